//! The rigs that can be diagnosed: what each is made of, in the diagnosis's terms.

use strut_model::{ParameterSet, Value};
use strut_physics::PARAMETER_SETS;
use strut_physics::rigs::{ElementDyno, QuarterCar};

use crate::catalogue::{self, Element};
use crate::data::table::did_you_mean;
use crate::plant::Plant;

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
    /// The values of its settings.
    pub choices: Vec<Value>,
    /// What the diagnosis has to know of the model.
    pub kind: &'static Kind,
}

/// What the diagnosis has to know of a model.
#[derive(Debug)]
pub struct Kind {
    plant: fn() -> Plant,
    model: &'static str,
    /// Parameters that are never quite those of a data sheet.
    pub base: &'static [&'static str],
    /// Where its elements' forces and motions are found.
    pub elements: &'static [ElementSignals],
    /// Other names of its signals in records; `-name` is the negative.
    pub aliases: &'static [(&'static str, &'static str)],
    /// Outputs that follow from the inputs alone and show nothing.
    pub trivial: &'static [&'static str],
    /// A column in whose sense a signal is recorded if the column is there: of opposite sign to the model's.
    pub opposed: Option<(&'static str, &'static str)>,
    /// What the force that the model misses is made of: an output's error times a parameter, if any.
    pub missing: &'static [Missing],
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
    /// A stiffness times the deflection and a damping rate times the velocity.
    SpringAndDamper(&'static str, &'static str),
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

const STRUT_FORCE: ForceOf = ForceOf::SpringAndDamper("strut.stiffness", "strut.damping");

const KINDS: &[Kind] = &[
    Kind {
        plant: Plant::of::<QuarterCar>,
        model: "QuarterCar",
        base: &[
            "sprung_mass",
            "unsprung_mass",
            "strut.stiffness",
            "strut.damping",
            "tire.stiffness",
            "tire.damping",
        ],
        elements: &[
            ElementSignals {
                element: Element::Strut,
                deflection: "suspension.deflection",
                velocity: Some("suspension.velocity"),
                force: STRUT_FORCE,
            },
            ElementSignals {
                element: Element::Guide,
                deflection: "body.position",
                velocity: Some("body.velocity"),
                force: STRUT_FORCE,
            },
            ElementSignals {
                element: Element::WheelGuide,
                deflection: "wheel.position",
                velocity: Some("wheel.velocity"),
                force: STRUT_FORCE,
            },
            ElementSignals {
                element: Element::Tire,
                deflection: "tire.deflection",
                velocity: None,
                force: ForceOf::Output("wheel.force"),
            },
        ],
        aliases: &[("road.position", "road"), ("actuator.force", "force")],
        trivial: &[],
        opposed: None,
        missing: &[
            Missing {
                quantity: "force missing on the body",
                output: "body.acceleration",
                factor: Some(("sprung_mass", -1.0)),
                over: &[Element::Strut, Element::Guide],
            },
            Missing {
                quantity: "force missing in the tyre",
                output: "wheel.force",
                factor: None,
                over: &[Element::Tire],
            },
        ],
    },
    Kind {
        plant: Plant::of::<ElementDyno>,
        model: "ElementDyno",
        base: &["strut.stiffness", "strut.damping"],
        elements: &[ElementSignals {
            element: Element::Strut,
            deflection: "deflection",
            velocity: None,
            force: ForceOf::Output("force"),
        }],
        aliases: &[("motion.position", "-deflection"), ("motion.velocity", "-velocity")],
        trivial: &["deflection"],
        // A force that is recorded beside a deflection resists it.
        opposed: Some(("deflection", "force")),
        missing: &[Missing {
            quantity: "force missing in the strut",
            output: "force",
            factor: None,
            over: &[Element::Strut],
        }],
    },
];

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
            });
        }
        let names = Self::names();
        let hint = did_you_mean(name, names.iter().map(String::as_str));
        Err(format!("there is no rig `{name}` (`diagnose rigs` lists them){hint}"))
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
        let mut choices = plant.choices.clone();
        for (name, given) in &set.values {
            let number = match given.value {
                Value::Real(number) => Some(number),
                Value::Integer(number) => Some(f64::from(number)),
                _ => None,
            };
            match (plant.parameter(name), plant.setting(name), number) {
                (Some(index), _, Some(number)) => parameters[index] = number,
                (_, Some(index), _) => choices[index] = choice(&plant, index, &given.value)?,
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
        Ok(Self { name: kebab(&set.fmu), fmu: set.fmu.clone(), plant, parameters, choices, kind })
    }

    /// Indices of the parameters that are fitted first: those of the data sheet, and how much there is of each effect
    /// that the rig has already.
    pub fn base(&self) -> Vec<usize> {
        let mut base: Vec<usize> =
            self.kind.base.iter().filter_map(|name| self.plant.parameter(name)).collect();
        for cause in catalogue::causes(&self.plant) {
            if let Some(part) = cause.parts.first()
                && let Some(index) = self.plant.parameter(part.parameter)
                && self.parameters[index] != 0.0
                && !base.contains(&index)
            {
                base.push(index);
            }
        }
        base
    }
}

/// A setting's value: an enumeration's item is given by name.
fn choice(plant: &Plant, index: usize, given: &Value) -> Result<Value, String> {
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
