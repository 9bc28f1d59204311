//! A small description with something of everything, and what breaks each rule for it.

use zip::CompressionMethod;

use super::fmus::{FACTS, RULES};
use super::{Case, schema};
use crate::subject::{Parts, parts};

const STATE: &str = "<ScalarVariable name=\"x\" valueReference=\"0\" description=\"State\" causality=\"local\" variability=\"continuous\" initial=\"exact\"><Real unit=\"m\" start=\"0.5\"/></ScalarVariable>";
const END: &str = "</ModelVariables>";

/// The small FMU with elements that it does without elsewhere.
fn rich() -> Parts {
    let mut parts = parts("")
        .with("<BaseUnit m=\"1\"/></Unit>", "<BaseUnit m=\"1\"/><DisplayUnit name=\"mm\" factor=\"1000\"/></Unit>")
        .with(
            "<DefaultExperiment",
            "<LogCategories><Category name=\"logAll\" description=\"All\"/></LogCategories><DefaultExperiment",
        )
        .with("<ModelVariables>", "<VendorAnnotations><Tool name=\"tool\"><Any/></Tool></VendorAnnotations><ModelVariables>")
        .with(
            "<ModelExchange modelIdentifier=\"Faulty\" canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\"/>",
            "<ModelExchange modelIdentifier=\"Faulty\" canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\">\
             <SourceFiles><File name=\"all.c\"/></SourceFiles></ModelExchange>",
        )
        .with(
            "<Real unit=\"m\" start=\"0\"/></ScalarVariable>",
            "<Real unit=\"m\" start=\"0\"/><Annotations><Tool name=\"tool\"/></Annotations></ScalarVariable>",
        );
    parts.files.push(("sources/all.c".into(), Vec::new(), CompressionMethod::Deflated));
    parts
}

/// Its description.
pub fn xml() -> String {
    rich().xml
}

/// The FMU with another description.
pub fn of(xml: &str) -> Vec<u8> {
    rich().bytes_with(xml.as_bytes())
}

pub fn good() -> Case {
    Case::fmu("small", "", rich().bytes())
}

/// A variable more, at the end.
fn more(attributes: &str, inner: &str) -> Parts {
    let variable = format!(
        "<ScalarVariable name=\"extra\" valueReference=\"50\" description=\"More\" {attributes}>{inner}</ScalarVariable>"
    );
    rich().with(END, &format!("{variable}{END}"))
}

fn without_interface(name: &str) -> Parts {
    let mut parts = rich();
    let start = parts.xml.find(&format!("<{name} ")).unwrap();
    let rest = &parts.xml[start..];
    let line = rest.find('\n').unwrap();
    parts.xml = format!("{}{}", &parts.xml[..start], &rest[line + 1..]);
    parts
}

pub fn all() -> Vec<Case> {
    let of_schema = schema::all(&rich().xml, &RULES, &FACTS);
    let mut cases: Vec<Case> = of_schema
        .into_iter()
        .map(|(what, rule, xml)| Case::fmu(what, rule, Parts { xml, ..rich() }.bytes()))
        .collect();
    let changed = |from: &str, to: &str| rich().with(from, to);
    let real = |attributes: &str| {
        more("causality=\"local\" variability=\"continuous\"", &format!("<Real unit=\"m\" {attributes}/>"))
    };
    let spoilt: Vec<(&'static str, Parts)> = vec![
        ("description.identifier", changed("modelIdentifier=\"Faulty\"", "modelIdentifier=\"2-Faulty\"")),
        ("description.guid", changed("guid=\"{faulty}\"", "guid=\" \"")),
        ("description.date", changed("guid=", "generationDateAndTime=\"2026-11-26T08:00:00+01:00\" guid=")),
        ("description.interfaces.twice", changed("<CoSimulation", "<CoSimulation modelIdentifier=\"Faulty\"/><CoSimulation")),
        ("description.encoding.named", changed(" encoding=\"UTF-8\"", "")),
        ("description.encoding", changed("encoding=\"UTF-8\"", "encoding=\"ISO-8859-1\"")),
        ("description.encoding.version", changed("version=\"1.0\"", "version=\"1.1\"")),
        ("description.encoding.mark", changed("<?xml", "\u{feff}<?xml")),
        ("schema.finite", changed("max=\"10\"", "max=\"INF\"")),
        ("schema.finite", changed("start=\"0.5\"", "start=\"NaN\"")),
        ("description.twice.unit", changed("<Unit name=\"m/s\">", "<Unit name=\"m\">")),
        ("description.twice.display", changed("<DisplayUnit name=\"mm\" factor=\"1000\"/>", "<DisplayUnit name=\"mm\"/><DisplayUnit name=\"mm\"/>")),
        ("description.twice.type", changed("<SimpleType name=\"Kind\">", "<SimpleType name=\"Kind\"><Real/></SimpleType><SimpleType name=\"Kind\">")),
        ("description.type.name", changed("<SimpleType name=\"Kind\">", "<SimpleType name=\"rate\"><Real/></SimpleType><SimpleType name=\"Kind\">")),
        ("description.twice.value", changed("value=\"2\"", "value=\"1\"")),
        ("description.twice.item", changed("name=\"Two\"", "name=\"One\"")),
        ("description.twice.category", changed("<Category name=\"logAll\" description=\"All\"/>", "<Category name=\"logAll\"/><Category name=\"logAll\"/>")),
        ("description.twice.tool", changed("<Tool name=\"tool\"><Any/></Tool>", "<Tool name=\"tool\"/><Tool name=\"tool\"/>")),
        ("description.experiment", changed("stopTime=\"1\"", "stopTime=\"0\"")),
        ("description.experiment", changed("stepSize=\"0.01\"", "stepSize=\"-0.01\"")),
        ("description.serialize", changed("canGetAndSetFMUstate=\"true\" canSerialize", "canGetAndSetFMUstate=\"false\" canSerialize")),
        ("variables.unit", changed("<Real unit=\"m\"/>", "<Real unit=\"ell\"/>")),
        ("variables.unit", changed("<SimpleType name=\"Kind\">", "<SimpleType name=\"Length\"><Real unit=\"ell\"/></SimpleType><SimpleType name=\"Kind\">")),
        ("variables.unit.display", real("").with("<Real unit=\"m\" />", "<Real displayUnit=\"mm\"/>")),
        ("variables.unit.factor", changed("factor=\"1000\"", "factor=\"0\"")),
        ("variables.name", changed("name=\"rate\"", "name=\"offset\"")),
        ("variables.name.empty", changed("name=\"rate\"", "name=\"\"")),
        ("variables.name.case", changed("name=\"rate\"", "name=\"OFFSET\"")),
        ("variables.name.structured", changed("name=\"rate\"", "name=\"a-rate\"")),
        ("variables.name.array", changed("name=\"u\"", "name=\"v[2]\"").with("name=\"y\"", "name=\"v[1]\"")),
        ("variables.reference", more("causality=\"parameter\" variability=\"fixed\"", "<Real unit=\"m\" start=\"0\"/>").with("\"50\"", "\"5\"")),
        ("variables.reference.start", changed(END, &format!("{}{END}", STATE.replace("name=\"x\"", "name=\"same\"")))),
        ("variables.reference.constant", more("causality=\"local\" variability=\"constant\"", "<Real unit=\"m\" start=\"0\"/>").with("\"50\"", "\"3\"")),
        ("variables.reference.unit", real("").with("\"50\"", "\"1\"")),
        ("variables.causality", changed("variability=\"fixed\"", "variability=\"discrete\"")),
        ("variables.causality.initial", changed("variability=\"fixed\" initial=\"exact\"", "variability=\"fixed\" initial=\"approx\"")),
        ("variables.causality.continuous", more("causality=\"local\"", "<Integer/>")),
        ("variables.causality.independent", more("causality=\"independent\" variability=\"continuous\"", "<Integer/>")),
        (
            "variables.causality.independent",
            more("causality=\"independent\"", "<Real/>").with(END, &format!("<ScalarVariable name=\"t\" valueReference=\"51\" causality=\"independent\"><Real/></ScalarVariable>{END}")),
        ),
        ("variables.start", changed(" start=\"0.5\"", "")),
        ("variables.start", changed("start=\"0\" min", "min")),
        ("variables.start.superfluous", more("causality=\"independent\"", "<Real start=\"0\"/>")),
        ("variables.start.superfluous", changed("initial=\"calculated\"><Real unit=\"m\"/>", "initial=\"calculated\"><Real unit=\"m\" start=\"0\"/>")),
        (
            "variables.start.item",
            more("causality=\"parameter\" variability=\"fixed\"", "<Enumeration declaredType=\"Kind\" start=\"3\"/>"),
        ),
        ("variables.bounds", changed("min=\"-10\" max=\"10\"", "min=\"10\" max=\"-10\"")),
        ("variables.bounds.start", changed("start=\"0\" min=\"-10\"", "start=\"-11\" min=\"-10\"")),
        ("variables.nominal", real("nominal=\"0\"")),
        ("variables.type", real("declaredType=\"Other\"")),
        ("variables.type.kind", real("declaredType=\"Kind\"")),
        ("variables.derivative", real("derivative=\"99\"")),
        ("variables.derivative", real("derivative=\"7\"")),
        ("variables.derivative", changed("<Real unit=\"m\" start=\"0.5\"/>", "<Real unit=\"m\" start=\"0.5\" derivative=\"2\"/>")),
        ("variables.derivative.continuous", real("derivative=\"5\"")),
        ("variables.derivative.unit", changed("<Unit name=\"m/s\"><BaseUnit m=\"1\" s=\"-1\"/>", "<Unit name=\"m/s\"><BaseUnit m=\"1\" s=\"-2\"/>")),
        ("variables.derivative.name", changed("name=\"u\"", "name=\"z\"").with("name=\"der(x)\"", "name=\"der(z)\"")),
        ("variables.reinit", real("reinit=\"true\"")),
        ("variables.multiple", more("causality=\"local\" canHandleMultipleSetPerTimeInstant=\"false\"", "<Real unit=\"m\"/>")),
        ("variables.unit.missing", changed("<Real unit=\"m\"/>", "<Real/>")),
        ("variables.description", changed("description=\"Output\" ", "")),
        ("structure.outputs.missing", changed("<Outputs><Unknown index=\"4\" dependencies=\"\"/></Outputs>", "")),
        ("structure.outputs.other", changed("<Outputs>", "<Outputs><Unknown index=\"3\"/>")),
        ("structure.derivatives.missing", changed("<Derivatives><Unknown index=\"2\" dependencies=\"3\"/></Derivatives>", "")),
        ("structure.derivatives.other", changed("<Derivatives>", "<Derivatives><Unknown index=\"1\"/>")),
        ("structure.derivatives.state", changed("derivative=\"1\"", "derivative=\"3\"")),
        (
            "structure.derivatives.twice",
            more("causality=\"local\"", "<Real unit=\"m/s\" derivative=\"1\"/>").with("<Derivatives>", "<Derivatives><Unknown index=\"7\"/>"),
        ),
        ("structure.initial.missing", changed("<Unknown index=\"4\" dependencies=\"1 6\"/>", "")),
        ("structure.initial.other", changed("<InitialUnknowns>", "<InitialUnknowns><Unknown index=\"1\"/>")),
        ("structure.order", changed("<InitialUnknowns>", "<InitialUnknowns><Unknown index=\"4\"/>")),
        ("structure.entry", changed("<Unknown index=\"4\" dependencies=\"\"/>", "<Unknown index=\"44\"/>")),
        ("structure.entry", changed("<Unknown index=\"4\" dependencies=\"\"/>", "<Unknown index=\"0\"/>")),
        ("structure.entry.twice", changed("<Outputs>", "<Outputs><Unknown index=\"4\"/>")),
        ("structure.dependencies", changed("<Unknown index=\"4\" dependencies=\"\"/>", "<Unknown index=\"4\"/>")),
        ("structure.dependencies.index", changed("dependencies=\"3\"", "dependencies=\"33\"")),
        ("structure.dependencies.order", changed("dependencies=\"1 3 5\"", "dependencies=\"1 5 3\"")),
        ("structure.dependencies.order", changed("dependencies=\"1 3 5\"", "dependencies=\"1 3 3\"")),
        ("structure.dependencies.known", changed("dependencies=\"3\"", "dependencies=\"4\"")),
        ("structure.dependencies.known", changed("dependencies=\"1 3 5\"", "dependencies=\"1 3 4\"")),
        ("structure.kinds", changed("dependencies=\"3\"", "dependencies=\"3\" dependenciesKind=\"fixed fixed\"")),
        ("structure.kinds", changed("<Unknown index=\"4\" dependencies=\"\"/>", "<Unknown index=\"4\" dependenciesKind=\"fixed\"/>")),
        (
            "structure.kinds.real",
            more("causality=\"output\" variability=\"discrete\" initial=\"exact\"", "<Integer start=\"0\"/>")
                .with("<Outputs>", "<Outputs><Unknown index=\"7\" dependencies=\"3\" dependenciesKind=\"constant\"/>"),
        ),
        ("structure.kinds.initial", changed("dependencies=\"1 6\"", "dependencies=\"1 6\" dependenciesKind=\"constant fixed\"")),
        ("binary.name", changed("modelIdentifier=\"Faulty\"", "modelIdentifier=\"Other\"")),
        ("archive.sources", changed("name=\"all.c\"", "name=\"none.c\"")),
        ("description.interfaces", without_interface("ModelExchange").with("<CoSimulation modelIdentifier=\"Faulty\" canHandleVariableCommunicationStepSize=\"true\" canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\" providesDirectionalDerivative=\"true\"/>", "")),
        ("variables.reinit", without_interface("ModelExchange").with("start=\"0.5\"", "start=\"0.5\" reinit=\"true\"")),
        ("variables.multiple", without_interface("ModelExchange").with("causality=\"input\"", "causality=\"input\" canHandleMultipleSetPerTimeInstant=\"false\"")),
    ];
    cases.extend(
        spoilt
            .into_iter()
            .map(|(rule, parts)| Case::fmu(format!("description, {rule}"), rule, parts.bytes())),
    );
    // What is no text in UTF-8.
    let mut latin = rich().xml.into_bytes();
    let place = latin.windows(5).position(|it| it == b"State").unwrap();
    latin[place] = 0xe4;
    let wide: Vec<u8> = format!("\u{feff}{}", rich().xml).encode_utf16().flat_map(u16::to_le_bytes).collect();
    for (what, bytes) in [("Latin-1", latin), ("UTF-16", wide)] {
        cases.push(Case::fmu(what, "description.encoding", rich().bytes_with(&bytes)));
    }
    cases
}
