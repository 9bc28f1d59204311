//! The even clock behind the time stamps of a record.

use std::collections::BTreeMap;

use crate::check::number;
use crate::{DataError, Record};

/// Deviation from the even grid, in periods, up to which a time stamp counts as on it.
pub const ON_GRID: f64 = 0.05;
/// Spread of time stamps about the fitted grid, in units of their last digit, that rounding can make: one digit, and a little for
/// the error of the fit.
const ROUNDED: f64 = 1.1;
/// Decimals of seconds that are looked for in printed times: nanoseconds.
const MOST_DECIMALS: i32 = 9;
/// Length of an interval, in periods, from which it is a gap.
pub(crate) const GAP: f64 = 1.5;
/// Share of missing samples from which a record or a signal cannot be used.
pub(crate) const MOST_MISSING: f64 = 0.1;
/// Longest period of a program's loop that is used, in its median.
const LONGEST_LOOP: u8 = 16;
/// Last digits in a time, at most, of which a double shows whether their number is whole.
const MOST_DIGITS: f64 = 1e11;

/// The even grid behind a record's times.
pub(super) struct Grid {
    pub start: f64,
    pub step: f64,
    pub length: usize,
    /// The grid point of each sample, if all are on the grid.
    pub places: Option<Vec<usize>>,
    /// The last digit of the stamps, in seconds, if they would be uneven but for its rounding: the coarsest one.
    pub rounded_to: Option<f64>,
}

impl Grid {
    pub fn of(record: &Record) -> Result<Self, DataError> {
        let time = &record.time;
        let all = |is_right: fn(f64, f64) -> bool| time.windows(2).all(|pair| is_right(pair[0], pair[1]));
        let increasing = all(|a, b| a < b);
        let Some(period) = median_period(time) else {
            return Err(DataError::signal(&record.name, "time", "there are fewer than two samples"));
        };
        let digits = last_digits(time);
        let is_fine = digits.iter().all(|digit| 2.0 * digit < period);
        let (first, last) = (time[0], time[time.len() - 1]);
        if increasing {
            if (last - first) / period > 20.0 * time.len() as f64 {
                let text = format!(
                    "{} samples {} s apart are spread over {} s: check the unit and the gaps of the time",
                    time.len(),
                    number(period),
                    number(last - first)
                );
                return Err(DataError::signal(&record.name, "time", text));
            }
            if let Some(grid) = Self::on(time, places(time, period), if is_fine { &digits } else { &[] }) {
                return Ok(grid);
            }
        }
        // Coarse stamps do not tell which sample is the next: each row is.
        let rows = || (0..time.len()).collect::<Vec<_>>();
        if !is_fine
            && all(|a, b| a <= b)
            && !is_printed_exactly(fit(time, &rows()), &digits)
            && let Some(grid) = Self::on(time, rows(), &digits)
        {
            return Ok(grid);
        }
        if !increasing {
            let text =
                "the times do not increase from sample to sample: sort the file and remove double rows";
            return Err(DataError::signal(&record.name, "time", text));
        }
        let period = loop_period(time, period);
        let step = snap(period).unwrap_or(period);
        let length = ((last - first) / step * (1.0 + 1e-12)) as usize + 1;
        Ok(Self { start: first, step, length, places: None, rounded_to: None })
    }

    /// The grid with these points of the samples, if all stamps are on it, but for the rounding of their digits.
    fn on(time: &[f64], places: Vec<usize>, digits: &[f64]) -> Option<Self> {
        let fitted = fit(time, &places);
        let candidates = [snap(fitted).unwrap_or(fitted), fitted];
        let offsets = |step: f64| time.iter().zip(&places).map(move |(t, &place)| t - step * place as f64);
        let digit = |sample: usize| digits.get(sample).copied().unwrap_or(0.0);
        let (start, step) = candidates.into_iter().find_map(|step| {
            let off = |sample: usize| (ON_GRID * step).max(0.5 * ROUNDED * digit(sample));
            let ends = |(low, high): (f64, f64), (sample, offset): (usize, f64)| {
                (low.max(offset - off(sample)), high.min(offset + off(sample)))
            };
            let (low, high) = offsets(step).enumerate().fold((f64::NEG_INFINITY, f64::INFINITY), ends);
            (low <= high).then_some((0.5 * (low + high), step))
        })?;
        // Rounding of the stamps is no reason for a start of 1e-17 s.
        let start = if (start - time[0]).abs() < 1e-9 * step { time[0] } else { start };
        let is_uneven = offsets(step).any(|offset| (offset - start).abs() > ON_GRID * step);
        let rounded_to = is_uneven.then(|| digits.iter().copied().fold(0.0, f64::max));
        let length = places.last().map_or(0, |last| last + 1);
        Some(Self { start, step, length, places: Some(places), rounded_to })
    }

    pub fn time(&self, place: usize) -> f64 {
        self.start + self.step * place as f64
    }
}

/// An even clock behind uneven stamps.
pub(crate) struct RoundedClock {
    /// Its period in seconds.
    pub period: f64,
    /// The last digit of its stamps in seconds, the coarsest one.
    pub digit: f64,
    /// Number of each sample.
    pub places: Vec<usize>,
}

/// The even clock behind time stamps that would be uneven but for the rounding of their last digit; none if they are even
/// without it, or not even with it.
pub(crate) fn rounded_clock(record: &Record) -> Option<RoundedClock> {
    let grid = Grid::of(record).ok()?;
    Some(RoundedClock { period: grid.step, digit: grid.rounded_to?, places: grid.places? })
}

/// The last digit of each printed time, in seconds: the largest power of ten of which all times of the same order are multiples.
/// Zero if it is less than a nanosecond. Programs print either a number of decimals or a number of digits, so that from one
/// order to the next the digit is the same or the next one.
fn last_digits(time: &[f64]) -> Vec<f64> {
    let order = |t: &f64| if *t == 0.0 { i32::MIN } else { t.abs().log10().floor() as i32 };
    let mut orders: BTreeMap<i32, Vec<f64>> = BTreeMap::new();
    time.iter().for_each(|t| orders.entry(order(t)).or_default().push(*t));
    let mut digits: BTreeMap<i32, f64> =
        orders.into_iter().map(|(order, times)| (order, common_digit(&times))).collect();
    let mut finest = f64::INFINITY;
    for digit in digits.values_mut().rev() {
        finest = finest.min(*digit);
        *digit = finest;
    }
    let mut before: Option<(i32, f64)> = None;
    for (order, digit) in &mut digits {
        if let Some((lower, finer)) = before {
            *digit = digit.min(finer * 10_f64.powi(order.saturating_sub(lower)));
        }
        before = (*order > i32::MIN).then_some((*order, *digit));
    }
    time.iter().map(|t| digits[&order(t)]).collect()
}

/// Whether a clock's period is a number of its last digits, so that rounding makes none of its stamps uneven.
fn is_printed_exactly(period: f64, digits: &[f64]) -> bool {
    let coarsest = digits.iter().copied().fold(0.0, f64::max);
    let count = period / coarsest;
    count.round() >= 1.0 && (count - count.round()).abs() * (digits.len() as f64) < 0.5
}

/// The largest power of ten, of a second or less, of which all times are multiples; zero if it is less than a nanosecond.
fn common_digit(times: &[f64]) -> f64 {
    let is_multiple = |t: &f64, digit: f64| {
        let count = t / digit;
        count.abs() < MOST_DIGITS && (count - count.round()).abs() < 1e-4
    };
    let digits = (0..=MOST_DECIMALS).map(|decimals| 10_f64.powi(-decimals));
    digits.into_iter().find(|digit| times.iter().all(|t| is_multiple(t, *digit))).unwrap_or(0.0)
}

/// Median of the differences of the times; none for fewer than two.
pub(crate) fn median_period(time: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// The period of samples that are on no even grid: the median of their differences. A program's loop takes the time that it takes:
/// where too many samples would be missing at that, it is the least multiple at which they are not.
fn loop_period(time: &[f64], median: f64) -> f64 {
    let multiples = (1..=LONGEST_LOOP).map(|number| f64::from(number) * median);
    let lengths = |period: f64| time.windows(2).map(move |pair| (pair[1] - pair[0]) / period);
    multiples.into_iter().find(|period| share_missing(lengths(*period)) <= MOST_MISSING).unwrap_or(median)
}

/// The period of a record's samples as its times have it, before it is rounded to a whole rate; none for fewer than two.
pub(crate) fn usual_period(record: &Record) -> Option<f64> {
    let median = median_period(&record.time)?;
    let is_uneven = Grid::of(record).is_ok_and(|it| it.places.is_none());
    Some(if is_uneven { loop_period(&record.time, median) } else { median })
}

/// The share of the samples that are missing, from the lengths of all intervals in periods.
pub(crate) fn share_missing(lengths: impl Iterator<Item = f64>) -> f64 {
    let lost = |length: f64| if length > GAP { length.round() - 1.0 } else { 0.0 };
    let (lost, all) = lengths.fold((0.0, 0.0), |(sum, all), it| (sum + lost(it), all + it));
    lost / all
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
