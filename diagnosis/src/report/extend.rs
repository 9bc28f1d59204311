//! The extended model: a parameter set, an SSV and an FMU.

mod validation;

use std::fmt::Write;
use std::path::Path;

use strut_model::Value;
use strut_related::{Files, Given, ParameterSet, Related, media};

use crate::catalogue::naming;
use crate::diagnosis::Diagnosis;
use crate::estimation::unknowns::Unknown;
use crate::report::file::replace;
use crate::report::findings::Findings;
use crate::rig::{self, Kind, Rig};

use super::augment::{self, System};
use validation::Validation;

pub use validation::Segment;

/// Name of the FMU.
pub const NAME: &str = "extended";

impl Diagnosis<'_> {
    /// The rig file of a foreign model with the values that were found.
    fn rig_file(&self) -> String {
        let rig = self.baseline.rig;
        let point = self.found.extended.point.within(&rig.plant);
        let mut kind = Kind::clone(&rig.kind);
        for (declared, value) in rig.plant.parameters.iter().zip(rig.plant.own(&point.parameters)) {
            if value != declared.start {
                kind.values.insert(declared.name.clone(), rig::Given::Number(value));
            }
        }
        format!(
            "# The rig file with the values that a diagnosis has found.\n{}{}",
            kind.text(),
            self.passed()
        )
    }

    /// The extended model's parameter set, as `build-fmu --parameters` takes it.
    fn parameter_set(&self) -> String {
        let judged = self.baseline.rig;
        let extended = &self.found.extended;
        let point = extended.point.within(&judged.plant);
        // Of a rig that nobody measured whole, what was found of a part is a value of the whole.
        let rig = judged.of.as_deref().unwrap_or(judged);
        let choices = match judged.of {
            Some(_) => rig.choices.clone(),
            None => self.baseline.choices(&extended.terms),
        };
        let mut text = format!(
            "fmu = \"{NAME}\"\nmodel = \"{}\"\ntitle = \"{} as a diagnosis has extended it\"\nsource = \"diagnosis\"\n\n\
             [values]\n",
            rig.plant.name, rig.fmu
        );
        let found = judged.plant.own(&point.parameters);
        for (declared, given) in rig.plant.parameters.iter().zip(rig.plant.own(&rig.parameters)) {
            let index = judged.plant.parameter(&declared.name);
            let value = index.map_or(given, |index| found[index]);
            let own = extended.coordinates.iter().any(|it| index.map(Unknown::Parameter) == Some(it.handle));
            let fitted = own || value != given;
            if fitted || value != declared.start {
                let source = if fitted { "fitted to the records" } else { "starting model" };
                let unit = declared.unit.symbol;
                let (low, high) = (declared.min.unwrap_or(f64::MIN), declared.max.unwrap_or(f64::MAX));
                let value = value.clamp(low, high);
                let _ = writeln!(
                    text,
                    "\"{}\" = {{ value = {value:?}, unit = \"{unit}\", source = \"{source}\" }}",
                    declared.name
                );
            }
        }
        for (declared, start) in rig.plant.states.iter().zip(&rig.start) {
            if *start != declared.start {
                let (name, unit) = (&declared.name, declared.unit.symbol);
                let _ = writeln!(
                    text,
                    "\"{name}\" = {{ value = {start:?}, unit = \"{unit}\", source = \"starting model\" }}"
                );
            }
        }
        for (declaration, choice) in rig.plant.settings.iter().zip(&choices) {
            let value = match (choice, declaration.kind) {
                (Value::Boolean(flag), _) => flag.to_string(),
                (Value::Integer(item), strut_model::SettingKind::Choice(enumeration)) => {
                    format!("\"{}\"", enumeration.items[*item as usize - 1].0)
                }
                (Value::Integer(number), _) => number.to_string(),
                (Value::Text(text), _) => format!("{text:?}"),
                (Value::Real(number), _) => format!("{number:?}"),
            };
            let _ = writeln!(
                text,
                "\"{}\" = {{ value = {value}, source = \"starting model\" }}",
                declaration.name
            );
        }
        text + &self.passed()
    }

    /// What signals pass, in comments; empty if they pass nothing.
    fn passed(&self) -> String {
        let rig = self.baseline.rig;
        let extended = &self.found.extended;
        let point = extended.point.within(&rig.plant);
        let signals: Vec<String> = extended
            .coordinates
            .iter()
            .filter(|it| !matches!(it.handle, Unknown::Parameter(_)) && point.get(it.handle) != 0.0)
            .map(|it| {
                let (name, unit) = naming::handle(it.handle, &rig.plant);
                format!("# {name} = {:?} {unit}\n", point.get(it.handle))
            })
            .collect();
        if signals.is_empty() {
            return String::new();
        }
        format!(
            "\n# What signals pass on their way into the model and out of it, the timing of the channels included:\n{}",
            signals.concat()
        )
    }

    /// The fitted values for the starting model's FMU, with their intervals.
    fn fitted(&self) -> ParameterSet {
        let rig: &Rig = self.baseline.rig;
        let point = self.found.extended.point.within(&rig.plant);
        let found = rig.plant.own(&point.parameters);
        let given = |(index, (declared, value)): (usize, (&strut_model::Declaration, &f64))| {
            let value = *value;
            if value == rig.parameters[index] {
                return None;
            }
            let interval = self.intervals.iter().find(|it| it.handle == Unknown::Parameter(index));
            let interval = interval.filter(|it| it.half.is_finite()).map(|it| [it.low(), it.high()]);
            Some(Given {
                name: declared.name.clone(),
                value: Value::Real(value),
                unit: declared.unit.symbol.into(),
                source: "fitted to the records".into(),
                interval,
            })
        };
        ParameterSet {
            name: NAME.into(),
            description: format!("{} as a diagnosis has extended it", rig.fmu),
            values: rig.plant.parameters.iter().zip(&found).enumerate().filter_map(given).collect(),
        }
    }

    /// The extended model's files.
    pub fn extended(&self) -> Extended {
        let ssv = String::from_utf8(self.fitted().document()).expect("XML is written in UTF-8");
        let is_foreign = self.baseline.rig.kind.is_foreign();
        let parameters = if is_foreign { self.rig_file() } else { self.parameter_set() };
        let segment = self.liveliest();
        let augmented = is_foreign.then(|| self.augmented(segment.as_ref()));
        let validation = segment.filter(|_| !is_foreign).and_then(|it| self.validation(&it));
        Extended { parameters, ssv, is_foreign, validation, augmented }
    }
}

/// The extended model's files.
#[derive(Clone, Debug, PartialEq)]
pub struct Extended {
    /// The parameter set in TOML, as `build-fmu --parameters` takes it; of a foreign model its rig file.
    pub parameters: String,
    /// The fitted values as SSP's parameter set.
    pub ssv: String,
    /// Whether the model is another maker's, of which no FMU is made.
    is_foreign: bool,
    validation: Option<Validation>,
    /// Of another maker's model, the system that it is augmented to, or why there is none.
    augmented: Option<Result<System, String>>,
}

/// How `extended.fmu` and `augmented.ssp` are made.
#[derive(Clone, Copy, Debug)]
pub struct Packing<'a> {
    /// Folder of prebuilt libraries; without one, they are beside the program, or cargo builds them.
    pub libraries: Option<&'a Path>,
    /// Whether a part of a validation record goes into it; without one there is no `augmented.ssp`, which it drives.
    pub record: bool,
}

/// The files that may be written.
pub(super) const FILES: [&str; 4] = ["extended.toml", "extended.ssv", "extended.fmu", "augmented.ssp"];

impl Extended {
    /// Writes `extended.toml` and `extended.ssv` into a folder that exists, and `extended.fmu` or, of another maker's model,
    /// `augmented.ssp` if asked for. One failure does not keep the others from being written.
    ///
    /// # Errors
    /// Every file that cannot be written or built, with what to do.
    pub fn write(
        &self,
        findings: &Findings,
        folder: &Path,
        fmu: Option<Packing<'_>>,
    ) -> Result<(), Vec<String>> {
        let set = folder.join("extended.toml");
        let mut failures = Vec::new();
        for (path, text) in [(&set, &self.parameters), (&folder.join("extended.ssv"), &self.ssv)] {
            if let Err(error) = replace(path, text) {
                failures.push(format!("cannot write `{}`: {error}", path.display()));
            }
        }
        if let (Some(packing), true) = (fmu.filter(|_| !self.is_foreign), failures.is_empty()) {
            let wanted = build_fmu::Wanted::Parameters(&set, self.related(findings, packing.record));
            if let Err(error) = build_fmu::make(&build_fmu::strut(), wanted, folder, packing.libraries) {
                let error = error.strip_prefix("error: ").unwrap_or(&error);
                failures.push(format!("no extended.fmu: {error}"));
            }
        }
        if let (Some(packing), Some(Ok(system))) = (fmu.filter(|it| it.record), &self.augmented)
            && let Err(error) = packed(system, folder, packing.libraries)
        {
            let error = error.strip_prefix("error: ").unwrap_or(&error);
            failures.push(format!("no {}.ssp: {error}", augment::NAME));
        }
        if failures.is_empty() { Ok(()) } else { Err(failures) }
    }

    /// The notes on `augmented.ssp`: the reason if there is none, and its differences from the report.
    pub fn notes(&self, packing: Option<Packing<'_>>) -> Vec<String> {
        let file = format!("{}.ssp", augment::NAME);
        match (&self.augmented, packing) {
            (None, _) | (_, None) => Vec::new(),
            (Some(Err(reason)), _) => vec![format!("no {file}: {reason}")],
            (Some(Ok(_)), Some(Packing { record: false, .. })) => {
                vec![format!("no {file}: a record drives it, and --no-record leaves records out")]
            }
            (Some(Ok(system)), Some(_)) => {
                system.notes.iter().map(|note| format!("{file}: {note}")).collect()
            }
        }
    }

    /// What travels with the FMU.
    fn related(&self, findings: &Findings, record: bool) -> Files {
        let mut files = Files::default();
        let text = "Fitted values for the starting model, with 95 % intervals; this FMU has them itself";
        files
            .add(Related::new(media::PARAMETERS, "extended.ssv", "parameter", text), self.ssv.clone().into());
        let text = "Verdict, effects, parameters with intervals, errors and account of the diagnosis; without pictures, \
                    candidates and the missing signal over time";
        files.add(Related::new(media::JSON, "report.json", "report", text), digest(findings).into());
        if let Some(validation) = self.validation.as_ref().filter(|_| record) {
            validation.add(&mut files);
        }
        files
    }
}

/// Writes a system into a folder; what it is made of lies in another one as long as it takes.
fn packed(system: &System, folder: &Path, libraries: Option<&Path>) -> Result<(), String> {
    let parts = tempfile::tempdir().map_err(|error| format!("cannot make a temporary folder: {error}"))?;
    for (name, text) in &system.files {
        replace(&parts.path().join(name), text).map_err(|error| format!("cannot write `{name}`: {error}"))?;
    }
    let file = parts.path().join(format!("{}.toml", augment::NAME));
    build_fmu::make(&build_fmu::strut(), build_fmu::Wanted::System(&file, augment::NAME), folder, libraries)
        .map(|_| ())
}

/// The findings without what fills megabytes.
fn digest(findings: &Findings) -> String {
    let mut value = serde_json::to_value(findings).expect("plain data");
    if let Some(fields) = value.as_object_mut() {
        for large in ["pictures", "candidates", "missing", "deciding_experiment"] {
            fields.remove(large);
        }
    }
    serde_json::to_string_pretty(&value).expect("plain data")
}
