//! Candidates in a simulation, where errors add up, and not from sample to sample.

use crate::missing::Missing;
use crate::missing::innovations::Noise;
use crate::missing::likelihood::Sums;

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
        let blocks = missing.setting.innovations(&missing.windows, &noise, &columns);
        let sums = Sums::of(blocks.iter().filter(|block| block.record < missing.train))?;
        let own = missing.nuisances();
        let all: Vec<usize> = (1..=own.len() + self.candidates.list[candidate].columns.len()).collect();
        let mut precisions = missing.precisions.clone();
        precisions.resize(all.len(), 0.0);
        let before = sums.fitted(&own, &missing.precisions)?.left;
        let after = sums.fitted(&all, &precisions)?.left;
        (before > 0.0).then(|| 1.0 - after / before)
    }
}
