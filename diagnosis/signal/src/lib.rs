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
