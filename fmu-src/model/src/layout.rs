//! Which value reference is which variable.

use std::marker::PhantomData;

use strut_integrators::Method;

use crate::{
    Bundle, Choice, Declaration, Declarations, Error, Model, SettingDeclaration, SettingKind, Settings,
    Value, Variables, setting::Setting,
};

/// How the integration is controlled; the user sees it as parameters.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub(crate) struct Solver<R> {
    /// Relative tolerance of the integration; a master's tolerance replaces it
    #[var(unit = ONE, min = 1e-13, max = 1e-2)]
    pub tolerance: R,
    /// Longest internal step
    #[var(unit = S, start = 0.1, min = 1e-9)]
    pub max_step: R,
}

/// The integration method.
#[derive(Choice, Clone, Copy, Debug, PartialEq)]
pub(crate) enum SolverMethod {
    /// Explicit Runge–Kutta pair of order 5(4), for models that are not stiff
    Explicit,
    /// Rosenbrock method with the exact Jacobian, for stiff models
    Rosenbrock,
}

impl From<Method> for SolverMethod {
    fn from(method: Method) -> Self {
        match method {
            Method::Explicit => Self::Explicit,
            Method::Rosenbrock => Self::Rosenbrock,
        }
    }
}

impl From<SolverMethod> for Method {
    fn from(method: SolverMethod) -> Self {
        match method {
            SolverMethod::Explicit => Self::Explicit,
            SolverMethod::Rosenbrock => Self::Rosenbrock,
        }
    }
}

/// The settings of the solver; they follow those of the model.
#[derive(Settings, Clone, Debug, PartialEq)]
pub(crate) struct SolverSettings {
    /// Integration: method
    #[set(name = "solver.method", start = SolverMethod::Explicit)]
    pub method: SolverMethod,
}

/// The sections that the real variables are numbered in, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Section {
    Input,
    Output,
    State,
    Rate,
    Parameter,
    Derived,
    Solver,
}

/// The arrays of a model's bundles.
pub(crate) type InputArray<M> = <<M as Model>::Input<f64> as Bundle<f64>>::Array;
pub(crate) type OutputArray<M> = <<M as Model>::Output<f64> as Bundle<f64>>::Array;
pub(crate) type StateArray<M> = <<M as Model>::State<f64> as Bundle<f64>>::Array;

/// Value references: real variables are numbered section by section, settings by their index.
pub(crate) struct Layout<M>(PhantomData<M>);

impl<M: Model> Layout<M> {
    pub const INPUTS: usize = <M::Input<f64> as Bundle<f64>>::LEN;
    pub const OUTPUTS: usize = <M::Output<f64> as Bundle<f64>>::LEN;
    pub const STATES: usize = <M::State<f64> as Bundle<f64>>::LEN;
    pub const PARAMETERS: usize = <M::Parameters<f64> as Bundle<f64>>::LEN;
    pub const DERIVED: usize = <M::Derived<f64> as Bundle<f64>>::LEN;
    /// A model without states needs no solver.
    pub const SOLVER: usize = if Self::STATES == 0 { 0 } else { Solver::<f64>::COUNT };

    /// Number of settings, those of the solver included.
    pub const SETTINGS: usize =
        M::Settings::COUNT + if Self::STATES == 0 { 0 } else { <SolverSettings as Settings>::COUNT };

    /// Section and length, in the order of the value references.
    pub const SECTIONS: [(Section, usize); 7] = [
        (Section::Input, Self::INPUTS),
        (Section::Output, Self::OUTPUTS),
        (Section::State, Self::STATES),
        (Section::Rate, Self::STATES),
        (Section::Parameter, Self::PARAMETERS),
        (Section::Derived, Self::DERIVED),
        (Section::Solver, Self::SOLVER),
    ];

    /// Section of a value reference, and index in it.
    #[inline]
    pub fn locate(reference: u32) -> Result<(Section, usize), Error> {
        let mut index = reference as usize;
        for (section, len) in Self::SECTIONS {
            if index < len {
                return Ok((section, index));
            }
            index -= len;
        }
        Err(Error::UnknownReference { kind: "real", reference, model: M::ABOUT.name })
    }

    /// What is declared about a section's variables. The rates are declared by the states.
    pub fn declarations(section: Section) -> Vec<Declaration> {
        match section {
            Section::Input => Declarations::of::<M::Input<f64>>(),
            Section::Output => Declarations::of::<M::Output<f64>>(),
            Section::State | Section::Rate => Declarations::of::<M::State<f64>>(),
            Section::Parameter => Declarations::of::<M::Parameters<f64>>(),
            Section::Derived => Declarations::of::<M::Derived<f64>>(),
            Section::Solver if Self::SOLVER == 0 => Vec::new(),
            Section::Solver => {
                let mut declarations = Declarations::default();
                declarations.group::<Solver<f64>>("solver", "Integration");
                let mut list = declarations.into_list();
                list[0].start = M::ABOUT.experiment.tolerance;
                list
            }
        }
    }

    /// The model's settings and those of the solver.
    pub fn settings() -> Vec<SettingDeclaration> {
        let mut list = M::Settings::declare();
        if Self::STATES > 0 {
            list.extend(SolverSettings::declare());
        }
        list
    }

    /// All that is declared.
    pub fn declared() -> Declared {
        let starts = M::Settings::starts();
        let mut setting_starts: Vec<Value> = (0..).map_while(|index| starts.get(index)).collect();
        if Self::STATES > 0 {
            setting_starts.push(SolverMethod::from(M::ABOUT.method).value());
        }
        Declared {
            model: M::ABOUT.name,
            sections: Self::SECTIONS.map(|(section, _)| (section, Self::declarations(section))),
            settings: Self::settings(),
            own_settings: M::Settings::COUNT,
            setting_starts,
        }
    }
}

/// All that a model declares, without the model's type: code that uses it is compiled once, and not for each model.
pub(crate) struct Declared {
    /// The model's name.
    pub model: &'static str,
    /// The real variables in the order of their references. The rates are declared by the states.
    pub sections: [(Section, Vec<Declaration>); 7],
    /// The model's settings and, after them, the solver's.
    pub settings: Vec<SettingDeclaration>,
    /// How many of the settings are the model's own.
    pub own_settings: usize,
    /// The declared values of the settings.
    pub setting_starts: Vec<Value>,
}

impl Declared {
    /// First value reference of a section.
    pub fn first(&self, section: Section) -> usize {
        self.sections.iter().take_while(|(other, _)| *other != section).map(|(_, list)| list.len()).sum()
    }

    /// What is declared about a section's variables.
    pub fn section(&self, section: Section) -> &[Declaration] {
        let (_, list) = self.sections.iter().find(|(other, _)| *other == section).expect("all are listed");
        list
    }

    /// Name of a real variable, for messages.
    pub fn name(&self, reference: u32) -> String {
        let mut index = reference as usize;
        for (section, list) in &self.sections {
            match list.get(index) {
                Some(declaration) => return name_in(*section, declaration),
                None => index -= list.len(),
            }
        }
        format!("#{reference}")
    }
}

/// Name of a section's variable: the rates are declared by the states.
pub(crate) fn name_in(section: Section, declaration: &Declaration) -> String {
    match section {
        Section::Rate => rate_name(&declaration.name),
        _ => declaration.name.clone(),
    }
}

/// Name of a state's derivative, as FMI's structured naming convention wants it.
pub(crate) fn rate_name(state: &str) -> String {
    format!("der({state})")
}

/// Whether a value is one of the kind's.
pub(crate) fn expected(kind: SettingKind) -> String {
    match kind {
        SettingKind::Integer => "give a whole number".into(),
        SettingKind::Boolean => "give true or false".into(),
        SettingKind::Text => "give a text".into(),
        SettingKind::Choice(enumeration) => {
            let items: Vec<String> =
                (1..).zip(enumeration.items).map(|(value, (name, _))| format!("{value} ({name})")).collect();
            format!("give one of {}", items.join(", "))
        }
    }
}

/// Refuses numbers that are not finite or not within the declared bounds.
pub(crate) fn check_bounds(declaration: &Declaration, value: f64) -> Result<(), Error> {
    let Declaration { name, unit, min, max, .. } = declaration;
    if !value.is_finite() {
        return Err(Error::NotFinite { name: name.clone(), value });
    }
    if min.is_none_or(|min| value >= min) && max.is_none_or(|max| value <= max) {
        return Ok(());
    }
    let bound = match (min, max) {
        (Some(min), Some(max)) => format!("between {min} and {max}"),
        (Some(min), None) => format!("at least {min}"),
        (None, Some(max)) => format!("at most {max}"),
        (None, None) => unreachable!("a variable without bounds is within them"),
    };
    Err(Error::OutOfBounds { name: name.clone(), value, unit: unit.symbol, bound })
}

/// A value as it is written in a message.
pub(crate) fn display(value: &Value) -> String {
    match value {
        Value::Real(number) => number.to_string(),
        Value::Integer(number) => number.to_string(),
        Value::Boolean(flag) => flag.to_string(),
        Value::Text(text) => format!("{text:?}"),
    }
}
