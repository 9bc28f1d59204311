//! `build-fmu check`: nothing on our own FMUs and on one without fault, and each rule on one that breaks it.

use std::io::BufRead;
use std::path::PathBuf;

use crate::subject::{Parts, check, described, parts, problems};
use zip::CompressionMethod;

/// Checks FMUs: each has problems of its rule, and no others.
fn each_has_its_problem(cases: &[(&str, Parts, &str, &str)], options: &[&str]) {
    let packed: Vec<_> =
        cases.iter().map(|(name, parts, rule, message)| (*name, parts.bytes(), *rule, *message)).collect();
    crate::subject::each_has_its_problem(&packed, "fmu", options);
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
            ("guid", described("guid=\"{faulty}\"", "guid=\"\""), "description.guid", "the guid is empty"),
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
            (
                "case",
                described("name=\"rate\"", "name=\"U\""),
                "variables.name",
                "`U` and `u` differ only in upper and lower case",
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
                "schema.value",
                "`constant` is no value for the attribute `causality`",
            ),
            ("no-start", without(" start=\"0.5\""), "variables.start", "`x` has no start value"),
            (
                "start",
                described(y, "initial=\"calculated\"><Real unit=\"m\" start=\"1\"/>"),
                "variables.start",
                "`y` has a start value although",
            ),
            ("value", described("start=\"0.5\"", "start=\"half\""), "schema.value", "`half` is no value for"),
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
                without("<Outputs><Unknown index=\"4\" dependencies=\"\"/></Outputs>"),
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
                "structure.dependencies",
                "depends on variable 9",
            ),
            (
                "kinds",
                described("dependencies=\"3\"", "dependencies=\"3\" dependenciesKind=\"constant fixed\""),
                "structure.kinds",
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
    let categories = "<LogCategories><Category name=\"logAll\"/></LogCategories><DefaultExperiment";
    let mut categorised = parts("CATEGORY");
    categorised.xml = categorised.xml.replace("<DefaultExperiment", categories);
    each_has_its_problem(
        &[
            case("GUID", "run.guid", "accepts a wrong GUID"),
            case("VERSION", "run.version", "fmi2GetVersion returns \"2\""),
            case("START", "run.start", "`rate` is 3, not 2"),
            ("category", categorised, "run.logger", "category is null"),
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
            case("DRIFT", "run.state", "of their largest value, more than the tolerance of 1e-4"),
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
    std::fs::write(&faultless, parts("").bytes()).unwrap();
    // A rig, a sampled controller, one with a file in its resources, one with other types of parameters.
    let ours = ["TumQuarterVehicle", "QuanserLqrController", "RecordedRoad", "KogutSasRig"];
    let mut files: Vec<PathBuf> = ours.iter().map(|name| strut::fmus().join(format!("{name}.fmu"))).collect();
    files.push(faultless);
    let python = strut::interpreter();
    let (code, answers) = check(&files, &["--fmpy", python.to_str().unwrap(), "--replay"]);
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

/// A solver that begins anew comes to slightly other values: legal, and told with its size.
#[test]
fn a_restarted_solver_is_noted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("restart.fmu");
    std::fs::write(&path, parts("RESTART").bytes()).unwrap();
    let (code, answers) = check(std::slice::from_ref(&path), &["--no-fmpy"]);
    assert_eq!((code, problems(&answers[0])), (0, Vec::<String>::new()));
    let findings = answers[0]["report"]["findings"].as_array().unwrap();
    let notes: Vec<&str> = findings
        .iter()
        .filter(|it| it["rule"] == "run.state")
        .map(|it| it["message"].as_str().unwrap())
        .collect();
    assert!(notes.len() >= 2, "{findings:#?}");
    assert!(notes.iter().all(|note| note.contains("within the tolerance of 1e-4")), "{notes:#?}");
}

/// Raising the input raises the output; in a system, too.
#[test]
fn signs_of_responses_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let files = [folder.path().join("small.fmu"), folder.path().join("small.ssp")];
    std::fs::write(&files[0], parts("").bytes()).unwrap();
    std::fs::write(&files[1], crate::ssp::faultless().bytes()).unwrap();
    let (_, answers) = check(&files, &["--no-fmpy", "--signs"]);
    for (place, component) in [(0, serde_json::Value::Null), (1, "resources/Faulty one.fmu".into())] {
        let signs = &answers[place]["report"]["signs"];
        let expected = serde_json::json!([{
            "component": component, "input": "u", "by": 0.1, "unit": "m", "duration": 2.0,
            "rise": ["y"], "fall": [], "rest": [],
        }]);
        assert_eq!(signs, &expected, "{signs:#}");
    }
    // A rig whose force pulls body and wheel apart.
    let rig = strut::fmus().join("TumQuarterVehicle.fmu");
    let (_, answers) = check(&[rig], &["--no-fmpy", "--signs"]);
    let signs = answers[0]["report"]["signs"].as_array().unwrap();
    let force = signs.iter().find(|it| it["input"] == "actuator.force").unwrap();
    let has = |list: &str, name: &str| force[list].as_array().unwrap().contains(&name.into());
    assert!(has("rise", "body.acceleration") && has("fall", "wheel.acceleration"), "{force:#}");
}

/// A state of two names, one of which has the derivative.
#[test]
fn one_derivative_of_a_state_is_enough() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("alias.fmu");
    let more = "<ScalarVariable name=\"slope\" valueReference=\"1\" description=\"Alias\"><Real unit=\"m/s\" \
                derivative=\"1\"/></ScalarVariable></ModelVariables>";
    std::fs::write(&path, described("</ModelVariables>", more).bytes()).unwrap();
    let (_, answers) = check(std::slice::from_ref(&path), &["--no-fmpy", "--no-run"]);
    let of_derivatives: Vec<_> =
        problems(&answers[0]).into_iter().filter(|it| it.starts_with("structure.derivatives")).collect();
    assert_eq!(of_derivatives, Vec::<String>::new());
}

/// A hundred thousand variables take seconds, and the square of that would take an hour.
#[test]
fn the_time_of_a_check_grows_with_the_variables_and_no_faster() {
    let folder = tempfile::tempdir().unwrap();
    let many: String = (0..100_000)
        .map(|index| {
            format!(
                "<ScalarVariable name=\"extra.v{index}\" valueReference=\"{}\" description=\"More\">\
                 <Real unit=\"m\"/></ScalarVariable>\n",
                100 + index
            )
        })
        .collect();
    let path = folder.path().join("large.fmu");
    let large = described("</ModelVariables>", &format!("{many}</ModelVariables>"));
    std::fs::write(&path, large.bytes()).unwrap();
    let begin = std::time::Instant::now();
    let (code, answers) = check(std::slice::from_ref(&path), &["--no-fmpy"]);
    assert_eq!((code, problems(&answers[0])), (0, Vec::<String>::new()));
    assert!(answers[0]["report"]["done"].to_string().contains("100006 variables"), "{answers}");
    // A third of a second alone; other tests run beside it.
    assert!(begin.elapsed().as_secs_f64() < 20.0, "{:?}", begin.elapsed());
}

/// Each finding is a line that is out when it is made: a check that is cut off has told what it knows.
#[test]
fn what_was_found_before_a_check_is_cut_off_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hang.fmu");
    let mut parts = parts("HANG");
    parts.xml = parts.xml.replace("stopTime=\"1\"", "stopTime=\"-1\"");
    std::fs::write(&path, parts.bytes()).unwrap();
    let mut child = strut::build_fmu()
        .args(["check", "--json", "--no-fmpy", "--timeout", "600"])
        .arg(&path)
        .stdout(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = std::io::BufReader::new(child.stdout.take().unwrap()).lines();
    let first: serde_json::Value = serde_json::from_str(&lines.next().unwrap().unwrap()).unwrap();
    assert_eq!(first["finding"]["rule"], "description.experiment", "{first}");
    assert!(child.try_wait().unwrap().is_none(), "it is still in the library");
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn what_is_legal_but_narrow_is_noted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fixed.fmu");
    let mut noted = parts("FIXED");
    noted.xml = noted.xml.replace(" unit=\"m\"", "").replace("description=\"Output\" ", "");
    std::fs::write(&path, noted.bytes()).unwrap();
    let (code, answers) = check(std::slice::from_ref(&path), &["--no-fmpy"]);
    let findings = answers[0]["report"]["findings"].as_array().unwrap();
    let rules: Vec<&str> = findings.iter().map(|finding| finding["rule"].as_str().unwrap()).collect();
    for rule in ["run.fixed", "variables.unit.missing", "variables.description", "binary.platform.missing"] {
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
    // Known to both.
    std::fs::write(&path, described("<ModelVariables>", "<ModelVariables colour=\"red\">").bytes()).unwrap();
    let python = strut::interpreter();
    let (code, answers) =
        check(std::slice::from_ref(&path), &["--no-run", "--fmpy", python.to_str().unwrap()]);
    assert_eq!(code, 1);
    let found = problems(&answers[0]);
    let [own, theirs] = ["schema.attribute", "fmpy"]
        .map(|rule| found.iter().filter(|it| it.starts_with(rule) && it.contains("colour")).count());
    assert_eq!((own, theirs, found.len()), (1, 1, 2), "{found:?}");
    let (code, answers) = check(std::slice::from_ref(&path), &["--no-run", "--fmpy", "no-such-python"]);
    assert_eq!(code, 2);
    assert!(
        answers[0]["unreadable"].as_str().unwrap().contains("`no-such-python` cannot be run"),
        "{answers}"
    );
    let (code, answers) = check(std::slice::from_ref(&path), &["--no-run", "--no-fmpy"]);
    assert_eq!((code, problems(&answers[0]).len()), (1, 1));
    assert!(answers[0]["report"]["skipped"].to_string().contains("not wanted"), "{answers}");
}

#[test]
fn what_cannot_be_read_is_told_with_exit_code_2() {
    let folder = tempfile::tempdir().unwrap();
    let text = folder.path().join("text.fmu");
    std::fs::write(&text, "no archive").unwrap();
    let broken = folder.path().join("broken.fmu");
    std::fs::write(&broken, described("</fmiModelDescription>", "").bytes()).unwrap();
    let third = folder.path().join("fmi3.fmu");
    std::fs::write(&third, described("fmiVersion=\"2.0\"", "fmiVersion=\"3.0\"").bytes()).unwrap();
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
