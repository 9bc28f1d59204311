//! The error of a clock: over a record, a signal that is a little too slow loses its phase many times over, so that no
//! derivative shows the way to the right rate. Its own simulation tells it: every rate is tried.

use crate::diagnosis::{root_mean_square, simulated};
use crate::estimation::fit::{Handle, Point};
use crate::estimation::hypothesis::{Fitted, Term, World};
use crate::signal::distortion::Fault;

/// Share of a period of the fastest signal by which neighbouring rates may differ at a record's end.
const PHASE: f64 = 0.25;
/// Highest frequency in Hz by which a phase is told.
const FASTEST: f64 = 20.0;

impl World<'_> {
    /// The point of a fit with the error of an output's clock with which its own simulation meets the signal best; none of
    /// another term.
    pub(super) fn by_clock(&self, null: &Fitted, term: Term) -> Option<Point> {
        let Term::Fault(handle @ Handle::Output(output, Fault::Rate)) = term else { return None };
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
