use super::*;
use proptest::prelude::*;
use std::f64::consts::TAU;

use strut_signal::random::{multisine, white};

const N: usize = 3000;

/// Three clean noisy signals at 1 kHz.
fn clean(seed: u64, sigma: f64) -> Record {
    let channel = |k: u64, name: &str, scale: f64| {
        let noise = white(seed ^ (k << 32), N);
        let values = multisine(seed + k, N).iter().zip(noise).map(|(s, n)| scale * (s + sigma * n)).collect();
        Channel { name: name.into(), unit: "m".into(), values }
    };
    let time = (0..N).map(|i| 1e-3 * i as f64).collect();
    Record {
        name: "run.csv".into(),
        time,
        channels: vec![channel(1, "x", 1.0), channel(2, "y", 40.0), channel(3, "z", 1e-3)],
        ..Record::default()
    }
}

/// The only problem of a record: its signal, text and whether it is fatal.
fn only(record: &Record) -> (String, String, bool) {
    let found = check(record).problems;
    let [problem] = &found[..] else { panic!("{found:#?}") };
    assert_eq!(problem.record, "run.csv");
    (problem.signal.clone(), problem.text.clone(), problem.fatal)
}

proptest! {
    #[test]
    fn clean_records_have_no_problems(seed in 0_u64..1_000_000, sigma in 1e-4..0.5_f64) {
        prop_assert_eq!(check(&clean(seed, sigma)).problems, []);
    }

    #[test]
    fn clean_records_on_a_lattice_have_no_problems(seed in 0_u64..1_000_000, levels in 100.0..5000.0_f64) {
        let mut record = clean(seed, 0.01);
        for value in &mut record.channels[0].values {
            *value = (*value * levels / 4.0).round() / levels * 4.0;
        }
        prop_assert_eq!(check(&record).problems, []);
    }

    #[test]
    fn nothing_makes_it_panic(
        time in prop::collection::vec(any::<f64>(), 200..260), step in any::<bool>(),
        values in prop::collection::vec(prop_oneof![any::<f64>(), Just(0.0), Just(1.0), Just(f64::NAN)], 260)
    ) {
        let n = time.len();
        let time = if step { (0..n).map(|i| i as f64).collect() } else { time };
        let channel = Channel { name: "x".into(), unit: String::new(), values: values[..n].to_vec() };
        let _ = check(&Record { name: "run.csv".into(), time, channels: vec![channel], ..Record::default() });
    }
}

#[test]
fn switched_commands_are_no_faults() {
    let mut record = clean(5, 0.01);
    for (i, value) in record.channels[0].values.iter_mut().enumerate() {
        *value = if (i / 37) % 3 == 0 { 5.0 } else { -5.0 };
    }
    for (i, value) in record.channels[1].values.iter_mut().enumerate() {
        *value = [0.0, 3.0, 1.0, 6.0, 2.0, 5.0][i / 500];
    }
    assert_eq!(check(&record).problems, []);
}

#[test]
fn the_signals_of_healthy_rigs_are_no_faults() {
    let shapes: [fn(f64) -> f64; 7] = [
        |t| (TAU * 5.0 * t).sin(), // a sine without noise, 200 samples a period
        |t| 2.0 * (2.0 * (0.7 * t).fract() - 1.0).abs() - 1.0, // triangle
        |t| (TAU * (1.0 + 8.0 * t) * t).sin(), // chirp
        |t| (TAU * 1.3 * t).sin().signum() * (1.0 + 0.1 * t), // friction
        |t| (-20.0 * (t % 0.5)).exp() * (TAU * 60.0 * (t % 0.5)).sin(), // impacts that ring down
        |t| (TAU * 0.8 * t).sin() - (TAU * 0.8 * t).sin().clamp(-0.9, 0.9), // events, otherwise at rest
        |t| if t < 0.8 { 0.0 } else { (TAU * 3.0 * (t - 0.8)).sin() }, // rest, then motion
    ];
    for sigma in [0.0, 0.003, 0.05] {
        let mut record = clean(5, 0.01);
        for (k, shape) in shapes.into_iter().enumerate() {
            let noise = white(k as u64, N);
            let values = record.time.iter().zip(noise).map(|(&t, n)| shape(t) + sigma * n).collect();
            record.channels.push(Channel { name: format!("shape {k}"), unit: "m".into(), values });
        }
        assert_eq!(check(&record).problems, [], "noise {sigma}");
        for channel in &mut record.channels {
            channel.values.iter_mut().for_each(|value| *value = (*value * 500.0).round() / 500.0);
        }
        record.channels.remove(2); // Its values are as small as the steps.
        assert_eq!(check(&record).problems, [], "noise {sigma}, rounded");
    }
}

#[test]
fn too_short() {
    let mut record = clean(1, 0.01);
    record.time.truncate(150);
    let (signal, text, fatal) = only(&record);
    assert_eq!((signal.as_str(), fatal), ("time", true));
    assert!(text.starts_with("only 150 samples"));
}

#[test]
fn broken_times_are_fatal() {
    for (sample, value, word) in [
        (
            700,
            clean(1, 0.01).time[699],
            "1 samples have the time of the sample before, the first is sample 701 at 0.699 s",
        ),
        (700, 0.1, "the time goes back at 1 samples, first at sample 701 to 0.1 s"),
        (700, f64::NAN, "1 samples have no time, the first is sample 701"),
    ] {
        let mut record = clean(1, 0.01);
        record.time[sample] = value;
        let (signal, text, fatal) = only(&record);
        assert_eq!((signal.as_str(), fatal), ("time", true));
        assert!(text.starts_with(word), "{text}");
    }
}

#[test]
fn jitter() {
    let mut record = clean(1, 0.01);
    for (t, n) in record.time.iter_mut().zip(white(4, N)) {
        *t += 2e-5 * n;
    }
    record.time[900] += 3e-4;
    let (signal, text, fatal) = only(&record);
    assert_eq!((signal.as_str(), fatal), ("time", false));
    assert!(text.contains("after 0.9003 s"), "{text}");
    assert!(text.starts_with("the time stamps jitter"), "{text}");
}

fn without(record: &mut Record, gap: Range<usize>) {
    record.time.drain(gap.clone());
    for channel in &mut record.channels {
        channel.values.drain(gap.clone());
    }
}

#[test]
fn gaps() {
    let mut record = clean(1, 0.01);
    without(&mut record, 1501..1551);
    without(&mut record, 501..503);
    let (signal, text, fatal) = only(&record);
    assert_eq!((signal.as_str(), fatal), ("time", false));
    assert_eq!(
        text,
        "2 gaps in the time, after 0.5 s, 1.5 s; the longest lasts 0.051 s; 1.73 % of the samples are missing"
    );
    without(&mut record, 1600..2000);
    let (_, text, fatal) = only(&record);
    assert!(fatal && text.ends_with("record again"), "{text}");
}

#[test]
fn missing_samples() {
    let mut record = clean(1, 0.01);
    record.channels[1].values[200] = f64::NAN;
    record.channels[1].values[1000..1010].fill(f64::NAN);
    let (signal, text, fatal) = only(&record);
    assert_eq!((signal.as_str(), fatal), ("y", false));
    assert_eq!(text, "11 samples are missing (0.37 %), the first at 0.2 s, at most 10 in a row at 1 s");
    record.channels[1].values[1000..1400].fill(f64::NAN);
    assert!(only(&record).2);
    record.channels[1].values.fill(f64::NAN);
    assert_eq!(only(&record), ("y".into(), "has no samples: leave it out".into(), true));
}

#[test]
fn saturation() {
    for (limit, word) in [(1.5, "highest"), (-1.5, "lowest")] {
        let mut record = clean(1, 0.001);
        for value in &mut record.channels[0].values {
            *value = if limit > 0.0 { value.min(limit) } else { value.max(limit) };
        }
        let (signal, text, fatal) = only(&record);
        assert_eq!((signal.as_str(), fatal), ("x", false));
        assert!(text.starts_with(&format!("is flat at its {word} value {limit} m for ")), "{text}");
    }
    // On a lattice, as a converter has it.
    let mut record = clean(1, 0.001);
    for value in &mut record.channels[0].values {
        *value = (value.clamp(-1.5, 1.5) * 1000.0).round() / 1000.0;
    }
    assert_eq!(check(&record).problems.len(), 2);
}

/// A command in steps, the highest of which is not the only one that stays.
#[test]
fn a_stepped_command_is_not_saturated() {
    let mut record = clean(1, 0.001);
    let levels = [0.0, 0.3, -0.2, 0.6, 0.1, -0.5, 0.4, 0.6, -0.1];
    for (k, value) in record.channels[0].values.iter_mut().enumerate() {
        // Between two steps it goes along a ramp.
        let (number, within) = (k / 40, k % 40);
        let [from, to] = [number, number + 1].map(|it| levels[it % levels.len()]);
        *value = from + (to - from) * (within as f64 / 30.0).min(1.0);
    }
    assert!(check(&record).problems.iter().all(|it| !it.text.contains("saturated")), "{record:?}");
}

/// Kicks of a controller's derivative of all sizes, or many, are what the signal does; few that are as large would be faults.
#[test]
fn kicks_of_all_sizes_are_no_spikes() {
    let kicks = |every: usize, size: &dyn Fn(usize) -> f64| {
        let mut record = clean(1, 0.01);
        for k in (20..record.channels[2].values.len() - 20).step_by(every) {
            record.channels[2].values[k] += size(k);
        }
        check(&record).problems.iter().any(|it| it.text.contains("spikes"))
    };
    // Twice as high is a quarter as often.
    assert!(!kicks(30, &|k| 0.15 / (0.01 + (k as f64 * 0.618).fract()).sqrt()));
    assert!(kicks(120, &|_| 5.0) && !kicks(40, &|_| 5.0));
}

/// A carriage that friction holds where it turns, behind a coarse encoder: it creeps to there and off again.
#[test]
fn where_a_coarse_signal_creeps_to_its_highest_value_it_is_not_saturated() {
    const MOVES: f64 = 600.0;
    const RESTS: f64 = 400.0;
    let mut record = clean(1, 0.01);
    let ease = |share: f64| share * share * (3.0 - 2.0 * share);
    for (k, value) in record.channels[2].values.iter_mut().enumerate() {
        let later = (k as f64 - MOVES - RESTS).clamp(0.0, MOVES);
        let position =
            ease((k as f64 / MOVES).min(1.0)) - ease(later / MOVES) - 1e-4 * (k as f64 - 1600.0).max(0.0);
        *value = (20_000.0 * position).round() / 20_000.0;
    }
    assert_eq!(check(&record).unusable, [vec![], vec![], vec![]]);
    assert!(check(&record).problems.iter().all(|it| !it.text.contains("saturated")), "{record:?}");
}

/// What a radio link or a bus makes of lost samples: the last value stays.
#[test]
fn held_values() {
    let mut record = clean(1, 0.01);
    let stretches = [300..340, 900..905, 1700..1712, 2400..2430];
    for stretch in stretches.clone() {
        let value = record.channels[2].values[stretch.start];
        record.channels[2].values[stretch].fill(value);
    }
    let (signal, text, fatal) = only(&record);
    assert_eq!((signal.as_str(), fatal), ("z", false));
    assert!(text.starts_with("keeps one value for up to 40 samples 4 times, at 0.3 s, 0.9 s"), "{text}");
    let found = check(&record).unusable;
    assert_eq!(found, [vec![], vec![], stretches.to_vec()]);
}

/// A command that is renewed every eighth sample keeps each value, and nothing was lost.
#[test]
fn a_signal_that_is_renewed_less_often_is_not_held_by_a_fault() {
    let mut record = clean(1, 0.01);
    let values = &mut record.channels[2].values;
    for first in (0..values.len()).step_by(8) {
        let (value, last) = (values[first], (first + 8).min(values.len()));
        values[first..last].fill(value);
    }
    let problems = check(&record).problems;
    assert!(problems.iter().all(|it| !it.text.contains("samples were lost")), "{problems:?}");
}

/// A bench that stops now and then: its amplifiers show zero, and nothing was lost. Where a bus loses samples, all signals are
/// held as well, but the motion has gone on.
#[test]
fn a_rest_of_all_signals_is_no_loss() {
    for seed in 0..12 {
        let mut record = clean(seed, 0.01);
        let stretches = [300..340, 900..930, 1700..1740, 2400..2430];
        let mut lost = record.clone();
        for (channel, lost) in record.channels.iter_mut().zip(&mut lost.channels) {
            for (k, value) in channel.values.iter_mut().enumerate() {
                // Each stop is left as slowly as it is come to.
                let distance =
                    |it: &Range<usize>| it.start.saturating_sub(k).max((k + 1).saturating_sub(it.end));
                let nearest = stretches.iter().map(distance).min().unwrap();
                *value *= (nearest as f64 / 100.0).min(1.0);
            }
            for stretch in stretches.clone() {
                let value = lost.values[stretch.start];
                lost.values[stretch].fill(value);
            }
        }
        assert_eq!(check(&record).problems, []);
        // A signal may be by chance where it was.
        assert!(check(&lost).problems.len() >= 2, "{seed}");
    }
}

/// An encoder on what sticks at every turn: no sample was lost.
#[test]
fn what_sticks_keeps_its_value() {
    let mut record = clean(1, 0.01);
    let values = &mut record.channels[2].values;
    let mut at = values[0];
    for value in values.iter_mut() {
        // It follows once it is a tenth of a millimetre behind.
        at += (*value - at).signum() * ((*value - at).abs() - 1e-4).max(0.0);
        *value = at;
    }
    let still = values.windows(5).filter(|it| it.iter().all(|value| *value == it[0])).count();
    assert!(still > 20, "{still}");
    assert_eq!(check(&record).problems, []);
}

/// A contact that opens, computed: no noise, no sensor.
#[test]
fn flat_tops_without_noise_are_the_signals_own() {
    let mut record = clean(1, 0.0);
    for value in &mut record.channels[0].values {
        *value = value.max(-1.5);
    }
    let found = check(&record);
    assert!(found.problems.iter().any(|it| it.text.starts_with("is flat at its lowest")), "{found:?}");
    assert_eq!(found.unusable, [vec![], vec![], vec![]]);
}

#[test]
fn stuck() {
    let mut record = clean(1, 0.01);
    let value = record.channels[2].values[1000];
    record.channels[2].values[1000..1700].fill(value);
    let (signal, text, fatal) = only(&record);
    assert_eq!((signal.as_str(), fatal), ("z", false));
    assert!(text.starts_with("is stuck at ") && text.contains("from 1 to 1.699 s"), "{text}");
}

#[test]
fn stuck_without_noise() {
    let mut record = clean(1, 0.0);
    let value = record.channels[2].values[1000];
    record.channels[2].values[1000..1700].fill(value);
    assert!(only(&record).1.starts_with("is stuck at "));
}

#[test]
fn constant() {
    let mut record = clean(1, 0.01);
    record.channels[2].values.fill(0.0);
    let (signal, text, fatal) = only(&record);
    assert_eq!((signal.as_str(), fatal), ("z", false));
    assert!(text.starts_with("is 0 m all the time"), "{text}");
}

#[test]
fn dropouts() {
    let mut record = clean(1, 0.001);
    for value in &mut record.channels[1].values {
        *value += 200.0;
    }
    record.channels[1].values[700] = 0.0;
    record.channels[1].values[1200..1204].fill(0.0);
    record.channels[1].values[2100] = 1e4;
    let (signal, text, fatal) = only(&record);
    assert_eq!((signal.as_str(), fatal), ("y", false));
    assert!(text.contains("3 times, at 0.7 s, 1.2 s, 2.1 s"), "{text}");
}

#[test]
fn coarse_quantisation() {
    let mut record = clean(1, 0.01);
    for value in &mut record.channels[0].values {
        *value = (*value * 4.0).round() / 4.0;
    }
    let (signal, text, fatal) = only(&record);
    assert_eq!((signal.as_str(), fatal), ("x", false));
    assert!(text.contains("0.25 m apart, which is a noise of 0.07217 m"), "{text}");
}

#[test]
fn offset_at_rest() {
    let mut record = clean(1, 0.01);
    for channel in &mut record.channels {
        let whole = spread(&channel.values).1;
        for (value, n) in channel.values.iter_mut().zip(white(9, 1200)) {
            *value = whole * 0.01 * n;
        }
    }
    assert_eq!(standstill(&record), Some(0..1200));
    assert_eq!(check(&record).problems, []);
    for value in &mut record.channels[1].values {
        *value += 7.5;
    }
    let (signal, text, fatal) = only(&record);
    assert_eq!((signal.as_str(), fatal), ("y", false));
    assert!(text.starts_with("shows 7.") && text.contains("at rest until 1.199 s"), "{text}");
    record.channels[1].unit = "Pa".into();
    assert_eq!(check(&record).problems, []);
    assert_eq!(standstill(&clean(1, 0.01)), None);
}

#[test]
fn numbers_for_people() {
    for (value, text) in [
        (0.0, "0"),
        (1.5, "1.5"),
        (-0.0012345, "-0.001234"),
        (123_456.0, "123456"),
        (1e-9, "1.000e-9"),
        (0.1, "0.1"),
        (2.0, "2"),
        (100.0, "100"),
        (1e9, "1.000e9"),
    ] {
        assert_eq!(number(value), text);
    }
}

#[test]
fn stamps_alike_by_rounding_are_one_note_and_no_gaps() {
    let mut record = clean(5, 0.01);
    record.time.iter_mut().for_each(|t| *t = (100.0 * *t).round() / 100.0);
    let (signal, text, fatal) = only(&record);
    assert!(signal == "time" && !fatal && text.contains("rounded to 0.01 s"), "{text}");
    assert!(text.contains("even clock of 1000 Hz"), "{text}");
    // Rows that are there twice are no clock's.
    record.time[700..].iter_mut().for_each(|t| *t -= 0.2);
    assert!(check(&record).problems.iter().any(|it| it.fatal));
}
