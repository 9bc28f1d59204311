//! Experiments, run again: whether the FMU does what they state.

use strut_related::{Agreement, Between, Series};

use super::Prepared;
use crate::behaviour::{Bench, plain};
use crate::description::Experiment as Times;
use crate::finding::{Finding, Report, count};
use crate::probe::{Act, Run};
use crate::rules::related;

/// Most steps of an experiment.
const MOST: f64 = 1e6;
/// How far a row may be from a communication point, in steps, to be compared there.
const NEAR: f64 = 1e-3;

/// Times of a run.
#[derive(Clone, Copy, Debug)]
struct Grid {
    start: f64,
    step: f64,
    steps: usize,
}

impl Grid {
    /// The times of an experiment; what it does not say follows from its tables and the default experiment.
    fn of(prepared: &Prepared, times: Times) -> Result<Self, String> {
        let Prepared { experiment, stimuli, expected, .. } = prepared;
        let ends = |of: fn(&[f64]) -> Option<&f64>| of(&stimuli.time).or_else(|| of(&expected.time)).copied();
        let start = experiment.start.or_else(|| ends(<[f64]>::first)).or(times.start).unwrap_or(0.0);
        let stop = experiment.stop.or_else(|| ends(<[f64]>::last)).or(times.stop).unwrap_or(start + 1.0);
        let step = experiment.step.or(times.step).unwrap_or((stop - start) / 500.0);
        let steps = ((stop - start) / step).round();
        if !(start.is_finite() && step > 0.0 && (1.0..=MOST).contains(&steps)) {
            return Err(format!("it leads from {start} s to {stop} s in steps of {step} s"));
        }
        Ok(Self { start, step, steps: steps as usize })
    }

    fn time(self, index: usize) -> f64 {
        self.start + index as f64 * self.step
    }
}

/// Runs an experiment, and compares what comes out with what is stated.
///
/// # Errors
/// If processes cannot be started.
pub fn replay(bench: &Bench, prepared: &Prepared, report: &mut Report) -> Result<(), String> {
    let name = &prepared.experiment.name;
    let subject = &bench.subject;
    let grid = match Grid::of(prepared, subject.description.experiment) {
        Ok(grid) => grid,
        Err(error) => {
            let message = format!("the experiment `{name}` cannot be run: {error}");
            report.findings.push(Finding::error(related::REPLAY, message).at(&prepared.file));
            return Ok(());
        }
    };
    let run = bench.obey(acts(bench, prepared, grid))?;
    if !bench.ran(related::REPLAY, &format!("the experiment `{name}`"), &run, report) {
        return Ok(());
    }
    let errors = errors(prepared, &rows(&run), grid);
    let steps = format!("{} of {} s", count(grid.steps, "step"), grid.step);
    match &prepared.experiment.agreement {
        None => {
            let told = errors.iter().map(|(name, rms)| format!("{name} {rms:.3e}"));
            let told: Vec<String> = told.collect();
            let told = if told.is_empty() { "nothing is expected".to_owned() } else { told.join(", ") };
            report.done.push(format!(
                "replay of `{name}` ({steps}), root mean square of expected less found: {told}"
            ));
        }
        Some(agreement) => {
            let wrong = disagreements(agreement, &errors);
            if wrong.is_empty() {
                let agree = match agreement.signals.len() {
                    1 => "the stated error comes out".into(),
                    number => format!("the {number} stated errors come out"),
                };
                report.done.push(format!("replay of `{name}` ({steps}): {agree}; {}", agreement.origin));
            }
            for message in wrong {
                let finding =
                    Finding::error(related::AGREEMENT, format!("the experiment `{name}`: {message}"));
                let help = "the library, the parameters or the tables are others than those that were stated with it";
                report.findings.push(finding.at(&prepared.file).help(help));
            }
        }
    }
    Ok(())
}

/// What is stated and does not come out.
fn disagreements(agreement: &Agreement, errors: &[(&str, f64)]) -> Vec<String> {
    let wrong = agreement.signals.iter().filter_map(|stated| {
        let (_, found) = errors.iter().find(|(name, _)| *name == stated.name)?;
        // What is no number is no agreement.
        let agrees = (found - stated.rms).abs() <= stated.within;
        (!agrees).then(|| {
            format!(
                "the error of `{}` is {found:.6e} {unit} (root mean square), and {:.6e} {unit} ± {:.1e} is stated",
                stated.name,
                stated.rms,
                stated.within,
                unit = stated.unit
            )
        })
    });
    wrong.collect()
}

/// The calls of an importer: inputs are set at a communication point, outputs are read where the step arrives.
fn acts(bench: &Bench, prepared: &Prepared, grid: Grid) -> Vec<(Act, bool)> {
    let Prepared { experiment, values, stimuli, inputs, outputs, .. } = prepared;
    let subject = &bench.subject;
    let linear = experiment.agreement.as_ref().is_some_and(|it| it.inputs == Between::Linear);
    let slopes = linear && subject.interface.can("canInterpolateInputs");
    let set = |time: f64| (Act::SetReals(inputs.clone(), at(stimuli, time, true)), true);
    let mut acts = subject.fresh(bench.unpacked.plain);
    if !values.is_empty() {
        acts.push((
            Act::SetReals(values.iter().map(|it| it.0).collect(), values.iter().map(|it| it.1).collect()),
            true,
        ));
    }
    let stop = Some(grid.time(grid.steps));
    acts.push((Act::SetUp { start: grid.start, stop, tolerance: experiment.tolerance }, true));
    acts.push(plain("EnterInitializationMode"));
    acts.extend((!inputs.is_empty()).then(|| set(grid.start)));
    acts.push(plain("ExitInitializationMode"));
    let read = || (!outputs.is_empty()).then(|| (Act::Reals(outputs.clone()), true));
    acts.extend(read());
    for index in 0..grid.steps {
        let (time, next) = (grid.time(index), grid.time(index + 1));
        if !inputs.is_empty() {
            acts.push(set(time));
            if slopes {
                let ends = at(stimuli, next, false).into_iter().zip(at(stimuli, time, true));
                let rates = ends.map(|(end, begin)| (end - begin) / grid.step).collect();
                acts.push((Act::InputDerivatives(inputs.clone(), rates), true));
            }
        }
        acts.push((Act::Step(time, grid.step), true));
        acts.extend(read());
    }
    acts
}

/// Values of a series at a time, straight between rows; of two rows at one time the later one, or the earlier one.
fn at(series: &Series, time: f64, later: bool) -> Vec<f64> {
    // Times are sums of steps: a row counts as reached a little before its time.
    let spacing =
        series.time.windows(2).map(|it| it[1] - it[0]).filter(|it| *it > 0.0).fold(f64::INFINITY, f64::min);
    let near = if spacing.is_finite() { NEAR * spacing } else { 0.0 };
    let next = match later {
        true => series.time.partition_point(|it| *it <= time + near),
        false => series.time.partition_point(|it| *it < time - near),
    };
    let (last, here) = (series.time.len() - 1, next.min(series.time.len() - 1));
    let value = |(_, values): &(String, Vec<f64>)| {
        let row = if later { next.saturating_sub(1) } else { here };
        if (series.time[row] - time).abs() <= near || next == 0 || next > last {
            return values[row];
        }
        let (from, to) = (next - 1, next);
        let share = (time - series.time[from]) / (series.time[to] - series.time[from]);
        values[from] + share * (values[to] - values[from])
    };
    series.signals.iter().map(value).collect()
}

/// What was read, row by row.
fn rows(run: &Run) -> Vec<Vec<f64>> {
    let outcomes = run.acts.iter().zip(&run.answers.outcomes);
    let read = outcomes.filter(|((act, _), _)| matches!(act, Act::Reals(_)));
    read.map(|(_, outcome)| outcome.values().collect()).collect()
}

/// Root mean square of what is expected less what was found, of each signal, at the communication points.
fn errors<'a>(prepared: &'a Prepared, rows: &[Vec<f64>], grid: Grid) -> Vec<(&'a str, f64)> {
    let Series { time, signals } = &prepared.expected;
    let places: Vec<Option<usize>> = time
        .iter()
        .map(|time| {
            let place = (time - grid.start) / grid.step;
            let near = (place - place.round()).abs() <= NEAR && place.round() >= 0.0;
            (near && place.round() <= grid.steps as f64).then_some(place.round() as usize)
        })
        .collect();
    let error = |(column, (name, values)): (usize, &'a (String, Vec<f64>))| {
        let compared = values.iter().zip(&places).filter(|(value, _)| !value.is_nan());
        let squares: Vec<f64> = compared
            .filter_map(|(value, place)| Some((value - rows.get((*place)?)?[column]).powi(2)))
            .collect();
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        (name.as_str(), mean.sqrt())
    };
    signals.iter().enumerate().map(error).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_go_straight_and_jump_where_a_time_is_there_twice() {
        let time = vec![0.0, 1.0, 1.0, 3.0];
        let series = Series { time, signals: vec![("u".into(), vec![0.0, 2.0, 10.0, 20.0])] };
        let later = |time: f64| at(&series, time, true)[0];
        let earlier = |time: f64| at(&series, time, false)[0];
        assert_eq!([-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 9.0].map(later), [0.0, 0.0, 1.0, 10.0, 15.0, 20.0, 20.0]);
        assert_eq!([-1.0, 0.5, 1.0, 2.0, 3.0, 9.0].map(earlier), [0.0, 1.0, 2.0, 15.0, 20.0, 20.0]);
        assert_eq!(later(1.0 - 1e-9), 10.0);
    }

    #[test]
    fn no_number_agrees_with_nothing() {
        let stated = strut_related::Stated { name: "y".into(), unit: "m".into(), rms: 1.0, within: 0.1 };
        let agreement = Agreement { signals: vec![stated], ..Agreement::default() };
        assert!(disagreements(&agreement, &[("y", 1.05)]).is_empty());
        assert_eq!(disagreements(&agreement, &[("y", 1.2)]).len(), 1);
        assert_eq!(disagreements(&agreement, &[("y", f64::NAN)]).len(), 1);
    }
}
