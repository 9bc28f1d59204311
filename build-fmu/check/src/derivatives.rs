//! Rules for derivatives: their state and their unit.

use std::collections::HashSet;

use crate::description::{Description, Kind, Variable};
use crate::finding::{Finding, names};
use crate::rules::{Rule, fmi, practice};
use crate::unit::{Fit, Unit};

/// What is wrong with the attributes `derivative`, `reinit` and their like.
pub fn findings(description: &Description) -> Vec<Finding> {
    let mut findings = Vec::new();
    for variable in &description.variables {
        if let Some(index) = variable.derivative {
            findings.extend(derivative(variable, index, description));
        }
    }
    findings.extend(only_for_model_exchange(description));
    findings
}

fn derivative(variable: &Variable, index: usize, description: &Description) -> Option<Finding> {
    let name = &variable.name;
    let wrong =
        |rule: &'static Rule, message: String| Some(Finding::error(rule, message).line(variable.line));
    let Some(state) = description.variable(index) else {
        let message = format!("`{name}` is the derivative of variable {index}, which there is none of");
        return wrong(fmi::DERIVATIVE_OF, message);
    };
    if std::ptr::eq(state, variable) {
        return wrong(fmi::DERIVATIVE_OF, format!("`{name}` is the derivative of itself"));
    }
    if is_round(state, description) {
        let message = format!("`{name}` is the derivative of `{}`, and by others of itself", state.name);
        return wrong(fmi::DERIVATIVE_OF, message);
    }
    if variable.kind != "Real" || variable.variability != "continuous" {
        let message = format!("`{name}` is a derivative, but no continuous Real");
        return wrong(fmi::DERIVATIVE_REAL, message);
    }
    if state.kind != "Real" || state.variability != "continuous" {
        let message = format!(
            "`{name}` is the derivative of `{}`, which is no continuous Real and cannot be a state",
            state.name
        );
        return wrong(fmi::DERIVATIVE_REAL, message);
    }
    unit(variable, state, description).or_else(|| named(variable, state, description))
}

/// Whether the way from derivative to derivative comes back.
fn is_round(state: &Variable, description: &Description) -> bool {
    let mut next = state;
    // No model has derivatives of the order of hundred.
    for _ in 0..100 {
        let Some(of) = next.derivative.and_then(|index| description.variable(index)) else { return false };
        next = of;
    }
    true
}

fn unit(variable: &Variable, state: &Variable, description: &Description) -> Option<Finding> {
    let declared = |variable: &Variable| -> Option<&Unit> {
        description.units.iter().find(|unit| Some(&unit.symbol) == variable.unit.as_ref())
    };
    let time = description.variables.iter().find(|it| it.causality == "independent");
    // Time in other units than seconds, and angles as plain numbers, are no findings.
    let (own, of) = (declared(variable)?, declared(state)?);
    if time.is_some_and(|time| time.unit.as_deref().is_some_and(|unit| unit != "s")) {
        return None;
    }
    let plain = |unit: &Unit| {
        let base =
            unit.base.as_ref().map(|base| base.iter().copied().filter(|(name, _)| *name != "rad").collect());
        Unit { base, ..unit.clone() }
    };
    let wrong = match plain(of).fit(&plain(own), 0) {
        Fit::Derivative | Fit::Unknown => return None,
        Fit::Same | Fit::Linear { .. } | Fit::Integral | Fit::Different => format!(
            "`{}` has the unit \"{}\", but is the derivative of `{}`, which has \"{}\"",
            variable.name, own.symbol, state.name, of.symbol
        ),
    };
    let help = "a derivative has the unit of its variable, divided by a second";
    Some(Finding::warning(practice::DERIVATIVE_UNIT, wrong).line(variable.line).help(help))
}

/// `der(x)` is the derivative of `x`, or of another name of it.
fn named(variable: &Variable, state: &Variable, description: &Description) -> Option<Finding> {
    let inner = variable.name.strip_prefix("der(")?.strip_suffix(')')?;
    let meant = description.named(inner).filter(|_| description.structured)?;
    if std::ptr::eq(meant, state) || (meant.reference == state.reference && meant.kind == state.kind) {
        return None;
    }
    let message = format!("`{}` is declared as the derivative of `{}`", variable.name, state.name);
    let help = "the index counts the variables from 1, in their order; it is no value reference";
    Some(Finding::warning(practice::DERIVATIVE_NAME, message).line(variable.line).help(help))
}

/// Attributes that say nothing where nobody else integrates, or of such variables.
fn only_for_model_exchange(description: &Description) -> Vec<Finding> {
    let alone = description.interface(Kind::ModelExchange).is_none();
    let states: HashSet<usize> = description.variables.iter().filter_map(|it| it.derivative).collect();
    let list = |of: &dyn Fn(usize, &Variable) -> bool| -> Vec<&Variable> {
        (1..).zip(&description.variables).filter(|(index, it)| of(*index, it)).map(|(_, it)| it).collect()
    };
    let set = "canHandleMultipleSetPerTimeInstant";
    let why = "but the FMU is for co-simulation alone";
    let cases = if alone {
        vec![
            (fmi::REINIT, "reinit", why, list(&|_, it| it.reinit)),
            (fmi::MULTIPLE_SET, set, why, list(&|_, it| it.multiple_set)),
        ]
    } else {
        let no_state = list(&|index, it| it.reinit && !states.contains(&index));
        let no_input = list(&|_, it| it.multiple_set && it.causality != "input");
        vec![
            (fmi::REINIT, "reinit", "but is no continuous-time state", no_state),
            (fmi::MULTIPLE_SET, set, "but is no input", no_input),
        ]
    };
    let finding = |(rule, attribute, why, variables): (&'static Rule, &str, &str, Vec<&Variable>)| {
        let first = variables.first()?;
        let all: Vec<&str> = variables.iter().map(|variable| variable.name.as_str()).collect();
        let message = format!("the attribute {attribute} is given for {}, {why}", names(&all));
        Some(Finding::error(rule, message).line(first.line).help("leave it out"))
    };
    cases.into_iter().filter_map(finding).collect()
}
