//! The communication step of an augmented model.

use nalgebra::DMatrix;

use crate::plant::{Drive, Dynamics, Follower, Seed, Seen};

/// Longest step in seconds.
const LONGEST: f64 = 1e-3;
/// Shortest step in seconds: a record of ten seconds takes a million of them.
const SHORTEST: f64 = 1e-5;
/// By how much of itself the damping of an oscillation may be wrong: explicit Euler, which many FMUs for co-simulation make in
/// each communication step, takes half the step times the square of the angular frequency from it.
const DAMPING: f64 = 0.01;
/// Largest product of the step and the rate of a mode: a force is some steps late on its way from component to component, and
/// becomes unstable where it is about 1.
const DELAYED: f64 = 0.05;
/// Between how many samples the modes are looked at.
const EVERY: usize = 10;
/// Samples that are looked at.
const SAMPLES: usize = 2000;

/// The longest step that divides a record's and is short enough for every mode of a model on it.
pub fn step(dynamics: &dyn Dynamics, (parameters, start): (&[f64], &[f64]), drive: &Drive) -> f64 {
    let mut watch = Watch { step: drive.step, states: start.len(), longest: LONGEST };
    let mut beginning = drive.clone();
    let samples = drive.len().min(SAMPLES);
    let values = beginning.finer * samples.saturating_sub(1) + 1;
    beginning.inputs.iter_mut().for_each(|signal| signal.truncate(values));
    let seeds: Vec<Seed> = (0..start.len()).map(Seed::State).collect();
    dynamics.followed(parameters, start, &beginning, (&seeds, &[]), &mut watch);
    divided(drive.step, watch.longest.max(SHORTEST))
}

/// The longest step that is not longer than another and goes into a sample's a number of times without factors but 2 and 5:
/// of a sample of a millisecond, it is a whole number of nanoseconds, in which libcosim counts.
fn divided(sample: f64, longest: f64) -> f64 {
    // Rounding alone makes no step longer.
    let least = (sample / longest * (1.0 - 1e-9)).ceil().max(1.0);
    let powers =
        |base: f64| (0..64).map(move |power| base.powi(power)).take_while(move |it| *it < base * least);
    let parts = powers(2.0).flat_map(|two| powers(5.0).map(move |five| two * five));
    sample / parts.filter(|it| *it >= least).fold(f64::INFINITY, f64::min)
}

/// Looks at the modes from sample to sample.
struct Watch {
    step: f64,
    states: usize,
    longest: f64,
}

impl Follower for Watch {
    fn state(&mut self, _: usize, _: &mut [f64]) {}

    fn seen(&mut self, _: usize, _: Seen<'_>, _: &mut [f64]) {}

    fn advanced(&mut self, sample: usize, _: &[f64], slopes: &[f64]) {
        if !sample.is_multiple_of(EVERY) || self.states == 0 {
            return;
        }
        let of_modes = if slopes.iter().all(|it| it.is_finite()) {
            short_enough(&DMatrix::from_row_slice(self.states, self.states, slopes), self.step)
        } else {
            // What cannot be looked at may have any rate.
            SHORTEST
        };
        self.longest = self.longest.min(of_modes);
    }
}

/// The step that is short enough for every mode of what becomes of the states over a sample.
fn short_enough(over_a_sample: &DMatrix<f64>, sample: f64) -> f64 {
    over_a_sample.complex_eigenvalues().iter().fold(f64::INFINITY, |longest, factor| {
        // A mode that decays within a sample may have any rate; a constant one has none.
        if factor.norm() < 1e-12 {
            return longest;
        }
        let rate = factor.ln() / sample;
        let fast = DELAYED / rate.norm();
        let oscillates = rate.im.abs() > rate.re.abs();
        let damped = if oscillates { 2.0 * DAMPING * rate.re.abs() / rate.norm_sqr() } else { f64::INFINITY };
        longest.min(fast).min(damped)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_oscillation_keeps_its_damping() {
        // 15.6 Hz with a damping ratio of 0.053, over a millisecond.
        let (decay, frequency, sample) = (5.2_f64, 98.0_f64, 1e-3);
        let (shrunk, angle) = ((-decay * sample).exp(), frequency * sample);
        let (cos, sin) = (shrunk * angle.cos(), shrunk * angle.sin());
        let step = short_enough(&DMatrix::from_row_slice(2, 2, &[cos, -sin, sin, cos]), sample);
        // Explicit Euler takes half the step times the square of the rate.
        let lost = 0.5 * step * (decay * decay + frequency * frequency);
        assert!((lost / decay / DAMPING - 1.0).abs() < 1e-6, "{lost}");
    }

    #[test]
    fn a_step_is_short_enough_for_a_mode_and_divides_a_sample() {
        // A mode of 200 per second, and a state that does not change.
        let decays = DMatrix::from_row_slice(2, 2, &[(-0.2_f64).exp(), 0.0, 0.0, 1.0]);
        assert!((short_enough(&decays, 1e-3) / (DELAYED / 200.0) - 1.0).abs() < 1e-9);
        let cases =
            [(1e-3, 2.5e-4, 2.5e-4), (1e-3, 3e-4, 2.5e-4), (2e-4, 1e-3, 2e-4), (1e-3, 1.075e-5, 1e-5)];
        for (sample, longest, step) in cases {
            assert!((divided(sample, longest) / step - 1.0).abs() < 1e-12, "{sample} {longest}");
        }
    }
}
