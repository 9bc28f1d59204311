//! Libraries with one fault each, compiled for the occasion.

use super::Case;
use crate::subject::{Parts, library, parts};

const TEXT: &str = "<ScalarVariable name=\"text\" valueReference=\"0\" description=\"Text\" causality=\"output\" \
                    variability=\"discrete\" initial=\"calculated\"><String/></ScalarVariable>";
const PROMISES: &str = "canHandleVariableCommunicationStepSize=\"true\"";

pub fn all() -> Vec<Case> {
    let promised = |more: &str| parts("").with(PROMISES, &format!("{PROMISES} {more}"));
    let shares = |name: &str, of: Parts| (name.to_owned(), of);
    let faults = [
        ("FUNCTION", "binary.functions"),
        ("GLIBC", "binary.glibc"),
        ("GUID", "run.guid"),
        ("VERSION", "run.version"),
        ("TYPES", "run.version.types"),
        ("START", "run.start"),
        ("NULL", "run.simulate"),
        ("REFUSES", "run.simulate"),
        ("CRASH", "run.simulate"),
        ("HANG", "run.simulate"),
        ("EVENTS", "run.simulate"),
        ("NAN", "run.finite"),
        ("REFERENCE", "run.reference"),
        ("REFERENCE_CRASH", "run.reference"),
        ("REPEAT", "run.repeat"),
        ("SPACES", "run.resources"),
        ("RESET", "run.reset"),
        ("STATE", "run.state.point"),
        ("BYTES", "run.state.point"),
        ("DRIFT", "run.state"),
        ("RESTART", "run.state"),
        ("SHARED", "run.instances"),
        ("CLOCK", "run.clock"),
        ("TUNABLE", "run.tunable"),
        ("FIXED", "run.fixed"),
        ("DIRECTIONAL", "run.directional"),
        ("CATEGORY", "run.logger.category"),
        ("LATIN", "run.logger.text"),
        ("LEAK", "run.memory.freed"),
        ("FOREIGN", "run.memory.foreign"),
        ("NOMINALS", "run.nominals"),
        ("FREE", "run.free"),
        ("TERMINATED", "run.terminated"),
        ("KEPT", "run.state.again"),
        ("POINTER", "run.state.freed"),
    ];
    let mut cases: Vec<(String, &'static str, Parts)> =
        faults.iter().map(|(fault, rule)| ((*fault).to_owned(), *rule, parts(fault))).collect();
    let text = parts("TEXT")
        .with("</ModelVariables>", &format!("{TEXT}</ModelVariables>"))
        .with("<Outputs>", "<Outputs><Unknown index=\"7\" dependencies=\"\"/>")
        .with("</InitialUnknowns>", "<Unknown index=\"7\" dependencies=\"\"/></InitialUnknowns>");
    let own =
        parts("LEAK").with(PROMISES, &format!("{PROMISES} canNotUseMemoryManagementFunctions=\"true\""));
    for ((what, parts), rule) in [
        (shares("null text", text), "run.text"),
        (shares("own memory", own), "run.memory.own"),
        (shares("slopes", promised("maxOutputDerivativeOrder=\"1\"")), "run.slopes"),
        (shares("inputs", promised("canInterpolateInputs=\"true\"")), "run.interpolate"),
        (shares("only Linux", parts("")), "binary.platform.missing"),
        (shares("library", Parts { library: Some(library("", true)), ..parts("") }), "binary.libraries"),
        (shares("loads", Parts { library: Some(library("", true)), ..parts("") }), "run.load"),
    ] {
        cases.push((what, rule, parts));
    }
    cases.into_iter().map(|(what, rule, parts)| Case::fmu(what, rule, parts.bytes())).collect()
}
