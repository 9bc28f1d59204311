//! From records to findings: base fit, search, and what is told about it.

use nalgebra::DVector;

use crate::catalogue::{self, Cause};
use crate::correction::Fault;
use crate::findings::Evidence;
use crate::fit::{self, Handle, Point, Residuals};
use crate::hypothesis::{Fitted, World};
use crate::lsq::Problem;
use crate::lsq::Stop;
use crate::plant::Drive;
use crate::recorded::{Measured, Recorded, Source};
use crate::rig::Rig;
use crate::screening::{rms, typical};
use crate::search::Found;

/// Blocks of half a second that make a long stretch.
const STRETCH: usize = 10;

/// A diagnosis that has come to its end.
pub struct Diagnosis<'a> {
    /// What it was about.
    pub world: World<'a>,
    /// The held-out records as they were measured.
    pub measured: &'a [Recorded],
    /// The starting model as it was given.
    pub before: Point,
    /// What was found.
    pub found: Found,
    /// Causes that the starting model has already, in quite another size.
    pub rooted: Vec<(&'static Cause, Evidence)>,
    /// Signals that had to be turned over before anything fitted.
    pub reversed: Vec<Handle>,
}

/// Diagnoses a rig from records. `train` and `test` are conditioned; `measured` are the latter as they were measured,
/// on which the errors are told. `known` are parameters' indices with a value and its standard deviation that were
/// measured otherwise; `only`, unless empty, the numbers of the causes that are looked at.
///
/// # Errors
/// If the model refuses its parameters or diverges on the records.
pub fn diagnose<'a>(
    rig: &'a Rig,
    train: &'a [Recorded],
    test: &'a [Recorded],
    measured: &'a [Recorded],
    known: Vec<(usize, f64, f64)>,
    only: &[String],
    progress: &(dyn Fn(&str) + Sync),
) -> Result<Diagnosis<'a>, String> {
    let mut world = World {
        rig,
        train,
        test,
        typical: Vec::new(),
        known,
        held: Vec::new(),
        only: only.to_vec(),
        sigma: vec![1.0; rig.plant.outputs.len()],
        floor: Vec::new(),
    };
    progress("simulating the starting model");
    let dynamics = world.dynamics(&[])?;
    world.sigma = measured_sigma(rig, train, |measured| rms(&measured.values));
    world.floor = floors(train);
    let mut start = {
        let bare = world.fit(&*dynamics, train, Vec::new());
        bare.settled(world.origin())
    };
    let before = start.clone();
    progress("fitting the starting model's parameters");
    let mut reversed = Vec::new();
    let mut base = world.fitted(&[], &[start.clone()], Stop::NOISY)?;
    // A sign is doubted only where something does not fit at all.
    let doubted = if fits(&world, &base) { Vec::new() } else { signals(train) };
    for handle in doubted {
        let mut turned = start.clone();
        turned.set(handle, -2.0);
        let other = world.fitted(&[], &[turned.clone()], Stop { iterations: 8, ..Stop::NOISY });
        if let Ok(other) = other
            && other.cost < 0.5 * base.cost
        {
            (base, start) = (other, turned);
            reversed.push(handle);
        }
    }
    // Weights by what is left, twice: then the fit is the likeliest for errors of such magnitudes.
    for _ in 0..2 {
        world.sigma = left_sigma(&world, &base.train);
        base = world.fitted(&[], &[base.point.clone()], Stop::NOISY)?;
    }
    world.typical = {
        let all = outputs(&world, &base);
        typical(rig, train, &all)
    };
    let found = world.search(base, progress)?;
    let rooted = rooted(&mut world, &found)?;
    Ok(Diagnosis { world, measured, before, found, rooted, reversed })
}

/// Causes among the base parameters whose size differs from the starting model's by more than half, with what speaks
/// for the difference.
fn rooted(world: &mut World<'_>, found: &Found) -> Result<Vec<(&'static Cause, Evidence)>, String> {
    let rig = world.rig;
    let base = rig.base();
    let mut rooted = Vec::new();
    for cause in catalogue::causes(&rig.plant) {
        let amount = cause.parts.first().and_then(|part| rig.plant.parameter(part.parameter));
        let Some(index) = amount.filter(|index| base.contains(index)) else { continue };
        let (before, after) = (rig.parameters[index], found.extended.point.parameters[index]);
        if (after - before).abs() <= 0.5 * before.abs() {
            continue;
        }
        world.held = vec![index];
        let mut start = found.extended.point.clone();
        start.parameters[index] = before;
        let held = world.fitted(&found.extended.terms, &[start], Stop::NOISY);
        world.held.clear();
        let evidence = world.evidence(&found.base, &held?, &found.extended);
        if evidence.refusal().is_none() {
            rooted.push((cause, evidence));
        }
    }
    Ok(rooted)
}

/// Whether every signal is met at least roughly.
fn fits(world: &World<'_>, fitted: &Fitted) -> bool {
    let records = world.train.iter().zip(&fitted.train);
    let mut signals = records.flat_map(|(record, left)| record.measured.iter().zip(left));
    signals.all(|(measured, left)| phi(left, &measured.values) > 0.3)
}

/// Root mean square of what is left of each output, and not below its noise.
fn left_sigma(world: &World<'_>, residuals: &Residuals) -> Vec<f64> {
    let mut sigma = world.sigma.clone();
    for (row, floor) in world.floor.iter().enumerate() {
        let output = world.train[0].measured[row].output;
        let left: Vec<f64> = residuals.iter().flat_map(|record| record[row].iter().copied()).collect();
        sigma[output] = root_mean_square(&left).max(*floor);
    }
    sigma
}

/// Every signal that may have been recorded with the wrong sign.
fn signals(train: &[Recorded]) -> Vec<Handle> {
    let Some(record) = train.first() else { return Vec::new() };
    let inputs = record.inputs.iter().enumerate().filter(|(_, source)| matches!(source, Source::Measured(_)));
    let inputs = inputs.map(|(index, _)| Handle::Input(index, Fault::Gain));
    let outputs = record.measured.iter().map(|measured| Handle::Output(measured.output, Fault::Gain));
    inputs.chain(outputs).collect()
}

fn measured_sigma(rig: &Rig, records: &[Recorded], of: impl Fn(&Measured) -> f64) -> Vec<f64> {
    let mut sigma = vec![1.0; rig.plant.outputs.len()];
    for record in records {
        for measured in &record.measured {
            sigma[measured.output] = of(measured).max(f64::MIN_POSITIVE);
        }
    }
    sigma
}

fn floors(train: &[Recorded]) -> Vec<f64> {
    let Some(first) = train.first() else { return Vec::new() };
    first
        .measured
        .iter()
        .map(|measured| measured.noise_floor.max(1e-6 * rms(&measured.values)).max(f64::MIN_POSITIVE))
        .collect()
}

/// All outputs of the plant on the training records.
pub(crate) fn outputs(world: &World<'_>, fitted: &Fitted) -> Vec<Vec<Vec<f64>>> {
    let Ok(dynamics) = world.dynamics(&fitted.terms) else { return Vec::new() };
    let mut starts = fitted.point.starts.iter();
    world
        .train
        .iter()
        .map(|record| {
            let mut whole = vec![Vec::new(); world.rig.plant.outputs.len()];
            for section in &record.sections {
                let drive: Drive = record.drive(section, &fitted.point.inputs);
                let Some(start) = starts.next() else { continue };
                let part = dynamics.outputs(&fitted.point.parameters, start, &drive);
                for (whole, part) in whole.iter_mut().zip(part) {
                    whole.extend(part);
                }
            }
            whole
        })
        .collect()
}

/// Value and half the 95 % interval of each coordinate.
///
/// Errors of a model that is not quite right pull its parameters differently in every excitation: beside the spread of
/// the training data's own blocks, the pull of long stretches of all data counts, held-out ones included, and the larger
/// of both makes the interval.
pub fn intervals(world: &World<'_>, fitted: &Fitted) -> Vec<(Handle, f64, f64)> {
    let own = fit::covariance(&fitted.linear, &fitted.trace.scores);
    let mut stretches = stretches(&fitted.trace.scores);
    let learnt = stretches.len();
    if let Ok(dynamics) = world.dynamics(&fitted.terms) {
        let point = world.held_out_point(&*dynamics, &fitted.point);
        let fit = world.fit(&*dynamics, world.test, fitted.coordinates.clone());
        let (_, trace) = fit.linearise(&point);
        stretches.extend(self::stretches(&trace.scores));
    }
    let share = learnt as f64 / stretches.len().max(1) as f64;
    let pull = fit::sandwich(&fitted.linear, &stretches) * share;
    let handles = fitted.coordinates.iter().enumerate();
    let half = |index: usize| 1.96 * own[(index, index)].max(pull[(index, index)]).max(0.0).sqrt();
    handles.map(|(index, it)| (it.handle, fitted.point.get(it.handle), half(index))).collect()
}

/// Scores of so many blocks together.
fn stretches(scores: &[DVector<f64>]) -> Vec<DVector<f64>> {
    let sum = |blocks: &[DVector<f64>]| blocks.iter().skip(1).fold(blocks[0].clone(), |sum, it| sum + it);
    scores.chunks(STRETCH).map(sum).collect()
}

/// How closely signals are met: `1 − rms(e)/rms(z)`, TUM eq. 16; z about its mean.
pub fn phi(residuals: &[f64], measured: &[f64]) -> f64 {
    1.0 - root_mean_square(residuals) / rms(measured).max(f64::MIN_POSITIVE)
}

/// Root of the mean of the known squares.
pub fn root_mean_square(values: &[f64]) -> f64 {
    let known = values.iter().filter(|value| value.is_finite());
    let (sum, n) = known.fold((0.0, 0), |(sum, n), value| (sum + value * value, n + 1));
    (sum / f64::from(n.max(1))).sqrt()
}
