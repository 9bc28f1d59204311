//! The smallest FMU library: a tank that empties, x' = u - a x.

use strut_model::{About, Instant, Model, Real, Variables, unit};

/// What it is made of.
#[derive(Variables, Clone, Copy)]
pub struct Parameters<R> {
    /// Rate of decay
    #[var(unit = unit::PER_S, start = 1.0, min = 0.0)]
    pub rate: R,
}

/// What it is given.
#[derive(Variables, Clone, Copy)]
pub struct Input<R> {
    /// Supply
    #[var(unit = unit::M_PER_S)]
    pub supply: R,
}

/// What it remembers.
#[derive(Variables, Clone, Copy)]
pub struct State<R> {
    /// Level
    #[var(unit = unit::M, start = 1.0)]
    pub level: R,
}

/// What it shows.
#[derive(Variables, Clone, Copy)]
pub struct Output<R> {
    /// Outflow
    #[var(unit = unit::M_PER_S)]
    pub outflow: R,
}

/// The model.
pub struct Decay;

impl Model for Decay {
    const ABOUT: About = About { name: "Decay", summary: "A tank that empties", ..About::DEFAULT };
    strut_model::bundles! { parameters: Parameters, input: Input, state: State, output: Output }

    fn prepare(_: &Self::Settings, _: Option<&std::path::Path>) -> Result<Self, String> {
        Ok(Self)
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let outflow = now.parameters.rate * now.state.level;
        (State { level: now.input.supply - outflow }, Output { outflow })
    }
}

strut_fmi::export_fmu!(Decay);
