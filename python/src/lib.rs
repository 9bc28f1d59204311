//! Strut for Python. What the package `strut` calls; everything here hands over to the libraries that the commands use.

#![allow(clippy::needless_pass_by_value, reason = "what Python hands over is owned")]

mod interrupt;
mod record;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use build_fmu::Wanted;
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use strut_diagnosis::app::study::{self, Outcome, Progress, Study};
use strut_diagnosis::app::virtual_rig::{self, Experiment};
use strut_diagnosis::data::map::Map;
use strut_diagnosis::data::table;
use strut_diagnosis::estimation::deadline::Deadline;
use strut_diagnosis::experiment::Limits;
use strut_diagnosis::report;
use strut_diagnosis::report::extend::Packing;
use strut_diagnosis::report::findings::SignalAccount;
use strut_diagnosis::rig::Rig;
use strut_model::Inputs;

use crate::interrupt::{interruptible, watched};
use crate::record::{Columns, Given, bytes, floats};

/// Sentences of the command line begin with `error:`; an exception needs no such word.
fn wrong(error: String) -> PyErr {
    PyValueError::new_err(error.strip_prefix("error: ").map_or(error.clone(), str::to_owned))
}

/// All FMUs and systems, as JSON.
#[pyfunction]
fn models(py: Python<'_>, libraries: Option<PathBuf>) -> PyResult<String> {
    py.detach(|| build_fmu::list(&build_fmu::strut(), libraries.as_deref())).map_err(wrong)
}

/// One of them, as JSON.
#[pyfunction]
fn describe(py: Python<'_>, name: &str, libraries: Option<PathBuf>) -> PyResult<String> {
    py.detach(|| build_fmu::describe(&build_fmu::strut(), name, libraries.as_deref())).map_err(wrong)
}

/// Makes an FMU; its path.
#[pyfunction]
fn fmu(
    py: Python<'_>,
    model: String,
    values: Vec<String>,
    name: Option<String>,
    folder: PathBuf,
    libraries: Option<PathBuf>,
) -> PyResult<PathBuf> {
    let work = move || {
        let wanted = Wanted::Values(&model, &values, name.as_deref());
        build_fmu::make(&build_fmu::strut(), wanted, &folder, libraries.as_deref())
    };
    interruptible(py, work)?.map_err(wrong)
}

/// Time, then name, unit and values of each signal; all values as bytes of doubles.
type Simulated = (Py<PyBytes>, Vec<(String, String, Py<PyBytes>)>);

/// Simulates an FMU's model.
#[pyfunction]
fn simulate(
    py: Python<'_>,
    model: String,
    values: Vec<String>,
    inputs: Option<Columns>,
    step: Option<f64>,
    stop: Option<f64>,
    libraries: Option<PathBuf>,
) -> PyResult<Simulated> {
    let inputs = inputs.map(|mut columns| {
        let time = columns.remove(0);
        let signals = columns.into_iter().map(|(name, values)| (name, floats(&values))).collect();
        Inputs { time: floats(&time.1), signals }
    });
    let work = move || {
        let project = build_fmu::strut();
        build_fmu::simulate(&project, (&model, &values), inputs.as_ref(), [step, stop], libraries.as_deref())
    };
    let trajectory = interruptible(py, work)?.map_err(wrong)?;
    let signals = trajectory.signals.into_iter();
    let signals = signals.map(|(name, unit, values)| (name, unit, bytes(py, &values))).collect();
    Ok((bytes(py, &trajectory.time), signals))
}

/// Checks an FMU or SSP; the report as JSON. `program` is the command that runs libraries.
#[pyfunction]
fn check(
    py: Python<'_>,
    path: PathBuf,
    program: Vec<PathBuf>,
    runs: [bool; 2],
    timeout: f64,
) -> PyResult<String> {
    let [run, replay] = runs;
    let timeout = Duration::try_from_secs_f64(timeout).map_err(|error| wrong(error.to_string()))?;
    let work = move || {
        let fmpy = strut_check::Fmpy::Without;
        let options =
            strut_check::Options { fmpy, run, signs: false, replay, timeout, program, listener: None };
        let failed = |error: String| format!("{}: {error}", path.display());
        strut_check::check(&path, &options).map_err(failed).map(|report| {
            let strut_check::Report { about, findings, done, skipped, .. } = report;
            serde_json::json!({"about": about, "findings": findings, "done": done, "skipped": skipped})
                .to_string()
        })
    };
    interruptible(py, work)?.map_err(wrong)
}

/// The rigs that can be diagnosed.
#[pyfunction]
fn rigs() -> Vec<String> {
    Rig::names()
}

/// What a rig's records may hold.
#[pyfunction]
fn rig(name: &str) -> PyResult<String> {
    Rig::published(name).map(|rig| report::sheet(&rig)).map_err(wrong)
}

/// Estimation and validation record of a virtual rig, as CSV.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "Python names them")]
fn virtual_records(
    py: Python<'_>,
    rig: &str,
    hide: Vec<String>,
    noise: f64,
    seed: u64,
    step: f64,
    length: f64,
    amplitude: f64,
) -> PyResult<[String; 2]> {
    let rig = Rig::published(rig).map_err(wrong)?;
    let hidden = hide.iter().map(|text| virtual_rig::hidden(&rig, text));
    let hidden = hidden.collect::<Result<Vec<_>, _>>().map_err(wrong)?;
    if !(amplitude.is_finite() && amplitude > 0.0) {
        return Err(wrong("amplitude is a positive factor".into()));
    }
    let sound = noise.is_finite() && noise >= 0.0 && step > 0.0 && length >= 100.0 * step && length <= 1e4;
    if !sound {
        return Err(wrong(
            "noise must not be negative, and a record has at least 100 steps, at most 10 000 s".into(),
        ));
    }
    let experiment = Experiment { hidden, amplitude, noise, seed, step, length };
    let [train, test] = py.detach(|| [1, 2].map(|number| virtual_rig::record(&rig, &experiment, number)));
    Ok([train.map_err(wrong)?, test.map_err(wrong)?])
}

/// Whether a column of this name, without its unit, is the time.
#[pyfunction]
fn is_time(name: &str) -> bool {
    table::is_time(name)
}

/// What a diagnosis found.
#[pyclass(frozen, name = "Outcome")]
struct PyOutcome(Outcome);

#[pymethods]
impl PyOutcome {
    /// The findings, as in report.json.
    fn json(&self, py: Python<'_>) -> String {
        py.detach(|| report::json(&self.0.findings))
    }

    /// The page, as in report.html.
    fn html(&self, py: Python<'_>) -> String {
        py.detach(|| report::html(&self.0.findings))
    }

    /// The summary, as on a terminal.
    fn text(&self) -> String {
        report::terminal(&self.0.findings)
    }

    /// Of each signal: name, root mean square of the starting model's error, and the shares of its power.
    fn account(&self) -> Vec<(String, f64, [f64; 5])> {
        let findings = &self.0.findings;
        let row = |it: &SignalAccount| (it.signal.clone(), it.error, report::shares(findings, it));
        findings.account.iter().map(row).collect()
    }

    /// The extended model's parameter set (TOML); none if the data cannot be used.
    fn parameters(&self) -> Option<&str> {
        self.0.extended.as_ref().map(|extended| &*extended.parameters)
    }

    /// Writes the report and the extended model; returns the notes on it.
    fn save(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        parts: [bool; 2],
        libraries: Option<PathBuf>,
    ) -> PyResult<Vec<String>> {
        let [fmu, record] = parts;
        let Outcome { findings, extended } = &self.0;
        let (failures, notes) = py.detach(|| {
            let (mut failures, mut notes) = (Vec::new(), Vec::new());
            let written = report::write(findings, &folder);
            failures.extend(written.err().into_iter().flatten().map(|error| error.to_string()));
            if let Some(extended) = extended.as_ref().filter(|_| folder.is_dir()) {
                let packing = Packing { libraries: libraries.as_deref(), record };
                let packing = fmu.then_some(packing);
                failures.extend(extended.write(findings, &folder, packing).err().into_iter().flatten());
                notes = extended.notes(packing);
            }
            (failures, notes)
        });
        if failures.is_empty() { Ok(notes) } else { Err(PyOSError::new_err(failures.join("\n"))) }
    }
}

/// Diagnoses; `progress` is called with each stage.
#[pyfunction]
#[pyo3(signature = (train, test, *, rig, parameters, map, sampling_rate, skip_rows, known, effects, limits, time_limit, command, progress))]
#[allow(clippy::too_many_arguments, reason = "Python names them")]
fn diagnose(
    py: Python<'_>,
    train: Vec<Given>,
    test: Vec<Given>,
    rig: Option<String>,
    parameters: Option<PathBuf>,
    map: Option<String>,
    sampling_rate: Option<f64>,
    skip_rows: Option<usize>,
    known: Vec<String>,
    effects: Vec<String>,
    limits: [Option<f64>; 5],
    time_limit: f64,
    command: String,
    progress: Py<PyAny>,
) -> PyResult<PyOutcome> {
    let origins = |given: Vec<Given>| given.into_iter().map(Given::origin).collect::<PyResult<Vec<_>>>();
    let rig = study::rig(rig.as_deref(), parameters.as_deref()).map_err(wrong)?;
    let mut study = Study::new(rig, origins(train)?, origins(test)?);
    for text in &known {
        study.know(text).map_err(wrong)?;
    }
    study.look_at(&effects).map_err(wrong)?;
    if let Some(text) = map {
        study.map = Map::parse(&text).map_err(|error| wrong(error.to_string()))?;
    }
    study.map.reading = study.map.reading.or(sampling_rate, skip_rows);
    let [stroke, force, rate, bandwidth, duration] = limits;
    if limits.iter().flatten().any(|limit| !(limit.is_finite() && *limit > 0.0)) {
        return Err(wrong("the limits of an experiment are positive numbers in SI units".into()));
    }
    study.limits = Limits { stroke, force, rate, bandwidth, duration };
    let limit = Duration::try_from_secs_f64(time_limit).map_err(|error| wrong(error.to_string()))?;
    let stop = Arc::new(AtomicBool::new(false));
    let deadline = Deadline::after(limit).or_when(stop.clone());
    let work = move |told: &(dyn Fn(&str) + Sync)| {
        study.run(deadline, &|progress: Progress<'_>| {
            if let Progress::Stage(text) = progress {
                told(text);
            }
        })
    };
    let mut outcome =
        watched(py, &stop, work, |text| progress.call1(py, (text,)).map(|_| ()))?.map_err(wrong)?;
    if let Some(provenance) = &mut outcome.findings.provenance {
        provenance.command = command;
    }
    Ok(PyOutcome(outcome))
}

#[pymodule]
fn _strut(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", build_fmu::VERSION)?;
    module.add_class::<PyOutcome>()?;
    for function in [
        wrap_pyfunction!(models, module)?,
        wrap_pyfunction!(describe, module)?,
        wrap_pyfunction!(fmu, module)?,
        wrap_pyfunction!(simulate, module)?,
        wrap_pyfunction!(check, module)?,
        wrap_pyfunction!(rigs, module)?,
        wrap_pyfunction!(rig, module)?,
        wrap_pyfunction!(is_time, module)?,
        wrap_pyfunction!(virtual_records, module)?,
        wrap_pyfunction!(diagnose, module)?,
    ] {
        module.add_function(function)?;
    }
    Ok(())
}
