//! What a call with these arguments has to return where it is legal.

#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "what is no number is within no bounds")]

use std::ptr;

use super::instance::Known;
use super::{Expected, Instance, Player};
use crate::call::{Action, Damage, Null};
use crate::package::{Kind, Package, Variable};
use crate::standard::{Purpose, State, Version};

/// Inputs and their slopes up to here are what a rig may see.
const TAME: f64 = 0.05;

/// Whether a call sets variables one after the other, so that those before a wrong one are set.
pub fn sets_several(action: &Action) -> bool {
    match action {
        Action::SetReal { values, .. } => values.len() > 1,
        Action::SetInteger { values, .. } | Action::SetBoolean { values, .. } => values.len() > 1,
        Action::SetString { values, .. } => values.len() > 1,
        Action::SetRealInputDerivatives { values, .. } => values.len() > 1,
        _ => false,
    }
}

/// Whether a call asks and changes nothing.
pub fn only_reads(action: &Action) -> bool {
    use Action as A;
    matches!(
        action,
        A::Get { .. }
            | A::GetDirectionalDerivative { .. }
            | A::GetAdjointDerivative { .. }
            | A::GetNumberOfContinuousStates { .. }
            | A::GetUInt16 { .. }
            | A::SetFloat32 { .. }
            | A::GetFmuState { .. }
            | A::FreeFmuState { .. }
            | A::SerializedFmuStateSize { .. }
            | A::SerializeFmuState { .. }
            | A::DeSerializeFmuState { .. }
            | A::CompletedIntegratorStep { .. }
            | A::GetDerivatives { .. }
            | A::GetContinuousStates { .. }
            | A::GetNominals { .. }
            | A::GetEventIndicators { .. }
            | A::GetRealOutputDerivatives { .. }
            | A::GetRealStatus { .. }
            | A::GetBooleanStatus { .. }
            | A::SetDebugLogging { .. }
    )
}

/// Whether a call may bring the model where it cannot be integrated.
pub fn is_wild(package: &Package, action: &Action) -> bool {
    match action {
        Action::SetReal { values, .. } => values.iter().any(|(reference, value)| {
            !package.variable(Kind::Real, *reference).is_some_and(Variable::is_input)
                || !(value.abs() <= TAME)
        }),
        Action::SetRealInputDerivatives { values, .. } => {
            values.iter().any(|(_, _, value)| !(value.abs() <= TAME))
        }
        Action::SetInteger { .. }
        | Action::SetBoolean { .. }
        | Action::SetString { .. }
        | Action::SetContinuousStates { .. } => true,
        Action::SetupExperiment { tolerance, start, .. } => tolerance.is_some() || !(start.abs() <= 1e3),
        Action::SetTime { time } => !(time.abs() <= 1e3),
        Action::DoStep { size, .. } => !(*size <= 0.1),
        _ => false,
    }
}

/// Before initialisation ends.
fn is_early(state: Option<State>) -> bool {
    matches!(state, Some(State::Instantiated | State::InitializationMode))
}

fn ok_if(right: bool) -> Expected {
    if right { Expected::Ok } else { Expected::Error }
}

/// As long as nothing wild was set, the call succeeds.
fn ok_if_tame(instance: &Instance) -> Expected {
    if instance.known.tame { Expected::Ok } else { Expected::Survives }
}

impl Player<'_> {
    /// What a legal call has to return.
    pub(super) fn expected(&self, instance: &Instance, action: &Action) -> Expected {
        use Action as A;
        let known = &instance.known;
        let count = |excess: isize| self.package.states.saturating_add_signed(excess);
        let right_count = |excess: isize, null: Null| {
            let n = count(excess);
            n == self.package.states && (n == 0 || null == Null::None)
        };
        match action {
            A::Instantiate { .. } | A::FreeInstance => unreachable!("they are not calls to an instance"),
            A::SetDebugLogging { categories, null, .. } => ok_if(
                categories.is_empty()
                    || *null == Null::None
                        && categories.iter().all(|category| {
                            category.as_deref().is_some_and(|name| {
                                [c"logAll", c"logStatusDiscard", c"logSolver", c"logStatusError"]
                                    .contains(&name)
                            })
                        }),
            ),
            A::SetupExperiment { tolerance, start, stop } => {
                if !start.is_finite() || stop.is_some_and(|stop| !(stop > *start)) {
                    Expected::Error
                } else if tolerance.is_some() {
                    Expected::Accepted
                } else {
                    Expected::Ok
                }
            }
            A::ExitInitializationMode => ok_if_tame(instance),
            A::EnterEventMode => {
                let asked_for = known.handles.events || known.purpose == Purpose::ModelExchange;
                ok_if(self.package.version == Version::Two || asked_for)
            }
            A::EnterInitializationMode
            | A::Terminate
            | A::Reset
            | A::EnterStepMode
            | A::EnterContinuousTimeMode => Expected::Ok,
            A::CancelStep | A::EnterConfigurationMode | A::EvaluateDiscreteStates => Expected::Error,
            A::GetNumberOfContinuousStates { null } => ok_if(*null == Null::None),
            A::GetUInt16 { references } | A::SetFloat32 { references } => ok_if(references.is_empty()),
            A::Get { kind, references, null } => {
                // Before initialisation, what has a start value may be read.
                let early = known.state == Some(State::Instantiated);
                let right = references.iter().all(|reference| {
                    let variable = self.package.variable(*kind, *reference);
                    variable.is_some_and(|variable| {
                        !early || variable.is_settable() || variable.causality == "independent"
                    })
                });
                if references.is_empty() {
                    Expected::Ok
                } else if *null != Null::None || !right {
                    Expected::Error
                } else if *kind == Kind::Real {
                    ok_if_tame(instance)
                } else {
                    Expected::Ok
                }
            }
            A::SetReal { values, null } => {
                let right = values.iter().all(|(reference, value)| {
                    self.settable(known, Kind::Real, *reference).is_some_and(|variable| {
                        // A solver may try a state that is out of bounds.
                        let tried = variable.is_state && !is_early(known.state);
                        value.is_finite() && (tried || (variable.min..=variable.max).contains(value))
                    })
                });
                ok_if(values.is_empty() || *null == Null::None && right)
            }
            A::SetInteger { kind, values, null } => {
                let right = values.iter().all(|(reference, value)| {
                    self.settable(known, *kind, *reference).is_some_and(|variable| {
                        !variable.is_choice || (variable.min..=variable.max).contains(&f64::from(*value))
                    })
                });
                ok_if(values.is_empty() || *null == Null::None && right)
            }
            A::SetBoolean { values, null } => ok_if(
                values.is_empty()
                    || *null == Null::None
                        && values
                            .iter()
                            .all(|(reference, _)| self.settable(known, Kind::Boolean, *reference).is_some()),
            ),
            A::SetString { values, null } => {
                let right = values.iter().all(|(reference, value)| {
                    self.settable(known, Kind::Text, *reference).is_some()
                        && value.as_ref().is_some_and(|text| text.to_str().is_ok())
                });
                ok_if(values.is_empty() || *null == Null::None && right)
            }
            A::GetDirectionalDerivative { unknowns, knowns, null } => {
                let exists = |reference: &u32| self.package.variable(Kind::Real, *reference).is_some();
                let nothing = match null {
                    Null::None => true,
                    Null::First | Null::Last => unknowns.is_empty(),
                };
                let right = unknowns.iter().all(exists)
                    && knowns.iter().all(|(reference, seed)| exists(reference) && seed.is_finite());
                if nothing && right { Expected::Survives } else { Expected::Error }
            }
            A::GetAdjointDerivative { unknowns, knowns, null } => {
                let exists = |reference: &u32| self.package.variable(Kind::Real, *reference).is_some();
                let nothing = match null {
                    Null::None => true,
                    Null::First => unknowns.is_empty(),
                    Null::Last => knowns.is_empty(),
                };
                let right = knowns.iter().all(exists)
                    && unknowns.iter().all(|(reference, seed)| exists(reference) && seed.is_finite());
                if nothing && right { Expected::Survives } else { Expected::Error }
            }
            A::GetFmuState { state, null } => {
                let place = self.states[*state];
                ok_if(
                    *null == Null::None
                        && (place.is_null() || instance.saved.contains_key(&(place as usize))),
                )
            }
            A::SetFmuState { state } => match instance.saved.get(&(self.states[*state] as usize)) {
                None => Expected::Error,
                // A forged state may be found out only here.
                Some(saved) if saved.state.is_none() => Expected::Survives,
                Some(_) => Expected::Ok,
            },
            A::FreeFmuState { state, null } => {
                let place = self.states[*state];
                ok_if(
                    *null == Null::None
                        && (place.is_null() || instance.saved.contains_key(&(place as usize))),
                )
            }
            A::SerializedFmuStateSize { state, null } => {
                ok_if(*null == Null::None && self.is_saved(instance, *state))
            }
            A::SerializeFmuState { state, excess, null, .. } => {
                ok_if(*null == Null::None && *excess == 0 && self.is_saved(instance, *state))
            }
            A::DeSerializeFmuState { blob, damage, state, null } => {
                let blob = &self.blobs[*blob];
                let place = self.states[*state];
                let fits = blob.known.as_ref().is_some_and(|saved| saved.purpose == known.purpose);
                let free = place.is_null() || instance.saved.contains_key(&(place as usize));
                match damage {
                    _ if *null != Null::None || !fits || !free => Expected::Error,
                    Damage::None => Expected::Ok,
                    Damage::Forge(..) => Expected::Survives,
                    _ => Expected::Error,
                }
            }
            A::NewDiscreteStates { null } if *null != Null::None => Expected::Error,
            A::NewDiscreteStates { .. } => ok_if_tame(instance),
            A::CompletedIntegratorStep { null } => ok_if(*null == Null::None),
            A::SetTime { time } => ok_if(time.is_finite()),
            A::SetContinuousStates { values, excess, null } => {
                let finite = values.iter().take(count(*excess)).all(|value| value.is_finite());
                ok_if(right_count(*excess, *null) && finite)
            }
            A::GetDerivatives { excess, null } if right_count(*excess, *null) => ok_if_tame(instance),
            A::GetDerivatives { .. } => Expected::Error,
            A::GetContinuousStates { excess, null } | A::GetNominals { excess, null } => {
                ok_if(right_count(*excess, *null))
            }
            A::GetEventIndicators { excess, null } => {
                let right = *excess == 0 && *null == Null::None;
                if right { ok_if_tame(instance) } else { Expected::Error }
            }
            A::SetRealInputDerivatives { values, null } => {
                let right = values.iter().all(|(reference, order, value)| {
                    self.package.variable(Kind::Real, *reference).is_some_and(Variable::is_input)
                        && (1..=2).contains(order)
                        && value.is_finite()
                });
                ok_if(values.is_empty() || *null == Null::None && right)
            }
            A::GetRealOutputDerivatives { orders, null } => {
                let right = orders.iter().all(|(reference, order)| {
                    self.package.variable(Kind::Real, *reference).is_some() && *order == 1
                });
                let outputs = orders.iter().all(|(reference, _)| {
                    self.package
                        .variable(Kind::Real, *reference)
                        .is_some_and(|variable| variable.causality == "output")
                });
                match () {
                    () if !orders.is_empty() && (*null != Null::None || !right) => Expected::Error,
                    () if outputs => ok_if_tame(instance),
                    () => Expected::Survives,
                }
            }
            A::DoStep { offset, size } => step(instance, *offset, *size),
            A::GetStatus { kind, null }
            | A::GetIntegerStatus { kind, null }
            | A::GetStringStatus { kind, null } => answer(*kind, *null, None),
            A::GetRealStatus { kind, null } => answer(*kind, *null, Some(2)),
            A::GetBooleanStatus { kind, null } => answer(*kind, *null, Some(3)),
        }
    }

    fn is_saved(&self, instance: &Instance, state: usize) -> bool {
        !ptr::eq(self.states[state], ptr::null())
            && instance.saved.contains_key(&(self.states[state] as usize))
    }

    /// The variable, if it may be set in a state (FMI 2.0.4, section 2.1.7 and the notes to the tables of
    /// the state machines).
    fn settable(&self, known: &Known, kind: Kind, reference: u32) -> Option<&Variable> {
        let variable = self.package.variable(kind, reference)?;
        let tunable = variable.causality == "parameter" && variable.variability == "tunable";
        // FMI 3.0, section 2.3.5.
        let at_event = self.package.version == Version::Three && known.purpose == Purpose::ModelExchange;
        let settable = match known.state? {
            State::Instantiated | State::InitializationMode => variable.is_settable(),
            State::EventMode if at_event && variable.is_state => true,
            State::EventMode | State::StepComplete => variable.is_input() || tunable,
            State::ContinuousTimeMode => variable.is_input() || variable.is_state,
            State::StepFailed | State::Terminated => false,
        };
        settable.then_some(variable)
    }
}

/// What a status function answers: a synchronous instance knows the answer to one question.
fn answer(kind: i32, null: Null, answered: Option<i32>) -> Expected {
    if null != Null::None || !(0..4).contains(&kind) {
        Expected::Error
    } else if Some(kind) == answered {
        Expected::Ok
    } else {
        Expected::Discard
    }
}

fn step(instance: &Instance, offset: f64, size: f64) -> Expected {
    let known = &instance.known;
    debug_assert!(known.purpose == Purpose::CoSimulation);
    if !(size > 0.0) || !size.is_finite() || !offset.is_finite() || offset.abs() > 1e-3 * size.max(1.0) {
        return Expected::Error;
    }
    let end = known.time + offset + size;
    let tame = known.tame && offset == 0.0 && (1e-6..=0.1).contains(&size);
    // Near the stop time rounding is forgiven.
    match () {
        () if tame && end < known.stop => Expected::Ok,
        () if tame && end > known.stop + 1e-3 * size => Expected::Error,
        () => Expected::Survives,
    }
}
