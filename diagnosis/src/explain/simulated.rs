//! Candidates in a simulation, where errors add up, and not from sample to sample.

use crate::missing::Missing;
use crate::missing::innovations::{Columns, Noise, Stretch};

use super::selection::Compared;

impl Compared {
    /// Share by which a candidate reduces the squared errors of a simulation of the estimation records. Signals count in shares of
    /// their `magnitudes`. Simulations take `length` seconds each, about the trajectory. A candidate that explains most of each
    /// sample's innovation may reduce little, and the other way round. None if the candidate cannot be told from a nuisance.
    pub fn reduction(
        &self,
        candidate: usize,
        missing: &Missing<'_>,
        magnitudes: &[f64],
        length: f64,
    ) -> Option<f64> {
        let columns = self.candidates.of(candidate);
        let noise = Noise {
            ports: vec![0.0; missing.setting.ports.len()],
            outputs: magnitudes.iter().map(|it| it * it).collect(),
            simulated: Some(length),
        };
        let own = 0..self.candidates.list[candidate].columns.len();
        let beside = Columns { windows: &columns, candidates: std::slice::from_ref(&own) };
        let stretches = missing.setting.innovations(&missing.windows, &noise, beside);
        let normal = Stretch::total(&stretches, |record| record < missing.train)?.with(0);
        let before = normal.fitted(&missing.precisions)?.left;
        let after = normal.fitted(&missing.precisions_beside(own.len()))?.left;
        (before > 0.0).then(|| 1.0 - after / before)
    }
}
