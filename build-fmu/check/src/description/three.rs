//! The variables of FMI 3.0, as far as a run needs them. FMPy validates the rest of such a description.

use roxmltree::Node;

use super::{Variable, elements, value};
use crate::lines::Lines;

/// The variables of a description, in their order.
pub(super) fn variables(root: Node, lines: &Lines) -> Vec<Variable> {
    let list = elements(root, "ModelVariables").next();
    let variables = list.into_iter().flat_map(|node| node.children().filter(Node::is_element));
    variables.map(|node| variable(node, lines.line(node))).collect()
}

fn variable(node: Node, line: u32) -> Variable {
    let text = |name: &str| node.attribute(name).map(str::to_owned);
    let causality = text("causality").unwrap_or_else(|| "local".into());
    let name = node.tag_name().name();
    let default = match (causality.as_str(), name) {
        ("parameter" | "structuralParameter" | "calculatedParameter", _) => "fixed",
        (_, "Float64" | "Float32") => "continuous",
        _ => "discrete",
    };
    Variable {
        name: text("name").unwrap_or_default(),
        reference: value(node, "valueReference"),
        description: text("description"),
        variability: text("variability").unwrap_or_else(|| default.into()),
        causality,
        initial: text("initial"),
        kind: kind(node),
        start: text("start")
            .or_else(|| elements(node, "Start").next()?.attribute("value").map(str::to_owned)),
        unit: text("unit"),
        display_unit: text("displayUnit"),
        declared_type: text("declaredType"),
        min: value(node, "min"),
        max: value(node, "max"),
        nominal: value(node, "nominal"),
        line,
        ..Variable::default()
    }
}

/// The corresponding type of FMI 2.0; arrays and other widths have none, and keep names of their own.
fn kind(node: Node) -> String {
    let name = node.tag_name().name();
    if elements(node, "Dimension").next().is_some() {
        return format!("array of {name}");
    }
    match name {
        "Float64" => "Real",
        "Int32" => "Integer",
        other => other,
    }
    .to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::{Description, Kind, Version};

    #[test]
    fn variables_of_corresponding_types_are_those_of_fmi_2() {
        let text = r#"<fmiModelDescription fmiVersion="3.0" instantiationToken="{1}">
            <CoSimulation modelIdentifier="m" canSerializeFMUState="true"/>
            <DefaultExperiment stopTime="2"/>
            <ModelVariables>
                <Float64 name="time" valueReference="0" causality="independent"/>
                <Float64 name="k" valueReference="1" causality="parameter" start="3" unit="N/m"/>
                <Float64 name="table" valueReference="2" causality="parameter" start="1 2"><Dimension start="2"/></Float64>
                <Int32 name="n" valueReference="3" causality="input" start="1"/>
                <String name="file" valueReference="4" causality="parameter"><Start value="a.csv"/></String>
                <Int64 name="many" valueReference="5"/>
            </ModelVariables>
        </fmiModelDescription>"#;
        let document = roxmltree::Document::parse(text).unwrap();
        let description = Description::of(document.root_element(), &Lines::of(text)).unwrap();
        assert_eq!(description.runs_as(), Some(Version::Three));
        assert_eq!(description.guid.as_deref(), Some("{1}"));
        assert_eq!(description.experiment.stop, Some(2.0));
        assert!(description.interface(Kind::CoSimulation).unwrap().can("canSerializeFMUState"));
        let kinds: Vec<&str> = description.variables.iter().map(|it| it.kind.as_str()).collect();
        assert_eq!(kinds, ["Real", "Real", "array of Float64", "Integer", "String", "Int64"]);
        let k = description.named("k").unwrap();
        assert_eq!((k.reference, k.variability.as_str(), k.unit.as_deref()), (Some(1), "fixed", Some("N/m")));
        assert_eq!(k.effective_initial(), Some("exact"));
        assert_eq!(description.named("file").unwrap().start.as_deref(), Some("a.csv"));
        assert_eq!(description.named("many").unwrap().variability, "discrete");
    }
}
