//! Functions of samples: spectra, filters, what a sensor does to a signal.
//!
//! ```
//! // A position that grows by 2 mm each millisecond.
//! let rates = strut_signal::derivative(&[0.0, 0.002, 0.004], 1e-3);
//! assert!(rates.iter().all(|rate| (rate - 2.0).abs() < 1e-9));
//! ```

pub mod distortion;
pub mod random;
pub mod spectral;

/// What an evenly sampled rate adds up to, from zero on, by the trapezoidal rule.
pub fn integral(rate: &[f64], step: f64) -> Vec<f64> {
    let mut sum = 0.0;
    let added = rate.windows(2).map(|pair| {
        sum += 0.5 * step * (pair[0] + pair[1]);
        sum
    });
    rate.first().map(|_| 0.0).into_iter().chain(added).collect()
}

/// The derivative of an evenly sampled signal by central differences.
pub fn derivative(signal: &[f64], step: f64) -> Vec<f64> {
    let last = signal.len().saturating_sub(1);
    (0..signal.len())
        .map(|k| {
            let (before, after) = (k.saturating_sub(1), (k + 1).min(last));
            (signal[after] - signal[before]) / (step * (after - before).max(1) as f64)
        })
        .collect()
}
