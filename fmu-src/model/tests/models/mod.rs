//! Small models whose solutions are known in closed form, and how the tests read and set them.

use strut_model::{
    About, Access, Choice, Error, Experiment, Instant, Interface, Model, NoSettings, Real, Settings,
    Simulation, Variables, noise,
};

/// A mass on a spring and a damper, driven by a force: x'' = (F − d x' − k x) / m.
pub struct Oscillator;

/// What it is made of
#[derive(Variables, Clone, Copy)]
pub struct Parameters<R> {
    /// Mass
    #[var(unit = KG, start = 1.0, min = 1e-6)]
    pub mass: R,
    /// Spring
    pub spring: Spring<R>,
}

/// A spring
#[derive(Variables, Clone, Copy)]
pub struct Spring<R> {
    /// Stiffness
    #[var(unit = N_PER_M, start = 4.0, min = 0.0)]
    pub stiffness: R,
    /// Damping
    #[var(unit = N_S_PER_M, start = 0.0, min = 0.0, fixed)]
    pub damping: R,
}

/// What follows
#[derive(Variables, Clone, Copy)]
pub struct Derived<R> {
    /// Angular frequency without damping
    #[var(unit = PER_S, fixed)]
    pub angular_frequency: R,
}

/// Inputs
#[derive(Variables, Clone, Copy)]
pub struct Input<R> {
    /// Force
    #[var(unit = N)]
    pub force: R,
}

/// States
#[derive(Variables, Clone, Copy)]
pub struct State<R> {
    /// Position
    #[var(unit = M, start = 1.0, output)]
    pub position: R,
    /// Velocity
    #[var(unit = M_PER_S)]
    pub velocity: R,
}

/// Outputs
#[derive(Variables, Clone, Copy)]
pub struct Output<R> {
    /// Acceleration
    #[var(unit = M_PER_S2)]
    pub acceleration: R,
    /// Energy
    #[var(unit = N)]
    pub energy: R,
}

impl Model for Oscillator {
    const ABOUT: About = About {
        name: "Oscillator",
        experiment: Experiment { tolerance: 1e-9, ..Experiment::DEFAULT },
        ..About::DEFAULT
    };
    strut_model::bundles! { parameters: Parameters, derived: Derived, input: Input, state: State, output: Output }

    fn prepare(_: &NoSettings, _: Option<&std::path::Path>) -> Result<Self, String> {
        Ok(Self)
    }

    fn derive<R: Real>(&self, p: &Parameters<R>) -> Derived<R> {
        Derived { angular_frequency: (p.spring.stiffness / p.mass).sqrt() }
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let Instant { state: x, input: u, parameters: p, .. } = now;
        let acceleration =
            (u.force - p.spring.damping * x.velocity - p.spring.stiffness * x.position) / p.mass;
        let energy = (p.mass * x.velocity.squared() + p.spring.stiffness * x.position.squared()) * 0.5;
        (State { position: x.velocity, velocity: acceleration }, Output { acceleration, energy })
    }
}

/// A sampled counter with noise: the memory adds up the input and a random number at each tick.
pub struct Counter {
    pub seed: u64,
}

/// How the noise is scaled
#[derive(Choice, Clone, Copy, Debug, PartialEq)]
pub enum Loudness {
    /// No noise
    Silent,
    /// Standard normal
    Loud,
}

#[derive(Settings, Clone, Debug, PartialEq)]
pub struct CounterSettings {
    /// Seed of the noise
    #[set(start = 3)]
    pub seed: i32,
    /// Loudness
    #[set(start = Loudness::Silent, tunable)]
    pub loudness: Loudness,
}

/// How often
#[derive(Variables, Clone, Copy)]
pub struct Period<R> {
    /// Period
    #[var(unit = S, start = 0.01, min = 1e-6, fixed)]
    pub period: R,
}

/// What is kept
#[derive(Variables, Clone, Copy)]
pub struct Memory<R> {
    /// Sum
    #[var(unit = N)]
    pub sum: R,
}

/// What is told
#[derive(Variables, Clone, Copy)]
pub struct Told<R> {
    /// Sum
    #[var(unit = N)]
    pub sum: R,
}

impl Model for Counter {
    const ABOUT: About = About { name: "Counter", ..About::DEFAULT };
    strut_model::bundles! { settings: CounterSettings, parameters: Period, input: Input, memory: Memory, output: Told }

    fn prepare(settings: &CounterSettings, _: Option<&std::path::Path>) -> Result<Self, String> {
        match settings.seed {
            ..0 => Err(format!("seed = {}: give one that is not negative", settings.seed)),
            seed => Ok(Self { seed: if settings.loudness == Loudness::Loud { seed as u64 } else { 0 } }),
        }
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (strut_model::NoVariables, Told<R>) {
        (strut_model::NoVariables, Told { sum: now.memory.sum })
    }

    fn period(p: &Period<f64>) -> Option<f64> {
        Some(p.period)
    }

    fn tick<R: Real>(&self, now: Instant<'_, Self, R>) -> Memory<R> {
        let random = if self.seed == 0 { 0.0 } else { noise(self.seed, 0, now.tick) };
        Memory { sum: now.memory.sum + now.input.force + random }
    }
}

pub fn started<M: Model>() -> Simulation<M> {
    let mut simulation = Simulation::new(None, None).unwrap();
    simulation.set_up(0.0, None).unwrap();
    simulation.initialize().unwrap();
    simulation
}

pub fn reference<M: Model>(name: &str) -> u32 {
    Interface::of::<M>(None, None).unwrap().variable(name).unwrap().reference
}

pub fn read<M: Model>(simulation: &mut Simulation<M>, name: &str) -> f64 {
    let mut value = [0.0];
    simulation.real(&[reference::<M>(name)], &mut value).unwrap();
    value[0]
}

pub fn set<M: Model>(
    simulation: &mut Simulation<M>,
    name: &str,
    value: f64,
    access: Access,
) -> Result<(), Error> {
    simulation.set_real(&[reference::<M>(name)], &[value], access)
}
