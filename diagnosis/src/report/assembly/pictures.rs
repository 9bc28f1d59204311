//! What the report's pictures show.

mod frequency;
mod marks;
mod parity;
mod scatters;

use strut_model::Declaration;

use crate::dataset::recorded::{Dataset, Measured};
use crate::diagnosis::Diagnosis;
use crate::report::findings::{Pictures, Trace};
use crate::signal::spectral::KEPT;

/// Seconds of a record that are shown.
const SHOWN: f64 = 10.0;

/// A signal of the first validation record, and the errors of the fitted and of the extended model there.
struct Erring<'a> {
    record: &'a Dataset,
    measured: &'a Measured,
    declared: &'a Declaration,
    before: &'a [f64],
    after: &'a [f64],
    /// Highest frequency in hertz that thinning has kept.
    top: f64,
}

impl Diagnosis<'_> {
    pub(super) fn pictures(&self) -> Pictures {
        let errors = self.errors();
        Pictures {
            traces: self.traces(&errors),
            spectra: errors.iter().map(Erring::spectrum).collect(),
            coherences: errors.iter().flat_map(|it| self.coherences(it)).collect(),
            periodograms: errors.iter().map(Erring::periodogram).collect(),
            scatters: self.scatters(),
            parity: self.parity(),
        }
    }

    fn errors(&self) -> Vec<Erring<'_>> {
        let Some(record) = self.baseline.test.first() else { return Vec::new() };
        let (base, extended) = (&self.found.base.test[0], &self.found.extended.test[0]);
        let thinned = self.measured.first().is_some_and(|it| record.step > 1.5 * it.step);
        let top = 0.5 * if thinned { KEPT } else { 1.0 } / record.step;
        let rows = record.measured.iter().zip(base.iter().zip(extended));
        rows.map(|(measured, (before, after))| Erring {
            record,
            measured,
            declared: &self.baseline.rig.plant.outputs[measured.output],
            before,
            after,
            top,
        })
        .collect()
    }

    fn traces(&self, errors: &[Erring<'_>]) -> Vec<Trace> {
        let active = self.active();
        let trace = |it: &Erring<'_>| {
            let (values, step) = (&it.measured.values, it.record.step);
            let shown = shown(it.record);
            let simulated = |residuals: &[f64]| -> Vec<f64> {
                values.iter().zip(residuals).take(shown).map(|(value, residual)| value - residual).collect()
            };
            let mut marks = marks::largest(&it.after[..shown], it.record);
            marks.extend(active.clone());
            Trace {
                signal: it.declared.name.clone(),
                unit: it.declared.unit.symbol.into(),
                time: (0..shown).map(|k| k as f64 * step).collect(),
                measured: values[..shown].to_vec(),
                before: simulated(it.before),
                after: simulated(it.after),
                marks,
            }
        };
        errors.iter().map(trace).collect()
    }
}

/// Number of samples that are shown.
fn shown(record: &Dataset) -> usize {
    record.len().min((SHOWN / record.step) as usize)
}
