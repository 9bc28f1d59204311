//! What each excitation on its own says of the coordinates of a fit.

use std::ops::Range;

use nalgebra::DVector;
use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::dataset::recorded::Dataset;
use crate::decision::disagreement::{Wish, wish};
use crate::estimation::hypothesis::{Baseline, Fitted};
use crate::estimation::lsq::{Linear, Problem};
use crate::estimation::unknowns::Estimate;

use super::NORMAL;

/// Excitations that are compared at least: fewer records are cut in pieces.
const EXCITATIONS: usize = 4;

/// A fit linearised on one excitation.
pub(super) struct Excitation {
    linear: Linear,
    /// Gradient over each block of time.
    scores: Vec<DVector<f64>>,
    /// Power of the errors.
    power: f64,
    /// Whether it is estimation data.
    estimation: bool,
    /// The record's number, estimation records first.
    record: usize,
}

impl Excitation {
    /// What it says of each coordinate on its own; with one held where it is, nothing of that one.
    fn opinions(&self, held: Option<usize>) -> Vec<Opinion> {
        let (linear, scores) = match held {
            None => (self.linear.clone(), self.scores.clone()),
            Some(held) => (
                self.linear.without(held),
                self.scores.iter().map(|score| score.clone().remove_row(held)).collect(),
            ),
        };
        let (shift, covariance) = (linear.minimiser(), linear.robust_covariance(&scores));
        let gain = linear.q.norm_squared();
        let of = |shift: f64, variance: f64| Opinion {
            shift,
            variance,
            gain,
            power: self.power,
            estimation: self.estimation,
            record: self.record,
        };
        let mut all: Vec<Opinion> =
            (0..shift.len()).map(|index| of(shift[index], covariance[(index, index)])).collect();
        if let Some(held) = held {
            all.insert(held, of(0.0, f64::INFINITY));
        }
        all
    }
}

/// What an excitation on its own says of a coordinate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Opinion {
    /// Change from the fitted value.
    shift: f64,
    /// Its variance.
    variance: f64,
    /// What the power of the excitation's errors loses where all coordinates are what it says.
    gain: f64,
    /// That power.
    power: f64,
    /// Whether it is estimation data.
    estimation: bool,
    /// The record's number, estimation records first.
    record: usize,
}

impl Baseline<'_> {
    /// The fit on each excitation alone: its Gauss–Newton step is what that one says.
    pub(super) fn excitations(&self, fitted: &Fitted) -> Result<Vec<Excitation>, String> {
        let dynamics = self.dynamics(&fitted.terms)?;
        let coordinates: Vec<_> = fitted.coordinates.iter().map(|it| self.released(it)).collect();
        let of = |record: &Dataset, estimation: bool, number: usize| {
            let records = std::slice::from_ref(record);
            let starts = self.starts(records);
            let fit = self.fit(&*dynamics, records, coordinates.clone());
            let point = fit.settled(Estimate { starts, ..fitted.point.clone() });
            let (linear, trace) = fit.linearise(&point);
            let power = 2.0 * fit.cost(&point);
            Excitation { linear, scores: trace.scores, power, estimation, record: number }
        };
        let pieces = EXCITATIONS.div_ceil(self.train.len() + self.test.len());
        let all = self.train.iter().map(|it| (it, true)).chain(self.test.iter().map(|it| (it, false)));
        let cut = all.enumerate().flat_map(|(number, (record, estimation))| {
            cut(record, pieces)
                .into_iter()
                .map(move |sections| (Dataset { sections, ..record.clone() }, estimation, number))
        });
        Ok(cut.map(|(record, estimation, number)| of(&record, estimation, number)).collect())
    }
}

/// What each excitation says of each coordinate, with one held where it is.
pub(super) fn opinions(excitations: &[Excitation], held: Option<usize>) -> Vec<Vec<Opinion>> {
    excitations.iter().map(|it| it.opinions(held)).collect()
}

/// What each record would choose for a coordinate of this value, by what its pieces say.
pub(super) fn wishes(value: f64, all: &[Opinion]) -> Vec<Wish> {
    let records = 0..all.iter().map(|it| it.record + 1).max().unwrap_or(0);
    let of = |record: usize| {
        let own = all.iter().filter(|it| it.record == record);
        let (gain, power) = own.clone().fold((0.0, 0.0), |sum, it| (sum.0 + it.gain, sum.1 + it.power));
        let pieces: Vec<(f64, f64)> = own.map(|it| (value + it.shift, it.variance)).collect();
        wish(record, &pieces, gain / power)
    };
    records.filter_map(of).collect()
}

/// A record's sections, cut into this number of pieces.
fn cut(record: &Dataset, pieces: usize) -> Vec<Vec<Range<usize>>> {
    if pieces < 2 {
        return vec![record.sections.clone()];
    }
    let length = record.len().div_ceil(pieces).max(1);
    let piece = |number: usize| -> Vec<Range<usize>> {
        let (start, end) = (number * length, (number + 1) * length);
        let part = |it: &Range<usize>| it.start.max(start)..it.end.min(end);
        // What is shorter than a block says nothing on its own.
        record.sections.iter().map(part).filter(|it| it.len() > record.block()).collect()
    };
    (0..pieces).map(piece).filter(|sections| !sections.is_empty()).collect()
}

/// The variance that differences between excitations bring to estimates from some of them, and the quantile of
/// Student's distribution that belongs to it. `own` is the variance of all of these together. Where it is much smaller than that of
/// what each says alone, only their contrast determines the coordinate, as strokes in both directions distinguish friction from a load: then it
/// follows what they say alone by as much less.
pub(super) fn between(opinions: &[Opinion], own: f64) -> (f64, f64) {
    // A piece of one block has no variance, and a coordinate that does nothing in it an infinite one.
    let told = |it: &&Opinion| it.shift.is_finite() && it.variance.is_finite() && it.variance > 0.0;
    let known: Vec<&Opinion> = opinions.iter().filter(told).collect();
    let freedom = known.len() as f64 - 1.0;
    let sum = |of: &dyn Fn(&Opinion) -> f64| known.iter().map(|it| of(it)).sum::<f64>();
    let weight = |it: &Opinion| 1.0 / it.variance;
    let (first, second) = (sum(&weight), sum(&|it| weight(it).powi(2)));
    let weights = |power: i32| sum(&|it| if it.estimation { weight(it).powi(power) } else { 0.0 });
    if freedom < 1.0 || weights(1) == 0.0 {
        return (0.0, 0.0);
    }
    let spread = first - second / first;
    let mean = sum(&|it| weight(it) * it.shift) / first;
    let excess = sum(&|it| weight(it) * (it.shift - mean).powi(2)) - freedom;
    let each = (excess / spread).max(0.0);
    let share = weights(2) / weights(1).powi(2);
    let alone = (own * weights(1)).clamp(0.0, 1.0);
    let quantile = StudentsT::new(0.0, 1.0, freedom).map_or(NORMAL, |it| it.inverse_cdf(0.975));
    (each * share * alone.powi(2), quantile)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::recorded::Measured;

    fn shifted(shifts: &[f64], variance: f64) -> Vec<Opinion> {
        let of = |(index, shift): (usize, &f64)| Opinion {
            shift: *shift,
            variance,
            gain: 0.0,
            power: 1.0,
            estimation: index < 2,
            record: index,
        };
        shifts.iter().enumerate().map(of).collect()
    }

    /// With equal weights the estimator is the sample variance less the variance within, and half of it is left of two
    /// records of the estimation data.
    #[test]
    fn equal_opinions_leave_the_sample_variance_less_that_within() {
        let (between, quantile) = between(&shifted(&[1.0, -1.0, 3.0, -3.0], 0.5), 0.25);
        assert!((between - 0.5 * (20.0 / 3.0 - 0.5)).abs() < 1e-12, "{between}");
        // Student's distribution with three degrees of freedom.
        assert!((quantile - 3.182).abs() < 1e-3, "{quantile}");
    }

    /// A tenth of the standard deviation of what the two records of the estimation data say alone.
    #[test]
    fn what_only_a_contrast_of_records_tells_hardly_follows_what_each_says() {
        let all = shifted(&[1.0, -1.0, 3.0, -3.0], 0.5);
        let (alone, contrast) = (between(&all, 0.25).0, between(&all, 2.5e-3).0);
        assert!((contrast / alone - 1e-4).abs() < 1e-12, "{contrast} {alone}");
    }

    #[test]
    fn opinions_that_differ_by_less_than_their_variance_widen_nothing() {
        assert_eq!(between(&shifted(&[0.1, -0.1, 0.2, -0.2], 1.0), 0.5).0, 0.0);
    }

    #[test]
    fn what_no_variance_is_known_of_does_not_count() {
        let all = shifted(&[1.0, -1.0, 3.0, -3.0], 0.5);
        let unknown = [f64::INFINITY, 0.0].map(|variance| Opinion {
            shift: 7.0,
            variance,
            gain: 0.0,
            power: 1.0,
            estimation: true,
            record: 0,
        });
        assert_eq!(between(&[all.clone(), unknown.to_vec()].concat(), 0.25), between(&all, 0.25));
        assert_eq!(between(&[all[..1].to_vec(), unknown.to_vec()].concat(), 0.5), (0.0, 0.0));
    }

    #[test]
    fn a_record_is_cut_where_it_may_be() {
        let sections = vec![0..700, 750..1000];
        let record = Dataset { step: 1e-3, sections, ..Dataset::default() };
        assert_eq!(cut(&record, 1).concat(), record.sections);
        let measured = vec![Measured { output: 0, values: vec![0.0; 2000], noise_floor: 1.0 }];
        let long = Dataset { measured, sections: vec![0..1400, 1450..2000], ..record };
        // Of the first section's second half, 400 samples are less than a block.
        let pieces = cut(&long, 2);
        assert_eq!((pieces.len(), pieces.concat()), (2, vec![0..1000, 1450..2000]));
    }
}
