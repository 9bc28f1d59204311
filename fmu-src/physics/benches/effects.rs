//! What an effect costs that is off: QuarterCar with every effect neutral beside the same linear equations
//! written without any, step by step in one run. `cargo bench --package strut-physics`
#![allow(missing_docs, reason = "a program, not a library")]

use std::path::Path;
use std::time;

use strut_model::{
    About, Access, Experiment, Instant, Method, Model, NoSettings, ParameterSet, Real, Simulation, Variables,
    bundles,
};
use strut_physics::{PARAMETER_SETS, rigs::QuarterCar, signals::Motion};

type Parameters<R> = <QuarterCar as Model>::Parameters<R>;
type Input<R> = <QuarterCar as Model>::Input<R>;
type Output<R> = <QuarterCar as Model>::Output<R>;

/// Body and wheel, without the states of effects.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
struct State<R> {
    /// Body
    body: Motion<R>,
    /// Wheel
    wheel: Motion<R>,
}

/// TUM eq. 2–3 and nothing else.
struct Linear;

impl Model for Linear {
    const ABOUT: About =
        About { name: "Linear", experiment: Experiment::DEFAULT, method: Method::Explicit, ..About::DEFAULT };
    bundles! { parameters: Parameters, input: Input, state: State, output: Output }

    fn prepare(_: &NoSettings, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self)
    }

    #[inline]
    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (State { body, wheel }, p, u) = (*now.state, now.parameters, now.input);
        let (deflection, velocity) = (body.position - wheel.position, body.velocity - wheel.velocity);
        let strut = p.strut.stiffness * deflection + p.strut.damping * velocity;
        let tire = p.tire.stiffness * (u.road.position - wheel.position)
            + p.tire.damping * (u.road.velocity - wheel.velocity);
        let (per_sprung, per_unsprung) = (R::from(1.0) / p.sprung_mass, R::from(1.0) / p.unsprung_mass);
        let (mut rates, mut output) = (*now.state, zero());
        rates.body.position = body.velocity;
        rates.body.velocity = (u.actuator.force - strut) * per_sprung;
        rates.wheel.position = wheel.velocity;
        rates.wheel.velocity = (strut - u.actuator.force + tire) * per_unsprung;
        output.body.acceleration = rates.body.velocity;
        output.wheel.acceleration = rates.wheel.velocity;
        output.wheel.force = tire;
        output.suspension.deflection = deflection;
        output.suspension.velocity = velocity;
        output.tire.deflection = wheel.position - u.road.position;
        (rates, output)
    }
}

fn zero<R: Real>() -> Output<R> {
    strut_model::Bundle::from_fn(|_| R::from(0.0))
}

/// Nanoseconds for a step of 1 ms with moving inputs and one output read.
fn time<M: Model>(set: &str) -> (f64, f64) {
    const STEPS: u32 = 200_000;
    let (_, text) =
        PARAMETER_SETS.iter().find(|(name, _)| *name == format!("{set}.toml")).expect("a published set");
    let mut set = ParameterSet::parse(text).expect("it is well-formed");
    if M::ABOUT.name == "Linear" {
        set.model = M::ABOUT.name.into();
        set.values.retain(|name, _| name != "tire.lift_off");
    }
    let mut simulation = Simulation::<M>::new(Some(&set), None).expect("the set fits");
    simulation.set_up(0.0, Some(1e-6)).expect("times are finite");
    simulation.initialize().expect("the parameters are legal");
    let mut output = [0.0];
    let start = time::Instant::now();
    for step in 0..STEPS {
        let time = f64::from(step) * 1e-3;
        let phase = f64::from(step % 500) / 250.0 - 1.0;
        let inputs = [0.01 * phase, 0.01, 100.0 * phase];
        simulation.set_real(&[0, 1, 2], &inputs, Access::Continuous).expect("they are inputs");
        simulation.step(time, 1e-3).expect("it is integrable");
        simulation.real(&[3], &mut output).expect("it is an output");
    }
    (start.elapsed().as_secs_f64() * 1e9 / f64::from(STEPS), output[0])
}

fn main() {
    let (mut with, mut without, mut on) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..31 {
        let (a, b) = (
            time::<QuarterCar>("TumLinearOptimisedQuarterCar"),
            time::<Linear>("TumLinearOptimisedQuarterCar"),
        );
        assert!((a.1 - b.1).abs() < 1e-6 * b.1.abs(), "not the same equations: {} {}", a.1, b.1);
        with.push(a.0);
        without.push(b.0);
        on.push(time::<QuarterCar>("TumQuarterVehicle").0);
    }
    let median = |list: &[f64]| {
        let mut sorted = list.to_vec();
        sorted.sort_by(f64::total_cmp);
        sorted[sorted.len() / 2]
    };
    let ratio = |list: &[f64]| median(&list.iter().zip(&without).map(|(a, b)| a / b).collect::<Vec<_>>());
    println!("linear equations without effects   {:7.1} ns a step", median(&without));
    println!("QuarterCar, every effect off       {:7.1} ns a step, ratio {:.3}", median(&with), ratio(&with));
    println!("QuarterCar, TUM Table 10           {:7.1} ns a step, ratio {:.3}", median(&on), ratio(&on));
}
