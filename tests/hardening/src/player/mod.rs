//! Makes calls and judges what comes back.

mod arguments;
mod instance;
mod invoke;

use std::ptr;

use strut_fmi::fmi2::types::{FALSE, FmuState, Status, TRUE};

use crate::api::Api;
use crate::call::{Action, BLOBS, Call, Damage, Fault, Handles, INSTANCES, STATES};
use crate::package::Kind;
use crate::package::Package;
use crate::standard::{Purpose, State, Verdict, Version, successor, verdict};
use instance::{Instance, Known};

/// Bytes of a saved state, and what is known of it.
#[derive(Clone, Debug, Default)]
struct Blob {
    bytes: Vec<u8>,
    known: Option<Known>,
}

/// What plays an episode.
pub struct Player<'a> {
    api: Api,
    package: &'a Package,
    instances: [Option<Instance>; INSTANCES],
    states: [FmuState; STATES],
    blobs: [Blob; BLOBS],
    /// Instances that steps are made in a second time, one for each purpose.
    twins: [Option<Instance>; 2],
    calls: u64,
}

/// What a call may return.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Expected {
    /// `fmi2OK`
    Ok,
    /// `fmi2Error`: refused, and nothing has changed.
    Error,
    /// `fmi2Discard`: the question has no answer.
    Discard,
    /// `fmi2OK` or `fmi2Warning`.
    Accepted,
    /// Depends on the model: anything but that the instance is lost.
    Survives,
}

impl Expected {
    fn allows(self, status: Status) -> bool {
        match self {
            Self::Ok => status == Status::Ok,
            Self::Error => status == Status::Error,
            Self::Discard => status == Status::Discard,
            Self::Accepted => matches!(status, Status::Ok | Status::Warning),
            Self::Survives => !matches!(status, Status::Fatal | Status::Pending),
        }
    }
}

impl<'a> Player<'a> {
    /// A player without instances.
    pub fn new(api: Api, package: &'a Package) -> Self {
        Self {
            api,
            package,
            instances: Default::default(),
            states: [ptr::null_mut(); STATES],
            blobs: Default::default(),
            twins: Default::default(),
            calls: 0,
        }
    }

    /// Makes the calls; returns how many were made.
    ///
    /// # Errors
    /// What the library did wrong, and at which call.
    pub fn play(mut self, calls: &[Call]) -> Result<u64, (usize, String)> {
        for (index, call) in calls.iter().enumerate() {
            self.call(call).map_err(|wrong| {
                (index, format!("{} {wrong}", call.action.function(self.package.version)))
            })?;
        }
        Ok(self.calls)
    }

    fn call(&mut self, call: &Call) -> Result<(), String> {
        self.calls += 1;
        match &call.action {
            Action::Instantiate { cosimulation, logging, handles, fault } => {
                let purpose = if *cosimulation { Purpose::CoSimulation } else { Purpose::ModelExchange };
                return self.instantiate(call.instance, (purpose, *handles), *logging, *fault);
            }
            Action::FreeInstance => {
                self.instances[call.instance] = None;
                return Ok(());
            }
            _ => {}
        }
        // Taken out, so that it and the player may be used at the same time.
        let Some(mut instance) = self.instances[call.instance].take() else {
            return self.without_instance(&call.action);
        };
        let result = self.call_instance(&mut instance, call);
        self.instances[call.instance] = Some(instance);
        result
    }

    fn instantiate(
        &mut self,
        place: usize,
        purpose: (Purpose, Handles),
        logging: bool,
        fault: Fault,
    ) -> Result<(), String> {
        self.instances[place] = None;
        let made = Instance::new(self.api, self.package, purpose, logging, fault)?;
        match (made.is_some(), fault) {
            (true, Fault::None) => self.instances[place] = made,
            (false, Fault::None) => return Err("gave no instance".into()),
            (true, _) => return Err(format!("gave an instance in spite of {fault:?}")),
            (false, _) => {}
        }
        Ok(())
    }

    /// Without an instance every function fails.
    fn without_instance(&mut self, action: &Action) -> Result<(), String> {
        match self.invoke(ptr::null_mut(), 0.0, action).status {
            Status::Error => Ok(()),
            other => Err(format!("returned {other:?} for a null component")),
        }
    }

    fn call_instance(&mut self, instance: &mut Instance, call: &Call) -> Result<(), String> {
        let Call { action, checked, .. } = call;
        let function = action.function(self.package.version);
        let legal = match instance.known.state {
            Some(state) => verdict(self.package.version, instance.known.purpose, state, function),
            None => Verdict::Either,
        };
        let expected = match legal {
            Verdict::Legal => self.expected(instance, action),
            Verdict::Illegal => Expected::Error,
            Verdict::Either => Expected::Survives,
        };
        let before = if *checked { Some(instance.bytes(self.api)?) } else { None };
        let twin = match (&before, action) {
            (Some(bytes), Action::DoStep { .. } | Action::GetDerivatives { .. }) => {
                Some(self.twin(instance, bytes, action)?)
            }
            _ => None,
        };
        instance.time_if_unknown(self.api);
        instance.forget_messages();
        let states = self.states;
        let outcome = self.invoke(instance.component, instance.known.time, action);
        let status = outcome.status;
        instance.check_messages(status)?;
        if !expected.allows(status) {
            return Err(format!(
                "returned {status:?} where {expected:?} is right ({legal:?} in {:?}); it said: {}",
                instance.known,
                instance.last_message()
            ));
        }
        self.follow(instance, action, &outcome, &states)?;
        if let Some(wrong) = self.unanswered(instance, action, &outcome) {
            return Err(wrong);
        }
        if let Some(before) = before {
            let untouched = match status {
                Status::Error => !arguments::sets_several(action),
                Status::Ok => arguments::only_reads(action),
                _ => false,
            };
            let after = instance.bytes(self.api)?;
            if untouched && before != after {
                return Err(format!("returned {status:?} and changed the instance all the same"));
            }
            if let Some((twin_status, twin_after)) = twin
                && (twin_status, &twin_after) != (status, &after)
            {
                return Err(format!(
                    "went {status:?}, but {twin_status:?} from the same saved state in another instance, or to \
                     another state"
                ));
            }
        }
        Ok(())
    }

    /// What became of an accepted or refused call.
    fn follow(
        &mut self,
        instance: &mut Instance,
        action: &Action,
        outcome: &invoke::Outcome,
        states: &[FmuState; STATES],
    ) -> Result<(), String> {
        let (status, version) = (outcome.status, self.package.version);
        let known = &mut instance.known;
        let accepted = matches!(status, Status::Ok | Status::Warning);
        if arguments::is_wild(self.package, action) && (accepted || arguments::sets_several(action)) {
            known.tame = false;
        }
        // In FMI 3.0 a discarded step leaves everything as it was.
        if status == Status::Discard && version == Version::Two && matches!(action, Action::DoStep { .. }) {
            known.state = known.state.map(|_| State::StepFailed);
        }
        if !accepted {
            return Ok(());
        }
        if let Some(next) = successor(known.purpose, known.handles.events, action.function(version))
            && (known.state.is_some() || next == State::Instantiated)
        {
            known.state = Some(next);
        }
        match action {
            Action::Reset => {
                *known = Known::fresh(known.purpose, known.handles);
                if instance.bytes(self.api)? != instance.fresh {
                    return Err("left an instance that is not as a fresh one".into());
                }
            }
            Action::SetupExperiment { start, stop, .. } => {
                (known.time, known.stop) = (*start, stop.unwrap_or(f64::INFINITY));
            }
            Action::SetTime { time } => known.time = *time,
            Action::DoStep { offset, size } => {
                let mut end = known.time + offset + size;
                if version == Version::Three {
                    let allowed = known.handles.events && known.handles.early_return;
                    let early = outcome.early && allowed && known.time < outcome.real && outcome.real < end;
                    if !early && (outcome.early || outcome.real.to_bits() != end.to_bits()) {
                        return Err(format!("was to go to {end} s and went to {} s", outcome.real));
                    }
                    end = outcome.real;
                }
                known.time = end;
                let told = instance.time(self.api);
                if told.map(f64::to_bits) != Some(end.to_bits()) {
                    return Err(format!("was to go to {end} s and says that it is at {told:?} s"));
                }
            }
            Action::GetFmuState { state, .. } => {
                let known = known.clone();
                instance.saved.insert(self.states[*state] as usize, known);
            }
            Action::FreeFmuState { state, .. } => {
                instance.saved.remove(&(states[*state] as usize));
            }
            Action::SerializeFmuState { state, blob, .. } => {
                self.blobs[*blob].known = instance.saved.get(&(states[*state] as usize)).cloned();
            }
            Action::DeSerializeFmuState { blob, damage, state, .. } => {
                if let Some(mut known) = self.blobs[*blob].known.clone() {
                    if *damage != Damage::None {
                        (known.state, known.tame) = (None, false);
                    }
                    instance.saved.insert(self.states[*state] as usize, known);
                }
            }
            Action::SetFmuState { state } => {
                let state = self.states[*state];
                let handles = instance.known.handles;
                instance.known = Known { handles, ..instance.saved[&(state as usize)].clone() };
                if instance.bytes(self.api)? != instance.bytes_of(self.api, state)? {
                    return Err("did not lead to the saved state".into());
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// The same call from the same state in another instance, which has seen other states before.
    fn twin(
        &mut self,
        instance: &Instance,
        bytes: &[u8],
        action: &Action,
    ) -> Result<(Status, Vec<u8>), String> {
        let Known { purpose, handles, .. } = instance.known;
        let kept = self.twins[purpose as usize].take().filter(|twin| twin.known.handles == handles);
        let mut twin = match kept {
            Some(twin) => twin,
            None => Instance::new(self.api, self.package, (purpose, handles), false, Fault::None)?
                .ok_or("gave no second instance")?,
        };
        twin.restore(self.api, bytes)?;
        twin.known = instance.known.clone();
        twin.time_if_unknown(self.api);
        let status = self.invoke(twin.component, twin.known.time, action).status;
        let after = twin.bytes(self.api)?;
        self.twins[purpose as usize] = Some(twin);
        Ok((status, after))
    }

    /// Whether what was to be answered was, and nothing else.
    fn unanswered(
        &mut self,
        instance: &mut Instance,
        action: &Action,
        outcome: &invoke::Outcome,
    ) -> Option<String> {
        if outcome.status != Status::Ok {
            return None;
        }
        match action {
            Action::GetRealStatus { .. } if instance.known.state.is_some() => {
                let right = instance.known.time;
                (outcome.real.to_bits() != right.to_bits())
                    .then(|| format!("told {} s; right is {right} s", outcome.real))
            }
            Action::GetBooleanStatus { .. } => {
                (outcome.integer != FALSE).then(|| format!("told {}", outcome.integer))
            }
            Action::Get { kind: Kind::Boolean, references, .. } if !references.is_empty() => {
                (![FALSE, TRUE].contains(&outcome.integer)).then(|| format!("told {}", outcome.integer))
            }
            Action::Get { kind: Kind::Text, .. } => {
                (!outcome.complete).then(|| "gave something that is no text".to_owned())
            }
            _ => None,
        }
    }
}
