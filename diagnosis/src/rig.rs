//! The rigs that can be diagnosed: what each is made of, in the diagnosis's terms.

mod actuated;
mod drives;
mod kinds;

use strut_model::{Declaration, ParameterSet, Value};
use strut_physics::PARAMETER_SETS;

use crate::catalogue::{self, Element};
use crate::data::table::did_you_mean;
use crate::plant::Plant;

use kinds::KINDS;

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
    /// What the diagnosis has to know of the model.
    pub kind: &'static Kind,
}

/// A signal, and the other names that records have for it; `-name` is the negative.
pub type Aliases = (&'static str, &'static [&'static str]);

/// What the diagnosis has to know of a model.
#[derive(Debug)]
pub struct Kind {
    plant: fn() -> Plant,
    model: &'static str,
    /// Parameters that are never quite those of a data sheet.
    pub base: &'static [&'static str],
    /// Where its elements' forces and motions are found.
    pub elements: &'static [ElementSignals],
    /// Other names of its signals in records.
    pub aliases: &'static [Aliases],
    /// Outputs that show a state of another name: output, state.
    pub shown: &'static [(&'static str, &'static str)],
    /// Outputs that follow from the inputs alone and show nothing.
    pub trivial: &'static [&'static str],
    /// A column in whose sense a signal is recorded if the column is there: of opposite sign to the model's.
    pub opposed: Option<(&'static str, &'static str)>,
    /// What the force that the model misses is made of: an output's error times a parameter, if any.
    pub missing: &'static [Missing],
    /// Longest section that is simulated in one go, in seconds: it bounds the memory, and how far a plant that
    /// integrates its input may drift.
    pub section: f64,
    /// Ways in which it can be driven; empty if there is one only.
    pub drives: &'static [DrivenBy],
    /// What drives a virtual rig.
    pub excitation: &'static [Excitation],
}

/// A way in which a plant can be driven.
#[derive(Clone, Copy, Debug)]
pub struct DrivenBy {
    /// The setting that chooses it.
    pub setting: &'static str,
    /// The item of that setting.
    pub item: &'static str,
    /// The input that acts then.
    pub input: &'static str,
    /// Further nominal parameters that matter then.
    pub base: &'static [&'static str],
    /// Columns that are this input where none has its name.
    pub columns: &'static [&'static str],
    /// Outputs that follow from the inputs alone then.
    pub trivial: &'static [&'static str],
    /// What it takes for the inverse: the motion drives the model, and the force is compared.
    pub inverse: Option<Inverse>,
    /// Longest section then, in seconds, if it is not the kind's.
    pub section: Option<f64>,
}

/// The inverse of a drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inverse {
    /// The output that is compared.
    pub force: &'static str,
    /// The input that is measured.
    pub position: &'static str,
    /// The input that is its second derivative.
    pub acceleration: &'static str,
    /// The output that says more where it is measured.
    pub instead: &'static str,
}

/// A way in which a plant can be driven, forward: setting, item, input, columns.
const fn driven(
    setting: &'static str,
    item: &'static str,
    input: &'static str,
    columns: &'static [&'static str],
) -> DrivenBy {
    DrivenBy { setting, item, input, base: &[], columns, trivial: &[], inverse: None, section: None }
}

/// A signal that drives a virtual rig.
#[derive(Clone, Copy, Debug)]
pub struct Excitation {
    /// The input.
    pub input: &'static str,
    /// Amplitude of all its sines together, in the input's unit.
    pub amplitude: f64,
    /// Lowest and highest frequency in Hz.
    pub band: (f64, f64),
}

/// Where an element's force and motion are found among a plant's outputs.
#[derive(Clone, Copy, Debug)]
pub struct ElementSignals {
    /// The element.
    pub element: Element,
    /// Output with its deflection, or position.
    pub deflection: &'static str,
    /// Output with its velocity; none: the derivative of the deflection.
    pub velocity: Option<&'static str>,
    /// Where its force is found.
    pub force: ForceOf,
}

/// Where an element's force is found.
#[derive(Clone, Copy, Debug)]
pub enum ForceOf {
    /// In an output.
    Output(&'static str),
    /// In an input.
    Input(&'static str),
    /// A stiffness times the deflection and a damping rate times the velocity.
    SpringAndDamper(&'static str, &'static str),
    /// An output times a parameter, the lever with which it turns something.
    Moment(&'static str, &'static str),
}

/// A force that the model misses, as it shows in an output.
#[derive(Clone, Copy, Debug)]
pub struct Missing {
    /// What it is.
    pub quantity: &'static str,
    /// The output whose error shows it.
    pub output: &'static str,
    /// The parameter that makes it a force, and the sign.
    pub factor: Option<(&'static str, f64)>,
    /// The elements over whose motions it is shown.
    pub over: &'static [Element],
}

impl ForceOf {
    /// The signal that is the force, if there is one.
    pub fn signal(self) -> Option<&'static str> {
        match self {
            Self::Output(name) | Self::Input(name) => Some(name),
            Self::SpringAndDamper(..) | Self::Moment(..) => None,
        }
    }
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
        if let Some(kind) = KINDS.iter().find(|kind| kebab(kind.model) == name) {
            return Self::of(&ParameterSet {
                fmu: kind.model.into(),
                model: kind.model.into(),
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

    /// Every model that can be diagnosed, with its name.
    pub fn models() -> impl Iterator<Item = (&'static str, Plant)> {
        KINDS.iter().map(|kind| (kind.model, (kind.plant)()))
    }

    /// Names of all published rigs.
    pub fn names() -> Vec<String> {
        let sets = PARAMETER_SETS.iter().filter_map(|(_, text)| ParameterSet::parse(text).ok());
        let rigs = sets.filter(|set| KINDS.iter().any(|kind| kind.model == set.model));
        let mut names: Vec<String> = rigs.map(|set| kebab(&set.fmu)).collect();
        names.extend(KINDS.iter().map(|kind| kebab(kind.model)));
        names.sort();
        names
    }

    /// The rig of a parameter set.
    ///
    /// # Errors
    /// If its model cannot be diagnosed, or a name or a value does not fit the model.
    pub fn of(set: &ParameterSet) -> Result<Self, String> {
        let kind = KINDS.iter().find(|kind| kind.model == set.model).ok_or_else(|| {
            let models: Vec<&str> = KINDS.iter().map(|kind| kind.model).collect();
            format!("a {} cannot be diagnosed; give a set for one of {}", set.model, models.join(", "))
        })?;
        let plant = (kind.plant)();
        let mut parameters: Vec<f64> = plant.parameters.iter().map(|it| it.start).collect();
        let mut stated = vec![false; parameters.len()];
        let mut choices = plant.choices.clone();
        let mut start: Vec<f64> = plant.states.iter().map(|it| it.start).collect();
        for (name, given) in &set.values {
            let number = match given.value {
                Value::Real(number) => Some(number),
                Value::Integer(number) => Some(f64::from(number)),
                _ => None,
            };
            match (plant.parameter(name), plant.setting(name), number) {
                (Some(index), _, Some(number)) => {
                    parameters[index] = number;
                    stated[index] = true;
                }
                (_, Some(index), _) => choices[index] = choice(&plant, index, &given.value)?,
                (None, None, Some(number)) if plant.state(name).is_some() => {
                    plant.state(name).into_iter().for_each(|index| start[index] = number);
                }
                _ if name.starts_with("solver.") => {}
                _ => {
                    return Err(format!(
                        "the parameter set {} gives `{name}`, which a {} does not have or not as a value of this kind",
                        set.fmu, set.model
                    ));
                }
            }
        }
        let dynamics = plant.prepare(&choices)?;
        dynamics.check(&parameters)?;
        let (name, fmu, taken) = (kebab(&set.fmu), set.fmu.clone(), Vec::new());
        Ok(Self { name, fmu, plant, parameters, stated, choices, start, taken, kind })
    }

    /// How it is driven; none if there is one way only.
    pub fn driven(&self) -> Option<&'static DrivenBy> {
        self.kind.drives.iter().find(|it| self.is_driven(it))
    }

    fn is_driven(&self, by: &DrivenBy) -> bool {
        let Some(index) = self.plant.setting(by.setting) else { return false };
        choice(&self.plant, index, &Value::Text(by.item.into())).as_ref() == Ok(&self.choices[index])
    }

    /// The ways in which the plant may be driven by what a record has; `has` tells whether there is a signal or a column of
    /// a name. The inverse comes first where the record has the force, too, then the rig's own way, and a signal's own
    /// name before a column's that may be it.
    pub fn ways(&self, has: impl Fn(&str) -> bool) -> Vec<&'static DrivenBy> {
        let drives = self.kind.drives;
        let by_column = |it: &&DrivenBy| it.columns.iter().any(|column| has(column));
        let compared = |it: &&DrivenBy| {
            let any = |signal: &'static str| self.called(signal).any(&has);
            // An accelerometer sees what differentiation loses.
            let force = it.inverse.is_some_and(|inverse| any(inverse.force) && !any(inverse.instead));
            force && (has(it.input) || by_column(it))
        };
        let forward = || drives.iter().filter(|it| it.inverse.is_none());
        let own = forward().filter(|it| self.is_driven(it) && has(it.input));
        let by_name = forward().filter(|it| has(it.input));
        drives.iter().filter(compared).chain(own).chain(by_name).chain(forward().filter(by_column)).collect()
    }

    /// A signal's own name and the others that it has in records.
    fn called(&self, signal: &'static str) -> impl Iterator<Item = &'static str> {
        let aliases = self.kind.aliases.iter().filter(move |(name, _)| *name == signal);
        std::iter::once(signal).chain(aliases.flat_map(|(_, names)| *names).copied())
    }

    /// Drives the plant in this way by what a record has.
    ///
    /// # Errors
    /// If the model does not know the choice.
    pub fn drive_by(&mut self, by: &DrivenBy, has: impl Fn(&str) -> bool) -> Result<(), String> {
        if let Some(index) = self.plant.setting(by.setting) {
            self.choices[index] = choice(&self.plant, index, &Value::Text(by.item.into()))?;
        }
        self.taken.clear();
        if !has(by.input) {
            let column = by.columns.iter().find(|column| has(column));
            self.taken.extend(column.map(|column| (*column).to_owned()));
        }
        Ok(())
    }

    /// Longest section that is simulated in one go, in seconds.
    pub fn section(&self) -> f64 {
        self.driven().and_then(|by| by.section).unwrap_or(self.kind.section)
    }

    /// Whether an output follows from the inputs alone.
    pub fn is_trivial(&self, output: &str) -> bool {
        let driven = self.driven().map_or(&[][..], |by| by.trivial);
        self.kind.trivial.iter().chain(driven).any(|it| *it == output)
    }

    /// Whether an input does nothing, since the plant is driven by another one.
    pub fn is_idle(&self, input: &str) -> bool {
        // A rate drives with its motion.
        if let Some(motion) = self.rate_of(input) {
            return self.is_idle(&self.plant.inputs[motion].name);
        }
        self.kind.drives.iter().any(|it| it.input == input && !self.is_driven(it))
    }

    /// The state that an output shows.
    pub fn shown(&self, output: &str) -> Option<usize> {
        let named = self.kind.shown.iter().find(|(name, _)| *name == output).map(|(_, state)| *state);
        self.plant.state(named.unwrap_or(output))
    }

    /// The input that one is the rate of: `road.velocity` is that of `road.position`.
    pub fn rate_of(&self, name: &str) -> Option<usize> {
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
    pub fn nominal(&self) -> impl Iterator<Item = &'static str> {
        self.kind.base.iter().chain(self.driven().map_or(&[][..], |it| it.base)).copied()
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
