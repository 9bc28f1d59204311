//! What is wrong with a record: where it is and what to do. Nothing is repaired here.
//!
//! Every check is silent on clean noisy data; switched commands (steps, random telegraph signals) are told from
//! failing sensors by not moving most of the time.

mod channel;
mod lines;

use super::uniform::{GAP, MOST_MISSING, RoundedClock, rounded_clock, runs, share_missing, usual_period};
use super::{Channel, Record};
use std::ops::Range;

use serde::Serialize;

pub use super::noise::{Lattice, lattice, noise_at_rest, noise_floor, rounding};
pub use lines::lines;

/// Samples below which a record is of no use.
const FEWEST_SAMPLES: usize = 200;
/// Deviation of an interval from the period, in periods, that is reported as jitter.
const JITTER: f64 = 0.05;
/// Samples of a block, and of all blocks, in which a record has to be at rest to show offsets.
pub(crate) const REST_BLOCK: usize = 50;
const SHORTEST_REST: usize = 200;
/// Spread of a signal at rest over its spread in the whole record.
const REST: f64 = 0.05;

/// Something wrong with the data.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DataProblem {
    /// The file.
    pub record: String,
    /// The signal, or `time`.
    pub signal: String,
    /// What is wrong, where, and what to do.
    pub text: String,
    /// Whether the diagnosis cannot go on with it.
    pub fatal: bool,
}

/// What is wrong with a record.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Checked {
    /// Everything that there is to say.
    pub problems: Vec<DataProblem>,
    /// Of each channel, the samples at which the sensor did not show what it should.
    pub unusable: Vec<Vec<Range<usize>>>,
}

/// Looks for everything that is wrong with a record.
#[must_use]
pub fn check(record: &Record) -> Checked {
    let mut problems = Problems { record: &record.name, found: Vec::new() };
    let mut unusable = vec![Vec::new(); record.channels.len()];
    let rounded = rounded_clock(record);
    if check_time(&record.time, rounded.is_some(), &mut problems) {
        check_intervals(record, rounded.as_ref(), &mut problems);
        let rest = standstill(record);
        for (i, channel) in record.channels.iter().enumerate() {
            let others = record.channels.iter().enumerate().filter(|&(j, _)| j != i).map(|(_, other)| other);
            unusable[i] = channel::check(&record.time, channel, &others, &mut problems);
            if let Some(rest) = rest.clone() {
                check_offset(&record.time, channel, rest, &mut problems);
            }
        }
    }
    Checked { problems: problems.found, unusable }
}

/// Collects problems of one record.
struct Problems<'a> {
    record: &'a str,
    found: Vec<DataProblem>,
}

impl Problems<'_> {
    fn add(&mut self, signal: &str, fatal: bool, text: String) {
        self.found.push(DataProblem { record: self.record.into(), signal: signal.into(), text, fatal });
    }
}

/// Whether the times increase and are enough for the other checks to make sense. Those of an even clock may be alike, where they
/// are rounded.
fn check_time(time: &[f64], is_rounded: bool, problems: &mut Problems) -> bool {
    if time.len() < FEWEST_SAMPLES {
        let text = format!("only {} samples: at least {FEWEST_SAMPLES} are needed", time.len());
        problems.add("time", true, text);
        return false;
    }
    let bad = |wrong: fn(f64, f64) -> bool| {
        let mut places = time.windows(2).enumerate().filter(move |(_, pair)| wrong(pair[0], pair[1]));
        let first = places.next();
        first.map(|(i, pair)| (i + 2, pair[1], 1 + places.count()))
    };
    let mut sound = true;
    if let Some(first) = time.iter().position(|t| !t.is_finite()) {
        let count = time.iter().filter(|t| !t.is_finite()).count();
        let text = format!(
            "{count} samples have no time, the first is sample {}: delete these rows or complete them",
            first + 1
        );
        problems.add("time", true, text);
        sound = false;
    }
    if let Some((sample, at, count)) = bad(|a, b| a == b).filter(|_| !is_rounded) {
        let text = format!(
            "{count} samples have the time of the sample before, the first is sample {sample} at {} s: remove \
             double rows, or export the time with more digits; if every row is a sample of an even clock, give its rate \
             (`--sampling-rate`, or `rate` in the map)",
            number(at)
        );
        problems.add("time", true, text);
        sound = false;
    }
    if let Some((sample, at, count)) = bad(|a, b| a > b) {
        let text = format!(
            "the time goes back at {count} samples, first at sample {sample} to {} s: sort the rows, or split the \
             file where recordings were joined",
            number(at)
        );
        problems.add("time", true, text);
        sound = false;
    }
    sound
}

/// Gaps and jitter.
fn check_intervals(record: &Record, rounded: Option<&RoundedClock>, problems: &mut Problems) {
    let Some(period) = rounded.map(|it| it.period).or_else(|| usual_period(record)) else { return };
    let time = &record.time;
    let length = |sample: usize| match rounded {
        Some(clock) => (clock.places[sample + 1] - clock.places[sample]) as f64,
        None => (time[sample + 1] - time[sample]) / period,
    };
    let intervals = || (0..time.len() - 1).map(|sample| (time[sample], length(sample)));
    let gaps: Vec<_> = intervals().filter(|interval| interval.1 > GAP).collect();
    if let Some(longest) = gaps.iter().max_by(|a, b| a.1.total_cmp(&b.1)) {
        let share = share_missing(intervals().map(|interval| interval.1));
        let fatal = share > MOST_MISSING;
        let places = describe(gaps.iter().map(|gap| format!("{} s", number(gap.0))));
        let text = format!(
            "{} gaps in the time, after {places}; the longest lasts {} s; {} of the samples are missing{}",
            gaps.len(),
            number(longest.1 * period),
            percent(share),
            if fatal { ": more than 10 %, record again" } else { "" }
        );
        problems.add("time", fatal, text);
    }
    if let Some(RoundedClock { period, digit, .. }) = rounded {
        let text = format!(
            "the time stamps are rounded to {} s; an even clock of {} Hz is within half a digit of all of them and is used \
             in their place",
            number(*digit),
            number(1.0 / period)
        );
        problems.add("time", false, text);
        return;
    }
    let deviation = |interval: &(f64, f64)| (interval.1 - 1.0).abs();
    let jittering = || intervals().filter(|i| i.1 <= GAP && deviation(i) > JITTER);
    if let Some(worst) = jittering().max_by(|a, b| deviation(a).total_cmp(&deviation(b))) {
        let text = format!(
            "the time stamps jitter: {} of the intervals deviate by more than 5 % from the period of {} s, the worst \
             by {} after {} s; take the time from the recorder's clock, not from the computer's",
            percent(jittering().count() as f64 / time.len() as f64),
            number(period),
            percent(deviation(&worst)),
            number(worst.0)
        );
        problems.add("time", false, text);
    }
}

/// The samples at the start in which no signal moves; none if that is less than 200 samples or a second.
#[must_use]
pub fn standstill(record: &Record) -> Option<Range<usize>> {
    let spreads: Vec<f64> = record.channels.iter().map(|channel| spread(&channel.values).1).collect();
    if !spreads.iter().any(|&spread| spread > 0.0) {
        return None;
    }
    let still = |end: usize| {
        record.channels.iter().zip(&spreads).all(|(channel, &whole)| {
            let (mean, own) = spread(&channel.values[end - REST_BLOCK..end]);
            let (first, _) = spread(&channel.values[..REST_BLOCK]);
            own <= REST * whole && (mean - first).abs() <= REST * whole
        })
    };
    let blocks = (1..=record.time.len() / REST_BLOCK).take_while(|block| still(block * REST_BLOCK)).count();
    let end = blocks * REST_BLOCK;
    (end >= SHORTEST_REST && record.time[end - 1] - record.time[0] >= 1.0).then_some(0..end)
}

/// What a signal shows while nothing moves. A pressure is seldom zero then.
fn check_offset(time: &[f64], channel: &Channel, rest: Range<usize>, problems: &mut Problems) {
    if channel.unit == "Pa" {
        return;
    }
    let whole = spread(&channel.values).1;
    let (mean, _) = spread(&channel.values[rest.clone()]);
    if mean.abs() > REST * whole && whole > 0.0 {
        let text = format!(
            "shows {} {} while the rig is at rest until {} s: if that is not its true value there, the sensor has an \
             offset; give it in the map as `offset = {}`",
            number(mean),
            channel.unit,
            number(time[rest.end - 1]),
            number(-mean)
        );
        problems.add(&channel.name, false, text);
    }
}

/// Mean and standard deviation of the samples that are there; 0 if there are none.
fn spread(values: &[f64]) -> (f64, f64) {
    let present = || values.iter().filter(|v| v.is_finite());
    let n = present().count().max(1) as f64;
    let mean = present().sum::<f64>() / n;
    (mean, (present().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt())
}

/// A number for people: four digits.
pub(crate) fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let digits = 3 - value.abs().log10().floor() as i32;
    if !(-3..=9).contains(&digits) {
        return format!("{value:.3e}");
    }
    let text = format!("{value:.0$}", digits.max(0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

/// A share in per cent.
fn percent(share: f64) -> String {
    format!("{} %", number((share * 1e4).round().max(1.0) / 100.0))
}

/// The first few of a list.
pub(crate) fn describe(items: impl Iterator<Item = String>) -> String {
    const SHOWN: usize = 5;
    let items: Vec<String> = items.collect();
    let rest = items.len().saturating_sub(SHOWN);
    let shown = items[..items.len() - rest].join(", ");
    if rest > 0 { format!("{shown} and {rest} more") } else { shown }
}

#[cfg(test)]
pub(crate) mod tests;
