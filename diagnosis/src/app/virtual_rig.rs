//! A virtual rig: records of a model with something hidden in it, to try the diagnosis with.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Write;

use crate::data::table::did_you_mean;
use crate::plant::Drive;
use crate::rig::Rig;
use crate::screening::rms;
use crate::signal::derivative;
use crate::signal::distortion::{Correction, Fault, Samples};
use crate::signal::random::Random;

/// What is recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Experiment {
    /// Parameters that differ from the rig's, and distortions of measured signals, with their values.
    pub hidden: Vec<(String, f64)>,
    /// Size of the excitation over the rig's usual one.
    pub amplitude: f64,
    /// Standard deviation of the noise over the root mean square of each signal.
    pub noise: f64,
    /// For phases and noise.
    pub seed: u64,
    /// Time between two samples in seconds.
    pub step: f64,
    /// Length of a record in seconds.
    pub length: f64,
}

/// Parts of a second to which times are written down.
const TICKS: f64 = 1e9;
/// Longest delay or lag of a signal in seconds: an hour is longer than any record.
const LONGEST: f64 = 3600.0;

/// A signal and its distortion: `body.acceleration.gain`. Parameters of the model come first.
fn distortion<'a>(rig: &Rig, name: &'a str) -> Option<(&'a str, Fault)> {
    let (signal, last) = name.rsplit_once('.').filter(|_| rig.plant.parameter(name).is_none())?;
    let fault = Fault::NAMED.into_iter().find(|fault| fault.name() == last)?;
    let mut signals = rig.plant.inputs.iter().chain(&rig.plant.outputs);
    signals.any(|it| it.name == signal).then_some((signal, fault))
}

/// A parameter that differs from the rig's, e.g. `strut.coulomb.force=60` in its SI unit, or the distortion of a measured
/// signal, e.g. `body.acceleration.gain=0.05`.
///
/// # Errors
/// If the text is of another form, the rig has no parameter of the name, or the value is out of its bounds.
pub fn hidden(rig: &Rig, text: &str) -> Result<(String, f64), String> {
    let wrong = || format!("{text}: write NAME=VALUE, as in strut.coulomb.force=60");
    let (name, value) = text.split_once('=').ok_or_else(wrong)?;
    let (name, value) = (name.trim(), value.trim().parse::<f64>().map_err(|_| wrong())?);
    if let Some((_, fault)) = distortion(rig, name) {
        let (low, high) = match fault {
            Fault::Delay => (Some(-LONGEST), Some(LONGEST)),
            Fault::Lag => (Some(0.0), Some(LONGEST)),
            Fault::Limit => (Some(0.0), None),
            _ => (None, None),
        };
        let unit = if matches!(fault, Fault::Delay | Fault::Lag) { "s" } else { "" };
        return within((low, high), unit, value)
            .map_err(|limits| format!("{text}: {name} has to be {limits}"))
            .map(|()| (name.to_owned(), value));
    }
    let index = rig.plant.parameter(name).ok_or_else(|| {
        let hint = did_you_mean(name, rig.plant.parameters.iter().map(|it| it.name.as_str()));
        format!(
            "{text}: {} has no parameter `{name}`{hint}; `diagnose rigs {}` lists them",
            rig.name, rig.name
        )
    })?;
    let declared = &rig.plant.parameters[index];
    let limits = (declared.min, declared.max);
    within(limits, declared.unit.symbol, value)
        .map_err(|limits| format!("{text}: {name} has to be {limits}"))?;
    Ok((name.to_owned(), value))
}

/// Whether a value lies within limits.
///
/// # Errors
/// The limits in words, if it does not.
fn within(limits: (Option<f64>, Option<f64>), unit: &str, value: f64) -> Result<(), String> {
    let (low, high) = (limits.0.unwrap_or(f64::MIN), limits.1.unwrap_or(f64::MAX));
    if (low..=high).contains(&value) {
        return Ok(());
    }
    let words = match limits {
        (Some(low), Some(high)) => format!("from {low} to {high} {unit}"),
        (Some(low), None) => format!("at least {low} {unit}"),
        (None, Some(high)) => format!("at most {high} {unit}"),
        (None, None) => "finite".into(),
    };
    Err(words.trim_end().to_owned())
}

/// A record as CSV; `number` tells its excitation: one for each.
///
/// # Errors
/// If the rig has no parameter of a name, refuses the values, or diverges with them.
pub fn record(rig: &Rig, experiment: &Experiment, number: u64) -> Result<String, String> {
    let mut parameters = rig.parameters.clone();
    let mut distorted: BTreeMap<&str, Correction> = BTreeMap::new();
    for (name, value) in &experiment.hidden {
        if let Some((signal, fault)) = distortion(rig, name) {
            distorted.entry(signal).or_default().set(fault, *value);
            continue;
        }
        let index = rig.plant.parameter(name).ok_or_else(|| {
            let names: Vec<&str> = rig.plant.parameters.iter().map(|it| it.name.as_str()).collect();
            format!("{} has no parameter `{name}`; it has {}", rig.name, names.join(", "))
        })?;
        parameters[index] = *value;
    }
    let dynamics = rig.plant.prepare(&rig.choices)?;
    dynamics.check(&parameters)?;
    let mut random = Random::new(experiment.seed.wrapping_mul(1000).wrapping_add(number));
    let step = experiment.step;
    let count = (experiment.length / step).round() as usize;
    let mut inputs: Vec<Vec<f64>> = rig
        .plant
        .inputs
        .iter()
        .map(|declared| match rig.excitation(declared) {
            Some((amplitude, band)) => {
                let signal = multisine(count, step, amplitude * experiment.amplitude, band, &mut random);
                signal.into_iter().map(|value| declared.start + value).collect()
            }
            None => vec![declared.start; count],
        })
        .collect();
    for (index, declared) in rig.plant.inputs.iter().enumerate() {
        if let Some(position) = rig.rate_of(&declared.name) {
            inputs[index] = derivative(&inputs[position], step);
        }
    }
    let drive = Drive::sampled(step, inputs);
    let outputs = dynamics.outputs(&parameters, &rig.start, &drive);
    if !outputs.iter().flatten().all(|it| it.is_finite()) {
        return Err(format!(
            "the simulation of {} diverges with these values: it is unstable, or too stiff for {} samples a second; hide less, or give a higher \
             --sample-rate",
            rig.name,
            step.recip().round()
        ));
    }
    let declared = rig.plant.inputs.iter().chain(&rig.plant.outputs);
    let signals: Vec<(String, Vec<f64>)> = declared
        .zip(drive.inputs.iter().chain(&outputs))
        .filter(|(declared, signal)| {
            let hidden = declared.name.ends_with("body.position")
                || (declared.name.ends_with("velocity") && !drives(rig, &declared.name));
            !hidden && !rig.is_trivial(&declared.name) && !rig.is_idle(&declared.name) && rms(signal) > 0.0
        })
        .map(|(declared, signal)| {
            let deviation = experiment.noise * rms(signal);
            let all = Samples { step, first: 0 };
            let shown = distorted.get(&*declared.name).map(|it| it.applied(signal, all));
            let signal = shown.as_ref().unwrap_or(signal);
            let noisy = signal.iter().map(|value| value + deviation * random.normal()).collect();
            (format!("{} [{}]", declared.name, declared.unit.symbol), noisy)
        })
        .collect();
    let mut text = String::from("time [s]");
    for (title, _) in &signals {
        let _ = write!(text, ",{title}");
    }
    text.push('\n');
    for sample in 0..count {
        // Times that are as long as the step is: 0.3 rather than 0.30000000000000004.
        let _ = write!(text, "{}", (sample as f64 * step * TICKS).round() / TICKS);
        for (_, signal) in &signals {
            let _ = write!(text, ",{:.7e}", signal[sample]);
        }
        text.push('\n');
    }
    Ok(text)
}

/// Whether a signal is an input of its own, not the rate of another one.
fn drives(rig: &Rig, name: &str) -> bool {
    rig.plant.input(name).is_some() && rig.rate_of(name).is_none()
}

/// Sines at a third of an octave with random phases; large slow, small fast; about `amplitude` in all.
fn multisine(
    count: usize,
    step: f64,
    amplitude: f64,
    (low, high): (f64, f64),
    random: &mut Random,
) -> Vec<f64> {
    let mut lines = Vec::new();
    let mut frequency = low * (1.0 + 0.2 * random.uniform());
    while frequency < high {
        lines.push((frequency, amplitude * (low / frequency).sqrt(), TAU * random.uniform()));
        frequency *= 1.26;
    }
    let scale = (lines.iter().map(|(_, a, _)| a * a).sum::<f64>()).sqrt() / amplitude;
    (0..count)
        .map(|k| {
            let t = k as f64 * step;
            // From rest: the plant starts in its equilibrium.
            let grown = (t / 0.5).min(1.0);
            let sum: f64 = lines.iter().map(|(f, a, phase)| a * (TAU * f * t + phase).sin()).sum();
            grown * grown * (3.0 - 2.0 * grown) * sum / scale
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(experiment: &Experiment) -> Vec<(String, Vec<f64>)> {
        let rig = Rig::published("tum-linear-measured-quarter-car").unwrap();
        let text = record(&rig, experiment, 1).unwrap();
        let mut lines = text.lines();
        let mut all: Vec<(String, Vec<f64>)> =
            lines.next().unwrap().split(',').map(|name| (name.to_owned(), Vec::new())).collect();
        for line in lines {
            for (column, number) in all.iter_mut().zip(line.split(',')) {
                column.1.push(number.parse().unwrap());
            }
        }
        all
    }

    fn plain() -> Experiment {
        Experiment { hidden: Vec::new(), amplitude: 1.0, noise: 0.0, seed: 1, step: 2e-3, length: 4.0 }
    }

    #[test]
    fn a_sensors_gain_is_in_its_own_column_alone() {
        let rig = Rig::published("tum-linear-measured-quarter-car").unwrap();
        let hidden = vec![hidden(&rig, "body.acceleration.gain=0.5").unwrap()];
        let (before, after) = (columns(&plain()), columns(&Experiment { hidden, ..plain() }));
        for ((name, before), (_, after)) in before.iter().zip(&after) {
            let factor = if name.starts_with("body.acceleration") { 1.5 } else { 1.0 };
            assert!((rms(after) - factor * rms(before)).abs() < 1e-5 * rms(before), "{name}");
        }
        assert!(super::hidden(&rig, "body.acceleration.gian=0.5").is_err());
    }

    #[test]
    fn a_simulation_that_diverges_is_no_record() {
        let rig = Rig::published("tum-linear-measured-quarter-car").unwrap();
        let hidden = ["hysteresis.presliding.force=50", "hysteresis.presliding.stiffness=1e12"];
        let hidden = hidden.map(|it| super::hidden(&rig, it).unwrap()).to_vec();
        let told = record(&rig, &Experiment { hidden, ..plain() }, 1).unwrap_err();
        assert!(told.contains("diverges") && told.contains("--sample-rate"), "{told}");
    }

    #[test]
    fn amplitude_rate_and_duration_are_as_asked_for() {
        let twice = columns(&Experiment { amplitude: 2.0, step: 4e-3, length: 8.0, ..plain() });
        assert_eq!(twice[0].1.len(), 2000);
        let once = columns(&Experiment { step: 4e-3, length: 8.0, ..plain() });
        let road = once.iter().position(|it| it.0.starts_with("road.position")).unwrap();
        assert!((rms(&twice[road].1) / rms(&once[road].1) - 2.0).abs() < 1e-6);
    }
}
