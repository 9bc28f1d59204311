//! Rules for what can be connected: each connector of a component is a variable of its FMU.

use super::structure::{Connector, Content, Element};
use super::{System, at, found};
use crate::finding::Finding;
use crate::rules::{Rule, practice, ssp};
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
        let wrong = |rule: &'static Rule, message: String| Finding::error(rule, message).at(at(*line));
        // What SSP does not know at all is for the schema.
        if !KINDS.contains(&kind.as_str()) {
            return None;
        }
        if let Content::Dictionary(_) = element.content {
            return self.connector_of_signal(element, connector);
        }
        let description = self.description(element)?;
        let Some(variable) = self.variable(element, name) else {
            let finding = wrong(ssp::CONNECTOR_VARIABLE, format!("`{shown}` is no variable of its FMU"));
            return Some(meant(finding, name, description.variables.iter().map(|it| it.name.as_str())));
        };
        let causality = &variable.causality;
        if kind != causality {
            let message = format!(
                "`{shown}` is of the kind \"{kind}\", but its variable has the causality \"{causality}\""
            );
            return Some(wrong(ssp::CONNECTOR_KIND, message));
        }
        if let Some(of_type) = &connector.of_type
            && !is_of(of_type, &variable.kind)
        {
            let given = &variable.kind;
            let message = format!("`{shown}` is of type {of_type}, but its variable is {given}");
            return Some(wrong(practice::CONNECTOR_TYPE, message));
        }
        let (own, theirs) = (self.own_unit(connector)?, self.unit_of(element, variable)?);
        // Where an FMU counts in numbers without a unit, the connector tells what they are.
        if theirs.base.as_ref().is_some_and(Vec::is_empty) || own.fit(&theirs, 0) == Fit::Same {
            return None;
        }
        let (own, theirs) = (own.symbol, theirs.symbol);
        let message = format!("`{shown}` has the unit \"{own}\", but its variable has \"{theirs}\"");
        Some(wrong(practice::CONNECTOR_UNIT, message).help("give the variable's unit, or none"))
    }

    pub(super) fn own_unit(&self, connector: &Connector) -> Option<Unit> {
        connector.unit.as_deref().map(|symbol| found(&self.structure.units, symbol))
    }

    /// The type of what a connector passes on: its own, else its variable's or its signal's.
    pub(super) fn type_at(&self, element: &Element, connector: &Connector) -> Option<String> {
        let variable = || Some(self.variable(element, &connector.name)?.kind.clone());
        let signal = || self.signal(element, &connector.name)?.of_type.clone();
        connector.of_type.clone().or_else(variable).or_else(signal)
    }

    /// The unit of what a connector passes on: its own, else its variable's or its signal's.
    pub(super) fn unit_at(&self, element: &Element, connector: &Connector) -> Option<Unit> {
        let variable = || self.unit_of(element, self.variable(element, &connector.name)?);
        let signal = || self.unit_of_signal(element, &connector.name);
        self.own_unit(connector).or_else(variable).or_else(signal)
    }
}

/// A finding with the name that comes closest to one that is not there.
pub(super) fn meant<'a>(finding: Finding, name: &str, all: impl Iterator<Item = &'a str>) -> Finding {
    let like = |other: &str| strsim::jaro_winkler(name, other);
    let close = all.max_by(|a, b| like(a).total_cmp(&like(b)));
    close.into_iter().fold(finding, |it, close| it.help(format!("is `{close}` meant?")))
}

/// Whether a type is the one that is wanted. Enumerations are passed on as whole numbers, which saves declaring them.
pub(super) fn is_of(of_type: &str, wanted: &str) -> bool {
    of_type == wanted || (of_type == "Integer" && wanted == "Enumeration")
}
