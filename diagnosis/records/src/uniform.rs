//! Evenly spaced records.
//!
//! Samples whose time stamps are on an even grid but for 5 % of the period, or but for the rounding of their last digit, keep
//! their values. Others are interpolated (monotone cubic). Missing samples in short runs are interpolated linearly; longer runs split
//! the record into segments. Whatever was done is reported.

mod grid;

use super::check::{describe, number};
use super::interpolate::{cubic, linear};
use super::{Channel, DataError, Record};
use crate::check::DataProblem;
use std::ops::Range;

use grid::Grid;
pub use grid::ON_GRID;
pub(crate) use grid::{
    GAP, MOST_MISSING, RoundedClock, median_period, rounded_clock, share_missing, usual_period,
};

/// Missing samples in a row that are interpolated.
pub const BRIDGED: usize = 5;
/// Samples that a segment needs to be used.
pub const SHORTEST_SEGMENT: usize = 50;

/// A record with evenly spaced times.
#[derive(Clone, Debug, PartialEq)]
pub struct Uniform {
    /// The file's name.
    pub name: String,
    /// Time of the first sample in seconds.
    pub start: f64,
    /// Period in seconds.
    pub step: f64,
    /// The channels, of one length; NaN outside of the segments only.
    pub channels: Vec<Channel>,
    /// Where all channels have values: ascending ranges of sample numbers that do not touch.
    pub segments: Vec<Range<usize>>,
}

impl Uniform {
    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.channels.first().map_or(0, |channel| channel.values.len())
    }

    /// Whether there is no sample.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Time of a sample in seconds.
    #[must_use]
    pub fn time(&self, sample: usize) -> f64 {
        self.start + self.step * sample as f64
    }
}

/// Makes a record evenly spaced; says what it had to do for that.
///
/// # Errors
/// The times do not increase, are fewer than two or more than twenty times sparser than their period,
/// or there is no stretch of [`SHORTEST_SEGMENT`] samples in which all channels have values.
pub fn uniform(record: &Record) -> Result<(Uniform, Vec<DataProblem>), DataError> {
    let grid = Grid::of(record)?;
    let mut problems = Vec::new();
    let mut report = |signal: &str, text: String| {
        problems.push(DataProblem { record: record.name.clone(), signal: signal.into(), text, fatal: false });
    };
    if grid.places.is_none() {
        let text = format!(
            "the samples are not evenly spaced: they were interpolated to a period of {} s; frequencies near half \
             the sampling rate are no longer to be trusted",
            number(grid.step)
        );
        report("time", text);
    }
    let mut channels: Vec<Channel> =
        record.channels.iter().map(|channel| grid.place(record, channel)).collect();
    let mut valid = vec![true; grid.length];
    for channel in &mut channels {
        let (bridged, lost) = bridge(&mut channel.values, &mut valid);
        if bridged > 0 {
            let text = format!("{bridged} missing samples were interpolated");
            report(&channel.name, text);
        }
        if lost > 0 {
            let text = format!(
                "{lost} samples are missing at an end or in runs of more than {BRIDGED}: these stretches are left out"
            );
            report(&channel.name, text);
        }
    }
    let segments: Vec<_> =
        runs(&valid, true).into_iter().filter(|run| run.len() >= SHORTEST_SEGMENT).collect();
    if segments.is_empty() {
        return Err(no_segment(record));
    }
    if segments.len() > 1 {
        let ends = segments
            .iter()
            .map(|run| format!("{} to {} s", number(grid.time(run.start)), number(grid.time(run.end - 1))));
        report("time", format!("the record is used in {} segments: {}", segments.len(), describe(ends)));
    }
    let (name, start, step) = (record.name.clone(), grid.start, grid.step);
    Ok((Uniform { name, start, step, channels, segments }, problems))
}

/// Names the channel that has the least samples.
fn no_segment(record: &Record) -> DataError {
    let missing = |channel: &&Channel| channel.values.iter().filter(|v| v.is_nan()).count();
    match record.channels.iter().max_by_key(missing) {
        Some(worst) if missing(&worst) > 0 => {
            let text = format!(
                "{} of {} samples are missing, which leaves no stretch of {SHORTEST_SEGMENT} samples with all \
                 signals: leave this signal out, or record all signals at one rate",
                missing(&worst),
                worst.values.len()
            );
            DataError::signal(&record.name, &worst.name, text)
        }
        _ => {
            let text =
                format!("there is no stretch of {SHORTEST_SEGMENT} samples without a gap: record longer");
            DataError::file(&record.name, text)
        }
    }
}

impl Grid {
    /// A channel's values on the grid; NaN where it has none.
    fn place(&self, record: &Record, channel: &Channel) -> Channel {
        let mut values = vec![f64::NAN; self.length];
        if let Some(places) = &self.places {
            for (&place, &value) in places.iter().zip(&channel.values) {
                values[place] = value;
            }
        } else {
            let present = |(_, v): &(&f64, &f64)| !v.is_nan();
            let (time, known): (Vec<f64>, Vec<f64>) =
                record.time.iter().zip(&channel.values).filter(present).unzip();
            for (place, value) in values.iter_mut().enumerate() {
                // The last stamp may lie a rounding error before the grid's last point.
                let at = self.time(place).min(record.time[record.time.len() - 1]);
                let after = time.partition_point(|&t| t < at).min(time.len().saturating_sub(1));
                let width = if after == 0 { 0.0 } else { time[after] - time[after - 1] };
                let on_sample = time.get(after) == Some(&at);
                // A gap is bridged by a straight line, a longer one not at all.
                *value = match width / self.step {
                    _ if on_sample => known[after],
                    w if w > BRIDGED as f64 + 1.5 => f64::NAN,
                    w if w > 2.5 => linear(&time, &known, at),
                    _ => cubic(&time, &known, at),
                };
            }
        }
        Channel { name: channel.name.clone(), unit: channel.unit.clone(), values }
    }
}

/// Interpolates short runs of missing samples and marks longer ones, and those at the ends, as not valid.
/// Returns how many samples were interpolated and how many are lost.
fn bridge(values: &mut [f64], valid: &mut [bool]) -> (usize, usize) {
    let missing: Vec<bool> = values.iter().map(|v| v.is_nan()).collect();
    let (mut bridged, mut lost) = (0, 0);
    for run in runs(&missing, true) {
        if run.len() > BRIDGED || run.start == 0 || run.end == values.len() {
            lost += run.len();
            valid[run].fill(false);
            continue;
        }
        bridged += run.len();
        let (low, high) = (values[run.start - 1], values[run.end]);
        let parts = (run.len() + 1) as f64;
        for (k, i) in run.enumerate() {
            values[i] = low + (high - low) * (k + 1) as f64 / parts;
        }
    }
    (bridged, lost)
}

/// Ranges of neighbours that have this value.
pub(crate) fn runs<T: PartialEq + Copy>(values: &[T], wanted: T) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut start = None;
    for (i, value) in values.iter().enumerate() {
        match (*value == wanted, start) {
            (true, None) => start = Some(i),
            (false, Some(from)) => {
                found.push(from..i);
                start = None;
            }
            _ => {}
        }
    }
    found.extend(start.map(|from| from..values.len()));
    found
}

#[cfg(test)]
mod tests;
