//! States of an instance, and in which of them a function may be called.

use std::fmt;

/// A phase of an instance's life.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// After instantiation or a reset.
    Instantiated,
    /// In Initialization Mode.
    Initialization,
    /// At an event.
    Event,
    /// Model exchange: between events.
    Continuous,
    /// Co-simulation: at a communication point (Step Mode of FMI 3.0).
    StepComplete,
    /// Co-simulation in FMI 2.0: after a step that was discarded.
    StepFailed,
    /// Terminated.
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
    pub const fn to_bits(self) -> u16 {
        self.0
    }
}

/// A set of states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateSet(u16);

impl StateSet {
    /// The states of these bits.
    pub const fn from_bits(bits: u16) -> Self {
        Self(bits)
    }

    /// Whether a state is one of the set.
    #[inline]
    pub fn contains(self, state: State) -> bool {
        self.0 & state.0 != 0
    }

    /// The states of the set.
    pub fn iter(self) -> impl Iterator<Item = State> {
        (0..16).map(|bit| State(1 << bit)).filter(move |state| self.contains(*state))
    }

    /// The state of a number; none if it is not one of the set.
    pub fn state(self, bits: u16) -> Option<State> {
        self.iter().find(|state| state.0 == bits)
    }
}

/// A version of the standard: what its instances begin with, and its names for what messages speak of.
#[derive(Debug)]
pub struct Version {
    /// What an instance begins with. It does not make a wild pointer safe, nothing could, but tells most
    /// mistakes of a host (a freed instance, a saved state, an instance of another library) from an instance.
    pub mark: u64,
    /// What its names begin with: `fmi2`.
    pub prefix: &'static str,
    /// The function that takes the stop time.
    pub set_up: &'static str,
    /// The function that saves a state.
    pub get_state: &'static str,
    /// The function that makes a state of bytes.
    pub de_serialize: &'static str,
    /// The function that returns the size of a state in bytes.
    pub state_size: &'static str,
    /// Whether warnings are logged only if the host asks for them.
    pub optional_warnings: bool,
    /// What to do after a step that was discarded.
    pub after_discard: &'static str,
    /// Why some functions are never legal.
    pub never: &'static str,
    /// A phase's name, and how one gets there.
    pub explained: fn(Kind, Phase) -> &'static str,
}

/// A function of the standard that works on an instance.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    /// Its C name.
    pub name: &'static str,
    /// Where it may be called.
    pub legal: StateSet,
    /// Whose it is.
    pub version: &'static Version,
}

impl Function {
    /// Why it may not be called in a state, and what to do.
    pub fn refusal(&self, state: State) -> String {
        let Version { prefix, never, explained, .. } = self.version;
        if state.phase() == Phase::Fatal {
            return format!("an earlier call returned {prefix}Fatal: only {prefix}FreeInstance may follow");
        }
        let kind = state.kind();
        let same = self.legal.iter().filter(|other| other.kind() == kind);
        let places: Vec<&str> = same.map(|other| explained(kind, other.phase())).collect();
        let remedy = if !places.is_empty() {
            format!("call it in: {}", places.join(", "))
        } else if let Some(other) = self.legal.iter().next() {
            format!("it is a function for {}: choose that type at instantiation", other.kind().name())
        } else {
            (*never).to_owned()
        };
        format!("not allowed in the state {}; {remedy}", Explained(state, self.version))
    }
}

/// A state in a version's words.
struct Explained(State, &'static Version);

impl fmt::Display for Explained {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(state, version) = self;
        write!(f, "{}, {}", state.kind().name(), (version.explained)(state.kind(), state.phase()))
    }
}

/// A version's functions with their legal states, one line each: `x` where it may be called, five states of model exchange
/// and five of co-simulation.
macro_rules! table {
    ($version:ident;
     $a:ident $b:ident $c:ident $d:ident $e:ident | $f:ident $g:ident $h:ident $i:ident $j:ident;
     $($constant:ident $name:ident:
       $ma:tt $mb:tt $mc:tt $md:tt $me:tt | $mf:tt $mg:tt $mh:tt $mi:tt $mj:tt;)*) => {
        $(#[doc = concat!("`", stringify!($name), "`.")]
        pub const $constant: Function = Function {
            name: stringify!($name),
            legal: StateSet::from_bits(
                bit!($ma ModelExchange $a) | bit!($mb ModelExchange $b) | bit!($mc ModelExchange $c)
                    | bit!($md ModelExchange $d) | bit!($me ModelExchange $e) | bit!($mf CoSimulation $f)
                    | bit!($mg CoSimulation $g) | bit!($mh CoSimulation $h) | bit!($mi CoSimulation $i)
                    | bit!($mj CoSimulation $j),
            ),
            version: &$version,
        };)*
        /// Every function that works on an instance.
        pub const FUNCTIONS: &[Function] = &[$($constant),*];
    };
}
pub(crate) use table;

/// The bit of a state if the mark is an `x`.
macro_rules! bit {
    (x $kind:ident $phase:ident) => {
        State::new(Kind::$kind, Phase::$phase).to_bits()
    };
    (- $kind:ident $phase:ident) => {
        0
    };
}
pub(crate) use bit;
