//! The rigs that can be diagnosed: what each is made of, in the diagnosis's terms.

mod check;
mod draft;
mod file;
mod kind;
mod own;
mod stand_in;
mod undriven;

use std::sync::Arc;

use strut_model::{Declaration, ParameterSet, Value};
use strut_physics::PARAMETER_SETS;

use crate::catalogue;
use crate::data::table::did_you_mean;
use crate::plant::Plant;

pub use draft::{Draft, SAME};
pub use kind::{DrivenBy, ElementSignals, ForceOf, Given, Inverse, Kind, Missing, Opposed, Undriven};
pub use own::{MADE, fmu_of, is_fmu, is_manifest};
pub use stand_in::{UNSEEN, difference};

/// Longest segment of a model that does not drift, in seconds.
const MINUTE: f64 = 60.0;

/// A rig to be diagnosed: a plant with the values of a parameter set.
#[derive(Clone, Debug)]
pub struct Rig {
    /// As the user names it: `tum-quarter-vehicle`.
    pub name: String,
    /// The FMU's name: `TumQuarterVehicle`.
    pub fmu: String,
    /// The model.
    pub plant: Plant,
    /// The values of its parameters.
    pub parameters: Vec<f64>,
    /// Which of them its parameter set states. The others are a model's start values: of this rig they say nothing.
    pub stated: Vec<bool>,
    /// The values of its settings.
    pub choices: Vec<Value>,
    /// The values of its states at the start.
    pub start: Vec<f64>,
    /// Names of outputs that a record has as what drives the plant.
    pub taken: Vec<String>,
    /// Independently measured parameters: index, value and standard deviation.
    pub known: Vec<(usize, f64, f64)>,
    /// What the diagnosis has to know of the model.
    pub kind: Arc<Kind>,
    /// The rig that it stands for, if nobody measured what drove that.
    pub of: Option<Arc<Rig>>,
}

impl Rig {
    /// A published rig by its name, or a model with its declared values by the model's: `element-dyno`.
    ///
    /// # Errors
    /// If there is none of that name: with those that there are.
    pub fn published(name: &str) -> Result<Self, String> {
        for (file, text) in PARAMETER_SETS {
            let set = ParameterSet::parse(text).map_err(|error| format!("{file}: {error}"))?;
            if kebab(&set.fmu) == name {
                return Self::of(&set);
            }
        }
        if let Some(kind) = Kind::published().iter().find(|kind| kebab(&kind.model) == name) {
            return Self::of(&ParameterSet {
                fmu: kind.model.clone(),
                model: kind.model.clone(),
                title: "The model's declared values".into(),
                source: String::new(),
                files: Vec::new(),
                values: Default::default(),
                units: Default::default(),
            });
        }
        let names = Self::names();
        let hint = did_you_mean(name, names.iter().map(String::as_str));
        Err(format!("there is no rig `{name}` (`diagnose rigs` lists them){hint}"))
    }

    /// Every model of the library that can be diagnosed.
    pub fn models() -> impl Iterator<Item = Plant> {
        Kind::published().iter().filter_map(|kind| kind.plant().ok())
    }

    /// Names of all published rigs.
    pub fn names() -> Vec<String> {
        let sets = PARAMETER_SETS.iter().filter_map(|(_, text)| ParameterSet::parse(text).ok());
        let rigs = sets.filter(|set| Kind::published().iter().any(|kind| kind.model == set.model));
        let mut names: Vec<String> = rigs.map(|set| kebab(&set.fmu)).collect();
        names.extend(Kind::published().iter().map(|kind| kebab(&kind.model)));
        names.sort();
        names
    }

    /// The rig of a parameter set.
    ///
    /// # Errors
    /// If its model cannot be diagnosed, or a name or a value does not fit the model.
    pub fn of(set: &ParameterSet) -> Result<Self, String> {
        let kinds = Kind::published();
        let kind = kinds.iter().find(|kind| kind.model == set.model).ok_or_else(|| {
            let models: Vec<&str> = kinds.iter().map(|kind| kind.model.as_str()).collect();
            format!("a {} cannot be diagnosed; give a set for one of {}", set.model, models.join(", "))
        })?;
        let plant = kind.plant()?;
        let values = set.values.iter().map(|(name, given)| (name.as_str(), &given.value));
        Self::made((kebab(&set.fmu), set.fmu.clone()), plant, kind.clone(), values)
            .map_err(|error| format!("the parameter set {}: {error}", set.fmu))
    }

    /// A rig by its own name and its FMU's, with these values in place of declared ones.
    fn made<'a>(
        (name, fmu): (String, String),
        plant: Plant,
        kind: Arc<Kind>,
        values: impl Iterator<Item = (&'a str, &'a Value)>,
    ) -> Result<Self, String> {
        let mut parameters: Vec<f64> = plant.parameters.iter().map(|it| it.start).collect();
        let mut stated = vec![false; parameters.len()];
        let mut choices = plant.choices.clone();
        let mut start: Vec<f64> = plant.states.iter().map(|it| it.start).collect();
        for (name, given) in values {
            let number = match *given {
                Value::Real(number) => Some(number),
                Value::Integer(number) => Some(f64::from(number)),
                _ => None,
            };
            match (plant.parameter(name), plant.setting(name), number) {
                (Some(index), _, Some(number)) => {
                    parameters[index] = number;
                    stated[index] = true;
                }
                (_, Some(index), _) => choices[index] = choice(&plant, index, given)?,
                (None, None, Some(number)) if plant.state(name).is_some() => {
                    plant.state(name).into_iter().for_each(|index| start[index] = number);
                }
                _ if name.starts_with("solver.") => {}
                _ => {
                    let all = plant.parameters.iter().map(|it| it.name.as_str());
                    let hint = did_you_mean(name, all.chain(plant.settings.iter().map(|it| it.name)));
                    return Err(format!(
                        "it gives `{name}`, which a {} does not have or not as a value of this kind{hint}",
                        plant.name
                    ));
                }
            }
        }
        let dynamics = plant.prepare(&choices)?;
        dynamics.check(&parameters)?;
        let (taken, known) = (Vec::new(), Vec::new());
        Ok(Self { name, fmu, plant, parameters, stated, choices, start, taken, known, kind, of: None })
    }

    /// How it is driven; none if there is one way only.
    pub fn driven(&self) -> Option<&DrivenBy> {
        self.kind.drives.iter().find(|it| self.is_driven(it))
    }

    fn is_driven(&self, by: &DrivenBy) -> bool {
        let Some(index) = self.plant.setting(&by.setting) else { return false };
        choice(&self.plant, index, &Value::Text(by.item.clone())).as_ref() == Ok(&self.choices[index])
    }

    /// The ways in which the plant may be driven by what a record has; `has` tells whether there is a signal or a column of
    /// a name. The inverse comes first where the record has the force, too, then the rig's own way, and a signal's own
    /// name before a column's that may be it.
    pub fn ways(&self, has: impl Fn(&str) -> bool) -> Vec<DrivenBy> {
        let drives = &self.kind.drives;
        let by_column = |it: &&DrivenBy| it.columns.iter().any(|column| has(column));
        let compared = |it: &&DrivenBy| {
            let any = |signal: &str| self.kind.called(signal).any(&has);
            // An accelerometer sees what differentiation loses.
            let inverse = it.inverse.as_ref();
            let force = inverse.is_some_and(|inverse| {
                any(&inverse.force) && !inverse.instead.iter().any(|signal| any(signal))
            });
            force && (has(&it.input) || by_column(it))
        };
        let forward = || drives.iter().filter(|it| it.inverse.is_none());
        let own = forward().filter(|it| self.is_driven(it) && has(&it.input));
        let by_name = forward().filter(|it| has(&it.input));
        drives
            .iter()
            .filter(compared)
            .chain(own)
            .chain(by_name)
            .chain(forward().filter(by_column))
            .cloned()
            .collect()
    }

    /// Drives the plant in this way by what a record has.
    ///
    /// # Errors
    /// If the model does not know the choice.
    pub fn drive_by(&mut self, by: &DrivenBy, has: impl Fn(&str) -> bool) -> Result<(), String> {
        if let Some(index) = self.plant.setting(&by.setting) {
            self.choices[index] = choice(&self.plant, index, &Value::Text(by.item.clone()))?;
        }
        self.taken.clear();
        if !has(&by.input) {
            let column = by.columns.iter().find(|column| has(column));
            self.taken.extend(column.cloned());
        }
        Ok(())
    }

    /// Whether its inputs impose all motion.
    pub fn imposes_motion(&self) -> bool {
        self.kind.imposed == Some(true)
    }

    /// Longest segment that is simulated in one go, in seconds. Where motion is imposed nothing drifts, and what friction remembers of
    /// it would have to be estimated at every new start.
    pub fn segment(&self) -> f64 {
        let usual = if self.imposes_motion() { f64::INFINITY } else { MINUTE };
        self.driven().and_then(|by| by.segment).or(self.kind.segment).unwrap_or(usual)
    }

    /// Whether an output follows from the inputs alone.
    pub fn is_trivial(&self, output: &str) -> bool {
        let driven = self.driven().map_or(&[][..], |by| &by.follows_inputs);
        self.kind.follows_inputs.iter().chain(driven).any(|it| *it == output)
    }

    /// Whether an input does nothing, since the plant is driven by another one.
    pub fn is_idle(&self, input: &str) -> bool {
        let mut ways = self.kind.drives.iter().filter(|it| it.input == input).peekable();
        match self.rate_of(input) {
            // A rate drives with its motion, unless it drives itself.
            Some(motion) if ways.peek().is_none() => self.is_idle(&self.plant.inputs[motion].name),
            _ => ways.any(|it| !self.is_driven(it)),
        }
    }

    /// The input whose measured mean is its sensor's and is removed.
    pub fn without_mean(&self) -> Option<&str> {
        self.driven().filter(|by| by.without_mean).map(|by| by.input.as_str())
    }

    /// The state that an output shows.
    pub fn shown(&self, output: &str) -> Option<usize> {
        self.plant.state(self.kind.shows.get(output).map_or(output, String::as_str))
    }

    /// The input that one is the rate of: `road.velocity` is that of `road.position`.
    pub fn rate_of(&self, name: &str) -> Option<usize> {
        if let Some(of) = self.kind.rates.get(name) {
            return self.plant.input(of);
        }
        const RATES: [(&str, &[&str]); 2] =
            [("velocity", &["position", "height"]), ("acceleration", &["velocity"])];
        let (group, of) = RATES.iter().find_map(|(rate, of)| Some((name.strip_suffix(rate)?, of)))?;
        of.iter().find_map(|of| self.plant.input(&format!("{group}{of}")))
    }

    /// Usual amplitude, in the input's unit, and band in Hz of what drives an input; none if it rests. What a kind does not
    /// tell follows from the unit.
    pub fn excitation(&self, declared: &Declaration) -> Option<(f64, (f64, f64))> {
        if self.is_idle(&declared.name) {
            return None;
        }
        if self.kind.excitation.is_empty() {
            return Some(match declared.unit.symbol {
                "N" => (100.0, (0.5, 18.0)),
                "V" => (2.0, (0.5, 18.0)),
                _ => (8e-3, (0.3, 15.0)),
            });
        }
        let excitation = self.kind.excitation.iter().find(|it| it.input == declared.name)?;
        Some((excitation.amplitude, excitation.band))
    }

    /// Names of the parameters that every model of the kind has, as it is driven.
    pub fn nominal(&self) -> impl Iterator<Item = &str> {
        let driven = self.driven().map_or(&[][..], |it| &it.nominal);
        self.kind.nominal.iter().chain(driven).map(String::as_str)
    }

    /// Indices of the parameters that are fitted first: those of the data sheet, and all of each effect that the rig has
    /// already. How wide its friction's transition is counts among them: who holds it finds its error elsewhere.
    pub fn base(&self) -> Vec<usize> {
        let mut base: Vec<usize> = self.nominal().filter_map(|name| self.plant.parameter(name)).collect();
        for effect in catalogue::effects(&self.plant) {
            let parts = || effect.parts.iter().filter_map(|part| self.plant.parameter(part.parameter));
            if parts().next().is_some_and(|amount| self.parameters[amount] != 0.0) {
                let more: Vec<usize> = parts().filter(|index| !base.contains(index)).collect();
                base.extend(more);
            }
        }
        base
    }
}

/// A setting's value: an enumeration's item is given by name.
pub(crate) fn choice(plant: &Plant, index: usize, given: &Value) -> Result<Value, String> {
    use strut_model::SettingKind;
    let declaration = &plant.settings[index];
    match (declaration.kind, given) {
        (SettingKind::Choice(enumeration), Value::Text(text)) => (1..)
            .zip(enumeration.items)
            .find_map(|(number, (item, _))| (item == text).then_some(Value::Integer(number)))
            .ok_or_else(|| format!("`{}` cannot be `{text}`", declaration.name)),
        _ => Ok(given.clone()),
    }
}

/// `TumQuarterVehicle` is called `tum-quarter-vehicle`.
pub fn kebab(name: &str) -> String {
    let mut kebab = String::new();
    let mut before = None::<char>;
    for c in name.chars() {
        let starts =
            c.is_ascii_uppercase() || (c.is_ascii_digit() && !before.is_some_and(|b| b.is_ascii_digit()));
        if starts && before.is_some() {
            kebab.push('-');
        }
        kebab.push(c.to_ascii_lowercase());
        before = Some(c);
    }
    kebab
}
