//! Events of an FMU: at known times, where an indicator changes its sign, and where a step that is completed asks for one.

use strut_check::import::Instance;

use super::{Fmu, Session, fine};

/// Rounds after which events that want further ones have no end.
const ROUNDS: usize = 1000;

/// Time in seconds by which an event may be early: what rounding makes of its time.
const CLOSE: f64 = 1e-10;

/// What an instance says of its events.
pub(super) struct Events {
    /// Indicators at the last event or the end of the last step.
    before: Vec<f64>,
    /// Indicators where the instance is.
    now: Vec<f64>,
    /// Time of the next event, as the FMU has it.
    next: f64,
}

impl Events {
    /// Of an instance, from the number of its indicators and the time of its first event.
    pub fn new(indicators: usize, first: f64) -> Self {
        Self { before: Vec::new(), now: vec![0.0; indicators], next: first }
    }
}

impl Fmu {
    /// Iterates at an event until nothing changes any more, and gives the time of the next one: infinite if none is known. None if
    /// it fails.
    pub(super) fn leave_events(&self, instance: Instance) -> Option<f64> {
        for _ in 0..ROUNDS {
            let (status, discrete) = self.library.new_discrete_states(instance);
            if !fine(status) || discrete.terminate {
                return None;
            }
            if !discrete.again {
                let goes_on = fine(self.library.plain("fmi2EnterContinuousTimeMode", instance));
                return goes_on.then(|| discrete.next_event.unwrap_or(f64::INFINITY));
            }
        }
        None
    }
}

impl Session {
    /// Whether it has indicators.
    pub fn indicates(&self) -> bool {
        !self.events.now.is_empty()
    }

    /// Time of the next event that is known, in seconds after the start; infinite if there is none.
    pub fn next_event(&self) -> f64 {
        self.events.next - self.start
    }

    /// Reads the indicators where the instance is.
    pub fn sense(&mut self) {
        if self.indicates() && !self.is_silent() {
            let (fmu, now) = (&*self.fmu, &mut self.events.now);
            self.failed |= !fine(fmu.library.array("fmi2GetEventIndicators", self.instance, now));
        }
    }

    /// The first indicator that had another sign at the last event or the end of the last step, if any.
    pub fn crossed(&self) -> Option<usize> {
        let both = self.events.before.iter().zip(&self.events.now);
        both.enumerate().find(|(_, (before, now))| (**before > 0.0) != (**now > 0.0)).map(|(index, _)| index)
    }

    /// An indicator at the last event or the end of the last step, and where it was read last.
    pub fn indicator(&self, index: usize) -> (f64, f64) {
        (self.events.before[index], self.events.now[index])
    }

    /// Completes a step where the instance is and its indicators were read, at a time after the start, and handles an event there;
    /// whether there was one, so that states and rates may have jumped.
    pub fn settle(&mut self, time: f64, states: &mut [f64]) -> bool {
        if self.is_silent() {
            return false;
        }
        let mut event = self.crossed().is_some() || self.next_event() <= time + CLOSE;
        if !self.fmu.silent && !self.failed {
            let (status, wanted) = self.fmu.library.completed_step(self.instance);
            self.failed |= !fine(status);
            event |= wanted;
        }
        if event && !self.failed {
            self.handle(states);
        }
        self.events.before.clone_from(&self.events.now);
        event
    }

    /// Handles an event, and takes the states after it.
    fn handle(&mut self, states: &mut [f64]) {
        let (fmu, instance) = (&*self.fmu, self.instance);
        let entered = fine(fmu.library.plain("fmi2EnterEventMode", instance));
        match entered.then(|| fmu.leave_events(instance)).flatten() {
            Some(next) => self.events.next = next,
            None => self.failed = true,
        }
        let own = &mut self.own;
        own.resize(states.len(), 0.0);
        if !own.is_empty() && !self.failed {
            self.failed |= !fine(fmu.library.array("fmi2GetContinuousStates", instance, own));
        }
        for ((state, value), conversion) in states.iter_mut().zip(own).zip(&fmu.of_states) {
            *state = conversion.si(*value);
        }
        self.sense();
    }
}
