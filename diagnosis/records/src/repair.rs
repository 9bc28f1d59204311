//! What is put right in a record before it is used, since nothing has to be guessed for it.

use std::ops::Range;

use super::check::{DataProblem, number};
use super::uniform::BRIDGED;
use super::{Channel, Record};

/// Beyond this, a number is no measurement in any unit: its square or a product of two of them is soon beyond all numbers.
const LARGEST: f64 = 1e30;
/// Rows that keep all values of the row before, as a share of all rows, from which values are held.
const HELD: f64 = 0.6;
/// Share of the changes that come as regularly as the others, within a row, if the same clock makes all of them.
const REGULAR: f64 = 0.9;

/// Takes numbers away that nothing measures; they are missing then.
pub fn remove_absurd(record: &mut Record) -> Vec<DataProblem> {
    let mut problems = Vec::new();
    for channel in &mut record.channels {
        let absurd = |value: &f64| value.abs() > LARGEST;
        let Some(first) = channel.values.iter().position(absurd) else { continue };
        let count = channel.values.iter().filter(|it| absurd(it)).count();
        let text = format!(
            "{count} values are larger than {LARGEST:e}, the first in sample {}: nothing measures that; they are taken \
             for missing ones",
            first + 1
        );
        channel.values.iter_mut().filter(|it| absurd(it)).for_each(|it| *it = f64::NAN);
        problems.push(DataProblem {
            record: record.name.clone(),
            signal: channel.name.clone(),
            text,
            fatal: false,
        });
    }
    problems
}

/// Leaves out the rows that only repeat the values of the row before, where a logger writes each value several times: to a model, a
/// staircase is a fast motion. `further` are columns over the same times. Rows at rest are kept as often as the others.
pub fn leave_out_repeated(record: &mut Record, further: &mut [Channel]) -> Option<DataProblem> {
    let kept = rows_that_are_new(&record.channels, record.time.len())?;
    let times = record.time.len() as f64 / kept.len() as f64;
    let chosen = |values: &[f64]| kept.iter().map(|row| values[*row]).collect::<Vec<f64>>();
    record.time = chosen(&record.time);
    for channel in record.channels.iter_mut().chain(further) {
        channel.values = chosen(&channel.values);
    }
    Some(DataProblem {
        record: record.name.clone(),
        signal: "all".into(),
        text: format!(
            "the file has each value {} times: one row of each is used; record at the rate at which the values come",
            number(times)
        ),
        fatal: false,
    })
}

/// The rows with new values, and as many rows where nothing is new for longer; none if values are not held, or not evenly. Columns may
/// be new within a third of the period of each other: the last of them counts.
fn rows_that_are_new(channels: &[Channel], rows: usize) -> Option<Vec<usize>> {
    let news = channels.iter().map(|it| rows_of_changes(&it.values)).filter(|it| it.len() > 1);
    let news: Vec<Vec<usize>> = news.collect();
    let period = news.iter().map(|it| usual_gap(it)).min()?;
    let mut all: Vec<usize> = news.concat();
    all.sort_unstable();
    all.dedup();
    let is_last = |place: usize| all.get(place + 1).is_none_or(|next| 3 * (next - all[place]) > period);
    let new: Vec<usize> = (0..all.len()).filter(|place| is_last(*place)).map(|place| all[place]).collect();
    if period < 2 || new.len() < 2 || (rows - new.len()) as f64 <= HELD * rows as f64 {
        return None;
    }
    let usual = usual_gap(&new);
    let regular = new.windows(2).filter(|pair| (pair[1] - pair[0]).abs_diff(usual) <= 1).count();
    if (regular as f64) < REGULAR * (new.len() - 1) as f64 {
        return None;
    }
    let mut kept: Vec<usize> = (0..new[0]).rev().skip(usual - 1).step_by(usual).collect();
    kept.reverse();
    for (place, row) in new.iter().enumerate() {
        let next = new.get(place + 1).copied().unwrap_or(rows);
        // What follows within half a period is the next new row itself.
        let rest = (*row..next).step_by(usual).filter(|it| it == row || next - it > usual / 2);
        kept.extend(rest);
    }
    Some(kept)
}

/// The rows in which a column has another value than in the row before.
fn rows_of_changes(values: &[f64]) -> Vec<usize> {
    (1..values.len()).filter(|row| values[*row] != values[*row - 1]).collect()
}

/// The median of the gaps between two or more rows.
fn usual_gap(rows: &[usize]) -> usize {
    let mut gaps: Vec<usize> = rows.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = gaps.len() / 2;
    *gaps.select_nth_unstable(middle).1
}

/// Takes single samples away that a sensor got wrong, so that they are interpolated.
pub fn remove_spikes(channel: &mut Channel, wrong: &[Range<usize>]) {
    for range in wrong.iter().filter(|it| it.len() <= BRIDGED) {
        channel.values[range.clone()].fill(f64::NAN);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn record(values: Vec<f64>) -> Record {
        let time = (0..values.len()).map(|row| row as f64 * 1e-3).collect();
        let channel = Channel { name: "x".into(), unit: "m".into(), values };
        Record { name: "a.csv".into(), time, channels: vec![channel], ..Record::default() }
    }

    #[test]
    fn a_number_that_nothing_measures_is_missing() {
        let mut record = record(vec![1.0, -1e240, 2.0, f64::INFINITY]);
        let problems = remove_absurd(&mut record);
        assert!(problems.len() == 1 && problems[0].text.starts_with("2 values"), "{problems:?}");
        let values = &record.channels[0].values;
        assert!(values[0] == 1.0 && values[1].is_nan() && values[2] == 2.0 && values[3].is_nan());
    }

    #[test]
    fn a_spike_is_missing_and_a_long_fault_stays() {
        let mut channel = record((0..20).map(f64::from).collect()).channels.remove(0);
        remove_spikes(&mut channel, &[3..4, 8..16]);
        let missing: Vec<usize> = (0..20).filter(|row| channel.values[*row].is_nan()).collect();
        assert_eq!(missing, [3]);
    }

    proptest! {
        #[test]
        fn held_values_are_had_back(
            values in prop::collection::vec(-1e3..1e3_f64, 60..200),
            times in 4_usize..20,
            rest in 0_usize..4,
        ) {
            // For some periods, nothing moves.
            let mut rare: Vec<f64> = values.clone();
            rare.splice(10..10, std::iter::repeat_n(rare[9], rest));
            let held: Vec<f64> = rare.iter().flat_map(|it| std::iter::repeat_n(*it, times)).collect();
            let mut record = record(held);
            // Another column comes a row later.
            let mut late = record.channels[0].clone();
            late.values.rotate_right(1);
            late.values[0] = late.values[1];
            record.channels.push(late);
            let mut further = vec![Channel { values: record.time.clone(), ..Channel::default() }];
            prop_assert!(leave_out_repeated(&mut record, &mut further).is_some());
            let periods: Vec<f64> = record.time.windows(2).map(|it| (it[1] - it[0]) * 1e3).collect();
            prop_assert!(periods.iter().all(|it| (it - times as f64).abs() < 1e-6), "{periods:?}");
            prop_assert!(record.channels.iter().all(|it| it.values == rare));
            prop_assert_eq!(&record.time, &further[0].values);
        }

        #[test]
        fn values_that_repeat_by_chance_stay(levels in prop::collection::vec(0_u8..3, 300)) {
            let mut record = record(levels.into_iter().map(f64::from).collect());
            let before = record.clone();
            prop_assert!(leave_out_repeated(&mut record, &mut []).is_none());
            prop_assert_eq!(record, before);
        }
    }

    #[test]
    fn a_slow_signal_of_few_steps_is_none_that_is_held() {
        let values = (0..4000).map(|row| (3.0 * (f64::from(row) * 3e-3).sin()).round()).collect();
        assert!(leave_out_repeated(&mut record(values), &mut []).is_none());
    }
}
