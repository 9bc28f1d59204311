//! A Jacobi master: components, connections, one loop.

use std::collections::HashMap;
use std::path::Path;

#[path = "component.rs"]
mod component;

use component::Component;

pub type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// A variable: its component's index and its value reference.
type Signal = (usize, u32);

/// Components with their connections: `targets[i]` is told what `sources[i]` is.
#[derive(Default)]
pub struct System {
    components: Vec<Component>,
    variables: HashMap<String, Signal>,
    sources: Vec<Signal>,
    targets: Vec<Signal>,
}

impl System {
    /// Loads the components, given as name and FMU, and connects `"component.output"` to `"component.input"`.
    pub fn new(folder: &Path, components: &[(&str, &str)], connections: &[(&str, &str)]) -> Result<Self> {
        let mut system = Self::default();
        for (index, (name, fmu)) in components.iter().enumerate() {
            let (component, variables) = Component::load(name, &folder.join(format!("{fmu}.fmu")))?;
            let named = |(variable, reference)| (format!("{name}.{variable}"), (index, reference));
            system.variables.extend(variables.into_iter().map(named));
            system.components.push(component);
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
        self.components[component].set(reference, value)
    }

    fn read(&mut self, signals: &[Signal]) -> Result<Vec<f64>> {
        signals.iter().map(|(component, reference)| self.components[*component].get(*reference)).collect()
    }

    /// Outputs to inputs: all are read before any is set.
    fn exchange(&mut self) -> Result<()> {
        let values = self.read(&self.sources.clone())?;
        for ((component, reference), value) in self.targets.iter().zip(values) {
            self.components[*component].set(*reference, value)?;
        }
        Ok(())
    }

    /// Simulates from 0 to `stop`: rows of signals at 0 and after every step, read before the next exchange.
    pub fn run(mut self, stop: f64, step: f64, signals: &[&str]) -> Result<Vec<Vec<f64>>> {
        let recorded = signals.iter().map(|name| self.signal(name)).collect::<Result<Vec<_>>>()?;
        self.components.iter_mut().try_for_each(Component::begin)?;
        // A value that passes through a component arrives only in the next exchange.
        for _ in 0..self.components.len() {
            self.exchange()?;
        }
        self.components.iter_mut().try_for_each(Component::ready)?;
        let mut rows = vec![self.read(&recorded)?];
        for index in 0..(stop / step).round() as u32 {
            self.exchange()?;
            for component in &mut self.components {
                // Not added up: after many steps a sum of steps is no longer a multiple of the step.
                component.step(f64::from(index) * step, step)?;
            }
            rows.push(self.read(&recorded)?);
        }
        self.components.iter_mut().try_for_each(Component::terminate)?;
        Ok(rows)
    }
}
