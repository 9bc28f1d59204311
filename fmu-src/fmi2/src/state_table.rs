//! Which function may be called in which state: sections 3.2.3 and 4.2.4 of the standard.
//!
//! The standard's states `stepInProgress` and `stepCanceled` are never reached, because a step has ended
//! when `fmi2DoStep` returns; nor is `error`, because a call that is refused changes nothing.
//!
//! More than the tables allow is one thing: start values may be read in the state Instantiated. Importers do that, and
//! their users expect the values of the description there.

use std::fmt;

/// A phase of an instance's life, as the standard's state machines name them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// After `fmi2Instantiate` or `fmi2Reset`.
    Instantiated,
    /// After `fmi2EnterInitializationMode`.
    Initialization,
    /// Model exchange: at an event.
    Event,
    /// Model exchange: between events.
    Continuous,
    /// Co-simulation: at a communication point.
    StepComplete,
    /// Co-simulation: after a step that was discarded.
    StepFailed,
    /// After `fmi2Terminate`.
    Terminated,
    /// After a panic.
    Fatal,
}

impl Phase {
    const ALL: [Self; 8] = [
        Self::Instantiated,
        Self::Initialization,
        Self::Event,
        Self::Continuous,
        Self::StepComplete,
        Self::StepFailed,
        Self::Terminated,
        Self::Fatal,
    ];

    /// Its name, and how one gets there.
    fn explained(self) -> &'static str {
        match self {
            Self::Instantiated => "instantiated (after fmi2Instantiate or fmi2Reset)",
            Self::Initialization => "Initialization Mode (after fmi2EnterInitializationMode)",
            Self::Event => "Event Mode (after fmi2ExitInitializationMode or fmi2EnterEventMode)",
            Self::Continuous => "Continuous-Time Mode (after fmi2EnterContinuousTimeMode)",
            Self::StepComplete => "step complete (after fmi2ExitInitializationMode or fmi2DoStep)",
            Self::StepFailed => "step failed (after fmi2DoStep returned fmi2Discard)",
            Self::Terminated => "terminated (after fmi2Terminate)",
            Self::Fatal => "fatal (after fmi2Fatal was returned)",
        }
    }
}

/// What an instance is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The host integrates.
    ModelExchange,
    /// The instance integrates.
    CoSimulation,
}

impl Kind {
    /// From `fmi2Type` as it comes from C.
    pub fn from_raw(kind: libc::c_int) -> Option<Self> {
        match kind {
            0 => Some(Self::ModelExchange),
            1 => Some(Self::CoSimulation),
            _ => None,
        }
    }

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::ModelExchange => "model exchange",
            Self::CoSimulation => "co-simulation",
        }
    }
}

/// Kind and phase of an instance, as one bit: whether a call is legal is then a single test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct State(u16);

impl State {
    /// The state of a kind and a phase.
    pub const fn new(kind: Kind, phase: Phase) -> Self {
        Self(1 << (phase as u16 + 8 * kind as u16))
    }

    /// What the instance is for.
    pub fn kind(self) -> Kind {
        if self.0 < 1 << 8 { Kind::ModelExchange } else { Kind::CoSimulation }
    }

    /// The phase.
    pub fn phase(self) -> Phase {
        Phase::ALL[self.0.trailing_zeros() as usize % 8]
    }

    /// Another phase of the same kind.
    pub fn at(self, phase: Phase) -> Self {
        Self::new(self.kind(), phase)
    }

    /// As a number, for a saved state.
    pub fn to_bits(self) -> u16 {
        self.0
    }

    /// From a number; none if it is not one that an instance can be saved in.
    pub fn from_bits(bits: u16) -> Option<Self> {
        GET_FMU_STATE.legal.iter().find(|state| state.0 == bits)
    }
}

impl fmt::Display for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {}", self.kind().name(), self.phase().explained())
    }
}

/// A set of states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateSet(u16);

impl StateSet {
    /// Whether a state is one of the set.
    #[inline]
    pub fn contains(self, state: State) -> bool {
        self.0 & state.0 != 0
    }

    /// The states of the set.
    pub fn iter(self) -> impl Iterator<Item = State> {
        (0..16).map(|bit| State(1 << bit)).filter(move |state| self.contains(*state))
    }
}

/// A function of the standard that works on an instance.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    /// Its C name.
    pub name: &'static str,
    /// Where it may be called.
    pub legal: StateSet,
}

impl Function {
    /// Why it may not be called in a state, and what to do.
    pub fn refusal(&self, state: State) -> String {
        if state.phase() == Phase::Fatal {
            return "an earlier call returned fmi2Fatal: only fmi2FreeInstance may follow".into();
        }
        let kind = state.kind();
        let places: Vec<&str> = self
            .legal
            .iter()
            .filter(|other| other.kind() == kind)
            .map(|other| other.phase().explained())
            .collect();
        let remedy = if !places.is_empty() {
            format!("call it in: {}", places.join(", "))
        } else if let Some(other) = self.legal.iter().next() {
            format!("it is a function for {}: choose that type at fmi2Instantiate", other.kind().name())
        } else {
            "a step has always ended when fmi2DoStep returns, so that there is never one to cancel".into()
        };
        format!("not allowed in the state {state}; {remedy}")
    }
}

macro_rules! bit {
    (x $kind:ident $phase:ident) => {
        State::new(Kind::$kind, Phase::$phase).0
    };
    (- $kind:ident $phase:ident) => {
        0
    };
}

macro_rules! table {
    ($($constant:ident $name:ident:
       $a:tt $b:tt $c:tt $d:tt $e:tt | $f:tt $g:tt $h:tt $i:tt $j:tt;)*) => {
        $(#[doc = concat!("`", stringify!($name), "`.")]
        pub const $constant: Function = Function {
            name: stringify!($name),
            legal: StateSet(
                bit!($a ModelExchange Instantiated) | bit!($b ModelExchange Initialization)
                    | bit!($c ModelExchange Event) | bit!($d ModelExchange Continuous)
                    | bit!($e ModelExchange Terminated) | bit!($f CoSimulation Instantiated)
                    | bit!($g CoSimulation Initialization) | bit!($h CoSimulation StepComplete)
                    | bit!($i CoSimulation StepFailed) | bit!($j CoSimulation Terminated),
            ),
        };)*
        /// Every function that works on an instance.
        pub const FUNCTIONS: &[Function] = &[$($constant),*];
    };
}

table! {
    //                                                                model exchange
    //                                                                instantiated
    //                                                                | Initialization Mode
    //                                                                | | Event Mode
    //                                                                | | | Continuous-Time Mode
    //                                                                | | | | terminated
    //                                                                | | | | |   co-simulation
    //                                                                | | | | |   instantiated
    //                                                                | | | | |   | Initialization Mode
    //                                                                | | | | |   | | step complete
    //                                                                | | | | |   | | | step failed
    //                                                                | | | | |   | | | | terminated
    SET_DEBUG_LOGGING                  fmi2SetDebugLogging:           x x x x x | x x x x x;
    FREE_INSTANCE                      fmi2FreeInstance:              x x x x x | x x x x x;
    SETUP_EXPERIMENT                   fmi2SetupExperiment:           x - - - - | x - - - -;
    ENTER_INITIALIZATION_MODE          fmi2EnterInitializationMode:   x - - - - | x - - - -;
    EXIT_INITIALIZATION_MODE           fmi2ExitInitializationMode:    - x - - - | - x - - -;
    TERMINATE                          fmi2Terminate:                 - - x x - | - - x x -;
    RESET                              fmi2Reset:                     x x x x x | x x x x x;
    GET_REAL                           fmi2GetReal:                   x x x x x | x x x x x;
    GET_INTEGER                        fmi2GetInteger:                x x x x x | x x x x x;
    GET_BOOLEAN                        fmi2GetBoolean:                x x x x x | x x x x x;
    GET_STRING                         fmi2GetString:                 x x x x x | x x x x x;
    SET_REAL                           fmi2SetReal:                   x x x x - | x x x - -;
    SET_INTEGER                        fmi2SetInteger:                x x x - - | x x x - -;
    SET_BOOLEAN                        fmi2SetBoolean:                x x x - - | x x x - -;
    SET_STRING                         fmi2SetString:                 x x x - - | x x x - -;
    GET_FMU_STATE                      fmi2GetFMUstate:               x x x x x | x x x x x;
    SET_FMU_STATE                      fmi2SetFMUstate:               x x x x x | x x x x x;
    FREE_FMU_STATE                     fmi2FreeFMUstate:              x x x x x | x x x x x;
    SERIALIZED_FMU_STATE_SIZE          fmi2SerializedFMUstateSize:    x x x x x | x x x x x;
    SERIALIZE_FMU_STATE                fmi2SerializeFMUstate:         x x x x x | x x x x x;
    DE_SERIALIZE_FMU_STATE             fmi2DeSerializeFMUstate:       x x x x x | x x x x x;
    GET_DIRECTIONAL_DERIVATIVE         fmi2GetDirectionalDerivative:  - x x x x | - x x x x;
    ENTER_EVENT_MODE                   fmi2EnterEventMode:            - - x x - | - - - - -;
    NEW_DISCRETE_STATES                fmi2NewDiscreteStates:         - - x - - | - - - - -;
    ENTER_CONTINUOUS_TIME_MODE         fmi2EnterContinuousTimeMode:   - - x - - | - - - - -;
    COMPLETED_INTEGRATOR_STEP          fmi2CompletedIntegratorStep:   - - - x - | - - - - -;
    SET_TIME                           fmi2SetTime:                   - - x x - | - - - - -;
    SET_CONTINUOUS_STATES              fmi2SetContinuousStates:       - - - x - | - - - - -;
    GET_EVENT_INDICATORS               fmi2GetEventIndicators:        - x x x x | - - - - -;
    GET_CONTINUOUS_STATES              fmi2GetContinuousStates:       - x x x x | - - - - -;
    GET_DERIVATIVES                    fmi2GetDerivatives:            - x x x x | - - - - -;
    GET_NOMINALS_OF_CONTINUOUS_STATES  fmi2GetNominalsOfContinuousStates:
                                                                      x - x x x | - - - - -;
    SET_REAL_INPUT_DERIVATIVES         fmi2SetRealInputDerivatives:   - - - - - | x x x - -;
    GET_REAL_OUTPUT_DERIVATIVES        fmi2GetRealOutputDerivatives:  - - - - - | - - x x x;
    DO_STEP                            fmi2DoStep:                    - - - - - | - - x - -;
    CANCEL_STEP                        fmi2CancelStep:                - - - - - | - - - - -;
    GET_STATUS                         fmi2GetStatus:                 - - - - - | - - x x x;
    GET_REAL_STATUS                    fmi2GetRealStatus:             - - - - - | - - x x x;
    GET_INTEGER_STATUS                 fmi2GetIntegerStatus:          - - - - - | - - x x x;
    GET_BOOLEAN_STATUS                 fmi2GetBooleanStatus:          - - - - - | - - x x x;
    GET_STRING_STATUS                  fmi2GetStringStatus:           - - - - - | - - x x x;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_survive_their_numbers() {
        for state in GET_FMU_STATE.legal.iter() {
            assert_eq!(State::from_bits(state.to_bits()), Some(state));
            assert_eq!(State::new(state.kind(), state.phase()), state);
        }
        let fatal = State::new(Kind::CoSimulation, Phase::Fatal);
        for bits in [0, 3, fatal.to_bits(), State::new(Kind::CoSimulation, Phase::Event).to_bits()] {
            assert_eq!(State::from_bits(bits), None);
        }
    }

    #[test]
    fn refusals_say_what_to_do() {
        let event = State::new(Kind::ModelExchange, Phase::Event);
        let step = State::new(Kind::CoSimulation, Phase::StepComplete);
        assert!(DO_STEP.refusal(event).contains("function for co-simulation"));
        assert!(SET_TIME.refusal(step).contains("function for model exchange"));
        assert!(SETUP_EXPERIMENT.refusal(step).contains("call it in: instantiated (after"));
        assert!(CANCEL_STEP.refusal(step).contains("never one to cancel"));
        assert!(DO_STEP.refusal(step.at(Phase::Fatal)).contains("only fmi2FreeInstance"));
    }
}
