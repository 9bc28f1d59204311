//! Rules for values: each is for a variable that takes it, in its type, its unit and its bounds.

use std::collections::HashSet;

use super::connections::transformable;
use super::connectors::is_of;
use super::documents::Wanted;
use super::structure::{Binding, Connector, Content, Element, FILE};
use super::values::{Mapping, Parameter, Values};
use super::{System, at, found};
use crate::description::Variable;
use crate::finding::{Finding, Report, names, repeated};
use crate::package::Package;
use crate::rules::{Rule, practice, ssp};
use crate::unit::{Fit, Unit};

/// The kind of files that parameter sets are in.
const MEDIA: &str = "application/x-ssp-parameter-set";

/// What a name stands for in an element.
enum Target<'a> {
    /// A variable of a component.
    Variable(&'a Element, &'a Variable),
    /// A connector of a system.
    Connector(&'a Element, &'a Connector),
    /// Something that is known to be there, or cannot be looked into.
    Other,
    /// Nothing.
    Missing,
}

impl System {
    /// Tells what is wrong with values; returns how many there are.
    pub(super) fn parameters(&self, package: &mut Package, report: &mut Report) -> usize {
        let mut number = 0;
        for element in self.structure.root.all() {
            for binding in &element.bindings {
                if binding.media != MEDIA {
                    let media = &binding.media;
                    report.skipped.push(format!("values for {}, of the type {media}", element.shown()));
                    continue;
                }
                match self.binding(element, binding, package) {
                    Ok((found, given)) => {
                        report.findings.extend(found);
                        number += given;
                    }
                    Err(unreadable) => report.findings.push(unreadable),
                }
            }
        }
        number
    }

    /// What is wrong with the values of a binding, and how many there are; or why they cannot be read.
    fn binding(
        &self,
        element: &Element,
        binding: &Binding,
        package: &mut Package,
    ) -> Result<(Vec<Finding>, usize), Finding> {
        let wanted = |source, within: bool| Wanted {
            rule: ssp::VALUES_READ,
            what: "values",
            source,
            within: within.then_some(element),
            line: binding.line,
        };
        let one_of_both = |message: &str| {
            let message = format!("a parameter binding of {} {message}", element.shown());
            let finding = Finding::error(ssp::VALUES_BOTH, message).at(at(binding.line));
            Err(finding.help("give the source of a file, or the values in place"))
        };
        let mut findings = Vec::new();
        let read;
        let (values, file) = match (&binding.inline, &binding.source) {
            (Some(_), Some(_)) => return one_of_both("has a file and values in place"),
            (None, None) => return one_of_both("has neither a file nor values in place"),
            (Some(values), None) => (values, FILE.to_owned()),
            (None, Some(source)) => {
                let document =
                    self.document(&wanted(source, binding.within), package, Values::parse, &mut findings)?;
                let Some((values, file)) = document else { return Ok((findings, 0)) };
                read = values;
                (&read, file)
            }
        };
        let mapped;
        let mapping = match &binding.mapping {
            Some(Mapping { source: Some(source), within, .. }) => {
                let document =
                    self.document(&wanted(source, *within), package, Mapping::parse, &mut findings)?;
                let Some(document) = document else { return Ok((findings, 0)) };
                mapped = document;
                Some((&mapped.0, mapped.1.as_str()))
            }
            inline => inline.as_ref().map(|mapping| (mapping, FILE)),
        };
        let mut missing: Vec<String> = Vec::new();
        let given = values.parameters.iter().map(|parameter| parameter.name.as_str());
        for (parameter, again) in values.parameters.iter().zip(repeated(given)) {
            let place = format!("{file}:{}", parameter.line);
            if again {
                let message = format!("there are two values for `{}` in one set", parameter.name);
                findings.push(Finding::error(ssp::VALUE_TWICE, message).at(&place));
            }
            let name = format!("{}{}", binding.prefix, parameter.name);
            let targets: Vec<(&str, Option<&str>)> = match mapping {
                None => vec![(&name, None)],
                Some((mapping, _)) => {
                    let entries = mapping.entries.iter().filter(|entry| entry.source == name);
                    entries.map(|entry| (entry.target.as_str(), entry.transformation.as_deref())).collect()
                }
            };
            for (target, transformation) in targets {
                let wrong = match self.target(element, target) {
                    Target::Other => None,
                    Target::Missing => {
                        missing.push(element.of(target));
                        None
                    }
                    Target::Connector(owner, connector) => {
                        self.value_of_connector(owner, connector, parameter, values, transformation)
                    }
                    Target::Variable(owner, variable) => {
                        self.value(owner, variable, parameter, values, transformation)
                    }
                };
                findings.extend(wrong.map(|finding| finding.at(&place)));
            }
        }
        if let Some((mapping, file)) = mapping {
            findings.extend(entries(mapping, file, element, binding, values));
        }
        if !missing.is_empty() {
            let message = format!("values are given for what is not there: {}", names(&missing));
            findings.push(
                Finding::warning(practice::PARAMETER_THERE, message)
                    .at(file)
                    .help("tools pass over such values without a word: correct the names, or leave them out"),
            );
        }
        Ok((findings, values.parameters.len()))
    }

    /// What a name stands for: within a system it is a connector's, or begins with an element's.
    fn target<'a>(&'a self, element: &'a Element, name: &str) -> Target<'a> {
        match &element.content {
            Content::System { elements, .. } => {
                if let Some(connector) = element.connector(name) {
                    return Target::Connector(element, connector);
                }
                let within = elements.iter().filter_map(|inner| {
                    let rest = name.strip_prefix(&inner.name)?.strip_prefix('.')?;
                    Some(self.target(inner, rest))
                });
                let mut there = within.filter(|target| !matches!(target, Target::Missing));
                there.next().unwrap_or(Target::Missing)
            }
            Content::Component { .. } if self.description(element).is_some() => {
                self.variable(element, name).map_or(Target::Missing, |it| Target::Variable(element, it))
            }
            Content::Component { .. } | Content::Dictionary(_) => Target::Other,
        }
    }

    fn value(
        &self,
        owner: &Element,
        variable: &Variable,
        parameter: &Parameter,
        values: &Values,
        transformation: Option<&str>,
    ) -> Option<Finding> {
        let name = owner.of(&variable.name);
        let wrong = |rule: &'static Rule, message: String| Some(Finding::error(rule, message));
        let initial = matches!(variable.effective_initial(), Some("exact" | "approx"));
        if variable.causality != "input" && (!initial || variable.variability == "constant") {
            return wrong(ssp::VALUE_TAKEN, format!("`{name}` is calculated and takes no value"));
        }
        let Parameter { kind, value, .. } = parameter;
        if let Some(transformation) = transformation {
            return transformable(transformation, [kind, &variable.kind]);
        }
        if !is_of(kind, &variable.kind) {
            return wrong(ssp::VALUE_TYPE, format!("`{name}` is {} and is given a {kind}", variable.kind));
        }
        let wanted = self.unit_of(owner, variable);
        if let Some(finding) = written(&name, parameter, values, wanted) {
            return Some(finding);
        }
        let (min, max) = (variable.min.unwrap_or(f64::NEG_INFINITY), variable.max.unwrap_or(f64::INFINITY));
        let number = value.trim().parse::<f64>().ok().filter(|value| !(min..=max).contains(value))?;
        wrong(
            practice::VALUE_BOUNDS,
            format!("`{name}` is given {number}, outside of its bounds from {min} to {max}"),
        )
    }

    /// What is wrong with a value for a connector of a system.
    fn value_of_connector(
        &self,
        owner: &Element,
        connector: &Connector,
        parameter: &Parameter,
        values: &Values,
        transformation: Option<&str>,
    ) -> Option<Finding> {
        let name = owner.of(&connector.name);
        let wrong = |rule: &'static Rule, message: String| Some(Finding::error(rule, message));
        if matches!(connector.kind.as_str(), "output" | "calculatedParameter") {
            return wrong(ssp::VALUE_TAKEN, format!("`{name}` is calculated and takes no value"));
        }
        let kind = &parameter.kind;
        if transformation.is_some() {
            return None;
        }
        if let Some(of_type) = self.type_at(owner, connector)
            && !is_of(kind, &of_type)
        {
            return wrong(ssp::VALUE_TYPE, format!("`{name}` is {of_type} and is given a {kind}"));
        }
        written(&name, parameter, values, self.unit_at(owner, connector))
    }
}

/// What is wrong with how a value is written: it is one of its type, and in the unit that is wanted.
fn written(name: &str, parameter: &Parameter, values: &Values, wanted: Option<Unit>) -> Option<Finding> {
    let wrong = |rule: &'static Rule, message: String| Some(Finding::error(rule, message));
    let given = parameter.unit.as_deref().map(|symbol| found(&values.units, symbol));
    let (given, wanted) = (given?, wanted?);
    let message = format!("`{name}` is given in \"{}\", but declared in \"{}\"", given.symbol, wanted.symbol);
    match given.fit(&wanted, 0) {
        Fit::Same => None,
        Fit::Linear { .. } | Fit::Unknown => Some(
            Finding::warning(practice::VALUE_UNIT, message)
                .help("give it in the variable's unit: not every tool converts"),
        ),
        Fit::Derivative | Fit::Integral | Fit::Different => wrong(practice::VALUE_UNIT, message),
    }
}

/// What is wrong with a mapping itself: each entry takes from what the set has, and none gives to what another does.
fn entries(
    mapping: &Mapping,
    file: &str,
    element: &Element,
    binding: &Binding,
    values: &Values,
) -> Vec<Finding> {
    let mut findings = Vec::new();
    let targets = mapping.entries.iter().map(|entry| entry.target.as_str());
    for (entry, again) in mapping.entries.iter().zip(repeated(targets)) {
        if again {
            let message = format!("two entries of a mapping give to `{}`", element.of(&entry.target));
            findings.push(Finding::error(ssp::TARGET_TWICE, message).at(format!("{file}:{}", entry.line)));
        }
    }
    let known: HashSet<&str> = values.parameters.iter().map(|parameter| parameter.name.as_str()).collect();
    let given =
        |name: &str| name.strip_prefix(binding.prefix.as_str()).is_some_and(|rest| known.contains(rest));
    let sources = mapping.entries.iter().map(|entry| entry.source.as_str());
    let missing: Vec<&str> = sources.filter(|source| !given(source)).collect();
    if !missing.is_empty() {
        let message = format!("a mapping takes from what its set does not give: {}", names(&missing));
        findings.push(
            Finding::warning(practice::PARAMETER_THERE, message)
                .at(file)
                .help("tools pass over such entries without a word: correct the names, or leave them out"),
        );
    }
    findings
}
