//! Models that between them have everything that an FMU can have.

use std::path::Path;

use strut_model::{
    About, Choice, Instant, Model, NoSettings, NoVariables, Real, Settings, Variables, noise, unit,
};

/// Numbers in.
#[derive(Variables, Clone, Copy)]
pub struct Input<R> {
    /// Force
    #[var(unit = unit::N)]
    pub force: R,
}

/// Numbers out.
#[derive(Variables, Clone, Copy)]
pub struct Output<R> {
    /// Signal
    #[var(unit = unit::N)]
    pub signal: R,
}

/// One state.
#[derive(Variables, Clone, Copy)]
pub struct State<R> {
    /// Position
    #[var(unit = unit::M, start = 1.0, nominal = 0.5)]
    pub position: R,
}

/// Two parameters.
#[derive(Variables, Clone, Copy)]
pub struct Parameters<R> {
    /// Rate of decay
    #[var(unit = unit::PER_S, start = 2.0, min = 0.0)]
    pub rate: R,
    /// Gain
    #[var(unit = unit::ONE, start = 1.0, fixed)]
    pub gain: R,
}

/// x' = u - rate x, y = gain x²: continuous only.
pub struct Decay;

impl Model for Decay {
    const ABOUT: About = About { name: "Decay", ..About::DEFAULT };
    strut_model::bundles! { parameters: Parameters, input: Input, state: State, output: Output }

    fn prepare(_: &NoSettings, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self)
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (p, x) = (now.parameters, now.state.position);
        (State { position: now.input.force - p.rate * x }, Output { signal: p.gain * x * x })
    }
}

/// Sampling.
#[derive(Variables, Clone, Copy)]
pub struct Sampling<R> {
    /// Period
    #[var(unit = unit::S, start = 0.01, min = 1e-6)]
    pub period: R,
}

/// What is held.
#[derive(Variables, Clone, Copy)]
pub struct Memory<R> {
    /// Sum so far
    #[var(unit = unit::N)]
    pub sum: R,
}

/// Sums its noisy input at each tick: sampled only.
pub struct Controller;

impl Model for Controller {
    const ABOUT: About = About { name: "Controller", ..About::DEFAULT };
    strut_model::bundles! { parameters: Sampling, input: Input, memory: Memory, output: Output }

    fn prepare(_: &NoSettings, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self)
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (NoVariables, Output<R>) {
        (NoVariables, Output { signal: now.memory.sum })
    }

    fn period(parameters: &Sampling<f64>) -> Option<f64> {
        Some(parameters.period)
    }

    fn tick<R: Real>(&self, now: Instant<'_, Self, R>) -> Memory<R> {
        Memory { sum: now.memory.sum + now.input.force + R::from(noise(7, 0, now.tick)) }
    }
}

/// A controlled mass: states, memory and noise.
pub struct Hybrid;

impl Model for Hybrid {
    const ABOUT: About = About { name: "Hybrid", ..About::DEFAULT };
    strut_model::bundles! { parameters: Sampling, input: Input, state: State, memory: Memory, output: Output }

    fn prepare(_: &NoSettings, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self)
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let x = now.state.position;
        (State { position: now.input.force - now.memory.sum - x }, Output { signal: now.memory.sum + x })
    }

    fn period(parameters: &Sampling<f64>) -> Option<f64> {
        Some(parameters.period)
    }

    fn tick<R: Real>(&self, now: Instant<'_, Self, R>) -> Memory<R> {
        Memory { sum: R::from(0.5) * now.memory.sum + now.state.position + R::from(noise(3, 1, now.tick)) }
    }
}

/// x' = x² + u: panics if the input is 13, leaves the numbers if it is large.
pub struct Fragile;

impl Model for Fragile {
    const ABOUT: About = About { name: "Fragile", ..About::DEFAULT };
    strut_model::bundles! { input: Input, state: State, output: Output }

    fn prepare(_: &NoSettings, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self)
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (x, u) = (now.state.position, now.input.force);
        assert!(!(u - R::from(13.0)).vanishes(), "100 % unlucky %s");
        (State { position: x * x + u }, Output { signal: u })
    }
}

/// A shape.
#[derive(Choice, Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Round
    Round,
    /// Square
    Square,
}

/// A setting of each type.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Shape
    #[set(start = Shape::Round)]
    pub shape: Shape,
    /// Count
    #[set(start = 3, tunable)]
    pub count: i32,
    /// Switch
    #[set(start = true, tunable)]
    pub switch: bool,
    /// Label; the model refuses "no"
    #[set(start = "räder", tunable)]
    pub label: String,
    /// Second label
    #[set(name = "label.second", start = "")]
    pub second: String,
}

/// Shows its settings.
pub struct Configured(f64);

impl Model for Configured {
    const ABOUT: About = About { name: "Configured", ..About::DEFAULT };
    strut_model::bundles! { settings: Sheet, output: Output }

    fn prepare(sheet: &Sheet, _: Option<&Path>) -> Result<Self, String> {
        if sheet.label == "no" {
            return Err("`label` cannot be \"no\": give another".into());
        }
        let shape = if sheet.shape == Shape::Round { 0.5 } else { 0.25 };
        Ok(Self(f64::from(sheet.count) + f64::from(u8::from(sheet.switch)) * 100.0 + shape))
    }

    fn equations<R: Real>(&self, _: Instant<'_, Self, R>) -> (NoVariables, Output<R>) {
        (NoVariables, Output { signal: R::from(self.0) })
    }
}

/// A stop.
#[derive(Variables, Clone, Copy)]
pub struct Stop<R> {
    /// Stiffness
    #[var(unit = unit::N_PER_M, start = 100.0, min = 0.0)]
    pub stiffness: R,
}

/// x' = clamp(u) - stop(x): three kinks.
pub struct Stopped;

impl Model for Stopped {
    const ABOUT: About = About { name: "Stopped", ..About::DEFAULT };
    strut_model::bundles! { parameters: Stop, input: Input, state: State, output: Output }

    fn prepare(_: &NoSettings, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self)
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let pushed = now.input.force.clamp(R::from(-2.0), R::from(2.0));
        let stiffness = now.parameters.stiffness;
        let stop = if stiffness.vanishes() {
            R::from(0.0)
        } else {
            stiffness * (now.state.position - 0.5).max(R::from(0.0))
        };
        (State { position: pushed - stop }, Output { signal: stop })
    }
}

/// A table.
#[derive(Variables, Clone, Copy)]
pub struct Points<R> {
    /// Offset
    #[var(unit = unit::N, start = 1.0)]
    pub offset: R,
    /// Weights
    #[var(unit = unit::N, start = [1.0, 2.0, 3.0], min = 0.0)]
    pub weight: [R; 3],
}

/// x' = u - w1 x, y = w2 x + w3 u t + offset: an array, and time itself.
pub struct Tabled;

impl Model for Tabled {
    const ABOUT: About = About { name: "Tabled", ..About::DEFAULT };
    strut_model::bundles! { parameters: Points, input: Input, state: State, output: Output }

    fn prepare(_: &NoSettings, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self)
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let ([a, b, c], u, x) = (now.parameters.weight, now.input.force, now.state.position);
        (State { position: u - a * x }, Output { signal: b * x + c * u * now.time + now.parameters.offset })
    }
}
