//! Where a signal is missing.

use super::Missing;
use super::innovations::{Column, Columns, Noise, Stretch};

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

/// Factor of standard deviations from one trial to the next where errors turn out to be larger than believed.
const LARGER: f64 = 2.0;
/// Rise of the log-likelihood that is worth a larger error: a model of one more parameter has it by chance once in a thousand.
const WORTH: f64 = 5.4;

impl Missing<'_> {
    fn log_likelihood(&self, noise: &Noise) -> f64 {
        self.log_likelihood_with(noise, &[])
    }

    /// With columns, one list for each window, that are fitted along.
    fn log_likelihood_with(&self, noise: &Noise, columns: &[Vec<Column>]) -> f64 {
        let own = 0..columns.first().map_or(0, Vec::len);
        let beside = Columns { windows: columns, candidates: std::slice::from_ref(&own) };
        let stretches = self.setting.innovations(&self.windows, noise, beside);
        let sums = Stretch::total(&stretches, |_| true);
        let precisions = self.precisions_beside(own.len());
        let likelihood = sums.map_or(f64::NEG_INFINITY, |it| it.with(0).log_likelihood(&precisions));
        if likelihood.is_finite() { likelihood } else { f64::NEG_INFINITY }
    }

    /// Errors of the sensors and of the plant that are as large as what remains beside the best explanation: sensors that
    /// disagree by more than their noise would otherwise decide what else is missing.
    pub fn refined(&self, noise: &Noise, columns: &[Vec<Column>]) -> Noise {
        // Nothing is larger than a port's signal may be, or than what a sensor shows.
        let setting = &self.setting;
        let larger = |noise: &Noise, row: Option<usize>| {
            let mut more = noise.clone();
            match row {
                Some(row) => {
                    more.outputs[row] =
                        (more.outputs[row] * LARGER * LARGER).min(setting.magnitudes[row].powi(2));
                }
                None => {
                    let ports = more.ports.iter_mut().zip(&setting.sizes);
                    ports.for_each(|(it, size)| *it = (*it * LARGER).min(*size));
                }
            }
            more
        };
        let (mut best, mut likelihood) = (noise.clone(), self.log_likelihood_with(noise, columns));
        for row in std::iter::once(None).chain((0..noise.outputs.len()).map(Some)) {
            loop {
                let more = larger(&best, row);
                let other = self.log_likelihood_with(&more, columns);
                if other <= likelihood + WORTH {
                    break;
                }
                (best, likelihood) = (more, other);
            }
        }
        best
    }

    /// Compares the likelihoods of a signal missing at each port.
    pub fn located(&self) -> Location {
        let setting = &self.setting;
        let with = |share: f64| {
            let noise =
                Noise { ports: setting.shared(share), outputs: setting.noise.clone(), simulated: None };
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
