//! From records to findings: base fit, search, and what is told about it.

use std::ops::Range;

use crate::dataset::recorded::{Recorded, Source};
use crate::estimation::fit::{Handle, Point, Residuals};
use crate::estimation::hypothesis::{Fitted, Term, World};
use crate::estimation::intervals::Interval;
use crate::estimation::lsq::Stop;
use crate::plant::Drive;
use crate::rig::Rig;
use crate::screening::{Screened, rms, typical};
use crate::search::{Accepted, Criterion, Found};
use crate::signal::distortion::Fault;

/// Length of a short stretch of data in seconds, over which no model goes far astray.
const SHOT: f64 = 1.0;

/// Cost of a hasty fit with an input turned over, in that of the fit without, above which a close one is not worth the time …
const HOPELESS: f64 = 1.5;
/// … and cost of the close one below which the input had the wrong sign …
const CLEARLY: f64 = 0.8;
/// … if Student's t of the difference over blocks of time is above this.
const STEADILY: f64 = 4.0;

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
    /// Causes that hide among the parameters that are fitted first.
    pub rooted: Vec<Accepted>,
    /// How sure each coordinate of the extended model is.
    pub intervals: Vec<Interval>,
    /// Signals that had to be turned over before anything fitted.
    pub reversed: Vec<Handle>,
}

/// What is known, and what is looked for.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Indices of parameters that were measured otherwise, with value and standard deviation.
    pub known: Vec<(usize, f64, f64)>,
    /// Numbers of the causes that are looked at; none: all.
    pub only: Vec<String>,
    /// What decides whether a cause is named.
    pub criterion: Criterion,
}

/// Diagnoses a rig from records. `train` and `test` are conditioned; `measured` are the latter as they were measured,
/// on which the errors are told.
///
/// # Errors
/// If the model refuses its parameters or diverges on the records.
pub fn diagnose<'a>(
    rig: &'a Rig,
    train: &'a [Recorded],
    test: &'a [Recorded],
    measured: &'a [Recorded],
    options: Options,
    progress: &(dyn Fn(&str) + Sync),
) -> Result<Diagnosis<'a>, String> {
    let mut world = World {
        rig,
        train,
        test,
        typical: Vec::new(),
        known: options.known,
        held: Vec::new(),
        punctual: false,
        only: options.only,
        criterion: options.criterion,
        looks: 1.0,
        sigma: vec![1.0; rig.plant.outputs.len()],
        floor: Vec::new(),
    };
    progress("simulating the starting model");
    let dynamics = world.dynamics(&[])?;
    world.sigma = measured_sigma(rig, train);
    world.floor = floors(train);
    let mut start = {
        let bare = world.fit(&*dynamics, train, Vec::new());
        bare.settled(world.origin())
    };
    let before = start.clone();
    for (parameter, value, _) in &world.known {
        start.parameters[*parameter] = *value;
    }
    progress("fitting the starting model's parameters");
    let mut reversed = Vec::new();
    let mut base = world.fitted(&[], &[start.clone()], Stop::NOISY)?;
    if !fits(&world, &base)
        && let Some(other) = shot(&world, &start)
        && other.cost < base.cost
    {
        base = other;
    }
    for handle in signals(train) {
        let mut turned = start.clone();
        turned.set(handle, -2.0);
        if let Some(other) = turned_over(&world, &base, &turned, handle) {
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
        let all = outputs(&world, &base.terms, &base.point, train);
        typical(rig, train, &all)
    };
    let tried = world.tried_out(&base)?;
    world.looks = tried.looks(&base);
    let screened = world.ranked(&tried, &base);
    let (mut found, mut rooted) = searched(&world, base, screened, progress)?;
    if world.criterion == Criterion::Gates && world.anything_late(&found, &rooted) {
        progress("looking for what makes signals seem late");
        let punctual = World { punctual: true, ..world.clone() };
        let start = Point { starts: before.starts.clone(), ..start };
        let base = punctual.fitted(&[], &[start, punctual.in_time(&found.base.point)], Stop::NOISY);
        let beyond = |base: Fitted| {
            let screened = punctual.screened(&base)?;
            searched(&punctual, base, screened, progress)
        };
        // If that diverges, what was found without it stands.
        if let Ok((other, hidden)) = base.and_then(beyond)
            && world.does_without_lateness(&found, &other)
        {
            (world, found, rooted) = (punctual, other, hidden);
        }
    }
    progress("comparing what each excitation says");
    let intervals = world.intervals(&found.extended)?;
    Ok(Diagnosis { world, measured, before, found, rooted, intervals, reversed })
}

/// What is found beyond a fit of the starting model, and what hides among its parameters.
fn searched(
    world: &World<'_>,
    base: Fitted,
    screened: Vec<Screened>,
    progress: &(dyn Fn(&str) + Sync),
) -> Result<(Found, Vec<Accepted>), String> {
    let mut found = world.search(base, screened, progress)?;
    let mut rooted = world.rooted(&mut found)?;
    if world.dwarfed(&mut found, &rooted)? {
        rooted = world.rooted(&mut found)?;
    }
    if world.criterion == Criterion::Gates {
        world.beside_the_common(&mut found, &mut rooted, progress)?;
    }
    Ok((found, rooted))
}

/// The base fit from where many short stretches lead, each with states of its own at the start: over a long stretch, a
/// model that is far off loses the data's phase, or drifts away, and the way to the minimum is lost with it (multiple
/// shooting; H. G. Bock, Recent advances in parameter identification techniques for o.d.e., 1983).
fn shot(world: &World<'_>, start: &Point) -> Option<Fitted> {
    let cut = |record: &Recorded| {
        let length = ((SHOT / record.step) as usize).max(record.block());
        let pieces = |section: &Range<usize>| {
            let ends = (section.start..section.end).step_by(length).skip(1).chain([section.end]);
            let starts = (section.start..section.end).step_by(length);
            starts.zip(ends.collect::<Vec<_>>()).map(|(start, end)| start..end).collect::<Vec<_>>()
        };
        Recorded { sections: record.sections.iter().flat_map(pieces).collect(), ..record.clone() }
    };
    let train: Vec<Recorded> = world.train.iter().map(cut).collect();
    let short = World { train: &train, test: &[], ..world.clone() };
    let starts = short.origin().starts;
    let near = short.fitted(&[], &[Point { starts, ..start.clone() }], Stop::NOISY).ok()?;
    let point = Point { starts: start.starts.clone(), ..near.point };
    world.fitted(&[], &[point], Stop::NOISY).ok()
}

/// The fit with a signal turned over, if that is clearly better. An output's sign is doubted only where something does not fit
/// at all. An input's always: where another one does most, all fits roughly with it the wrong way round.
fn turned_over(world: &World<'_>, base: &Fitted, turned: &Point, handle: Handle) -> Option<Fitted> {
    let fits = fits(world, base);
    if fits && matches!(handle, Handle::Output(..)) {
        return None;
    }
    let hasty = Stop { iterations: 8, ..Stop::NOISY };
    let other = world.fitted(&[], std::slice::from_ref(turned), hasty).ok()?;
    if other.cost < 0.5 * base.cost {
        return Some(other);
    }
    if !fits || other.cost > HOPELESS * base.cost {
        return None;
    }
    let other = world.fitted(&[], &[other.point], Stop::NOISY).ok()?;
    (other.cost < CLEARLY * base.cost && world.apart(&other, base) > STEADILY).then_some(other)
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

/// Root mean square of each output's signal.
fn measured_sigma(rig: &Rig, records: &[Recorded]) -> Vec<f64> {
    let mut sigma = vec![1.0; rig.plant.outputs.len()];
    for record in records {
        for measured in &record.measured {
            sigma[measured.output] = rms(&measured.values).max(f64::MIN_POSITIVE);
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

/// All outputs of the plant on records, from the starts that the point has for them; not a number between sections.
pub(crate) fn outputs(
    world: &World<'_>,
    terms: &[Term],
    point: &Point,
    records: &[Recorded],
) -> Vec<Vec<Vec<f64>>> {
    let Ok(dynamics) = world.dynamics(terms) else { return Vec::new() };
    let mut starts = point.starts.iter();
    records
        .iter()
        .map(|record| {
            let mut whole = vec![vec![f64::NAN; record.len()]; world.rig.plant.outputs.len()];
            for section in &record.sections {
                let drive: Drive = record.drive(section, &point.inputs);
                let Some(start) = starts.next() else { continue };
                let part = dynamics.outputs(&point.parameters, start, &drive);
                for (whole, part) in whole.iter_mut().zip(part) {
                    whole[section.clone()].copy_from_slice(&part);
                }
            }
            whole
        })
        .collect()
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
