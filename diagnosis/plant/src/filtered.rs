//! Outputs behind the filter through which measured signals went when they were thinned.
//!
//! A law that bends does not go through a filter: what it makes of a filtered motion is not what the filter leaves of its force. So
//! the model sees the motion as far as it is known, and its outputs go through the filter, as the measured ones did.

use strut_signal::spectral::decimated;

use super::{Drive, Dynamics, Follower, Linearised, Seed, Seen, Signals};

/// Dynamics whose outputs are filtered where the drive says so.
pub(super) struct Filtered(pub Box<dyn Dynamics>);

impl Dynamics for Filtered {
    fn outputs(&self, parameters: &[f64], start: &[f64], drive: &Drive) -> Signals {
        let Some(fine) = drive.at_each_value() else { return self.0.outputs(parameters, start, drive) };
        thinned(&self.0.outputs(parameters, start, &fine), drive)
    }

    fn linearised(
        &self,
        parameters: &[f64],
        start: &[f64],
        drive: &Drive,
        seeds: &[Seed],
        wanted: &[usize],
    ) -> Linearised {
        let Some(fine) = drive.at_each_value() else {
            return self.0.linearised(parameters, start, drive, seeds, wanted);
        };
        let Linearised { outputs, slopes } = self.0.linearised(parameters, start, &fine, seeds, wanted);
        Linearised {
            outputs: thinned(&outputs, drive),
            slopes: slopes.iter().map(|it| thinned(it, drive)).collect(),
        }
    }

    /// The filter looks ahead, where nobody knows what the follower will say. So what it changes is that along the model's own way.
    fn followed(
        &self,
        parameters: &[f64],
        start: &[f64],
        drive: &Drive,
        (seeds, wanted): (&[Seed], &[usize]),
        follower: &mut dyn Follower,
    ) {
        let Some(fine) = drive.at_each_value() else {
            return self.0.followed(parameters, start, drive, (seeds, wanted), follower);
        };
        let numbers: Vec<usize> =
            (0..seeds.len()).filter(|it| !matches!(seeds[*it], Seed::State(_))).collect();
        let own: Vec<Seed> = numbers.iter().map(|it| seeds[*it].clone()).collect();
        let Linearised { outputs, slopes } = self.0.linearised(parameters, start, &fine, &own, wanted);
        let change = |signal: &Vec<f64>| -> Vec<f64> {
            let passed = decimated(signal, drive.finer).into_iter();
            passed.zip(signal.iter().step_by(drive.finer)).map(|(passed, now)| passed - now).collect()
        };
        let mut changed = Changed {
            follower,
            outputs: outputs.iter().map(change).collect(),
            slopes: slopes.iter().map(|it| it.iter().map(change).collect()).collect(),
            numbers,
            seeds: seeds.len(),
        };
        let plain = Drive { filtered: false, ..drive.clone() };
        self.0.followed(parameters, start, &plain, (seeds, wanted), &mut changed);
    }

    fn check(&self, parameters: &[f64]) -> Result<(), String> {
        self.0.check(parameters)
    }
}

fn thinned(signals: &Signals, drive: &Drive) -> Signals {
    signals.iter().map(|it| decimated(it, drive.finer)).collect()
}

/// A follower of what the filter leaves of the outputs.
struct Changed<'a> {
    follower: &'a mut dyn Follower,
    /// What the filter changes of each wanted output.
    outputs: Signals,
    /// The same of the derivatives by each seed that is no state, output by output.
    slopes: Vec<Signals>,
    /// Places of these seeds among all.
    numbers: Vec<usize>,
    /// How many there are.
    seeds: usize,
}

impl Follower for Changed<'_> {
    fn given(&self) -> Option<&[usize]> {
        self.follower.given()
    }

    fn state(&mut self, sample: usize, state: &mut [f64]) {
        self.follower.state(sample, state);
    }

    fn seen(&mut self, sample: usize, Seen { outputs, slopes, rates }: Seen<'_>, state: &mut [f64]) {
        let of = self.outputs.iter().zip(outputs);
        let outputs: Vec<f64> = of.map(|(change, now)| now + change[sample]).collect();
        let mut slopes = slopes.to_vec();
        for (number, changes) in self.numbers.iter().zip(&self.slopes) {
            let of_seed = slopes.iter_mut().skip(*number).step_by(self.seeds);
            of_seed.zip(changes).for_each(|(slope, change)| *slope += change[sample]);
        }
        self.follower.seen(sample, Seen { outputs: &outputs, slopes: &slopes, rates }, state);
    }

    fn advanced(&mut self, sample: usize, next: &[f64], moved: &[f64]) {
        self.follower.advanced(sample, next, moved);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Between, Plant};
    use strut_model::{SettingKind, Value};
    use strut_physics::rigs::{ElementDyno, LinearDrive};

    /// A drive with sharp friction that is moved by 20 mm at 2 Hz, seen ten times in each of its samples.
    fn moved(filtered: bool) -> (Plant, Vec<f64>, Drive) {
        let plant = Plant::of::<LinearDrive>();
        let mut parameters: Vec<f64> = plant.parameters.iter().map(|it| it.start).collect();
        for (name, value) in [("guide.coulomb.force", 30.0), ("guide.coulomb.velocity", 1e-3)] {
            parameters[plant.parameter(name).unwrap()] = value;
        }
        let (step, finer, samples) = (0.02, 10, 200);
        let wave = |order: i32| -> Vec<f64> {
            let omega = std::f64::consts::TAU * 2.0;
            let at = |k: usize| omega * step / finer as f64 * k as f64;
            let of = |phase: f64| match order {
                0 => phase.sin(),
                1 => phase.cos(),
                _ => -phase.sin(),
            };
            (0..=finer * (samples - 1)).map(|k| 0.02 * omega.powi(order) * of(at(k))).collect()
        };
        let inputs = plant.inputs.iter().map(|it| match it.name.as_str() {
            "motion.position" => wave(0),
            "motion.velocity" => wave(1),
            "motion.acceleration" => wave(2),
            _ => vec![0.0; finer * (samples - 1) + 1],
        });
        let drive =
            Drive { start: 0.0, step, inputs: inputs.collect(), finer, between: Between::Curves, filtered };
        (plant, parameters, drive)
    }

    #[test]
    fn filtered_outputs_are_what_a_filter_leaves_of_them() {
        let (plant, parameters, drive) = moved(true);
        let start: Vec<f64> = plant.states.iter().map(|it| it.start).collect();
        let dynamics = plant.prepare(&inverse(&plant)).unwrap();
        let force = plant.output("motor.force").unwrap();
        let found = &dynamics.outputs(&parameters, &start, &drive)[force];
        let fine = drive.at_each_value().unwrap();
        assert_eq!((fine.len(), drive.len(), found.len()), (1991, 200, 200));
        let whole = &dynamics.outputs(&parameters, &start, &fine)[force];
        assert_eq!(*found, decimated(whole, 10));
        // Sharp friction is steeper than the filter lets through.
        let plain = &dynamics.outputs(&parameters, &start, &moved(false).2)[force];
        let apart = found.iter().zip(plain).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart > 3.0, "{apart}");
    }

    /// The derivative by a parameter is that of the filtered outputs, along the way and sample by sample.
    #[test]
    fn slopes_are_those_of_the_filtered_outputs() {
        struct Seens(Vec<[f64; 2]>);
        impl Follower for Seens {
            fn state(&mut self, _: usize, _: &mut [f64]) {}
            fn seen(&mut self, _: usize, seen: Seen<'_>, _: &mut [f64]) {
                self.0.push([seen.outputs[0], seen.slopes[0]]);
            }
            fn advanced(&mut self, _: usize, _: &[f64], _: &[f64]) {}
        }
        let (plant, mut parameters, drive) = moved(true);
        let start: Vec<f64> = plant.states.iter().map(|it| it.start).collect();
        let dynamics = plant.prepare(&inverse(&plant)).unwrap();
        let force = plant.output("motor.force").unwrap();
        let coulomb = plant.parameter("guide.coulomb.force").unwrap();
        let seeds = [Seed::Parameter(coulomb)];
        let linear = dynamics.linearised(&parameters, &start, &drive, &seeds, &[force]);
        let mut seens = Seens(Vec::new());
        dynamics.followed(&parameters, &start, &drive, (&seeds, &[force]), &mut seens);
        let before = dynamics.outputs(&parameters, &start, &drive).swap_remove(force);
        parameters[coulomb] += 1.0;
        let after = dynamics.outputs(&parameters, &start, &drive).swap_remove(force);
        for (k, [output, slope]) in seens.0.iter().enumerate() {
            assert!((output - before[k]).abs() < 1e-9, "{k}");
            assert!((linear.slopes[0][0][k] - slope).abs() < 1e-9, "{k}");
            // The law is linear in its force.
            assert!((after[k] - before[k] - slope).abs() < 1e-6, "{k}: {slope}");
        }
        assert_eq!(seens.0.len(), drive.len());
    }

    /// A state that a follower replaces changes the output by what it is otherwise, beside what the filter makes of the model's way.
    #[test]
    fn a_replaced_state_shows_in_the_filtered_output() {
        struct Replaced {
            state: usize,
            by: f64,
            outputs: Vec<f64>,
        }
        impl Follower for Replaced {
            fn state(&mut self, _: usize, state: &mut [f64]) {
                state[self.state] += self.by;
            }
            fn seen(&mut self, _: usize, seen: Seen<'_>, _: &mut [f64]) {
                self.outputs.push(seen.outputs[0]);
            }
            fn advanced(&mut self, _: usize, _: &[f64], _: &[f64]) {}
        }
        let plant = Plant::of::<ElementDyno>();
        let mut parameters: Vec<f64> = plant.parameters.iter().map(|it| it.start).collect();
        for (name, value) in
            [("hysteresis.presliding.force", 100.0), ("hysteresis.presliding.stiffness", 1e5)]
        {
            parameters[plant.parameter(name).unwrap()] = value;
        }
        let start: Vec<f64> = plant.states.iter().map(|it| it.start).collect();
        let dynamics = plant.prepare(&plant.choices).unwrap();
        let force = plant.output("force").unwrap();
        let still = Drive::sampled(2e-3, vec![vec![0.0; 401]; plant.inputs.len()]);
        let outputs = |filtered: bool, state: usize, by: f64| {
            let drive = Drive { finer: 4, filtered, ..still.clone() };
            let mut replaced = Replaced { state, by, outputs: Vec::new() };
            dynamics.followed(&parameters, &start, &drive, (&[], &[force]), &mut replaced);
            replaced.outputs
        };
        let changes = (0..plant.states.len()).map(|state| {
            let change = |filtered: bool| outputs(filtered, state, 1.0)[0] - outputs(filtered, state, 0.0)[0];
            assert!((change(true) - change(false)).abs() < 1e-9, "{}", plant.states[state].name);
            change(true).abs()
        });
        assert!(changes.fold(0.0, f64::max) > 0.5);
    }

    /// The choices with which the motion drives the model.
    fn inverse(plant: &Plant) -> Vec<Value> {
        let drive = plant.setting("drive").unwrap();
        let mut choices = plant.choices.clone();
        let SettingKind::Choice(of) = plant.settings[drive].kind else { panic!("it has no items") };
        let motion = (1..).zip(of.items).find(|(_, (item, _))| *item == "Motion");
        choices[drive] = Value::Integer(motion.unwrap().0);
        choices
    }
}
