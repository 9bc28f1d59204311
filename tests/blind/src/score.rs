//! What a diagnosis made of a case.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde::Deserialize;

use crate::case::{Present, Truth, Value};
use crate::catalogue::Place;

/// What of `report.json` is judged.
#[derive(Clone, Debug, Deserialize)]
pub struct Report {
    /// `no_effect`, `named`, …
    pub verdict: String,
    /// In the order of their gain.
    #[serde(default)]
    pub effects: Vec<Named>,
    /// Parameters of the starting model.
    #[serde(default)]
    pub base_parameters: Vec<Fitted>,
    /// Errors on the held-out data.
    #[serde(default)]
    pub signals: Vec<Signal>,
    /// A cause without a name.
    #[serde(default)]
    pub unnamed: Option<Unnamed>,
    /// What is wrong with the data.
    #[serde(default)]
    pub data_problems: Vec<Problem>,
    /// How long it took.
    #[serde(default)]
    pub seconds: f64,
}

/// A cause that was named.
#[derive(Clone, Debug, Deserialize)]
pub struct Named {
    /// Number in the catalogue.
    pub id: String,
    /// Where it sits: an element or a signal.
    #[serde(default)]
    pub element: String,
    /// With intervals.
    #[serde(default)]
    pub parameters: Vec<Interval>,
    /// Numbers, each perhaps with a place.
    #[serde(default)]
    pub ambiguous_with: Vec<String>,
}

/// A parameter's interval; an end that could not be determined is none.
#[derive(Clone, Debug, Deserialize)]
pub struct Interval {
    /// As in the FMU, or `signal.gain`.
    pub name: String,
    /// Lower end.
    pub low: Option<f64>,
    /// Upper end.
    pub high: Option<f64>,
}

/// A parameter of the starting model.
#[derive(Clone, Debug, Deserialize)]
pub struct Fitted {
    /// With its interval.
    #[serde(flatten)]
    pub interval: Interval,
    /// Whether it is said to be another one.
    #[serde(default)]
    pub mismatch: bool,
}

/// The error of one signal on the held-out data; what could not be determined is none.
#[derive(Clone, Debug, Deserialize)]
pub struct Signal {
    /// As in the FMU.
    pub name: String,
    /// 1 − rms(e)/rms(z) of the extended model.
    pub phi_after: Option<f64>,
    /// Root mean square of the error of the starting model with fitted parameters.
    pub rms_fitted: Option<f64>,
    /// The same of the extended model.
    pub rms_after: Option<f64>,
}

/// A cause without a name.
#[derive(Clone, Debug, Deserialize)]
pub struct Unnamed {
    /// Where it acts.
    pub location: String,
    /// Over which variable.
    #[serde(default)]
    pub variable: String,
}

/// Something wrong with the data.
#[derive(Clone, Debug, Deserialize)]
pub struct Problem {
    /// The signal.
    #[serde(default)]
    pub signal: String,
}

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
    /// What is there: `01`, `01+08`, `34 wheel.force`, `-`.
    pub truth: String,
    /// What comes first in the report, in the same form.
    pub first: String,
    /// How it came out.
    pub outcome: Outcome,
    /// How many effects are there.
    pub effects: usize,
    /// Whether what is there has no number.
    pub out_of_catalogue: bool,
    /// Whether there was clutter.
    pub clutter: bool,
    /// Whether the first name is one of those that are there; none if nothing is.
    pub first_right: Option<bool>,
    /// Whether the first cause is at the right place.
    pub location_right: Option<bool>,
    /// Whether the variable of an unnamed cause is right.
    pub variable_right: Option<bool>,
    /// Whether a sensor was told from the plant; none if nothing was found or is there.
    pub sensor_or_plant: Option<bool>,
    /// How many 95 % intervals of rightly named effects cover the truth, of how many.
    pub covered: (usize, usize),
    /// How many of the base parameters' cover it, where all that is there is named.
    pub base_covered: (usize, usize),
    /// The rise of Φ on the held-out data, summed over the signals, and that of an oracle which knows parameters and
    /// effects; none if there are no effects with a name.
    pub gained: Option<(f64, f64)>,
    /// How long the diagnosis took.
    pub seconds: f64,
}

/// Judges a report.
///
/// # Errors
/// If it is no report.
pub fn score(truth: &Truth, report: &str) -> Result<Score, String> {
    let report: Report = serde_json::from_str(report)
        .map_err(|error| format!("case {}: report.json is not a report: {error}", truth.case.name))?;
    let effects = &truth.effects;
    let out_of_catalogue = effects.iter().any(|effect| effect.id.starts_with('U'));
    let first = first_cause(&report);
    let first_place = report.effects.first().map(|named| named.element.as_str());
    let first_place = first_place.or(report.unnamed.as_ref().map(|unnamed| unnamed.location.as_str()));
    let outcome = outcome(&report, effects);
    let found = first_place.filter(|_| !effects.is_empty());
    let sensors: Vec<bool> = effects.iter().map(|effect| effect.place == Place::Sensor).collect();
    let said_sensor = report.verdict == "sensor_fault" || first_place.is_some_and(is_signal);
    let variable = report.unnamed.as_ref().filter(|_| out_of_catalogue).map(|unnamed| &unnamed.variable);
    Ok(Score {
        case: truth.case.name.clone(),
        truth: if effects.is_empty() { "-".into() } else { joined(effects) },
        first,
        outcome,
        effects: effects.len(),
        out_of_catalogue,
        clutter: truth.case.clutter > 0,
        first_right: (!effects.is_empty()).then(|| {
            let right = |named: &Named| effects.iter().any(|effect| is_named(effect, named));
            report.effects.first().is_some_and(right)
                || effects.iter().any(|e| is_known_otherwise(e, &report))
        }),
        location_right: found.map(|place| effects.iter().any(|effect| is_at(effect, place))),
        variable_right: variable.map(|name| effects.iter().any(|effect| effect.variable == *name)),
        sensor_or_plant: found.map(|_| sensors.contains(&said_sensor)),
        covered: coverage(&report, effects),
        base_covered: if outcome == Outcome::Correct { base_coverage(&report, truth) } else { (0, 0) },
        gained: (!effects.is_empty() && !out_of_catalogue).then(|| gained(&report, truth)),
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

/// The catalogue's number: dropouts and saturation share one.
fn number(id: &str) -> &str {
    if id == "38d" { "38" } else { id }
}

fn is_signal(place: &str) -> bool {
    place.contains('.')
}

fn first_cause(report: &Report) -> String {
    match (report.effects.first(), &report.unnamed) {
        (Some(named), _) if is_signal(&named.element) => format!("{} {}", named.id, named.element),
        (Some(named), _) => named.id.clone(),
        (None, Some(unnamed)) => format!("unnamed {}", unnamed.location),
        (None, None) if report.verdict == "no_effect" => "-".into(),
        (None, None) => report.verdict.clone(),
    }
}

fn is_named(effect: &Present, named: &Named) -> bool {
    let at_place = effect.signal.is_empty() || named.element == effect.signal;
    named.id == number(&effect.id) && at_place
}

/// Whether the report says so in another way than by an effect: the tyre's damping is a parameter of the model,
/// and steps, flat tops and holes in a signal are found before any model is fitted.
fn is_known_otherwise(effect: &Present, report: &Report) -> bool {
    match number(&effect.id) {
        "21" => report
            .base_parameters
            .iter()
            .any(|fitted| fitted.interval.name == "tire.damping" && fitted.mismatch),
        "37" | "38" => report.data_problems.iter().any(|problem| problem.signal == effect.signal),
        _ => false,
    }
}

/// Whether `text`, a number with perhaps a place, is the effect.
fn is_meant(effect: &Present, text: &str) -> bool {
    let words: Vec<&str> = text.split(|c: char| c.is_whitespace() || "()@,:".contains(c)).collect();
    let at_place = effect.signal.is_empty() || words.len() < 2 || words.contains(&effect.signal.as_str());
    words.first() == Some(&number(&effect.id)) && at_place
}

fn is_at(effect: &Present, place: &str) -> bool {
    match effect.place {
        Place::Strut => place.starts_with("strut"),
        Place::Guide => place.starts_with("guide") || place == "body_guide",
        Place::WheelGuide => place.starts_with("wheel_guide"),
        Place::Tire => place.starts_with("tire"),
        Place::Actuator => place.starts_with("actuator") && !is_signal(place),
        Place::Sensor => place == effect.signal,
    }
}

fn outcome(report: &Report, effects: &[Present]) -> Outcome {
    let nothing = report.effects.is_empty() && report.unnamed.is_none();
    if effects.is_empty() {
        let calm = nothing && ["no_effect", "parameter_mismatch"].contains(&report.verdict.as_str());
        return if calm { Outcome::Correct } else { Outcome::FalseAlarm };
    }
    if effects.iter().any(|effect| effect.id.starts_with('U')) {
        return match (report.effects.is_empty(), nothing) {
            (_, true) => Outcome::Missed,
            (true, _) => Outcome::Unnamed,
            (false, _) => Outcome::WrongName,
        };
    }
    // The largest set from which one of the present effects had to be chosen; none if it is not there at all.
    let choice = |effect: &Present| {
        let sure = report.effects.iter().find(|named| is_named(effect, named));
        let among = |named: &&Named| named.ambiguous_with.iter().any(|text| is_meant(effect, text));
        let found = sure.or_else(|| report.effects.iter().find(among));
        let size = found.map(|named| 1 + named.ambiguous_with.len());
        size.or(is_known_otherwise(effect, report).then_some(1))
    };
    let choices: Vec<usize> = effects.iter().filter_map(choice).collect();
    let belongs = |named: &Named| {
        effects
            .iter()
            .any(|e| is_named(e, named) || named.ambiguous_with.iter().any(|text| is_meant(e, text)))
    };
    let strangers = !report.effects.iter().all(belongs);
    match choices.iter().max() {
        None if report.unnamed.is_some() && report.effects.is_empty() => Outcome::Unnamed,
        None if report.effects.is_empty() => Outcome::Missed,
        None => Outcome::WrongName,
        Some(_) if strangers && choices.len() < effects.len() => Outcome::WrongName,
        Some(_) if strangers || report.effects.len() > effects.len() => Outcome::TooMany,
        Some(_) if choices.len() < effects.len() => Outcome::TooFew,
        Some(1) => Outcome::Correct,
        Some(2) => Outcome::OneOfTwo,
        Some(_) => Outcome::OneOfMany,
    }
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
    let intervals: Vec<Interval> = report.base_parameters.iter().map(|it| it.interval.clone()).collect();
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

/// The rise of Φ that the extended model brings, and the oracle's.
fn gained(report: &Report, truth: &Truth) -> (f64, f64) {
    let mut gained = (0.0, 0.0);
    for signal in &report.signals {
        let oracle = truth.oracle.iter().find(|value| value.name == signal.name);
        let known = signal.phi_after.zip(signal.rms_fitted.zip(signal.rms_after));
        if let (Some(oracle), Some((phi, (fitted, after)))) = (oracle, known) {
            let size = after / (1.0 - phi);
            gained.0 += (fitted - after) / size;
            gained.1 += (fitted - oracle.value) / size;
        }
    }
    gained
}

/// Wilson's 95 % interval of a share.
pub fn wilson(hits: usize, of: usize) -> (f64, f64) {
    if of == 0 {
        return (0.0, 1.0);
    }
    let (n, z) = (of as f64, 1.959_963_985);
    let share = hits as f64 / n;
    let middle = share + z * z / (2.0 * n);
    let half = z * (share * (1.0 - share) / n + z * z / (4.0 * n * n)).sqrt();
    let scale = 1.0 + z * z / n;
    (((middle - half) / scale).max(0.0), ((middle + half) / scale).min(1.0))
}

/// The table of targets and the confusion matrix, as Markdown.
pub fn markdown(scores: &[Score]) -> String {
    let mut text = "| figure | wanted | seen | cases | 95 % interval |\n|---|---|---|---|---|\n".to_owned();
    let mut row = |name: &str, wanted: &str, judged: &mut dyn Iterator<Item = bool>| {
        let all: Vec<bool> = judged.collect();
        let hits = all.iter().filter(|hit| **hit).count();
        let (low, high) = wilson(hits, all.len());
        let (seen, interval) = if all.is_empty() {
            ("–".to_owned(), "–".to_owned())
        } else {
            let percent = 100.0 * hits as f64 / all.len() as f64;
            (format!("{percent:.1} %"), format!("{:.1}–{:.1} %", 100.0 * low, 100.0 * high))
        };
        writeln!(text, "| {name} | {wanted} | {seen} | {hits}/{} | {interval} |", all.len())
            .expect("a string takes everything");
    };
    let single = || scores.iter().filter(|score| score.effects == 1 && !score.out_of_catalogue);
    let without = |clutter| scores.iter().filter(move |score| score.effects == 0 && score.clutter == clutter);
    let unnamed = || scores.iter().filter(|score| score.out_of_catalogue);
    let good = |score: &Score| matches!(score.outcome, Outcome::Correct | Outcome::OneOfTwo);
    let alarm = |score: &Score| score.outcome == Outcome::FalseAlarm;
    row("correct, or one of two", "≥ 95 %", &mut single().map(good));
    row("first name right", "≥ 95 %", &mut single().filter_map(|score| score.first_right));
    row("false alarms without clutter", "≤ 1 %", &mut without(false).map(alarm));
    row("false alarms with clutter", "≤ 5 %", &mut without(true).map(alarm));
    let pairs = scores.iter().filter(|score| score.effects == 2);
    row("pairs: exact set", "≥ 80 %", &mut pairs.map(good));
    let wrong = |score: &Score| score.outcome == Outcome::WrongName;
    row("out of catalogue: falsely named", "≤ 5 %", &mut unnamed().map(wrong));
    let place = |score: &Score| score.location_right == Some(true) && score.variable_right == Some(true);
    row("out of catalogue: location and variable right", "≥ 85 %", &mut unnamed().map(place));
    row("sensor or plant", "≥ 95 %", &mut scores.iter().filter_map(|score| score.sensor_or_plant));
    let each = |(hits, of): (usize, usize)| (0..of).map(move |k| k < hits);
    row("95 % intervals that cover", "90–98 %", &mut scores.iter().flat_map(|score| each(score.covered)));
    let base = scores.iter().flat_map(|score| each(score.base_covered));
    row("the same of base parameters", "90–98 %", &mut { base });
    let gains: Vec<(f64, f64)> = scores.iter().filter_map(|score| score.gained).collect();
    let (gained, oracle) = gains.iter().fold((0.0, 0.0), |sum, it| (sum.0 + it.0, sum.1 + it.1));
    if oracle > 0.0 {
        let percent = 100.0 * gained / oracle;
        writeln!(
            text,
            "| Φ gained on held-out data, of an oracle's | ≥ 90 % | {percent:.1} % | {} | – |",
            gains.len()
        )
        .expect("a string takes everything");
    }
    if !scores.is_empty() {
        let mean = scores.iter().map(|score| score.seconds).sum::<f64>() / scores.len() as f64;
        writeln!(text, "\nMean time of a diagnosis: {mean:.1} s.").expect("a string takes everything");
    }
    text + "\n" + &confusion(scores)
}

/// Which truth was called what, most frequent names first.
pub fn confusion(scores: &[Score]) -> String {
    let mut table: BTreeMap<&str, BTreeMap<&str, usize>> = BTreeMap::new();
    for score in scores {
        *table.entry(&score.truth).or_default().entry(&score.first).or_default() += 1;
    }
    let mut text = "| truth | called first (times) |\n|---|---|\n".to_owned();
    for (truth, called) in table {
        let mut called: Vec<(&str, usize)> = called.into_iter().collect();
        called.sort_by_key(|(_, times)| std::cmp::Reverse(*times));
        let called: Vec<String> = called.iter().map(|(name, times)| format!("{name} ({times})")).collect();
        writeln!(text, "| {truth} | {} |", called.join(", ")).expect("a string takes everything");
    }
    text
}

#[cfg(test)]
mod tests;
