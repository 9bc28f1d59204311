//! A leaking air spring: its pressure returns to the supply's through a throttle.
use strut_model::{About, Model, NoSettings, Now, Real, Variables};

/// Parameters
#[derive(Variables, Clone, Copy)]
pub struct Parameters<R> {
    /// Time constant of the throttle
    #[var(unit = S, start = 0.5, min = 1e-6)]
    time_constant: R,
}

/// State, which is the output as well
#[derive(Variables, Clone, Copy)]
pub struct State<R> {
    /// Force above the supply's
    #[var(unit = N, start = 1000.0, nominal = 1000.0, output)]
    force: R,
}

/// The model: T dF/dt = −F
pub struct AirSpring;

impl Model for AirSpring {
    const ABOUT: About =
        About { name: "AirSpring", summary: "Air spring that leaks through a throttle", ..About::DEFAULT };
    strut_model::bundles! { parameters: Parameters, state: State }

    fn prepare(_: &NoSettings, _: Option<&std::path::Path>) -> Result<Self, String> {
        Ok(Self)
    }

    fn equations<R: Real>(&self, now: Now<'_, Self, R>) -> (State<R>, strut_model::Nothing) {
        (State { force: -now.state.force / now.parameters.time_constant }, strut_model::Nothing)
    }
}

strut_fmi2::export_fmu!(AirSpring);
