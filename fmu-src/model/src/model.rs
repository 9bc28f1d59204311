//! What a model is.

use std::path::Path;

use crate::{Bundle, Real, Settings};

pub use strut_integrators::Method;

/// A continuous model, a sampled controller, or both: the equations, written once.
///
/// The bundles are usually named by [`bundles!`](crate::bundles).
pub trait Model: Sized + Send + 'static {
    /// Name, summary, printed equations, default experiment.
    const ABOUT: About;

    /// Parameters that are not real numbers and may change the structure.
    type Settings: Settings;
    /// Real parameters.
    type Parameters<R: Real>: Bundle<R>;
    /// Parameters that follow from others.
    type Derived<R: Real>: Bundle<R>;
    /// Inputs.
    type Input<R: Real>: Bundle<R>;
    /// Continuous states.
    type State<R: Real>: Bundle<R>;
    /// What a sampled part remembers from one tick to the next.
    type Memory<R: Real>: Bundle<R>;
    /// Outputs.
    type Output<R: Real>: Bundle<R>;

    /// Makes the model from its settings, reading files from the FMU's resources where it needs any.
    /// Called again when a setting changes.
    ///
    /// # Errors
    /// A sentence that says what is wrong and what to do.
    fn prepare(settings: &Self::Settings, resources: Option<&Path>) -> Result<Self, String>;

    /// The parameters that follow from others. Called when a parameter changes.
    fn derive<R: Real>(&self, parameters: &Self::Parameters<R>) -> Self::Derived<R> {
        let _ = parameters;
        const { assert!(<Self::Derived<R> as Bundle<R>>::LEN == 0, "implement `derive`") };
        Bundle::from_fn(|_| R::from(0.0))
    }

    /// Refuses parameters that are each within their bounds but not together.
    ///
    /// # Errors
    /// A sentence that names the parameters, their values and what must hold.
    fn check(&self, parameters: &Self::Parameters<f64>, derived: &Self::Derived<f64>) -> Result<(), String> {
        let _ = (parameters, derived);
        Ok(())
    }

    /// The rates of the states and the outputs.
    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (Self::State<R>, Self::Output<R>);

    /// The sampling period in seconds; none for a model without ticks.
    fn period(parameters: &Self::Parameters<f64>) -> Option<f64> {
        let _ = parameters;
        None
    }

    /// The memory after a tick.
    fn tick<R: Real>(&self, now: Instant<'_, Self, R>) -> Self::Memory<R> {
        *now.memory
    }
}

/// Everything that the equations may read.
pub struct Instant<'a, M: Model, R: Real> {
    /// Time in seconds.
    pub time: R,
    /// Continuous states.
    pub state: &'a M::State<R>,
    /// Inputs.
    pub input: &'a M::Input<R>,
    /// Parameters.
    pub parameters: &'a M::Parameters<R>,
    /// Parameters that follow from others.
    pub derived: &'a M::Derived<R>,
    /// What the last tick left.
    pub memory: &'a M::Memory<R>,
    /// Number of the tick: of the coming one in `tick`, of the next one in `equations`. A random
    /// number that is a function of it needs no other state ([`noise`](crate::noise)).
    pub tick: u64,
}

// Not derived: the model itself need not be copied.
impl<M: Model, R: Real> Clone for Instant<'_, M, R> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<M: Model, R: Real> Copy for Instant<'_, M, R> {}

/// Names the bundles of a model; those that it leaves out are empty.
///
/// ```text
/// impl Model for Decay {
///     strut_model::bundles! { parameters: Parameters, state: State, output: Output }
/// ```
/// The order is settings, parameters, derived, input, state, memory, output.
#[macro_export]
macro_rules! bundles {
    ($(settings: $settings:ident $(,)?)? $(parameters: $parameters:ident $(,)?)? $(derived: $derived:ident $(,)?)?
     $(input: $input:ident $(,)?)? $(state: $state:ident $(,)?)? $(memory: $memory:ident $(,)?)?
     $(output: $output:ident $(,)?)?) => {
        type Settings = $crate::bundles!(@or $($settings,)? $crate::NoSettings);
        type Parameters<R: $crate::Real> = $crate::bundles!(@or $($parameters<R>,)? $crate::NoVariables);
        type Derived<R: $crate::Real> = $crate::bundles!(@or $($derived<R>,)? $crate::NoVariables);
        type Input<R: $crate::Real> = $crate::bundles!(@or $($input<R>,)? $crate::NoVariables);
        type State<R: $crate::Real> = $crate::bundles!(@or $($state<R>,)? $crate::NoVariables);
        type Memory<R: $crate::Real> = $crate::bundles!(@or $($memory<R>,)? $crate::NoVariables);
        type Output<R: $crate::Real> = $crate::bundles!(@or $($output<R>,)? $crate::NoVariables);
    };
    (@or $first:ty $(, $rest:ty)?) => { $first };
}

/// What people read about a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct About {
    /// Identifier in CamelCase.
    pub name: &'static str,
    /// What it is, in one sentence.
    pub summary: &'static str,
    /// The kind of component.
    pub kind: Kind,
    /// The equations, as printed in the documentation.
    pub equations: &'static [Equation],
    /// What a user must know: conventions, corrections of the sources.
    pub notes: &'static [&'static str],
    /// The experiment that tools propose and the documentation plots.
    pub experiment: Experiment,
    /// The integration method that suits it.
    pub method: Method,
}

impl About {
    /// What is left to say when a name and a summary are given.
    pub const DEFAULT: Self = Self {
        name: "Model",
        summary: "",
        kind: Kind::Other,
        equations: &[],
        notes: &[],
        experiment: Experiment::DEFAULT,
        method: Method::Explicit,
    };
}

/// The kind of component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A plant: masses, springs, tyres.
    Rig,
    /// Turns a command into a force.
    Actuator,
    /// Turns measurements into a command.
    Controller,
    /// Excites a wheel.
    Road,
    /// Gives a signal over time.
    Source,
    /// Measures.
    Sensor,
    /// Anything else.
    Other,
}

impl Kind {
    /// In lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rig => "rig",
            Self::Actuator => "actuator",
            Self::Controller => "controller",
            Self::Road => "road",
            Self::Source => "source",
            Self::Sensor => "sensor",
            Self::Other => "other",
        }
    }
}

/// A printed equation with its source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Equation {
    /// In plain text.
    pub text: &'static str,
    /// Document and equation number.
    pub source: &'static str,
}

/// An experiment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Experiment {
    /// End in seconds; it starts at zero.
    pub stop: f64,
    /// Communication step in seconds.
    pub step: f64,
    /// Relative tolerance of the integration.
    pub tolerance: f64,
    /// What the inputs do; others rest.
    pub stimuli: &'static [(&'static str, Stimulus)],
    /// The outputs that are plotted.
    pub plot: &'static [&'static str],
}

impl Experiment {
    /// Ten seconds at one millisecond with resting inputs.
    pub const DEFAULT: Self = Self { stop: 10.0, step: 1e-3, tolerance: 1e-7, stimuli: &[], plot: &[] };
}

/// What an input does in an experiment, about its start value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stimulus {
    /// From zero to `height` at time `at`.
    Step {
        /// Time in seconds.
        at: f64,
        /// In the input's unit.
        height: f64,
    },
    /// `amplitude · sin(2π · frequency · t)`.
    Sine {
        /// In the input's unit.
        amplitude: f64,
        /// In hertz.
        frequency: f64,
    },
    /// `amplitude · cos(2π · frequency · t)`.
    Cosine {
        /// In the input's unit.
        amplitude: f64,
        /// In hertz.
        frequency: f64,
    },
}

impl Stimulus {
    /// The value at time `t`.
    pub fn at(self, t: f64) -> f64 {
        use std::f64::consts::TAU;
        match self {
            Self::Step { at, height } => {
                if t >= at {
                    height
                } else {
                    0.0
                }
            }
            Self::Sine { amplitude, frequency } => amplitude * (TAU * frequency * t).sin(),
            Self::Cosine { amplitude, frequency } => amplitude * (TAU * frequency * t).cos(),
        }
    }
}
