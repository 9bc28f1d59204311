//! Where a signal is missing.

use super::Missing;
use super::innovations::Noise;
use super::likelihood::Sums;

/// Shares of a port's size that are tried as the standard deviation of what is missing there.
const SHARES: [f64; 3] = [0.1, 0.3, 1.0];
/// Shares of every port's size that are tried as what every rig lacks a little of.
const BACKGROUND: [f64; 3] = [3e-3, 1e-2, 3e-2];

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

impl Missing<'_> {
    fn log_likelihood(&self, noise: &Noise) -> f64 {
        let blocks = self.setting.innovations(&self.windows, noise, &[]);
        let sums = Sums::of(blocks.iter());
        let likelihood = sums.map_or(f64::NEG_INFINITY, |it| it.log_likelihood(&self.precisions));
        if likelihood.is_finite() { likelihood } else { f64::NEG_INFINITY }
    }

    /// Compares the likelihoods of a signal missing at each port.
    pub fn located(&self) -> Location {
        let setting = &self.setting;
        let with = |share: f64| {
            let ports = setting.ports.iter().zip(&setting.sizes);
            let ports = ports.enumerate().map(|(number, (port, size))| {
                if port.is_sensor() || setting.ties[number] != number { 0.0 } else { share * size }
            });
            let ports = ports.collect();
            let noise = Noise { ports, outputs: setting.noise.clone() };
            let likelihood = self.log_likelihood(&noise);
            (noise, likelihood)
        };
        let all = BACKGROUND.map(with);
        let best = all.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
        let (background, log_likelihood) = best.expect("shares are tried");
        let places = (0..setting.ports.len()).filter(|port| setting.ties[*port] == *port);
        let tried = places.map(|port| {
            let larger = SHARES.map(|share| share * setting.sizes[port]).into_iter();
            let larger = larger.filter(|it| *it > background.ports[port]);
            let gains = larger.map(|deviation| {
                let mut more = background.clone();
                more.ports[port] = deviation;
                (deviation, self.log_likelihood(&more) - log_likelihood)
            });
            let best = gains.max_by(|a, b| a.1.total_cmp(&b.1));
            let (deviation, gain) = best.unwrap_or((background.ports[port], 0.0));
            Located { port, deviation, gain }
        });
        let mut ranked: Vec<Located> = tried.collect();
        ranked.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        Location { background, log_likelihood, ranked }
    }
}
