//! Nominal parameters on which records disagree.

use crate::decision::disagreement::{Wish, disagreement};
use crate::diagnosis::Diagnosis;
use crate::estimation::unknowns::Unknown;
use crate::report::findings::{Disagreement, RecordValue};

/// Quantile of the normal distribution for 95 % within.
const NORMAL: f64 = 1.96;

impl Diagnosis<'_> {
    /// Nominal parameters on which records disagree, with the final model, the clearest first.
    pub(super) fn disagreements(&self) -> Vec<Disagreement> {
        let (baseline, base) = (&self.baseline, self.baseline.rig.base());
        let names: Vec<&str> =
            baseline.train.iter().chain(baseline.test).map(|it| it.name.as_str()).collect();
        let wanted = |it: Wish| RecordValue {
            record: names[it.record].into(),
            value: it.value,
            low: it.value - NORMAL * it.deviation,
            high: it.value + NORMAL * it.deviation,
        };
        let mut list = Vec::new();
        for interval in &self.intervals {
            if let Unknown::Parameter(index) = interval.handle
                && base.contains(&index)
                // How sharply friction turns over is the regularisation's, not the rig's.
                && baseline.sought(index).is_none()
                && let Some((low, high)) = disagreement(&interval.wishes, interval.value)
            {
                let declared = &baseline.rig.plant.parameters[index];
                let (name, unit) = (declared.name.clone(), declared.unit.symbol.into());
                let apart = (high.value - low.value) / low.deviation.hypot(high.deviation);
                let yardstick = interval.yardstick.and_then(|it| match it {
                    Unknown::Parameter(index) => Some(baseline.rig.plant.parameters[index].name.clone()),
                    Unknown::Input(..) | Unknown::Output(..) => None,
                });
                let records = [wanted(low), wanted(high)];
                list.push((apart, Disagreement { name, unit, yardstick, records }));
            }
        }
        list.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        list.into_iter().map(|(_, it)| it).collect()
    }
}
