//! `build-fmu check` of systems: nothing on one without fault, and each rule on one that breaks it.

use std::path::PathBuf;

use crate::ssp::{
    DESCRIPTION, FMU, Ssp, VALUES, each_has_its_problem, faultless, of, replaced, with, without,
};
use crate::subject::{check, described, parts, problems};

#[test]
fn each_rule_for_systems_finds_what_breaks_it() {
    // A connector more, a connection more, a component more.
    let connector = |text: &str| {
        let first = "<ssd:Connector name=\"y\" kind=\"output\"/>";
        with(DESCRIPTION, first, &format!("{first}{text}"))
    };
    let connection = |text: &str| {
        let first = "<ssd:Connection startConnector=\"drive\" endElement=\"first\" endConnector=\"u\"/>";
        with(DESCRIPTION, first, &format!("{first}<ssd:Connection {text}/>"))
    };
    let component = |text: &str| {
        let first = "<ssd:System name=\"inner\">";
        with(
            DESCRIPTION,
            first,
            &format!("<ssd:Component source=\"resources/Faulty one.fmu\" {text}/>{first}"),
        )
    };
    let drive = |to: &str| with(DESCRIPTION, "name=\"drive\" kind=\"input\"><ssc:Real unit=\"m\"/>", to);
    let driven = "name=\"drive\" kind=\"input\">";
    let mut exchange = parts("");
    let lines = exchange.xml.lines().filter(|line| !line.contains("<CoSimulation"));
    exchange.xml = lines.collect::<Vec<_>>().join("\n");
    let transformed = "endConnector=\"out\" suppressUnitConversion=\"true\"";
    let cases = [
        ("gone", with(DESCRIPTION, "Faulty%20one", "Gone"), "system.source", "made of `resources/Gone.fmu`"),
        ("no-fmu", replaced(FMU, b"nothing"), "system.source", "cannot be checked: it is no zip archive"),
        ("fmu", of(&described("guid=\"{faulty}\"", "guid=\"\"")), "description.guid", "the guid is empty"),
        ("exchange", of(&exchange), "system.implementation", "`first` is to be used by CoSimulation"),
        ("no-name", component("name=\"\""), "system.schema.value", "`` is no value for the attribute `name`"),
        ("two", component("name=\"first\""), "system.name", "two elements of the name `first`"),
        (
            "two-connectors",
            connector("<ssd:Connector name=\"y\" kind=\"output\"/>"),
            "system.name",
            "`first` has two connectors of the name `y`",
        ),
        (
            "no-variable",
            connector("<ssd:Connector name=\"ofset\" kind=\"parameter\"/>"),
            "system.connector",
            "`first.ofset` is no variable",
        ),
        (
            "no-kind",
            connector("<ssd:Connector name=\"offset\" kind=\"sensor\"/>"),
            "system.schema.value",
            "`sensor` is no value for the attribute `kind` of <Connector>",
        ),
        (
            "kind",
            connector("<ssd:Connector name=\"offset\" kind=\"input\"/>"),
            "system.connector",
            "its variable has the causality \"parameter\"",
        ),
        (
            "connector-type",
            connector("<ssd:Connector name=\"offset\" kind=\"parameter\"><ssc:Integer/></ssd:Connector>"),
            "system.connector",
            "`first.offset` is of type Integer, but its variable is Real",
        ),
        (
            "connector-unit",
            connector(
                "<ssd:Connector name=\"offset\" kind=\"parameter\"><ssc:Real unit=\"mm\"/></ssd:Connector>",
            ),
            "system.connector",
            "`first.offset` has the unit \"mm\", but its variable has \"m\"",
        ),
        (
            "no-element",
            connection("startElement=\"third\" startConnector=\"y\" endConnector=\"result\""),
            "system.connection",
            "ends at the element `third`",
        ),
        (
            "no-connector",
            connection("startElement=\"inner\" startConnector=\"y\" endConnector=\"result\""),
            "system.connection",
            "ends at `inner.y`, which is no connector",
        ),
        (
            "both-give",
            connection("startElement=\"first\" startConnector=\"y\" endConnector=\"drive\""),
            "system.connection",
            "`first.y` and `drive` are connected, and both give a value",
        ),
        (
            "both-take",
            connection(
                "startElement=\"first\" startConnector=\"u\" endElement=\"inner\" endConnector=\"in\"",
            ),
            "system.connection",
            "both take a value",
        ),
        (
            "parameter",
            with(
                DESCRIPTION,
                "<ssd:Connector name=\"result\" kind=\"output\">",
                "<ssd:Connector name=\"result\" kind=\"calculatedParameter\">",
            ),
            "system.connection",
            "one is a parameter and the other a signal",
        ),
        (
            "twice",
            connection("endElement=\"first\" endConnector=\"y\" startElement=\"first\" startConnector=\"u\""),
            "system.twice",
            "`first.u` is connected twice",
        ),
        ("type", drive(&format!("{driven}<ssc:Boolean/>")), "system.type", "leads from Boolean to Real"),
        (
            "unit",
            drive(&format!("{driven}<ssc:Real unit=\"kg\"/>")),
            "system.unit",
            "leads from \"kg\" to \"m\"",
        ),
        (
            "scale",
            drive(&format!("{driven}<ssc:Real unit=\"mm\"/>")),
            "system.unit",
            "leads from \"mm\" to \"m\", which not every tool converts",
        ),
        (
            "unknown-unit",
            drive(&format!("{driven}<ssc:Real unit=\"furlong\"/>")),
            "system.unit",
            "nothing tells how these units compare",
        ),
        (
            "converted-twice",
            with(DESCRIPTION, transformed, "endConnector=\"out\""),
            "system.unit",
            "by a transformation of its own, which tools apply after converting",
        ),
    ];
    each_has_its_problem(&cases);
}

#[test]
fn there_is_nothing_to_find_in_systems_without_fault() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("faultless.ssp");
    std::fs::write(&path, faultless().bytes()).unwrap();
    let python = strut::interpreter();
    let options = ["--fmpy", python.to_str().unwrap()];
    let (code, answers) = check(std::slice::from_ref(&path), &options);
    // Past the schema, FMPy 0.3 stumbles over the first signal dictionary, whatever is in it.
    let found = problems(&answers[0]);
    assert!(found.len() == 1 && found[0].ends_with("has no attribute 'type'"), "{found:?}");
    assert_eq!(code, 1);
    let (code, answers) = check(&[path], &["--no-fmpy"]);
    assert_eq!((code, problems(&answers[0])), (0, Vec::new()));
    assert_eq!(answers[0]["report"]["about"][1], "2 components of 1 FMU");
    let done = answers[0]["report"]["done"].to_string();
    for part in [
        "resources/Faulty one.fmu: co-simulation: the same results after fmi2Reset",
        "system: schema, 12 connectors, 7 connections, 6 parameter values, 3 dictionary signals",
    ] {
        assert!(done.contains(part), "{part}: {done}");
    }
    // Ours: their FMUs are run elsewhere.
    let ours = ["quanser-lqr", "full-car-modal-skyhook", "sas"];
    let files: Vec<PathBuf> = ours.iter().map(|name| strut::fmus().join(format!("{name}.ssp"))).collect();
    let (code, answers) = check(&files, &[&["--no-run"], &options[..]].concat());
    for answer in answers.as_array().unwrap() {
        assert_eq!(problems(answer), Vec::<String>::new(), "{}", answer["file"]);
    }
    assert_eq!(code, 0);
}

#[test]
fn the_schema_of_systems_is_heard() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("unknown.ssp");
    // Known to both.
    let ssp =
        with(DESCRIPTION, "<ssd:System name=\"faulty\">", "<ssd:System name=\"faulty\" colour=\"red\">");
    std::fs::write(&path, ssp.bytes()).unwrap();
    let python = strut::interpreter();
    let (code, answers) = check(&[path], &["--no-run", "--fmpy", python.to_str().unwrap()]);
    let found = problems(&answers[0]);
    let [own, theirs] = ["system.schema.attribute", "fmpy"]
        .map(|rule| found.iter().filter(|it| it.starts_with(rule) && it.contains("colour")).count());
    assert_eq!((own, theirs, found.len()), (1, 1, 2), "{found:?}");
    assert_eq!(code, 1);
}

#[test]
fn what_is_not_looked_into_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let first = "name=\"first\" type=\"application/x-fmu-sharedlibrary\"";
    let cases = [
        (
            of(&described("fmiVersion=\"2.0\"", "fmiVersion=\"3.0\"")),
            "resources/Faulty one.fmu: this is FMI 3.0",
        ),
        (with(DESCRIPTION, first, "name=\"first\" type=\"application/x-ssp-package\""), "and no FMU"),
        (
            with(DESCRIPTION, "version=\"1.0\" name=\"faulty\"", "version=\"2.0\" name=\"faulty\""),
            "this is 2.0",
        ),
    ];
    let files: Vec<PathBuf> =
        (0..cases.len()).map(|index| folder.path().join(format!("{index}.ssp"))).collect();
    for (path, (ssp, _)) in files.iter().zip(&cases) {
        std::fs::write(path, ssp.bytes()).unwrap();
    }
    let (code, answers) = check(&files, &["--no-run", "--no-fmpy"]);
    for (answer, (_, told)) in answers.as_array().unwrap().iter().zip(&cases) {
        assert_eq!(problems(answer), Vec::<String>::new(), "{told}");
        let skipped = answer["report"]["skipped"].to_string();
        assert!(skipped.contains(told), "{told}: {skipped}");
    }
    assert_eq!(code, 0);
}

#[test]
fn where_it_is_stands_beside_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str, ssp: &Ssp| {
        let path = folder.path().join(name);
        std::fs::write(&path, ssp.bytes()).unwrap();
        let (_, answers) = check(&[path], &["--no-run", "--no-fmpy"]);
        let findings = answers[0]["report"]["findings"].as_array().unwrap().clone();
        let problem = findings.iter().find(|finding| finding["level"] != "note").unwrap();
        problem["place"].as_str().unwrap().to_owned()
    };
    let fmu = place("fmu.ssp", &of(&described("max=\"10\"", "max=\"-1\"")));
    assert_eq!(fmu, "resources/Faulty one.fmu/modelDescription.xml:17");
    assert_eq!(place("value.ssp", &with(VALUES, "value=\"1\"", "value=\"one\"")), "resources/first.ssv:5");
    let kind = with(DESCRIPTION, "name=\"result\" kind=\"output\"", "name=\"result\" kind=\"exit\"");
    assert_eq!(place("kind.ssp", &kind), "SystemStructure.ssd:6");
}

#[test]
fn systems_that_cannot_be_read_are_told_with_exit_code_2() {
    let folder = tempfile::tempdir().unwrap();
    let cases = [
        ("broken", with(DESCRIPTION, "</ssd:SystemStructureDescription>", ""), "is no well-formed XML"),
        ("other", replaced(DESCRIPTION, b"<System/>"), "is a `System` and no `SystemStructureDescription`"),
        ("empty", replaced(DESCRIPTION, b"<SystemStructureDescription/>"), "has no <System>"),
        ("neither", without(DESCRIPTION), "neither modelDescription.xml nor SystemStructure.ssd"),
    ];
    let files: Vec<PathBuf> = cases
        .iter()
        .map(|(name, ssp, _)| {
            let path = folder.path().join(format!("{name}.ssp"));
            std::fs::write(&path, ssp.bytes()).unwrap();
            path
        })
        .collect();
    let (code, answers) = check(&files, &["--no-fmpy"]);
    assert_eq!(code, 2);
    for ((name, _, message), answer) in cases.iter().zip(answers.as_array().unwrap()) {
        let told = answer["unreadable"].as_str().unwrap_or_else(|| panic!("{name}: {answer}"));
        assert!(told.contains(message), "{name}: {told}");
    }
}
