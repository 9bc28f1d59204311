//! Causes that are in no catalogue: what a report has to say of them.

use super::report::{Named, Report, words};
use super::{Interval, Outcome, is_named};
use crate::case::Present;
use crate::catalogue::{Place, number};

/// Share by which a frequency may be off: that of an absorber is a little higher where the body moves, too.
const FREQUENCY: f64 = 0.15;

/// Whether an effect is in no catalogue.
pub(super) fn is_hidden(effect: &Present) -> bool {
    effect.id.starts_with('U')
}

/// How a report came out of which these effects count, where one that is there is in no catalogue.
pub(super) fn outcome(report: &Report, told: &[&Named], effects: &[Present]) -> Outcome {
    let right = |effect: &Present, named: &Named| {
        if is_hidden(effect) { is_known_law(effect, named) } else { is_named(effect, named) }
    };
    if told.iter().any(|named| !effects.iter().any(|effect| right(effect, named))) {
        return Outcome::WrongName;
    }
    if effects.iter().all(|effect| told.iter().any(|named| right(effect, named))) {
        return if report.unmodelled.is_empty() { Outcome::Correct } else { Outcome::TooMany };
    }
    match told.is_empty() {
        _ if !report.unmodelled.is_empty() || says_something(report) => Outcome::Unnamed,
        true => Outcome::Missed,
        false => Outcome::TooFew,
    }
}

/// Whether the verdict says that something is there, though not what.
fn says_something(report: &Report) -> bool {
    ["unmodelled", "model_inadequate", "sensor_fault", "bad_data"].contains(&report.verdict.as_str())
}

/// Whether a name of the catalogue is the effect's law after all: an absorber on the body is a mode of the frame (18) of its
/// frequency.
pub(super) fn is_known_law(effect: &Present, named: &Named) -> bool {
    let interval = |it: &&Interval| it.name.ends_with("frequency");
    let told = named.parameters.iter().find(interval).and_then(|it| Some(0.5 * (it.low? + it.high?)));
    number(&effect.id) == "U9" && named.id == "18" && told.is_some_and(|it| is_near(effect, it) == Some(true))
}

/// Whether the record of the very sensor is said to have a problem.
pub(super) fn is_problem(report: &Report, effects: &[Present]) -> bool {
    let there = |effect: &Present| report.data_problems.iter().any(|problem| problem.signal == effect.signal);
    effects.iter().any(|effect| is_hidden(effect) && effect.place == Place::Sensor && there(effect))
}

/// Whether what the largest unmodelled cause depends on is right.
pub(super) fn variable_right(report: &Report, effects: &[Present]) -> Option<bool> {
    if report.effects.iter().any(|named| effects.iter().any(|effect| is_known_law(effect, named))) {
        return Some(true);
    }
    let told = report.unmodelled.first()?.words();
    let right = |effect: &Present| {
        // Truths of earlier versions have the variable alone.
        words(&effect.variable)
            .chain(effect.depends_on.iter().map(String::as_str))
            .any(|it| told.contains(&it))
    };
    Some(effects.iter().any(right))
}

/// Whether the frequency of the largest unmodelled cause is right.
pub(super) fn frequency_right(report: &Report, effects: &[Present]) -> Option<bool> {
    let told = report.unmodelled.first()?.frequency?;
    effects.iter().filter_map(|effect| is_near(effect, told)).reduce(|one, other| one || other)
}

/// Whether a frequency in Hz is the effect's; none if it has none. That of a loose sensor's ringing is above what a record shows.
fn is_near(effect: &Present, frequency: f64) -> Option<bool> {
    let own = effect.parameters.iter().find(|it| it.name.ends_with(".frequency"))?;
    (effect.place != Place::Sensor).then(|| (frequency / own.value - 1.0).abs() <= FREQUENCY)
}
