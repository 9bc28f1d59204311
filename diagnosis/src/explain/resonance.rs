//! Oscillators that a motion drives: hidden masses on springs.

use std::f64::consts::TAU;

use crate::decision::choice::Score;
use crate::decision::criteria::CRITERIA;
use crate::estimation::hypothesis::Baseline;
use crate::missing::Missing;
use crate::missing::innovations::Noise;
use crate::plant::Signals;

use super::candidates::Candidates;
use super::features::Group;
use super::selection::Compared;

/// Frequencies in Hz that are tried first, half an octave apart …
const RESONANCES: [f64; 9] = [2.0, 2.8, 4.0, 5.6, 8.0, 11.0, 16.0, 22.0, 31.0];
/// … with a damping ratio as wide as the steps between them.
const DAMPING: f64 = 0.15;
/// Octaves and factors of the damping ratio around the best oscillator that are tried next.
const CLOSER: [(&[f64], &[f64]); 3] = [
    (&[-0.25, -0.125, 0.0, 0.125, 0.25], &[0.15, 0.4, 1.0]),
    (&[-0.06, 0.0, 0.06], &[0.6, 1.0, 1.6]),
    (&[-0.03, -0.015, 0.0, 0.015, 0.03], &[0.8, 1.0, 1.25]),
];

/// A mass on a spring with a damper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillator {
    /// Natural frequency in Hz.
    pub hertz: f64,
    /// Damping ratio, less than one.
    pub damping: f64,
}

impl Oscillator {
    /// Those that are tried first.
    pub fn first() -> impl Iterator<Item = Self> {
        RESONANCES.into_iter().map(|hertz| Self { hertz, damping: DAMPING })
    }

    /// Those around one that are tried in a round.
    fn around(self, (octaves, factors): (&[f64], &[f64])) -> Vec<Self> {
        let at = |octave: f64, factor: f64| Self {
            hertz: self.hertz * octave.exp2(),
            damping: self.damping * factor,
        };
        octaves.iter().flat_map(|octave| factors.iter().map(move |factor| at(*octave, *factor))).collect()
    }

    /// `y'' + 2 ζ ω y' + ω² y = −v'`: an oscillator's restoring and damping force per mass, `ω² y` and `2 ζ ω y'`.
    pub fn forces(self, velocity: &[f64], step: f64) -> [Vec<f64>; 2] {
        let omega = TAU * self.hertz;
        // Exact for a velocity that is straight between samples, however few of them a period has.
        let (fading, turning) = (self.damping * omega, omega * (1.0 - self.damping * self.damping).sqrt());
        let (left, sine, cosine) =
            ((-fading * step).exp(), (turning * step).sin() / turning, (turning * step).cos());
        let (mut y, mut rate, mut before) = (0.0, 0.0, velocity.first().copied().unwrap_or_default());
        let (mut restoring, mut damping) = (Vec::new(), Vec::new());
        for v in velocity {
            let rest = -(v - before) / (step * omega * omega);
            let beside = y - rest;
            (y, rate) = (
                rest + left * ((cosine + fading * sine) * beside + sine * rate),
                left * ((cosine - fading * sine) * rate - omega * omega * sine * beside),
            );
            before = *v;
            restoring.push(omega * omega * y);
            damping.push(2.0 * self.damping * omega * rate);
        }
        [restoring, damping]
    }
}

impl Baseline<'_> {
    /// The comparison with the oscillator that explains most, where one of those that were tried first explains something: between
    /// two of them, or hardly damped, another one may explain much more.
    pub fn sharpened(
        &self,
        (missing, signals): (&Missing<'_>, &[Signals]),
        mut compared: Compared,
        noise: &Noise,
    ) -> Compared {
        let oscillator = |all: &Compared, score: &Score| match all.feature(score.candidate) {
            Some((port, mover, Group::Resonance(it))) => Some((port, mover, it)),
            _ => None,
        };
        let best = |all: &Compared| {
            let own = all.features.iter().filter(|it| oscillator(all, it).is_some());
            own.max_by(|a, b| a.share.total_cmp(&b.share)).copied()
        };
        let Some(first) = best(&compared).filter(|it| it.share >= CRITERIA.background_share) else {
            return compared;
        };
        let Some((port, mover, mut at)) = oscillator(&compared, &first) else { return compared };
        let mut largest = first.share;
        for round in CLOSER {
            let mut closer = Candidates::of_windows(missing.windows.len());
            for it in at.around(round) {
                self.feature(missing, signals, (port, mover, Group::Resonance(it)), &mut closer);
            }
            let Some(looked) = self.compared(missing, closer, noise) else { break };
            let Some(score) = best(&looked) else { break };
            let Some((.., it)) = oscillator(&looked, &score) else { break };
            at = it;
            if looked.share_in(&compared, &score) > largest {
                largest = compared.take(looked, score);
            }
        }
        compared
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The step response `1 − exp(−ζωt) (cos ω_d t + ζω/ω_d sin ω_d t)`, also with fewer than three samples in a period, where the
    /// steps of a simulation would run away.
    #[test]
    fn an_oscillator_is_exact_for_a_velocity_that_is_straight_between_samples() {
        for step in [0.001, 0.02] {
            let (hertz, acceleration) = (22.0, 3.0);
            let velocity: Vec<f64> = (0..300).map(|k| acceleration * step * f64::from(k)).collect();
            let [restoring, _] = Oscillator { hertz, damping: DAMPING }.forces(&velocity, step);
            let omega = TAU * hertz;
            let (fading, turning) = (DAMPING * omega, omega * (1.0 - DAMPING * DAMPING).sqrt());
            for (k, force) in (0..).map(f64::from).zip(restoring) {
                let (at, left) = (turning * step * k, (-fading * step * k).exp());
                let exact = -acceleration * (1.0 - left * (at.cos() + fading / turning * at.sin()));
                assert!((force - exact).abs() < 1e-9, "{step}: {k}");
            }
        }
    }

    #[test]
    fn oscillators_around_one_are_between_its_neighbours() {
        let all = Oscillator { hertz: 8.0, damping: DAMPING }.around(CLOSER[0]);
        assert_eq!(all.len(), 15);
        assert!(all.iter().all(|it| it.hertz > 6.7 && it.hertz < 9.6 && it.damping <= DAMPING));
        assert!(all.contains(&Oscillator { hertz: 8.0, damping: DAMPING }));
    }
}
