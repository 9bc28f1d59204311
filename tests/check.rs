//! `build-fmu check`: nothing on our own FMUs and on one without fault, and each rule on one that breaks it.

use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use serde_json::Value;
use zip::{CompressionMethod, ZipWriter, write::SimpleFileOptions};

const XML: &str = include_str!("check/modelDescription.xml");

/// What an FMU is made of.
struct Parts {
    xml: String,
    library: Option<Vec<u8>>,
    files: Vec<(String, Vec<u8>, CompressionMethod)>,
}

/// The small FMU of `check/faulty.c`, with a fault of its code.
fn parts(fault: &str) -> Parts {
    static FAULTLESS: OnceLock<Vec<u8>> = OnceLock::new();
    let library =
        if fault.is_empty() { FAULTLESS.get_or_init(|| compiled("")).clone() } else { compiled(fault) };
    let data = ("resources/data.txt".into(), b"data".to_vec(), CompressionMethod::Deflated);
    Parts { xml: XML.into(), library: Some(library), files: vec![data] }
}

fn compiled(fault: &str) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("Faulty.so");
    let source = strut::root().join("tests/check/faulty.c");
    let mut cc = Command::new("cc");
    cc.args(["-shared", "-fPIC", "-O1", "-w", "-ffp-contract=off", "-o"]).arg(&out).arg(source).arg("-lm");
    if !fault.is_empty() {
        cc.arg(format!("-DFAULT_{fault}"));
    }
    strut::run(&mut cc);
    std::fs::read(out).unwrap()
}

/// The same with another text in its description.
fn described(from: &str, to: &str) -> Parts {
    let mut parts = parts("");
    assert!(parts.xml.contains(from), "{from}");
    parts.xml = parts.xml.replace(from, to);
    parts
}

impl Parts {
    fn write(&self, path: &Path) {
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        let mut add = |name: &str, contents: &[u8], method| {
            zip.start_file(name, SimpleFileOptions::default().compression_method(method)).unwrap();
            zip.write_all(contents).unwrap();
        };
        add("modelDescription.xml", self.xml.as_bytes(), CompressionMethod::Deflated);
        if let Some(library) = &self.library {
            add("binaries/linux64/Faulty.so", library, CompressionMethod::Deflated);
        }
        for (name, contents, method) in &self.files {
            add(name, contents, *method);
        }
        std::fs::write(path, zip.finish().unwrap().into_inner()).unwrap();
    }
}

/// Exit code and answer of `check --json`.
fn check(files: &[PathBuf], options: &[&str]) -> (i32, Value) {
    let mut command = strut::build_fmu();
    let output = command.arg("check").args(files).arg("--json").args(options).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    let answer = serde_json::from_str(&text)
        .unwrap_or_else(|error| panic!("{error}: {text}{}", String::from_utf8_lossy(&output.stderr)));
    (output.status.code().unwrap(), answer)
}

/// Findings above notes, as `rule: message`.
fn problems(answer: &Value) -> Vec<String> {
    let findings = answer["report"]["findings"].as_array().unwrap_or_else(|| panic!("{answer}"));
    let problems = findings.iter().filter(|finding| finding["level"] != "note");
    problems
        .map(|it| format!("{}: {}", it["rule"].as_str().unwrap(), it["message"].as_str().unwrap()))
        .collect()
}

/// Checks many FMUs in one run of the program, by our own rules alone: each has problems of its rule, and no others.
fn each_has_its_problem(cases: &[(&str, Parts, &str, &str)], options: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let files: Vec<PathBuf> = (0..)
        .zip(cases)
        .map(|(index, (name, parts, ..))| {
            let path = folder.path().join(format!("{index}-{name}.fmu"));
            parts.write(&path);
            path
        })
        .collect();
    let (code, answers) = check(&files, &[&["--no-fmpy"], options].concat());
    assert_eq!(code, 1);
    for ((name, _, rule, message), answer) in cases.iter().zip(answers.as_array().unwrap()) {
        let found = problems(answer);
        assert!(found.iter().any(|problem| problem.contains(message)), "{name}: {found:#?}");
        assert!(found.iter().all(|problem| problem.starts_with(&format!("{rule}: "))), "{name}: {found:#?}");
    }
}

/// Description, archive and files of libraries.
#[test]
fn each_rule_finds_what_breaks_it() {
    let without = |part: &str| described(part, "");
    let unknown = "<Unknown index=\"4\" dependencies=\"1 6\"/>";
    let first = "<Unknown index=\"2\" dependencies=\"1 3 5\"/>";
    let y = "initial=\"calculated\"><Real unit=\"m\"/>";
    let mut interfaces = parts("");
    let lines = interfaces.xml.lines().filter(|line| !line.contains("modelIdentifier"));
    interfaces.xml = lines.collect::<Vec<_>>().join("\n");
    let mut states = described("<Derivatives><Unknown index=\"2\" dependencies=\"3\"/></Derivatives>", "");
    states.xml = states.xml.replace(first, "");
    let mut identifier = described("modelIdentifier=\"Faulty\"", "modelIdentifier=\"Faulty-2\"");
    let library = identifier.library.take().unwrap();
    identifier.files.push(("binaries/linux64/Faulty-2.so".into(), library, CompressionMethod::Stored));
    let with_file = |name: &str| {
        let mut parts = parts("");
        parts.files.push((name.into(), Vec::new(), CompressionMethod::Stored));
        parts
    };
    let with_library = |library: Option<Vec<u8>>| Parts { library, ..parts("") };
    let mut windows = parts("");
    let library = windows.library.clone().unwrap();
    windows.files.push(("binaries/win64/Faulty.dll".into(), library, CompressionMethod::Stored));
    each_has_its_problem(
        &[
            ("guid", described("guid=\"{faulty}\"", "guid=\"\""), "description.guid", "missing or empty"),
            ("interfaces", interfaces, "description.interfaces", "neither"),
            ("identifier", identifier, "description.identifier", "`Faulty-2` is no identifier"),
            (
                "stop",
                described("stopTime=\"1\"", "stopTime=\"-1\""),
                "description.experiment",
                "stops at -1 s",
            ),
            (
                "step",
                described("stepSize=\"0.01\"", "stepSize=\"0\""),
                "description.experiment",
                "stepSize is 0",
            ),
            (
                "twice",
                described("name=\"rate\"", "name=\"u\""),
                "variables.name",
                "two variables of the name `u`",
            ),
            ("flat", described("name=\"rate\"", "name=\"a rate\""), "variables.name", "no structured name"),
            (
                "alias",
                described("valueReference=\"5\"", "valueReference=\"4\""),
                "variables.reference",
                "`rate` and `offset` share the reference 4",
            ),
            (
                "variability",
                described("variability=\"fixed\"", "variability=\"continuous\""),
                "variables.causality",
                "`offset` is a parameter, but its variability is \"continuous\"",
            ),
            (
                "initial",
                described("causality=\"input\"", "causality=\"input\" initial=\"exact\""),
                "variables.causality",
                "cannot have initial=\"exact\"",
            ),
            (
                "causality",
                described("causality=\"parameter\" variability=\"fixed\"", "causality=\"constant\""),
                "variables.causality",
                "\"constant\", which FMI 2.0 does not know",
            ),
            ("no-start", without(" start=\"0.5\""), "variables.start", "`x` has no start value"),
            (
                "start",
                described(y, "initial=\"calculated\"><Real unit=\"m\" start=\"1\"/>"),
                "variables.start",
                "`y` has a start value although",
            ),
            ("value", described("start=\"0.5\"", "start=\"half\""), "variables.start", "starts at `half`"),
            ("bounds", described("max=\"10\"", "max=\"-1\""), "variables.bounds", "outside of its bounds"),
            (
                "nominal",
                described("start=\"0.5\"", "start=\"0.5\" nominal=\"0\""),
                "variables.nominal",
                "nominal value 0",
            ),
            (
                "type",
                described(y, "initial=\"calculated\"><Real declaredType=\"Knd\" unit=\"m\"/>"),
                "variables.type",
                "of the type `Knd`, which",
            ),
            (
                "other-type",
                described(y, "initial=\"calculated\"><Real declaredType=\"Kind\" unit=\"m\"/>"),
                "variables.type",
                "`y` is Real, but its type `Kind` is Enumeration",
            ),
            (
                "unit",
                without("<Unit name=\"1/s\"><BaseUnit s=\"-1\"/></Unit>"),
                "variables.unit",
                "the unit `1/s` of `rate` is not declared",
            ),
            (
                "derivative",
                described("derivative=\"1\"", "derivative=\"9\""),
                "variables.derivative",
                "derivative of variable 9, which there is none of",
            ),
            (
                "outputs",
                without("<Unknown index=\"4\" dependencies=\"\"/>"),
                "structure.outputs",
                "lacks `y`",
            ),
            (
                "not-an-output",
                described("<Outputs>", "<Outputs><Unknown index=\"3\" dependencies=\"\"/>"),
                "structure.outputs",
                "lists `u`",
            ),
            ("derivatives", states, "structure.derivatives", "lacks `der(x)`"),
            ("initial-unknowns", without(unknown), "structure.initial", "InitialUnknowns lacks `y`"),
            (
                "order",
                described(&format!("{first}{unknown}"), &format!("{unknown}{first}")),
                "structure.order",
                "4 stands before 2",
            ),
            (
                "entry",
                described("index=\"2\" dependencies=\"1 3 5\"", "index=\"2\" dependencies=\"1 3 9\""),
                "structure.entry",
                "depends on variable 9",
            ),
            (
                "kinds",
                described("dependencies=\"3\"", "dependencies=\"3\" dependenciesKind=\"constant fixed\""),
                "structure.entry",
                "not as many dependenciesKind",
            ),
            (
                "dependencies",
                described("index=\"4\" dependencies=\"\"", "index=\"4\""),
                "structure.dependencies",
                "not told for `y`",
            ),
            ("backslash", with_file("resources\\x.txt"), "archive.path", "backslashes"),
            ("outside", with_file("../x.txt"), "archive.path", "out of the archive"),
            ("nothing", with_library(None), "binary.platform", "neither a library nor source code"),
            ("no-library", with_library(Some(b"nothing".to_vec())), "binary.format", "no shared library"),
            ("elsewhere", windows, "binary.format", "the library is one for linux64"),
            ("function", parts("FUNCTION"), "binary.functions", "does not export `fmi2GetStringStatus`"),
        ],
        &["--no-run"],
    );
}

/// Libraries that are run.
#[test]
fn each_fault_of_behaviour_is_found() {
    let case = |fault: &'static str, rule, message| (fault, parts(fault), rule, message);
    each_has_its_problem(
        &[
            case("GUID", "run.guid", "accepts a wrong GUID"),
            case("VERSION", "run.version", "fmi2GetVersion returns \"2\""),
            case("START", "run.start", "`rate` is 3, not 2"),
            case("CATEGORY", "run.logger", "category is null"),
            case("NULL", "run.simulate", "fmi2Instantiate returns null"),
            case("REFUSES", "run.simulate", "fmi2EnterInitializationMode returns fmi2Error"),
            case("CRASH", "run.simulate", "crashes in fmi2DoStep during a run of co-simulation: signal 11"),
            case("HANG", "run.simulate", "does not return from fmi2DoStep"),
            case("EVENTS", "run.simulate", "fmi2NewDiscreteStates"),
            case("NAN", "run.finite", "`y` is no finite number"),
            case("REFERENCE", "run.reference", "returns fmi2OK for the value reference"),
            case("REFERENCE_CRASH", "run.reference", "crashes in fmi2GetReal"),
            case("REPEAT", "run.repeat", "two runs of co-simulation with the same inputs differ"),
            case("SPACES", "run.resources", "fmi2Instantiate returns null"),
            case("RESET", "run.reset", "after fmi2Reset"),
            case("STATE", "run.state", "after fmi2SetFMUstate"),
            case("BYTES", "run.state", "through bytes"),
            case("SHARED", "run.instances", "beside a second instance"),
            case("CLOCK", "run.clock", "communication points are added up"),
            case("TUNABLE", "run.tunable", "fmi2SetReal returns fmi2Error"),
            case("DIRECTIONAL", "run.directional", "fmi2GetDirectionalDerivative returns fmi2Error"),
        ],
        &["--timeout", "5"],
    );
}

#[test]
fn there_is_nothing_to_find_where_there_is_no_fault() {
    let folder = tempfile::tempdir().unwrap();
    let faultless = folder.path().join("faultless.fmu");
    parts("").write(&faultless);
    // A rig, a sampled controller, one with a file in its resources, one with other types of parameters.
    let ours = ["TumQuarterVehicle", "QuanserLqrController", "RecordedRoad", "KogutSasRig"];
    let mut files: Vec<PathBuf> = ours.iter().map(|name| strut::fmus().join(format!("{name}.fmu"))).collect();
    files.push(faultless);
    let python = strut::interpreter();
    let (code, answers) = check(&files, &["--fmpy", python.to_str().unwrap()]);
    for answer in answers.as_array().unwrap() {
        assert_eq!(problems(answer), Vec::<String>::new(), "{}", answer["file"]);
        let done = answer["report"]["done"].to_string();
        for part in [
            "validation of FMPy",
            "a wrong GUID is refused",
            "the same results after fmi2Reset",
            "through bytes",
        ] {
            assert!(done.contains(part), "{part}: {done}");
        }
    }
    assert_eq!(code, 0);
}

#[test]
fn what_is_legal_but_narrow_is_noted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fixed.fmu");
    let mut noted = parts("FIXED");
    noted.xml = noted.xml.replace(" unit=\"m\"", "").replace("description=\"Output\" ", "");
    noted.write(&path);
    let (code, answers) = check(std::slice::from_ref(&path), &["--no-fmpy"]);
    let findings = answers[0]["report"]["findings"].as_array().unwrap();
    let rules: Vec<&str> = findings.iter().map(|finding| finding["rule"].as_str().unwrap()).collect();
    for rule in ["run.fixed", "variables.unit.missing", "variables.description", "binary.platform"] {
        assert!(rules.contains(&rule), "{rule}: {rules:?}");
    }
    assert_eq!((code, answers[0]["problems"].as_u64()), (0, Some(0)), "{findings:#?}");
    let (strict, _) = check(std::slice::from_ref(&path), &["--no-fmpy", "--strict"]);
    assert_eq!(strict, 1);
}

#[test]
fn fmpy_is_heard_and_missed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("unknown.fmu");
    // Known to the schema alone.
    described("<ModelVariables>", "<ModelVariables colour=\"red\">").write(&path);
    let python = strut::interpreter();
    let (code, answers) =
        check(std::slice::from_ref(&path), &["--no-run", "--fmpy", python.to_str().unwrap()]);
    assert_eq!(code, 1);
    let found = problems(&answers[0]);
    assert!(found.len() == 1 && found[0].contains("FMPy") && found[0].contains("colour"), "{found:?}");
    let (code, answers) = check(std::slice::from_ref(&path), &["--no-run", "--fmpy", "no-such-python"]);
    assert_eq!(code, 2);
    assert!(
        answers[0]["unreadable"].as_str().unwrap().contains("`no-such-python` cannot be run"),
        "{answers}"
    );
    let (code, answers) = check(std::slice::from_ref(&path), &["--no-run", "--no-fmpy"]);
    assert_eq!(code, 0);
    assert!(answers[0]["report"]["skipped"].to_string().contains("not wanted"), "{answers}");
}

#[test]
fn what_cannot_be_read_is_told_with_exit_code_2() {
    let folder = tempfile::tempdir().unwrap();
    let text = folder.path().join("text.fmu");
    std::fs::write(&text, "no archive").unwrap();
    let broken = folder.path().join("broken.fmu");
    described("</fmiModelDescription>", "").write(&broken);
    let third = folder.path().join("fmi3.fmu");
    described("fmiVersion=\"2.0\"", "fmiVersion=\"3.0\"").write(&third);
    let files = [text, broken, third, folder.path().join("missing.fmu")];
    let (code, answers) = check(&files, &["--no-fmpy"]);
    assert_eq!(code, 2);
    for (place, part) in
        ["no zip archive", "no well-formed XML", "this is FMI 3.0", "cannot open"].iter().enumerate()
    {
        let told = answers[place]["unreadable"].as_str().unwrap_or_else(|| panic!("{answers}"));
        assert!(told.contains(part), "{told}");
    }
}
