//! The common scale of masses, stiffnesses and dampings.
//!
//! Where no force is recorded, another unit of mass changes no record: all parameters with a dimension of mass have a common factor that
//! nothing tells (E. Buckingham, On physically similar systems, Physical Review 4 (1914)). One of them keeps its value then, and the
//! others, and the forces of all effects, are relative to it.

use std::cmp::Reverse;

use nalgebra::DVector;
use strut_model::unit;

use crate::estimation::coordinates::TOLERANCE;
use crate::estimation::hypothesis::{Baseline, Fitted};
use crate::estimation::unknowns::{Estimate, FreeParameter, Prior, Unknown};
use crate::screening::rms;

/// Standard deviation of a parameter that keeps its value, over that.
const KEPT: f64 = 1e-6;

impl Baseline<'_> {
    /// Nominal parameters with a dimension of mass, by their indices, with its exponent.
    fn with_mass(&self) -> impl Iterator<Item = (usize, i32)> {
        let exponent = |index: usize| i32::from(self.rig.plant.parameters[index].unit.base.kg);
        let all = self.rig.base().into_iter().map(move |index| (index, exponent(index)));
        all.filter(|(_, exponent)| *exponent != 0)
    }

    /// Those that the parameter set has: a value of zero is one at any scale.
    fn scaled(&self) -> Vec<(usize, i32)> {
        self.with_mass().filter(|(index, _)| self.rig.parameters[*index] != 0.0).collect()
    }

    /// Whether a parameter keeps its value, so that others are relative to it.
    pub fn is_yardstick(&self, handle: Unknown) -> bool {
        self.yardstick.is_some_and(|it| handle == Unknown::Parameter(it))
    }

    /// Whether a nominal parameter has the scale of the one that keeps its value.
    pub fn is_scaled(&self, handle: Unknown) -> bool {
        let scaled = || self.scaled().into_iter().map(|(index, _)| Unknown::Parameter(index));
        self.yardstick.is_some() && scaled().any(|it| it == handle)
    }

    /// Variance of a parameter's value by the unknown scale: each nominal parameter is as good an estimate of the scale as its data
    /// sheet is.
    pub(crate) fn variance_of_scale(&self, handle: Unknown, value: f64) -> f64 {
        let (Unknown::Parameter(index), Some(_)) = (handle, self.yardstick) else { return 0.0 };
        let estimates = self.scaled().len() as f64;
        let exponent = f64::from(self.rig.plant.parameters[index].unit.base.kg);
        (TOLERANCE * exponent * value).powi(2) / estimates
    }

    /// Lets a mass keep its value where no force was recorded, and the constants of the model determine the common scale less well than a
    /// data sheet does. Gives the fit's point at that scale; none where the scale is known.
    pub(crate) fn hold_scale(&mut self, fitted: &Fitted) -> Option<Estimate> {
        let scaled = self.scaled();
        let is_known = |(index, _): &(usize, i32)| self.known.iter().any(|(known, _, _)| known == index);
        let is_determined = || self.information(fitted) * TOLERANCE.powi(2) >= 1.0;
        if scaled.iter().any(is_known) || self.records_a_force() || is_determined() {
            return None;
        }
        let is_mass = |index: usize| self.rig.plant.parameters[index].unit.base == unit::KG.base;
        let (held, exponent) = *scaled
            .iter()
            .max_by_key(|(index, _)| (self.rig.stated[*index], is_mass(*index), Reverse(*index)))?;
        let value = self.rig.parameters[held];
        let factor = (value / fitted.point.parameters[held]).powf(f64::from(exponent).recip());
        if !(factor.is_finite() && factor > 0.0) {
            return None;
        }
        let mut point = fitted.point.clone();
        let sheet_factor = (value / self.sheet[held]).powf(f64::from(exponent).recip());
        // A stiffness that the parameter set lacks and the fit has is at the same scale.
        for (index, exponent) in self.with_mass().collect::<Vec<_>>() {
            point.parameters[index] *= factor.powi(exponent);
            self.sheet[index] *= sheet_factor.powi(exponent);
        }
        self.known.push((held, value, KEPT * value.abs()));
        self.yardstick = Some(held);
        Some(point)
    }

    /// Whether a signal with a dimension of mass was recorded, and moves.
    fn records_a_force(&self) -> bool {
        let plant = &self.rig.plant;
        self.train.iter().any(|record| {
            let outputs = record.measured.iter().map(|it| (&plant.outputs[it.output], &it.values[..]));
            let inputs = plant.inputs.iter().zip(&record.inputs);
            let inputs = inputs.filter_map(|(declared, source)| Some((declared, source.measured()?)));
            outputs.chain(inputs).any(|(declared, values)| declared.unit.base.kg != 0 && rms(values) > 0.0)
        })
    }

    /// Information of the data on the logarithm of the common scale: the inverse of its variance.
    fn information(&self, fitted: &Fitted) -> f64 {
        let scaled: Vec<(usize, i32)> = self.with_mass().collect();
        let slope = |coordinate: &FreeParameter| {
            let own = scaled.iter().find(|(index, _)| coordinate.handle == Unknown::Parameter(*index));
            own.map_or(0.0, |(_, exponent)| f64::from(*exponent) * fitted.point.get(coordinate.handle))
        };
        let direction =
            DVector::from_iterator(fitted.coordinates.len(), fitted.coordinates.iter().map(slope));
        let all = (&fitted.linear.r * &direction).norm_squared();
        let before = fitted.coordinates.iter().zip(direction.iter());
        let before = before.filter_map(|(it, step)| Some((it.distance(&fitted.point)?.1 * step).powi(2)));
        let independent: f64 = self.errors(&fitted.train).effective_counts().iter().sum();
        let samples: usize = self.train.iter().map(|it| it.len() * it.measured.len()).sum();
        (all - before.sum::<f64>()) * independent / samples.max(1) as f64
    }

    /// A coordinate as it would be if it were not kept at its value for the others' sake.
    pub(crate) fn released(&self, coordinate: &FreeParameter) -> FreeParameter {
        match coordinate.handle {
            Unknown::Parameter(index) if self.yardstick == Some(index) => {
                let prior = Prior::Factor { mean: self.rig.parameters[index], deviation: TOLERANCE };
                FreeParameter { prior: Some(prior), bounds: (0.0, f64::INFINITY), ..*coordinate }
            }
            _ => *coordinate,
        }
    }
}
