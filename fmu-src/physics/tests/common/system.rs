//! A system of `systems/`, run by a Jacobi master.

use std::collections::BTreeMap;
use std::path::Path;

use strut_model::{Access, Instance, Interface, ParameterSet};
use strut_physics::{CATALOGUE, PARAMETER_SETS, SYSTEMS};
use toml::Table;

/// The values of each signal: at the start, and at the end of each step before the exchange.
pub type Record = BTreeMap<String, Vec<f64>>;

/// One FMU of a system.
struct Component {
    instance: Box<dyn Instance>,
    interface: Interface,
}

impl Component {
    /// A parameter set by its name, or a model as it is declared.
    fn of(name: &str) -> Self {
        let file = format!("{name}.toml");
        let set = PARAMETER_SETS.iter().find(|(other, _)| *other == file);
        let set = set.map(|(_, text)| ParameterSet::parse(text).unwrap());
        let model = set.as_ref().map_or(name, |set| set.model.as_str());
        let entry = CATALOGUE.iter().find(|entry| entry.about.name == model);
        let entry = entry.unwrap_or_else(|| panic!("there is no model {model}"));
        let resources = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/parameters/resources"));
        Self {
            instance: entry.instance(set.as_ref(), Some(resources)).unwrap(),
            interface: entry.interface(set.as_ref(), Some(resources)).unwrap(),
        }
    }

    fn reference(&self, name: &str) -> u32 {
        self.interface.variable(name).unwrap_or_else(|| panic!("no variable {name}")).reference
    }

    fn get(&mut self, name: &str) -> f64 {
        let mut value = [0.0];
        self.instance.real(&[self.reference(name)], &mut value).unwrap();
        value[0]
    }

    fn set(&mut self, name: &str, value: f64, access: Access) {
        self.instance.set_real(&[self.reference(name)], &[value], access).unwrap();
    }
}

/// Components and what connects them.
pub struct System {
    components: BTreeMap<String, Component>,
    connections: Vec<(String, String)>,
}

fn split(path: &str) -> (&str, &str) {
    path.split_once('.').unwrap_or_else(|| panic!("{path} has no component"))
}

impl System {
    /// The system of a name, not yet initialised.
    pub fn of(name: &str) -> Self {
        let file = format!("{name}.toml");
        let (_, text) = SYSTEMS.iter().find(|(other, _)| *other == file).expect("a system");
        let system: Table = text.parse().unwrap();
        let components = system["components"].as_table().unwrap().iter();
        let connections = system["connections"].as_array().unwrap().iter();
        Self {
            components: components
                .map(|(name, fmu)| (name.clone(), Component::of(fmu.as_str().unwrap())))
                .collect(),
            connections: connections
                .map(|connection| connection.as_str().unwrap().split_once(" -> ").unwrap())
                .map(|(from, to)| (from.to_owned(), to.to_owned()))
                .collect(),
        }
    }

    fn component(&mut self, name: &str) -> &mut Component {
        self.components.get_mut(name).unwrap_or_else(|| panic!("no component {name}"))
    }

    fn get(&mut self, path: &str) -> f64 {
        let (component, name) = split(path);
        self.component(component).get(name)
    }

    /// Changes a start value.
    pub fn start(&mut self, path: &str, value: f64) {
        let (component, name) = split(path);
        self.component(component).set(name, value, Access::All);
    }

    /// Gives an input another source.
    pub fn reconnect(&mut self, from: &str, to: &str) {
        let connection = self.connections.iter_mut().find(|(_, input)| input == to);
        let (source, _) = connection.unwrap_or_else(|| panic!("nothing leads to {to}"));
        from.clone_into(source);
    }

    fn exchange(&mut self) {
        let values: Vec<f64> = (0..self.connections.len())
            .map(|index| {
                let from = self.connections[index].0.clone();
                self.get(&from)
            })
            .collect();
        for (index, value) in values.into_iter().enumerate() {
            let to = self.connections[index].1.clone();
            let (component, name) = split(&to);
            self.component(component).set(name, value, Access::Continuous);
        }
    }

    /// Initialises the system and runs it.
    pub fn run(mut self, stop: f64, step: f64, signals: &[&str]) -> Record {
        for component in self.components.values_mut() {
            component.instance.set_up(0.0, None).unwrap();
            component.instance.initialize().unwrap();
        }
        let mut record = Record::new();
        let mut note = |system: &mut Self| {
            for signal in signals {
                record.entry((*signal).to_owned()).or_default().push(system.get(signal));
            }
        };
        note(&mut self);
        for k in 0..(stop / step).round() as usize {
            self.exchange();
            for component in self.components.values_mut() {
                component.instance.step(k as f64 * step, step).unwrap();
            }
            note(&mut self);
        }
        record
    }
}
