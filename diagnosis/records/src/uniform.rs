//! Evenly spaced records.
//!
//! Samples whose time stamps are on an even grid but for 5 % of the period, or but for the rounding of their last digit, keep
//! their values. Others are interpolated (monotone cubic). Missing samples in short runs are interpolated linearly; longer runs split
//! the record into segments. Whatever was done is reported.

use super::check::{describe, number};
use super::interpolate::{cubic, linear};
use super::{Channel, DataError, Record};
use crate::check::DataProblem;
use std::ops::Range;

/// Deviation from the even grid, in periods, up to which a time stamp counts as on it.
pub const ON_GRID: f64 = 0.05;
/// Spread of time stamps about the fitted grid, in units of their last digit, that rounding can make: one digit, and a little for
/// the error of the fit.
const ROUNDED: f64 = 1.1;
/// Decimals of seconds that are looked for in printed times: microseconds.
const MOST_DECIMALS: i32 = 6;
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

/// The even grid behind a record's times.
struct Grid {
    start: f64,
    step: f64,
    length: usize,
    /// The grid point of each sample, if all are on the grid.
    places: Option<Vec<usize>>,
    /// How far the stamps are spread about the grid, in seconds.
    spread: f64,
}

impl Grid {
    fn of(record: &Record) -> Result<Self, DataError> {
        let time = &record.time;
        if !time.iter().all(|t| t.is_finite()) || !time.windows(2).all(|pair| pair[0] < pair[1]) {
            let text =
                "the times do not increase from sample to sample: sort the file and remove double rows";
            return Err(DataError::signal(&record.name, "time", text));
        }
        let Some(period) = median_period(time) else {
            return Err(DataError::signal(&record.name, "time", "there are fewer than two samples"));
        };
        let (first, last) = (time[0], time[time.len() - 1]);
        if (last - first) / period > 20.0 * time.len() as f64 {
            let text = format!(
                "{} samples {} s apart are spread over {} s: check the unit and the gaps of the time",
                time.len(),
                number(period),
                number(last - first)
            );
            return Err(DataError::signal(&record.name, "time", text));
        }
        let places = places(time, period);
        let fitted = fit(time, &places);
        let candidates = [snap(fitted).unwrap_or(fitted), fitted];
        let rounding = rounding(time);
        let on_grid = candidates.into_iter().find_map(|step| {
            let offset = |(t, &place): (&f64, &usize)| t - step * place as f64;
            let (low, high) = time
                .iter()
                .zip(&places)
                .map(offset)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), offset| {
                    (low.min(offset), high.max(offset))
                });
            let allowed =
                (2.0 * ON_GRID * step).max(if 2.0 * rounding < step { ROUNDED * rounding } else { 0.0 });
            (high - low <= allowed).then_some((0.5 * (low + high), step, high - low))
        });
        Ok(match on_grid {
            Some((start, step, spread)) => {
                // Rounding of the stamps is no reason for a start of 1e-17 s.
                let start = if (start - first).abs() < 1e-9 * step { first } else { start };
                Self { start, step, length: places[places.len() - 1] + 1, places: Some(places), spread }
            }
            None => {
                let step = snap(period).unwrap_or(period);
                let length = ((last - first) / step * (1.0 + 1e-12)) as usize + 1;
                Self { start: first, step, length, places: None, spread: f64::INFINITY }
            }
        })
    }

    fn time(&self, place: usize) -> f64 {
        self.start + self.step * place as f64
    }

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

/// The period of the even clock behind time stamps that would be uneven but for the rounding of their last digit, and that
/// digit; none if they are even without it, or not even with it.
pub(crate) fn rounded_clock(record: &Record) -> Option<(f64, f64)> {
    let digit = rounding(&record.time);
    let grid = Grid::of(record).ok()?;
    let uneven = grid.spread > 2.0 * ON_GRID * grid.step;
    (grid.places.is_some() && uneven).then_some((grid.step, digit))
}

/// The last digit of printed times, in seconds: the largest power of ten of which all are multiples. Zero if it is
/// less than a microsecond.
fn rounding(time: &[f64]) -> f64 {
    let is_multiple = |t: &f64, digit: f64| (t / digit - (t / digit).round()).abs() < 1e-4;
    let digits = (0..=MOST_DECIMALS).map(|decimals| 10_f64.powi(-decimals));
    digits.into_iter().find(|digit| time.iter().all(|t| is_multiple(t, *digit))).unwrap_or(0.0)
}

/// Median of the differences of the times; none for fewer than two.
pub(crate) fn median_period(time: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Number of the grid point of each sample, counted from gap to gap so that no error of the period adds up.
fn places(time: &[f64], period: f64) -> Vec<usize> {
    let mut place = 0;
    let steps = time.windows(2).map(|pair| (((pair[1] - pair[0]) / period).round() as usize).max(1));
    std::iter::once(0)
        .chain(steps.map(|step| {
            place += step;
            place
        }))
        .collect()
}

/// Slope of the line through the times over their grid points.
fn fit(time: &[f64], places: &[usize]) -> f64 {
    let n = time.len() as f64;
    let mean_time = time.iter().sum::<f64>() / n;
    let mean_place = places.iter().sum::<usize>() as f64 / n;
    let (mut covariance, mut variance) = (0.0, 0.0);
    for (t, &place) in time.iter().zip(places) {
        let x = place as f64 - mean_place;
        covariance += x * (t - mean_time);
        variance += x * x;
    }
    covariance / variance
}

/// The period of a whole number of samples a second, or the whole number of seconds, if within 1e-3.
fn snap(period: f64) -> Option<f64> {
    let near = |round: f64| (round > 0.0 && (period / round - 1.0).abs() < 1e-3).then_some(round);
    let rate = (1.0 / period).round();
    near(1.0 / rate).or_else(|| near(period.round()))
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
