//! The small FMU with files that travel with it (FMI-LS-REF), and what breaks each rule for them.

use zip::CompressionMethod;

use super::Case;
use crate::subject::{Parts, parts};

const FOLDER: &str = "extra/org.fmi-standard.fmi-ls-ref/";
const MANIFEST: &str = include_str!("../related/fmi-ls-manifest.xml");
const EXPERIMENT: &str = include_str!("../related/validation.exp");
const PARAMETERS: &str = include_str!("../related/parameters.ssv");
const STIMULI: &str = "time,u\n0,0\n0.5,0\n0.5,1\n1,1\n";

/// What the FMU of `faulty.c` does in the experiment: Euler's method in steps of a millisecond.
fn expected() -> String {
    let (mut x, mut text) = (0.5_f64, "time,y\n0,0.5\n".to_owned());
    for step in 0..10 {
        let u = if step < 5 { 0.0 } else { 1.0 };
        (0..100).for_each(|_| x += 1e-3 * 3.0 * (u - x));
        text.push_str(&format!("{},{x}\n", f64::from(step + 1) / 10.0));
    }
    text
}

/// The FMU with these files; one of them may have another text in it, or be missing.
fn with(change: Option<(&str, &str, &str)>) -> Parts {
    let mut parts = parts("");
    let expected = expected();
    for (name, text) in [
        ("fmi-ls-manifest.xml", MANIFEST),
        ("validation.exp", EXPERIMENT),
        ("parameters.ssv", PARAMETERS),
        ("in.csv", STIMULI),
        ("out.csv", &expected),
    ] {
        let text = match change {
            Some((file, "", "")) if file == name => continue,
            Some((file, from, to)) if file == name => {
                assert!(text.contains(from), "{from} is not in {name}");
                text.replacen(from, to, 1)
            }
            _ => text.to_owned(),
        };
        parts.files.push((format!("{FOLDER}{name}"), text.into_bytes(), CompressionMethod::Deflated));
    }
    parts
}

pub fn good() -> Case {
    Case::fmu("related files", "", with(None).bytes())
}

pub fn all() -> Vec<Case> {
    let text = expected();
    let line = text.lines().nth(6).expect("eleven rows").to_owned();
    let altered = format!("0.5,{}", line[4..].parse::<f64>().expect("a number") + 1e-3);
    let changes: [(&str, &str, &str, &str); 33] = [
        ("related.manifest", "fmi-ls-manifest.xml", "</fmiReferences>", ""),
        ("related.manifest", "fmi-ls-manifest.xml", "fmiReferences", "fmiReference"),
        (
            "related.manifest",
            "fmi-ls-manifest.xml",
            "\"org.fmi-standard.fmi-ls-ref\"",
            "\"org.fmi-standard.fmi-ls-xcp\"",
        ),
        ("related.manifest", "fmi-ls-manifest.xml", "fmi-ls:fmi-ls-version=\"1.0.0-alpha.1\"", ""),
        ("related.manifest", "fmi-ls-manifest.xml", "encoding=\"UTF-8\"", "encoding=\"ISO-8859-1\""),
        ("related.schema", "fmi-ls-manifest.xml", "<Related ", "<Other/><Related "),
        ("related.schema", "fmi-ls-manifest.xml", "description=\"Values\"", "describes=\"Values\""),
        ("related.schema", "fmi-ls-manifest.xml", " role=\"parameter\"", ""),
        ("related.schema", "fmi-ls-manifest.xml", "<Label name=\"variant:all\"/>", "<Label/>"),
        ("related.file", "fmi-ls-manifest.xml", "\"parameters.ssv\"", "\"parameter.ssv\""),
        ("related.file", "fmi-ls-manifest.xml", "\"parameters.ssv\"", "\"../../../parameters.ssv\""),
        ("related.file", "validation.exp", "", ""),
        ("related.role", "fmi-ls-manifest.xml", "experiment/validation", "experiment/proof"),
        ("related.role", "fmi-ls-manifest.xml", "\"parameter\"", "\"parameters\""),
        ("related.parameters", "parameters.ssv", "\"rate\"", "\"rates\""),
        ("related.parameters", "parameters.ssv", "\"rate\"", "\"y\""),
        ("related.parameters", "parameters.ssv", "ssv:Real", "ssv:Boolean"),
        ("related.parameters", "parameters.ssv", "</ssv:ParameterSet>", ""),
        ("related.experiment", "validation.exp", "</Experiments>", ""),
        ("related.experiment", "validation.exp", "stopTime=\"1\"", "stopTime=\"late\""),
        ("related.experiment", "validation.exp", "Stimuli", "Stimulus"),
        ("related.experiment", "validation.exp", "rms=\"0\"", "rms=\"none\""),
        ("related.experiment", "validation.exp", "name=\"rise\"", ""),
        ("related.experiment.data", "in.csv", "", ""),
        ("related.experiment.data", "in.csv", "0.5,1", "0.5,one"),
        ("related.experiment.data", "in.csv", "time,u", "time,y"),
        ("related.experiment.data", "out.csv", "time,y", "time,z"),
        ("related.experiment.data", "validation.exp", "Signal name=\"y\"", "Signal name=\"x\""),
        ("related.replay", "validation.exp", "stopTime=\"1\"", "stopTime=\"-1\""),
        ("related.replay.agreement", "out.csv", &line, &altered),
        ("related.replay.agreement", "validation.exp", "rms=\"0\"", "rms=\"1e-3\""),
        ("related.replay.agreement", "in.csv", "0.5,1", "0.5,1.01"),
        ("related.replay.agreement", "parameters.ssv", "value=\"3\"", "value=\"3.01\""),
    ];
    let files = changes.iter().map(|(rule, file, from, to)| {
        Case::fmu(format!("{file}: {from} -> {to}"), rule, with(Some((file, from, to))).bytes())
    });
    files.collect()
}
