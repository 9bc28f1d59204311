//! What a candidate would do in a simulation, and not from sample to sample.

use crate::missing::Missing;
use crate::missing::innovations::{Column, Noise};
use crate::missing::likelihood::Sums;

use super::selection::Compared;

impl Compared {
    /// Share of the squared errors of a simulation of the estimation records that would go with a candidate, all signals in shares
    /// of their `magnitudes`: what explains most of each sample's surprise may add up to little, and the other way round.
    /// Simulations are of a `length` in seconds, about the trajectory. None if nothing can be told apart.
    pub fn reduction(
        &self,
        candidate: usize,
        missing: &Missing<'_>,
        magnitudes: &[f64],
        length: f64,
    ) -> Option<f64> {
        let range = self.candidates.list[candidate].columns.clone();
        let columns: Vec<Vec<Column>> =
            self.candidates.columns.iter().map(|all| all[range.clone()].to_vec()).collect();
        let noise = Noise {
            ports: vec![0.0; missing.setting.ports.len()],
            outputs: magnitudes.iter().map(|it| it * it).collect(),
            simulated: Some(length),
        };
        let blocks = missing.setting.innovations(&missing.windows, &noise, &columns);
        let sums = Sums::of(blocks.iter().filter(|block| block.record < missing.train))?;
        let own = missing.nuisances();
        let all: Vec<usize> = (1..=own.len() + range.len()).collect();
        let mut precisions = missing.precisions.clone();
        precisions.resize(all.len(), 0.0);
        let before = sums.fitted(&own, &missing.precisions)?.left;
        let after = sums.fitted(&all, &precisions)?.left;
        (before > 0.0).then(|| 1.0 - after / before)
    }
}
