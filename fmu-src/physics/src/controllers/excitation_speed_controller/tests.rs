use proptest::prelude::*;
use strut_model::{Bundle, Declarations, Settings};

use super::*;
use crate::actuators::EccentricDrive;
use crate::rigs::SasRig;

fn starts<B: Bundle<f64>>() -> B {
    let declared = Declarations::of::<B>();
    Bundle::from_fn(|i| declared[i].start)
}

fn list<B: Bundle<f64>>(bundle: &B) -> Vec<f64> {
    let mut list = Vec::new();
    bundle.for_each(|_, number| list.push(number));
    list
}

/// The controller with its memory.
struct Controller {
    parameters: Parameters<f64>,
    memory: Memory<f64>,
    tick: u64,
}

impl Controller {
    fn new(parameters: Parameters<f64>) -> Self {
        Self { parameters, memory: Bundle::from_fn(|_| 0.0), tick: 0 }
    }

    fn tick(&mut self, frequency_reference: f64, angle: f64, speed: f64) -> f64 {
        self.memory = ExcitationSpeedController.tick(Instant {
            time: self.tick as f64 * self.parameters.period,
            state: &NoVariables,
            input: &Input { frequency_reference, eccentric: Turning { angle, speed } },
            parameters: &self.parameters,
            derived: &NoVariables,
            memory: &self.memory,
            tick: self.tick,
        });
        self.tick += 1;
        self.memory.duty
    }
}

/// Rates and outputs of a model with its declared values but for some changes.
fn evaluate<M: Model>(changes: &[(&str, f64)], state: &[f64], input: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let model = M::prepare(&M::Settings::starts(), None).unwrap();
    let declared = Declarations::of::<M::Parameters<f64>>();
    let value = |i: usize| {
        let change = changes.iter().find(|(name, _)| *name == declared[i].name);
        change.map_or(declared[i].start, |(_, value)| *value)
    };
    let parameters = M::Parameters::<f64>::from_fn(value);
    let (rates, output) = model.equations(Instant {
        time: 0.0,
        state: &Bundle::from_fn(|i| state[i]),
        input: &Bundle::from_fn(|i| input[i]),
        parameters: &parameters,
        derived: &model.derive(&parameters),
        memory: &starts(),
        tick: 0,
    });
    (list(&rates), list(&output))
}

/// Rates of drive and rig together, the brake without current.
fn rates(x: [f64; 6], duty: f64) -> [f64; 6] {
    let friction = [("eccentric.coulomb.torque", 0.1), ("eccentric.coulomb.speed", 0.5)];
    // The rig needs the eccentric's height, the drive the tyre's force.
    let (_, drive) = evaluate::<EccentricDrive>(&friction, &x[..2], &[duty, 0.0]);
    let (arms, rig) = evaluate::<SasRig>(&[], &x[2..], &[0.1921 * 1.37 * (x[5] - x[3]), drive[0], drive[1]]);
    let force = rig[rig.len() - 1];
    let (turn, _) = evaluate::<EccentricDrive>(&friction, &x[..2], &[duty, force]);
    [turn[0], turn[1], arms[0], arms[1], arms[2], arms[3]]
}

/// Times and frequencies in hertz, every 10 ms, of rig and drive under a law for the duty cycle that sees time,
/// angle and speed.
fn run(seconds: usize, mut law: impl FnMut(f64, f64, f64) -> f64) -> Vec<[f64; 3]> {
    let h = 1e-3;
    let start: <SasRig as Model>::State<f64> = starts();
    let arms = list(&start);
    let mut x = [0.0, 0.0, arms[0], arms[1], arms[2], arms[3]];
    let mut samples = Vec::new();
    for sample in 0..seconds * 100 {
        let t = sample as f64 * 0.01;
        let duty = law(t, x[0], x[1]);
        samples.push([t, x[1] / TAU, x[0] / TAU]);
        for _ in 0..10 {
            let moved = |k: [f64; 6], h: f64| -> [f64; 6] { std::array::from_fn(|i| x[i] + h * k[i]) };
            let k1 = rates(x, duty);
            let k2 = rates(moved(k1, 0.5 * h), duty);
            let k3 = rates(moved(k2, 0.5 * h), duty);
            let k4 = rates(moved(k3, h), duty);
            x = std::array::from_fn(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        }
    }
    samples
}

fn controlled(seconds: usize, reference: impl Fn(f64) -> f64) -> Vec<[f64; 3]> {
    let mut controller = Controller::new(starts());
    run(seconds, |t, angle, speed| controller.tick(reference(t), angle, speed))
}

/// Largest less smallest frequency, and the mean.
fn ripple(samples: &[[f64; 3]]) -> (f64, f64) {
    let of =
        |better: fn(f64, f64) -> f64, from: f64| samples.iter().map(|sample| sample[1]).fold(from, better);
    let (first, last) = (samples[0], samples[samples.len() - 1]);
    (of(f64::max, f64::MIN) - of(f64::min, f64::MAX), (last[2] - first[2]) / (last[0] - first[0]))
}

#[test]
fn the_load_makes_the_frequency_swing_and_the_controller_steadies_it() {
    // At the duty cycle that gives 1.4 Hz on the mean.
    let (swing, mean) = ripple(&run(8, |_, _, _| 0.186)[400..]);
    assert!((swing - 1.3).abs() < 0.05 && (mean - 1.4).abs() < 0.1, "{swing} {mean}");
    let (steadied, mean) = ripple(&controlled(8, |_| 1.6)[400..]);
    assert!((steadied - 0.26).abs() < 0.01 && (mean - 1.6).abs() < 0.01, "{steadied} {mean}");
}

#[test]
fn it_follows_the_ramp_of_figure_4() {
    // The experiment of 3.2.2: 0.1 t Hz for 20 s, through the body's resonance.
    let samples = controlled(20, |t| 0.1 * t);
    for [t, frequency, turns] in samples.into_iter().skip(300) {
        // No turn is lost; within a turn the load shows, most of all behind the resonance.
        assert!((turns - 0.05 * t * t).abs() < 0.02, "{turns} turns at {t} s");
        assert!((frequency / (0.1 * t) - 1.0).abs() < 0.12, "{frequency} Hz at {t} s");
    }
}

#[test]
fn it_follows_the_stairs_of_figure_5() {
    let stair = |t: f64| 0.5 * (1.0 + (t / 4.0).floor());
    let samples = controlled(16, stair);
    for flight in samples.chunks(400) {
        let (swing, mean) = ripple(&flight[150..]);
        let wanted = stair(flight[200][0]);
        assert!((mean - wanted).abs() < 0.02 && swing < 0.2 * wanted, "{mean} {swing} instead of {wanted}");
    }
}

#[test]
fn it_is_the_law_in_its_equations() {
    let p = Parameters { velocity: Velocity { derivative: 1e-3, ..starts::<Velocity<f64>>() }, ..starts() };
    let mut controller = Controller::new(p);
    // The first sample: no angle is missing; nothing was before it.
    let first = TAU - 5.0;
    let sudden = 1e-3 * 2.0 * first / (0.04 + 0.01);
    let duty = controller.tick(1.0, 3.0, 5.0);
    assert!((duty - (0.0175 * TAU + 0.03 * first + 0.8 * 0.005 * first + sudden)).abs() < 1e-12);
    // The second: the perfect eccentric has turned by 0.01 turns and the other one by 0.05 rad.
    let second = TAU + 10.0 * (0.01 * TAU - 0.05) - 5.5;
    let integral = 0.8 * 0.005 * (first + first + second);
    let derivative = ((0.04 - 0.01) * sudden + 1e-3 * 2.0 * (second - first)) / (0.04 + 0.01);
    let expected = 0.0175 * TAU + 0.03 * second + integral + derivative;
    assert!((controller.tick(1.0, 3.05, 5.5) - expected).abs() < 1e-12);
}

#[test]
fn what_is_held_fast_is_not_forced_for_ever_once_it_is_free() {
    let mut controller = Controller::new(starts());
    for _ in 0..3000 {
        assert!(controller.tick(2.0, 0.0, 0.0) <= 1.0);
    }
    let memory = controller.memory;
    assert!(
        memory.duty == 1.0 && memory.angle <= 1.0 + 1e-12 && memory.velocity.integral < 1.0,
        "{memory:?}"
    );
    // Free and too fast: the brake comes within the next samples, not after half a minute.
    let braking =
        (0..30).map(|i| controller.tick(2.0, 1.0 + 0.3 * f64::from(i), 30.0)).position(|duty| duty < 0.0);
    assert!(braking.is_some_and(|samples| samples < 10), "{braking:?}");
}

proptest! {
    #[test]
    fn the_duty_cycle_keeps_to_its_limit(
        limit in 0.01..1.0_f64,
        inputs in prop::collection::vec((-10.0..10.0_f64, -5.0..5.0_f64, -60.0..60.0_f64), 1..40),
    ) {
        let mut controller = Controller::new(Parameters { duty_limit: limit, ..starts() });
        for (frequency, angle, speed) in inputs {
            prop_assert!(controller.tick(frequency, angle, speed).abs() <= limit);
        }
    }

    #[test]
    fn what_turns_as_it_should_gets_the_feedforward_only(frequency in 0.0..5.0_f64, start in -3.0..3.0_f64) {
        let mut controller = Controller::new(starts());
        for sample in 0..50 {
            let turned = start + TAU * frequency * 0.01 * f64::from(sample);
            let duty = controller.tick(frequency, turned, TAU * frequency);
            prop_assert!((duty - 0.0175 * TAU * frequency).abs() < 1e-9);
        }
    }
}
