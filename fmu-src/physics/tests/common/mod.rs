//! Reads the reference cases and drives a simulation by names.

pub mod system;

use std::collections::BTreeMap;

use serde_json::Value as Json;
use strut_model::{Access, Instance, ParameterSet, Value, Variable};
use strut_physics::{CATALOGUE, PARAMETER_SETS};

const CASES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/reference/cases");

/// A reference case with its rows.
pub struct Case {
    pub name: String,
    pub json: Json,
    pub columns: Vec<String>,
    pub rows: Vec<Vec<f64>>,
}

/// All cases of a kind.
pub fn cases(kind: &str) -> Vec<Case> {
    let mut names: Vec<String> = std::fs::read_dir(CASES)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter_map(|file| file.strip_suffix(".json").map(str::to_owned))
        .collect();
    names.sort();
    let all = names.into_iter().map(|name| {
        let json: Json =
            serde_json::from_str(&std::fs::read_to_string(format!("{CASES}/{name}.json")).unwrap()).unwrap();
        let csv = std::fs::read_to_string(format!("{CASES}/{name}.csv")).unwrap();
        let mut lines = csv.lines();
        let columns = lines.next().unwrap().split(',').map(str::to_owned).collect();
        let rows = lines.map(|line| line.split(',').map(|field| field.parse().unwrap()).collect()).collect();
        Case { name, json, columns, rows }
    });
    all.filter(|case| case.json["kind"] == kind).collect()
}

impl Case {
    pub fn number(&self, key: &str) -> f64 {
        self.json[key].as_f64().unwrap_or_else(|| panic!("{}: no {key}", self.name))
    }

    pub fn text(&self, key: &str) -> &str {
        self.json[key].as_str().unwrap_or_else(|| panic!("{}: no {key}", self.name))
    }

    /// Name and number of each entry of an object.
    pub fn numbers(&self, key: &str) -> Vec<(String, f64)> {
        let object = self.json[key].as_object();
        object
            .into_iter()
            .flatten()
            .filter_map(|(name, value)| Some((name.clone(), value.as_f64()?)))
            .collect()
    }

    /// The magnitude that a column's errors are relative to.
    pub fn scale(&self, column: &str) -> f64 {
        match self.json["scale"][column].as_f64() {
            Some(scale) => scale,
            None => {
                let index = self.columns.iter().position(|other| other == column).unwrap();
                self.rows.iter().map(|row| row[index].abs()).fold(0.0, f64::max)
            }
        }
    }

    /// Names and values of the inputs at a time.
    pub fn inputs(&self, t: f64) -> Vec<(&str, f64)> {
        let inputs = self.json["inputs"].as_object().unwrap();
        inputs.iter().map(|(name, formula)| (name.as_str(), value(formula, t))).collect()
    }
}

/// Sum of sines and steps.
fn value(formula: &Json, t: f64) -> f64 {
    let list = |key: &str| formula[key].as_array().cloned().unwrap_or_default();
    let number = |entry: &Json, i: usize| entry[i].as_f64().unwrap();
    let sines = list("sines");
    let sines =
        sines.iter().map(|s| number(s, 0) * (std::f64::consts::TAU * number(s, 1) * t + number(s, 2)).sin());
    let steps = list("steps");
    let steps = steps.iter().map(|s| if t >= number(s, 1) { number(s, 0) } else { 0.0 });
    sines.sum::<f64>() + steps.sum::<f64>()
}

/// An instance whose variables have names.
pub struct Named {
    pub instance: Box<dyn Instance>,
    variables: BTreeMap<String, Variable>,
}

impl Named {
    /// The model of this name as it is declared.
    pub fn new(model: &str) -> Self {
        Self::with(model, None)
    }

    /// The FMU of a published parameter set.
    pub fn published(fmu: &str) -> Self {
        let file = format!("{fmu}.toml");
        let found = PARAMETER_SETS.iter().find(|(name, _)| *name == file);
        let (_, text) = found.unwrap_or_else(|| panic!("there is no set {fmu}"));
        let set = ParameterSet::parse(text).unwrap();
        Self::with(&set.model, Some(&set))
    }

    fn with(model: &str, set: Option<&ParameterSet>) -> Self {
        let entry = CATALOGUE.iter().find(|entry| entry.about.name == model);
        let entry = entry.unwrap_or_else(|| panic!("there is no model {model}"));
        let variables = entry.interface(set, None).unwrap().variables.into_iter();
        Self {
            instance: entry.instance(set, None).unwrap(),
            variables: variables.map(|variable| (variable.name.clone(), variable)).collect(),
        }
    }

    pub fn variable(&self, name: &str) -> &Variable {
        self.variables.get(name).unwrap_or_else(|| panic!("no variable {name}"))
    }

    fn reference(&self, name: &str) -> u32 {
        self.variable(name).reference
    }

    pub fn start(&mut self, name: &str, value: f64) {
        self.instance.set_real(&[self.reference(name)], &[value], Access::All).unwrap();
    }

    pub fn choose(&mut self, name: &str, value: Value) {
        self.instance.set_setting(self.reference(name), value, Access::All).unwrap();
    }

    pub fn initialize(&mut self) {
        self.instance.set_up(0.0, None).unwrap();
        self.instance.initialize().unwrap();
    }

    pub fn set(&mut self, name: &str, value: f64) {
        self.instance.set_real(&[self.reference(name)], &[value], Access::Continuous).unwrap();
    }

    pub fn get(&mut self, name: &str) -> f64 {
        let mut value = [0.0];
        self.instance.real(&[self.reference(name)], &mut value).unwrap();
        value[0]
    }
}
