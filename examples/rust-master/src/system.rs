//! A Jacobi master: components, connections, one loop.

use std::collections::HashMap;
use std::path::Path;

use fmi::fmi2::instance::{CoSimulation, Common, InstanceCS};
use fmi::{fmi2::import::Fmi2Import, traits::FmiImport};

pub type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// A variable: its component's index and its value reference.
type Signal = (usize, u32);

/// Components with their connections: `targets[i]` is told what `sources[i]` is.
#[derive(Default)]
pub struct System {
    instances: Vec<InstanceCS>,
    /// They hold the unpacked folders, in which the instances' libraries and resources lie.
    imports: Vec<Fmi2Import>,
    variables: HashMap<String, Signal>,
    sources: Vec<Signal>,
    targets: Vec<Signal>,
}

impl System {
    /// Loads the components, given as name and FMU, and connects `"component.output"` to `"component.input"`.
    pub fn new(folder: &Path, components: &[(&str, &str)], connections: &[(&str, &str)]) -> Result<Self> {
        let mut system = Self::default();
        for (index, (name, fmu)) in components.iter().enumerate() {
            let path = folder.join(format!("{fmu}.fmu"));
            let unusable = |error| format!("{}: {error}; cargo run --release builds it", path.display());
            let import: Fmi2Import = fmi::import::from_path(&path).map_err(unusable)?;
            for variable in import.model_description().get_model_variables() {
                system
                    .variables
                    .insert(format!("{name}.{}", variable.name), (index, variable.value_reference));
            }
            system.instances.push(import.instantiate_cs(name, false, false)?);
            system.imports.push(import);
        }
        for (source, target) in connections {
            system.sources.push(system.signal(source)?);
            system.targets.push(system.signal(target)?);
        }
        Ok(system)
    }

    fn signal(&self, name: &str) -> Result<Signal> {
        self.variables.get(name).copied().ok_or_else(|| format!("there is no {name:?}").into())
    }

    pub fn set(&mut self, name: &str, value: f64) -> Result<()> {
        let (component, reference) = self.signal(name)?;
        self.instances[component].set_real(&[reference], &[value])?;
        Ok(())
    }

    fn read(&mut self, signals: &[Signal]) -> Result<Vec<f64>> {
        let mut values = vec![0.0; signals.len()];
        for ((component, reference), value) in signals.iter().zip(&mut values) {
            self.instances[*component].get_real(&[*reference], std::slice::from_mut(value))?;
        }
        Ok(values)
    }

    /// Outputs to inputs: all are read before any is set.
    fn exchange(&mut self) -> Result<()> {
        let values = self.read(&self.sources.clone())?;
        for ((component, reference), value) in self.targets.iter().zip(values) {
            self.instances[*component].set_real(&[*reference], &[value])?;
        }
        Ok(())
    }

    /// Simulates from 0 to `stop`: rows of signals at 0 and after every step, read before the next exchange.
    pub fn run(mut self, stop: f64, step: f64, signals: &[&str]) -> Result<Vec<Vec<f64>>> {
        let recorded = signals.iter().map(|name| self.signal(name)).collect::<Result<Vec<_>>>()?;
        for instance in &mut self.instances {
            instance.setup_experiment(None, 0.0, None)?;
            instance.enter_initialization_mode()?;
        }
        // A value that passes through a component arrives only in the next exchange.
        for _ in 0..self.instances.len() {
            self.exchange()?;
        }
        self.instances.iter_mut().try_for_each(|instance| instance.exit_initialization_mode().map(drop))?;
        let mut rows = vec![self.read(&recorded)?];
        for index in 0..(stop / step).round() as u32 {
            self.exchange()?;
            for instance in &self.instances {
                // Not added up: after many steps a sum of steps is no longer a multiple of the step.
                instance.do_step(f64::from(index) * step, step, true)?;
            }
            rows.push(self.read(&recorded)?);
        }
        self.instances.iter_mut().try_for_each(|instance| instance.terminate().map(drop))?;
        Ok(rows)
    }
}
