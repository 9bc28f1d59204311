use super::*;
use proptest::prelude::*;

fn signal(t: f64) -> f64 {
    (12.0 * t).sin() + 0.3 * (31.0 * t).cos()
}

fn record(time: Vec<f64>) -> Record {
    let values = time.iter().map(|&t| signal(t)).collect();
    Record {
        name: "run.csv".into(),
        time,
        channels: vec![Channel { name: "x".into(), unit: "m".into(), values }],
        ..Record::default()
    }
}

fn even(n: usize, step: f64) -> Vec<f64> {
    (0..n).map(|i| 2.0 + step * i as f64).collect()
}

#[test]
fn an_even_record_stays_as_it_is() {
    let input = record(even(300, 1e-3));
    let (output, problems) = uniform(&input).unwrap();
    assert_eq!(problems, []);
    assert_eq!((output.start, output.step, output.len()), (2.0, 1e-3, 300));
    assert_eq!(output.channels, input.channels);
    assert_eq!(output.segments, vec![0..300]);
    assert!(!output.is_empty());
}

#[test]
fn rounded_stamps_are_on_the_grid() {
    // 1024 Hz, printed with six digits: the median period is wrong by 5e-4, the grid must not be.
    let stamps = (0..5000).map(|i| (f64::from(i) / 1024.0 * 1e6).round() / 1e6).collect();
    let (output, problems) = uniform(&record(stamps)).unwrap();
    assert_eq!(problems, []);
    assert_eq!(output.step, 1.0 / 1024.0);
    assert_eq!(output.len(), 5000);
}

#[test]
fn a_clock_that_is_a_little_off_is_kept() {
    let (output, problems) = uniform(&record(even(20_000, 1.0003e-3))).unwrap();
    assert_eq!(problems, []);
    assert!((output.step - 1.0003e-3).abs() < 1e-12);
}

/// Most rounds of a loop take a millisecond, every third takes four and a bit: at the median, six in ten samples would be missing.
#[test]
fn a_loop_s_record_has_the_period_at_which_few_samples_are_missing() {
    let mut time = vec![2.0];
    for round in 0..1500 {
        let lasts = if round % 3 == 0 { 4.3e-3 } else { 1e-3 + 1e-5 * f64::from(round % 7) };
        time.push(time[time.len() - 1] + lasts);
    }
    let input = record(time);
    assert!(crate::check::check(&input).problems.iter().all(|it| !it.fatal));
    let (output, problems) = uniform(&input).unwrap();
    assert!((2.5e-3..5e-3).contains(&output.step) && output.segments.len() == 1, "{}", output.step);
    assert!(problems[0].text.starts_with("the samples are not evenly spaced"), "{problems:?}");
    let values = output.channels[0].values.iter().enumerate();
    assert!(values.into_iter().all(|(sample, value)| (value - signal(output.time(sample))).abs() < 2e-3));
}

#[test]
fn missing_samples_are_bridged_and_reported() {
    let mut input = record(even(300, 1e-2));
    input.channels[0].values[100..103].fill(f64::NAN);
    let (output, problems) = uniform(&input).unwrap();
    assert_eq!(output.segments, vec![0..300]);
    assert!(output.channels[0].values.iter().all(|v| v.is_finite()));
    assert!((output.channels[0].values[101] - signal(3.01)).abs() < 0.1);
    assert_eq!(problems.len(), 1);
    assert_eq!(problems[0].signal, "x");
    assert!(problems[0].text.contains("3 missing samples were interpolated"));
}

#[test]
fn gaps_split_the_record() {
    let mut time = even(600, 1e-2);
    time.drain(200..203); // Short: bridged.
    time.drain(397..437); // 40 samples: split.
    let (output, problems) = uniform(&record(time)).unwrap();
    assert_eq!(output.segments, [0..400, 440..600]);
    assert_eq!(output.len(), 600);
    for i in output.segments.iter().cloned().flatten() {
        let exact = if (200..203).contains(&i) { 0.1 } else { 1e-12 };
        assert!((output.channels[0].values[i] - signal(output.time(i))).abs() < exact, "{i}");
    }
    let texts: Vec<_> = problems.iter().map(|p| p.text.as_str()).collect();
    assert!(texts[0].starts_with("3 missing samples"), "{texts:?}");
    assert!(texts[1].starts_with("40 samples are missing"), "{texts:?}");
    assert!(texts[2].contains("2 segments: 2 to 5.99 s, 6.4 to 7.99 s"), "{texts:?}");
}

#[test]
fn missing_ends_are_left_out() {
    let mut input = record(even(300, 1e-2));
    input.channels[0].values[..2].fill(f64::NAN);
    input.channels[0].values[297..].fill(f64::NAN);
    assert_eq!(uniform(&input).unwrap().0.segments, vec![2..297]);
}

#[test]
fn what_cannot_be_made_even_is_refused() {
    let message = |record: &Record| uniform(record).unwrap_err().to_string();
    let mut time = even(300, 1e-2);
    time[7] = time[6];
    assert!(message(&record(time)).contains("do not increase"));
    assert!(message(&record(vec![0.0, f64::NAN, 1.0])).contains("do not increase"));
    assert!(message(&record(vec![0.0])).contains("fewer than two"));
    assert!(message(&record(vec![])).contains("fewer than two"));
    assert!(message(&record(vec![0.0, 1e-3, 2e-3, 1e9])).contains("check the unit"));
    assert!(message(&record(even(20, 1e-2))).contains("record longer"));
    let mut slow = record(even(300, 1e-2));
    for (i, value) in slow.channels[0].values.iter_mut().enumerate() {
        *value = if i % 10 == 0 { *value } else { f64::NAN };
    }
    let text = message(&slow);
    assert!(text.starts_with("run.csv, x: 270 of 300 samples are missing"), "{text}");
}

proptest! {
    #[test]
    fn uneven_records_are_resampled(jitter in prop::collection::vec(-0.4..0.4_f64, 400)) {
        let time: Vec<f64> = jitter.iter().enumerate().map(|(i, j)| 1e-2 * (i as f64 + j)).collect();
        let (output, problems) = uniform(&record(time)).unwrap();
        prop_assert!(problems[0].text.contains("not evenly spaced"));
        prop_assert_eq!(output.segments.first(), Some(&(0..output.len())));
        for i in 0..output.len() {
            let error = output.channels[0].values[i] - signal(output.time(i));
            prop_assert!(error.abs() < 0.02, "{} at {}", error, i);
        }
    }

    #[test]
    fn no_panic_and_no_nan_in_segments(
        samples in prop::collection::vec((prop::num::f64::ANY, prop::option::of(-1.0..1.0_f64)), 0..80),
        steps in prop::collection::vec(1e-3..3.0_f64, 80), sorted in any::<bool>(), length in 0..300_usize
    ) {
        let mut now = 0.0;
        let mut input = record(Vec::new());
        for i in 0..length {
            let (wild, value) = samples.get(i % samples.len().max(1)).copied().unwrap_or((0.0, None));
            now += steps[i % 80];
            input.time.push(if sorted { now } else { wild });
            input.channels[0].values.push(value.unwrap_or(f64::NAN));
        }
        if let Ok((output, _)) = uniform(&input) {
            for i in output.segments.iter().cloned().flatten() {
                prop_assert!(!output.channels[0].values[i].is_nan());
            }
        }
    }
}

#[test]
fn stamps_that_are_even_but_for_their_last_digit_keep_their_values() {
    let clock = |k: usize| k as f64 / 3004.8;
    let rounded: Vec<f64> = (0..5000).map(|k| (1e4 * (10.0 + clock(k))).round() / 1e4).collect();
    let uneven = record(rounded.clone());
    let (even, problems) = uniform(&uneven).unwrap();
    assert!(problems.is_empty() && even.len() == 5000, "{problems:?}");
    assert!((even.step * 3004.8 - 1.0).abs() < 1e-4, "{}", 1.0 / even.step);
    assert_eq!(even.channels[0].values, uneven.channels[0].values);
    let clock = rounded_clock(&uneven).unwrap();
    assert_eq!((clock.period, clock.digit), (even.step, 1e-4));
    // A clock that jitters by more than its digit is no even one.
    let jittering = rounded.iter().enumerate().map(|(k, t)| t + 1e-4 * [0.0, 1.0, -1.0][k * 7 % 3]).collect();
    assert!(rounded_clock(&record(jittering)).is_none());
    assert!(rounded_clock(&record(self::even(500, 1e-3))).is_none());
}

/// As `%.5g` prints them, from zero beyond a hundred seconds: three different last digits, the coarsest longer than a period.
#[test]
fn stamps_of_a_number_of_digits_keep_their_values() {
    let printed = |t: f64| -> f64 {
        let decimals = 4 - t.max(1e-5).log10().floor() as i32;
        let unit = 10_f64.powi(decimals);
        (t * unit).round() / unit
    };
    let stamps: Vec<f64> = (0..20_000).map(|k| printed(f64::from(k) / 128.98)).collect();
    assert!(stamps.windows(2).any(|pair| pair[0] == pair[1]));
    let input = record(stamps);
    let (output, problems) = uniform(&input).unwrap();
    assert!(problems.is_empty() && output.len() == 20_000, "{problems:?}");
    assert!((output.step * 128.98 - 1.0).abs() < 1e-5, "{}", 1.0 / output.step);
    assert_eq!(output.channels[0].values, input.channels[0].values);
    assert_eq!(rounded_clock(&input).unwrap().digit, 0.01);
}

#[test]
fn coarse_stamps_of_an_even_clock_are_alike_and_doubled_rows_are_wrong() {
    let coarse: Vec<f64> = (0..4000).map(|k| (f64::from(k) / 10.0).floor() / 100.0).collect();
    let (output, problems) = uniform(&record(coarse)).unwrap();
    assert_eq!((problems.len(), output.len()), (0, 4000));
    assert!((output.step - 1e-3).abs() < 1e-7, "{}", output.step);
    let mut doubled = even(500, 1e-3);
    (200..210).for_each(|k| doubled.insert(2 * k - 200, doubled[2 * k - 200]));
    assert!(uniform(&record(doubled)).is_err());
    // A lost sample is seen although the last digit is as long as a period.
    let mut lost = even(1000, 1e-2);
    lost.remove(500);
    let (output, problems) = uniform(&record(lost)).unwrap();
    assert_eq!((output.len(), problems.len()), (1000, 1));
}
