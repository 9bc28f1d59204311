//! Files of experiments: each experiment with its values, inputs and expected outputs.

use strut_related::{Experiment, Experiments, Series, Table, media, resolved};

use super::{of_one, parsed, values};
use crate::description::{Description, Variable};
use crate::finding::{Finding, Report, names};
use crate::lines::Lines;
use crate::package::Package;
use crate::rules::related;
use crate::schema;
use crate::text::{self, Standard};

/// What the sentences of the schema are.
const RULES: schema::Rules = of_one(related::EXPERIMENT);

/// An experiment that can be run.
#[derive(Debug)]
pub struct Prepared {
    /// The file.
    pub file: String,
    /// What it says.
    pub experiment: Experiment,
    /// References and values that are set before the initialisation.
    pub values: Vec<(u32, f64)>,
    /// What the inputs do.
    pub stimuli: Series,
    /// References of the inputs.
    pub inputs: Vec<u32>,
    /// Expected outputs.
    pub expected: Series,
    /// References of the outputs.
    pub outputs: Vec<u32>,
}

/// Reads a file of experiments; what is wrong with it is reported.
///
/// # Errors
/// If the archive is damaged.
pub fn prepared(
    bytes: &[u8],
    path: &str,
    package: &mut Package,
    description: &Description,
    report: &mut Report,
) -> Result<Vec<Prepared>, String> {
    let (text, encoding) = text::decoded(bytes, Standard::Ssp, path);
    report.findings.extend(encoding.into_iter().map(|it| Finding { rule: related::EXPERIMENT, ..it }));
    let (experiments, document) = match parsed(&text, Experiments::read) {
        Ok(read) => read,
        Err(error) => {
            let message = format!("the experiments cannot be read: {error}");
            report.findings.push(Finding::error(related::EXPERIMENT, message).at(path));
            return Ok(Vec::new());
        }
    };
    let (root, lines) = (document.root_element(), Lines::of(&text));
    let found = schema::validate(root, &schema::related::EXPERIMENTS, &RULES, path, &lines);
    let is_valid = found.is_empty();
    report.findings.extend(found);
    if !is_valid {
        return Ok(Vec::new());
    }
    let mut prepared = Vec::new();
    for experiment in experiments.all {
        let name = experiment.name.clone();
        if let Some(other) = unsupported(&experiment) {
            report.skipped.push(format!("the experiment `{name}`: {other}"));
            continue;
        }
        match Prepared::new(path, experiment, package, description)? {
            Ok(Some(ready)) => prepared.push(ready),
            Ok(None) => {
                report
                    .skipped
                    .push(format!("the experiment `{name}`: it sets or compares other values than Reals"));
            }
            Err(message) => {
                let message = format!("the experiment `{name}`: {message}");
                report.findings.push(Finding::error(related::DATA, message).at(path));
            }
        }
    }
    Ok(prepared)
}

/// Why an experiment is beyond this program, if it is.
fn unsupported(experiment: &Experiment) -> Option<String> {
    if let Some(analysis) = &experiment.analysis {
        return Some(format!("it is no simulation but <{analysis}>"));
    }
    let tables = [&experiment.stimuli, &experiment.references];
    let other = tables.into_iter().flatten().find(|table| table.media != media::TABLE)?;
    Some(format!("`{}` is of the type {}", other.source, other.media))
}

impl Prepared {
    /// A result without an experiment: that of the default experiment, as the Reference FMUs have it. What it has to come to nobody
    /// says; none if it is of other than this FMU's Reals.
    pub fn of_result(path: &str, bytes: &[u8], description: &Description) -> Option<Self> {
        let expected = Series::read(std::str::from_utf8(bytes).ok()?).ok()?;
        let outputs = references(&expected, description, |_| true, "variables").ok()??;
        let name = path.rsplit('/').next().unwrap_or(path).to_owned();
        Some(Self {
            file: path.to_owned(),
            experiment: Experiment { name, ..Experiment::default() },
            values: Vec::new(),
            stimuli: Series::default(),
            inputs: Vec::new(),
            expected,
            outputs,
        })
    }

    /// Brings the files of an experiment together; none if it is of values that cannot be set or compared here, and what is wrong
    /// with them.
    fn new(
        file: &str,
        experiment: Experiment,
        package: &mut Package,
        description: &Description,
    ) -> Result<Result<Option<Self>, String>, String> {
        let mut file_of = |address: &str| -> Result<Result<(String, Vec<u8>), String>, String> {
            let missing = || format!("`{address}` is not in the archive");
            let Some(path) = resolved(file, address) else { return Ok(Err(missing())) };
            Ok(package.read(&path)?.map(|bytes| (path, bytes)).ok_or_else(missing))
        };
        let parameters = experiment.parameters.as_deref().map(&mut file_of).transpose()?.transpose();
        let stimuli = experiment.stimuli.as_ref().map(|it| file_of(&it.source)).transpose()?.transpose();
        let expected = experiment.references.as_ref().map(|it| file_of(&it.source)).transpose()?.transpose();
        let together = || -> Result<Option<Self>, String> {
            let given = match parameters? {
                Some((path, bytes)) => values(&bytes, &path, description)?,
                None => Vec::new(),
            };
            let stimuli = series(experiment.stimuli.as_ref(), stimuli?)?;
            let expected = series(experiment.references.as_ref(), expected?)?;
            let is_input = |it: &Variable| it.causality == "input";
            let (Some(inputs), Some(outputs)) = (
                references(&stimuli, description, is_input, "inputs")?,
                references(&expected, description, |it| it.causality != "input", "outputs")?,
            ) else {
                return Ok(None);
            };
            let names: Vec<&str> = expected.signals.iter().map(|(name, _)| name.as_str()).collect();
            let stated = experiment.agreement.iter().flat_map(|it| &it.signals);
            if let Some(other) = stated.map(|it| &it.name).find(|name| !names.contains(&name.as_str())) {
                return Err(format!("it states an error of `{other}`, of which nothing is expected"));
            }
            let mut numbers = Vec::new();
            for (variable, parameter) in given {
                let (Some(reference), "Real") = (variable.reference, parameter.kind.as_str()) else {
                    return Ok(None);
                };
                let value = parameter.value.trim().parse();
                numbers.push((
                    reference,
                    value.map_err(|_| format!("the value of `{}` is no number", parameter.name))?,
                ));
            }
            let file = file.to_owned();
            Ok(Some(Self { file, experiment, values: numbers, stimuli, inputs, expected, outputs }))
        };
        Ok(together())
    }
}

/// A table; empty where there is none.
fn series(table: Option<&Table>, file: Option<(String, Vec<u8>)>) -> Result<Series, String> {
    let (Some(Table { source, .. }), Some((_, bytes))) = (table, file) else { return Ok(Series::default()) };
    let text = String::from_utf8(bytes).map_err(|_| format!("`{source}` is not encoded in UTF-8"))?;
    Series::read(&text).map_err(|error| format!("`{source}`: {error}"))
}

/// The variables of a table; none if one of them is no Real.
fn references(
    series: &Series,
    description: &Description,
    fits: impl Fn(&Variable) -> bool,
    what: &str,
) -> Result<Option<Vec<u32>>, String> {
    let variables: Vec<(&str, Option<&Variable>)> =
        series.signals.iter().map(|(name, _)| (name.as_str(), description.named(name))).collect();
    let unknown = |(_, variable): &&(&str, Option<&Variable>)| variable.is_none_or(|it| !fits(it));
    let wrong: Vec<&str> = variables.iter().filter(unknown).map(|(name, _)| *name).collect();
    if !wrong.is_empty() {
        return Err(format!("{} are no {what} of the FMU", names(&wrong)));
    }
    let real = |(_, variable): &(&str, Option<&Variable>)| {
        variable.filter(|it| it.kind == "Real").and_then(|it| it.reference)
    };
    Ok(variables.iter().map(real).collect())
}
