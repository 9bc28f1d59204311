//! `build-fmu check` of what a system brings along: values for its parameters, and signals that its elements share.

use crate::ssp::{DESCRIPTION, SIGNALS, VALUES, each_has_its_problem, replaced, with, with_own, without};
use crate::subject::{check, problems};

#[test]
fn each_rule_for_values_finds_what_breaks_it() {
    let value = |to: &str| with(VALUES, "<ssv:Real value=\"1\" unit=\"m\"/>", to);
    let name = |to: &str| with(VALUES, "name=\"rate\"", &format!("name=\"{to}\""));
    let inline = |to: &str| with(DESCRIPTION, "<ssv:Real value=\"0.25\"/>", to);
    let first = "source=\"resources/first.ssv\"";
    let mapping = |from: &str, to: &str| with("resources/mapping.ssm", from, to);
    let entry = "<ssm:MappingEntry source=\"their.shift\" target=\"offset\"/>";
    let mut latin = include_bytes!("check/first.ssv").to_vec();
    let place = latin.windows(12).position(|it| it == b"name=\"first\"").unwrap();
    latin[place + 6] = 0xe4;
    let cases = [
        (
            "no-values",
            without(VALUES),
            "system.parameters",
            "are in `resources/first.ssv`, which the archive",
        ),
        (
            "broken-values",
            with(VALUES, "</ssv:Parameters>", ""),
            "system.parameters",
            "`resources/first.ssv` is no well-formed XML",
        ),
        (
            "latin-values",
            replaced(VALUES, &latin),
            "system.encoding",
            "resources/first.ssv is not encoded in UTF-8: line 2",
        ),
        (
            "other-values",
            replaced(VALUES, b"<Values/>"),
            "system.parameters",
            "`resources/first.ssv` is a `Values` and no `ParameterSet`",
        ),
        (
            "no-mapping",
            without("resources/mapping.ssm"),
            "system.parameters",
            "are in `resources/mapping.ssm`, which the archive",
        ),
        (
            "mapped",
            with("resources/mapping.ssm", "target=\"offset\"", "target=\"ofset\""),
            "system.parameter",
            "for what is not there: `inner.second.ofset`",
        ),
        (
            "inline",
            with(DESCRIPTION, "inner.second.rate", "inner.third.rate"),
            "system.parameter",
            "for what is not there: `inner.third.rate`",
        ),
        ("no-parameter", name("rat"), "system.parameter", "for what is not there: `first.rat`"),
        ("calculated", name("y"), "system.parameter", "`first.y` is calculated and takes no value"),
        ("two-values", name("u"), "system.parameter", "two values for `u`"),
        (
            "value-type",
            value("<ssv:Boolean value=\"true\"/>"),
            "system.parameter",
            "is Real and is given a Boolean",
        ),
        (
            "no-number",
            value("<ssv:Real value=\"one\"/>"),
            "system.schema.value",
            "`one` is no value for the attribute `value` of <Real>",
        ),
        (
            "bounds",
            value("<ssv:Real value=\"11\" unit=\"m\"/>"),
            "system.parameter",
            "`first.u` is given 11, outside",
        ),
        (
            "value-unit",
            value("<ssv:Real value=\"1\" unit=\"1/s\"/>"),
            "system.parameter",
            "is given in \"1/s\", but declared in \"m\"",
        ),
        (
            "value-scale",
            value("<ssv:Real value=\"1\" unit=\"mm\"/>"),
            "system.parameter",
            "is given in \"mm\", but declared in \"m\"",
        ),
        (
            "no-own-values",
            with(DESCRIPTION, first, "source=\"resources/none.ssv\" sourceBase=\"component\""),
            "system.parameters",
            "are in `resources/none.ssv` of `resources/Faulty one.fmu`, which does not have it",
        ),
        (
            "broken-own-values",
            with_own("</ssv:Parameters>", ""),
            "system.parameters",
            "`resources/Faulty one.fmu/resources/own.ssv` is no well-formed XML",
        ),
        (
            "within-a-system",
            with(
                DESCRIPTION,
                "<ssd:ParameterBinding>",
                "<ssd:ParameterBinding source=\"own.ssv\" sourceBase=\"component\"/><ssd:ParameterBinding>",
            ),
            "system.parameters",
            "values are looked for in a component, but the system is none",
        ),
        (
            "file-and-place",
            with(
                DESCRIPTION,
                "<ssd:ParameterBinding>",
                "<ssd:ParameterBinding source=\"resources/first.ssv\">",
            ),
            "system.parameters",
            "a parameter binding of the system has a file and values in place",
        ),
        (
            "neither",
            with(DESCRIPTION, first, ""),
            "system.parameters",
            "a parameter binding of `first` has neither a file nor values in place",
        ),
        (
            "own-parameter",
            with_own("name=\"offset\"", "name=\"ofset\""),
            "system.parameter",
            "for what is not there: `first.ofset`",
        ),
        (
            "own-type",
            with_own("<ssv:Real value=\"0.5\"/>", "<ssv:Boolean value=\"true\"/>"),
            "system.parameter",
            "`first.offset` is Real and is given a Boolean",
        ),
        (
            "connector-type",
            inline("<ssv:Boolean value=\"true\"/>"),
            "system.parameter",
            "`inner.in` is Real and is given a Boolean",
        ),
        (
            "connector-number",
            inline("<ssv:Real value=\"one\"/>"),
            "system.schema.value",
            "`one` is no value for the attribute `value` of <Real>",
        ),
        (
            "connector-unit",
            with(
                DESCRIPTION,
                "<ssv:Real value=\"0.25\"/></ssv:Parameter>\n            </ssv:Parameters>",
                "<ssv:Real value=\"1\" unit=\"mm\"/></ssv:Parameter>\n            </ssv:Parameters><ssv:Units>\
                 <ssc:Unit name=\"mm\"><ssc:BaseUnit m=\"1\" factor=\"0.001\"/></ssc:Unit></ssv:Units>",
            ),
            "system.parameter",
            "`inner.in` is given in \"mm\", but declared in \"m\"",
        ),
        (
            "calculated-connector",
            with(DESCRIPTION, "name=\"inner.in\"><ssv", "name=\"inner.seen\"><ssv"),
            "system.parameter",
            "`inner.seen` is calculated and takes no value",
        ),
        (
            "mapped-from-nothing",
            mapping("their.shift", "their.shaft"),
            "system.parameter",
            "a mapping takes from what its set does not give: `their.shaft`",
        ),
        (
            "mapped-twice",
            mapping("</ssm:ParameterMapping>", &format!("{entry}</ssm:ParameterMapping>")),
            "system.parameter",
            "two entries of a mapping give to `inner.second.offset`",
        ),
    ];
    each_has_its_problem(&cases);
}

#[test]
fn each_rule_for_signal_dictionaries_finds_what_breaks_it() {
    let declared = "<ssd:SignalDictionary name=\"signals\" source=\"resources/signals.ssb\"/>";
    let declaration = |to: &str| with(DESCRIPTION, declared, to);
    let connector = |text: &str| {
        let first = "<ssd:Connector name=\"way\" kind=\"inout\"><ssc:Real/>";
        with(DESCRIPTION, first, &format!("<ssd:Connector {text}</ssd:Connector>{first}"))
    };
    let inside = "<ssb:SignalDictionary version=\"1.0\"/></ssd:SignalDictionary>";
    let cases = [
        (
            "no-file",
            without(SIGNALS),
            "system.dictionary",
            "signals are in `resources/signals.ssb`, which the",
        ),
        (
            "broken",
            with(SIGNALS, "</ssb:Units>", ""),
            "system.dictionary",
            "`resources/signals.ssb` is no well-formed XML",
        ),
        (
            "other",
            replaced(SIGNALS, b"<Signals/>"),
            "system.dictionary",
            "`resources/signals.ssb` is a `Signals` and no `SignalDictionary`",
        ),
        (
            "neither",
            declaration("<ssd:SignalDictionary name=\"signals\"/>"),
            "system.dictionary",
            "`signals` has neither a file nor signals in place",
        ),
        (
            "file-and-place",
            declaration(&format!("{}>{inside}", declared.trim_end_matches("/>"))),
            "system.dictionary",
            "`signals` has a file and signals in place",
        ),
        (
            "no-dictionary",
            with(DESCRIPTION, "name=\"tap\" dictionary=\"signals\"", "name=\"tap\" dictionary=\"signal\""),
            "system.dictionary",
            "`inner.tap` refers to the signal dictionary `signal`, which there is none of",
        ),
        (
            "two-dictionaries",
            declaration(&format!("{declared}{declared}")),
            "system.name",
            "the system has two signal dictionaries of the name `signals`",
        ),
        (
            "two-signals",
            with(SIGNALS, "name=\"lift\"", "name=\"way\""),
            "system.name",
            "the dictionary `signals` has two signals of the name `way`",
        ),
        (
            "no-signal",
            connector("name=\"weg\" kind=\"inout\">"),
            "system.connector",
            "`inner.tap.weg` is no signal of the dictionary `signals`",
        ),
        (
            "signal-type",
            connector("name=\"number\" kind=\"inout\"><ssc:Real/>"),
            "system.connector",
            "`inner.tap.number` is of type Real, but its signal is Integer",
        ),
        (
            "signal-unit",
            connector("name=\"lift\" kind=\"inout\"><ssc:Real unit=\"m\"/>"),
            "system.connector",
            "`inner.tap.lift` has the unit \"m\", but its signal has \"mm\"",
        ),
        (
            "connected-type",
            with(
                DESCRIPTION,
                "endElement=\"bus\" endConnector=\"way\"",
                "endElement=\"bus\" endConnector=\"number\"",
            ),
            "system.type",
            "leads from Real to Integer",
        ),
        (
            "connected-unit",
            with(SIGNALS, "<ssc:Real unit=\"m\"/>", "<ssc:Real unit=\"kg\"/>"),
            "system.unit",
            "leads from \"m\" to \"kg\"",
        ),
        (
            "given-twice",
            with(
                DESCRIPTION,
                "<ssd:Connection startElement=\"tap\"",
                "<ssd:Connection startElement=\"second\" startConnector=\"y\" endElement=\"tap\" endConnector=\"way\"/>\
                 <ssd:Connection startElement=\"tap\"",
            ),
            "system.twice",
            "the signal `way` of the dictionary `signals` is given twice",
        ),
    ];
    each_has_its_problem(&cases);
}

#[test]
fn values_within_an_fmu_are_found_there() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("own.ssp");
    std::fs::write(&path, with_own("0.5", "0.25").bytes()).unwrap();
    let (code, answers) = check(&[path], &["--no-run", "--no-fmpy"]);
    assert_eq!((code, problems(&answers[0])), (0, Vec::new()));
    let done = answers[0]["report"]["done"].to_string();
    assert!(done.contains("7 parameter values"), "{done}");
}

/// By the table of SSP: what is set once may lead to what is read.
#[test]
fn a_parameter_may_lead_to_an_input() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("parameter.ssp");
    let ssp = with(DESCRIPTION, "name=\"drive\" kind=\"input\"", "name=\"drive\" kind=\"parameter\"");
    std::fs::write(&path, ssp.bytes()).unwrap();
    let (code, answers) = check(&[path], &["--no-run", "--no-fmpy"]);
    assert_eq!((code, problems(&answers[0])), (0, Vec::new()));
}

#[test]
fn signals_may_be_given_in_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("inline.ssp");
    let declared = "<ssd:SignalDictionary name=\"signals\" source=\"resources/signals.ssb\"/>";
    let more = "<ssd:SignalDictionary name=\"states\"><ssb:SignalDictionary version=\"1.0\">\
                <ssb:DictionaryEntry name=\"on\"><ssc:Boolean/></ssb:DictionaryEntry>\
                </ssb:SignalDictionary></ssd:SignalDictionary>";
    std::fs::write(&path, with(DESCRIPTION, declared, &format!("{declared}{more}")).bytes()).unwrap();
    let (code, answers) = check(&[path], &["--no-run", "--no-fmpy"]);
    assert_eq!((code, problems(&answers[0])), (0, Vec::new()));
    let done = answers[0]["report"]["done"].to_string();
    assert!(done.contains("4 dictionary signals"), "{done}");
}
