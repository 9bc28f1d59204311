//! A small system, and what breaks each rule for it: its description, its values, its mapping, its dictionary, its archive.

use super::Case;
use super::archives::{FLAGS, METHOD, VERSION, patched};
use super::schema::{self, Facts};
use crate::ssp::{DESCRIPTION, FMU, SIGNALS, Ssp, VALUES, faultless, replaced, with, without};

const MAPPING: &str = "resources/mapping.ssm";

const RULES: schema::Rules = [
    "system.schema.element",
    "system.schema.order",
    "system.schema.missing",
    "system.schema.attribute",
    "system.schema.required",
    "system.schema.value",
    "system.schema.text",
];

const FACTS: Facts = Facts {
    required: &[
        ("SystemStructureDescription", "name"),
        ("ParameterSet", "name"),
        ("ParameterSet", "version"),
        ("ParameterMapping", "version"),
        ("SignalDictionary", "name"),
        ("SignalDictionary", "version"),
        ("System", "name"),
        ("Component", "name"),
        ("Component", "source"),
        ("SignalDictionaryReference", "name"),
        ("SignalDictionaryReference", "dictionary"),
        ("Connector", "name"),
        ("Connector", "kind"),
        ("Connection", "startConnector"),
        ("Connection", "endConnector"),
        ("Unit", "name"),
        ("Parameter", "name"),
        ("MappingEntry", "source"),
        ("MappingEntry", "target"),
        ("DictionaryEntry", "name"),
    ],
    typed: &[
        "kind",
        "implementation",
        "sourceBase",
        "suppressUnitConversion",
        "factor",
        "offset",
        "m",
        "kg",
        "s",
    ],
    single: &[
        "Connectors",
        "ParameterBindings",
        "Elements",
        "Connections",
        "SignalDictionaries",
        "Units",
        "Parameters",
        "BaseUnit",
        "LinearTransformation",
    ],
    needed: &["BaseUnit", "Parameters"],
    open: &[],
    free: &["Elements"],
};

pub fn good() -> Case {
    Case::ssp("small", "", faultless().bytes())
}

pub fn all() -> Vec<Case> {
    let mut cases = Vec::new();
    for (file, text) in [
        (DESCRIPTION, include_str!("../SystemStructure.ssd")),
        (VALUES, include_str!("../first.ssv")),
        (MAPPING, include_str!("../mapping.ssm")),
        (SIGNALS, include_str!("../signals.ssb")),
    ] {
        // What is in them is for another schema, which is asked where they are files.
        let holders: &[&str] = &["ParameterValues", "ParameterMapping", "SignalDictionary"];
        let open = if file == DESCRIPTION { holders } else { &[] };
        let mutations = schema::all(text, &RULES, &Facts { open, ..FACTS });
        cases.extend(
            mutations
                .into_iter()
                .map(|(what, rule, text)| Case::ssp(what, rule, replaced(file, text.as_bytes()).bytes())),
        );
    }
    let changed = |from: &str, to: &str| with(DESCRIPTION, from, to);
    let value = |to: &str| with(VALUES, "<ssv:Real value=\"1\" unit=\"m\"/>", to);
    let first = "<ssd:Connector name=\"y\" kind=\"output\"/>";
    let connector = |text: &str| changed(first, &format!("{first}{text}"));
    let joined = "<ssd:Connection startConnector=\"drive\" endElement=\"first\" endConnector=\"u\"/>";
    let connection = |text: &str| changed(joined, &format!("{joined}{text}"));
    let driven = |text: &str| {
        changed(
            "name=\"drive\" kind=\"input\"><ssc:Real unit=\"m\"/>",
            &format!("name=\"drive\" kind=\"input\">{text}"),
        )
    };
    let transformed = |text: &str| changed("<ssc:LinearTransformation factor=\"0.001\"/>", text);
    let unit = "<ssc:Unit name=\"kg\"><ssc:BaseUnit kg=\"1\"/></ssc:Unit>";
    let dictionary = "<ssd:SignalDictionary name=\"signals\" source=\"resources/signals.ssb\"/>";
    let spoilt: Vec<(&'static str, Ssp)> = vec![
        ("system.source", changed("Faulty%20one", "Gone")),
        ("system.source", replaced(FMU, b"nothing")),
        ("system.version", changed("version=\"1.0\" name=\"faulty\"", "version=\"1.1\" name=\"faulty\"")),
        ("system.version", with(MAPPING, "version=\"1.0\">", "version=\"one\">")),
        (
            "system.twice.id",
            changed("<ssd:Connector name=\"in\"", "<ssd:Connector id=\"a\" name=\"in\"").also(
                DESCRIPTION,
                "<ssd:Connector name=\"out\"",
                "<ssd:Connector id=\"a\" name=\"out\"",
            ),
        ),
        ("system.schema.value", changed("<ssd:Connector name=\"in\"", "<ssd:Connector id=\"1\" name=\"in\"")),
        ("system.twice.unit", changed(unit, &format!("{unit}{unit}"))),
        (
            "system.twice.enumeration",
            changed(
                "<ssd:Units>",
                "<ssd:Enumerations><ssc:Enumeration name=\"e\"><ssc:Item name=\"a\" value=\"1\"/></ssc:Enumeration>\
                 <ssc:Enumeration name=\"e\"><ssc:Item name=\"a\" value=\"1\"/></ssc:Enumeration></ssd:Enumerations><ssd:Units>",
            ),
        ),
        (
            "system.enumeration",
            connector(
                "<ssd:Connector name=\"x\" kind=\"output\"><ssc:Enumeration name=\"e\"/></ssd:Connector>",
            ),
        ),
        ("system.unit.declared", driven("<ssc:Real unit=\"ell\"/>")),
        (
            "system.transformation",
            transformed(
                "<ssc:IntegerMappingTransformation><ssc:MapEntry source=\"1\" target=\"2\"/></ssc:IntegerMappingTransformation>",
            ),
        ),
        (
            "system.transformation.twice",
            transformed(
                "<ssc:IntegerMappingTransformation><ssc:MapEntry source=\"1\" target=\"2\"/><ssc:MapEntry source=\"1\" target=\"3\"/>\
                 </ssc:IntegerMappingTransformation>",
            ),
        ),
        ("system.encoding", with(VALUES, "encoding=\"UTF-8\"", "encoding=\"ISO-8859-1\"")),
        ("system.encoding", changed("<?xml version=\"1.0\"", "<?xml version=\"1.1\"")),
        (
            "system.schema.element",
            changed("xmlns:ssd=\"http://ssp-standard.org/SSP1/", "xmlns:ssd=\"http://ssp-standard.org/SSP9/"),
        ),
        (
            "system.geometry",
            changed(
                "</ssd:SignalDictionaries>",
                "</ssd:SignalDictionaries><ssd:SystemGeometry x1=\"1\" y1=\"0\" x2=\"0\" y2=\"1\"/>",
            ),
        ),
        (
            "system.name",
            changed("<ssd:System name=\"inner\">", "<ssd:System name=\"first\"/><ssd:System name=\"inner\">"),
        ),
        ("system.name.connector", connector(first)),
        ("system.name.dictionary", changed(dictionary, &format!("{dictionary}{dictionary}"))),
        ("system.name.signal", with(SIGNALS, "name=\"lift\"", "name=\"way\"")),
        ("system.connector", connector("<ssd:Connector name=\"ofset\" kind=\"parameter\"/>")),
        ("system.connector.kind", connector("<ssd:Connector name=\"offset\" kind=\"input\"/>")),
        ("system.connector.kind", connector("<ssd:Connector name=\"offset\" kind=\"inout\"/>")),
        (
            "system.connector.type",
            connector("<ssd:Connector name=\"offset\" kind=\"parameter\"><ssc:Integer/></ssd:Connector>"),
        ),
        (
            "system.connector.unit",
            connector(
                "<ssd:Connector name=\"offset\" kind=\"parameter\"><ssc:Real unit=\"mm\"/></ssd:Connector>",
            ),
        ),
        (
            "system.connection",
            connection(
                "<ssd:Connection startElement=\"third\" startConnector=\"y\" endConnector=\"result\"/>",
            ),
        ),
        (
            "system.connection.kinds",
            connection(
                "<ssd:Connection startElement=\"first\" startConnector=\"y\" endConnector=\"drive\"/>",
            ),
        ),
        ("system.twice", connection(joined)),
        ("system.type", driven("<ssc:Boolean/>")),
        ("system.unit", driven("<ssc:Real unit=\"kg\"/>")),
        ("system.dictionary", without(SIGNALS)),
        (
            "system.dictionary.reference",
            changed("name=\"tap\" dictionary=\"signals\"", "name=\"tap\" dictionary=\"none\""),
        ),
        ("system.parameters", without(VALUES)),
        ("system.parameters", with(VALUES, "</ssv:Parameters>", "")),
        (
            "system.parameters.both",
            changed("<ssd:ParameterBinding>", "<ssd:ParameterBinding source=\"resources/first.ssv\">"),
        ),
        ("system.parameter", with(VALUES, "name=\"rate\"", "name=\"rat\"")),
        ("system.parameter.taken", with(VALUES, "name=\"rate\"", "name=\"y\"")),
        ("system.parameter.twice", with(VALUES, "name=\"rate\"", "name=\"u\"")),
        ("system.parameter.type", value("<ssv:Boolean value=\"true\"/>")),
        ("system.parameter.unit", value("<ssv:Real value=\"1\" unit=\"1/s\"/>")),
        ("system.parameter.bounds", value("<ssv:Real value=\"11\" unit=\"m\"/>")),
        (
            "system.parameter.mapped",
            with(
                MAPPING,
                "</ssm:ParameterMapping>",
                "<ssm:MappingEntry source=\"their.shift\" target=\"offset\"/></ssm:ParameterMapping>",
            ),
        ),
        ("system.archive.prefix", faultless().with_file("binaries/more.so")),
        ("system.archive.documentation", faultless().with_file("documentation/more.html")),
        ("system.archive.path", faultless().with_file("resources\\more.ssv")),
    ];
    cases.extend(
        spoilt.into_iter().map(|(rule, ssp)| Case::ssp(format!("system, {rule}"), rule, ssp.bytes())),
    );
    // `first` wants an interface that its FMU does not have.
    let only = crate::subject::described(
        "<ModelExchange modelIdentifier=\"Faulty\" canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\"/>",
        "",
    );
    let exchange = changed("implementation=\"CoSimulation\"", "implementation=\"ModelExchange\"")
        .and(FMU, &only.bytes());
    cases.push(Case::ssp("interface", "system.implementation", exchange.bytes()));
    let values = |patch: &dyn Fn(&mut [u8])| patched(faultless().bytes(), "resources/mapped.ssv", patch);
    let named = faultless().with_file("resources/Räder.ssv").bytes();
    for (what, rule, bytes) in [
        ("compressed", "system.archive.compression", values(&|entry| entry[METHOD] = 12)),
        ("encrypted", "system.archive.encryption", values(&|entry| entry[FLAGS] |= 1)),
        ("newer", "system.archive.version", values(&|entry| entry[VERSION] = 45)),
        ("letters", "system.archive.names", patched(named, "resources/R", |entry| entry[FLAGS + 1] &= !8)),
    ] {
        cases.push(Case::ssp(what, rule, bytes));
    }
    cases.push(Case { ending: "zip", ..Case::ssp("ending", "system.archive.ending", faultless().bytes()) });
    cases
}
