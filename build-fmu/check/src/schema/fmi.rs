//! `modelDescription.xml` (FMI 2.0.5, `fmi2ModelDescription.xsd` and what it includes).

use super::Type::{Boolean, DateTime, Double, Int, Line, ListOf, OneOf, Text, UnsignedInt, UnsignedInts};
use super::{Attribute, Content, Element, any, element, maybe, one, optional, required, some};

/// The root.
pub static ROOT: Element = element(
    "fmiModelDescription",
    &[&[
        required("fmiVersion", OneOf(&["2.0"])),
        required("modelName", Text),
        required("guid", Line),
        optional("description", Text),
        optional("author", Text),
        optional("version", Line),
        optional("copyright", Text),
        optional("license", Text),
        optional("generationTool", Line),
        optional("generationDateAndTime", DateTime),
        optional("variableNamingConvention", OneOf(&["flat", "structured"])),
        optional("numberOfEventIndicators", UnsignedInt),
    ]],
    &[&[
        // The schema takes the two in any order; that there is one of each is a rule of its own.
        any(&[&MODEL_EXCHANGE, &CO_SIMULATION]),
        maybe(&[&UNIT_DEFINITIONS]),
        maybe(&[&TYPE_DEFINITIONS]),
        maybe(&[&LOG_CATEGORIES]),
        maybe(&[&DEFAULT_EXPERIMENT]),
        maybe(&[&VENDOR_ANNOTATIONS]),
        one(&[&MODEL_VARIABLES]),
        one(&[&MODEL_STRUCTURE]),
    ]],
);

/// What both interfaces can declare.
const CAPABILITIES: &[Attribute] = &[
    required("modelIdentifier", Line),
    optional("needsExecutionTool", Boolean),
    optional("canBeInstantiatedOnlyOncePerProcess", Boolean),
    optional("canNotUseMemoryManagementFunctions", Boolean),
    optional("canGetAndSetFMUstate", Boolean),
    optional("canSerializeFMUstate", Boolean),
    optional("providesDirectionalDerivative", Boolean),
];

static MODEL_EXCHANGE: Element = element(
    "ModelExchange",
    &[CAPABILITIES, &[optional("completedIntegratorStepNotNeeded", Boolean)]],
    &[&[maybe(&[&SOURCE_FILES])]],
);
static CO_SIMULATION: Element = element(
    "CoSimulation",
    &[
        CAPABILITIES,
        &[
            optional("canHandleVariableCommunicationStepSize", Boolean),
            optional("canInterpolateInputs", Boolean),
            optional("maxOutputDerivativeOrder", UnsignedInt),
            optional("canRunAsynchronuously", Boolean),
        ],
    ],
    &[&[maybe(&[&SOURCE_FILES])]],
);
static SOURCE_FILES: Element = element("SourceFiles", &[], &[&[some(&[&FILE])]]);
static FILE: Element = element("File", &[&[required("name", Line)]], &[]);

static UNIT_DEFINITIONS: Element = element("UnitDefinitions", &[], &[&[some(&[&UNIT])]]);
static UNIT: Element =
    element("Unit", &[&[required("name", Line)]], &[&[maybe(&[&BASE_UNIT]), any(&[&DISPLAY_UNIT])]]);
/// Exponents, factor and offset, which SSP has too.
pub(super) const BASE: &[Attribute] = &[
    optional("kg", Int),
    optional("m", Int),
    optional("s", Int),
    optional("A", Int),
    optional("K", Int),
    optional("mol", Int),
    optional("cd", Int),
    optional("rad", Int),
    optional("factor", Double),
    optional("offset", Double),
];
static BASE_UNIT: Element = element("BaseUnit", &[BASE], &[]);
static DISPLAY_UNIT: Element = element(
    "DisplayUnit",
    &[&[required("name", Line), optional("factor", Double), optional("offset", Double)]],
    &[],
);

/// Of Reals, in types and variables.
const REAL: &[Attribute] = &[
    optional("quantity", Line),
    optional("unit", Line),
    optional("displayUnit", Line),
    optional("relativeQuantity", Boolean),
    optional("min", Double),
    optional("max", Double),
    optional("nominal", Double),
    optional("unbounded", Boolean),
];
/// Of Integers and Enumerations.
const INTEGER: &[Attribute] = &[optional("quantity", Line), optional("min", Int), optional("max", Int)];

static TYPE_DEFINITIONS: Element = element("TypeDefinitions", &[], &[&[some(&[&SIMPLE_TYPE])]]);
static SIMPLE_TYPE: Element = element(
    "SimpleType",
    &[&[required("name", Line), optional("description", Text)]],
    &[&[one(&[&TYPE_REAL, &TYPE_INTEGER, &TYPE_BOOLEAN, &TYPE_STRING, &TYPE_ENUMERATION])]],
);
static TYPE_REAL: Element = element("Real", &[REAL], &[]);
static TYPE_INTEGER: Element = element("Integer", &[INTEGER], &[]);
static TYPE_BOOLEAN: Element = element("Boolean", &[], &[]);
static TYPE_STRING: Element = element("String", &[], &[]);
static TYPE_ENUMERATION: Element =
    element("Enumeration", &[&[optional("quantity", Line)]], &[&[some(&[&ITEM])]]);
static ITEM: Element =
    element("Item", &[&[required("name", Line), required("value", Int), optional("description", Text)]], &[]);

static LOG_CATEGORIES: Element = element("LogCategories", &[], &[&[some(&[&CATEGORY])]]);
static CATEGORY: Element =
    element("Category", &[&[required("name", Line), optional("description", Text)]], &[]);
static DEFAULT_EXPERIMENT: Element = element(
    "DefaultExperiment",
    &[&[
        optional("startTime", Double),
        optional("stopTime", Double),
        optional("tolerance", Double),
        optional("stepSize", Double),
    ]],
    &[],
);

static VENDOR_ANNOTATIONS: Element = element("VendorAnnotations", &[], &[&[some(&[&TOOL])]]);
static ANNOTATIONS: Element = element("Annotations", &[], &[&[some(&[&TOOL])]]);
static TOOL: Element = Element {
    name: "Tool",
    namespace: None,
    attributes: &[&[required("name", Line)]],
    content: Content::Foreign { one: true },
};

static MODEL_VARIABLES: Element = element("ModelVariables", &[], &[&[some(&[&SCALAR_VARIABLE])]]);
static SCALAR_VARIABLE: Element = element(
    "ScalarVariable",
    &[&[
        required("name", Line),
        required("valueReference", UnsignedInt),
        optional("description", Text),
        optional(
            "causality",
            OneOf(&["parameter", "calculatedParameter", "input", "output", "local", "independent"]),
        ),
        optional("variability", OneOf(&["constant", "fixed", "tunable", "discrete", "continuous"])),
        optional("initial", OneOf(&["exact", "approx", "calculated"])),
        optional("canHandleMultipleSetPerTimeInstant", Boolean),
    ]],
    &[&[
        one(&[&VARIABLE_REAL, &VARIABLE_INTEGER, &VARIABLE_BOOLEAN, &VARIABLE_STRING, &VARIABLE_ENUMERATION]),
        maybe(&[&ANNOTATIONS]),
    ]],
);
const DECLARED_TYPE: Attribute = optional("declaredType", Line);
static VARIABLE_REAL: Element = element(
    "Real",
    &[
        REAL,
        &[
            DECLARED_TYPE,
            optional("start", Double),
            optional("derivative", UnsignedInt),
            optional("reinit", Boolean),
        ],
    ],
    &[],
);
static VARIABLE_INTEGER: Element =
    element("Integer", &[INTEGER, &[DECLARED_TYPE, optional("start", Int)]], &[]);
static VARIABLE_BOOLEAN: Element = element("Boolean", &[&[DECLARED_TYPE, optional("start", Boolean)]], &[]);
static VARIABLE_STRING: Element = element("String", &[&[DECLARED_TYPE, optional("start", Text)]], &[]);
static VARIABLE_ENUMERATION: Element =
    element("Enumeration", &[INTEGER, &[required("declaredType", Line), optional("start", Int)]], &[]);

static MODEL_STRUCTURE: Element = element(
    "ModelStructure",
    &[],
    &[&[maybe(&[&OUTPUTS]), maybe(&[&DERIVATIVES]), maybe(&[&INITIAL_UNKNOWNS])]],
);
static OUTPUTS: Element = element("Outputs", &[], &[&[some(&[&UNKNOWN])]]);
static DERIVATIVES: Element = element("Derivatives", &[], &[&[some(&[&UNKNOWN])]]);
static INITIAL_UNKNOWNS: Element = element("InitialUnknowns", &[], &[&[some(&[&UNKNOWN])]]);
static UNKNOWN: Element = element(
    "Unknown",
    &[&[
        required("index", UnsignedInt),
        optional("dependencies", UnsignedInts),
        optional("dependenciesKind", ListOf(&["dependent", "constant", "fixed", "tunable", "discrete"])),
    ]],
    &[],
);
