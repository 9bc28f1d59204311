//! Columns of one motion against each other: a velocity is the rate of its position whatever the rig's parameters are.

use crate::catalogue::{Bounds, Element, distortion};
use crate::data::check::DataProblem;
use crate::data::uniform::SHORTEST_SEGMENT;
use crate::dataset::inverse::LOWEST;
use crate::dataset::rate::Agreement;
use crate::dataset::recorded::{Dataset, Source};
use crate::decision::plausible::{FARTHEST, is_beyond_any_rig, mismatched_rate};
use crate::report::words::{digits, percent, unit};
use crate::rig::Rig;
use crate::screening::rms;
use crate::signal::derivative;
use crate::signal::distortion::Fault;
use crate::signal::spectral::{Complex, about_line, filled};

use super::{likeness, mended, readings};

/// Names' ends of motions and of their rates.
const RATES: &[(&[&str], &str)] =
    &[(&["position", "height", "deflection"], "velocity"), (&["velocity"], "acceleration")];

/// A measured column: its name, its SI unit and its values.
type Column<'a> = (&'a str, &'static str, &'a [f64]);

/// All measured columns of a record.
fn columns<'a>(rig: &'a Rig, record: &'a Dataset) -> Vec<Column<'a>> {
    let inputs = rig.plant.inputs.iter().zip(&record.inputs).filter_map(|(declared, source)| match source {
        Source::Measured(values) => Some((declared.name.as_str(), declared.unit.symbol, &values[..])),
        Source::DerivativeOf(_) | Source::RateOf(_) | Source::Constant(_) => None,
    });
    let outputs = record.measured.iter().map(|measured| {
        let declared = &rig.plant.outputs[measured.output];
        (declared.name.as_str(), declared.unit.symbol, &measured.values[..])
    });
    inputs.chain(outputs).collect()
}

/// Pairs of columns whose units do not go together.
pub(super) fn problems(rig: &Rig, record: &Dataset) -> Vec<DataProblem> {
    let columns = columns(rig, record);
    let mut problems: Vec<DataProblem> = Vec::new();
    for (motion, rate) in pairs(&columns) {
        // One wrong column is wrong beside each of its relatives.
        if let Some(problem) = compared(record, motion, rate).or_else(|| apart(record, motion, rate))
            && !problems.iter().any(|it| it.signal == problem.signal)
        {
            problems.push(problem);
        }
    }
    problems
}

/// Rates that are late or early beside their motion: a shift in time that a model would have to make up for. It is a note, since the
/// search looks for a sensor's delay, too.
pub(super) fn late(rig: &Rig, record: &Dataset) -> Vec<DataProblem> {
    // Over stretches in which a simulation drifts little, a slow motion turns too seldom.
    let record = &record.joined();
    let columns = columns(rig, record);
    let of = |(motion, rate): (Column<'_>, Column<'_>)| {
        let late = in_step(record, motion.2, rate.2).filter(Agreement::is_related)?.late()?;
        let text = format!(
            "is {late}, compared with the rate of {}: its sensor, or what computes it, delays it. Correct it in the map (`delay`), or \
             take the column out",
            motion.0
        );
        Some(DataProblem { record: record.name.clone(), signal: rate.0.into(), text, fatal: false })
    };
    pairs(&columns).filter_map(of).collect()
}

/// Each motion with each of its rates.
fn pairs<'a>(columns: &[Column<'a>]) -> impl Iterator<Item = (Column<'a>, Column<'a>)> {
    let rates = |motion: &Column<'a>| {
        let motion = *motion;
        columns.iter().filter(move |rate| is_rate(motion.0, rate.0)).map(move |rate| (motion, *rate))
    };
    columns.iter().flat_map(rates)
}

/// Positions beyond any test rig, by distance or speed. A drive may turn, and angles are no lengths: there, it is a note.
pub(super) fn beyond_any_rig(rig: &Rig, record: &Dataset) -> Vec<DataProblem> {
    let may_turn = rig.kind.elements.iter().all(|it| it.element == Element::GUIDE);
    let of = |(name, si, values): Column<'_>| {
        let rates = record.sections.iter().flat_map(|it| derivative(&values[it.clone()], record.step));
        let (length, rate) = (rms(values), rms(&rates.collect::<Vec<_>>()));
        let reading = readings(si).into_iter().find(|it| !it.in_header)?;
        (si == "m" && is_beyond_any_rig(length, rate)).then(|| {
            let text = format!(
                "its rms is {} m, and that of its rate {} m/s. No test rig goes beyond {} m or {} m/s. It fits if {}{}",
                digits(length, 2),
                digits(rate, 2),
                FARTHEST.0,
                FARTHEST.1,
                mended(name, si, reading),
                if may_turn { ". An axis that turns, recorded in rad, may go as far" } else { "" }
            );
            DataProblem { record: record.name.clone(), signal: name.into(), text, fatal: !may_turn }
        })
    };
    columns(rig, record).into_iter().filter_map(of).collect()
}

/// Whether a signal is the rate of another one, by their names.
fn is_rate(motion: &str, rate: &str) -> bool {
    // A motion that is imposed is the rig's own.
    let motion = motion.strip_prefix("motion.").unwrap_or(motion);
    let of = |(motions, end): &(&[&str], &str)| {
        let group = rate.strip_suffix(end)?;
        Some(motions.iter().any(|it| motion.strip_suffix(it) == Some(group)))
    };
    RATES.iter().filter_map(of).any(|it| it)
}

fn compared(record: &Dataset, motion: Column<'_>, rate: Column<'_>) -> Option<DataProblem> {
    let (mut derived, mut measured) = (Vec::new(), Vec::new());
    for section in &record.sections {
        let values = derivative(&motion.2[section.clone()], record.step);
        let pairs = values.into_iter().zip(&rate.2[section.clone()]);
        for (one, other) in pairs.filter(|(one, other)| one.is_finite() && other.is_finite()) {
            derived.push(one);
            measured.push(*other);
        }
    }
    let about_mean = |values: &[f64]| {
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        values.iter().map(|value| value - mean).collect::<Vec<_>>()
    };
    let alike = likeness(&about_mean(&derived), &about_mean(&measured));
    let (is_motion, reading) = mismatched_rate(alike, &readings(motion.1), &readings(rate.1))?;
    let wrong = if is_motion { motion } else { rate };
    let text = format!(
        "{} and {} do not go together: the derivative of {} has an rms of {} {unit}, and {} one of {} {unit}. That fits if {}",
        motion.0,
        rate.0,
        motion.0,
        digits(rms(&derived), 2),
        rate.0,
        digits(rms(&measured), 2),
        mended(wrong.0, wrong.1, reading),
        unit = unit(rate.1),
    );
    Some(DataProblem { record: record.name.clone(), signal: wrong.0.into(), text, fatal: true })
}

/// A rate that is another quantity than that of its motion: alike but for a factor that no sensor's gain has.
fn apart(record: &Dataset, motion: Column<'_>, rate: Column<'_>) -> Option<DataProblem> {
    let Bounds::Between(least, most) = distortion(Fault::Gain).bounds else { return None };
    let alike = in_step(record, motion.2, rate.2)?;
    if !alike.is_related() || (1.0 + least..=1.0 + most).contains(&alike.ratio) {
        return None;
    }
    let text = format!(
        "{} is {} of the rate of {}{}: no sensor is that far off. One of the two is another quantity or wrongly scaled. Correct \
         it in the map (`scale`, `delay`), or take one of them out",
        rate.0,
        percent(alike.ratio),
        motion.0,
        alike.late().map_or_else(String::new, |late| format!(", and {late}"))
    );
    Some(DataProblem { record: record.name.clone(), signal: rate.0.into(), text, fatal: true })
}

/// A rate beside that of a motion, both without what is fast: there, a position's rate has no noise yet.
fn in_step(record: &Dataset, motion: &[f64], rate: &[f64]) -> Option<Agreement> {
    let slow = |values: &[f64]| -> Option<Vec<f64>> {
        let (line, rest) = about_line(&filled(values)?, &mut |spectrum| {
            let end = LOWEST * record.step * spectrum.len() as f64;
            let gain = |bin: usize| f64::from(bin.min(spectrum.len() - bin) as f64 <= end);
            (0..spectrum.len()).map(|bin| Complex::from(gain(bin))).collect()
        });
        Some(rest.iter().enumerate().map(|(k, it)| line.at(k) + it).collect())
    };
    let (mut derived, mut change, mut measured) = (Vec::new(), Vec::new(), Vec::new());
    for section in record.sections.iter().filter(|it| it.len() >= SHORTEST_SEGMENT) {
        let own = derivative(&slow(&motion[section.clone()])?, record.step);
        change.extend(derivative(&own, record.step));
        derived.extend(own);
        measured.extend(slow(&rate[section.clone()])?);
    }
    Agreement::of([&derived, &change], &measured, record.step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::recorded::Measured;

    /// A sensor may be some percent off or late; a tenth of the rate is another quantity.
    #[test]
    fn a_rate_of_another_size_is_no_sensors_gain() {
        const STEP: f64 = 0.01;
        let record = Dataset {
            name: "run.csv".into(),
            step: STEP,
            sections: std::iter::once(0..2000).collect(),
            ..Dataset::default()
        };
        let wave = |of: fn(f64) -> f64| (0..2000).map(|k| of(STEP * f64::from(k))).collect::<Vec<f64>>();
        let position = wave(|t| (5.0 * t).sin() + 0.1 * (13.0 * t).cos());
        let rate = |t: f64| 5.0 * (5.0 * t).cos() - 1.3 * (13.0 * t).sin();
        let seen = |scale: f64, late: f64| {
            let rate: Vec<f64> = (0..2000).map(|k| scale * rate(STEP * f64::from(k) - late)).collect();
            apart(&record, ("position", "m", &position), ("velocity", "m/s", &rate))
        };
        let tenth = seen(0.1, 0.04).unwrap();
        assert!(tenth.fatal && tenth.signal == "velocity", "{tenth:?}");
        assert!(tenth.text.starts_with("velocity is 10 % of the rate of position, and 4"), "{}", tenth.text);
        assert_eq!((seen(1.2, 0.0), seen(0.8, 0.02)), (None, None));
    }

    #[test]
    fn a_late_rate_is_noted_whatever_drives_the_model() {
        const STEP: f64 = 0.005;
        let rig = Rig::published("rotary-drive").unwrap();
        let output = |name: &str| rig.plant.output(name).unwrap();
        let noted = |late: f64| {
            let of = |name: &str, of: &dyn Fn(f64) -> f64| Measured {
                output: output(name),
                values: (0..2000).map(|k| of(STEP * f64::from(k))).collect(),
                noise_floor: 0.0,
            };
            let rate = |t: f64| 5.0 * (5.0 * (t - late)).cos() - 1.3 * (13.0 * (t - late)).sin();
            let record = Dataset {
                step: STEP,
                measured: vec![
                    of("position", &|t| (5.0 * t).sin() + 0.1 * (13.0 * t).cos()),
                    of("velocity", &rate),
                ],
                sections: std::iter::once(0..2000).collect(),
                ..Dataset::default()
            };
            super::late(&rig, &record)
        };
        let [note] = &noted(0.02)[..] else { panic!("one note") };
        assert!(
            note.signal == "velocity" && !note.fatal && note.text.starts_with("is 20 ms late"),
            "{note:?}"
        );
        assert_eq!(noted(0.0), []);
    }

    #[test]
    fn a_rate_has_the_name_of_its_motion() {
        assert!(is_rate("position", "velocity") && is_rate("motion.position", "velocity"));
        assert!(is_rate("velocity", "acceleration"));
        assert!(is_rate("suspension.deflection", "suspension.velocity"));
        assert!(!is_rate("body.position", "wheel.velocity") && !is_rate("position", "acceleration"));
        assert!(!is_rate("velocity", "velocity"));
    }
}
