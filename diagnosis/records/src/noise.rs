//! Measurement noise and the steps of the converter.

use strut_signal::spectral::{filled, power_spectrum};

use crate::check::REST_BLOCK;

/// Differences of this order leave next to nothing of a signal that is sampled ten times in its period.
const ORDER: usize = 5;
/// Rms of these differences over that of white noise: the root of the binomial coefficient 10 over 5.
const GAIN: f64 = 15.874_507_866_387_544;
/// Band of a spectrum from which the noise is taken, in cycles a sample: above most signals, and below the cut of most antialiasing filters.
const BAND: (f64, f64) = (0.15, 0.4);
/// Its parts, of which the quietest counts.
const PARTS: usize = 5;
/// Samples below which no spectrum is taken.
const FEWEST: usize = 512;
/// Ratio of the quietest part's noise to that of the differences below which the latter see the signal: chance makes less.
const QUIETER: f64 = 0.5;
/// Median of the magnitude of a normal variable with unit variance.
const MEDIAN: f64 = 0.674_489_750_196_081_7;
/// A signal with fewer values than this is a switched command rather than a coarse measurement.
const SWITCHED: usize = 4;

/// The lattice that the values of a converter or of a printed number lie on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// Distance of neighbouring values, q.
    pub step: f64,
    /// How many different values are used.
    pub levels: usize,
}

impl Lattice {
    /// Rms of the rounding error, q/√12.
    #[must_use]
    pub fn noise(self) -> f64 {
        self.step / 12.0_f64.sqrt()
    }
}

/// The lattice of a signal: the largest q of which all differences of values are multiples, if need be but for the
/// rounding of printed numbers. None if the values are finer than 2⁻¹⁸ of their range, or constant.
#[must_use]
pub fn lattice(values: &[f64]) -> Option<Lattice> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let (&first, &last) = (sorted.first()?, sorted.last()?);
    let range = last - first;
    let (finest, rounding) = (range * 2.0_f64.powi(-18), range * 2.0_f64.powi(-25));
    sorted.dedup_by(|a, b| (*a - *b).abs() <= rounding);
    let step = divisor(&sorted, rounding, finest).or_else(|| spacing(&sorted).filter(|&q| q > finest));
    step.filter(|_| sorted.len() > 1).map(|step| Lattice { step, levels: sorted.len() })
}

/// The greatest common divisor of the ascending values' differences; none if it is not above the finest.
fn divisor(sorted: &[f64], rounding: f64, finest: f64) -> Option<f64> {
    let mut q = sorted[sorted.len() - 1] - sorted[0];
    // Euclid's algorithm; a remainder that is nearly nothing, or nearly the divisor, is rounding.
    for value in sorted {
        let (mut a, mut b) = (value - sorted[0], q);
        while b > rounding {
            let rest = a % b;
            (a, b) = (b, if b - rest <= rounding { 0.0 } else { rest });
        }
        q = a;
        if q <= finest {
            return None;
        }
    }
    Some(q)
}

/// The spacing of ascending values that lie within a tenth of it on a lattice: the least distance of neighbours,
/// refined by a line through the values over their numbers on the lattice.
fn spacing(sorted: &[f64]) -> Option<f64> {
    const FEWEST: usize = 8;
    let gaps = || sorted.windows(2).map(|pair| pair[1] - pair[0]);
    let mut q = gaps().reduce(f64::min).filter(|&q| q > 0.0 && sorted.len() >= FEWEST)?;
    let mut places = vec![0.0; sorted.len()];
    for _ in 0..3 {
        for (i, gap) in gaps().enumerate() {
            places[i + 1] = places[i] + (gap / q).round();
        }
        q = line(&places, sorted).1;
    }
    let (start, q) = line(&places, sorted);
    places.iter().zip(sorted).all(|(place, value)| (value - start - q * place).abs() < 0.1 * q).then_some(q)
}

/// Value at 0 and slope of the line through y over x.
fn line(x: &[f64], y: &[f64]) -> (f64, f64) {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (mean_x, mean_y) = (mean(x), mean(y));
    let covariance: f64 = x.iter().zip(y).map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    let slope = covariance / x.iter().map(|x| (x - mean_x).powi(2)).sum::<f64>();
    (mean_y - slope * mean_x, slope)
}

/// Standard deviation of the white noise on a signal, from its fifth differences: their median is moved neither by
/// the slow signal nor by rare impacts. Where a part of the spectrum is much quieter, its level is taken instead: of a signal with
/// fewer than ten samples a period, differences are no noise. Never less than the rounding error. Signals with missing samples are
/// judged where six in a row are there; 0 if there is no such place.
#[must_use]
pub fn noise_floor(values: &[f64]) -> f64 {
    const BINOMIAL: [f64; ORDER + 1] = [-1.0, 5.0, -10.0, 10.0, -5.0, 1.0];
    let difference = |window: &[f64]| window.iter().zip(BINOMIAL).map(|(v, b)| v * b).sum::<f64>().abs();
    let mut differences: Vec<f64> =
        values.windows(ORDER + 1).map(difference).filter(|difference| difference.is_finite()).collect();
    let white = median(&mut differences).map_or(0.0, |median| median / (MEDIAN * GAIN));
    let quietest = quietest(values).filter(|it| *it < QUIETER * white);
    quietest.unwrap_or(white).max(rounding(values))
}

/// Standard deviation of a signal while nothing moves: of what an antialiasing filter left of the noise, differences see little. It
/// is that about a line, which what settles slowly follows, in the middle one of the blocks of time; 0 of fewer samples than one has.
#[must_use]
pub fn noise_at_rest(values: &[f64]) -> f64 {
    let number: Vec<f64> = (0..REST_BLOCK).map(|k| k as f64).collect();
    let about_line = |block: &[f64]| {
        let (start, slope) = line(&number, block);
        let squares = block.iter().zip(&number).map(|(value, k)| (value - start - slope * k).powi(2));
        (squares.sum::<f64>() / (REST_BLOCK - 2) as f64).sqrt()
    };
    let mut blocks: Vec<f64> =
        values.chunks_exact(REST_BLOCK).map(about_line).filter(|it| it.is_finite()).collect();
    median(&mut blocks).unwrap_or(0.0)
}

/// Standard deviation of white noise that is as strong at all frequencies as the signal is in the quietest part of the band; none
/// of few samples.
fn quietest(values: &[f64]) -> Option<f64> {
    let known = filled(values).filter(|it| it.len() >= FEWEST)?;
    let (frequency, density) = power_spectrum(&known, 1.0);
    let width = (BAND.1 - BAND.0) / PARTS as f64;
    let levels = (0..PARTS).filter_map(|part| {
        let from = BAND.0 + width * part as f64;
        let within = frequency.iter().zip(&density).filter(|(at, _)| (from..from + width).contains(*at));
        median(&mut within.map(|(_, density)| *density).collect::<Vec<_>>())
    });
    // One-sided: all of the power is below half a cycle a sample.
    levels.reduce(f64::min).map(|level| (0.5 * level).sqrt())
}

/// Rms of the rounding error of values as they were recorded; zero if they are fine, or those of a switched command.
#[must_use]
pub fn rounding(values: &[f64]) -> f64 {
    lattice(values).filter(|lattice| lattice.levels >= SWITCHED).map_or(0.0, Lattice::noise)
}

/// The middle of the values, which are reordered; none if there are none.
pub(crate) fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use strut_signal::random::{multisine, white};

    #[test]
    fn known_noise_is_found() {
        for sigma in [1e-3, 0.01, 0.3] {
            for seed in 0..10 {
                let white = white(seed, 4000);
                let values: Vec<f64> =
                    multisine(seed, 4000).iter().zip(white).map(|(s, n)| s + sigma * n).collect();
                let found = noise_floor(&values);
                assert!((found / sigma - 1.0).abs() < 0.1, "{sigma}: {found}");
            }
        }
    }

    #[test]
    fn impacts_and_missing_samples_do_not_count() {
        let mut values: Vec<f64> = white(3, 4000).iter().map(|n| 0.01 * n).collect();
        for i in (0..4000).step_by(200) {
            values[i] = if i % 400 == 0 { f64::NAN } else { 50.0 };
        }
        assert!((noise_floor(&values) / 0.01 - 1.0).abs() < 0.15);
        assert_eq!(noise_floor(&[f64::NAN; 20]), 0.0);
        assert_eq!(noise_floor(&[1.0, 2.0]), 0.0);
    }

    /// Differences take 1.5 cycles in ten samples for noise; the band beyond them has none but that.
    #[test]
    fn a_signal_of_few_samples_a_period_is_no_noise() {
        for sigma in [1e-3, 0.01, 0.1] {
            let white = white(5, 8000);
            let wave = |k: usize, number: f64| (k as f64 * (0.1 + 0.02 * number) + number).sin();
            let fast = |k: usize| (0..40).map(|number| wave(k, f64::from(number))).sum::<f64>();
            let values: Vec<f64> = (0..8000).map(|k| fast(k) + sigma * white[k]).collect();
            let found = noise_floor(&values);
            assert!((found / sigma - 1.0).abs() < 0.15, "{sigma}: {found}");
        }
    }

    /// A moving average lets pass a quarter of the band: where nothing moves, the rms is the noise.
    #[test]
    fn noise_behind_a_filter_is_found_at_rest() {
        for seed in 0..10 {
            let filtered: Vec<f64> =
                white(seed, 2000).windows(4).map(|it| it.iter().sum::<f64>() / 4.0).collect();
            let settling = |k: usize| 5.0 * (-(k as f64) / 1000.0).exp();
            let values: Vec<f64> =
                filtered.iter().enumerate().map(|(k, noise)| settling(k) + noise).collect();
            let (expected, found) = (0.5, noise_at_rest(&values));
            assert!((found / expected - 1.0).abs() < 0.2, "{found}");
            assert!(noise_floor(&values) < 0.5 * expected);
        }
        assert!((noise_at_rest(&white(3, 2000)) - 1.0).abs() < 0.1);
        assert_eq!(noise_at_rest(&white(3, REST_BLOCK - 1)), 0.0);
    }

    #[test]
    fn rounding_is_the_least_noise() {
        let slow: Vec<f64> =
            (0..4000).map(|i| (f64::from(i) * 1e-3).sin()).map(|v| (v * 50.0).round() / 50.0).collect();
        assert!((noise_floor(&slow) - 0.02 / 12.0_f64.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn lattices() {
        let values: Vec<f64> = [7, -3, 12, 0, 5, 40].iter().map(|&k| 0.1 + 0.0123 * f64::from(k)).collect();
        let found = lattice(&values).unwrap();
        assert!((found.step - 0.0123).abs() < 1e-9, "{found:?}");
        assert_eq!(found.levels, 6);
        // A common divisor that is no difference of neighbours.
        assert!((lattice(&[0.0, 2.0, 5.0, 9.0]).unwrap().step - 1.0).abs() < 1e-9);
        let fine: Vec<f64> = multisine(1, 500).iter().map(|v| (v * 1e4).round() / 1e4).collect();
        assert!((lattice(&fine).unwrap().step - 1e-4).abs() < 1e-8);
        // A converter's steps, printed with five digits.
        let printed: Vec<f64> = multisine(1, 2000).iter().map(|v| (v * 200.0).round() * 3.5625).collect();
        let printed: Vec<f64> = printed.iter().map(|v| format!("{v:.4e}").parse().unwrap()).collect();
        assert!((lattice(&printed).unwrap().step - 3.5625).abs() < 1e-4);
        assert_eq!(lattice(&multisine(1, 500)), None);
        assert_eq!(lattice(&white(1, 4000)), None);
        assert_eq!(lattice(&[3.0; 9]), None);
        assert_eq!(lattice(&[]), None);
    }
}
