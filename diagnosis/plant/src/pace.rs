//! How many steps the integration makes between two samples.
//!
//! Friction is stiff where it holds and loose elsewhere: a wheel that turns round crosses the velocity of
//! regularisation within one sample in fifty. So a model has two numbers of steps, one that is enough where nothing holds
//! and one that is enough at rest, and goes between them by what the stages of each step tell.

mod rates;

use strut_model::{Bundle, Declaration, Declarations, Model};

use super::jet::Scalar;
use super::{DIRECTIONS, Drive};

pub(super) use rates::{FAST, rates};

/// Longest step of the integration in seconds, whatever the record's sampling, of what does not move slowly.
pub(super) const LONGEST_STEP: f64 = 4e-3;
/// Largest product of the step and the fastest rate of change that is met on the way; the method is stable up to 2.78.
const STABLE: f64 = 2.0;
/// The same that is planned for: a step's error is below a thousandth of what the fastest mode loses in it. Where there is
/// no room between steps that are stable and steps that are accurate, nothing controls the error.
pub(super) const ACCURATE: f64 = 0.6;
/// The same of the step and the fastest rate at rest where everything is slow, and a step may be longer than [`LONGEST_STEP`]: its error
/// is then below a millionth.
const SLOW: f64 = 0.1;
/// The same of the step and the largest slope of a delay's states, 12 over the delay: a sixteenth of the delay is a step.
const WELL_BELOW: f64 = 0.75;
/// Steps between two samples beyond which a model is too stiff for this method.
pub(super) const MOST_STEPS: f64 = 60.0;

/// Difference of a step's stages that tells nothing of stiffness, in shares of a state's largest value so far.
const NEGLIGIBLE: f64 = 1e-9;
/// Largest difference of a step from one of lower order, in the same shares.
const TOLERATED: f64 = 3e-4;
/// More steps than the last one's stages ask for, lest the next attempt is refused too.
pub(super) const RESERVE: f64 = 1.2;

/// How many steps a model makes between samples.
#[derive(Clone, Debug)]
pub(super) struct Pace {
    /// Enough where nothing holds.
    loose: usize,
    /// Enough everywhere.
    tight: usize,
    /// Steps to the next sample.
    pub steps: usize,
    /// One over the largest value of each state so far, in shares of which an error is taken.
    scales: Vec<f64>,
}

/// How the derivatives in one direction answer to a step: sums of squares over the states.
#[derive(Clone, Copy, Default)]
struct Response {
    /// Of the first slope.
    size: f64,
    /// Of what half a step changes in it.
    change: f64,
    /// Of what that changes in turn.
    answer: f64,
}

impl Response {
    #[inline(always)]
    fn add(&mut self, [first, second, third]: [f64; 3], scale: f64) {
        self.size += (first * scale).powi(2);
        self.change += ((second - first) * scale).powi(2);
        self.answer += ((third - second) * scale).powi(2);
    }

    /// Half of the step times the fastest rate, over what is stable; zero where nothing but rounding changes.
    fn stiffness(&self) -> f64 {
        let moves = self.change > self.size * NEGLIGIBLE.powi(2);
        if moves { 2.0 * (self.answer / self.change).sqrt() / STABLE } else { 0.0 }
    }
}

/// What the stages of a step differ by, over the states.
#[derive(Default)]
struct Met {
    /// Of the first and the second slope: the sum of squares.
    change: f64,
    /// Of the second and the third slope: the same.
    answer: f64,
    /// Of the step and one of lower order: the largest.
    error: f64,
}

impl Met {
    #[inline(always)]
    fn add(&mut self, [first, second, third, fourth]: [f64; 4], scale: f64) {
        self.change += ((second - first) * scale).powi(2);
        self.answer += ((third - second) * scale).powi(2);
        self.error = self.error.max(((first - second - third + fourth) * scale).abs());
    }

    /// Whether it is more than rounding.
    #[inline(always)]
    fn tells(&self) -> bool {
        self.answer.sqrt() > NEGLIGIBLE
    }
}

impl Pace {
    /// None is longer than [`LONGEST_STEP`], and the fastest mode about rest, where friction is stiffest, can be
    /// integrated stably. A sampled part is computed at the ends of steps, which therefore do not change with the state.
    pub fn of<M: Model>(model: &M, parameters: &M::Parameters<f64>, drive: &Drive) -> Self {
        let states = Declarations::of::<M::State<f64>>();
        let (loose, tight) =
            if states.is_empty() { (1, 1) } else { range(model, parameters, drive, &states) };
        let loose = if M::period(parameters).is_some() { tight } else { loose };
        Self::between(loose, tight, states.len())
    }

    /// With the fewest and the most steps between samples.
    pub fn between(loose: usize, tight: usize, states: usize) -> Self {
        Self { loose, tight, steps: tight, scales: vec![f64::MAX; states] }
    }

    /// Makes the most steps everywhere from now on.
    pub fn tighten(&mut self) {
        (self.loose, self.steps) = (self.tight, self.tight);
    }

    /// Looks at a state at a sample.
    pub fn reach<R: Scalar>(&mut self, state: &impl Bundle<R>) {
        if self.varies() {
            state.for_each(|index, value| self.reach_value(index, value.number()));
        }
    }

    /// Looks at the value of one state at a sample.
    #[inline]
    pub fn reach_value(&mut self, index: usize, value: f64) {
        // Seldom: a division for each state in each step would be felt.
        if value.abs() * self.scales[index] > 1.0 {
            self.scales[index] = value.abs().recip();
        }
    }

    /// How many times as many steps a step from its four slopes asks for: by the stiffness that it met and by its error. Friction that
    /// slides is at its limit, and no slope tells how fast it would come back to it. Its derivatives are not there, and would grow.
    #[inline]
    pub fn need<R: Scalar, S: Bundle<R>>(&self, h: f64, [k1, k2, k3, k4]: [&S; 4]) -> f64 {
        if !self.varies() {
            return 1.0;
        }
        let (mut met, mut index) = (Met::default(), 0);
        let mut derivatives = [Response::default(); DIRECTIONS];
        k1.combine([k2, k3, k4], &mut |k1, [k2, k3, k4]| {
            let scale = h * self.scales[index];
            met.add([k1, k2, k3, k4].map(Scalar::number), scale);
            let slopes = k1.slopes().iter().zip(k2.slopes()).zip(k3.slopes());
            for (own, ((first, second), third)) in derivatives.iter_mut().zip(slopes) {
                own.add([*first, *second, *third], scale);
            }
            index += 1;
            *k1
        });
        self.needed(&met, derivatives.iter().map(Response::stiffness).fold(0.0, f64::max))
    }

    /// The same of numbers, by the four slopes of each state; where nothing tells how stiff it is, all steps that there may be.
    pub fn need_of(&self, h: f64, slopes: impl Iterator<Item = [f64; 4]>) -> f64 {
        if !self.varies() {
            return 1.0;
        }
        let mut met = Met::default();
        slopes.zip(&self.scales).for_each(|(slopes, scale)| met.add(slopes, h * scale));
        let unknown = if met.tells() { 0.0 } else { self.tight as f64 / self.steps as f64 };
        self.needed(&met, unknown)
    }

    /// By what was met, or another stiffness if that is larger.
    #[inline]
    fn needed(&self, met: &Met, other: f64) -> f64 {
        if !met.change.is_finite() {
            return f64::INFINITY;
        }
        // The second slope's change by half a step is answered by the third's: half of the step times the fastest rate.
        let own = if met.tells() { 2.0 * (met.answer / met.change).sqrt() / STABLE } else { 0.0 };
        let stiffness = own.max(other);
        // The larger of the stiffness and the root of the error. That costs much and seldom asks for more than the fewest steps.
        let error = met.error / TOLERATED;
        let least = stiffness.max(self.loose as f64 / self.steps as f64);
        if error > least.powi(3) { error.cbrt() } else { stiffness }
    }

    /// Takes note of the largest need of the steps made since a sample; whether they have to be made again, more finely.
    pub fn refuse(&mut self, need: f64) -> bool {
        let made = self.steps;
        let wanted = made as f64 * if need > 1.0 { need * RESERVE } else { need };
        self.steps =
            if wanted < self.tight as f64 { (wanted.ceil() as usize).max(self.loose) } else { self.tight };
        need > 1.0 && made < self.steps
    }

    fn varies(&self) -> bool {
        self.loose < self.tight
    }
}

/// Steps that are enough where nothing holds, and everywhere.
fn range<M: Model>(
    model: &M,
    parameters: &M::Parameters<f64>,
    drive: &Drive,
    declared: &[Declaration],
) -> (usize, usize) {
    let [at_rest, fastest, sharpest] = rates(model, parameters, drive, declared);
    let steps = |rate: f64| (drive.step * rate).ceil().clamp(1.0, MOST_STEPS) as usize;
    let loose = (1.0 / LONGEST_STEP).min(at_rest / SLOW).max(sharpest / WELL_BELOW);
    (steps(loose), steps(loose.max(fastest / ACCURATE)))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use strut_physics::rigs::{ElementDyno, QuarterCar};

    use super::*;
    use crate::integrate::Run;
    use crate::{Plant, Seed};

    const SAMPLES: usize = 3000;
    const STEP: f64 = 1e-3;

    /// A rig's outputs on a road, and how many steps they took.
    fn driven(named: &[(&str, f64)], finest: bool) -> (Vec<Vec<f64>>, usize) {
        let plant = Plant::of::<QuarterCar>();
        let model = QuarterCar::prepare(&strut_model::Settings::starts(), None).unwrap();
        let mut parameters: Vec<f64> = plant.parameters.iter().map(|it| it.start).collect();
        for (name, value) in named {
            parameters[plant.parameter(name).unwrap()] = *value;
        }
        let mut inputs = vec![vec![0.0; SAMPLES]; plant.inputs.len()];
        let wave = |k: usize, frequency: f64| (std::f64::consts::TAU * frequency * k as f64 * STEP).sin();
        inputs[plant.input("road.position").unwrap()] =
            (0..SAMPLES).map(|k| 0.02 * wave(k, 1.7) + 0.003 * wave(k, 7.1)).collect();
        let drive = Drive::sampled(STEP, inputs);
        let rest = |_| 0.0;
        let mut run =
            Run::new(&model, &parameters, Bundle::from_fn(|i| parameters[i]), Bundle::from_fn(rest), &drive);
        if finest {
            run.pace.loose = run.pace.tight;
        }
        let mut found = vec![Vec::new(); plant.outputs.len()];
        // Each input is asked for once at a sample and twice in a step.
        let asked = std::cell::Cell::new(0);
        let input = |i: usize, sample: usize, share: f64| {
            asked.set(asked.get() + usize::from(i == 0));
            drive.value(&drive.inputs[i], sample, share)
        };
        run.through(SAMPLES, input, |output, value| found[output].push(value));
        (found, (asked.get() - SAMPLES) / 2)
    }

    fn rms(signal: impl Iterator<Item = f64>) -> f64 {
        (signal.map(|it| it * it).sum::<f64>() / SAMPLES as f64).sqrt()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn many_steps_where_friction_holds_are_as_good_as_many_everywhere(
            force in 20.0..400.0_f64,
            velocity in 3e-4..2e-3_f64,
        ) {
            let rig = [
                ("sprung_mass", 94.4),
                ("unsprung_mass", 10.0),
                ("strut.coulomb.force", force),
                ("strut.coulomb.velocity", velocity),
            ];
            let ((some, few), (all, many)) = (driven(&rig, false), driven(&rig, true));
            // Of what the finest makes beside one step a sample.
            let [few_more, many_more] = [few, many].map(|steps| steps - (SAMPLES - 1));
            prop_assert!(2 * few_more < many_more, "{few} {many}");
            for (some, all) in some.iter().zip(&all) {
                let difference = rms(some.iter().zip(all).map(|(some, all)| some - all));
                prop_assert!(difference <= 2e-3 * rms(all.iter().copied()), "{difference}");
            }
        }
    }

    /// The way over which it builds up is a fiftieth of a millimetre: it is there in a fraction of a sample.
    #[test]
    fn friction_before_it_slides_is_integrated_however_stiff_it_is() {
        let rig = |stiffness: f64| {
            [
                ("sprung_mass", 94.4),
                ("hysteresis.presliding.force", 50.0),
                ("hysteresis.presliding.stiffness", stiffness),
                ("hysteresis.presliding.gap", 1e-5),
            ]
        };
        let (soft, _) = driven(&rig(5e5), false);
        let (stiff, _) = driven(&rig(3e6), false);
        for (soft, stiff) in soft.iter().zip(&stiff) {
            let difference = rms(soft.iter().zip(stiff).map(|(soft, stiff)| soft - stiff));
            assert!(difference <= 0.1 * rms(soft.iter().copied()), "{difference}");
        }
    }

    /// While it slides, it is at its limit: what changes there is gone within a hundredth of a sample, and no derivative may grow.
    #[test]
    fn derivatives_of_friction_that_slides_are_those_of_differences() {
        let plant = Plant::of::<ElementDyno>();
        let mut parameters: Vec<f64> = plant.parameters.iter().map(|it| it.start).collect();
        let at = |name: &str| plant.parameter(name).unwrap();
        for (name, value) in [
            ("hysteresis.presliding.force", 22.0),
            ("hysteresis.presliding.stiffness", 1.6e5),
            ("hysteresis.presliding.exponent", 0.65),
        ] {
            parameters[at(name)] = value;
        }
        let (step, position, velocity) =
            (2e-3, plant.input("motion.position").unwrap(), plant.input("motion.velocity").unwrap());
        let mut inputs = vec![vec![0.0; 2000]; plant.inputs.len()];
        let turn = std::f64::consts::TAU * 3.0;
        let phases = || (0..2000).map(|k| turn * f64::from(k) * step);
        inputs[position] = phases().map(|phase| 0.015 * phase.sin()).collect();
        inputs[velocity] = phases().map(|phase| 0.015 * turn * phase.cos()).collect();
        let drive = Drive::sampled(step, inputs);
        let dynamics = plant.prepare(&plant.choices).unwrap();
        let start = vec![0.0; plant.states.len()];
        let force = plant.output("force").unwrap();
        let seed = at("hysteresis.presliding.force");
        let exact = dynamics.linearised(&parameters, &start, &drive, &[Seed::Parameter(seed)], &[force]);
        let moved = |by: f64| {
            let mut parameters = parameters.clone();
            parameters[seed] += by;
            dynamics.outputs(&parameters, &start, &drive)[force].clone()
        };
        let (more, less) = (moved(0.1), moved(-0.1));
        let differences: Vec<f64> = more.iter().zip(&less).map(|(more, less)| (more - less) / 0.2).collect();
        let apart = rms(differences.iter().zip(&exact.slopes[0][0]).map(|(a, b)| a - b));
        assert!(apart < 0.02 * rms(differences.iter().copied()), "{apart}");
    }

    /// Behind a backlash, more than a newton is displaced before anything holds, and that may be beyond where it slides.
    #[test]
    fn friction_behind_a_backlash_slides_in_as_small_steps_as_without() {
        let plant = Plant::of::<QuarterCar>();
        let model = QuarterCar::prepare(&strut_model::Settings::starts(), None).unwrap();
        let tight = |exponent: f64, gap: f64| {
            let mut parameters: Vec<f64> = plant.parameters.iter().map(|it| it.start).collect();
            for (name, value) in [
                ("hysteresis.presliding.force", 52.0),
                ("hysteresis.presliding.stiffness", 8.3e4),
                ("hysteresis.presliding.exponent", exponent),
                ("hysteresis.presliding.gap", gap),
            ] {
                parameters[plant.parameter(name).unwrap()] = value;
            }
            let drive = Drive::sampled(STEP, vec![vec![0.0; 2]; plant.inputs.len()]);
            Pace::of(&model, &Bundle::from_fn(|i| parameters[i]), &drive).tight
        };
        for exponent in [0.2, 0.5, 0.8] {
            let plain = tight(exponent, 0.0);
            assert!(plain > 4, "{plain}");
            for gap in [1e-4, 5e-4, 2e-3, 5e-3] {
                assert_eq!(tight(exponent, gap), plain, "{exponent} {gap}");
            }
        }
    }

    #[test]
    fn a_linear_rig_makes_one_step() {
        let (_, steps) = driven(&[], false);
        assert_eq!(steps, SAMPLES - 1);
    }
}
