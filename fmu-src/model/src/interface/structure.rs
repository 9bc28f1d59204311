//! What depends on what, found by running the equations on sets.

use std::path::Path;

use crate::{
    Bundle, Dependencies, Error, Instant, Model, SettingDeclaration, SettingKind, Settings, Value,
    layout::{Declared, Layout, Section},
    simulation::indicators::count,
};

use super::{Causality, Variable};

/// The structural dependencies of a model's outputs and rates, over every choice of its settings.
#[derive(Clone, Debug)]
pub struct Dependency {
    /// Of each output, while time goes on.
    outputs: Vec<Dependencies>,
    /// Of each rate.
    rates: Vec<Dependencies>,
    /// Of each output at initialisation, where a first tick has just been made.
    initial_outputs: Vec<Dependencies>,
    /// Of each derived parameter.
    derived: Vec<Dependencies>,
    /// Number of event indicators, whatever the settings are.
    pub(super) event_indicators: usize,
    /// Positions of the known quantities.
    knowns: Knowns,
}

/// Runs a model's equations with the given settings, or with another value of the one of an index.
type Unite<'a> = &'a mut dyn FnMut(&mut Dependency, Option<(usize, Value)>) -> Result<usize, String>;

/// Numbering of the known quantities.
#[derive(Clone, Copy, Debug)]
struct Knowns {
    inputs: usize,
    states: usize,
    parameters: usize,
}

impl Knowns {
    fn state(self, index: usize) -> usize {
        self.inputs + index
    }
    fn parameter(self, index: usize) -> usize {
        self.inputs + self.states + index
    }
    fn time(self) -> usize {
        self.inputs + self.states + self.parameters
    }
}

impl Dependency {
    /// Runs the equations on sets, for the given settings and for every other choice of each of them.
    ///
    /// # Errors
    /// If the model refuses the given settings.
    pub fn of<M: Model>(settings: &M::Settings, resources: Option<&Path>) -> Result<Self, Error> {
        let knowns = Knowns {
            inputs: Layout::<M>::INPUTS,
            states: Layout::<M>::STATES,
            parameters: Layout::<M>::PARAMETERS,
        };
        let mut dependency = Self {
            outputs: vec![Dependencies::default(); Layout::<M>::OUTPUTS],
            rates: vec![Dependencies::default(); Layout::<M>::STATES],
            initial_outputs: vec![Dependencies::default(); Layout::<M>::OUTPUTS],
            derived: vec![Dependencies::default(); Layout::<M>::DERIVED],
            event_indicators: 0,
            knowns,
        };
        dependency.over_all_choices(&M::Settings::declare(), &mut |dependency, choice| {
            let mut settings = settings.clone();
            if let Some((index, value)) = choice {
                settings.set(index, value).ok_or("the setting cannot have this value")?;
            }
            let model = M::prepare(&settings, resources)?;
            dependency.unite(&model);
            Ok(count(&model))
        })?;
        Ok(dependency)
    }

    /// `unite` adds what the equations depend on, and counts the kinks.
    fn over_all_choices(&mut self, settings: &[SettingDeclaration], unite: Unite<'_>) -> Result<(), Error> {
        let kinks = unite(self, None).map_err(Error::Refused)?;
        self.event_indicators = kinks;
        for (index, declaration) in settings.iter().enumerate() {
            // A choice that the model refuses (a file that is not there) has no dependencies.
            let others = choices(declaration).into_iter();
            let most = others.filter_map(|value| unite(self, Some((index, value))).ok()).max();
            // Several settings may be changed together.
            self.event_indicators += most.map_or(0, |most| most.saturating_sub(kinks));
        }
        // At least one: some importers set inputs only where they ask for event indicators.
        self.event_indicators = self.event_indicators.max(1);
        Ok(())
    }

    fn unite<M: Model>(&mut self, model: &M) {
        let knowns = self.knowns;
        let set = Dependencies::on;
        let parameters = Bundle::from_fn(|i| set(knowns.parameter(i)));
        let derived = model.derive(&parameters);
        let (input, state) = (Bundle::from_fn(set), Bundle::from_fn(|i| set(knowns.state(i))));
        let held = Bundle::from_fn(|_| Dependencies::default());
        let now = Instant::<M, Dependencies> {
            time: set(knowns.time()),
            state: &state,
            input: &input,
            parameters: &parameters,
            derived: &derived,
            memory: &held,
            tick: 0,
        };
        let (rates, outputs) = model.equations(now);
        rates.for_each(|i, found| self.rates[i] = self.rates[i] | found);
        outputs.for_each(|i, found| self.outputs[i] = self.outputs[i] | found);
        derived.for_each(|i, found| self.derived[i] = self.derived[i] | found);
        let memory = model.tick(now);
        let (_, initial) = model.equations(Instant { memory: &memory, ..now });
        initial.for_each(|i, found| self.initial_outputs[i] = self.initial_outputs[i] | found);
    }

    /// Whether an output stays as it is between ticks.
    pub(super) fn output_is_held(&self, index: usize) -> bool {
        let changing = (0..self.knowns.inputs + self.knowns.states).chain([self.knowns.time()]);
        !changing.into_iter().any(|known| self.outputs[index].contains(known))
    }
}

/// Every value of a setting that has finitely many.
fn choices(declaration: &SettingDeclaration) -> Vec<Value> {
    match declaration.kind {
        SettingKind::Boolean => vec![Value::Boolean(false), Value::Boolean(true)],
        SettingKind::Choice(enumeration) => (1..).map(Value::Integer).take(enumeration.items.len()).collect(),
        SettingKind::Integer | SettingKind::Text => Vec::new(),
    }
}

/// What depends on what, by position in the list of variables (from zero).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Structure {
    /// Outputs with the inputs and states that they depend on.
    pub outputs: Vec<(usize, Vec<usize>)>,
    /// State derivatives, likewise.
    pub derivatives: Vec<(usize, Vec<usize>)>,
    /// What is calculated at initialisation, with the inputs, start values, parameters and settings that
    /// it depends on.
    pub initial_unknowns: Vec<(usize, Vec<usize>)>,
}

/// What depends on time itself, by position in the list of variables. FMI 3.0 asks for it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Timely {
    /// Of the outputs and state derivatives.
    pub running: Vec<usize>,
    /// Of the unknowns of the initialisation.
    pub initial: Vec<usize>,
}

impl Timely {
    pub(super) fn new(declared: &Declared, dependency: &Dependency) -> Self {
        let of = |sections: [(Section, &[Dependencies]); 2]| -> Vec<usize> {
            let time = dependency.knowns.time();
            let sections = sections.into_iter();
            let found = sections.flat_map(|(section, sets)| {
                let first = declared.first(section);
                sets.iter().enumerate().filter(|(_, set)| set.contains(time)).map(move |(i, _)| first + i)
            });
            found.collect()
        };
        let rates = (Section::Rate, &dependency.rates[..]);
        Self {
            running: of([(Section::Output, &dependency.outputs), rates]),
            initial: of([(Section::Output, &dependency.initial_outputs), rates]),
        }
    }
}

impl Structure {
    pub(super) fn new(declared: &Declared, dependency: &Dependency, variables: &[Variable]) -> Self {
        let Dependency { knowns, .. } = *dependency;
        let first = |section| declared.first(section);
        // Real variables come first and in the order of their references: reference and position are one.
        let position = |known: usize| {
            if known < knowns.inputs {
                first(Section::Input) + known
            } else if known < knowns.parameter(0) {
                first(Section::State) + known - knowns.inputs
            } else {
                first(Section::Parameter) + known - knowns.parameter(0)
            }
        };
        let list = |set: Dependencies, end: usize| -> Vec<usize> {
            (0..end).filter(|known| set.contains(*known)).map(position).collect()
        };
        let continuous = knowns.parameter(0);
        let all = knowns.time();
        let at = |section: Section, sets: &[Dependencies], end: usize| -> Vec<(usize, Vec<usize>)> {
            sets.iter().enumerate().map(|(index, set)| (first(section) + index, list(*set, end))).collect()
        };
        let mut outputs = at(Section::Output, &dependency.outputs, continuous);
        let states = (0..knowns.states).map(|index| first(Section::State) + index);
        let exposed = states.filter(|state| variables[*state].causality == Causality::Output);
        outputs.extend(exposed.map(|state| (state, vec![state])));
        let mut initial_unknowns = at(Section::Output, &dependency.initial_outputs, all);
        initial_unknowns.extend(at(Section::Rate, &dependency.rates, all));
        initial_unknowns.extend(at(Section::Derived, &dependency.derived, all));
        // What a setting does to the structure cannot be traced: everything may depend on each of the model's own.
        let settings = variables.len() - declared.settings.len();
        for (_, dependencies) in &mut initial_unknowns {
            dependencies.extend(settings..settings + declared.own_settings);
        }
        Self { outputs, derivatives: at(Section::Rate, &dependency.rates, continuous), initial_unknowns }
    }
}
