//! The signs of the outputs' responses to a raised input. No file states them, and models of different makers differ in them.

use std::fmt::{self, Display, Formatter};

use serde::Serialize;

use super::subject::reals;
use super::{Acts, Bench};
use crate::description::{Kind, Variable};
use crate::finding::Report;
use crate::probe::{Act, Run};

/// How many communication steps an input is held for.
const HELD: usize = 200;
/// By how much an input is raised, as a share of its nominal value: enough for a friction to give way, little enough for no stop.
const MOVED: f64 = 0.1;
/// A response is one from this share of its largest value on: what comes before is rounding, or a ripple.
const NOTICEABLE: f64 = 0.05;

/// What comes of raising one input.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Response {
    /// The FMU in a system; none where the FMU is checked alone.
    pub component: Option<String>,
    /// The input.
    pub input: String,
    /// By how much it is raised, in its unit.
    pub by: f64,
    /// Its unit, if it is declared.
    pub unit: Option<String>,
    /// For how long, in seconds.
    pub duration: f64,
    /// Outputs that rise, at first.
    pub rise: Vec<String>,
    /// Outputs that fall, at first.
    pub fall: Vec<String>,
    /// Outputs that do not move.
    pub rest: Vec<String>,
}

impl Display for Response {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { component, input, by, unit, duration, rise, fall, rest } = self;
        let prefix = component.as_ref().map_or_else(String::new, |name| format!("{name}: "));
        let unit = unit.as_ref().map_or_else(String::new, |unit| format!(" {unit}"));
        write!(f, "{prefix}{input} raised by {by}{unit} for {duration} s:")?;
        for (sign, outputs) in [("+", rise), ("-", fall), ("0", rest)] {
            if !outputs.is_empty() {
                write!(f, " {sign} {};", outputs.join(", "))?;
            }
        }
        Ok(())
    }
}

impl Bench<'_> {
    /// Holds each input at a higher value, one at a time, and compares with a run at the start values.
    pub(super) fn signs(&self, report: &mut Report) -> Result<(), String> {
        let subject = &self.subject;
        if subject.interface.kind != Kind::CoSimulation {
            return Ok(());
        }
        let is_input = |it: &Variable| it.causality == "input";
        let is_output = |it: &Variable| it.causality == "output";
        let inputs: Vec<_> = reals(subject.description, &is_input).collect();
        let outputs: Vec<_> = reals(subject.description, &is_output).collect();
        if inputs.is_empty() || outputs.is_empty() {
            report.skipped.push("signs: there are no real inputs, or no real outputs".into());
            return Ok(());
        }
        let references: Vec<u32> = outputs.iter().map(|(reference, _)| *reference).collect();
        let held = |set: Option<(u32, f64)>| -> Acts {
            let mut acts = subject.fresh(self.unpacked.plain);
            acts.extend(subject.initialize());
            acts.extend(set.map(|(reference, value)| (Act::SetReals(vec![reference], vec![value]), true)));
            for index in 0..HELD {
                acts.push(subject.advance(subject.time(index)));
                acts.push((Act::Reals(references.clone()), true));
            }
            acts
        };
        let plain = self.obey(held(None))?;
        for (reference, input) in inputs {
            let (start, raised) = raised(input);
            let run = self.obey(held(Some((reference, raised))))?;
            let mut response = Response {
                component: None,
                input: input.name.clone(),
                by: rounded((raised - start).abs()),
                unit: input.unit.clone(),
                duration: rounded(subject.step * HELD as f64),
                rise: Vec::new(),
                fall: Vec::new(),
                rest: Vec::new(),
            };
            if run.failure().is_some() || plain.failure().is_some() {
                report.skipped.push(format!("signs of `{}`: a run with it raised fails", input.name));
                continue;
            }
            for (place, (_, output)) in outputs.iter().enumerate() {
                let name = output.name.clone();
                let sign = first_move(&signal(&plain, place), &signal(&run, place));
                // An input at its upper bound is lowered, and the signs are turned over.
                match if raised < start { -sign } else { sign } {
                    0 => response.rest.push(name),
                    1 => response.rise.push(name),
                    _ => response.fall.push(name),
                }
            }
            report.signs.push(response);
        }
        Ok(())
    }
}

/// The start value of an input, and a higher one, as far as its bounds allow. A lower one where it starts at
/// its upper bound.
fn raised(input: &Variable) -> (f64, f64) {
    let start = super::subject::number(input).unwrap_or(0.0);
    let by = MOVED * input.nominal.unwrap_or(if start == 0.0 { 1.0 } else { start }).abs();
    let high = (start + by).min(input.max.unwrap_or(f64::MAX));
    (start, if high > start { high } else { (start - by).max(input.min.unwrap_or(f64::MIN)) })
}

/// Without the last digits, which are those of differences and products.
fn rounded(value: f64) -> f64 {
    format!("{value:.9e}").parse().unwrap_or(value)
}

/// One output over a run.
fn signal(run: &Run, place: usize) -> Vec<f64> {
    let read =
        run.acts.iter().zip(&run.answers.outcomes).filter(|((act, _), _)| matches!(act, Act::Reals(_)));
    read.filter_map(|(_, outcome)| outcome.values().nth(place)).collect()
}

/// Which way a signal goes at first: 1, -1, or 0 if it does not.
fn first_move(plain: &[f64], raised: &[f64]) -> i32 {
    let moves: Vec<f64> = plain.iter().zip(raised).map(|(plain, raised)| raised - plain).collect();
    let largest = moves.iter().fold(0.0_f64, |largest, it| largest.max(it.abs()));
    let size = plain.iter().chain(raised).fold(0.0_f64, |size, it| size.max(it.abs()));
    // Below that, two runs differ by rounding alone.
    if largest <= 1e-9 * size {
        return 0;
    }
    let first = moves.iter().find(|it| it.abs() >= NOTICEABLE * largest);
    first.map_or(0, |it| if *it > 0.0 { 1 } else { -1 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_move_counts() {
        assert_eq!(first_move(&[1.0, 1.0, 1.0], &[1.0, 1.2, 0.5]), 1);
        assert_eq!(first_move(&[1.0, 1.0, 1.0], &[1.0, 1.000_001, 0.5]), -1);
        assert_eq!(first_move(&[1.0, 1.0], &[1.0, 1.0]), 0);
        assert_eq!(first_move(&[], &[]), 0);
    }
}
