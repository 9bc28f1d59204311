//! A linear response without a name: what a signal shows after a step of one, over the time since the step.

/// Times after a step in s, at which its response is given; it is straight between them and stays where it is after the last.
pub const AFTER: [f64; 14] =
    [0.0, 4e-3, 8e-3, 13e-3, 20e-3, 28e-3, 38e-3, 55e-3, 85e-3, 0.14, 0.23, 0.38, 0.62, 1.0];

/// Deviation of a point of which the data say nothing.
pub const UNKNOWN: f64 = 1.0;

/// By how much a step response exceeds one at the times of [`AFTER`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Response(pub [f64; AFTER.len()]);

impl Response {
    /// Whether it is one all the time.
    pub fn is_neutral(&self) -> bool {
        self.0.iter().all(|amount| *amount == 0.0)
    }

    /// What becomes of a signal with samples every `step` seconds, straight between them, that rested at its first value before.
    ///
    /// A step response that is straight between two times gives as much of the signal's mean over the delays between
    /// them as it rises there.
    pub(super) fn applied(&self, signal: &[f64], step: f64) -> Vec<f64> {
        let integral = Integral::new(signal);
        let late = |index: usize, after: f64| integral.at(index as f64 - after / step);
        let pieces: Vec<(f64, f64, f64)> = (1..AFTER.len())
            .map(|k| (AFTER[k - 1], AFTER[k], (self.0[k] - self.0[k - 1]) * step / (AFTER[k] - AFTER[k - 1])))
            .filter(|piece| piece.2 != 0.0)
            .collect();
        let answer = |(index, y): (usize, &f64)| {
            let rises = pieces.iter().map(|(from, to, rate)| rate * (late(index, *from) - late(index, *to)));
            (1.0 + self.0[0]) * y + rises.sum::<f64>()
        };
        signal.iter().enumerate().map(answer).collect()
    }
}

/// The integral over its samples' numbers of a signal that is straight between them and rested before the first.
struct Integral<'a> {
    signal: &'a [f64],
    sums: Vec<f64>,
}

impl<'a> Integral<'a> {
    fn new(signal: &'a [f64]) -> Self {
        let mut sum = 0.0;
        let areas = signal.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        let sums = std::iter::once(0.0).chain(areas.map(|area| {
            sum += area;
            sum
        }));
        Self { signal, sums: sums.collect() }
    }

    /// Up to a place that is not beyond the last sample.
    fn at(&self, place: f64) -> f64 {
        if place <= 0.0 {
            return self.signal.first().map_or(0.0, |first| first * place);
        }
        let index = place as usize;
        let (share, here) = (place - index as f64, self.signal[index]);
        let next = self.signal.get(index + 1).map_or(here, |next| *next);
        self.sums[index] + share * (here + 0.5 * share * (next - here))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// After a step it shows its points; a ramp comes out as their integral.
    #[test]
    fn a_step_and_a_ramp_come_out_as_its_points_say() {
        let response = Response(std::array::from_fn(|k| 0.3 * (k as f64).sin()));
        let step = 1e-3;
        let ramp: Vec<f64> = (0..1500).map(|k| k as f64 * step).collect();
        let out = response.applied(&ramp, step);
        let slope = |k: usize| (out[k + 1] - out[k]) / step;
        for (point, after) in response.0.iter().zip(AFTER).skip(1) {
            let k = (after / step).round() as usize;
            let middle = 0.5 * (slope(k - 1) + slope(k));
            // Between two times it is straight, with a corner at each.
            assert!((middle - (1.0 + point)).abs() < 0.04, "{after} s: {middle}");
        }
        assert!((slope(1300) - (1.0 + response.0[13])).abs() < 1e-9);
    }

    /// A first-order lag of 50 ms by its points, and a constant signal.
    #[test]
    fn a_lag_can_be_told_by_points() {
        let response = Response(AFTER.map(|after| -(-after / 0.05_f64).exp()));
        let step = 2e-3;
        let omega = 20.0;
        let sine: Vec<f64> = (0..4000).map(|k| (omega * step * k as f64).sin()).collect();
        let out = response.applied(&sine, step);
        let (gain, phase) = (1.0 / 1_f64.hypot(omega * 0.05), (omega * 0.05).atan());
        for (k, out) in out.iter().enumerate().skip(1000) {
            let expected = gain * (omega * step * k as f64 - phase).sin();
            assert!((out - expected).abs() < 0.02, "{out} for {expected}");
        }
        assert!((response.applied(&[3.0; 2000], step)[1999] - 3.0).abs() < 1e-6);
    }
}
