//! Rules for what joins elements: both ends are there, signals flow from one to the other, types and units agree.

use std::collections::BTreeMap;

use super::structure::{Connection, Connector, Content, Element, End};
use super::{System, at};
use crate::finding::Finding;
use crate::rules::{practice, ssp};
use crate::unit::Fit;

/// An end of a connection, found.
struct Found<'a> {
    element: &'a Element,
    connector: &'a Connector,
    /// Whether it is the surrounding system's own, which is seen from within.
    within: bool,
}

/// What a connector is to a connection.
#[derive(Clone, Copy, PartialEq)]
enum Role {
    Source,
    Sink,
    Either,
}

impl Found<'_> {
    /// What enters a system from outside comes from its connector, seen from within.
    fn role(&self) -> Role {
        match (self.connector.kind.as_str(), self.within) {
            ("output" | "calculatedParameter", false) | ("input" | "parameter", true) => Role::Source,
            ("input" | "parameter", false) | ("output" | "calculatedParameter", true) => Role::Sink,
            _ => Role::Either,
        }
    }

    /// Whether it is set once, before anything runs.
    fn is_parameter(&self) -> bool {
        self.connector.kind.to_lowercase().ends_with("parameter")
    }

    fn shown(&self) -> String {
        self.element.of(&self.connector.name)
    }
}

impl System {
    /// What is wrong with connections.
    pub(super) fn connections(&self) -> Vec<Finding> {
        let mut findings = Vec::new();
        // What leads to each signal of a dictionary, whichever reference it takes.
        let mut given: BTreeMap<(usize, String), u32> = BTreeMap::new();
        for system in self.structure.root.all() {
            let Content::System { elements, connections, .. } = &system.content else { continue };
            // What leads to each sink, with the line.
            let mut driven: BTreeMap<String, u32> = BTreeMap::new();
            for connection in connections {
                let [start, end] = &connection.ends;
                let ends = (find(system, elements, start), find(system, elements, end));
                let (start, end) = match ends {
                    (Ok(start), Ok(end)) => (start, end),
                    (start, end) => {
                        let missing = [start.err(), end.err()].into_iter().flatten();
                        findings.extend(missing.map(|message| {
                            Finding::error(ssp::CONNECTION_END, message).at(at(connection.line))
                        }));
                        continue;
                    }
                };
                match directed(start, end) {
                    Ok((source, sink)) => {
                        let (first, what) = match self.referred(sink.element) {
                            None => (
                                driven.insert(sink.shown(), connection.line),
                                format!("`{}` is connected twice", sink.shown()),
                            ),
                            Some((number, dictionary)) => {
                                let signal = &sink.connector.name;
                                let what = format!(
                                    "the signal `{signal}` of the dictionary `{dictionary}` is given twice"
                                );
                                (given.insert((number, signal.clone()), connection.line), what)
                            }
                        };
                        if let Some(first) = first {
                            let message = format!("{what}; the other connection is in line {first}");
                            findings.push(
                                Finding::error(ssp::CONNECTION_TWICE, message)
                                    .at(at(connection.line))
                                    .help("let a component add the signals up, or leave one of them out"),
                            );
                        }
                        findings.extend(self.types(connection, &source, &sink));
                        findings.extend(self.units(connection, &source, &sink));
                    }
                    Err(message) => {
                        findings.push(
                            Finding::error(ssp::CONNECTION_KINDS, message).at(at(connection.line)).help(
                                "connect an output with an input, or a system's connector with one of the same kind \
                                 within it",
                            ),
                        );
                    }
                }
            }
        }
        findings
    }

    fn types(&self, connection: &Connection, source: &Found, sink: &Found) -> Option<Finding> {
        let from = self.type_at(source.element, source.connector)?;
        let to = self.type_at(sink.element, sink.connector)?;
        if let Some(transformation) = &connection.transformation {
            return transformable(transformation, [&from, &to])
                .map(|finding| finding.at(at(connection.line)));
        }
        // Enumerations are passed on as whole numbers.
        let whole = |it: &str| matches!(it, "Integer" | "Enumeration");
        if from == to || (whole(&from) && whole(&to)) {
            return None;
        }
        let (source, sink) = (source.shown(), sink.shown());
        let message = format!("the connection `{source}` -> `{sink}` leads from {from} to {to}");
        Some(Finding::error(practice::CONNECTION_TYPE, message).at(at(connection.line)).help(
            "connect variables of the same type, or tell how the one becomes the other by a transformation",
        ))
    }

    fn units(&self, connection: &Connection, source: &Found, sink: &Found) -> Option<Finding> {
        let Connection { unconverted, transformation, .. } = connection;
        let from = self.unit_at(source.element, source.connector)?;
        let to = self.unit_at(sink.element, sink.connector)?;
        let leads = format!(
            "the connection `{}` -> `{}` leads from \"{}\" to \"{}\"",
            source.shown(),
            sink.shown(),
            from.symbol,
            to.symbol
        );
        let finding = match (from.fit(&to, 0), unconverted, transformation.is_some()) {
            // It is said what becomes of the signal, or that nothing is to.
            (Fit::Same, ..) | (_, true, _) => return None,
            (Fit::Linear { .. }, false, true) => Finding::warning(
                practice::CONNECTION_UNIT,
                format!(
                    "{leads} by a transformation of its own, which tools apply after converting the units"
                ),
            )
            .help("add suppressUnitConversion=\"true\" if the transformation is the conversion"),
            (_, false, true) => return None,
            (Fit::Linear { factor, offset }, false, false) => {
                let way = format!("<ssc:LinearTransformation factor=\"{factor:?}\" offset=\"{offset:?}\"/>");
                Finding::warning(practice::CONNECTION_UNIT, format!("{leads}, which not every tool converts"))
                    .help(format!("write {way} into it, with suppressUnitConversion=\"true\""))
            }
            (Fit::Unknown, false, false) => {
                let message = format!("{leads}, and nothing tells how these units compare");
                Finding::warning(practice::CONNECTION_UNIT, message)
                    .help("declare both by their base units, or tell the factor by a transformation")
            }
            (Fit::Derivative | Fit::Integral | Fit::Different, false, false) => {
                Finding::error(practice::CONNECTION_UNIT, leads)
                    .help("connect variables of the same unit, or tell the factor by a transformation")
            }
        };
        Some(finding.at(at(connection.line)))
    }
}

/// What is wrong if a transformation is not one for the types of what it is applied to.
pub(super) fn transformable(transformation: &str, types: [&str; 2]) -> Option<Finding> {
    let fine: &[&str] = match transformation {
        "LinearTransformation" => &["Real"],
        "BooleanMappingTransformation" => &["Boolean"],
        "IntegerMappingTransformation" => &["Integer", "Enumeration"],
        "EnumerationMappingTransformation" => &["Enumeration"],
        // The schema knows no others.
        _ => return None,
    };
    let other = types.into_iter().find(|it| !fine.contains(it))?;
    let message = format!("a {transformation} is applied to the type {other}");
    let help = format!("it is for {}", fine.join(" and "));
    Some(Finding::error(ssp::TRANSFORMATION, message).help(help))
}

/// The connector at an end.
fn find<'a>(system: &'a Element, elements: &'a [Element], end: &End) -> Result<Found<'a>, String> {
    let (element, within) = match &end.element {
        None => (system, true),
        Some(name) if name.is_empty() => {
            return Err("a connection ends at an element without a name; for the system itself, leave the attribute out".into());
        }
        Some(name) => {
            let element = elements.iter().find(|element| element.name == *name).ok_or_else(|| {
                format!("a connection ends at the element `{}`, which there is none of", system.of(name))
            })?;
            (element, false)
        }
    };
    let connector = element.connector(&end.connector).ok_or_else(|| {
        format!("a connection ends at `{}`, which is no connector", element.of(&end.connector))
    })?;
    Ok(Found { element, connector, within })
}

/// The ends in the order that the signal takes, which is not always that in which they are written.
fn directed<'a>(start: Found<'a>, end: Found<'a>) -> Result<(Found<'a>, Found<'a>), String> {
    let both = format!("`{}` and `{}`", start.shown(), end.shown());
    let (source, sink) = match (start.role(), end.role()) {
        (Role::Source, Role::Source) => return Err(format!("{both} are connected, and both give a value")),
        (Role::Sink, Role::Sink) => return Err(format!("{both} are connected, and both take a value")),
        (Role::Sink, _) | (_, Role::Source) => (end, start),
        (Role::Source | Role::Either, Role::Sink | Role::Either) => (start, end),
    };
    // A parameter may set a signal, which then stays as it is; what changes cannot set a parameter.
    if sink.is_parameter() && !source.is_parameter() {
        return Err(format!("{both} are connected, of which one is a parameter and the other a signal"));
    }
    Ok((source, sink))
}
