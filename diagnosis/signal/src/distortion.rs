//! What a sensor or an actuator makes of a signal: gain, offset, drift, lag, delay, wrong rate, curvature, a limit; or a response
//! that has no name.

mod response;

use crate::derivative;

pub use response::{AFTER, Response, UNKNOWN};

/// Steps in which a slightly bent line is straightened to the last digit.
const NEWTON: usize = 6;

/// A way in which a signal is changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Fault {
    /// Relative change of the gain.
    Gain,
    /// Constant, in the signal's unit.
    Offset,
    /// How fast the offset grows, in the signal's unit per second.
    Drift,
    /// Time constant of a first-order lag in seconds.
    Lag,
    /// Delay in seconds; negative: the signal is early.
    Delay,
    /// Quadratic part, in one over the signal's unit.
    Quadratic,
    /// Cubic part, in one over the signal's unit squared.
    Cubic,
    /// Relative error of the sampling rate: samples are taken at `(1 + rate) t`.
    Rate,
    /// Largest magnitude, in the signal's unit; zero is no limit.
    Limit,
    /// By how much the response to a step of one exceeds one, after a time of [`AFTER`].
    Response(usize),
}

impl Fault {
    /// All that have a name.
    pub const NAMED: [Self; 9] = [
        Self::Gain,
        Self::Offset,
        Self::Drift,
        Self::Lag,
        Self::Delay,
        Self::Quadratic,
        Self::Cubic,
        Self::Rate,
        Self::Limit,
    ];

    /// Its place among those with a name.
    fn number(self) -> Option<usize> {
        Self::NAMED.iter().position(|it| *it == self)
    }

    /// Its name, as the last part of a parameter's.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gain => "gain",
            Self::Offset => "offset",
            Self::Drift => "drift",
            Self::Lag => "lag",
            Self::Delay => "delay",
            Self::Quadratic => "quadratic",
            Self::Cubic => "cubic",
            Self::Rate => "rate",
            Self::Limit => "limit",
            Self::Response(_) => "response",
        }
    }

    /// Unit of its parameter for a signal of a unit.
    pub fn unit(self, signal: &str) -> String {
        match self {
            Self::Gain | Self::Rate | Self::Response(_) => "1".into(),
            Self::Offset | Self::Limit => signal.into(),
            Self::Drift => format!("{signal}/s"),
            Self::Lag | Self::Delay => "s".into(),
            Self::Quadratic => format!("1/({signal})"),
            Self::Cubic => format!("1/({signal})2"),
        }
    }
}

/// Which samples of a record a signal's are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Samples {
    /// Time between two of them in seconds.
    pub step: f64,
    /// Number of the first one in the record: drifts and wrong rates grow from the record's beginning.
    pub first: usize,
}

impl Samples {
    /// Time of a sample since the record's beginning.
    fn time(self, index: usize) -> f64 {
        self.step * (self.first + index) as f64
    }
}

/// Every change of one signal: `(1 + gain) lag(y(t')) + offset + drift t` with `t' = (1 + rate) t − delay` and the signal bent
/// before, `y + q y² + c y³`; the lag's output passes the response without a name, and what comes out is held within the limit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Correction {
    /// Of [`Fault::NAMED`].
    amounts: [f64; 9],
    response: Response,
}

impl Correction {
    /// How much of a fault there is.
    pub fn get(&self, fault: Fault) -> f64 {
        match fault {
            Fault::Response(point) => self.response.0[point],
            _ => fault.number().map_or(0.0, |number| self.amounts[number]),
        }
    }

    /// Sets how much of a fault there is.
    pub fn set(&mut self, fault: Fault, amount: f64) {
        if let Fault::Response(point) = fault {
            self.response.0[point] = amount;
        } else if let Some(number) = fault.number() {
            self.amounts[number] = amount;
        }
    }

    /// Whether it changes nothing.
    pub fn is_neutral(&self) -> bool {
        self.amounts.iter().all(|amount| *amount == 0.0) && self.response.is_neutral()
    }

    /// The response without a name.
    pub fn response(&self) -> &Response {
        &self.response
    }

    /// How many samples before and after some the signal has to be known to know what becomes of it there; a lag forgets what
    /// was eight time constants ago.
    pub fn reach(&self, samples: Samples, count: usize) -> (usize, usize) {
        const FORGOTTEN: f64 = 8.0;
        const CUBIC: f64 = 2.0;
        let late = |index| self.get(Fault::Delay) - self.get(Fault::Rate) * samples.time(index);
        let (first, last) = (late(0), late(count.saturating_sub(1)));
        let memory = if self.response.is_neutral() { 0.0 } else { AFTER[AFTER.len() - 1] };
        let late = first.max(last).max(0.0) + FORGOTTEN * self.get(Fault::Lag) + memory;
        let early = (-first.min(last)).max(0.0);
        let count = |time: f64| if time > 0.0 { ((time / samples.step).ceil() + CUBIC) as usize } else { 0 };
        (count(late), count(early))
    }

    /// What becomes of a signal.
    pub fn applied(&self, signal: &[f64], samples: Samples) -> Vec<f64> {
        self.through(signal, samples, true)
    }

    /// What a signal was before this became of it: the inverse of [`Self::applied`], a lag by the signal's derivative. A
    /// response without a name and a limit stay: what they have taken away cannot be had back.
    pub fn removed(&self, signal: &[f64], samples: Samples) -> Vec<f64> {
        let [gain, offset, drift, lag, delay, quadratic, cubic, rate, _] = self.amounts;
        let linear = |(index, y): (usize, &f64)| (y - offset - drift * samples.time(index)) / (1.0 + gain);
        let mut result: Vec<f64> = signal.iter().enumerate().map(linear).collect();
        if lag > 0.0 {
            let rates = derivative(&result, samples.step);
            result.iter_mut().zip(rates).for_each(|(y, rate)| *y += lag * rate);
        }
        if delay != 0.0 || rate != 0.0 {
            result = resampled(&result, |index| {
                (delay - rate * samples.time(index)) / (1.0 + rate) / samples.step
            });
        }
        if quadratic != 0.0 || cubic != 0.0 {
            for bent in &mut result {
                let mut y = *bent;
                for _ in 0..NEWTON {
                    let slope = 1.0 + y * (2.0 * quadratic + 3.0 * cubic * y);
                    y -= (y * (1.0 + y * (quadratic + y * cubic)) - *bent) / slope;
                }
                *bent = y;
            }
        }
        result
    }

    /// What becomes of a small change of a signal; limits, which are of inputs, aside.
    pub fn tangent(&self, signal: &[f64], change: &[f64], samples: Samples) -> Vec<f64> {
        let (quadratic, cubic) = (self.get(Fault::Quadratic), self.get(Fault::Cubic));
        if quadratic == 0.0 && cubic == 0.0 {
            return self.through(change, samples, false);
        }
        let bent: Vec<f64> = signal
            .iter()
            .zip(change)
            .map(|(y, dy)| dy * (1.0 + 2.0 * quadratic * y + 3.0 * cubic * y * y))
            .collect();
        let mut straight = *self;
        straight.set(Fault::Quadratic, 0.0);
        straight.set(Fault::Cubic, 0.0);
        straight.through(&bent, samples, false)
    }

    fn through(&self, signal: &[f64], samples: Samples, constants: bool) -> Vec<f64> {
        let [gain, offset, drift, lag, delay, quadratic, cubic, rate, limit] = self.amounts;
        let mut result: Vec<f64> = if quadratic == 0.0 && cubic == 0.0 {
            signal.to_vec()
        } else {
            signal.iter().map(|y| y * (1.0 + y * (quadratic + y * cubic))).collect()
        };
        if rate != 0.0 {
            result = resampled(&result, |index| (rate * samples.time(index) - delay) / samples.step);
        } else if delay != 0.0 {
            result = shifted(&result, -delay / samples.step);
        }
        if lag > 0.0 {
            lagged(&mut result, lag / samples.step);
        }
        if !self.response.is_neutral() {
            result = self.response.applied(&result, samples.step);
        }
        if gain != 0.0 {
            result.iter_mut().for_each(|y| *y *= 1.0 + gain);
        }
        if constants && (offset != 0.0 || drift != 0.0) {
            for (index, y) in result.iter_mut().enumerate() {
                *y += offset + drift * samples.time(index);
            }
        }
        if limit > 0.0 {
            result.iter_mut().for_each(|y| *y = y.clamp(-limit, limit));
        }
        result
    }
}

/// A signal at `later` samples after each of its own, by cubic interpolation between them; the ends are held.
fn resampled(signal: &[f64], later: impl Fn(usize) -> f64) -> Vec<f64> {
    let at = |index: usize| {
        let position = index as f64 + later(index);
        let before = position.floor();
        let around = std::array::from_fn(|k| held(signal, before as isize + k as isize - 1));
        interpolated(around, cubic(position - before))
    };
    (0..signal.len()).map(at).collect()
}

/// The same where it is equally many samples after each: most signals are late, and few have a clock of their own.
fn shifted(signal: &[f64], later: f64) -> Vec<f64> {
    let before = later.floor();
    let weights = cubic(later - before);
    let first = before as isize - 1;
    let longer: Vec<f64> = (first..first + signal.len() as isize + 3).map(|it| held(signal, it)).collect();
    longer.windows(4).map(|it| interpolated([it[0], it[1], it[2], it[3]], weights)).collect()
}

/// A sample of a signal, whose ends are held.
fn held(signal: &[f64], index: isize) -> f64 {
    signal.get(index.max(0) as usize).or(signal.last()).copied().unwrap_or_default()
}

/// Weights of four samples at a share of the way from the second to the third, along a cubic (Catmull and Rom).
fn cubic(share: f64) -> [f64; 4] {
    let (s, half) = (share, 0.5 * share);
    [
        half * (s * (2.0 - s) - 1.0),
        1.0 + half * s * (3.0 * s - 5.0),
        half * (1.0 + s * (4.0 - 3.0 * s)),
        half * s * (s - 1.0),
    ]
}

fn interpolated(around: [f64; 4], weights: [f64; 4]) -> f64 {
    around.into_iter().zip(weights).map(|(y, weight)| weight * y).sum()
}

/// A first-order lag with a time constant in samples, exact for a signal that is straight between them.
fn lagged(signal: &mut [f64], samples: f64) {
    let Some(&first) = signal.first() else { return };
    let decay = (-1.0 / samples).exp();
    let (mut state, mut before) = (first, first);
    for y in signal {
        let slope = *y - before;
        // Response to a ramp from `before`: it follows the ramp `samples` behind.
        state = *y - samples * slope + (state - before + samples * slope) * decay;
        before = *y;
        *y = state;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sine(n: usize, step: f64, at: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..n).map(|k| at(k as f64 * step)).collect()
    }

    fn every(step: f64) -> Samples {
        Samples { step, first: 0 }
    }

    #[test]
    fn drift_and_wrong_rate_grow_from_the_record_s_beginning() {
        let mut correction = Correction::default();
        correction.set(Fault::Drift, 0.3);
        correction.set(Fault::Rate, 2e-3);
        let whole = sine(4000, 1e-3, |t| (20.0 * t).sin());
        let all = correction.applied(&whole, every(1e-3));
        let part = correction.applied(&whole[2000..], Samples { step: 1e-3, first: 2000 });
        for k in 10..1980 {
            let t = 2.0 + k as f64 * 1e-3;
            let expected = (20.0 * 1.002 * t).sin() + 0.3 * t;
            assert!((part[k] - expected).abs() < 1e-4 && (part[k] - all[2000 + k]).abs() < 1e-12, "{k}");
        }
    }

    #[test]
    fn a_lag_delays_a_slow_sine_by_its_time_constant_and_weakens_a_fast_one() {
        let mut correction = Correction::default();
        correction.set(Fault::Lag, 0.01);
        let omega = 100.0;
        let lagged = correction.applied(&sine(4000, 1e-4, |t| (omega * t).sin()), every(1e-4));
        let (gain, phase) = (1.0 / 2.0_f64.sqrt(), -std::f64::consts::FRAC_PI_4);
        for k in (2000..4000).step_by(7) {
            let expected = gain * (omega * k as f64 * 1e-4 + phase).sin();
            assert!((lagged[k] - expected).abs() < 1e-4, "{k}");
        }
    }

    #[test]
    fn nothing_passes_beyond_a_limit_and_all_below_it() {
        let mut correction = Correction::default();
        correction.set(Fault::Limit, 2.0);
        correction.set(Fault::Gain, 0.5);
        assert_eq!(correction.applied(&[1.0, -1.25, 1.5, -4.0], every(1e-3)), [1.5, -1.875, 2.0, -2.0]);
        assert!(!correction.is_neutral());
        correction.set(Fault::Limit, 0.0);
        assert_eq!(correction.applied(&[1.0, -4.0], every(1e-3)), [1.5, -6.0]);
    }

    proptest! {
        #[test]
        fn a_shift_by_the_same_is_one_by_whatever_each_sample_says(
            signal in prop::collection::vec(-1.0..1.0_f64, 0..20), later in -30.0..30.0_f64,
        ) {
            let (all, each) = (shifted(&signal, later), resampled(&signal, |_| later));
            prop_assert_eq!(all.len(), signal.len());
            for (a, b) in all.iter().zip(&each) {
                prop_assert!((a - b).abs() < 1e-12, "{} {}", a, b);
            }
        }

        #[test]
        fn a_delay_is_one(delay in -0.02..0.02_f64) {
            let mut correction = Correction::default();
            correction.set(Fault::Delay, delay);
            let y = |t: f64| (20.0 * t).sin() + 0.3 * (55.0 * t).cos();
            let delayed = correction.applied(&sine(1000, 1e-3, y), every(1e-3));
            for (k, value) in delayed.iter().enumerate().skip(30).take(940) {
                prop_assert!((value - y(k as f64 * 1e-3 - delay)).abs() < 1e-4);
            }
        }

        #[test]
        fn what_is_removed_is_what_was_applied(amounts in prop::array::uniform9(-0.1..0.1_f64)) {
            let mut correction = Correction { amounts, ..Correction::default() };
            correction.set(Fault::Limit, 0.0);
            correction.set(Fault::Rate, 0.05 * amounts[7]);
            correction.set(Fault::Lag, 0.05 * amounts[3].abs());
            correction.set(Fault::Delay, 0.1 * amounts[4]);
            let signal = sine(2000, 1e-3, |t| (20.0 * t).sin() + 0.3 * (55.0 * t).cos());
            let found = correction.removed(&correction.applied(&signal, every(1e-3)), every(1e-3));
            for (found, value) in found.iter().zip(&signal).skip(60).take(1880) {
                prop_assert!((found - value).abs() < 2e-3, "{found} {value}");
            }
        }

        #[test]
        fn the_tangent_is_the_derivative(amounts in prop::array::uniform9(-0.2..0.2_f64), h in 1e-6..1e-5_f64) {
            let mut correction = Correction { amounts, ..Correction::default() };
            correction.set(Fault::Limit, 0.0);
            correction.set(Fault::Response(5), amounts[0]);
            let y = sine(50, 1e-2, |t| (9.0 * t).sin());
            let change = sine(50, 1e-2, |t| (4.0 * t).cos());
            let moved: Vec<f64> = y.iter().zip(&change).map(|(y, d)| y + h * d).collect();
            let (a, b) = (correction.applied(&y, every(1e-2)), correction.applied(&moved, every(1e-2)));
            for ((a, b), t) in a.iter().zip(&b).zip(correction.tangent(&y, &change, every(1e-2))) {
                prop_assert!(((b - a) / h - t).abs() < 1e-3);
            }
        }
    }
}
