//! Files of records on a rig's inputs and outputs.

use std::ops::Range;

use crate::data::check::DataProblem;
use crate::data::check::{Checked, check, lines, noise_at_rest, noise_floor, rounding, standstill};
use crate::data::map::{Map, Wanted};
use crate::data::repair::{leave_out_repeated, remove_absurd, remove_spikes};
use crate::data::{
    Channel, Origin, Record,
    uniform::{Uniform, uniform},
};
use crate::dataset::recorded::{Dataset, Measured, Source};
use crate::plant::Between;
use crate::report::findings::RecordRead;
use crate::report::words::quantity;
use crate::rig::{Opposed, Rig};

use super::columns::{doubt, follow, is_constant, leave_out_copies, others, read};
use super::driven::{instead, of_part};

/// Samples that a record needs.
pub(super) const FEWEST: usize = 100;

/// Share of a signal's samples up to which those that its sensor got wrong are left out, rather than the signal.
const MOST_LEFT_OUT: f64 = 0.2;

/// A record on a rig, with what is to be said about the data.
pub(super) struct Imported {
    /// The record; none if it cannot be used.
    pub recorded: Option<Dataset>,
    /// What is wrong with the data.
    pub problems: Vec<DataProblem>,
    /// How the file was read.
    pub read: RecordRead,
}

/// Reads a file and finds the rig's signals in it.
///
/// # Errors
/// If the file cannot be read, or has not the signals that the rig needs: what to do.
pub(super) fn import(rig: &Rig, origin: &Origin, map: &Map, rate: Option<&str>) -> Result<Imported, String> {
    let mut record = origin.read(&map.reading).map_err(|error| error.to_string())?;
    oppose(rig, &mut record, map);
    let wanted = wanted(rig);
    let map = &of_part(rig, map, &wanted);
    let mut mapped = map.apply(record, &wanted).map_err(|error| error.to_string())?;
    let name = mapped.record.name.clone();
    let titles = |unused: &[Channel]| unused.iter().map(Channel::title).collect::<Vec<String>>();
    missing(rig, &mapped.record, &name, &titles(&mapped.unused))?;
    let read = read(&mapped);
    let turned = follow(rig, map, &mut mapped.record);
    let absurd = remove_absurd(&mut mapped.record);
    let repeated = leave_out_repeated(&mut mapped.record, &mut mapped.unused);
    let Checked { mut problems, unusable } = check(&mapped.record);
    problems.extend(turned.into_iter().chain(absurd).chain(repeated));
    problems.extend(doubt(&mapped.record, &read));
    problems.extend(leave_out_copies(&mapped.record, &mut mapped.unused));
    let unused = titles(&mapped.unused);
    if !unused.is_empty() {
        problems.push(DataProblem {
            record: name.clone(),
            signal: unused.join(", "),
            text: "no signal of the rig has this name: it is compared with the missing signal only. To use it, name it \
                   in a map (--map)"
                .into(),
            fatal: false,
        });
    }
    if problems.iter().any(|problem| problem.fatal) {
        return Ok(Imported { recorded: None, problems, read });
    }
    for (channel, wrong) in mapped.record.channels.iter_mut().zip(&unusable) {
        // What an output shows there is not compared; an input has to drive the model there, too.
        if rig.plant.input(&channel.name).is_some() {
            remove_spikes(channel, wrong);
        }
    }
    let (uniform, resampled) = uniform(&mapped.record).map_err(|error| error.to_string())?;
    problems.extend(resampled);
    let drives = |name: &str| rig.plant.input(name).is_some();
    problems.extend(lines(&mapped.record, drives));
    let values = |name: &str| {
        let channel = uniform.channels.iter().find(|channel| channel.name == name);
        channel.map(|channel| channel.values.clone())
    };
    let moved = rig.driven().and_then(|by| rig.plant.input(&by.input));
    let measured_rate =
        |name: &str| rate.filter(|_| moved.is_some() && rig.rate_of(name) == moved).and_then(values);
    let mut inputs: Vec<Source> = Vec::new();
    let without_mean = rig.without_mean();
    for declared in &rig.plant.inputs {
        inputs.push(match values(&declared.name).or_else(|| measured_rate(&declared.name)) {
            Some(mut values) if without_mean == Some(declared.name.as_str()) => {
                let mean = centre(&mut values);
                problems.push(DataProblem {
                    record: name.clone(),
                    signal: declared.name.clone(),
                    text: format!(
                        "its mean of {} is taken for the sensor's offset: a base that stays in its place has none",
                        quantity(mean, declared.unit.symbol)
                    ),
                    fatal: false,
                });
                Source::Measured(values)
            }
            Some(values) => Source::Measured(values),
            // A rate is declared after its motion.
            None => rig
                .rate_of(&declared.name)
                .filter(|other| !matches!(inputs[*other], Source::Constant(_)))
                .map_or(Source::Constant(declared.start), Source::DerivativeOf),
        });
    }
    let outputs = rig.plant.outputs.iter().enumerate().filter(|(_, it)| !rig.is_trivial(&it.name));
    let rest = standstill(&mapped.record);
    let measured = outputs.filter_map(|(output, declared)| {
        let mut values = values(&declared.name)?;
        if is_constant(&values) {
            problems.push(DataProblem {
                record: name.clone(),
                signal: declared.name.clone(),
                text: "constant: it is not compared with the model".into(),
                fatal: false,
            });
            return None;
        }
        let raw = mapped.record.channels.iter().zip(&unusable).find(|(it, _)| it.name == declared.name);
        let (raw, wrong) = raw.map_or((&[][..], &[][..]), |(channel, ranges)| (&channel.values[..], ranges));
        // Interpolated to an even grid, values no longer show the steps of their converter.
        let at_rest = rest.clone().map_or(0.0, |rest| noise_at_rest(raw.get(rest).unwrap_or_default()));
        let noise_floor = noise_floor(&values).max(rounding(raw)).max(at_rest);
        let left_out = leave_out(&mut values, wrong, &mapped.record.time, &uniform);
        if left_out > 0 {
            let enough = left_out as f64 <= MOST_LEFT_OUT * values.len() as f64;
            let what = if enough { "they are" } else { "the signal is" };
            problems.push(DataProblem {
                record: name.clone(),
                signal: declared.name.clone(),
                text: format!(
                    "{left_out} of its {} samples are wrong in this way: {what} not compared with the model",
                    values.len()
                ),
                fatal: false,
            });
            if !enough {
                return None;
            }
        }
        Some(Measured { output, values, noise_floor })
    });
    let measured: Vec<Measured> = measured.collect();
    if measured.is_empty() {
        problems.push(DataProblem {
            record: name,
            signal: "all outputs".into(),
            text: "no output is left to compare with the model: each is constant or has too many wrong samples. See the \
                   other notes on this record, mend the sensors or their ranges, and record again"
                .into(),
            fatal: true,
        });
        return Ok(Imported { recorded: None, problems, read });
    }
    let sections = sections(&uniform.segments, uniform.step, rig.segment());
    Ok(Imported {
        recorded: Some(Dataset {
            name,
            step: uniform.step,
            inputs,
            between: Between::Lines,
            wide: None,
            imposed: rig.imposes_motion(),
            measured,
            others: others(&mapped.record.time, mapped.unused),
            errors: vec![],
            sections,
        }),
        problems,
        read,
    })
}

/// Takes the mean away from the known values, and tells it.
fn centre(values: &mut [f64]) -> f64 {
    let (count, sum) =
        values.iter().filter(|it| it.is_finite()).fold((0, 0.0), |(n, sum), it| (n + 1, sum + it));
    let mean = sum / f64::from(count.max(1));
    values.iter_mut().for_each(|it| *it -= mean);
    mean
}

/// Takes away the values on the even grid that come from ranges of the file's samples, and tells how many there were.
fn leave_out(values: &mut [f64], ranges: &[Range<usize>], time: &[f64], grid: &Uniform) -> usize {
    let mut count = 0;
    for range in ranges {
        // Up to the middle between its samples and their neighbours.
        let edge = |sample: usize| {
            (sample > 0 && sample < time.len()).then(|| 0.5 * (time[sample - 1] + time[sample]))
        };
        let place =
            |time: f64| (((time - grid.start) / grid.step).ceil().max(0.0) as usize).min(values.len());
        let (first, last) = (edge(range.start).map_or(0, place), edge(range.end).map_or(values.len(), place));
        for value in values[first..last].iter_mut().filter(|value| value.is_finite()) {
            *value = f64::NAN;
            count += 1;
        }
    }
    count
}

/// Turns a signal over that is recorded in the sense of another one, unless a map says what it is.
fn oppose(rig: &Rig, record: &mut Record, map: &Map) {
    let Some(Opposed { column, signal }) = &rig.kind.opposed else { return };
    let named = |name: &str, other: &str| name.trim().eq_ignore_ascii_case(other);
    if map.signals.is_empty() && record.channels.iter().any(|channel| named(&channel.name, column)) {
        for channel in record.channels.iter_mut().filter(|channel| named(&channel.name, signal)) {
            channel.values.iter_mut().for_each(|value| *value = -*value);
        }
    }
}

/// Every signal of a rig with the names that it may have.
fn wanted(rig: &Rig) -> Vec<Wanted> {
    // What follows from the inputs the way the rig is driven has its column all the same: it explains nothing.
    let shows = |name: &String| !rig.kind.follows_inputs.contains(name) && !rig.taken.contains(name);
    let outputs = rig.plant.outputs.iter().filter(|it| shows(&it.name));
    let driven = rig.driven();
    rig.plant
        .inputs
        .iter()
        .filter(|declared| !rig.is_idle(&declared.name))
        .chain(outputs)
        .map(|declared| {
            let columns = driven.filter(|it| it.input == declared.name).map_or(&[][..], |it| &it.columns);
            // A column that drives the rig is not what it did, too.
            let aliases = rig.kind.aliases(&declared.name);
            let aliases = aliases.filter(|it| !rig.taken.iter().any(|taken| taken == it));
            let aliases = aliases.chain(columns.iter().map(String::as_str));
            Wanted {
                name: declared.name.clone(),
                unit: declared.unit.symbol.into(),
                aliases: aliases.map(str::to_owned).collect(),
            }
        })
        .collect()
}

/// Refuses a record that does not tell what drove the rig, or nothing of what it did.
fn missing(rig: &Rig, record: &Record, name: &str, unused: &[String]) -> Result<(), String> {
    let has = |declared: &str| record.channels.iter().any(|channel| channel.name == declared);
    let hint = if unused.is_empty() {
        String::new()
    } else {
        format!("; the columns {} are not used: name them in a map (--map)", unused.join(", "))
    };
    if !rig.plant.inputs.iter().any(|declared| has(&declared.name)) {
        let inputs: Vec<&str> = rig.plant.inputs.iter().map(|declared| declared.name.as_str()).collect();
        let instead = instead(rig)?;
        return Err(format!(
            "{name}: no column says what drove the rig; one of {} is needed{instead}{hint}",
            inputs.join(", ")
        ));
    }
    let outputs = rig.plant.outputs.iter().map(|declared| declared.name.as_str());
    let outputs: Vec<&str> = outputs.filter(|name| !rig.is_trivial(name)).collect();
    if !outputs.iter().any(|name| has(name)) {
        return Err(format!(
            "{name}: no column says what the rig did; one of {} is needed{hint}",
            outputs.join(", ")
        ));
    }
    Ok(())
}

/// Ranges of at most `seconds` and about equal length.
fn sections(segments: &[Range<usize>], step: f64, seconds: f64) -> Vec<Range<usize>> {
    let longest = (seconds / step).max(FEWEST as f64);
    let mut sections = Vec::new();
    for segment in segments.iter().filter(|segment| segment.len() >= FEWEST) {
        let parts = ((segment.len() as f64 / longest).ceil() as usize).max(1);
        for part in 0..parts {
            let at = |part: usize| segment.start + segment.len() * part / parts;
            sections.push(at(part)..at(part + 1));
        }
    }
    sections
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Channel, Record};

    #[test]
    fn a_mean_is_that_of_the_known_values() {
        let mut values = [1.0, f64::NAN, 4.0];
        assert_eq!(centre(&mut values), 2.5);
        assert!(values[0] == -1.5 && values[1].is_nan() && values[2] == 1.5);
    }

    #[test]
    fn one_value_and_gaps_are_constant() {
        assert!(
            is_constant(&[2.0, f64::NAN, 2.0]) && !is_constant(&[2.0, 2.0, 2.1]) && !is_constant(&[f64::NAN])
        );
    }

    /// Sample 3 of the file is missing, so that its later samples stand one place further on the even grid.
    #[test]
    fn wrong_samples_of_a_file_are_left_out_where_they_stand_on_the_even_grid() {
        let time: Vec<f64> = (0..400).filter(|k| *k != 3).map(|k| 0.01 * f64::from(k)).collect();
        let values: Vec<f64> = time.iter().map(|t| t.sin()).collect();
        let channels = vec![Channel { name: "x".into(), unit: "m".into(), values }];
        let (grid, _) = uniform(&Record { time: time.clone(), channels, ..Record::default() }).unwrap();
        let mut values = grid.channels[0].values.clone();
        let wrong = [0..1, 9..12, 398..399];
        assert_eq!(leave_out(&mut values, &wrong, &time, &grid), 5);
        let left: Vec<usize> = (0..values.len()).filter(|k| values[*k].is_nan()).collect();
        assert_eq!(left, [0, 10, 11, 12, 399]);
    }
}
