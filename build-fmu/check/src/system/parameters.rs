//! Rules for values: each is for a variable that takes it, in its type, its unit and its bounds.

use super::connectors::is_of;
use super::structure::{Binding, Content, Element, FILE};
use super::values::{Mapping, Parameter, Values};
use super::{System, at, file_of, found};
use crate::description::Variable;
use crate::finding::{Finding, names};
use crate::package::Package;
use crate::unit::Fit;
use crate::variables::is_value;

/// What a name stands for in an element.
enum Target<'a> {
    /// A variable of a component.
    Variable(&'a Element, &'a Variable),
    /// Something that is known to be there, or cannot be looked into.
    Other,
    /// Nothing.
    Missing,
}

impl System {
    /// What is wrong with values, and how many there are.
    pub(super) fn parameters(&self, package: &mut Package) -> (Vec<Finding>, usize) {
        let (mut findings, mut number) = (Vec::new(), 0);
        for element in self.structure.root.all() {
            for binding in &element.bindings {
                match self.binding(element, binding, package) {
                    Ok((found, given)) => {
                        findings.extend(found);
                        number += given;
                    }
                    Err(unreadable) => findings.push(unreadable),
                }
            }
        }
        (findings, number)
    }

    /// What is wrong with the values of a binding, and how many there are; or why they cannot be read.
    fn binding(
        &self,
        element: &Element,
        binding: &Binding,
        package: &mut Package,
    ) -> Result<(Vec<Finding>, usize), Finding> {
        // What is in files of other kinds, or in components, is for others to know.
        if binding.media != "application/x-ssp-parameter-set" || !binding.beside {
            return Ok((Vec::new(), 0));
        }
        let (read, mapped);
        let (values, file) = match (&binding.inline, &binding.source) {
            (Some(values), _) => (values, FILE.to_owned()),
            (None, Some(source)) => {
                let file;
                (read, file) = document(package, source, binding.line, Values::parse)?;
                (&read, file)
            }
            (None, None) => return Ok((Vec::new(), 0)),
        };
        let mapping = match &binding.mapping {
            Some(Mapping { source: Some(source), .. }) => {
                (mapped, _) = document(package, source, binding.line, Mapping::parse)?;
                Some(&mapped)
            }
            inline => inline.as_ref(),
        };
        let mut findings = Vec::new();
        let mut missing: Vec<String> = Vec::new();
        for (index, parameter) in values.parameters.iter().enumerate() {
            let place = format!("{file}:{}", parameter.line);
            if values.parameters[..index].iter().any(|other| other.name == parameter.name) {
                let message = format!("there are two values for `{}` in one set", parameter.name);
                findings.push(Finding::error("system.parameter", message).at(&place));
            }
            let name = format!("{}{}", binding.prefix, parameter.name);
            let targets: Vec<(&str, bool)> = match mapping {
                None => vec![(&name, false)],
                Some(mapping) => {
                    let entries = mapping.entries.iter().filter(|entry| entry.source == name);
                    entries.map(|entry| (entry.target.as_str(), entry.transformed)).collect()
                }
            };
            for (target, transformed) in targets {
                match self.target(element, target) {
                    Target::Other => {}
                    Target::Missing => missing.push(element.of(target)),
                    Target::Variable(owner, variable) => {
                        let wrong = self.value(owner, variable, parameter, values, transformed);
                        findings.extend(wrong.map(|finding| finding.at(&place)));
                    }
                }
            }
        }
        if !missing.is_empty() {
            let message = format!("values are given for what is not there: {}", names(&missing));
            findings.push(
                Finding::warning("system.parameter", message)
                    .at(file)
                    .help("tools pass over such values without a word: correct the names, or leave them out"),
            );
        }
        Ok((findings, values.parameters.len()))
    }

    /// What a name stands for: within a system it is a connector's, or begins with an element's.
    fn target<'a>(&'a self, element: &'a Element, name: &str) -> Target<'a> {
        match &element.content {
            Content::System { .. } if element.connector(name).is_some() => Target::Other,
            Content::System { elements, .. } => elements
                .iter()
                .filter_map(|inner| {
                    let rest = name.strip_prefix(&inner.name)?.strip_prefix('.')?;
                    Some(self.target(inner, rest))
                })
                .find(|target| !matches!(target, Target::Missing))
                .unwrap_or(Target::Missing),
            Content::Component { .. } if self.description(element).is_some() => {
                self.variable(element, name).map_or(Target::Missing, |it| Target::Variable(element, it))
            }
            Content::Component { .. } | Content::Dictionary => Target::Other,
        }
    }

    fn value(
        &self,
        owner: &Element,
        variable: &Variable,
        parameter: &Parameter,
        values: &Values,
        transformed: bool,
    ) -> Option<Finding> {
        let name = owner.of(&variable.name);
        let wrong = |message: String| Some(Finding::error("system.parameter", message));
        let initial = matches!(variable.effective_initial(), Some("exact" | "approx"));
        if variable.causality != "input" && (!initial || variable.variability == "constant") {
            return wrong(format!("`{name}` is calculated and takes no value"));
        }
        let Parameter { kind, value, .. } = parameter;
        if transformed {
            return None;
        }
        if !is_of(kind, variable) {
            return wrong(format!("`{name}` is {} and is given a {kind}", variable.kind));
        }
        // An item of an enumeration is given by its name.
        if kind != "Enumeration" && !is_value(kind, value) {
            return wrong(format!("`{name}` is given `{value}`, which is no value of the type {kind}"));
        }
        let given = parameter.unit.as_deref().map(|symbol| found(&values.units, symbol));
        if let (Some(given), Some(wanted)) = (given, self.unit_of(owner, variable)) {
            let message =
                format!("`{name}` is given in \"{}\", but declared in \"{}\"", given.symbol, wanted.symbol);
            match given.fit(&wanted, 0) {
                Fit::Same => {}
                Fit::Linear { .. } | Fit::Unknown => {
                    return Some(
                        Finding::warning("system.parameter", message)
                            .help("give it in the variable's unit: not every tool converts"),
                    );
                }
                Fit::Derivative | Fit::Integral | Fit::Different => return wrong(message),
            }
        }
        let (min, max) = (variable.min.unwrap_or(f64::NEG_INFINITY), variable.max.unwrap_or(f64::INFINITY));
        let number = value.trim().parse::<f64>().ok().filter(|value| !(min..=max).contains(value))?;
        wrong(format!("`{name}` is given {number}, outside of its bounds from {min} to {max}"))
    }
}

/// Reads a document of the archive; also tells its file.
fn document<T>(
    package: &mut Package,
    source: &str,
    line: u32,
    parse: impl Fn(&[u8]) -> Result<T, String>,
) -> Result<(T, String), Finding> {
    let wrong = |message: String| Finding::error("system.parameters", message).at(at(line));
    let file = file_of(source, package)
        .ok_or_else(|| wrong(format!("values are in `{source}`, which the archive does not have")))?;
    let bytes = package.read(&file).map_err(&wrong)?.unwrap_or_default();
    let document = parse(&bytes).map_err(|why| wrong(format!("`{file}` {why}")))?;
    Ok((document, file))
}
