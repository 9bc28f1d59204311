//! Random numbers that are the same at every run.

use std::f64::consts::TAU;

/// Values with white noise of a standard deviation, the same for each seed.
pub fn with_noise(values: &[f64], deviation: f64, seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    values.iter().map(|value| value + deviation * random.normal()).collect()
}

/// White noise of unit variance, the same for each seed.
pub fn white(seed: u64, count: usize) -> Vec<f64> {
    with_noise(&vec![0.0; count], 1.0, seed)
}

/// A signal with unit rms and frequencies up to a twentieth of the sampling rate.
pub fn multisine(seed: u64, count: usize) -> Vec<f64> {
    let phases = white(seed.wrapping_add(77), 25);
    let wave =
        |i: usize, (k, phase): (usize, &f64)| (TAU * ((k + 1) as f64 * 0.002 * i as f64 + phase)).sin();
    (0..count).map(|i| phases.iter().enumerate().map(|p| wave(i, p)).sum::<f64>() / 12.5_f64.sqrt()).collect()
}

/// Marsaglia's xorshift.
pub struct Random(u64);

impl Random {
    /// A sequence of its own for each seed.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9) | 1)
    }

    /// Evenly from 0 to 1.
    pub fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Normal, of unit variance.
    pub fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().max(1e-300).ln()).sqrt() * (TAU * self.uniform()).cos()
    }
}
