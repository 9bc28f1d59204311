//! A component: an FMU for co-simulation, of FMI 2.0 or 3.0.

use std::collections::HashMap;
use std::path::Path;

use fmi::fmi2::instance::{CoSimulation as _, Common as _};
use fmi::fmi3::{CoSimulation as _, Common as _, Fmi3Model as _, GetSet as _};
use fmi::schema::{MajorVersion, fmi3::AbstractVariableTrait as _, traits::FmiModelDescription as _};
use fmi::{fmi2, fmi3, traits::FmiImport as _};

use super::Result;

/// An instance, and the import: it holds the unpacked folder, in which the library and the resources lie.
pub enum Component {
    Two { instance: fmi2::instance::InstanceCS, _import: fmi2::import::Fmi2Import },
    Three { instance: fmi3::instance::InstanceCS, _import: fmi3::import::Fmi3Import },
}

impl Component {
    /// Loads an FMU of either version; the references of its real variables.
    pub fn load(name: &str, path: &Path) -> Result<(Self, HashMap<String, u32>)> {
        let unusable = |error| format!("{}: {error}; cargo run --release builds it", path.display());
        let version =
            fmi::import::peek_descr_path(path).and_then(|description| Ok(description.major_version()?));
        if version.map_err(unusable)? == MajorVersion::FMI3 {
            let import: fmi3::import::Fmi3Import = fmi::import::from_path(path).map_err(unusable)?;
            let variables = &import.model_description().model_variables;
            let variables =
                variables.float64().into_iter().map(|it| (it.name().to_owned(), it.value_reference()));
            let variables = variables.collect();
            let instance = import.instantiate_cs(name, false, false, false, false, &[])?;
            return Ok((Self::Three { instance, _import: import }, variables));
        }
        let import: fmi2::import::Fmi2Import = fmi::import::from_path(path).map_err(unusable)?;
        let variables = import.model_description().get_model_variables();
        let variables = variables.map(|it| (it.name.clone(), it.value_reference)).collect();
        let instance = import.instantiate_cs(name, false, false)?;
        Ok((Self::Two { instance, _import: import }, variables))
    }

    pub fn set(&mut self, reference: u32, value: f64) -> Result<()> {
        match self {
            Self::Two { instance, .. } => drop(instance.set_real(&[reference], &[value])?),
            Self::Three { instance, .. } => drop(instance.set_float64(&[reference], &[value])?),
        }
        Ok(())
    }

    pub fn get(&mut self, reference: u32) -> Result<f64> {
        let mut value = [0.0];
        match self {
            Self::Two { instance, .. } => drop(instance.get_real(&[reference], &mut value)?),
            Self::Three { instance, .. } => drop(instance.get_float64(&[reference], &mut value)?),
        }
        Ok(value[0])
    }

    /// Begins the initialisation at time zero.
    pub fn begin(&mut self) -> Result<()> {
        match self {
            Self::Two { instance, .. } => {
                instance.setup_experiment(None, 0.0, None)?;
                instance.enter_initialization_mode()?;
            }
            Self::Three { instance, .. } => drop(instance.enter_initialization_mode(None, 0.0, None)?),
        }
        Ok(())
    }

    /// Ends the initialisation.
    pub fn ready(&mut self) -> Result<()> {
        match self {
            Self::Two { instance, .. } => drop(instance.exit_initialization_mode()?),
            Self::Three { instance, .. } => drop(instance.exit_initialization_mode()?),
        }
        Ok(())
    }

    pub fn step(&mut self, time: f64, step: f64) -> Result<()> {
        match self {
            Self::Two { instance, .. } => drop(instance.do_step(time, step, true)?),
            Self::Three { instance, .. } => {
                let (mut event, mut terminate, mut early, mut reached) = (false, false, false, time);
                instance.do_step(time, step, true, &mut event, &mut terminate, &mut early, &mut reached)?;
            }
        }
        Ok(())
    }

    pub fn terminate(&mut self) -> Result<()> {
        match self {
            Self::Two { instance, .. } => drop(instance.terminate()?),
            Self::Three { instance, .. } => drop(instance.terminate()?),
        }
        Ok(())
    }
}
