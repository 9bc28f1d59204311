//! Fig. 8: a car at 70 km/h on a random road, passive with soft and with hard valves, and active.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use super::STEP;
use super::system::System;

const ACCELERATIONS: [&str; 3] =
    ["car.heave.acceleration", "car.roll.acceleration", "car.pitch.acceleration"];
/// In Hz: the body's mode (3.3), the sensitive middle frequencies and what is above them (5).
const BODY: [f64; 2] = [0.5, 2.0];
const MIDDLE: [f64; 2] = [2.0, 8.0];
const ABOVE: [f64; 2] = [8.0, 30.0];
/// Seconds of a window, and how many there are, each beginning in the middle of the one before.
const WINDOW: f64 = 8.0;
const WINDOWS: usize = 9;

/// What the body does on the road.
struct Ride([Vec<f64>; 3]);

impl Ride {
    fn of(system: &str) -> Self {
        let mut system = System::on_its_road(system, STEP).initialized();
        let samples = (WINDOW / STEP) as usize * (WINDOWS + 1) / 2;
        // The road begins at half a second.
        for _ in 0..(0.5 / STEP) as usize {
            system.advance();
        }
        let mut ride = Self(Default::default());
        for _ in 0..samples {
            system.advance();
            for (name, seen) in ACCELERATIONS.iter().zip(&mut ride.0) {
                seen.push(system.get(name));
            }
        }
        ride
    }

    /// What the power spectral densities have in a band: the mean squares of heave, roll and pitch.
    fn power(&self, [low, high]: [f64; 2]) -> [f64; 3] {
        let length = (WINDOW / STEP) as usize;
        let window: Vec<f64> =
            (0..length).map(|k| 0.5 - 0.5 * (TAU * k as f64 / length as f64).cos()).collect();
        let lines = (low * WINDOW).round() as usize..(high * WINDOW).round() as usize;
        self.0.each_ref().map(|samples| {
            let parts = (0..WINDOWS).map(|i| &samples[i * length / 2..][..length]);
            let powers = parts.map(|part| {
                let windowed: Vec<f64> = part.iter().zip(&window).map(|(a, b)| a * b).collect();
                lines.clone().map(|line| line_power(&windowed, line)).sum::<f64>()
            });
            let gain: f64 = window.iter().map(|factor| factor * factor).sum::<f64>() * length as f64;
            2.0 * powers.sum::<f64>() / (WINDOWS as f64 * gain)
        })
    }
}

/// The squared magnitude of a line of the discrete Fourier transform (Goertzel).
fn line_power(samples: &[f64], line: usize) -> f64 {
    let factor = 2.0 * (TAU * line as f64 / samples.len() as f64).cos();
    let (last, before) =
        samples.iter().fold((0.0, 0.0), |(last, before), sample| (sample + factor * last - before, last));
    last * last + before * before - factor * last * before
}

static SOFT: LazyLock<Ride> = LazyLock::new(|| Ride::of("full-car-passive-soft"));
static HARD: LazyLock<Ride> = LazyLock::new(|| Ride::of("full-car-passive-hard"));
static ACTIVE: LazyLock<Ride> = LazyLock::new(|| Ride::of("full-car-modal-skyhook"));

/// Effective accelerations relative to each other, for heave, roll and pitch.
fn ratios(ride: &Ride, to: &Ride, band: [f64; 2]) -> [f64; 3] {
    let (ride, to) = (ride.power(band), to.power(band));
    std::array::from_fn(|i| (ride[i] / to[i]).sqrt())
}

#[test]
fn the_spectrum_has_the_power_of_the_signal() {
    let samples = |k: usize| {
        let t = k as f64 * STEP;
        // Two lines apart from each other and one outside the band.
        3.0 * (TAU * 1.25 * t).sin() + 2.0 * (TAU * 1.6 * t + 1.0).sin() + 5.0 * (TAU * 4.0 * t).sin()
    };
    let record: Vec<f64> = (0..(WINDOW / STEP) as usize * (WINDOWS + 1) / 2).map(samples).collect();
    let [power, ..] = Ride([record.clone(), record.clone(), record]).power(BODY);
    assert!((power / (0.5 * (9.0 + 4.0)) - 1.0).abs() < 1e-3, "{power}");
}

#[test]
fn hard_valves_calm_the_body_mode_and_are_worse_above_it() {
    for (band, bounds) in [(BODY, 0.5..0.8), (MIDDLE, 1.05..1.5), (ABOVE, 1.1..1.5)] {
        let ratios = ratios(&HARD, &SOFT, band);
        assert!(ratios.iter().all(|ratio| bounds.contains(ratio)), "{band:?}: {ratios:?}");
    }
}

#[test]
fn active_control_is_best_at_low_and_like_soft_valves_at_high_frequencies() {
    for band in [BODY, MIDDLE] {
        for passive in [&SOFT, &HARD] {
            let ratios = ratios(&ACTIVE, passive, band);
            assert!(ratios.iter().all(|ratio| *ratio < 0.6), "{band:?}: {ratios:?}");
        }
    }
    let (active, hard) = (ratios(&ACTIVE, &SOFT, ABOVE), ratios(&HARD, &SOFT, ABOVE));
    for (active, hard) in active.into_iter().zip(hard) {
        // Not further off than a tenth, and nearer to soft than hard valves are.
        assert!(
            (0.9..1.1).contains(&active) && (active - 1.0).abs() < 0.6 * (hard - 1.0).abs(),
            "{active} {hard}"
        );
    }
}
