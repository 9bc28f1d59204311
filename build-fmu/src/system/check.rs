//! Whether a system fits its components.

use strut_model::{Causality, Initial, Interface, Value, Variable, VariableKind};

use super::{Port, Setting, System};
use crate::failure::{Failure, Result, similar};

/// A system that fits: every name exists, every unit agrees, every input is driven.
pub struct Checked<'a> {
    /// From an output to an input.
    pub connections: Vec<(End<'a>, End<'a>)>,
    /// What is looked at.
    pub outputs: Vec<End<'a>>,
    /// Start values, with the variable that each is for.
    pub settings: Vec<(End<'a>, Value)>,
}

/// A variable of a component, found.
#[derive(Clone, Copy)]
pub struct End<'a> {
    /// Position of the component.
    pub component: usize,
    /// The variable.
    pub variable: &'a Variable,
}

impl<'a> Checked<'a> {
    /// Finds every name and compares every unit.
    pub fn new(system: &System, interfaces: &'a [Interface]) -> Result<Self> {
        let finder = Finder { system, interfaces };
        let mut connections: Vec<(End, End)> = Vec::new();
        for text in &system.connections {
            let (from, to) = text.split_once("->").ok_or_else(|| {
                Failure::new(format!("the connection `{text}` of the system {} has no arrow", system.name))
                    .help("write `road.position -> rig.road.position`")
            })?;
            let from = finder.find_as(&system.port(from)?, Causality::Output)?;
            let to = finder.find_as(&system.port(to)?, Causality::Input)?;
            let (given, wanted) = (symbol(from.variable), symbol(to.variable));
            if given != wanted {
                return Err(finder
                    .failure(format!("the connection `{text}` leads from {given:?} to {wanted:?}"))
                    .help("connect variables of the same unit"));
            }
            if connections.iter().any(|(_, other)| other.is(to)) {
                return Err(finder.failure(format!("the input `{}` is connected twice", finder.name(to))));
            }
            connections.push((from, to));
        }
        let outputs = system
            .outputs
            .iter()
            .map(|text| finder.find_as(&system.port(text)?, Causality::Output))
            .collect::<Result<Vec<_>>>()?;
        let mut settings: Vec<(End, Value)> = Vec::new();
        for setting in system.settings()? {
            let end = finder.find(&setting.port)?;
            if connections.iter().any(|(_, to)| to.is(end)) {
                return Err(
                    finder.failure(format!("`{}` is connected and has a value as well", finder.name(end)))
                );
            }
            if settings.iter().any(|(other, _)| other.is(end)) {
                return Err(finder.failure(format!("`{}` has two values", finder.name(end))));
            }
            settings.push((end, finder.value(end, &setting)?));
        }
        finder.every_input_is_driven(&connections, &settings)?;
        Ok(Self { connections, outputs, settings })
    }
}

impl End<'_> {
    fn is(&self, other: End) -> bool {
        self.component == other.component && self.variable.name == other.variable.name
    }
}

/// The unit of a variable; nothing for those that have none.
pub fn symbol(variable: &Variable) -> &'static str {
    match variable.kind {
        VariableKind::Real { unit, .. } => unit.symbol,
        _ => "",
    }
}

struct Finder<'a, 's> {
    system: &'s System,
    interfaces: &'a [Interface],
}

impl<'a> Finder<'a, '_> {
    fn failure(&self, mut message: String) -> Failure {
        message.push_str(" in the system ");
        message.push_str(&self.system.name);
        Failure::new(message)
    }

    fn name(&self, end: End) -> String {
        let (component, _) = self.system.components.get_index(end.component).expect("an end is found");
        format!("{component}.{}", end.variable.name)
    }

    fn find(&self, port: &Port) -> Result<End<'a>> {
        let Port { component: name, variable } = port;
        let components = &self.system.components;
        let component = components.get_index_of(name).ok_or_else(|| {
            let failure = self.failure(format!("there is no component `{name}`"));
            similar(name, components.keys().map(String::as_str)).into_iter().fold(failure, Failure::help)
        })?;
        let interface = &self.interfaces[component];
        let variable = interface.variable(variable).ok_or_else(|| {
            let fmu = &components[component];
            let failure = self.failure(format!("component `{name}` ({fmu}) has no variable `{variable}`"));
            let names = interface.variables.iter().map(|variable| variable.name.as_str());
            similar(variable, names).into_iter().fold(failure, Failure::help)
        })?;
        Ok(End { component, variable })
    }

    fn find_as(&self, port: &Port, causality: Causality) -> Result<End<'a>> {
        let end = self.find(port)?;
        if end.variable.causality == causality {
            return Ok(end);
        }
        let word = if causality == Causality::Input { "input" } else { "output" };
        let failure = self.failure(format!("`{}` is no {word}", self.name(end)));
        let all = self.interfaces[end.component].variables.iter();
        let names =
            all.filter(|variable| variable.causality == causality).map(|variable| variable.name.as_str());
        Err(similar(&port.variable, names).into_iter().fold(failure, Failure::help))
    }

    fn every_input_is_driven(&self, connections: &[(End, End)], settings: &[(End, Value)]) -> Result<()> {
        for (component, interface) in self.interfaces.iter().enumerate() {
            for variable in
                interface.variables.iter().filter(|variable| variable.causality == Causality::Input)
            {
                let end = End { component, variable };
                if !connections.iter().any(|(_, to)| to.is(end))
                    && !settings.iter().any(|(set, _)| set.is(end))
                {
                    let name = self.name(end);
                    let unit = symbol(variable);
                    return Err(self.failure(format!("nothing drives the input `{name}`")).help(format!(
                        "connect it, or let it rest: \"{name}\" = {{ value = 0.0, unit = \"{unit}\" }} under [parameters]"
                    )));
                }
            }
        }
        Ok(())
    }

    /// The value in the type of its variable.
    fn value(&self, end: End, setting: &Setting) -> Result<Value> {
        let name = self.name(end);
        let settable =
            end.variable.causality == Causality::Input || end.variable.initial == Some(Initial::Exact);
        if !settable {
            return Err(self.failure(format!("`{name}` is calculated and cannot be given a value")));
        }
        let wrong = |expected: &str| self.failure(format!("`{name}` must be {expected}"));
        if !matches!(end.variable.kind, VariableKind::Real { .. }) && setting.unit.is_some() {
            return Err(self.failure(format!("`{name}` has no unit")));
        }
        match (&end.variable.kind, &setting.value) {
            (VariableKind::Real { unit, min, max, .. }, Value::Real(_) | Value::Integer(_)) => {
                let value = match setting.value {
                    Value::Integer(value) => f64::from(value),
                    Value::Real(value) => value,
                    _ => unreachable!("matched above"),
                };
                match &setting.unit {
                    Some(given) if given == unit.symbol => {}
                    None if matches!(unit.symbol, "" | "1") => {}
                    Some(given) => {
                        return Err(self
                            .failure(format!(
                                "`{name}` is given in {given:?} but declared in {:?}",
                                unit.symbol
                            ))
                            .help("convert the value"));
                    }
                    None => return Err(wrong(&format!("given with its unit, {:?}", unit.symbol))),
                }
                if !value.is_finite()
                    || min.is_some_and(|min| value < min)
                    || max.is_some_and(|max| value > max)
                {
                    let bound = |bound: &Option<f64>, word| {
                        bound.map(|bound| format!(" {word} {bound}")).unwrap_or_default()
                    };
                    return Err(self
                        .failure(format!("`{name}` = {value} {} is out of bounds", unit.symbol))
                        .help(format!(
                            "it must be finite{}{}",
                            bound(min, "and at least"),
                            bound(max, "and at most")
                        )));
                }
                Ok(Value::Real(value))
            }
            (VariableKind::Choice { enumeration, .. }, Value::Text(text)) => (1..)
                .zip(enumeration.items)
                .find_map(|(index, (item, _))| (item == text).then_some(Value::Integer(index)))
                .ok_or_else(|| {
                    let items: Vec<&str> = enumeration.items.iter().map(|(item, _)| *item).collect();
                    wrong(&format!("one of {}", items.join(", ")))
                }),
            (VariableKind::Integer { .. }, value @ Value::Integer(_))
            | (VariableKind::Boolean { .. }, value @ Value::Boolean(_))
            | (VariableKind::Text { .. }, value @ Value::Text(_)) => Ok(value.clone()),
            (VariableKind::Real { .. }, _) => Err(wrong("a number")),
            (VariableKind::Integer { .. }, _) => Err(wrong("a whole number")),
            (VariableKind::Boolean { .. }, _) => Err(wrong("true or false")),
            (VariableKind::Text { .. }, _) => Err(wrong("a text")),
            (VariableKind::Choice { enumeration, .. }, _) => {
                let items: Vec<&str> = enumeration.items.iter().map(|(item, _)| *item).collect();
                Err(wrong(&format!("one of {}", items.join(", "))))
            }
        }
    }
}
