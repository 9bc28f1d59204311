//! Rules for derivatives: of what they are, and in which unit.

use crate::description::{Description, Kind, Variable};
use crate::finding::Finding;
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
    // Where time is not counted in seconds, or angles are taken for numbers, nothing is told.
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

/// Attributes that say nothing where nobody else integrates.
fn only_for_model_exchange(description: &Description) -> Vec<Finding> {
    let mut findings = Vec::new();
    let alone = description.interface(Kind::ModelExchange).is_none();
    let states: Vec<usize> =
        description.variables.iter().filter_map(|variable| variable.derivative).collect();
    let is_state: std::collections::HashSet<usize> = states.into_iter().collect();
    for (index, variable) in (1..).zip(&description.variables) {
        let mut wrong = |rule: &'static Rule, attribute: &str, why: &str| {
            let message = format!("`{}` has the attribute {attribute}, {why}", variable.name);
            findings.push(Finding::error(rule, message).line(variable.line).help("leave it out"));
        };
        if variable.reinit && alone {
            wrong(fmi::REINIT, "reinit", "but the FMU is for co-simulation alone");
        } else if variable.reinit && !is_state.contains(&index) {
            wrong(fmi::REINIT, "reinit", "but is no continuous-time state");
        }
        let set = "canHandleMultipleSetPerTimeInstant";
        if variable.multiple_set && alone {
            wrong(fmi::MULTIPLE_SET, set, "but the FMU is for co-simulation alone");
        } else if variable.multiple_set && variable.causality != "input" {
            wrong(fmi::MULTIPLE_SET, set, "but is no input");
        }
    }
    findings
}
