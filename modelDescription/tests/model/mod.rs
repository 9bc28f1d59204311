//! Small models: one with everything that a description of FMI 2.0 can say, one with almost nothing, one with what FMI 3.0 says
//! more.

use strut_model::{About, Choice, Experiment, Instant, Model, Real, Settings, Variables, bundles};

/// Rolls.
#[derive(Variables, Clone, Copy, Debug)]
pub struct Parameters<R> {
    /// Mass m
    #[var(unit = KG, start = 2.5, min = 0.1, max = 1e4, nominal = 10.0)]
    pub mass: R,
    /// Spring rate k
    #[var(unit = N_PER_M, start = 4.44495e13, min = 0.0, fixed)]
    pub stiffness: R,
}

/// What follows.
#[derive(Variables, Clone, Copy, Debug)]
pub struct Derived<R> {
    /// Natural frequency
    #[var(unit = HZ)]
    pub frequency: R,
}

/// What comes in.
#[derive(Variables, Clone, Copy, Debug)]
pub struct Input<R> {
    /// Force "from outside" <&>
    #[var(unit = N)]
    pub force: R,
}

/// What moves.
#[derive(Variables, Clone, Copy, Debug)]
pub struct State<R> {
    /// Position x
    #[var(unit = M, start = 1e-3, output)]
    pub position: R,
    /// Velocity v
    #[var(unit = M_PER_S)]
    pub velocity: R,
}

/// What goes out.
#[derive(Variables, Clone, Copy, Debug)]
pub struct Output<R> {
    /// Acceleration
    #[var(unit = M_PER_S2)]
    pub acceleration: R,
    /// Spring deflection over its length
    #[var(unit = ONE)]
    pub ratio: R,
}

/// Track gauge.
#[derive(Choice, Clone, Copy, Debug, PartialEq)]
pub enum Gauge {
    /// Wide
    Wide,
    /// Narrow
    Narrow,
}

/// What is chosen.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Track {
    /// Gauge
    #[set(name = "track.gauge", start = Gauge::Narrow)]
    pub gauge: Gauge,
    /// Profile
    #[set(name = "track.file", start = "<a> & 'b'.csv", tunable)]
    pub file: String,
    /// Number of axles
    #[set(name = "axles", start = 2)]
    pub axles: i32,
    /// With brakes
    #[set(name = "braked", start = true)]
    pub braked: bool,
}

/// A mass on a spring.
pub struct Wagon;

impl Model for Wagon {
    const ABOUT: About = About {
        name: "Wagon",
        summary: "A wagon of any \"Größe\" <&> gauge",
        experiment: Experiment { stop: 2.0, step: 1e-2, ..Experiment::DEFAULT },
        ..About::DEFAULT
    };
    bundles! { settings: Track, parameters: Parameters, derived: Derived, input: Input, state: State, output: Output }

    fn prepare(_: &Track, _: Option<&std::path::Path>) -> Result<Self, String> {
        Ok(Self)
    }
    fn derive<R: Real>(&self, p: &Parameters<R>) -> Derived<R> {
        Derived { frequency: p.stiffness / p.mass }
    }
    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (x, p) = (now.state, now.parameters);
        let acceleration = (now.input.force - p.stiffness * x.position) / p.mass;
        let rates = State { position: x.velocity, velocity: acceleration };
        (rates, Output { acceleration, ratio: x.position })
    }
}

/// What is held.
#[derive(Variables, Clone, Copy, Debug)]
pub struct Sample<R> {
    /// Value
    #[var(unit = M)]
    pub value: R,
}

/// Samples its input.
pub struct Delay;

impl Model for Delay {
    const ABOUT: About = About { name: "Delay", summary: "Holds its input", ..About::DEFAULT };
    type Settings = strut_model::NoSettings;
    type Parameters<R: Real> = strut_model::NoVariables;
    type Derived<R: Real> = strut_model::NoVariables;
    type Input<R: Real> = Sampled<R>;
    type State<R: Real> = strut_model::NoVariables;
    type Memory<R: Real> = Sample<R>;
    type Output<R: Real> = Held<R>;

    fn prepare(_: &Self::Settings, _: Option<&std::path::Path>) -> Result<Self, String> {
        Ok(Self)
    }
    fn period(_: &strut_model::NoVariables) -> Option<f64> {
        Some(0.01)
    }
    fn tick<R: Real>(&self, now: Instant<'_, Self, R>) -> Sample<R> {
        Sample { value: now.input.input }
    }
    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (strut_model::NoVariables, Held<R>) {
        (strut_model::NoVariables, Held { held: now.memory.value })
    }
}

/// What is sampled.
#[derive(Variables, Clone, Copy, Debug)]
pub struct Sampled<R> {
    /// Signal
    #[var(unit = M)]
    pub input: R,
}

/// What was sampled.
#[derive(Variables, Clone, Copy, Debug)]
pub struct Held<R> {
    /// Held signal
    #[var(unit = M)]
    pub held: R,
}

/// Where it stands.
#[derive(Variables, Clone, Copy, Debug)]
pub struct Height<R> {
    /// Height
    #[var(unit = M)]
    pub height: R,
}

/// What it stands on.
#[derive(Variables, Clone, Copy, Debug)]
pub struct Foot<R> {
    /// Foot
    pub foot: Height<R>,
}

/// A side of it.
#[derive(Variables, Clone, Copy, Debug)]
pub struct Side<R> {
    /// Force
    #[var(unit = N)]
    pub force: R,
}

/// Its upper end.
#[derive(Variables, Clone, Copy, Debug)]
pub struct End<R> {
    /// Height
    #[var(unit = M)]
    pub height: R,
    /// Left
    pub left: Side<R>,
}

/// What it shows.
#[derive(Variables, Clone, Copy, Debug)]
pub struct Top<R> {
    /// Top
    pub top: End<R>,
}

/// What it is made of.
#[derive(Variables, Clone, Copy, Debug)]
pub struct Points<R> {
    /// Points
    #[var(unit = M, start = [1.0, 2.5, 3.0], min = 0.0)]
    pub points: [R; 3],
}

/// Sways: signals in groups, an array, and an output that depends on time itself.
pub struct Mast;

impl Model for Mast {
    const ABOUT: About = About { name: "Mast", ..About::DEFAULT };
    bundles! { parameters: Points, input: Foot, output: Top }

    fn prepare(_: &strut_model::NoSettings, _: Option<&std::path::Path>) -> Result<Self, String> {
        Ok(Self)
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (strut_model::NoVariables, Top<R>) {
        let ([a, b, c], foot) = (now.parameters.points, now.input.foot.height);
        let left = Side { force: foot };
        (strut_model::NoVariables, Top { top: End { height: foot + a * b + c * now.time, left } })
    }
}
