//! The extended model: a parameter set, an SSV and an FMU.

use std::fmt::Write;
use std::path::Path;

use strut_model::Value;

use crate::catalogue::naming;
use crate::diagnosis::Diagnosis;
use crate::estimation::fit::Unknown;
use crate::report::file::replace;
use crate::rig::Rig;

/// Name of the FMU.
pub const NAME: &str = "extended";

impl Diagnosis<'_> {
    /// The extended model's parameter set, as `build-fmu --parameters` takes it.
    fn parameter_set(&self) -> String {
        let rig = self.baseline.rig;
        let extended = &self.found.extended;
        let point = extended.point.within(&rig.plant);
        let choices = self.baseline.choices(&extended.terms);
        let mut text = format!(
            "fmu = \"{NAME}\"\nmodel = \"{}\"\ntitle = \"{} as a diagnosis has extended it\"\nsource = \"diagnosis\"\n\n\
             [values]\n",
            rig.plant.name, rig.fmu
        );
        for (index, declared) in rig.plant.parameters.iter().enumerate() {
            let value = point.parameters[index];
            let own = extended.coordinates.iter().any(|it| it.handle == Unknown::Parameter(index));
            let fitted = own || value != extended.point.parameters[index];
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
        let signals: Vec<String> = extended
            .coordinates
            .iter()
            .filter(|it| !matches!(it.handle, Unknown::Parameter(_)) && point.get(it.handle) != 0.0)
            .map(|it| {
                let (name, unit) = naming::handle(it.handle, &rig.plant);
                format!("# {name} = {:?} {unit}\n", point.get(it.handle))
            })
            .collect();
        if !signals.is_empty() {
            let _ = write!(
                text,
                "\n# What signals pass on their way into the model and out of it, the timing of the channels included:\n{}",
                signals.concat()
            );
        }
        text
    }

    /// The fitted values as a parameter set of SSP 1.0, for the starting model's FMU.
    fn ssv(&self) -> String {
        let rig: &Rig = self.baseline.rig;
        let point = self.found.extended.point.within(&rig.plant);
        let mut text = String::from(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<ssv:ParameterSet version=\"1.0\" name=\"extended\" \
             xmlns:ssv=\"http://ssp-standard.org/SSP1/SystemStructureParameterValues\">\n  <ssv:Parameters>\n",
        );
        for (index, declared) in rig.plant.parameters.iter().enumerate() {
            let value = point.parameters[index];
            if value != rig.parameters[index] {
                let _ = writeln!(
                    text,
                    "    <ssv:Parameter name=\"{}\"><ssv:Real value=\"{value:?}\"/></ssv:Parameter>",
                    declared.name
                );
            }
        }
        text.push_str("  </ssv:Parameters>\n</ssv:ParameterSet>\n");
        text
    }

    /// The extended model's files.
    pub fn extended(&self) -> Extended {
        Extended { parameters: self.parameter_set(), ssv: self.ssv() }
    }
}

/// The extended model's files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Extended {
    /// The parameter set in TOML, as `build-fmu --parameters` takes it.
    pub parameters: String,
    /// The fitted values as SSP's parameter set.
    pub ssv: String,
}

impl Extended {
    /// Writes `extended.toml` and `extended.ssv` into a folder that exists, and `extended.fmu` if asked for, of the library
    /// in `libraries` or beside the program, or else by cargo. One failure does not keep the others from being written.
    ///
    /// # Errors
    /// Every file that cannot be written or built, with what to do.
    pub fn write(&self, folder: &Path, fmu: bool, libraries: Option<&Path>) -> Result<(), Vec<String>> {
        let set = folder.join("extended.toml");
        let mut failures = Vec::new();
        for (path, text) in [(&set, &self.parameters), (&folder.join("extended.ssv"), &self.ssv)] {
            if let Err(error) = replace(path, text) {
                failures.push(format!("cannot write `{}`: {error}", path.display()));
            }
        }
        if fmu && failures.is_empty() {
            let wanted = build_fmu::Wanted::Parameters(&set);
            if let Err(error) = build_fmu::make(&build_fmu::strut(), wanted, folder, libraries) {
                let error = error.strip_prefix("error: ").unwrap_or(&error);
                failures.push(format!("no extended.fmu: {error}"));
            }
        }
        if failures.is_empty() { Ok(()) } else { Err(failures) }
    }
}
