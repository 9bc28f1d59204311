//! A leaking air spring: its pressure returns to the supply's through a throttle.
use strut_model::{About, Model, NoSettings, Instant, Real, Variables};

/// Parameters
#[derive(Variables, Clone, Copy)]
pub struct Parameters<R> {
    /// Rate at which the throttle lets the pressure even out
    #[var(unit = PER_S, start = 2.0, min = 0.0)]
    rate: R,
}

/// State, which is the output as well
#[derive(Variables, Clone, Copy)]
pub struct State<R> {
    /// Force above the supply's
    #[var(unit = N, start = 1000.0, nominal = 1000.0, output)]
    force: R,
}

/// The model: dF/dt = −r F
pub struct AirSpring;

impl Model for AirSpring {
    const ABOUT: About =
        About { name: "AirSpring", summary: "Air spring that leaks through a throttle", ..About::DEFAULT };
    strut_model::bundles! { parameters: Parameters, state: State }

    fn prepare(_: &NoSettings, _: Option<&std::path::Path>) -> Result<Self, String> {
        Ok(Self)
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, strut_model::NoVariables) {
        (State { force: -now.parameters.rate * now.state.force }, strut_model::NoVariables)
    }
}

strut_fmi::export_fmu!(AirSpring);
