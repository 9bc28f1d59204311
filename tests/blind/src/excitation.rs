//! What moves a rig: profiles over time, each at rest for the first half second.

use std::f64::consts::{PI, TAU};

use crate::random::Random;

/// Time at rest at the beginning of each record, in seconds: it shows noise floors and offsets.
pub const STANDSTILL: f64 = 0.5;

/// Distance of a profile's knots, in seconds.
const STEP: f64 = 5e-4;

/// A quantity over time: a cubic through knots, so that its rate of change is exactly its derivative, but for a recorded one.
#[derive(Clone, Debug, Default)]
pub struct Profile {
    knots: Vec<f64>,
    /// Rates of change at the knots of a recorded one, straight between them.
    rates: Option<Vec<f64>>,
}

impl Profile {
    /// Samples `law(t)` for `duration` seconds; `t` counts from the end of the standstill, and the profile fades
    /// in over half a second.
    pub fn new(duration: f64, mut law: impl FnMut(f64) -> f64) -> Self {
        let count = (duration / STEP).round() as usize + 1;
        let knots = (0..count).map(|k| {
            let t = k as f64 * STEP - STANDSTILL;
            if t <= 0.0 { 0.0 } else { law(t) * fade_in(t) }
        });
        Self { knots: knots.collect(), rates: None }
    }

    /// Nothing moves.
    pub fn still() -> Self {
        Self::default()
    }

    /// Whether nothing ever moves.
    pub fn is_still(&self) -> bool {
        self.knots.is_empty()
    }

    /// Value and rate of change at a time in seconds; outside of the profile it rests.
    pub fn at(&self, time: f64) -> (f64, f64) {
        // Each profile begins with a standstill.
        if time < STEP || self.knots.is_empty() {
            return (0.0, 0.0);
        }
        let (value, slope) = along(&self.knots, time / STEP);
        (value, self.rates.as_ref().map_or(slope / STEP, |rates| straight(rates, time / STEP)))
    }

    /// Through samples that were taken at `rate` a second; its rate of change are their central differences, as those have
    /// them who read a record.
    pub fn through(samples: &[f64], rate: f64) -> Self {
        let count = ((samples.len() - 1) as f64 / (rate * STEP)).round() as usize + 1;
        let place = |k: usize| k as f64 * STEP * rate;
        let slopes: Vec<f64> = (0..samples.len()).map(|k| along(samples, k as f64).1 * rate).collect();
        Self {
            knots: (0..count).map(|k| along(samples, place(k)).0).collect(),
            rates: Some((0..count).map(|k| straight(&slopes, place(k))).collect()),
        }
    }

    /// Its rate of change.
    pub fn rate(&self) -> Self {
        Self { knots: (0..self.knots.len()).map(|k| self.at(k as f64 * STEP).1).collect(), rates: None }
    }

    /// The profile, `factor` times as large.
    pub fn scaled(&self, factor: f64) -> Self {
        let scaled = |all: &Vec<f64>| all.iter().map(|x| x * factor).collect();
        Self { knots: scaled(&self.knots), rates: self.rates.as_ref().map(scaled) }
    }

    /// The profile so that its largest absolute value is `peak`.
    pub fn with_peak(&self, peak: f64) -> Self {
        let largest = self.knots.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        if largest > 0.0 { self.scaled(peak / largest) } else { self.clone() }
    }

    /// Both together.
    pub fn plus(&self, other: &Self) -> Self {
        let count = self.knots.len().max(other.knots.len());
        let of = |profile: &Self, k: usize| profile.knots.get(k).copied().unwrap_or(0.0);
        Self { knots: (0..count).map(|k| of(self, k) + of(other, k)).collect(), rates: None }
    }
}

/// Value and slope between knots at distances of 1, along the cubic whose slopes at the knots are central differences.
fn along(knots: &[f64], place: f64) -> (f64, f64) {
    let index = place as usize;
    let share = place - index as f64;
    let knot = |k: usize| knots[k.min(knots.len() - 1)];
    let (before, left, right, after) =
        (knot(index.saturating_sub(1)), knot(index), knot(index + 1), knot(index + 2));
    let (rise_left, rise_right) = ((right - before) / 2.0, (after - left) / 2.0);
    let square = 3.0 * (right - left) - 2.0 * rise_left - rise_right;
    let cube = rise_left + rise_right - 2.0 * (right - left);
    let value = left + share * (rise_left + share * (square + share * cube));
    (value, rise_left + share * (2.0 * square + share * 3.0 * cube))
}

/// Value between knots at distances of 1, along straight lines.
fn straight(knots: &[f64], place: f64) -> f64 {
    let index = place as usize;
    let knot = |k: usize| knots[k.min(knots.len() - 1)];
    knot(index) + (place - index as f64) * (knot(index + 1) - knot(index))
}

/// From 0 to 1 in half a second, without a corner.
pub(crate) fn fade_in(t: f64) -> f64 {
    if t < 0.5 { 0.5 - 0.5 * (TAU * t).cos() } else { 1.0 }
}

/// Sines of random phase from 0.3 to 20 Hz, amplitudes falling with frequency^`slope`.
pub fn multisine(random: &mut Random, duration: f64, slope: f64, peak: f64) -> Profile {
    let lines: Vec<(f64, f64, f64)> = (0..48)
        .map(|k| {
            // Spread over the logarithm, so that the body's mode gets as many lines as the wheel's.
            let frequency = 0.3 * (20.0_f64 / 0.3).powf((f64::from(k) + random.unit()) / 48.0);
            (TAU * frequency, frequency.powf(-slope), random.phase())
        })
        .collect();
    let law = |t: f64| lines.iter().map(|(omega, size, phase)| size * (omega * t + phase).sin()).sum();
    Profile::new(duration, law).with_peak(peak)
}

/// A random binary sequence: every `clock` seconds it may change its sign, within 4 ms.
pub fn prbs(random: &mut Random, duration: f64, clock: f64, size: f64) -> Profile {
    let levels = (0..=(duration / clock) as usize + 1).map(|_| random.sign() * size);
    held(duration, clock, &levels.collect::<Vec<_>>())
}

/// A random level between `-size` and `size` every `clock` seconds, reached within 4 ms.
pub fn steps(random: &mut Random, duration: f64, clock: f64, size: f64) -> Profile {
    let levels = (0..=(duration / clock) as usize + 1).map(|_| random.between(-size, size));
    held(duration, clock, &levels.collect::<Vec<_>>())
}

/// Each level for `clock` seconds, reached within 4 ms.
fn held(duration: f64, clock: f64, levels: &[f64]) -> Profile {
    Profile::new(duration, |t| {
        let tick = (t / clock) as usize;
        let edge = ((t - tick as f64 * clock) / 4e-3).min(1.0);
        let before = if tick == 0 { 0.0 } else { levels[tick - 1] };
        before + (levels[tick] - before) * (0.5 - 0.5 * (PI * edge).cos())
    })
}

/// Single bumps and hollows of 0.08 to 0.3 s, up to `peak` high, one every two seconds or so.
pub fn bumps(random: &mut Random, duration: f64, peak: f64) -> Profile {
    let mut all: Vec<(f64, f64, f64)> = vec![];
    let mut start = 0.6;
    while start < duration {
        all.push((start, random.log_between(0.08, 0.3), random.sign() * random.between(0.5, 1.0) * peak));
        start += random.between(1.4, 2.4);
    }
    Profile::new(duration, |t| {
        let under = |&&(start, length, _): &&(f64, f64, f64)| t >= start && t < start + length;
        all.iter()
            .find(under)
            .map_or(0.0, |(start, length, height)| height * (0.5 - 0.5 * (TAU * (t - start) / length).cos()))
    })
}

/// A road like those of ISO 8608: velocity almost white, smoothed by a contact patch (25 Hz, twice).
pub fn road(random: &mut Random, duration: f64, peak: f64) -> Profile {
    let mut height = 0.0;
    let (mut once, mut twice) = (0.0, 0.0);
    let smooth = STEP / (STEP + 1.0 / (TAU * 25.0));
    Profile::new(duration, |_| {
        // Forgetting below 0.15 Hz keeps the road on the rig.
        height += random.normal() - TAU * 0.15 * STEP * height;
        once += smooth * (height - once);
        twice += smooth * (once - twice);
        twice
    })
    .with_peak(peak)
}

/// A sine whose frequency rises from 0.5 to 18 Hz, evenly over the logarithm, amplitude falling with
/// frequency^`slope`.
pub fn sweep(duration: f64, slope: f64, peak: f64) -> Profile {
    let (low, high) = (0.5_f64, 18.0_f64);
    let growth = (high / low).ln() / (duration - STANDSTILL);
    let law = |t: f64| (TAU * low / growth * ((growth * t).exp() - 1.0)).sin() * (-slope * growth * t).exp();
    Profile::new(duration, law).with_peak(peak)
}

/// A slow triangle, `period` seconds long, its corners rounded over 20 ms.
pub fn triangle(duration: f64, period: f64, peak: f64) -> Profile {
    let sharp = |t: f64| {
        let place = (t / period + 0.25).rem_euclid(1.0);
        peak * (1.0 - 4.0 * (place - 0.5).abs())
    };
    Profile::new(duration, |t| (0..20).map(|k| sharp(t - f64::from(k) * 1e-3)).sum::<f64>() / 20.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_begins_at_rest() {
        let mut random = Random::new(1, "test");
        let all = [
            multisine(&mut random, 4.0, 1.0, 0.006),
            prbs(&mut random, 4.0, 0.02, 150.0),
            steps(&mut random, 4.0, 0.02, 150.0),
            bumps(&mut random, 4.0, 0.008),
            road(&mut random, 4.0, 0.006),
            sweep(4.0, 1.0, 0.006),
            triangle(4.0, 2.0, 0.006),
        ];
        for profile in all {
            assert_eq!(profile.at(STANDSTILL - 1e-3), (0.0, 0.0));
            assert!((0..4000).any(|k| profile.at(f64::from(k) * 1e-3).0 != 0.0));
        }
    }

    #[test]
    fn the_rate_is_the_derivative() {
        let profile = multisine(&mut Random::new(2, "test"), 4.0, 1.0, 0.006);
        for k in 0..200 {
            let t = 1.0 + f64::from(k) * 7.3e-3;
            let difference = (profile.at(t + 1e-6).0 - profile.at(t - 1e-6).0) / 2e-6;
            assert!((difference - profile.at(t).1).abs() < 1e-5, "at {t} s");
            // As a profile of its own it is straight enough between its knots.
            assert!((profile.rate().at(t).0 - profile.at(t).1).abs() < 1e-4, "at {t} s");
        }
    }
}
