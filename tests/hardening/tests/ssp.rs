//! A system with everything in its names and texts that XML and paths have a meaning for, read back by readers that
//! others have written: every component, connector, connection, parameter and unit is what was declared.

use std::io::Write;
use std::path::Path;

use serde_json::{Value, json};
use zip::{ZipWriter, write::SimpleFileOptions};

/// For a text in XML, one in TOML between double quotes, and any reader of attributes: a line's end counts.
const HOSTILE: &str = "Größe \"in\" <b> & 'Ä' ]]> &amp; 100 % \\ €\tdann\nZeile 2";
const OUTPUT: &str = "Kraft \"F\" <&> 'ä' ]]> [1]";
const INPUT: &str = "räder.\"links\" -> <vorn> & 'mitte'";
const SPEED: &str = "v & <w>";
const GAIN: &str = "größe & \"k\" <1>";
const LABEL: &str = "name of <file> & 'path'";
const UNIT: &str = "µN \"<&>\"";

/// An FMU that nobody runs: a description, and a library to be carried along.
fn write_fmu(path: &Path, title: &str, units: &str, variables: &[(&str, &str, &str)]) {
    let variables: String = variables
        .iter()
        .map(|(name, role, of_type)| {
            format!(
                "<ScalarVariable name=\"{}\" valueReference=\"0\" {role}>{of_type}</ScalarVariable>",
                xml(name)
            )
        })
        .collect();
    let text = format!(
        "<fmiModelDescription fmiVersion=\"2.0\" modelName=\"M\" guid=\"1\" description=\"{}\">\
         <CoSimulation modelIdentifier=\"M\"/><UnitDefinitions>{units}</UnitDefinitions>\
         <ModelVariables>{variables}</ModelVariables></fmiModelDescription>",
        xml(title)
    );
    let mut zip = ZipWriter::new(std::fs::File::create(path).expect("a folder of ours"));
    for (name, contents) in [("modelDescription.xml", text.as_str()), ("binaries/linux64/M.so", "")] {
        zip.start_file(name, SimpleFileOptions::default()).expect("it is open");
        zip.write_all(contents.as_bytes()).expect("it is open");
    }
    zip.finish().expect("it is open");
}

fn xml(text: &str) -> String {
    let escaped = [("&", "&amp;"), ("<", "&lt;"), ("\"", "&quot;"), ("\n", "&#10;"), ("\t", "&#9;")];
    escaped.iter().fold(text.to_owned(), |text, (from, to)| text.replace(from, to))
}

/// A basic string of TOML.
fn toml(text: &str) -> String {
    let escaped = [("\\", "\\\\"), ("\"", "\\\""), ("\n", "\\n"), ("\t", "\\t")];
    format!("\"{}\"", escaped.iter().fold(text.to_owned(), |text, (from, to)| text.replace(from, to)))
}

#[test]
fn a_hostile_system_comes_back_from_foreign_readers() {
    let folder = tempfile::tempdir().expect("a folder");
    let (from, to) = ("Quelle 100% & #1 'ä'.fmu", "Senke?.fmu");
    let unit =
        format!("<Unit name=\"{}\"><BaseUnit kg=\"1\" m=\"1\" s=\"-2\" factor=\"1e-6\"/></Unit>", xml(UNIT));
    let speeds = "<Unit name=\"°C\"><BaseUnit K=\"1\" offset=\"273.15\"/></Unit><Unit name=\"K\"><BaseUnit K=\"1\"/></Unit>";
    let real = format!("<Real unit=\"{}\"/>", xml(UNIT));
    let started = format!("<Real unit=\"{}\" start=\"0\"/>", xml(UNIT));
    let (parameter, output) = ("causality=\"parameter\" variability=\"fixed\"", "causality=\"output\"");
    write_fmu(
        &folder.path().join(from),
        HOSTILE,
        &format!("{unit}{speeds}"),
        &[(OUTPUT, output, &real), (SPEED, output, "<Real unit=\"°C\"/>")],
    );
    write_fmu(
        &folder.path().join(to),
        "",
        &format!("{unit}{speeds}"),
        &[
            (INPUT, "causality=\"input\"", &started),
            (SPEED, "causality=\"input\"", "<Real unit=\"K\" start=\"0\"/>"),
            (GAIN, parameter, &started),
            (LABEL, parameter, "<String start=\"\"/>"),
        ],
    );
    let port = |component: &str, variable: &str| toml(&format!("{component}.{variable}"));
    let system = folder.path().join("system.toml");
    let text = format!(
        "name = \"hostile\"\ntitle = {title}\nsource = \"M&T <'\\\"'>\"\nfactors = \"connection\"\n\
         components = {{ source = {{ fmu = {} }}, sink = {{ fmu = {} }} }}\n\
         connections = [{{ from = {}, to = {} }}, {{ from = {}, to = {}, factor = 1.0, offset = 273.15 }}]\n\
         outputs = [{}]\n[experiment]\nstop = 1.0\nstep = 0.1\n[parameters]\n\
         {} = {{ value = 2.5, unit = {} }}\n{} = {{ value = {title} }}\n",
        toml(from),
        toml(to),
        port("source", OUTPUT),
        port("sink", INPUT),
        port("source", SPEED),
        port("sink", SPEED),
        port("source", OUTPUT),
        port("sink", GAIN),
        toml(UNIT),
        port("sink", LABEL),
        title = toml(HOSTILE),
    );
    std::fs::write(&system, text).expect("a folder of ours");
    strut::run(strut::build_fmu().arg("--out").arg(folder.path()).arg("--system").arg(&system));
    let told = strut::python("tests/masters/system_read_back.py", [folder.path().join("hostile.ssp")]);
    let told: Value = serde_json::from_str(&told).expect("it prints JSON");
    let newton = json!({"kg": 1, "m": 1, "s": -2});
    let expected = json!({
        "names": ["hostile", "hostile", HOSTILE],
        // Whatever a file is called: in the archive it has a name that every reader of URIs finds.
        "components": [["source", "resources/Quelle_100_____1____.fmu"], ["sink", "resources/Senke_.fmu"]],
        "connectors": [
            ["source", OUTPUT, "output"],
            ["source", SPEED, "output"],
            ["sink", INPUT, "input"],
            ["sink", SPEED, "input"],
        ],
        "connections": [["source", OUTPUT, "sink", INPUT], ["source", SPEED, "sink", SPEED]],
        "parameters": [["sink", GAIN, "Real", "2.5", UNIT], ["sink", LABEL, "String", HOSTILE, null]],
        "units": [["K", {"K": 1}, 1.0, 0.0], ["°C", {"K": 1}, 1.0, 273.15], [UNIT, newton, 1e-6, 0.0]],
    });
    assert_eq!(told["FMPy"], expected, "FMPy");
    let mut expected = expected;
    expected["description"] = json!(format!("{HOSTILE} (M&T <'\"'>)"));
    expected["descriptions"] = json!([HOSTILE, "M"]);
    expected["types"] = json!([["Real", UNIT], ["Real", "°C"], ["Real", UNIT], ["Real", "K"]]);
    expected["ways"] = json!([[], [["LinearTransformation", "1.0", "273.15"]]]);
    assert_eq!(told["lxml"], expected, "lxml");
}
