//! A whole diagnosis: from records to findings and the extended model. It reads files and writes none.

use std::cell::OnceCell;
use std::path::Path;
use std::time::{Duration, Instant};

use strut_model::ParameterSet;

use crate::catalogue::naming;
use crate::data::Origin;
use crate::data::check::DataProblem;
use crate::data::map::Map;
use crate::data::table::did_you_mean;
use crate::dataset::load::{Loaded, load};
use crate::dataset::recorded::Dataset;
use crate::dataset::split::Split;
use crate::dataset::witness;
use crate::decision::rules::tells_more;
use crate::diagnosis::component::Component;
use crate::diagnosis::{Diagnosis, Options};
use crate::estimation::deadline::{Deadline, Stage};
use crate::experiment::Limits;
use crate::plausibility;
use crate::report::extend::Extended;
use crate::report::findings::{Findings, RecordRead};
use crate::report::provenance::Provenance;
use crate::rig::Rig;

/// How often segments are made shorter over which a model that drifts is compared.
const SHORTER: usize = 2;

/// What a diagnosis is made of.
#[derive(Debug)]
pub struct Study {
    /// The rig with its starting model.
    pub rig: Rig,
    /// Estimation records.
    pub train: Vec<Origin>,
    /// Validation records, of another excitation.
    pub test: Vec<Origin>,
    /// Names, units, signs and delays of the records' columns.
    pub map: Map,
    /// Numbers of the effects that are looked at; none: all.
    pub effects: Vec<String>,
    /// Limits of a deciding experiment.
    pub limits: Limits,
    /// A component of the method that is left out, for an ablation.
    pub without: Option<Component>,
}

/// What a diagnosis tells while it runs.
#[derive(Clone, Copy, Debug)]
pub enum Progress<'a> {
    /// How the records were read.
    Read(&'a [RecordRead]),
    /// What it does from now on.
    Stage(&'a str),
}

/// What comes out of it.
#[derive(Debug)]
pub struct Outcome {
    /// The findings.
    pub findings: Findings,
    /// The extended model; none if the data cannot be used.
    pub extended: Option<Extended>,
}

impl Study {
    /// A diagnosis of a rig from estimation and validation records, with nothing else known.
    pub fn new(rig: Rig, train: Vec<Origin>, test: Vec<Origin>) -> Self {
        let (map, limits) = (Map::default(), Limits::default());
        Self { rig, train, test, map, effects: Vec::new(), limits, without: None }
    }

    /// Takes a parameter as measured independently, e.g. `sprung_mass=94.4±0.5` (or with `+-`), in its SI unit.
    ///
    /// # Errors
    /// If the text is of another form, the rig fits no parameter of the name, or the value is out of its bounds.
    pub fn know(&mut self, text: &str) -> Result<(), String> {
        let known = known(&self.rig, text)?;
        // What is said last counts, also instead of the rig file.
        self.rig.known.retain(|(index, ..)| *index != known.0);
        self.rig.known.push(known);
        Ok(())
    }

    /// Looks only at the effects of these numbers, e.g. `01`.
    ///
    /// # Errors
    /// If the rig has no effect of a number.
    pub fn look_at(&mut self, effects: &[String]) -> Result<(), String> {
        let numbers = naming::numbers(&self.rig.plant);
        if let Some(wrong) = effects.iter().find(|it| !numbers.contains(it)) {
            return Err(format!("{wrong}: {} has the effects {}", self.rig.name, numbers.join(", ")));
        }
        self.effects.extend_from_slice(effects);
        Ok(())
    }

    /// Diagnoses. `progress` gets how the records were read, and each stage; a [`Deadline`] may end it early, with the best
    /// answer so far.
    ///
    /// # Errors
    /// If a record cannot be read or lacks signals that the rig needs, or the model diverges on the records: what to do.
    pub fn run(
        mut self,
        deadline: Deadline,
        progress: &(dyn Fn(Progress<'_>) + Sync),
    ) -> Result<Outcome, String> {
        let clock = Instant::now();
        let provenance = Provenance::of(self.train.iter().chain(&self.test));
        let all: Vec<&Origin> = self.train.iter().chain(&self.test).collect();
        let loaded = load(&mut self.rig, &all, &self.map)?;
        let read = loaded.read.clone();
        progress(Progress::Read(&read));
        let mut outcome =
            self.diagnose(loaded, deadline, &|text: &str| progress(Progress::Stage(text)), clock)?;
        outcome.findings.provenance = Some(provenance);
        outcome.findings.records = read;
        Ok(outcome)
    }

    fn diagnose(
        &mut self,
        loaded: Loaded,
        deadline: Deadline,
        progress: &(dyn Fn(&str) + Sync),
        clock: Instant,
    ) -> Result<Outcome, String> {
        let Loaded { mut records, mut problems, .. } = loaded;
        if let Some(outcome) = self.refused(&problems) {
            return Ok(outcome);
        }
        let test: Vec<Dataset> = records.split_off(self.train.len());
        problems.extend(witness::notes(&records, &test, &self.rig.plant.inputs));
        let (known, only) = (self.rig.known.clone(), self.effects.clone());
        let options = Options { known, only, without: self.without, deadline };
        progress("removing the noise of the inputs");
        let whole = Split::new(&records, test);
        progress("comparing each column with the model");
        problems.extend(plausibility::problems(&self.rig, &whole, &options)?);
        if let Some(outcome) = self.refused(&problems) {
            return Ok(outcome);
        }
        let mut diagnosis = whole.diagnosed(&self.rig, options.clone(), progress)?;
        let shorter = [const { OnceCell::new() }; SHORTER];
        let mut last = &whole;
        for cell in &shorter {
            if !diagnosis.is_lost() {
                break;
            }
            let Some(parts) = last.in_parts(&self.rig) else { break };
            if diagnosis.baseline.deadline.is_over(Stage::Segments) {
                break;
            }
            last = cell.get_or_init(|| parts);
            progress("comparing over shorter segments");
            let options = Options { deadline: options.deadline.again(), ..options.clone() };
            let again = last.diagnosed(&self.rig, options, progress)?;
            if !again.is_lost() && tells_more(again.finds_something(), diagnosis.finds_something()) {
                problems.push(last.note());
                diagnosis = again;
            }
        }
        progress("comparing experiments that separate the rivals");
        Ok(told(&diagnosis, self.limits, problems, clock.elapsed()))
    }

    /// That the data cannot be used, if they cannot.
    fn refused(&self, problems: &[DataProblem]) -> Option<Outcome> {
        problems.iter().find(|problem| problem.fatal)?;
        let names = |origins: &[Origin]| origins.iter().map(Origin::name).collect();
        let (train, test) = (names(&self.train), names(&self.test));
        let findings = Findings::of_bad_data(&self.rig.name, train, test, problems.to_vec());
        Some(Outcome { findings, extended: None })
    }
}

/// The rig of a name or a rig file, with the parameters of a set (TOML) in place of its own if there is one; or the set's rig.
///
/// # Errors
/// If neither is given, the file cannot be read, or the set does not fit the rig: what to do.
pub fn rig(name: Option<&str>, parameters: Option<&Path>) -> Result<Rig, String> {
    let path = match (parameters, name) {
        (Some(_), Some(file)) if file.ends_with(".toml") => {
            return Err(format!(
                "`{file}` is a rig file, which has its own parameters (`[values]`): leave --parameters out"
            ));
        }
        (Some(path), _) => path,
        (None, Some(file)) if file.ends_with(".toml") => return Rig::read(Path::new(file)),
        (None, Some(name)) => return Rig::published(name),
        (None, None) => return Err(format!("which rig? Give --rig with one of {}", Rig::names().join(", "))),
    };
    let failed = |error: String| format!("{}: {error}", path.display());
    let text = std::fs::read_to_string(path)
        .map_err(|error| format!("cannot read `{}`: {error}", path.display()))?;
    let mut rig = ParameterSet::parse(&text).and_then(|set| Rig::of(&set)).map_err(failed)?;
    if let Some(name) = name {
        let named = Rig::published(name)?;
        if named.plant.name != rig.plant.name {
            return Err(format!(
                "`{}` is a set for a {}, and the rig {name} is a {}",
                path.display(),
                rig.plant.name,
                named.plant.name
            ));
        }
        rig.name = name.into();
    }
    Ok(rig)
}

/// What a diagnosis found, with the experiment that decides between rivals.
fn told(
    diagnosis: &Diagnosis<'_>,
    limits: Limits,
    mut problems: Vec<DataProblem>,
    before: Duration,
) -> Outcome {
    let clock = Instant::now();
    let deciding = diagnosis.deciding_experiment(limits).unwrap_or_else(|error| {
        problems.push(DataProblem {
            record: "all".into(),
            signal: "experiment".into(),
            text: format!("no experiment is computed: {error}"),
            fatal: false,
        });
        None
    });
    let mut findings = diagnosis.findings(problems, (before + clock.elapsed()).as_secs_f64());
    if let Some(deciding) = deciding {
        findings.decide(deciding);
    }
    Outcome { findings, extended: Some(diagnosis.extended()) }
}

/// `sprung_mass=94.4±0.5`, or with `+-`.
fn known(rig: &Rig, text: &str) -> Result<(usize, f64, f64), String> {
    let wrong = || format!("{text}: write NAME=VALUE±DEVIATION, as in sprung_mass=94.4±0.5");
    let (name, value) = text.split_once('=').ok_or_else(wrong)?;
    let (value, deviation) = value.split_once('±').or_else(|| value.split_once("+-")).ok_or_else(wrong)?;
    let number = |text: &str| text.trim().parse::<f64>().map_err(|_| wrong());
    let (value, deviation) = (number(value)?, number(deviation)?);
    let index =
        rig.base().into_iter().find(|index| rig.plant.parameters[*index].name == name.trim()).ok_or_else(
            || {
                let names = rig.base().into_iter().map(|index| rig.plant.parameters[index].name.as_str());
                let hint = did_you_mean(name.trim(), names);
                format!("{text}: {} has no parameter `{}` that is fitted{hint}", rig.name, name.trim())
            },
        )?;
    if !value.is_finite() || !deviation.is_finite() || deviation <= 0.0 {
        return Err(format!("{text}: the value has to be finite, its deviation finite and positive"));
    }
    let declared = &rig.plant.parameters[index];
    let below = declared.min.filter(|least| value < *least).map(|least| format!("at least {least}"));
    let above = declared.max.filter(|most| value > *most).map(|most| format!("at most {most}"));
    if let Some(bound) = below.or(above) {
        let unit = declared.unit.symbol;
        return Err(format!("{text}: {} has to be {bound} {unit}", declared.name));
    }
    Ok((index, value, deviation))
}
