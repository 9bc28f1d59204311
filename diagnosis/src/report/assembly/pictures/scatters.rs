//! What the error depends on: its mean over bins of a variable.

use crate::catalogue::Element;
use crate::diagnosis::{Diagnosis, simulated};
use crate::report::findings::Binned;
use crate::rig::Missing;
use crate::signal::derivative;

/// Bins of a variable.
const BINS: usize = 24;
/// Samples that a bin needs.
const ENOUGH: usize = 10;

impl Diagnosis<'_> {
    /// The force that the fitted model misses, over the motions of the elements that may lack it.
    pub(super) fn scatters(&self) -> Vec<Binned> {
        let base = &self.found.base;
        let all = simulated(&self.baseline, &base.terms, &base.point, self.baseline.train);
        let kind = &self.baseline.rig.kind;
        let pairs = kind.missing.iter().flat_map(|missing| missing.over.iter().map(move |it| (missing, *it)));
        pairs
            .flat_map(|(missing, element)| {
                [false, true].map(|velocity| self.binned(missing, element, velocity, &all))
            })
            .flatten()
            .collect()
    }

    fn binned(
        &self,
        missing: &Missing,
        element: Element,
        over_velocity: bool,
        outputs: &[Vec<Vec<f64>>],
    ) -> Option<Binned> {
        let plant = &self.baseline.rig.plant;
        let signals = self.baseline.rig.kind.elements.iter().find(|it| it.element == element)?;
        let (output, position) = (plant.output(&missing.output)?, plant.output(&signals.deflection)?);
        let sign = if missing.negative { -1.0 } else { 1.0 };
        let factor = match &missing.times {
            Some(name) => sign * self.found.base.point.parameters[plant.parameter(name)?],
            None => sign,
        };
        // Variable, its rate, force.
        let mut points: Vec<(f64, f64, f64)> = Vec::new();
        for ((record, residuals), outputs) in
            self.baseline.train.iter().zip(&self.found.base.train).zip(outputs)
        {
            let row = record.measured.iter().position(|it| it.output == output)?;
            let x = &signals.deflected(&outputs[position]);
            let v = derivative(x, record.step);
            let (variable, rate) =
                if over_velocity { (v.clone(), derivative(&v, record.step)) } else { (x.clone(), v) };
            let known = residuals[row].iter().zip(variable).zip(rate).filter(|((e, _), _)| e.is_finite());
            points.extend(known.map(|((e, x), rate)| (x, rate, factor * e)));
        }
        let reach = points.iter().map(|(x, _, _)| x.abs()).fold(0.0, f64::max);
        if reach == 0.0 {
            return None;
        }
        let of = |rising: bool| -> Vec<Vec<f64>> {
            let mut bins = vec![Vec::new(); BINS];
            for (x, rate, force) in &points {
                if (*rate > 0.0) == rising {
                    let bin = ((x / reach + 1.0) * 0.5 * BINS as f64) as usize;
                    bins[bin.min(BINS - 1)].push(*force);
                }
            }
            bins
        };
        let (rising, falling) = (of(true), of(false));
        let mean = |bin: &Vec<f64>| (bin.len() >= ENOUGH).then(|| bin.iter().sum::<f64>() / bin.len() as f64);
        let two_sigma = rising.iter().zip(&falling).map(|(rising, falling)| {
            let n = rising.len().max(falling.len());
            let larger = if rising.len() >= falling.len() { rising } else { falling };
            let middle = mean(larger)?;
            let variance = larger.iter().map(|it| (it - middle).powi(2)).sum::<f64>() / n as f64;
            Some(2.0 * (variance / n as f64).sqrt())
        });
        Some(Binned {
            quantity: missing.quantity.clone(),
            unit: if signals.turns(plant) { "N.m" } else { "N" }.into(),
            variable: format!("{} {}", element.name(), if over_velocity { "velocity" } else { "deflection" }),
            variable_unit: match over_velocity {
                true => plant.outputs[position].unit.per_second().symbol.into_owned(),
                false => plant.outputs[position].unit.symbol.into(),
            },
            x: (0..BINS).map(|bin| reach * (2.0 * (bin as f64 + 0.5) / BINS as f64 - 1.0)).collect(),
            two_sigma: two_sigma.collect(),
            rising: rising.iter().map(mean).collect(),
            falling: falling.iter().map(mean).collect(),
        })
    }
}
