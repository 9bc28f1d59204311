//! One-sample predictions along a trajectory, with derivatives: what a Kalman filter needs of a model.

use strut_model::{Bundle, Model};

use super::integrate::{Run, Seeding, direction};
use super::jet::{Jet, Scalar};
use super::{DIRECTIONS, Drive, Seed, outputs_of};

/// What a model says at a sample.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    /// The wanted outputs.
    pub outputs: &'a [f64],
    /// Their derivatives by seed, output by output.
    pub slopes: &'a [f64],
    /// The rates of all states.
    pub rates: &'a [f64],
}

/// Follows a model from sample to sample, and says from which state it goes on.
pub trait Follower {
    /// The states that it replaces at every sample, if it does not ask for the next ones: as long as all others rest, nothing is
    /// integrated.
    fn given(&self) -> Option<&[usize]> {
        None
    }

    /// The state at a sample, as predicted, before anything is computed from it: it may be replaced.
    fn state(&mut self, sample: usize, state: &mut [f64]);

    /// What the model says at a sample. The state may be corrected.
    fn seen(&mut self, sample: usize, seen: Seen<'_>, state: &mut [f64]);

    /// The state that follows at the next sample, and its derivatives by seed, state by state.
    fn advanced(&mut self, sample: usize, state: &[f64], slopes: &[f64]);
}

/// A model on its way through a record with some seeds at once.
struct Lane<'a, M: Model, R: Scalar> {
    run: Run<'a, M, R>,
    /// Numbers of the seeds.
    seeds: Vec<usize>,
    seeding: Seeding<'a>,
}

/// See [`Dynamics::followed`](super::Dynamics::followed).
pub(super) fn followed<M: Model>(
    model: &M,
    parameters: &[f64],
    start: &[f64],
    drive: &Drive,
    (seeds, wanted): (&[Seed], &[usize]),
    follower: &mut dyn Follower,
) {
    if seeds.is_empty() {
        let numbers = Bundle::from_fn(|i| parameters[i]);
        let run = Run::<M, f64>::new(model, parameters, numbers, Bundle::from_fn(|i| start[i]), drive);
        let lane = Lane { run, seeds: Vec::new(), seeding: Seeding::new(&[], drive) };
        let input = |_: &Seeding<'_>, (i, sample, share): (usize, usize, f64)| {
            drive.value(&drive.inputs[i], sample, share)
        };
        return follow(vec![lane], start, drive, (0, wanted), follower, |value, _, _| value, input);
    }
    let lanes = seeds.chunks(DIRECTIONS).enumerate().map(|(number, chunk)| {
        // A parameter may be asked for twice: as a port, and as what is fitted.
        let asked = |i: usize, seed: usize| chunk.get(seed) == Some(&Seed::Parameter(i));
        let parameter = |i: usize| Jet {
            value: parameters[i],
            slopes: std::array::from_fn(|seed| f64::from(asked(i, seed))),
        };
        let run = Run::<M, Jet<DIRECTIONS>>::new(
            model,
            parameters,
            Bundle::from_fn(parameter),
            Bundle::from_fn(|i| Jet::from(start[i])),
            drive,
        );
        let first = number * DIRECTIONS;
        Lane { run, seeds: (first..first + chunk.len()).collect(), seeding: Seeding::new(chunk, drive) }
    });
    let seeded = |value: f64, state: usize, lane: &[usize]| {
        let own = lane.iter().position(|seed| seeds[*seed] == Seed::State(state));
        own.map_or(Jet::from(value), |index| Jet { value, slopes: direction(index) })
    };
    let input = |seeding: &Seeding<'_>, (i, sample, share): (usize, usize, f64)| {
        seeding.value(drive, i, sample, share)
    };
    follow(lanes.collect(), start, drive, (seeds.len(), wanted), follower, seeded, input);
}

fn follow<M: Model, R: Scalar>(
    mut lanes: Vec<Lane<'_, M, R>>,
    start: &[f64],
    drive: &Drive,
    (seeds, wanted): (usize, &[usize]),
    follower: &mut dyn Follower,
    seeded: impl Fn(f64, usize, &[usize]) -> R,
    input: impl Fn(&Seeding<'_>, (usize, usize, f64)) -> R,
) {
    let rows: Vec<Option<usize>> =
        (0..outputs_of::<M>()).map(|output| wanted.iter().position(|it| *it == output)).collect();
    let mut state = start.to_vec();
    let mut rates = vec![0.0; state.len()];
    let (mut values, mut slopes) = (vec![0.0; wanted.len()], vec![0.0; wanted.len() * seeds]);
    let mut advanced = vec![0.0; state.len() * seeds];
    let given = follower.given();
    let others: Vec<usize> =
        (0..state.len()).filter(|it| given.is_none_or(|given| !given.contains(it))).collect();
    let mut rests = given.is_some() && lanes.iter().all(|it| !it.run.is_sampled());
    let mut before = state.clone();
    let mut known = Vec::with_capacity(lanes.len());
    for sample in 0..drive.len() {
        follower.state(sample, &mut state);
        known.clear();
        for lane in &mut lanes {
            lane.run.place(|i| seeded(state[i], i, &lane.seeds));
            let at = |i: usize, share: f64| input(&lane.seeding, (i, sample, share));
            let (first, own) = lane.run.outputs(sample, at, |output, value| {
                let Some(row) = rows[output] else { return };
                values[row] = value.number();
                for (seed, slope) in lane.seeds.iter().zip(value.slopes()) {
                    slopes[row * seeds + seed] = *slope;
                }
            });
            own.for_each(|index, rate| rates[index] = rate.number());
            known.push((first, own));
        }
        let seen = Seen { outputs: &values, slopes: &slopes, rates: &rates };
        before.copy_from_slice(&state);
        follower.seen(sample, seen, &mut state);
        rests = rests && others.iter().all(|it| rates[*it] == 0.0);
        if sample + 1 == drive.len() || rests {
            continue;
        }
        let mut next = state.clone();
        for (lane, known) in lanes.iter_mut().zip(&mut known) {
            let at = |i: usize, share: f64| input(&lane.seeding, (i, sample, share));
            if state != before {
                lane.run.place(|i| seeded(state[i], i, &lane.seeds));
                *known = lane.run.outputs(sample, at, |_, _| {});
            }
            lane.run.advanced(sample, known, at, |index, value| {
                next[index] = value.number();
                for (seed, slope) in lane.seeds.iter().zip(value.slopes()) {
                    advanced[index * seeds + seed] = *slope;
                }
            });
        }
        follower.advanced(sample, &next, &advanced);
        state = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Plant;
    use strut_physics::rigs::QuarterCar;

    /// Gives some states, and counts how often it is handed the next ones.
    struct Given {
        states: Vec<usize>,
        asks: bool,
        outputs: Vec<f64>,
        advanced: usize,
    }

    impl Follower for Given {
        fn given(&self) -> Option<&[usize]> {
            (!self.asks).then_some(&self.states)
        }

        fn state(&mut self, sample: usize, state: &mut [f64]) {
            for (number, index) in self.states.iter().enumerate() {
                state[*index] = 1e-3 * (0.05 * sample as f64 + number as f64).sin();
            }
        }

        fn seen(&mut self, _: usize, seen: Seen<'_>, _: &mut [f64]) {
            self.outputs.extend(seen.outputs);
        }

        fn advanced(&mut self, _: usize, _: &[f64], _: &[f64]) {
            self.advanced += 1;
        }
    }

    /// Outputs, and how often states were integrated, of a quarter car whose bodies' motions are given.
    fn followed(friction: f64, asks: bool) -> (Vec<f64>, usize) {
        let plant = Plant::of::<QuarterCar>();
        let mut parameters: Vec<f64> = plant.parameters.iter().map(|it| it.start).collect();
        parameters[plant.parameter("hysteresis.presliding.force").unwrap()] = friction;
        let start: Vec<f64> = plant.states.iter().map(|it| it.start).collect();
        let states = ["body.position", "body.velocity", "wheel.position", "wheel.velocity"];
        let states = states.map(|name| plant.state(name).unwrap()).to_vec();
        let inputs = vec![vec![0.0; 50]; plant.inputs.len()];
        let drive = Drive::sampled(2e-3, inputs);
        let wanted: Vec<usize> = (0..plant.outputs.len()).collect();
        let mut given = Given { states, asks, outputs: Vec::new(), advanced: 0 };
        let dynamics = plant.prepare(&plant.choices).unwrap();
        dynamics.followed(&parameters, &start, &drive, (&[], &wanted), &mut given);
        (given.outputs, given.advanced)
    }

    #[test]
    fn only_what_remembers_is_integrated_where_the_motion_is_given() {
        let [plain, asked] = [false, true].map(|asks| followed(0.0, asks));
        assert_eq!((plain.1, asked.1), (0, 49));
        assert_eq!(plain.0, asked.0);
        let [remembers, asked] = [false, true].map(|asks| followed(50.0, asks));
        assert_eq!(remembers, asked);
        assert_eq!(asked.1, 49);
        assert_ne!(remembers.0, plain.0);
    }
}
