//! The error of a clock. Over a record, a signal with a wrong rate loses its phase many times over, and no derivative leads
//! to the right rate. So every rate is compared with the signal's own simulation.

use crate::diagnosis::{root_mean_square, simulated};
use crate::estimation::hypothesis::{Baseline, Fitted, Term};
use crate::estimation::unknowns::{Estimate, Unknown};
use crate::signal::distortion::Fault;

/// Share of a period of the fastest signal by which neighbouring rates may differ at a record's end.
const PHASE: f64 = 0.25;
/// Highest frequency in Hz whose phase counts.
const FASTEST: f64 = 20.0;

impl Baseline<'_> {
    /// A fit's point with the clock error that brings an output's simulation nearest to its signal; none for other terms.
    pub(super) fn by_clock(&self, null: &Fitted, term: Term) -> Option<Estimate> {
        let Term::Fault(handle @ Unknown::Output(output, Fault::Rate)) = term else { return None };
        let row = self.train.first()?.measured.iter().position(|it| it.output == output)?;
        let plain = simulated(self, &null.terms, &null.point, self.train);
        let longest = self.train.iter().map(|it| it.step * it.len() as f64).fold(0.0, f64::max);
        let (low, high) = self.own_coordinates(term).first()?.bounds;
        let step = PHASE / (FASTEST * longest);
        let misses = |rate: f64| {
            let mut point = null.point.clone();
            point.set(handle, rate);
            let errors = self.train.iter().zip(&plain).flat_map(|(record, plain)| {
                let correction = &point.outputs[output];
                let (plain, measured) = (&plain[output], &record.measured[row].values);
                record.sections.iter().flat_map(move |section| {
                    let seen = correction.applied(&plain[section.clone()], record.samples(section));
                    let measured = &measured[section.clone()];
                    seen.into_iter().zip(measured).map(|(seen, measured)| measured - seen).collect::<Vec<_>>()
                })
            });
            (root_mean_square(&errors.collect::<Vec<_>>()), point)
        };
        let count = ((high - low) / step).ceil() as usize;
        let tried = (0..=count).map(|number| misses((low + step * number as f64).min(high)));
        tried.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, point)| point)
    }
}
