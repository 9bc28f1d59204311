//! The columns that were read of a file: what is to be told of them, and those that no signal of the rig comes from.

use crate::data::check::DataProblem;
use crate::data::map::{Map, Mapped, Taken};
use crate::data::uniform::uniform;
use crate::data::{Channel, Record};
use crate::report::findings::{ColumnRead, RecordRead};
use crate::report::words::digits;
use crate::rig::Rig;

use super::rate::along;

/// Samples per second below which a time without a unit is not believed to be in seconds: a wheel hops at 10 to 15 Hz.
const SLOWEST: f64 = 10.0;

/// Largest difference of a column from the signal that it repeats, in shares of its standard deviation.
const REPEATED: f64 = 0.1;

/// A rate that a file has beside its motion, where a map names the motion only: it was not asked for, and its sign is the
/// motion's. What was turned over.
pub fn follow(rig: &Rig, map: &Map, record: &mut Record) -> Vec<DataProblem> {
    let is_mapped = |signal: &str| {
        let names = std::iter::once(signal).chain(rig.kind.aliases(signal));
        names.map(|name| name.trim_start_matches('-')).any(|name| map.signals.contains_key(name))
    };
    let mut turned = Vec::new();
    for declared in &rig.plant.inputs {
        let Some(motion) = rig.rate_of(&declared.name).map(|index| rig.plant.inputs[index].name.as_str())
        else {
            continue;
        };
        let values = |name: &str| record.channels.iter().position(|channel| channel.name == name);
        let (Some(rate), Some(position)) = (values(&declared.name), values(motion)) else { continue };
        if is_mapped(&declared.name) || !is_mapped(motion) {
            continue;
        }
        if along(&record.channels[rate].values, &record.channels[position].values) < 0.0 {
            record.channels[rate].values.iter_mut().for_each(|it| *it = -*it);
            turned.push(DataProblem {
                record: record.name.clone(),
                signal: declared.name.clone(),
                text: format!(
                    "its column goes against {motion}, which the map names: it is turned over. To take it otherwise, name \
                     it in the map, too"
                ),
                fatal: false,
            });
        }
    }
    turned
}

/// That the unit of the time is in doubt: nobody says it, and in seconds no rig would be sampled so.
pub fn doubt(record: &Record, read: &RecordRead) -> Option<DataProblem> {
    (record.seconds_assumed && read.rate < SLOWEST).then(|| DataProblem {
        record: record.name.clone(),
        signal: "time".into(),
        text: format!(
            "the time has no unit, and in seconds that would be {} Hz for {} s, which no test of a suspension is: write the unit in \
             the header, such as `time [ms]`, or in the map, `time = {{ column = \"…\", unit = \"ms\" }}`; if it is in \
             seconds, `[s]`",
            digits(read.rate, 3),
            digits(read.seconds, 4)
        ),
        fatal: true,
    })
}

/// What was read of a file.
pub fn read(mapped: &Mapped) -> RecordRead {
    let Record { name, time, unread, notes, .. } = &mapped.record;
    let column = |taken: &Taken| ColumnRead {
        signal: taken.signal.clone(),
        column: taken.column.clone(),
        unit: taken.unit.clone(),
        unit_assumed: taken.assumed,
    };
    let seconds = time.last().zip(time.first()).map_or(0.0, |(last, first)| last - first);
    RecordRead {
        record: name.clone(),
        samples: time.len(),
        seconds,
        rate: if seconds > 0.0 { (time.len() - 1) as f64 / seconds } else { 0.0 },
        columns: mapped.taken.iter().map(column).collect(),
        unused: mapped.unused.iter().map(Channel::title).collect(),
        left_out: unread.iter().map(|it| format!("{}: {}", it.name, it.why)).collect(),
        notes: notes.clone(),
    }
}

/// Takes away columns that repeat a signal of the rig, perhaps in another unit, and tells it. The signal's errors would follow them
/// whatever their cause.
pub fn leave_out_copies(record: &Record, unused: &mut Vec<Channel>) -> Vec<DataProblem> {
    let mut told = Vec::new();
    unused.retain(|column| {
        let copied = record.channels.iter().find(|signal| {
            let common = correlation(&signal.values, &column.values).powi(2);
            common >= 1.0 - REPEATED.powi(2)
        });
        told.extend(copied.map(|signal| DataProblem {
            record: record.name.clone(),
            signal: column.title(),
            text: format!("goes with {}: it is taken for the same measurement and left out", signal.name),
            fatal: false,
        }));
        copied.is_none()
    });
    told
}

/// The correlation of two signals where both are known; zero if one is constant.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let known = || a.iter().zip(b).filter(|(a, b)| a.is_finite() && b.is_finite());
    let mean = |of: fn((&f64, &f64)) -> f64| known().map(of).sum::<f64>() / known().count().max(1) as f64;
    let means = (mean(|(a, _)| *a), mean(|(_, b)| *b));
    let sums = known().fold([0.0; 3], |[aa, ab, bb], (a, b)| {
        let (a, b) = (a - means.0, b - means.1);
        [aa + a * a, ab + a * b, bb + b * b]
    });
    if sums[0] > 0.0 && sums[2] > 0.0 { sums[1] / (sums[0] * sums[2]).sqrt() } else { 0.0 }
}

/// Columns that no signal of the rig is, on the even grid of the record; none that is constant, counts or has gaps.
pub fn others(time: &[f64], unused: Vec<Channel>) -> Vec<Channel> {
    let on_grid = |channel: Channel| {
        let record = Record { time: time.to_vec(), channels: vec![channel], ..Record::default() };
        let (even, _) = uniform(&record).ok()?;
        let channel = even.channels.into_iter().next()?;
        let says_something = !is_constant(&channel.values) && !is_count(&channel.values);
        (channel.values.iter().all(|it| it.is_finite()) && says_something).then_some(channel)
    };
    unused.into_iter().filter_map(on_grid).collect()
}

/// Whether a signal shows one value only.
pub fn is_constant(values: &[f64]) -> bool {
    let mut known = values.iter().filter(|value| value.is_finite());
    known.next().is_some_and(|first| known.all(|value| value == first))
}

/// Whether evenly sampled values count the samples: within one of them on the straight line from the first to the last.
fn is_count(values: &[f64]) -> bool {
    let [first, .., last] = *values else { return false };
    let rise = (last - first) / (values.len() - 1) as f64;
    values.iter().enumerate().all(|(k, value)| (value - first - rise * k as f64).abs() <= rise.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(columns: &[(&str, Vec<f64>)]) -> Record {
        let channel = |(name, values): &(&str, Vec<f64>)| Channel {
            name: (*name).into(),
            unit: String::new(),
            values: values.clone(),
        };
        let time = (0..columns[0].1.len()).map(|k| 0.01 * k as f64).collect();
        let channels = columns.iter().map(channel).collect();
        Record { name: "run.csv".into(), time, channels, ..Record::default() }
    }

    #[test]
    fn a_count_says_nothing_and_a_ramp_with_noise_does() {
        let count: Vec<f64> = (0..50).map(|k| 7.0 + f64::from(k)).collect();
        assert!(is_count(&count) && !is_count(&[1.0]));
        let rough = count.iter().map(|it| it + 3.0 * (1.3 * it).sin()).collect::<Vec<_>>();
        assert!(!is_count(&rough));
        let time: Vec<f64> = (0..50).map(|k| 0.01 * f64::from(k)).collect();
        let channel =
            |name: &str, values: Vec<f64>| Channel { name: name.into(), unit: String::new(), values };
        let kept = others(&time, vec![channel("Sample Number", count), channel("Temperature", rough)]);
        assert_eq!(kept.iter().map(|it| it.name.as_str()).collect::<Vec<_>>(), ["Temperature"]);
    }

    #[test]
    fn a_velocity_beside_a_position_that_is_mapped_has_its_sign() {
        let rig = Rig::published("element-dyno").unwrap();
        let position: Vec<f64> = (0..200).map(|k| (0.1 * f64::from(k)).sin()).collect();
        let against: Vec<f64> = (0..200).map(|k| -10.0 * (0.1 * f64::from(k)).cos()).collect();
        let columns = [("motion.position", position), ("motion.velocity", against.clone())];
        let mut given = record(&columns);
        let map = Map::parse("[signals]\n\"motion.position\" = \"Weg\"").unwrap();
        let told = follow(&rig, &map, &mut given);
        assert!(told.len() == 1 && told[0].text.contains("turned over"), "{told:?}");
        assert!(given.channels[1].values.iter().zip(&against).all(|(turned, it)| *turned == -it));
        // Now it goes with the position; and what the map names is taken as it is.
        assert!(follow(&rig, &map, &mut given).is_empty());
        let both =
            Map::parse("[signals]\n\"motion.position\" = \"Weg\"\n\"motion.velocity\" = \"v\"").unwrap();
        assert!(follow(&rig, &both, &mut record(&columns)).is_empty());
        assert!(follow(&rig, &Map::default(), &mut record(&columns)).is_empty());
    }

    #[test]
    fn a_column_that_repeats_a_signal_in_another_unit_is_left_out() {
        let wave = |k: i32, frequency: f64| (frequency * f64::from(k)).sin();
        let force: Vec<f64> = (0..500).map(|k| if k == 3 { f64::NAN } else { 90.0 * wave(k, 0.1) }).collect();
        let channel = |name: &str, unit: &str, values: Vec<f64>| Channel {
            name: name.into(),
            unit: unit.into(),
            values,
        };
        let volts = force.iter().map(|it| 2.5 - 0.01 * it).collect();
        // A pressure that makes the force but for a tenth of its power, which is another measurement; and a constant.
        let pressure = force.iter().zip(0..).map(|(it, k)| it + 30.0 * wave(k, 0.37)).collect::<Vec<f64>>();
        let mut unused = vec![
            channel("Force", "V", volts),
            channel("p", "bar", pressure),
            channel("Supply", "V", vec![5.0; 500]),
        ];
        let told = leave_out_copies(&record(&[("force", force)]), &mut unused);
        assert_eq!(unused.iter().map(|it| it.name.as_str()).collect::<Vec<_>>(), ["p", "Supply"]);
        assert!(
            told.len() == 1 && told[0].signal == "Force [V]" && told[0].text.contains("force"),
            "{told:?}"
        );
    }

    #[test]
    fn seconds_that_no_rig_would_take_are_doubted() {
        let read = |rate| RecordRead {
            record: "run.csv".into(),
            samples: 3000,
            seconds: 3000.0 / rate,
            rate,
            columns: vec![],
            unused: vec![],
            left_out: vec![],
            notes: vec![],
        };
        let assumed = Record { seconds_assumed: true, ..Record::default() };
        let doubted = doubt(&assumed, &read(0.3)).unwrap();
        assert!(doubted.fatal && doubted.text.contains("0.300 Hz for"), "{}", doubted.text);
        assert!(doubt(&assumed, &read(100.0)).is_none() && doubt(&Record::default(), &read(0.3)).is_none());
    }
}
