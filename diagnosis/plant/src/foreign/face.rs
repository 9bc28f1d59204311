//! What an FMU declares for those who connect it: roles, units, start values.

use std::path::Path;

use strut_check::import::{Description, Kind, Package, Unit, description};

use super::units::{Conversion, coherent};

/// What an FMU declares.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// Whether it is of FMI 2.0.
    pub is_of_fmi_2: bool,
    /// Whether it is for co-simulation.
    pub co_simulates: bool,
    /// Its variables.
    pub variables: Vec<FaceVariable>,
}

/// A variable as an FMU declares it.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceVariable {
    /// Name.
    pub name: String,
    /// `Real`, `Integer`, `Boolean`, `String` or `Enumeration`.
    pub kind: String,
    /// `input`, `output`, `local`, `parameter` …
    pub causality: String,
    /// Whether a start value may be given before the initialisation.
    pub settable: bool,
    /// Start value, in the file's own digits.
    pub start: Option<String>,
    /// The FMU's unit; none if it states none.
    pub unit: Option<Unit>,
    /// How its values are made values in base units.
    pub conversion: Conversion,
}

impl Face {
    /// Reads an FMU's description.
    ///
    /// # Errors
    /// If the file is no FMU.
    pub fn read(fmu: &Path) -> Result<Self, String> {
        let failed = |error: String| format!("`{}`: {error}", fmu.display());
        let mut package = Package::open(fmu).map_err(failed)?;
        let (description, _) = description(&mut package).map_err(failed)?;
        Ok(Self::of(&description))
    }

    fn of(description: &Description) -> Self {
        let variables = description.variables.iter().map(|it| {
            let unit = it.unit.as_deref().filter(|symbol| !symbol.is_empty()).map(|symbol| {
                let declared = description.units.iter().find(|unit| unit.symbol == symbol).cloned();
                declared.unwrap_or_else(|| Unit::named(symbol))
            });
            let exact = it.effective_initial() == Some("exact") && it.variability != "constant";
            FaceVariable {
                name: it.name.clone(),
                kind: it.kind.clone(),
                causality: it.causality.clone(),
                settable: exact || it.causality == "input",
                start: it.start.clone(),
                conversion: coherent(it.unit.as_deref(), &description.units).1,
                unit,
            }
        });
        Self {
            is_of_fmi_2: !description.is_of_another_version(),
            co_simulates: description.interfaces.iter().any(|it| it.kind == Kind::CoSimulation),
            variables: variables.collect(),
        }
    }

    /// The variable of a name.
    pub fn variable(&self, name: &str) -> Option<&FaceVariable> {
        self.variables.iter().find(|it| it.name == name)
    }
}
