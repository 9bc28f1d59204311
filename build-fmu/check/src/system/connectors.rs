//! Rules for what can be connected: each connector of a component is a variable of its FMU.

use super::structure::{Connector, Element};
use super::{System, at, found};
use crate::description::Variable;
use crate::finding::Finding;
use crate::unit::{Fit, Unit};

const KINDS: [&str; 5] = ["input", "output", "parameter", "calculatedParameter", "inout"];

impl System {
    /// What is wrong with connectors.
    pub(super) fn connectors(&self) -> Vec<Finding> {
        let mut findings = Vec::new();
        for element in self.structure.root.all() {
            for connector in &element.connectors {
                findings.extend(self.connector(element, connector));
            }
        }
        findings
    }

    fn connector(&self, element: &Element, connector: &Connector) -> Option<Finding> {
        let Connector { name, kind, line, .. } = connector;
        let shown = element.of(name);
        let wrong = |message: String| Finding::error("system.connector", message).at(at(*line));
        if !KINDS.contains(&kind.as_str()) {
            let known = KINDS.join(", ");
            return Some(
                wrong(format!("`{shown}` is of the kind \"{kind}\", which SSP does not know"))
                    .help(format!("it is one of {known}")),
            );
        }
        let description = self.description(element)?;
        let Some(variable) = self.variable(element, name) else {
            let close = description.variables.iter().map(|variable| variable.name.as_str()).max_by(|a, b| {
                let like = |other: &str| strsim::jaro_winkler(name, other);
                like(a).total_cmp(&like(b))
            });
            let finding = wrong(format!("`{shown}` is no variable of its FMU"));
            return Some(
                close.into_iter().fold(finding, |it, close| it.help(format!("is `{close}` meant?"))),
            );
        };
        let causality = &variable.causality;
        if kind != "inout" && kind != causality {
            return Some(wrong(format!(
                "`{shown}` is of the kind \"{kind}\", but its variable has the causality \"{causality}\""
            )));
        }
        if let Some(of_type) = &connector.of_type
            && !is_of(of_type, variable)
        {
            let given = &variable.kind;
            return Some(wrong(format!("`{shown}` is of type {of_type}, but its variable is {given}")));
        }
        let (own, theirs) = (self.own_unit(connector)?, self.unit_of(element, variable)?);
        // Where an FMU counts in numbers without a unit, the connector tells what they are.
        if theirs.base.as_ref().is_some_and(Vec::is_empty) || own.fit(&theirs, 0) == Fit::Same {
            return None;
        }
        let (own, theirs) = (own.symbol, theirs.symbol);
        let message = format!("`{shown}` has the unit \"{own}\", but its variable has \"{theirs}\"");
        Some(wrong(message).help("give the variable's unit, or none"))
    }

    fn own_unit(&self, connector: &Connector) -> Option<Unit> {
        connector.unit.as_deref().map(|symbol| found(&self.structure.units, symbol))
    }

    /// The type of what a connector passes on: its own, else its variable's.
    pub(super) fn type_at(&self, element: &Element, connector: &Connector) -> Option<String> {
        let variable = || Some(self.variable(element, &connector.name)?.kind.clone());
        connector.of_type.clone().or_else(variable)
    }

    /// The unit of what a connector passes on: its own, else its variable's.
    pub(super) fn unit_at(&self, element: &Element, connector: &Connector) -> Option<Unit> {
        let variable = || self.unit_of(element, self.variable(element, &connector.name)?);
        self.own_unit(connector).or_else(variable)
    }
}

/// Whether a type is a variable's. Enumerations are passed on as whole numbers, which saves declaring them.
pub(super) fn is_of(of_type: &str, variable: &Variable) -> bool {
    of_type == variable.kind || (of_type == "Integer" && variable.kind == "Enumeration")
}
