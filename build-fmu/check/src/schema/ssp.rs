//! Descriptions, parameter sets, mappings and dictionaries of SSP 1.0 (its four schemas and what they share).

use super::Type::{Boolean, DateTime, Double, Doubles, Hex, Id, Int, Line, Named, OneOf, Text, Uri};
use super::{Attribute, Content, Element, Particle, any, maybe, one, optional, required, some};

const COMMON: &str = "http://ssp-standard.org/SSP1/SystemStructureCommon";
const SSD: &str = "http://ssp-standard.org/SSP1/SystemStructureDescription";
const SSV: &str = "http://ssp-standard.org/SSP1/SystemStructureParameterValues";
const SSM: &str = "http://ssp-standard.org/SSP1/SystemStructureParameterMapping";
const SSB: &str = "http://ssp-standard.org/SSP1/SystemStructureSignalDictionary";

const fn element(
    namespace: &'static str,
    name: &'static str,
    attributes: &'static [&'static [Attribute]],
    content: &'static [&'static [Particle]],
) -> Element {
    Element { name, namespace: Some(namespace), attributes, content: Content::Sequence(content) }
}

const fn holder(name: &'static str, attributes: &'static [&'static [Attribute]]) -> Element {
    Element { name, namespace: Some(SSD), attributes, content: Content::Foreign { one: false } }
}

/// Of every entity.
const ENTITY: &[Attribute] = &[optional("id", Id), optional("description", Text)];
/// Of every file's root.
const ROOT: &[Attribute] = &[
    // That it is 1.0 is a rule of its own.
    required("version", Line),
    optional("author", Text),
    optional("fileversion", Line),
    optional("copyright", Text),
    optional("license", Text),
    optional("generationTool", Line),
    optional("generationDateAndTime", DateTime),
];
const NAME: &[Attribute] = &[required("name", Text)];

static ANNOTATIONS: Element = element(COMMON, "Annotations", &[], &[&[some(&[&ANNOTATION])]]);
static SSD_ANNOTATIONS: Element = element(SSD, "Annotations", &[], &[&[some(&[&ANNOTATION])]]);
static SSV_ANNOTATIONS: Element = element(SSV, "Annotations", &[], &[&[some(&[&ANNOTATION])]]);
static SSM_ANNOTATIONS: Element = element(SSM, "Annotations", &[], &[&[some(&[&ANNOTATION])]]);
static SSB_ANNOTATIONS: Element = element(SSB, "Annotations", &[], &[&[some(&[&ANNOTATION])]]);
static ANNOTATION: Element = Element {
    name: "Annotation",
    namespace: Some(COMMON),
    attributes: &[&[required("type", Line)]],
    content: Content::Foreign { one: true },
};

static ENUMERATIONS: [Particle; 1] = [some(&[&ENUMERATION])];
static ENUMERATION: Element =
    element(COMMON, "Enumeration", &[ENTITY, NAME], &[&[some(&[&ITEM]), maybe(&[&ANNOTATIONS])]]);
static ITEM: Element = element(COMMON, "Item", &[&[required("name", Text), required("value", Int)]], &[]);
static UNITS: [Particle; 1] = [some(&[&UNIT])];
static UNIT: Element =
    element(COMMON, "Unit", &[ENTITY, NAME], &[&[one(&[&BASE_UNIT]), maybe(&[&ANNOTATIONS])]]);
static BASE_UNIT: Element = element(COMMON, "BaseUnit", &[super::fmi::BASE], &[]);

/// The type of a connector or a signal.
const TYPES: &[&Element] = &[&REAL, &INTEGER, &BOOLEAN, &STRING, &OF_ENUMERATION, &BINARY];
static REAL: Element = element(COMMON, "Real", &[&[optional("unit", Text)]], &[]);
static INTEGER: Element = element(COMMON, "Integer", &[], &[]);
static BOOLEAN: Element = element(COMMON, "Boolean", &[], &[]);
static STRING: Element = element(COMMON, "String", &[], &[]);
static OF_ENUMERATION: Element = element(COMMON, "Enumeration", &[NAME], &[]);
static BINARY: Element = element(COMMON, "Binary", &[&[optional("mime-type", Text)]], &[]);

const TRANSFORMATIONS: &[&Element] = &[&LINEAR, &OF_BOOLEANS, &OF_INTEGERS, &OF_ITEMS];
static LINEAR: Element = element(
    COMMON,
    "LinearTransformation",
    &[&[optional("factor", Double), optional("offset", Double)]],
    &[],
);
static OF_BOOLEANS: Element =
    element(COMMON, "BooleanMappingTransformation", &[], &[&[some(&[&BOOLEAN_ENTRY])]]);
static BOOLEAN_ENTRY: Element =
    element(COMMON, "MapEntry", &[&[required("source", Boolean), required("target", Boolean)]], &[]);
static OF_INTEGERS: Element =
    element(COMMON, "IntegerMappingTransformation", &[], &[&[some(&[&INTEGER_ENTRY])]]);
static INTEGER_ENTRY: Element =
    element(COMMON, "MapEntry", &[&[required("source", Int), required("target", Int)]], &[]);
static OF_ITEMS: Element =
    element(COMMON, "EnumerationMappingTransformation", &[], &[&[some(&[&ITEM_ENTRY])]]);
static ITEM_ENTRY: Element =
    element(COMMON, "MapEntry", &[&[required("source", Text), required("target", Text)]], &[]);

/// `SystemStructure.ssd`.
pub static DESCRIPTION: Element = element(
    SSD,
    "SystemStructureDescription",
    &[ROOT, ENTITY, NAME],
    &[&[
        one(&[&SYSTEM]),
        maybe(&[&SSD_ENUMERATIONS]),
        maybe(&[&SSD_UNITS]),
        maybe(&[&DEFAULT_EXPERIMENT]),
        maybe(&[&SSD_ANNOTATIONS]),
    ]],
);
static SSD_ENUMERATIONS: Element = element(SSD, "Enumerations", &[], &[&ENUMERATIONS]);
static SSD_UNITS: Element = element(SSD, "Units", &[], &[&UNITS]);
static DEFAULT_EXPERIMENT: Element = element(
    SSD,
    "DefaultExperiment",
    &[&[optional("startTime", Double), optional("stopTime", Double)]],
    &[&[maybe(&[&SSD_ANNOTATIONS])]],
);

/// Of systems, components and references.
const ELEMENT: &[Attribute] = &[required("name", Named)];
static ELEMENT_CONTENT: [Particle; 3] =
    [maybe(&[&CONNECTORS]), maybe(&[&ELEMENT_GEOMETRY]), maybe(&[&PARAMETER_BINDINGS])];
const CORNERS: &[Attribute] =
    &[required("x1", Double), required("y1", Double), required("x2", Double), required("y2", Double)];

static SYSTEM: Element = element(
    SSD,
    "System",
    &[ENTITY, ELEMENT],
    &[
        &ELEMENT_CONTENT,
        &[
            maybe(&[&ELEMENTS]),
            maybe(&[&CONNECTIONS]),
            maybe(&[&SIGNAL_DICTIONARIES]),
            maybe(&[&SYSTEM_GEOMETRY]),
            maybe(&[&GRAPHICAL_ELEMENTS]),
            maybe(&[&SSD_ANNOTATIONS]),
        ],
    ],
);
static ELEMENTS: Element = element(SSD, "Elements", &[], &[&[some(&[&COMPONENT, &REFERENCE, &SYSTEM])]]);
static COMPONENT: Element = element(
    SSD,
    "Component",
    &[
        ENTITY,
        ELEMENT,
        &[
            optional("type", Text),
            required("source", Uri),
            optional("implementation", OneOf(&["any", "ModelExchange", "CoSimulation"])),
        ],
    ],
    &[&ELEMENT_CONTENT, &[maybe(&[&SSD_ANNOTATIONS])]],
);
static REFERENCE: Element = element(
    SSD,
    "SignalDictionaryReference",
    &[ENTITY, ELEMENT, &[required("dictionary", Text)]],
    &[&ELEMENT_CONTENT, &[maybe(&[&SSD_ANNOTATIONS])]],
);
static CONNECTORS: Element = element(SSD, "Connectors", &[], &[&[some(&[&CONNECTOR])]]);
static CONNECTOR: Element = element(
    SSD,
    "Connector",
    &[
        ENTITY,
        NAME,
        &[required("kind", OneOf(&["input", "output", "parameter", "calculatedParameter", "inout"]))],
    ],
    &[&[maybe(TYPES), maybe(&[&CONNECTOR_GEOMETRY]), maybe(&[&SSD_ANNOTATIONS])]],
);
static CONNECTOR_GEOMETRY: Element =
    element(SSD, "ConnectorGeometry", &[&[required("x", Double), required("y", Double)]], &[]);
static ELEMENT_GEOMETRY: Element = element(
    SSD,
    "ElementGeometry",
    &[
        CORNERS,
        &[
            optional("rotation", Double),
            optional("iconSource", Uri),
            optional("iconRotation", Double),
            optional("iconFlip", Boolean),
            optional("iconFixedAspectRatio", Boolean),
        ],
    ],
    &[],
);
static SYSTEM_GEOMETRY: Element = element(SSD, "SystemGeometry", &[CORNERS], &[]);
static GRAPHICAL_ELEMENTS: Element = element(SSD, "GraphicalElements", &[], &[&[some(&[&NOTE])]]);
static NOTE: Element = element(SSD, "Note", &[CORNERS, &[required("text", Text)]], &[]);

static CONNECTIONS: Element = element(SSD, "Connections", &[], &[&[some(&[&CONNECTION])]]);
static CONNECTION: Element = element(
    SSD,
    "Connection",
    &[
        ENTITY,
        &[
            optional("startElement", Text),
            required("startConnector", Text),
            optional("endElement", Text),
            required("endConnector", Text),
            optional("suppressUnitConversion", Boolean),
        ],
    ],
    &[&[maybe(TRANSFORMATIONS), maybe(&[&CONNECTION_GEOMETRY]), maybe(&[&SSD_ANNOTATIONS])]],
);
static CONNECTION_GEOMETRY: Element =
    element(SSD, "ConnectionGeometry", &[&[required("pointsX", Doubles), required("pointsY", Doubles)]], &[]);
static SIGNAL_DICTIONARIES: Element =
    element(SSD, "SignalDictionaries", &[], &[&[some(&[&SIGNAL_DICTIONARY])]]);
static SIGNAL_DICTIONARY: Element =
    holder("SignalDictionary", &[ENTITY, NAME, &[optional("type", Text), optional("source", Uri)]]);

static PARAMETER_BINDINGS: Element =
    element(SSD, "ParameterBindings", &[], &[&[some(&[&PARAMETER_BINDING])]]);
/// Where values or mappings come from.
const SOURCE: &[Attribute] =
    &[optional("type", Text), optional("source", Uri), optional("sourceBase", OneOf(&["SSD", "component"]))];
static PARAMETER_BINDING: Element = element(
    SSD,
    "ParameterBinding",
    &[ENTITY, SOURCE, &[optional("prefix", Text)]],
    &[&[maybe(&[&PARAMETER_VALUES]), maybe(&[&PARAMETER_MAPPING]), maybe(&[&SSD_ANNOTATIONS])]],
);
static PARAMETER_VALUES: Element = holder("ParameterValues", &[]);
static PARAMETER_MAPPING: Element = holder("ParameterMapping", &[ENTITY, SOURCE]);

/// `.ssv`.
pub static PARAMETER_SET: Element = element(
    SSV,
    "ParameterSet",
    &[ROOT, ENTITY, NAME],
    &[&[one(&[&PARAMETERS]), maybe(&[&SSV_ENUMERATIONS]), maybe(&[&SSV_UNITS]), maybe(&[&SSV_ANNOTATIONS])]],
);
static SSV_ENUMERATIONS: Element = element(SSV, "Enumerations", &[], &[&ENUMERATIONS]);
static SSV_UNITS: Element = element(SSV, "Units", &[], &[&UNITS]);
static PARAMETERS: Element = element(SSV, "Parameters", &[], &[&[any(&[&PARAMETER])]]);
static PARAMETER: Element = element(
    SSV,
    "Parameter",
    &[ENTITY, NAME],
    &[&[
        one(&[&GIVEN_REAL, &GIVEN_INTEGER, &GIVEN_BOOLEAN, &GIVEN_STRING, &GIVEN_ITEM, &GIVEN_BINARY]),
        maybe(&[&SSV_ANNOTATIONS]),
    ]],
);
static GIVEN_REAL: Element =
    element(SSV, "Real", &[&[required("value", Double), optional("unit", Text)]], &[]);
static GIVEN_INTEGER: Element = element(SSV, "Integer", &[&[required("value", Int)]], &[]);
static GIVEN_BOOLEAN: Element = element(SSV, "Boolean", &[&[required("value", Boolean)]], &[]);
static GIVEN_STRING: Element = element(SSV, "String", &[&[required("value", Text)]], &[]);
static GIVEN_ITEM: Element =
    element(SSV, "Enumeration", &[&[required("value", Text), optional("name", Text)]], &[]);
static GIVEN_BINARY: Element =
    element(SSV, "Binary", &[&[optional("mime-type", Text), required("value", Hex)]], &[]);

/// `.ssm`.
pub static MAPPING: Element = element(
    SSM,
    "ParameterMapping",
    &[ROOT, ENTITY],
    &[&[any(&[&MAPPING_ENTRY]), maybe(&[&SSM_ANNOTATIONS])]],
);
static MAPPING_ENTRY: Element = element(
    SSM,
    "MappingEntry",
    &[
        ENTITY,
        &[required("source", Text), required("target", Text), optional("suppressUnitConversion", Boolean)],
    ],
    &[&[maybe(TRANSFORMATIONS), maybe(&[&SSM_ANNOTATIONS])]],
);

/// `.ssb`.
pub static DICTIONARY: Element = element(
    SSB,
    "SignalDictionary",
    &[ROOT, ENTITY],
    &[&[
        any(&[&DICTIONARY_ENTRY]),
        maybe(&[&SSB_ENUMERATIONS]),
        maybe(&[&SSB_UNITS]),
        maybe(&[&SSB_ANNOTATIONS]),
    ]],
);
static SSB_ENUMERATIONS: Element = element(SSB, "Enumerations", &[], &[&ENUMERATIONS]);
static SSB_UNITS: Element = element(SSB, "Units", &[], &[&UNITS]);
static DICTIONARY_ENTRY: Element =
    element(SSB, "DictionaryEntry", &[ENTITY, NAME], &[&[one(TYPES), maybe(&[&SSB_ANNOTATIONS])]]);
