//! A published rig, as the packager makes it, with a description that breaks the schema.

use std::io::Read;

use zip::{CompressionMethod, ZipArchive};

use super::Case;
use super::schema::{self, Facts};
use crate::subject::archive;

const NAME: &str = "TumQuarterVehicle.fmu";
const XML: &str = "modelDescription.xml";

pub(super) const RULES: schema::Rules = [
    "schema.element",
    "schema.order",
    "schema.missing",
    "schema.attribute",
    "schema.required",
    "schema.value",
    "schema.text",
];

pub(super) const FACTS: Facts = Facts {
    required: &[
        ("fmiModelDescription", "fmiVersion"),
        ("fmiModelDescription", "modelName"),
        ("fmiModelDescription", "guid"),
        ("ModelExchange", "modelIdentifier"),
        ("CoSimulation", "modelIdentifier"),
        ("Unit", "name"),
        ("DisplayUnit", "name"),
        ("SimpleType", "name"),
        ("Item", "name"),
        ("Item", "value"),
        ("Category", "name"),
        ("Tool", "name"),
        ("File", "name"),
        ("ScalarVariable", "name"),
        ("ScalarVariable", "valueReference"),
        ("Enumeration", "declaredType"),
        ("Unknown", "index"),
    ],
    typed: &[
        "fmiVersion",
        "generationDateAndTime",
        "variableNamingConvention",
        "numberOfEventIndicators",
        "completedIntegratorStepNotNeeded",
        "canBeInstantiatedOnlyOncePerProcess",
        "canNotUseMemoryManagementFunctions",
        "canGetAndSetFMUstate",
        "canSerializeFMUstate",
        "providesDirectionalDerivative",
        "canHandleVariableCommunicationStepSize",
        "canInterpolateInputs",
        "maxOutputDerivativeOrder",
        "needsExecutionTool",
        "canRunAsynchronuously",
        "kg",
        "m",
        "s",
        "rad",
        "factor",
        "offset",
        "value",
        "startTime",
        "stopTime",
        "tolerance",
        "stepSize",
        "valueReference",
        "causality",
        "variability",
        "initial",
        "canHandleMultipleSetPerTimeInstant",
        "min",
        "max",
        "nominal",
        "unbounded",
        "relativeQuantity",
        "derivative",
        "reinit",
        "index",
        "dependencies",
        "dependenciesKind",
    ],
    single: &[
        "UnitDefinitions",
        "TypeDefinitions",
        "LogCategories",
        "DefaultExperiment",
        "VendorAnnotations",
        "ModelVariables",
        "ModelStructure",
        "Outputs",
        "Derivatives",
        "InitialUnknowns",
        "BaseUnit",
        "Real",
        "SourceFiles",
        "Annotations",
    ],
    needed: &["ModelVariables", "ModelStructure", "Real", "Integer", "Enumeration"],
    open: &["Tool"],
    free: &[],
};

/// The FMU without its library, which is looked into elsewhere: files with their names.
fn files() -> Vec<(String, Vec<u8>)> {
    let mut zip = ZipArchive::new(std::fs::File::open(strut::fmus().join(NAME)).unwrap()).unwrap();
    let mut files = Vec::new();
    for index in 0..zip.len() {
        let mut entry = zip.by_index(index).unwrap();
        let mut bytes = Vec::new();
        entry.read_to_end(&mut bytes).unwrap();
        let name = entry.name().unwrap().into_owned();
        let is_library = name.starts_with("binaries/");
        files.push((
            if is_library { "sources/all.c".into() } else { name },
            if is_library { Vec::new() } else { bytes },
        ));
    }
    files
}

/// As it is made.
pub fn good() -> Case {
    Case::fmu(NAME, "", std::fs::read(strut::fmus().join(NAME)).unwrap())
}

/// Each way of breaking the schema.
pub fn all() -> Vec<Case> {
    let files = files();
    let (_, xml) = files.iter().find(|(name, _)| name == XML).unwrap();
    let packed = |text: String| {
        let others = files
            .iter()
            .filter(|(name, _)| name != XML)
            .map(|(name, bytes)| (name.as_str(), bytes.as_slice()));
        let all = [(XML, text.as_bytes())].into_iter().chain(others);
        archive(all.map(|(name, bytes)| (name, bytes, CompressionMethod::Deflated)))
    };
    let mutations = schema::all(std::str::from_utf8(xml).unwrap(), &RULES, &FACTS);
    mutations.into_iter().map(|(what, rule, text)| Case::fmu(what, rule, packed(text))).collect()
}
