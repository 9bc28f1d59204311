//! What travels with each FMU (FMI-LS-REF): its parameter set with sources, an experiment with expected outputs, and where its
//! documentation and licence are.

use strut_model::{Interface, Trajectory, Value, VariableKind};
use strut_related::{
    Agreement, Between, Experiment, Experiments, Files, Given, ParameterSet, Related, Series, Stated, Table,
    media, rounded,
};

use crate::fmu::{Fmu, Set};
use crate::version::Version;

/// Most communication steps of the experiment: enough to see the library's work, few enough for a few kB.
pub const STEPS: usize = 200;
/// Digits of the largest value that tables keep.
const DIGITS: i32 = 9;
/// How far a replay may be from the expected outputs, as a share of the largest value: far beyond rounding, far within what any
/// change of the model does.
const WITHIN: f64 = 1e-6;
/// A signal below this share of its nominal value is rounding, as a velocity between the edges of a square.
const NOTHING: f64 = 1e-6;

/// The files of an FMU whose default experiment was recorded; its inputs come first.
pub fn files(fmu: &Fmu, version: Version, interface: &Interface, recorded: (&Trajectory, usize)) -> Files {
    let mut files = fmu.related.clone().unwrap_or_else(|| own(fmu, version, interface, recorded));
    let document = |source: &str, text: &str| Related::new(media::HTML, source, "document", text);
    files.name(document(
        "../../documentation/index.html",
        "Equations, variables, sources and default experiment",
    ));
    files
}

fn own(
    fmu: &Fmu,
    version: Version,
    interface: &Interface,
    (trajectory, inputs): (&Trajectory, usize),
) -> Files {
    let mut files = Files::default();
    if let Some(set) = &fmu.set {
        let parameters = parameters(set, version, interface);
        if !parameters.values.is_empty() {
            let text = format!("Values of this FMU with their sources: {}", set.parsed.title);
            files.add(
                Related::new(media::PARAMETERS, "parameters.ssv", "parameter", text),
                parameters.document(),
            );
        }
    }
    if trajectory.signals.len() > inputs {
        regression(&mut files, interface, trajectory, inputs);
    }
    files
}

/// The values of a published set, each with where it comes from.
fn parameters(set: &Set, version: Version, interface: &Interface) -> ParameterSet {
    let given = |(name, given): (&String, &strut_model::Given)| {
        // A table is one variable in FMI 3.0, and a set of SSP 1.0 has no arrays.
        if version == Version::Three && name.ends_with(']') {
            return None;
        }
        let kind = &interface.variable(name)?.kind;
        let value = match kind {
            VariableKind::Real { start, .. } => Value::Real((*start)?),
            VariableKind::Integer { start } | VariableKind::Choice { start, .. } => Value::Integer(*start),
            VariableKind::Boolean { start } => Value::Boolean(*start),
            VariableKind::Text { start } => Value::Text(start.clone()),
        };
        let unit = match kind {
            VariableKind::Real { unit, .. } => unit.symbol.to_string(),
            _ => String::new(),
        };
        let assumed = if given.assumed { "assumed: " } else { "" };
        let source = format!("{assumed}{}", given.source);
        Some(Given { name: name.clone(), value, unit, source, interval: None })
    };
    ParameterSet {
        name: set.parsed.fmu.clone(),
        description: format!("{} ({})", set.parsed.title, set.parsed.source),
        values: set.parsed.values.iter().filter_map(given).collect(),
    }
}

/// The default experiment with what came of it when the FMU was packed.
fn regression(files: &mut Files, interface: &Interface, trajectory: &Trajectory, inputs: usize) {
    let steps = trajectory.time.len() - 1;
    let stop = trajectory.time[steps];
    let table = |signals: &[(String, String, Vec<f64>)], digits: i32| Series {
        time: trajectory.time.clone(),
        signals: signals.iter().map(|(name, _, values)| (name.clone(), rounded(values, digits))).collect(),
    };
    let (driven, found) = trajectory.signals.split_at(inputs);
    let stated = |(name, unit, values): &(String, String, Vec<f64>)| {
        let nominal = match interface.variable(name).map(|it| &it.kind) {
            Some(VariableKind::Real { nominal, .. }) => nominal.unwrap_or(1.0),
            _ => 1.0,
        };
        let largest = values.iter().fold(NOTHING * nominal, |largest, it| largest.max(it.abs()));
        Stated { name: name.clone(), unit: unit.clone(), rms: 0.0, within: WITHIN * largest }
    };
    let origin = "the expected outputs are those of the packager, which has the same equations: they show that the \
                  library still does what it did, and say nothing on how true the model is";
    let experiment = Experiment {
        name: "default-experiment".into(),
        description: format!(
            "The default experiment in {steps} communication steps; inputs are held over each"
        ),
        start: Some(0.0),
        stop: Some(stop),
        step: Some(stop / steps as f64),
        stimuli: (!driven.is_empty()).then(|| Table::csv("default-experiment-in.csv")),
        references: Some(Table::csv("default-experiment-out.csv")),
        agreement: Some(Agreement {
            inputs: Between::Held,
            origin: origin.into(),
            signals: found.iter().map(stated).collect(),
        }),
        ..Experiment::default()
    };
    let experiments = Experiments {
        name: "Regression".into(),
        description: "Whether the library does what it did when it was packed".into(),
        all: vec![experiment],
    };
    let text = "The default experiment with the outputs of the packager: a regression test, no validation";
    let file = Related::new(media::EXPERIMENTS, "default-experiment.exp", "experiment/smoke-test", text);
    files.add(file, experiments.document());
    if !driven.is_empty() {
        // Inputs as they were set: all digits.
        files.attach("default-experiment-in.csv", table(driven, 17).text().into());
    }
    files.attach("default-experiment-out.csv", table(found, DIGITS).text().into());
}
