//! Whether a motion is measured so well that a model may be compared inversely: motion given, force compared.
//!
//! Simulated forward, a drive with much friction and little mass amplifies every error of the force; where nothing holds
//! it, it drifts away. A car on a road that nobody measured cannot be simulated forward at all. The inverse needs neither. But it
//! differentiates the position, a drive's twice, and the position's noise becomes noise of the force: times the mass and the
//! frequency squared, or times the damping and the frequency. So force and motion are compared in the
//! band in which that noise does not count, behind one filter without phase (the decimation of M. Gautier, Dynamic
//! identification of robots with power model, IEEE ICRA 1997).

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use strut_model::Declaration;

use super::recorded::{Dataset, SHORT, Source};
use crate::data::check::DataProblem;
use crate::report::words::digits;
use crate::rig::{Inverse, Rig};
use crate::screening::rms;
use crate::signal::distortion::Correction;
use crate::signal::spectral::{Complex, about_line, filled};

/// Lowest end of a band in Hz: at its sampling rate, a block of errors has ten samples.
pub(crate) const LOWEST: f64 = 8.0;
/// Share of the force's power above which nothing is compared: it is 3 % of the force, and would decide about all that is slow.
const NEGLIGIBLE: f64 = 1e-3;
/// Share of the force's power that has to lie in the band.
const COVERED: f64 = 0.9;
/// Share of the force's power that the position's noise may make up.
const NOISY: f64 = 0.01;
/// Ratio of a band's end to that of the next wider one that is tried.
const NARROWER: f64 = 0.8;
/// Share of its magnitude below which a velocity is none …
const STILL: f64 = 0.02;
/// … if it lasts so long, in seconds: a reversal does not.
const REST: f64 = 0.1;

/// Records in the band in which their motion is known.
#[derive(Clone, Debug)]
pub struct Banded {
    /// The records: every signal behind the same filter without phase, and thinned.
    pub records: Vec<Dataset>,
    /// The band's end in Hz.
    pub top: f64,
    /// What the user has to know of it.
    pub note: DataProblem,
}

/// The records in the widest band in which the position's noise makes up little of the force, if most of the force is in it.
///
/// How much of the force a noise makes, the balance of the narrowest band tells: noise of an acceleration looks like no mass at
/// all, and a mass that is lost in it would make none of the force. Where a balance leaves more of the force than in a narrower
/// band, what is fast in the motion is noise, whatever its spectrum.
pub fn banded(rig: &Rig, records: &[Dataset], inverse: &Inverse) -> Option<Banded> {
    let signals = Signals::of(rig, inverse)?;
    // One band for all: in a wider one, what is fast would decide.
    let ends = records.iter().map(|record| Some(relevant(record, signals.force(record)?)));
    let end = ends.collect::<Option<Vec<f64>>>()?.into_iter().reduce(f64::min)?.max(LOWEST);
    let mut widest = None;
    let mut narrowest: Option<(DVector<f64>, f64)> = None;
    for top in bands(end) {
        let banded: Vec<Dataset> = records.iter().map(|it| below(it, top)).collect();
        let covered = |(record, banded): (&Dataset, &Dataset)| {
            Some(power(signals.force(banded)?) >= COVERED * power(signals.force(record)?))
        };
        if !records.iter().zip(&banded).all(|pair| covered(pair).unwrap_or(false)) {
            continue;
        }
        let left = signals.left_of(&banded)?;
        let (balance, least) = match &narrowest {
            Some(known) => known,
            None => narrowest.insert((signals.balance(&banded)?, left)),
        };
        let quiet = banded.iter().all(|it| signals.noise(it, balance).is_some_and(|it| it < NOISY));
        if !quiet || left > least + NOISY {
            break;
        }
        widest = Some(top);
    }
    // Over a single stroke, no simulation goes astray, and none needs derivatives.
    let top = widest.filter(|_| longest(records) > SHORT)?;
    let text = format!(
        "{} drives the model, and this is compared (inverse dynamics), up to {} Hz: above, noise of the motion dominates, or \
         this has less than {} % of its power. Samples at rest and at the ends of a segment are left out",
        inverse.position,
        digits(top, 2),
        100.0 * NEGLIGIBLE
    );
    let note = DataProblem { record: "all".into(), signal: inverse.force.clone(), text, fatal: false };
    Some(Banded { records: records.iter().map(|it| signals.compared(it, top)).collect(), top, note })
}

/// The longest section of some records, in seconds.
fn longest(records: &[Dataset]) -> f64 {
    let sections =
        records.iter().flat_map(|record| record.sections.iter().map(move |it| (record.step, it.len())));
    sections.map(|(step, samples)| step * samples as f64).fold(0.0, f64::max)
}

/// That no band is left in which a motion could be compared inversely, and what is done `instead`, as a clause.
pub fn refused(inverse: &Inverse, instead: &str) -> DataProblem {
    let Inverse { force, position, .. } = inverse;
    let text = format!(
        "too coarse or too noisy for inverse dynamics: in no band that has nearly all of {force} does it add less than {} % to \
         it, {instead}. A finer position, or a column of the velocity, helps",
        100.0 * NOISY.sqrt()
    );
    DataProblem { record: "all".into(), signal: position.clone(), text, fatal: false }
}

/// Ends of the bands that are tried, in Hz, the narrowest first.
fn bands(end: f64) -> impl Iterator<Item = f64> {
    let wider = move |top: &f64| (*top < end).then(|| (top / NARROWER).min(end));
    std::iter::successors(Some(LOWEST), wider)
}

/// A record below a frequency in Hz, with the exact rates of its motion.
pub(super) fn below(record: &Dataset, top: f64) -> Dataset {
    with_exact_rates(record.below(top))
}

fn with_exact_rates(mut record: Dataset) -> Dataset {
    for source in &mut record.inputs {
        if let Some(motion) = source.motion() {
            *source = Source::RateOf(motion);
        }
    }
    record
}

/// The signals of a balance of forces.
#[derive(Clone, Copy)]
pub(super) struct Signals {
    /// The output that is compared.
    force: usize,
    /// The input that is measured.
    pub position: usize,
    /// The input that makes most of the motion's noise: what the mass resists, or the damper.
    pub derivative: usize,
    /// The input that tells whether anything moves.
    pub velocity: usize,
}

impl Signals {
    pub fn of(rig: &Rig, inverse: &Inverse) -> Option<Self> {
        let position = rig.plant.input(&inverse.position)?;
        let is_rate = |declared: &Declaration| rig.rate_of(&declared.name) == Some(position);
        Some(Self {
            force: rig.plant.output(&inverse.force)?,
            position,
            derivative: rig.plant.input(&inverse.derivative)?,
            velocity: rig.plant.inputs.iter().position(is_rate)?,
        })
    }

    /// Mean square of what a balance of forces with the banded record's motion leaves of the force.
    pub fn left(self, banded: &Dataset) -> Option<f64> {
        let (terms, force) = (terms(&motion(banded), self.velocity), self.force(banded)?);
        let found = &terms * balance(&terms, force)?;
        let errors = force.iter().zip(&found).map(|(force, found)| force - found);
        Some(power(&errors.filter(|it| it.is_finite()).collect::<Vec<_>>()))
    }

    fn force(self, record: &Dataset) -> Option<&[f64]> {
        record.measured.iter().find(|it| it.output == self.force).map(|it| &it.values[..])
    }

    /// How much of each term is in the force of some records.
    fn balance(self, banded: &[Dataset]) -> Option<DVector<f64>> {
        let each: Vec<DMatrix<f64>> = banded.iter().map(|it| terms(&motion(it), self.velocity)).collect();
        let columns = each.first()?.ncols();
        let rows: Vec<_> = each.iter().flat_map(|it| it.row_iter()).collect();
        let forces = banded.iter().map(|it| self.force(it)).collect::<Option<Vec<_>>>()?.concat();
        balance(&DMatrix::from_fn(rows.len(), columns, |row, column| rows[row][column]), &forces)
    }

    /// Share of the force's power in some records that their own balances leave.
    fn left_of(self, banded: &[Dataset]) -> Option<f64> {
        let left = banded.iter().map(|it| self.left(it)).sum::<Option<f64>>()?;
        let all = banded.iter().map(|it| self.force(it).map(power)).sum::<Option<f64>>()?;
        Some(left / all.max(f64::MIN_POSITIVE))
    }

    /// Share of the force's power that the noise of the position makes up by way of mass, damper, spring or friction, where the rig
    /// moves.
    fn noise(self, banded: &Dataset, balance: &DVector<f64>) -> Option<f64> {
        let (motion, force) = (motion(banded), self.force(banded)?);
        let size = rms(&motion[self.derivative]);
        let known = terms(&motion, self.velocity);
        let noisier = banded.disturbed().map(|it| terms(&self::motion(&it), self.velocity));
        let differences = noisier.map_or_else(|| DVector::zeros(known.nrows()), |it| (it - &known) * balance);
        let rests = resting(&motion[self.velocity], banded.step);
        let moving = differences.iter().zip(rests).filter(|(_, rests)| !rests).map(|(it, _)| *it);
        let noise = rms(&moving.collect::<Vec<_>>());
        (size > 0.0).then(|| noise.powi(2) / power(force))
    }

    /// A record below a frequency in Hz without the force at rest and at its ends, driven by all of its motion that is known.
    fn compared(self, record: &Dataset, top: f64) -> Dataset {
        let mut all = record.compared_below(top);
        // What rests shows in the band that is compared: in a wider one, noise moves it.
        let wide = all.wide.take();
        Dataset { wide, ..self.moving(with_exact_rates(all)) }.with_rates().without_ends()
    }

    /// The record without the force at rest.
    fn moving(self, mut record: Dataset) -> Dataset {
        let rests = resting(&motion(&record)[self.velocity], record.step);
        for measured in record.measured.iter_mut().filter(|it| it.output == self.force) {
            let still = measured.values.iter_mut().zip(&rests).filter(|(_, rests)| **rests);
            still.for_each(|(value, _)| *value = f64::NAN);
        }
        record
    }
}

/// Whether what moves stands still, sample by sample.
fn resting(velocity: &[f64], step: f64) -> Vec<bool> {
    let (still, shortest) = (STILL * rms(velocity), (REST / step).ceil() as usize);
    let mut resting = vec![false; velocity.len()];
    let mut since = 0;
    for sample in 0..=velocity.len() {
        if velocity.get(sample).is_none_or(|it| it.abs() >= still) {
            if sample - since >= shortest {
                resting[since..sample].fill(true);
            }
            since = sample + 1;
        }
    }
    resting
}

/// Mean square of the known values about their mean.
fn power(values: &[f64]) -> f64 {
    rms(values).powi(2)
}

/// The frequency above which a signal has no power worth a comparison, in Hz: the highest over the record's sections.
fn relevant(record: &Dataset, values: &[f64]) -> f64 {
    let of = |section: &Range<usize>| {
        let part = filled(&values[section.clone()]).filter(|it| it.len() >= 16)?;
        let mut top = 0.0;
        about_line(&part, &mut |spectrum| {
            let len = spectrum.len();
            let power: Vec<f64> = spectrum[..=len / 2].iter().map(Complex::norm_sqr).collect();
            let (total, mut beyond) = (power.iter().sum::<f64>(), 0.0);
            let bin = (0..power.len()).rev().find(|bin| {
                beyond += power[*bin];
                beyond > NEGLIGIBLE * total
            });
            top = bin.unwrap_or(0) as f64 / (len as f64 * record.step);
            vec![Complex::from(1.0); len]
        });
        Some(top)
    };
    record.sections.iter().filter_map(of).fold(0.0, f64::max)
}

/// Every input at the samples of a record.
pub(super) fn motion(record: &Dataset) -> Vec<Vec<f64>> {
    let neutral = vec![Correction::default(); record.inputs.len()];
    let mut inputs = vec![Vec::with_capacity(record.len()); record.inputs.len()];
    for section in &record.sections {
        let drive = record.drive(section, &neutral);
        for (all, values) in inputs.iter_mut().zip(&drive.inputs) {
            all.extend(values.iter().step_by(drive.finer));
        }
    }
    inputs
}

/// What a balance of forces adds up, sample by sample: every input, the direction of the motion, and a constant.
fn terms(inputs: &[Vec<f64>], velocity: usize) -> DMatrix<f64> {
    let samples = inputs.iter().map(Vec::len).min().unwrap_or(0);
    let direction = inputs.len();
    DMatrix::from_fn(samples, direction + 2, |sample, term| match inputs.get(term) {
        Some(input) => input[sample],
        None if term == direction => inputs[velocity][sample].signum(),
        None => 1.0,
    })
}

/// How much of each term is in a signal, by least squares over its known values.
fn balance(terms: &DMatrix<f64>, signal: &[f64]) -> Option<DVector<f64>> {
    let known: Vec<usize> = (0..signal.len().min(terms.nrows())).filter(|k| signal[*k].is_finite()).collect();
    let scales = DVector::from_fn(terms.ncols(), |term, _| {
        let size = terms.column(term).norm();
        if size > 0.0 { size } else { 1.0 }
    });
    let rows =
        DMatrix::from_fn(known.len(), terms.ncols(), |row, term| terms[(known[row], term)] / scales[term]);
    let right = DVector::from_fn(known.len(), |row, _| signal[known[row]]);
    let solution = rows.svd(true, true).solve(&right, 1e-9).ok()?;
    Some(solution.component_div(&scales))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::dataset::recorded::Measured;
    use crate::signal::random::Random;

    /// A mass and 30 N of friction, moved by 10 mm at 2 Hz, 3 mm at 6.2 Hz and 0.1 mm at 40 Hz.
    fn record(rig: &Rig, mass: f64, noise: f64) -> Dataset {
        const SINES: [(f64, f64); 3] = [(0.01, 2.0), (3e-3, 6.2), (1e-4, 40.0)];
        let mut random = Random::new(7);
        let step = 1e-3;
        let wave = |t: f64, of: fn(f64) -> f64, order: i32| -> f64 {
            SINES.iter().map(|(size, hertz)| size * (TAU * hertz).powi(order) * of(TAU * hertz * t)).sum()
        };
        let time = || (0..8000).map(|k| f64::from(k) * step);
        let position: Vec<f64> = time().map(|t| wave(t, f64::sin, 0) + noise * random.normal()).collect();
        let force = time().map(|t| 30.0 * (wave(t, f64::cos, 1) / 0.01).tanh() - mass * wave(t, f64::sin, 2));
        let inputs = rig.plant.inputs.iter().map(|declared| match declared.name.as_str() {
            "motion.position" => Source::Measured(position.clone()),
            _ => rig.rate_of(&declared.name).map_or(Source::Constant(0.0), Source::DerivativeOf),
        });
        let output = rig.plant.output("motor.force").unwrap();
        Dataset {
            step,
            inputs: inputs.collect(),
            measured: vec![Measured { output, values: force.collect(), noise_floor: 0.1 }],
            sections: std::iter::once(0..8000).collect(),
            ..Dataset::default()
        }
    }

    /// Friction of a filtered motion is not the filtered friction: a tenth of the force apart where it turns over within 10 mm/s.
    #[test]
    fn a_law_sees_all_of_the_motion_and_its_force_is_filtered() {
        let mut rig = Rig::published("linear-drive").unwrap();
        let by = rig.kind.drives.iter().find(|by| by.inverse.is_some()).unwrap().clone();
        rig.drive_by(&by, |name| name == by.input).unwrap();
        let values = [("moving_mass", 20.0), ("guide.coulomb.force", 30.0), ("guide.coulomb.velocity", 0.01)];
        for (name, value) in values {
            let index = rig.plant.parameter(name).unwrap();
            rig.parameters[index] = value;
        }
        let dynamics = rig.plant.prepare(&rig.choices).unwrap();
        let signals = Signals::of(&rig, &by.inverse.unwrap()).unwrap();
        let apart = |record: &Dataset| {
            let neutral = vec![Correction::default(); record.inputs.len()];
            let drive = record.drive(&record.sections[0], &neutral);
            let outputs = dynamics.outputs(&rig.parameters, &rig.start, &drive);
            let (force, found) = (signals.force(record).unwrap(), &outputs[signals.force]);
            let known = force.iter().zip(found).filter(|(force, _)| force.is_finite());
            let errors: Vec<f64> = known.map(|(force, found)| force - found).collect();
            assert!(errors.len() > 200);
            rms(&errors) / rms(force)
        };
        let wide = signals.compared(&record(&rig, 20.0, 0.0), 20.0);
        // A part of a section is driven as in the whole of it.
        let neutral = vec![Correction::default(); wide.inputs.len()];
        let [whole, part] = [0..400, 100..300].map(|samples| wide.drive(&samples, &neutral));
        for (all, some) in whole.inputs.iter().zip(&part.inputs) {
            assert_eq!(all[100 * whole.finer..][..some.len()], some[..]);
        }
        let narrow = Dataset { wide: None, ..wide.clone() };
        assert!(wide.wide.is_some() && apart(&wide) < 3e-3, "{}", apart(&wide));
        assert!(apart(&narrow) > 0.05, "{}", apart(&narrow));
    }

    #[test]
    fn a_position_has_to_be_fine_where_the_mass_matters() {
        let rig = Rig::published("linear-drive").unwrap();
        let inverse = rig.kind.drives.iter().find_map(|by| by.inverse.clone()).unwrap();
        let step = |mass: f64, noise: f64| {
            banded(&rig, &[record(&rig, mass, noise)], &inverse).map(|it| it.records[0].step)
        };
        assert!(step(20.0, 1e-7).unwrap() < 0.01);
        // Half of the force is at 40 Hz, where nothing of the motion is left in such noise.
        assert_eq!(step(20.0, 1e-3), None);
        assert!(step(1e-3, 1e-5).is_some());
    }

    #[test]
    fn a_motion_that_no_force_goes_with_is_noise() {
        let rig = Rig::published("linear-drive").unwrap();
        let inverse = rig.kind.drives.iter().find_map(|by| by.inverse.clone()).unwrap();
        let top = |shaken_by: f64| {
            let mut record = record(&rig, 1.0, 0.0);
            for source in &mut record.inputs {
                if let Source::Measured(position) = source {
                    let shake = |k: usize| shaken_by * (TAU * 60.0 * 1e-3 * k as f64).sin();
                    position.iter_mut().enumerate().for_each(|(k, it)| *it += shake(k));
                }
            }
            banded(&rig, &[record], &inverse).unwrap().top
        };
        let (calm, shaken) = (top(0.0), top(1e-3));
        assert!(calm > 70.0 && shaken < 60.0, "{calm} {shaken}");
    }

    #[test]
    fn a_stop_is_a_rest_and_a_reversal_is_none() {
        let velocity: Vec<f64> = (0..300)
            .map(|k| if (100..130).contains(&k) { 1e-3 } else { (0.1 * f64::from(k)).cos() })
            .collect();
        let rests = resting(&velocity, 0.01);
        let first = rests.iter().position(|it| *it).unwrap();
        assert!((99..=100).contains(&first), "{first}");
        assert!((30..=32).contains(&rests.iter().filter(|it| **it).count()));
    }

    #[test]
    fn the_mass_is_found_beside_friction() {
        let rig = Rig::published("linear-drive").unwrap();
        let record = record(&rig, 20.0, 0.0).below(100.0);
        let motion = motion(&record);
        let [velocity, acceleration] =
            ["motion.velocity", "motion.acceleration"].map(|name| rig.plant.input(name).unwrap());
        let mass = balance(&terms(&motion, velocity), &record.measured[0].values).unwrap()[acceleration];
        // The direction stands for a friction that takes a while to turn over.
        assert!((mass / 20.0 - 1.0).abs() < 0.05, "{mass}");
    }
}
