//! From the true signal to what the record shows.

mod rattle;

use std::f64::consts::{PI, TAU};

use crate::car::RATE;
use crate::random::Random;

pub use rattle::Rattle;

/// What a sensor does to its signal; by default nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    /// What is loose about its mounting, of an accelerometer.
    pub rattle: Option<Rattle>,
    /// First-order time constant, in s.
    pub lag: f64,
    /// A second one, of the clutter, in s.
    pub bandwidth: f64,
    /// Natural frequency in Hz and damping ratio of a second-order response.
    pub resonance: Option<(f64, f64)>,
    /// Frequency in Hz below which nothing passes, as of a first-order high-pass; zero is none.
    pub high_pass: f64,
    /// Time by which the signal comes late, in s; exact, and negative if the others are late.
    pub skew: f64,
    /// How much later its samples are taken than their number says, as a share of the time.
    pub rate_error: f64,
    /// Mass between cell and tyre in kg, of a force cell in the wheel: it shows the tyre's force less what that
    /// mass takes.
    pub moved_mass: f64,
    /// How far to each side the signal can be from what it was left at, in its unit, before what is shown follows: friction
    /// in a cell.
    pub hysteresis: f64,
    /// Shown over true.
    pub gain: f64,
    /// In the signal's unit.
    pub offset: f64,
    /// In the signal's unit for a second.
    pub drift: f64,
    /// Deviation of the white noise, in the signal's unit.
    pub noise: f64,
    /// Step of the converter; zero is none.
    pub quantum: f64,
    /// Largest value to each side.
    pub range: f64,
    /// Amplitude in the signal's unit and frequency in Hz of a sine that no filter has taken away before the converter.
    pub folded: (f64, f64),
    /// Chance that a sample begins a dropout of up to 50 ms, during which the last value stays.
    pub dropout: f64,
}

impl Default for Sensor {
    fn default() -> Self {
        Self {
            rattle: None,
            lag: 0.0,
            bandwidth: 0.0,
            resonance: None,
            high_pass: 0.0,
            skew: 0.0,
            rate_error: 0.0,
            moved_mass: 0.0,
            hysteresis: 0.0,
            gain: 1.0,
            offset: 0.0,
            drift: 0.0,
            noise: 0.0,
            quantum: 0.0,
            range: f64::INFINITY,
            folded: (0.0, 0.0),
            dropout: 0.0,
        }
    }
}

impl Sensor {
    /// The samples that it shows of `signal`, which has [`RATE`] samples a second, at `rate` a second.
    pub fn measure(&self, signal: &[f64], rate: f64, random: &mut Random) -> Vec<f64> {
        let seated = self.rattle.map(|rattle| rattle.felt(signal));
        let signal = seated.as_deref().unwrap_or(signal);
        let ringing = resonating(&dragged(signal, self.hysteresis), self.resonance);
        let passed = high_passed(&ringing, self.high_pass);
        let slow = delayed(&lagged(&lagged(&passed, self.lag), self.bandwidth), self.skew);
        let mut shown = decimated(&stretched(&slow, self.rate_error), rate);
        for (k, value) in shown.iter_mut().enumerate() {
            let time = k as f64 / rate;
            let drifted =
                self.offset + self.drift * time + self.folded.0 * (TAU * self.folded.1 * time).sin();
            // Noise is drawn even if it is nothing, so that the rest of the stream stays where it is.
            let noisy = self.gain * *value + drifted + self.noise * random.normal();
            let clipped = noisy.clamp(-self.range, self.range);
            *value =
                if self.quantum > 0.0 { (clipped / self.quantum).round() * self.quantum } else { clipped };
        }
        if self.dropout > 0.0 {
            self.drop_out(&mut shown, rate, random);
        }
        shown
    }

    fn drop_out(&self, shown: &mut [f64], rate: f64, random: &mut Random) {
        let mut k = 1;
        while k < shown.len() {
            if random.unit() < self.dropout {
                let length = (random.between(0.02, 0.05) * rate).ceil() as usize;
                let end = (k + length).min(shown.len());
                let last = shown[k - 1];
                shown[k..end].fill(last);
                k = end;
            }
            k += 1;
        }
    }
}

/// What friction leaves of a signal: it stays until the signal is `width` away, and is then dragged along.
fn dragged(signal: &[f64], width: f64) -> Vec<f64> {
    let drag = |left: &mut f64, value: &f64| {
        *left = left.clamp(value - width, value + width);
        Some(*left)
    };
    signal.iter().scan(signal[0], drag).collect()
}

/// Exact for a signal that is linear between samples.
fn lagged(signal: &[f64], time_constant: f64) -> Vec<f64> {
    if time_constant <= 0.0 {
        return signal.to_vec();
    }
    let ratio = 1.0 / (RATE * time_constant);
    let keep = (-ratio).exp();
    let average = (1.0 - keep) / ratio;
    let mut out = vec![signal[0]; signal.len()];
    for k in 1..signal.len() {
        out[k] = keep * out[k - 1] + (average - keep) * signal[k - 1] + (1.0 - average) * signal[k];
    }
    out
}

/// What a second-order response with a natural frequency in Hz and a damping ratio makes of a signal, from rest at its beginning.
fn resonating(signal: &[f64], response: Option<(f64, f64)>) -> Vec<f64> {
    let Some((frequency, ratio)) = response else { return signal.to_vec() };
    let omega = TAU * frequency;
    let rates = |[y, v]: [f64; 2], x: f64| [v, omega * (omega * (x - y) - 2.0 * ratio * v)];
    let mut state = [signal[0], 0.0];
    let mut out = vec![signal[0]; signal.len()];
    for k in 1..signal.len() {
        let half = |slope: [f64; 2], step: f64| std::array::from_fn(|i| state[i] + step / RATE * slope[i]);
        let middle = 0.5 * (signal[k - 1] + signal[k]);
        let first = rates(state, signal[k - 1]);
        let second = rates(half(first, 0.5), middle);
        let third = rates(half(second, 0.5), middle);
        let fourth = rates(half(third, 1.0), signal[k]);
        state = std::array::from_fn(|i| {
            state[i] + (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]) / (6.0 * RATE)
        });
        out[k] = state[0];
    }
    out
}

/// What is left of a signal above a frequency in Hz, as of a charge amplifier.
fn high_passed(signal: &[f64], frequency: f64) -> Vec<f64> {
    if frequency <= 0.0 {
        return signal.to_vec();
    }
    let slow = lagged(signal, 1.0 / (TAU * frequency));
    signal.iter().zip(slow).map(|(x, slow)| x - slow).collect()
}

/// `delay` seconds later, straight lines between the samples.
fn delayed(signal: &[f64], delay: f64) -> Vec<f64> {
    if delay == 0.0 {
        return signal.to_vec();
    }
    taken_at(signal, |k| k - delay * RATE)
}

/// As a clock shows it that is slow by a share `error`: its samples are taken at (1 + error) t.
fn stretched(signal: &[f64], error: f64) -> Vec<f64> {
    if error == 0.0 { signal.to_vec() } else { taken_at(signal, |k| k * (1.0 + error)) }
}

/// Samples at other places, straight lines between those that are there.
fn taken_at(signal: &[f64], place: impl Fn(f64) -> f64) -> Vec<f64> {
    let last = signal.len() - 1;
    let at = |k: f64| signal[(k.max(0.0) as usize).min(last)];
    (0..signal.len())
        .map(|k| {
            let place = place(k as f64);
            let share = place - place.floor();
            at(place.floor()) * (1.0 - share) + at(place.floor() + 1.0) * share
        })
        .collect()
}

/// Every so many samples, after an anti-alias filter (cut-off 0.4 of the rate, without phase; the same for all
/// signals, so that linear relations between them stay).
fn decimated(signal: &[f64], rate: f64) -> Vec<f64> {
    let every = (RATE / rate).round() as usize;
    let reach = 4 * every;
    let cut_off = 0.4 / every as f64;
    let window = |k: f64| 0.5 + 0.5 * (PI * k / (reach as f64 + 1.0)).cos();
    let sinc =
        |k: f64| if k == 0.0 { 1.0 } else { (2.0 * PI * cut_off * k).sin() / (2.0 * PI * cut_off * k) };
    let taps: Vec<f64> =
        (0..=2 * reach).map(|k| k as f64 - reach as f64).map(|k| window(k) * sinc(k)).collect();
    let sum: f64 = taps.iter().sum();
    let last = signal.len() - 1;
    (0..signal.len())
        .step_by(every)
        .map(|centre| {
            let around = |k: usize| signal[(centre + k).saturating_sub(reach).min(last)];
            let weighted: f64 = if centre >= reach && centre + reach <= last {
                taps.iter().zip(&signal[centre - reach..]).map(|(tap, value)| tap * value).sum()
            } else {
                taps.iter().enumerate().map(|(k, tap)| tap * around(k)).sum()
            };
            weighted / sum
        })
        .collect()
}

/// Root mean square.
pub fn rms(signal: &[f64]) -> f64 {
    (signal.iter().map(|x| x * x).sum::<f64>() / signal.len().max(1) as f64).sqrt()
}

/// Root mean square about where a signal is at rest, at the beginning of its record.
pub fn swing(signal: &[f64]) -> f64 {
    let rest = signal.first().copied().unwrap_or_default();
    rms(&signal.iter().map(|x| x - rest).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(frequency: f64, seconds: f64) -> Vec<f64> {
        let count = (seconds * RATE) as usize + 1;
        (0..count).map(|k| (TAU * frequency * k as f64 / RATE).sin()).collect()
    }

    fn shown(sensor: &Sensor, signal: &[f64]) -> Vec<f64> {
        sensor.measure(signal, 1000.0, &mut Random::new(1, "test"))
    }

    #[test]
    fn a_perfect_sensor_shows_the_signal() {
        for rate in [100.0, 250.0, 1000.0] {
            let signal = sine(5.0, 4.0);
            let seen = Sensor::default().measure(&signal, rate, &mut Random::new(1, "test"));
            assert_eq!(seen.len(), (4.0 * rate) as usize + 1);
            let truth = |k: usize| (TAU * 5.0 * k as f64 / rate).sin();
            for (k, seen) in seen.iter().enumerate().take(seen.len() / 2).skip(seen.len() / 4) {
                assert!((seen - truth(k)).abs() < 5e-3, "{rate} Hz: {seen} for {}", truth(k));
            }
        }
    }

    #[test]
    fn what_would_fold_is_filtered_out() {
        let seen = Sensor::default().measure(&sine(90.0, 4.0), 100.0, &mut Random::new(1, "test"));
        assert!(rms(&seen[50..350]) < 0.01, "{}", rms(&seen[50..350]));
    }

    #[test]
    fn a_swing_counts_from_rest() {
        assert_eq!(swing(&[4.0, 7.0, 1.0, 4.0]), 4.5_f64.sqrt());
        assert_eq!(swing(&[]), 0.0);
    }

    #[test]
    fn noise_is_as_large_as_asked() {
        let seen = shown(&Sensor { noise: 0.3, ..Sensor::default() }, &vec![0.0; 800_000]);
        assert!((rms(&seen) / 0.3 - 1.0).abs() < 0.02);
    }

    #[test]
    fn a_skew_of_whole_samples_is_exact() {
        let (plain, late) = (Sensor::default(), Sensor { skew: 5e-3, ..Sensor::default() });
        let (first, second) = (shown(&plain, &sine(7.0, 1.0)), shown(&late, &sine(7.0, 1.0)));
        for k in 100..900 {
            assert!((second[k] - first[k - 5]).abs() < 1e-12);
        }
    }

    /// With half a percent the samples of the second at 4 s are those of 4.02 s.
    #[test]
    fn a_wrong_clock_is_wrong_by_its_share_of_the_time() {
        for error in [0.005, -0.005] {
            let seen = shown(&Sensor { rate_error: error, ..Sensor::default() }, &sine(5.0, 5.0));
            for (k, seen) in seen.iter().enumerate().take(4500).skip(100) {
                let truth = (TAU * 5.0 * (1.0 + error) * k as f64 / 1000.0).sin();
                assert!((seen - truth).abs() < 1e-4, "{seen} for {truth} at {k}");
            }
        }
    }

    #[test]
    fn a_lag_has_the_phase_and_size_of_theory() {
        let time_constant = 0.01;
        let seen = shown(&Sensor { lag: time_constant, ..Sensor::default() }, &sine(10.0, 4.0));
        let omega_t = TAU * 10.0 * time_constant;
        for (k, seen) in seen.iter().enumerate().take(3000).skip(2000) {
            let phase = TAU * 10.0 * k as f64 / 1000.0 - omega_t.atan();
            let truth = phase.sin() / (1.0 + omega_t * omega_t).sqrt();
            assert!((seen - truth).abs() < 1e-3);
        }
    }

    /// A loop as wide as the band twice, whose middle is the signal: behind by the width until it turns.
    #[test]
    fn friction_makes_a_loop() {
        let (signal, width) = (sine(1.0, 4.0), 0.3);
        let seen = dragged(&signal, width);
        let at = |share: f64| seen[(share * RATE) as usize];
        assert!((at(2.0) - signal[40_000] + width).abs() < 1e-9 && (at(2.5) - width).abs() < 1e-3);
        assert!(
            (at(2.25) - 0.7).abs() < 1e-9 && (at(2.3) - 0.7).abs() < 1e-9 && (at(2.75) + 0.7).abs() < 1e-9
        );
        assert_eq!(dragged(&signal, 0.0), signal);
    }

    #[test]
    fn responses_have_the_size_and_phase_of_theory() {
        let (frequency, ratio): (f64, f64) = (10.0, 0.2);
        let ringing =
            shown(&Sensor { resonance: Some((25.0, ratio)), ..Sensor::default() }, &sine(frequency, 4.0));
        let coupled = shown(&Sensor { high_pass: 5.0, ..Sensor::default() }, &sine(frequency, 4.0));
        // 1/(1 - r² + 2 i z r) and i s/(1 + i s).
        let (r, s) = (frequency / 25.0, frequency / 5.0);
        let (real, imaginary) = (1.0 - r * r, 2.0 * ratio * r);
        let omega = TAU * frequency;
        for k in 2000..3000 {
            let t = k as f64 / 1000.0;
            let expected = (omega * t - imaginary.atan2(real)).sin() / real.hypot(imaginary);
            assert!((ringing[k] - expected).abs() < 1e-3, "{} for {expected}", ringing[k]);
            let expected = (omega * t + (1.0 / s).atan()).sin() * s / s.hypot(1.0);
            assert!((coupled[k] - expected).abs() < 1e-3, "{} for {expected}", coupled[k]);
        }
    }

    /// 1100 Hz at a thousand samples a second are 100 Hz.
    #[test]
    fn what_is_too_fast_is_folded() {
        let seen = shown(&Sensor { folded: (0.5, 1100.0), ..Sensor::default() }, &sine(0.0, 4.0));
        for (k, seen) in seen.iter().enumerate() {
            assert!((seen - 0.5 * (TAU * 0.1 * k as f64).sin()).abs() < 1e-9, "{seen} at {k}");
        }
    }

    #[test]
    fn converters_have_steps_and_ends_and_lose_samples() {
        let signal = sine(1.0, 4.0);
        let seen = shown(&Sensor { quantum: 0.25, range: 0.75, ..Sensor::default() }, &signal);
        assert!(seen.iter().all(|x| (x * 4.0).fract() == 0.0 && x.abs() <= 0.75));
        let stuck = shown(&Sensor { dropout: 0.01, ..Sensor::default() }, &signal);
        let repeated = stuck.windows(2).filter(|pair| pair[0] == pair[1]).count();
        assert!((200..2500).contains(&repeated), "{repeated}");
    }
}
