//! The fit of the nominal parameters, before anything is looked for.

use std::ops::Range;

use crate::confirm::has_no_name;
use crate::dataset::rate::along;
use crate::dataset::recorded::{Dataset, SHORT, Source};
use crate::dataset::split::Split;
use crate::decision::criteria::CRITERIA;
use crate::decision::rules::lowers;
use crate::estimation::deadline::Stage;
use crate::estimation::fit::{Residuals, contained};
use crate::estimation::hypothesis::{Baseline, Fitted};
use crate::estimation::lsq::Stop;
use crate::estimation::unknowns::{Estimate, Unknown};
use crate::rig::Rig;
use crate::screening::rms;
use crate::signal::distortion::Fault;

use super::{Found, phi, root_mean_square};

/// Cost of a fit, in that of another one, below which it is clearly the better one.
const CLEARLY: f64 = 0.8;

/// Share of an estimated noise that is there for sure: estimates are some per cent off.
const SURE: f64 = 0.9;

/// Least noise of a signal, in its root mean square.
const ROUNDING: f64 = 1e-6;

/// The starting model as it was given, the fit of its nominal parameters, and the signals that had to be turned over.
pub(super) fn fit(baseline: &mut Baseline<'_>) -> Result<(Estimate, Fitted, Vec<Unknown>), String> {
    let dynamics = baseline.dynamics(&[])?;
    baseline.sigma = measured_sigma(baseline.rig, baseline.train);
    baseline.floor = floors(baseline.train);
    let before = baseline.fit(&*dynamics, baseline.train, Vec::new()).settled(baseline.origin());
    let mut start = before.clone();
    for (parameter, value, _) in &baseline.known {
        start.parameters[*parameter] = *value;
    }
    let mut reversed = Vec::new();
    let starts: Vec<Estimate> = std::iter::once(start.clone()).chain(weighed(baseline, &start)?).collect();
    let mut base = baseline.fitted(&[], &starts, Stop::NOISY)?;
    if !fits(baseline, &base)
        && !baseline.deadline.is_over(Stage::Nominal)
        && let Some(other) = shot(baseline, &start)
        && other.cost < base.cost
    {
        base = other;
    }
    for handle in signals(baseline.rig, baseline.train) {
        if baseline.deadline.is_over(Stage::Nominal) {
            break;
        }
        let mut turned = start.clone();
        turned.set(handle, -2.0);
        if let Some(other) = turned_over(baseline, &base, &turned, handle) {
            (base, start) = (other, turned);
            reversed.push(handle);
        }
    }
    // A mass that was weighed with the wrong sign is another one.
    if !reversed.is_empty()
        && let Some(again) = weighed(baseline, &start)?
    {
        base = baseline.fitted(&[], &[again, base.point], Stop::NOISY)?;
    }
    Ok((before, settled(baseline, base)?, reversed))
}

/// A nominal fit with its weights, its scale, and what noise of the measured inputs does to it.
fn settled(baseline: &mut Baseline<'_>, base: Fitted) -> Result<Fitted, String> {
    let mut base = weighted(baseline, base)?;
    if let Some(point) = baseline.hold_scale(&base) {
        base = weighted(baseline, Fitted { point, ..base })?;
    }
    baseline.transmitted = transmitted(baseline, &base)?;
    Ok(base)
}

/// Root mean square of what noise of the measured inputs changes each measured output by, on the validation data. The states at
/// the start make up for what they can, as they do for the noise that is there.
fn transmitted(baseline: &Baseline<'_>, base: &Fitted) -> Result<Vec<f64>, String> {
    let all = baseline.test.iter().map(|record| record.disturbed().unwrap_or_else(|| record.clone()));
    let noisier: Vec<Dataset> = all.collect();
    let dynamics = baseline.dynamics(&[])?;
    let left = Baseline { test: &noisier, ..baseline.clone() }.held_out(&*dynamics, &base.point);
    let change = |row: usize| {
        let records =
            left.iter().zip(&base.test).flat_map(|(noisy, clean)| noisy[row].iter().zip(&clean[row]));
        root_mean_square(&records.map(|(noisy, clean)| noisy - clean).collect::<Vec<_>>())
    };
    Ok((0..baseline.floor.len()).map(change).collect())
}

/// A start with the parameters of a balance of forces, which become the sheet; none if the order of each is known. A simulation from a
/// mass that nobody gave shows nothing; a balance of forces does not simulate.
fn weighed(baseline: &mut Baseline<'_>, start: &Estimate) -> Result<Option<Estimate>, String> {
    if !baseline.rig.base().into_iter().any(|index| baseline.is_of_unknown_order(index)) {
        return Ok(None);
    }
    baseline.sheet = baseline.balanced(start)?;
    Ok(Some(Estimate { parameters: baseline.sheet.clone(), ..start.clone() }))
}

/// The fit with weights from its residuals, twice: then it is the likeliest for errors of these magnitudes.
pub(super) fn weighted(baseline: &mut Baseline<'_>, mut base: Fitted) -> Result<Fitted, String> {
    for _ in 0..2 {
        baseline.sigma = left_sigma(baseline, &base.train);
        base = baseline.fitted(&base.terms, &[base.point.clone()], Stop::NOISY)?;
    }
    Ok(base)
}

impl<'a> Baseline<'a> {
    /// The nominal fit from where the extended one is, where it comes clearly closer than the one before: that had ended in another
    /// minimum, and the effects made up for it.
    ///
    /// # Errors
    /// If the model refuses its settings or diverges.
    pub(super) fn closer(&mut self, found: &Found) -> Result<Option<Fitted>, String> {
        if found.accepted.is_empty() || self.deadline.is_over(Stage::Search) {
            return Ok(None);
        }
        let mut start = found.base.point.clone();
        for it in &found.base.coordinates {
            start.set(it.handle, found.extended.point.get(it.handle));
        }
        let below = CLEARLY * found.base.cost;
        match self.fitted(&[], &[start], Stop { below, ..Stop::NOISY }) {
            Ok(other) if other.cost < below => settled(self, other).map(Some),
            _ => Ok(None),
        }
    }

    /// The extended model that is reported, and what knows the weights and the records that it was fitted with. In a search, all fits have
    /// the weights of the nominal fit, by which the effects, once found, would count for little beside what was known of parameters
    /// before, and motion with as few samples as tell effects from each other. A curve without a name is no law: what it leaves is
    /// not noise, and weighs as before. So does what a law leaves that is only a part of what is missing, if a signal loses by other weights.
    pub(super) fn weighed_by_what_is_left(
        &self,
        found: &Found,
        records: &'a Split,
    ) -> Result<(Baseline<'a>, Fitted), String> {
        let terms = &found.extended.terms;
        if terms.is_empty() || terms.iter().any(|it| has_no_name(*it)) {
            return Ok((self.clone(), found.extended.clone()));
        }
        let before = validated(self.test, &found.extended);
        let on = |mut baseline: Baseline<'a>| {
            let extended = weighted(&mut baseline, found.extended.clone())?;
            let after = validated(baseline.test, &extended);
            Ok((!lowers(&before, &after)).then_some((baseline, extended)))
        };
        let [train, test] = &records.finer;
        // What diverges in finer motion need not in the search's.
        let weighed = on(Baseline { train, test, ..self.clone() }).or_else(|_: String| on(self.clone()))?;
        Ok(weighed.unwrap_or_else(|| (self.clone(), found.extended.clone())))
    }
}

/// How closely each signal of the validation data is met.
fn validated(records: &[Dataset], fitted: &Fitted) -> Vec<f64> {
    let of = |row: usize| {
        let pairs = || records.iter().zip(&fitted.test);
        let left: Vec<f64> = pairs().flat_map(|(_, left)| left[row].iter().copied()).collect();
        let values: Vec<f64> =
            pairs().flat_map(|(record, _)| record.measured[row].values.iter().copied()).collect();
        phi(&left, &values)
    };
    (0..records.first().map_or(0, |it| it.measured.len())).map(of).collect()
}

/// The nominal fit from where many short stretches lead, each with states of its own at the start: over a long stretch, a
/// model that is far off loses the data's phase, or drifts away, and the way to the minimum is lost with it (multiple
/// shooting; H. G. Bock, Recent advances in parameter identification techniques for o.d.e., 1983).
fn shot(baseline: &Baseline<'_>, start: &Estimate) -> Option<Fitted> {
    let cut = |record: &Dataset| {
        let length = ((SHORT / record.step) as usize).max(record.block());
        let pieces = |section: &Range<usize>| {
            let ends = (section.start..section.end).step_by(length).skip(1).chain([section.end]);
            let starts = (section.start..section.end).step_by(length);
            starts.zip(ends.collect::<Vec<_>>()).map(|(start, end)| start..end).collect::<Vec<_>>()
        };
        Dataset { sections: record.sections.iter().flat_map(pieces).collect(), ..record.clone() }
    };
    let train: Vec<Dataset> = baseline.train.iter().map(cut).collect();
    let short = Baseline { train: &train, test: &[], ..baseline.clone() };
    let starts = short.origin().starts;
    let near = short.fitted(&[], &[Estimate { starts, ..start.clone() }], Stop::NOISY).ok()?;
    let point = Estimate { starts: start.starts.clone(), ..near.point };
    baseline.fitted(&[], &[point], Stop::NOISY).ok()
}

/// The fit with a signal turned over, if that is clearly better. A sign is doubted where something does not fit at all, and that of an
/// input where the records want less than nothing of it: where another input does most, all fits roughly with this one the wrong way round.
fn turned_over(baseline: &Baseline<'_>, base: &Fitted, turned: &Estimate, handle: Unknown) -> Option<Fitted> {
    let fitted = |stop: Stop| baseline.fitted(&[], std::slice::from_ref(turned), stop).ok();
    if !fits(baseline, base) {
        return fitted(Stop { iterations: 8, ..Stop::NOISY }).filter(|other| other.cost < 0.5 * base.cost);
    }
    if matches!(handle, Unknown::Output(..)) || !is_unwanted(baseline, base, handle)? {
        return None;
    }
    fitted(Stop::NOISY)
        .filter(|other| other.cost < CLEARLY * base.cost && baseline.apart(other, base) > CRITERIA.apart)
}

/// Whether the records want less than nothing of an input: the errors contain more than once what the model's signals change by where the
/// input is left out. A linear look at the fit, all its coordinates being free; none if the model refuses its settings.
fn is_unwanted(baseline: &Baseline<'_>, base: &Fitted, handle: Unknown) -> Option<bool> {
    let dynamics = baseline.dynamics(&[]).ok()?;
    let fit = baseline.fit(&*dynamics, baseline.train, base.coordinates.clone());
    let mut without = base.point.clone();
    without.set(handle, -1.0);
    let change = |index: usize, record: &Dataset, section: &Range<usize>| {
        let predicted = |point: &Estimate| fit.predicted(point, &base.point.starts[index], record, section);
        let mut change = predicted(&without);
        for (change, with) in change.iter_mut().flatten().zip(predicted(&base.point).iter().flatten()) {
            *change -= with;
        }
        vec![change]
    };
    let normal =
        contained(&fit.beside(&base.point, &change, std::slice::from_ref(&(0..1))), base.coordinates.len());
    Some(normal.g[0] > normal.h[(0, 0)])
}

/// Whether every signal is met at least roughly.
fn fits(baseline: &Baseline<'_>, fitted: &Fitted) -> bool {
    let records = baseline.train.iter().zip(&fitted.train);
    let mut signals = records.flat_map(|(record, left)| record.measured.iter().zip(left));
    signals.all(|(measured, left)| phi(left, &measured.values) > 0.3)
}

/// Root mean square of each output's residuals, at least its noise.
fn left_sigma(baseline: &Baseline<'_>, residuals: &Residuals) -> Vec<f64> {
    let mut sigma = baseline.sigma.clone();
    for (row, floor) in baseline.floor.iter().enumerate() {
        let output = baseline.train[0].measured[row].output;
        let left: Vec<f64> = residuals.iter().flat_map(|record| record[row].iter().copied()).collect();
        sigma[output] = root_mean_square(&left).max(*floor);
    }
    sigma
}

/// Every signal that may have been recorded with the wrong sign: of a motion and its rate that go together, neither was.
fn signals(rig: &Rig, train: &[Dataset]) -> Vec<Unknown> {
    let Some(record) = train.first() else { return Vec::new() };
    let vouched_for: Vec<usize> = (0..record.inputs.len())
        .filter_map(|rate| Some((rate, rig.rate_of(&rig.plant.inputs[rate].name)?)))
        .filter(|(rate, motion)| match (&record.inputs[*rate], &record.inputs[*motion]) {
            (Source::Measured(rate), Source::Measured(motion)) => along(rate, motion) > 0.0,
            _ => false,
        })
        .flat_map(<[usize; 2]>::from)
        .collect();
    let is_doubted = |(index, source): &(usize, &Source)| {
        matches!(source, Source::Measured(_)) && !vouched_for.contains(index)
    };
    let inputs = record.inputs.iter().enumerate().filter(is_doubted);
    let inputs = inputs.map(|(index, _)| Unknown::Input(index, Fault::Gain));
    let outputs = record.measured.iter().map(|measured| Unknown::Output(measured.output, Fault::Gain));
    inputs.chain(outputs).collect()
}

/// Root mean square of each output's signal.
fn measured_sigma(rig: &Rig, records: &[Dataset]) -> Vec<f64> {
    let mut sigma = vec![1.0; rig.plant.outputs.len()];
    for record in records {
        for measured in &record.measured {
            sigma[measured.output] = rms(&measured.values).max(f64::MIN_POSITIVE);
        }
    }
    sigma
}

fn floors(train: &[Dataset]) -> Vec<f64> {
    let Some(first) = train.first() else { return Vec::new() };
    first
        .measured
        .iter()
        .map(|measured| {
            (SURE * measured.noise_floor).max(ROUNDING * rms(&measured.values)).max(f64::MIN_POSITIVE)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;
    use std::time::Duration;

    use super::*;
    use crate::confirm::Accepted;
    use crate::dataset::recorded::Measured;
    use crate::decision::evidence::Evidence;
    use crate::diagnosis::Options;
    use crate::estimation::deadline::Deadline;
    use crate::estimation::hypothesis::Term;
    use crate::signal::random::Random;

    fn driven_by_force() -> Rig {
        let mut rig = Rig::published("linear-drive").unwrap();
        rig.drive_by(&rig.kind.drives[0].clone(), |name| name == "force").unwrap();
        rig
    }

    /// 12 kg with 40 N s/m, moved by 20 mm at 0.9 Hz and 4 mm at 3.1 Hz.
    fn record(rig: &Rig, seed: u64) -> Dataset {
        const SINES: [(f64, f64); 2] = [(0.02, 0.9), (4e-3, 3.1)];
        let mut random = Random::new(seed);
        let at = |k: i32| f64::from(k) * 2e-3 + seed as f64;
        let wave = |t: f64, of: fn(f64) -> f64, order: i32| -> f64 {
            SINES.iter().map(|(size, hertz)| size * (TAU * hertz).powi(order) * of(TAU * hertz * t)).sum()
        };
        let force = |t: f64| 40.0 * wave(t, f64::cos, 1) - 12.0 * wave(t, f64::sin, 2);
        let inputs = rig.plant.inputs.iter().map(|declared| match declared.name.as_str() {
            "force" => Source::Measured((0..4000).map(|k| force(at(k))).collect()),
            _ => Source::Constant(0.0),
        });
        let values = (0..4000).map(|k| wave(at(k), f64::sin, 0) + 1e-5 * random.normal()).collect();
        let output = rig.plant.output("position").unwrap();
        Dataset {
            step: 2e-3,
            inputs: inputs.collect(),
            measured: vec![Measured { output, values, noise_floor: 1e-5 }],
            sections: std::iter::once(0..4000).collect(),
            ..Dataset::default()
        }
    }

    /// A mass of 20 kg in the model, of which nobody states the order, and of 12 kg in the record.
    #[test]
    fn no_order_is_looked_for_beyond_the_time_limit_and_the_stage_behind_tells_of_it() {
        let rig = driven_by_force();
        let mass = rig.plant.parameter("moving_mass").unwrap();
        let records = Split::new(&[record(&rig, 1)], vec![record(&rig, 2)]);
        let weighed = |deadline: Deadline| {
            let baseline = Baseline::new(&rig, &records, Options { deadline, ..Options::default() });
            baseline.balanced(&baseline.origin()).unwrap()[mass]
        };
        assert!((weighed(Deadline::default()) / 12.0 - 1.0).abs() < 0.05);
        let over = Deadline::after(Duration::ZERO);
        assert_eq!(weighed(over.clone()), rig.parameters[mass]);
        assert_eq!(over.stopped(), None);
    }

    #[test]
    fn a_fit_in_another_minimum_is_left_for_where_the_effects_lead() {
        let rig = driven_by_force();
        let records = Split::new(&[record(&rig, 1)], vec![record(&rig, 2)]);
        let mut baseline = Baseline::new(&rig, &records, Options::default());
        let (_, base, _) = fit(&mut baseline).unwrap();
        let mass = Unknown::Parameter(rig.plant.parameter("moving_mass").unwrap());
        assert!((base.point.get(mass) / 12.0 - 1.0).abs() < 1e-2, "{}", base.point.get(mass));
        let mut found = Found::nothing(base.clone());
        assert!(baseline.closer(&found).unwrap().is_none(), "without an effect");
        let term = Term::Fault(Unknown::Input(0, Fault::Delay));
        found.accepted.push(Accepted { term, evidence: Evidence::default(), rivals: Vec::new() });
        assert!(baseline.closer(&found).unwrap().is_none(), "as close as before");
        found.base.cost *= 30.0;
        found.base.point.set(mass, 90.0);
        let closer = baseline.closer(&found).unwrap().unwrap();
        assert!((closer.point.get(mass) / 12.0 - 1.0).abs() < 1e-2, "{}", closer.point.get(mass));
    }
}
