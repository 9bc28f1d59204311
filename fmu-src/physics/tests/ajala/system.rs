//! The systems as they are shipped: components by their parameter sets, connections from the file.

use std::collections::BTreeMap;

use strut_model::Value;
use strut_physics::SYSTEMS;
use toml::Table;

use crate::common::Named;

/// One end of a connection: component and variable.
type Port = (String, String);

fn port(path: &str) -> Port {
    let (component, variable) = path.split_once('.').unwrap();
    (component.to_owned(), variable.to_owned())
}

/// Components that exchange what they have at every communication point, all at once (Jacobi).
pub struct System {
    components: BTreeMap<String, Named>,
    connections: Vec<(Port, Port)>,
    /// What lies between two communication points, in seconds.
    pub step: f64,
    steps: u64,
}

impl System {
    pub fn new(step: f64, components: &[(&str, &str)], connections: &[&str]) -> Self {
        let connections = connections.iter().map(|connection| connection.split_once(" -> ").unwrap());
        Self {
            components: components
                .iter()
                .map(|(name, fmu)| ((*name).to_owned(), Named::published(fmu)))
                .collect(),
            connections: connections.map(|(from, to)| (port(from), port(to))).collect(),
            step,
            steps: 0,
        }
    }

    /// One of the shipped systems, exchanging every `step` seconds; its road is left to the test.
    pub fn published(name: &str, step: f64) -> Self {
        Self::of_file(name, step, |component| component != "road")
    }

    /// The same on its road.
    pub fn on_its_road(name: &str, step: f64) -> Self {
        Self::of_file(name, step, |_| true)
    }

    fn of_file(name: &str, step: f64, wanted: fn(&str) -> bool) -> Self {
        let file = format!("{name}.toml");
        let (_, text) = SYSTEMS.iter().find(|(name, _)| *name == file).expect("a published system");
        let table: Table = text.parse().unwrap();
        let components: Vec<(&str, &str)> = table["components"]
            .as_table()
            .unwrap()
            .iter()
            .map(|(name, fmu)| (name.as_str(), fmu.as_str().unwrap()))
            .filter(|(name, _)| wanted(name))
            .collect();
        let connections: Vec<&str> = table["connections"]
            .as_array()
            .unwrap()
            .iter()
            .map(|connection| connection.as_str().unwrap())
            .filter(|connection| connection.split_once('.').is_some_and(|(component, _)| wanted(component)))
            .collect();
        Self::new(step, &components, &connections)
    }

    fn component(&mut self, name: &str) -> &mut Named {
        self.components.get_mut(name).unwrap_or_else(|| panic!("no component {name}"))
    }

    pub fn choose(mut self, path: &str, value: Value) -> Self {
        let (component, variable) = port(path);
        self.component(&component).choose(&variable, value);
        self
    }

    pub fn initialized(mut self) -> Self {
        self.components.values_mut().for_each(Named::initialize);
        self
    }

    pub fn set(&mut self, path: &str, value: f64) {
        let (component, variable) = path.split_once('.').unwrap();
        self.component(component).set(variable, value);
    }

    pub fn get(&mut self, path: &str) -> f64 {
        let (component, variable) = path.split_once('.').unwrap();
        self.component(component).get(variable)
    }

    pub fn advance(&mut self) {
        let time = self.steps as f64 * self.step;
        for component in self.components.values_mut() {
            component.instance.step(time, self.step).unwrap();
        }
        self.steps += 1;
        let connections = std::mem::take(&mut self.connections);
        let values: Vec<f64> = connections
            .iter()
            .map(|((component, variable), _)| self.component(component).get(variable))
            .collect();
        for ((_, (component, variable)), value) in connections.iter().zip(values) {
            self.component(component).set(variable, value);
        }
        self.connections = connections;
    }
}
