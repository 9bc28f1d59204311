//! Where a signal is missing.

use super::innovations::Noise;
use super::likelihood::Sums;
use super::trajectory::{Setting, Window};

/// Shares of a port's size that are tried as the standard deviation of what is missing there.
const SHARES: [f64; 5] = [0.03, 0.1, 0.3, 1.0, 3.0];
/// Shares of every port's size that are tried as what every rig lacks a little of.
const BACKGROUND: [f64; 6] = [3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1];

/// How likely it is that a signal is missing at a port.
#[derive(Clone, Debug)]
pub struct Located {
    /// Number of the port.
    pub port: usize,
    /// Standard deviation of the missing signal.
    pub deviation: f64,
    /// Logarithm of the likelihood, beyond that of nothing missing but what every rig lacks.
    pub gain: f64,
}

/// Where a signal is missing, the likeliest first.
#[derive(Clone, Debug)]
pub struct Location {
    /// What every rig lacks a little of, at every port.
    pub background: Noise,
    /// Log-likelihood of nothing more than that.
    pub log_likelihood: f64,
    /// Every port.
    pub ranked: Vec<Located>,
}

impl Setting<'_> {
    fn log_likelihood(&self, windows: &[Window], noise: &Noise, precisions: &[f64]) -> f64 {
        let blocks = self.innovations(windows, noise, &[]);
        let sums = Sums::of(blocks.iter());
        let likelihood = sums.map_or(f64::NEG_INFINITY, |it| it.log_likelihood(precisions));
        if likelihood.is_finite() { likelihood } else { f64::NEG_INFINITY }
    }

    /// Compares the likelihoods of a signal missing at each port.
    pub fn located(&self, windows: &[Window], precisions: &[f64]) -> Location {
        let with = |share: f64| {
            let ports = self.ports.iter().zip(&self.sizes);
            let ports = ports.map(|(port, size)| if port.is_sensor() { 0.0 } else { share * size }).collect();
            let noise = Noise { ports, outputs: self.noise.clone() };
            let likelihood = self.log_likelihood(windows, &noise, precisions);
            (noise, likelihood)
        };
        let all = BACKGROUND.map(with);
        let best = all.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
        let (background, log_likelihood) = best.expect("shares are tried");
        let ranked = self.beyond(windows, precisions, &background, log_likelihood);
        Location { background, log_likelihood, ranked }
    }

    /// The same beyond what is missing already.
    pub fn beyond(&self, windows: &[Window], precisions: &[f64], noise: &Noise, likelihood: f64) -> Vec<Located> {
        let tried = (0..self.ports.len()).map(|port| {
            let deviations = SHARES.map(|share| share * self.sizes[port]);
            let larger = deviations.into_iter().filter(|it| *it > noise.ports[port]);
            let gains = larger.map(|deviation| {
                let mut more = noise.clone();
                more.ports[port] = deviation;
                (deviation, self.log_likelihood(windows, &more, precisions) - likelihood)
            });
            let best = gains.max_by(|a, b| a.1.total_cmp(&b.1));
            let (deviation, gain) = best.unwrap_or((noise.ports[port], 0.0));
            Located { port, deviation, gain }
        });
        let mut ranked: Vec<Located> = tried.collect();
        ranked.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        ranked
    }
}
