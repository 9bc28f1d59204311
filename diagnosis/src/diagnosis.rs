//! From records to findings: base fit, search, and what is told about it.

use std::ops::Range;

use crate::confirm::{Accepted, Confirmed, Tried};
use crate::dataset::recorded::{Recorded, Source};
use crate::dataset::split::Records;
use crate::decision::rules::{Amount, is_determined};
use crate::estimation::deadline::{Deadline, Stage};
use crate::estimation::fit::{Handle, Point, Residuals};
use crate::estimation::hypothesis::{Fitted, Term, World};
use crate::estimation::intervals::Interval;
use crate::estimation::lsq::Stop;
use crate::explain::candidates::outputs;
use crate::explain::describe::{MissingSignal, SMALLEST, Unmodelled};
use crate::explain::selection::{Choice, Compared, Limits, Score, choose};
use crate::missing::Missing;
use crate::missing::locate::Location;
use crate::plant::Drive;
use crate::rig::Rig;
use crate::screening::{bent_rms, rms};
use crate::signal::distortion::Fault;

/// Length of a short stretch of data in seconds, over which no model goes far astray.
const SHOT: f64 = 1.0;

/// Cost of a hasty fit with an input turned over, in that of the fit without, above which a close one is not worth the time …
const HOPELESS: f64 = 1.5;
/// … and cost of the close one below which the input had the wrong sign …
const CLEARLY: f64 = 0.8;
/// … if Student's t of the difference over blocks of time is above this.
const STEADILY: f64 = 4.0;

/// Effects at most.
const MOST: usize = 4;
/// How often other effects are fitted where the first ones are not confirmed.
const ATTEMPTS: usize = 2;
/// Unmodelled places at most.
const PLACES: usize = 2;

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
    /// How sure each coordinate of the extended model is.
    pub intervals: Vec<Interval>,
    /// Signals that had to be turned over before anything fitted.
    pub reversed: Vec<Handle>,
}

/// What was found.
pub struct Found {
    /// The model with nominal parameters fitted and nothing added.
    pub base: Fitted,
    /// The model after each effect, in the order in which they were confirmed.
    pub stages: Vec<Fitted>,
    /// The model with all effects.
    pub extended: Fitted,
    /// The effects.
    pub accepted: Vec<Accepted>,
    /// What is missing and has no name.
    pub unmodelled: Vec<Unmodelled>,
    /// The missing signal before anything was explained.
    pub missing: Option<MissingSignal>,
    /// What was compared, first of all.
    pub compared: Vec<(Term, Score)>,
    /// All that was fitted, the last word on each term.
    pub tried: Vec<Tried>,
}

/// What a round of the search has found.
enum Next {
    /// An effect with a name.
    Effect,
    /// Features without one.
    Curve(Score),
    /// Nothing that was recorded explains what is missing, if anything is.
    Nothing,
}

/// What is known, and what is looked for.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Indices of parameters that were measured otherwise, with value and standard deviation.
    pub known: Vec<(usize, f64, f64)>,
    /// Numbers of the effects that are looked at; none: all.
    pub only: Vec<String>,
    /// Until when it may be looked further.
    pub deadline: Deadline,
}

/// Diagnoses a rig from records; errors are told on the validation records as they were measured.
///
/// # Errors
/// If the model refuses its parameters or diverges on the records.
pub fn diagnose<'a>(
    rig: &'a Rig,
    records: &'a Records,
    options: Options,
    progress: &(dyn Fn(&str) + Sync),
) -> Result<Diagnosis<'a>, String> {
    let mut world = World::new(rig, records, options);
    progress("fitting the nominal parameters");
    let (before, base, reversed) = nominal(&mut world)?;
    world.look_at(&base)?;
    let mut found = world.identified(base, progress)?;
    progress("comparing what each excitation says");
    let mut intervals = world.intervals(&found.extended)?;
    while let Some(doubtful) = world.doubtful(&found, &intervals) {
        world.drop(&mut found, doubtful)?;
        intervals = world.intervals(&found.extended)?;
    }
    Ok(Diagnosis { world, measured: &records.measured, before, found, intervals, reversed })
}

/// The starting model as it was given, the fit of its nominal parameters, and the signals that had to be turned over.
fn nominal(world: &mut World<'_>) -> Result<(Point, Fitted, Vec<Handle>), String> {
    let dynamics = world.dynamics(&[])?;
    world.sigma = measured_sigma(world.rig, world.train);
    world.floor = floors(world.train);
    let before = world.fit(&*dynamics, world.train, Vec::new()).settled(world.origin());
    let mut start = before.clone();
    for (parameter, value, _) in &world.known {
        start.parameters[*parameter] = *value;
    }
    let mut reversed = Vec::new();
    let mut base = world.fitted(&[], &[start.clone()], Stop::NOISY)?;
    if !fits(world, &base)
        && !world.deadline.is_over(Stage::Nominal)
        && let Some(other) = shot(world, &start)
        && other.cost < base.cost
    {
        base = other;
    }
    for handle in signals(world.train) {
        if world.deadline.is_over(Stage::Nominal) {
            break;
        }
        let mut turned = start.clone();
        turned.set(handle, -2.0);
        if let Some(other) = turned_over(world, &base, &turned, handle) {
            (base, start) = (other, turned);
            reversed.push(handle);
        }
    }
    // Weights by what is left, twice: then the fit is the likeliest for errors of such magnitudes.
    for _ in 0..2 {
        world.sigma = left_sigma(world, &base.train);
        base = world.fitted(&[], &[base.point.clone()], Stop::NOISY)?;
    }
    Ok((before, base, reversed))
}

impl World<'_> {
    /// Typical magnitudes along the trajectory, and how many independent comparisons all effects amount to.
    fn look_at(&mut self, base: &Fitted) -> Result<(), String> {
        let frame =
            self.frame(&[], &Point { parameters: self.rig.parameters.clone(), ..base.point.clone() })?;
        let missing = self.missing(&frame)?;
        let signals = outputs(&missing.setting, &missing.windows, self.rig.plant.outputs.len());
        let typical = self.typical_along(&missing, &signals);
        self.typical = typical;
        self.looks = self.tried_out(base)?.looks(base);
        Ok(())
    }

    /// Place, law, confirmation: until nothing is missing that matters.
    fn identified(&self, base: Fitted, progress: &(dyn Fn(&str) + Sync)) -> Result<Found, String> {
        let mut found = Found::nothing(base);
        while found.accepted.len() < MOST && !self.deadline.is_over(Stage::Search) {
            progress("estimating the missing signal");
            let terms = found.extended.terms.clone();
            let mut at = found.extended.point.clone();
            if terms.is_empty() {
                // A fit has bent its parameters to what it lacks.
                at.parameters.clone_from(&self.rig.parameters);
            }
            let frame = self.frame(&terms, &at)?;
            let mut missing = self.missing(&frame)?;
            let signals = outputs(&missing.setting, &missing.windows, self.rig.plant.outputs.len());
            for known in &found.unmodelled {
                known.explain(&mut missing, self, &signals);
            }
            let location = missing.located();
            if found.missing.is_none() {
                found.missing = Some(MissingSignal::of(self, &missing, &location, &signals));
            }
            progress("comparing what may explain it");
            let candidates = self.candidates(&missing, &signals, &terms);
            let Some(mut compared) = self.compared(&missing, candidates, &location.background) else { break };
            // What is within the sensors' accuracy from sample to sample may add up to what leads a simulation astray.
            if self.is_worth_a_look(&found.extended) {
                compared.misses = compared.misses.max(1.0);
            }
            if found.compared.is_empty() {
                found.compared = compared.ranking();
            }
            let named = self.named(&mut found, &compared, progress)?;
            let goes_on = match named {
                Next::Effect => true,
                // Of what was not looked at to the end nothing is claimed.
                _ if self.deadline.is_over(Stage::Search) => false,
                Next::Curve(score) => self.unmodelled(&mut found, (&missing, &compared), score)?,
                Next::Nothing => {
                    let rest = self.remainder(&found.extended, &missing, &location, &compared);
                    found.unmodelled.extend(rest);
                    false
                }
            };
            if !goes_on {
                break;
            }
        }
        Ok(found)
    }

    /// Fits the effects that explain most of what is missing, until one is confirmed.
    fn named(
        &self,
        found: &mut Found,
        compared: &Compared,
        progress: &(dyn Fn(&str) + Sync),
    ) -> Result<Next, String> {
        let mut names = compared.named.clone();
        let mut features = &compared.features[..];
        for _ in 0..ATTEMPTS {
            let scores = match choose(compared.misses, &names, features, Limits::USUAL) {
                Choice::Nothing => return Ok(Next::Nothing),
                Choice::Unmodelled(score) => return Ok(Next::Curve(score)),
                Choice::Named(scores) => scores,
            };
            // A fit is not worth its time where no signal would gain.
            if scores.first().is_none_or(|it| self.improvement(&found.extended, it.share) < SMALLEST) {
                return Ok(Next::Nothing);
            }
            let proposals = compared.proposals(&scores, Limits::USUAL.most);
            progress(&format!("fitting {} effects", proposals.len()));
            let tried = self.try_all(&found.base, &found.extended, &proposals);
            if self.deadline.is_over(Stage::Search) {
                found.tried.extend(tried);
                return Ok(Next::Nothing);
            }
            let confirmed = self.confirmed(&found.base, &tried)?;
            found.tried.extend(tried);
            if let Some(Confirmed { accepted, fitted }) = confirmed {
                found.accepted.push(accepted);
                found.extended = fitted.clone();
                found.stages.push(fitted);
                return Ok(Next::Effect);
            }
            // What these laws nearly explained is no place without a name.
            names.retain(|it| !proposals.iter().any(|refused| compared.is_of(it, refused.term)));
            features = &[];
        }
        Ok(Next::Nothing)
    }

    /// Takes features without a name as explained, as a curve in the model if there is one. Whether to look further.
    fn unmodelled(
        &self,
        found: &mut Found,
        (missing, compared): (&Missing<'_>, &Compared),
        score: Score,
    ) -> Result<bool, String> {
        let improvement = self.improvement(&found.extended, score.share);
        if found.unmodelled.len() == PLACES || improvement < SMALLEST {
            return Ok(false);
        }
        let port = compared.feature(score.candidate).map(|(port, _)| &missing.setting.ports[port]);
        let curve = compared.curve_for(score, port.and_then(|it| it.element));
        if let Some((term, own)) = curve
            && let Some(Confirmed { accepted, fitted }) = self.drawn(found, compared, own)?
        {
            found.unmodelled.push(Unmodelled::curve(term, own, improvement, &self.rig.plant));
            found.accepted.push(accepted);
            found.extended = fitted.clone();
            found.stages.push(fitted);
            return Ok(true);
        }
        // Without a curve in the model that the data confirm, its place and its variable are known all the same.
        let curve = curve.map(|(term, own)| Unmodelled::curve(term, own, improvement, &self.rig.plant));
        let unmodelled = Unmodelled::of(missing, compared, score, improvement);
        let goes_on = unmodelled.is_some();
        found.unmodelled.extend(unmodelled.or(curve));
        Ok(goes_on)
    }

    /// The last effect whose amount may be nothing by all that is known of it.
    fn doubtful(&self, found: &Found, intervals: &[Interval]) -> Option<usize> {
        let amount = |handle: Handle| {
            let it = intervals.iter().find(|it| it.handle == handle)?;
            let value = it.value - found.base.point.get(handle);
            Some(Amount { value, bounds: (f64::NEG_INFINITY, f64::INFINITY), half: it.half })
        };
        found.accepted.iter().rposition(|it| {
            let amounts: Vec<Amount> = self.sizes(it.term).into_iter().filter_map(amount).collect();
            !is_determined(&amounts)
        })
    }

    /// Takes an effect away again.
    fn drop(&self, found: &mut Found, index: usize) -> Result<(), String> {
        found.accepted.remove(index);
        found.stages.truncate(index);
        let mut last = found.stages.last().unwrap_or(&found.base).clone();
        for accepted in &found.accepted[index..] {
            let mut terms = last.terms.clone();
            terms.push(accepted.term);
            let mut start = last.point.clone();
            for own in self.own_coordinates(accepted.term) {
                start.set(own.handle, found.extended.point.get(own.handle));
            }
            last = self.fitted(&terms, &[start], Stop::NOISY)?;
            found.stages.push(last.clone());
        }
        found.extended = last;
        Ok(())
    }

    /// A curve without a name in the model, if the data confirm it.
    fn drawn(
        &self,
        found: &mut Found,
        compared: &Compared,
        score: Score,
    ) -> Result<Option<Confirmed>, String> {
        let tried = self.try_all(&found.base, &found.extended, &compared.proposals(&[score], 1));
        let confirmed = self.confirmed(&found.base, &tried)?;
        found.tried.extend(tried);
        Ok(confirmed)
    }

    /// What is missing although nothing that was recorded explains it.
    fn remainder(
        &self,
        fitted: &Fitted,
        missing: &Missing<'_>,
        location: &Location,
        compared: &Compared,
    ) -> Option<Unmodelled> {
        let best = location.ranked.first().filter(|_| compared.misses >= 1.0)?;
        let share = (2.0 * best.gain / compared.left).clamp(0.0, 1.0);
        let improvement = self.improvement(fitted, share);
        (improvement >= SMALLEST)
            .then(|| Unmodelled::remainder(missing, location, best.port, (share, improvement)))
    }

    /// Whether the fit of some signal would rise by what is worth reporting if its error were its noise alone.
    fn is_worth_a_look(&self, fitted: &Fitted) -> bool {
        let above = |(row, error): (usize, f64)| (error - self.floor[row]) / bent_rms(self.train, row);
        self.roots(fitted).map(above).any(|it| it >= SMALLEST)
    }

    /// By how much the fit of the worst signal would rise without a share of its error's power.
    fn improvement(&self, fitted: &Fitted, share: f64) -> f64 {
        let of = |(row, error): (usize, f64)| error / bent_rms(self.train, row);
        let worst = self.roots(fitted).map(of).fold(0.0, f64::max);
        worst * (1.0 - (1.0 - share.clamp(0.0, 1.0)).sqrt())
    }

    /// Root mean square of each signal's error on the estimation records, by its row.
    fn roots(&self, fitted: &Fitted) -> impl Iterator<Item = (usize, f64)> {
        self.errors(&fitted.train).mean_squares().into_iter().map(f64::sqrt).enumerate()
    }
}

impl Found {
    fn nothing(base: Fitted) -> Self {
        Self {
            extended: base.clone(),
            base,
            stages: Vec::new(),
            accepted: Vec::new(),
            unmodelled: Vec::new(),
            missing: None,
            compared: Vec::new(),
            tried: Vec::new(),
        }
    }
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
pub(crate) fn simulated(
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
