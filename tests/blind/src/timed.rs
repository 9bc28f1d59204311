//! Effects of time alone: parts that turn, and bursts. Each record finds them at other times.

use std::f64::consts::TAU;

use crate::excitation::{STANDSTILL, fade_in};
use crate::random::Random;

/// A part that turns at a constant speed from the end of the standstill on; its effect fades in as every excitation does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning {
    /// Amplitude.
    pub size: f64,
    /// Turns a second, in Hz.
    pub frequency: f64,
    /// At the beginning of the record, in rad.
    pub phase: f64,
}

impl Turning {
    /// Its effect at a time in s.
    pub fn at(&self, time: f64) -> f64 {
        let fade = if time > STANDSTILL { fade_in(time - STANDSTILL) } else { 0.0 };
        fade * self.size * (TAU * self.frequency * time + self.phase).sin()
    }
}

/// Spans of time, in order and apart.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bursts(Vec<[f64; 2]>);

impl Bursts {
    /// Shortest and longest burst, in s.
    pub const LENGTHS: (f64, f64) = (0.02, 0.2);

    /// Spans between which `1/rate` seconds pass on average, at random.
    pub fn new(random: &mut Random, duration: f64, rate: f64) -> Self {
        if rate <= 0.0 {
            return Self::default();
        }
        let mut next = |end: f64| {
            let start = end - (1.0 - random.unit()).ln() / rate;
            [start, start + random.log_between(Self::LENGTHS.0, Self::LENGTHS.1)]
        };
        let first = next(STANDSTILL);
        let all = std::iter::successors(Some(first), |[_, end]| Some(next(*end)));
        Self(all.take_while(|[start, _]| *start < duration).collect())
    }

    /// Whether a time in s is in one of them.
    pub fn cover(&self, time: f64) -> bool {
        let next = self.0.partition_point(|[start, _]| *start <= time);
        next > 0 && time < self.0[next - 1][1]
    }

    /// Their length together, in s.
    pub fn total(&self) -> f64 {
        self.0.iter().map(|[start, end]| end - start).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turning_part_rests_first_and_then_repeats_itself() {
        let turning = Turning { size: 3.0, frequency: 4.0, phase: 0.3 };
        assert_eq!(turning.at(STANDSTILL), 0.0);
        assert!((turning.at(2.0) - 3.0 * 0.3_f64.sin()).abs() < 1e-12);
        for k in 0..100 {
            let time = 1.1 + f64::from(k) * 0.013;
            assert!((turning.at(time) - turning.at(time + 0.25)).abs() < 1e-12);
        }
        assert_eq!(Turning { size: 0.0, ..turning }.at(2.0), 0.0);
    }

    #[test]
    fn bursts_come_as_often_and_last_as_long_as_asked() {
        let bursts = Bursts::new(&mut Random::new(3, "test"), 1000.0, 2.0);
        assert!(bursts.0.iter().all(|[start, end]| (0.02..=0.2).contains(&(end - start)) && *start > 0.5));
        assert!(bursts.0.windows(2).all(|pair| pair[0][1] <= pair[1][0]));
        // Half a second apart, 0.18/ln 10 s long.
        let due = 1000.0 / (0.5 + 0.18 / 10_f64.ln());
        assert!((bursts.0.len() as f64 / due - 1.0).abs() < 0.1, "{} for {due}", bursts.0.len());
        let [start, end] = bursts.0[7];
        let seen = [start - 1e-6, start, 0.5 * (start + end), end].map(|time| bursts.cover(time));
        assert_eq!(seen, [false, true, true, false]);
        let covered = (0..1_000_000).filter(|k| bursts.cover(f64::from(*k) * 1e-3)).count() as f64 * 1e-3;
        assert!((covered / bursts.total() - 1.0).abs() < 0.01, "{covered} s");
        assert_eq!(Bursts::new(&mut Random::new(3, "test"), 1000.0, 0.0), Bursts::default());
        assert!(!Bursts::default().cover(1.0));
    }
}
