//! What a diagnosis made of a case.

mod breakdown;
mod report;
mod spot;
mod table;
#[cfg(test)]
mod tests;
mod unmodelled;

use std::collections::BTreeSet;

use crate::case::{Oracle, Plant, Present, Sensors, Truth, Value, characteristic};
use crate::catalogue::{Place, number};

use spot::Spot;

pub use breakdown::breakdown;
pub use report::{Fitted, Interval, Named, Problem, Report, Signal, Unmodelled, Unnamed, words};
pub use table::{confusion, markdown, wilson};

/// How a case came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Outcome {
    /// All that is there is named and nothing else, or nothing is there and nothing is named.
    Correct,
    /// The truth is one of two that are said to be alike.
    OneOfTwo,
    /// The truth is in a larger set.
    OneOfMany,
    /// All that is there is named, and more.
    TooMany,
    /// Some of several effects are named, and nothing else.
    TooFew,
    /// A cause is seen but rightly or wrongly given no name.
    Unnamed,
    /// Another cause is named.
    WrongName,
    /// Nothing is found.
    Missed,
    /// Nothing is there and something is named.
    FalseAlarm,
}

/// The judgement of one case.
#[derive(Clone, Debug, PartialEq)]
pub struct Score {
    /// The case.
    pub case: String,
    /// The rig.
    pub plant: Plant,
    /// See [`Case::condition`](crate::Case::condition).
    pub condition: String,
    /// What is there: `01`, `01+08`, `34 wheel.force`, `-`.
    pub truth: String,
    /// What comes first in the report, in the same form.
    pub first: String,
    /// How it came out.
    pub outcome: Outcome,
    /// How it came out but for small effects of the clutter that are named and are there.
    pub beside_clutter: Outcome,
    /// How many effects are there.
    pub effects: usize,
    /// Whether what is there has no number.
    pub out_of_catalogue: bool,
    /// Whether there was clutter.
    pub clutter: bool,
    /// Whether every effect is as large beside it as the case asks for, as far as that is known.
    pub full_size: bool,
    /// Whether the first name is one of those that are there; none if nothing is.
    pub first_right: Option<bool>,
    /// Whether the first cause is at the right place.
    pub location_right: Option<bool>,
    /// Whether what an unmodelled cause depends on is right; none if the report has none.
    pub variable_right: Option<bool>,
    /// Whether its frequency is right; none if it has none, or the report tells none.
    pub frequency_right: Option<bool>,
    /// Whether a sensor was told from the plant; none if nothing was found or is there.
    pub sensor_or_plant: Option<bool>,
    /// How many 95 % intervals of rightly named effects cover the truth, of how many.
    pub covered: (usize, usize),
    /// How many of the nominal parameters' cover it, where all that is there is named.
    pub base_covered: (usize, usize),
    /// What the extended model gains; none if there are no effects with a name, or no oracle.
    pub gained: Option<Gain>,
    /// How long the diagnosis took.
    pub seconds: f64,
}

/// By how much Φ rises on the validation data over that of the starting model with fitted parameters, summed over signals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gain {
    /// With the extended model.
    pub model: f64,
    /// With an oracle's [`Oracle::recorded`].
    pub recorded: f64,
    /// With an oracle's [`Oracle::exact`].
    pub exact: f64,
}

impl Score {
    /// Whether the first cause is at the right place.
    fn is_at_place(&self) -> bool {
        self.location_right == Some(true)
    }

    /// Whether what an unmodelled cause depends on is right.
    fn is_over_variable(&self) -> bool {
        self.variable_right == Some(true)
    }
}

/// Judges a report.
///
/// # Errors
/// If it is no report.
pub fn score(truth: &Truth, report: &str) -> Result<Score, String> {
    let report = Report::read(report)
        .map_err(|error| format!("case {}: report.json is not a report: {error}", truth.case.name))?;
    let effects = &truth.effects;
    let out_of_catalogue = effects.iter().any(unmodelled::is_hidden);
    let first = Spot::of(&report, truth);
    let told: Vec<&Named> = report.effects.iter().collect();
    let own: Vec<&Named> = told.iter().copied().filter(|named| !is_clutter(named, truth)).collect();
    let beside_clutter = outcome(&report, &own, effects);
    let outcome = outcome(&report, &told, effects);
    let found = first.as_ref().filter(|_| !effects.is_empty());
    let at_place = |spot: &Spot| {
        let hidden = |it: &Present| unmodelled::is_hidden(it) && spot.is_like(it);
        effects.iter().any(|it| if out_of_catalogue { hidden(it) } else { spot.is_of(it) })
    };
    // Beside a name for what the clutter brings, what has none counts.
    let unmodelled = Spot::unmodelled(&report, truth).filter(|_| out_of_catalogue);
    let located = unmodelled
        .as_ref()
        .or(found)
        .map(at_place)
        .or(unmodelled::is_problem(&report, effects).then_some(true));
    let sensors: Vec<bool> = effects.iter().map(|effect| effect.place == Place::Sensor).collect();
    let said_sensor = report.verdict == "sensor_fault" || first.as_ref().is_some_and(Spot::is_sensor);
    Ok(Score {
        case: truth.case.name.clone(),
        plant: truth.case.plant,
        condition: truth.case.condition(),
        truth: if effects.is_empty() { "-".into() } else { joined(effects) },
        first: first.as_ref().map_or_else(|| without_cause(&report), Spot::label),
        outcome,
        beside_clutter,
        effects: effects.len(),
        out_of_catalogue,
        clutter: truth.case.clutter > 0,
        full_size: effects.iter().all(|it| it.ratio.is_none_or(|ratio| ratio >= truth.case.ratio)),
        first_right: (!effects.is_empty()).then(|| {
            let right = |named: &Named| effects.iter().any(|effect| is_named(effect, named));
            report.effects.first().is_some_and(right)
                || effects.iter().any(|e| is_known_otherwise(e, &report))
        }),
        location_right: located,
        variable_right: out_of_catalogue.then(|| unmodelled::variable_right(&report, effects)).flatten(),
        frequency_right: out_of_catalogue.then(|| unmodelled::frequency_right(&report, effects)).flatten(),
        // A place that is like the effect's may be a signal where that is none.
        sensor_or_plant: found
            .map(|_| sensors.contains(&said_sensor) || out_of_catalogue && located == Some(true)),
        covered: coverage(&report, effects),
        base_covered: if outcome == Outcome::Correct { base_coverage(&report, truth) } else { (0, 0) },
        // Without the road an oracle has nothing to simulate with.
        gained: (!effects.is_empty()
            && !out_of_catalogue
            && truth.oracle != Oracle::default()
            && truth.case.sensors != Sensors::NoRoad)
            .then(|| gained(&report, truth)),
        seconds: report.seconds,
    })
}

fn label(effect: &Present) -> String {
    let id = number(&effect.id);
    if effect.signal.is_empty() { id.into() } else { format!("{id} {}", effect.signal) }
}

fn joined(effects: &[Present]) -> String {
    effects.iter().map(label).collect::<Vec<_>>().join("+")
}

/// What a report says that has neither a named nor an unnamed cause.
fn without_cause(report: &Report) -> String {
    if report.verdict == "no_effect" { "-".into() } else { report.verdict.clone() }
}

/// Whether a place is the one that belongs to the effect's number: a sensor's faults need their signal, and a
/// constant force in the plant has the number of a sensor's offset. Other numbers are places themselves.
fn fits(effect: &Present, place: &str) -> bool {
    match (effect.place, number(&effect.id)) {
        (Place::Sensor, _) => place == effect.signal,
        (_, "33") => place.starts_with("guide"),
        _ => true,
    }
}

fn is_named(effect: &Present, named: &Named) -> bool {
    // The laws of actuators' own share a number, with a letter each.
    let of_family = number(&effect.id) == "32" && number(&named.id) == "32";
    (named.id == number(&effect.id) || of_family) && fits(effect, &named.element)
}

/// Whether the report says so in another way than by an effect: the tyre's damping, the gain of a servo valve, the cylinder's
/// leakage, a drive's constant load, a pump actuator's charge pressure and its valves' characteristics are parameters of the model, and steps, flat tops,
/// holes and folded lines in a signal are found before any model is fitted.
fn is_known_otherwise(effect: &Present, report: &Report) -> bool {
    let another = |name: &str| {
        report
            .nominal_parameters
            .iter()
            .any(|fitted| characteristic(&fitted.interval.name) == name && fitted.mismatch)
    };
    match number(&effect.id) {
        _ if effect.id == "33g" => another("constant_load"),
        "21" => another("tire.damping"),
        _ if effect.id == "15c" => another("guide.damping"),
        "29" => another("actuator.spool.gain") || another("actuator.valve.conductance"),
        "30" => another("actuator.cylinder.leakage"),
        "32a" => another("gas.charge_pressure"),
        "32b" => another("valve.rebound.pressure_drop"),
        "37" | "38" | "40a" => report.data_problems.iter().any(|problem| problem.signal == effect.signal),
        _ => false,
    }
}

/// Whether `text`, a number with perhaps a place, is the effect.
fn is_meant(effect: &Present, text: &str) -> bool {
    let words: Vec<&str> = text.split(|c: char| c.is_whitespace() || "()@,:".contains(c)).collect();
    let at_place = words.len() < 2 || words.iter().any(|word| fits(effect, word));
    words.first() == Some(&number(&effect.id)) && at_place
}

/// How a report came out of which these effects count.
fn outcome(report: &Report, told: &[&Named], effects: &[Present]) -> Outcome {
    let unmodelled = !report.unmodelled.is_empty();
    if effects.is_empty() {
        let calm = ["no_effect", "parameter_mismatch"].contains(&report.verdict.as_str());
        let nothing = calm && told.is_empty() && !unmodelled;
        return if nothing { Outcome::Correct } else { Outcome::FalseAlarm };
    }
    if effects.iter().any(unmodelled::is_hidden) {
        return unmodelled::outcome(report, told, effects);
    }
    // The largest set from which one of the present effects had to be chosen; none if it is not there at all.
    let choice = |effect: &Present| {
        let sure = told.iter().find(|named| is_named(effect, named));
        let among = |named: &&&Named| named.ambiguous_with.iter().any(|text| is_meant(effect, text));
        let found = sure.or_else(|| told.iter().find(among));
        let size = found.map(|named| 1 + named.ambiguous_with.len());
        size.or(is_known_otherwise(effect, report).then_some(1))
    };
    let choices: Vec<usize> = effects.iter().filter_map(choice).collect();
    let belongs = |named: &Named| {
        effects
            .iter()
            .any(|e| is_named(e, named) || named.ambiguous_with.iter().any(|text| is_meant(e, text)))
    };
    // What is wrong with one measured input, its gain and its delay, say, is one effect.
    let number = told.iter().map(|named| (&named.id, &named.element)).collect::<BTreeSet<_>>().len();
    let strangers =
        report.unmodelled.iter().any(Unmodelled::is_claimed) || !told.iter().all(|named| belongs(named));
    match choices.iter().max() {
        None if unmodelled && told.is_empty() => Outcome::Unnamed,
        None if told.is_empty() => Outcome::Missed,
        None => Outcome::WrongName,
        Some(_) if strangers && choices.len() < effects.len() => Outcome::WrongName,
        Some(_) if strangers || number > effects.len() => Outcome::TooMany,
        Some(_) if choices.len() < effects.len() => Outcome::TooFew,
        Some(1) => Outcome::Correct,
        Some(2) => Outcome::OneOfTwo,
        Some(_) => Outcome::OneOfMany,
    }
}

/// Whether a name is that of an effect that the clutter brings: a weak Maxwell branch, a slightly cubic spring, and the filters of
/// accelerometers, which are late by them.
fn is_clutter(named: &Named, truth: &Truth) -> bool {
    let there = match named.id.as_str() {
        "07" | "08" => named.element == "strut",
        "35" | "36" => named.element.ends_with("acceleration"),
        _ => false,
    };
    there && truth.case.clutter > 0 && !truth.effects.iter().any(|effect| is_named(effect, named))
}

fn coverage(report: &Report, effects: &[Present]) -> (usize, usize) {
    let mut covered = (0, 0);
    for effect in effects {
        let Some(named) = report.effects.iter().find(|named| is_named(effect, named)) else { continue };
        count(&mut covered, &named.parameters, &effect.parameters);
    }
    covered
}

fn base_coverage(report: &Report, truth: &Truth) -> (usize, usize) {
    let intervals: Vec<Interval> = report.nominal_parameters.iter().map(|it| it.interval.clone()).collect();
    let mut covered = (0, 0);
    count(&mut covered, &intervals, &truth.base);
    covered
}

/// Counts the intervals that cover, and all.
fn count(covered: &mut (usize, usize), intervals: &[Interval], truth: &[Value]) {
    for value in truth {
        let interval = intervals.iter().find(|interval| interval.name == value.name);
        if let Some((low, high)) = interval.and_then(|it| it.low.zip(it.high)) {
            covered.1 += 1;
            covered.0 += usize::from((low..=high).contains(&value.value));
        }
    }
}

fn gained(report: &Report, truth: &Truth) -> Gain {
    let mut gain = Gain::default();
    for signal in &report.signals {
        let left = |by: &[Value]| by.iter().find(|value| value.name == signal.name).map(|it| it.value);
        let oracle = left(&truth.oracle.recorded).zip(left(&truth.oracle.exact));
        let known = signal.fit_after.zip(signal.rms_fitted.zip(signal.rms_after));
        if let (Some((recorded, exact)), Some((phi, (fitted, after)))) = (oracle, known) {
            let size = after / (1.0 - phi);
            gain.model += (fitted - after) / size;
            gain.recorded += (fitted - recorded) / size;
            gain.exact += (fitted - exact) / size;
        }
    }
    gain
}
