//! Whether a system fits its components.

use strut_check::unit::{Fit, Unit};
use strut_model::{Causality, Value};

use super::adapter::{Adaptation, Adapter, Operation};
use super::face::{Face, Kind};
use super::wire::{End, Sink, Source, Way, Wire};
use super::{Factors, Line, Part, Port, Setting, System, Units};
use crate::failure::{Failure, Result, similar};

/// A system that fits: every name exists, every unit agrees or is adapted, every input is driven.
pub struct Checked<'a> {
    /// What leads where.
    pub wires: Vec<Wire<'a>>,
    /// What stands between the components.
    pub adapters: Vec<Adapter>,
    /// What is looked at.
    pub outputs: Vec<End<'a>>,
    /// Start values, with the variable that each is for.
    pub settings: Vec<(End<'a>, Value)>,
}

impl<'a> Checked<'a> {
    /// Finds every name and compares every unit. The error lists all mistakes.
    pub fn new(system: &System, faces: &'a [Face]) -> Result<Self> {
        let finder = Finder { system, faces };
        let mut checked =
            Self { wires: Vec::new(), adapters: Vec::new(), outputs: Vec::new(), settings: Vec::new() };
        let mut failures = Vec::new();
        // Inputs that something is meant for, be it right or wrong: that nothing drives them is no mistake of its own.
        let mut meant = Vec::new();
        for line in &system.connections {
            let laid = finder.ends(line).and_then(|(from, to, adaptation)| {
                let to = finder.find_as(&system.port(to)?, Causality::Input)?;
                meant.push(to);
                let from = finder.find_as(&system.port(from)?, Causality::Output)?;
                match adaptation {
                    None => finder.agree(from, to, Operation::Value)?,
                    Some(adaptation) => finder.adaptable(from, to, adaptation)?,
                }
                finder.lay(from, to, adaptation, &mut checked.wires, &mut checked.adapters)
            });
            failures.extend(laid.err());
        }
        for text in &system.outputs {
            match system.port(text).and_then(|port| finder.find_as(&port, Causality::Output)) {
                Ok(end) => checked.outputs.push(end),
                Err(failure) => failures.push(failure),
            }
        }
        let (settings, broken) = system.settings();
        failures.extend(broken);
        for setting in settings {
            let set = finder.find(&setting.port).and_then(|end| {
                meant.push(end);
                let name = || finder.name(end);
                if checked.wires.iter().any(|wire| wire.leads_to(end)) {
                    return Err(finder.failure(format!("`{}` is connected and has a value as well", name())));
                }
                if checked.settings.iter().any(|(other, _)| other.is(end)) {
                    return Err(finder.failure(format!("`{}` has two values", name())));
                }
                checked.settings.push((end, finder.value(end, &setting)?));
                Ok(())
            });
            failures.extend(set.err());
        }
        failures.extend(finder.undriven(&meant));
        Failure::together(failures).map_or(Ok(checked), Err)
    }
}

struct Finder<'a, 's> {
    system: &'s System,
    faces: &'a [Face],
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
        let face = &self.faces[component];
        let variable = face.variable(variable).ok_or_else(|| {
            let fmu = &components[component];
            let failure = self.failure(format!("component `{name}` ({fmu}) has no variable `{variable}`"));
            let names = face.variables.iter().map(|variable| variable.name.as_str());
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
        let mut failure = self.failure(format!("`{}` is no {word}", self.name(end)));
        if end.variable.causality == Causality::Local {
            failure = failure.help(format!(
                "it is local to its FMU, and masters connect outputs with inputs: ask for an export with it as an {word}"
            ));
        }
        let all = self.faces[end.component].variables.iter();
        let names =
            all.filter(|variable| variable.causality == causality).map(|variable| variable.name.as_str());
        Err(similar(&port.variable, names).into_iter().fold(failure, Failure::help))
    }

    /// The texts of a connection's ends, and what is done on the way.
    fn ends<'l>(&self, line: &'l Line) -> Result<(&'l str, &'l str, Option<Adaptation>)> {
        match line {
            Line::Plain(text) => {
                let (from, to) = text.split_once("->").ok_or_else(|| {
                    let name = &self.system.name;
                    Failure::new(format!("the connection `{text}` of the system {name} has no arrow"))
                        .help("write `road.position -> rig.road.position`")
                })?;
                Ok((from, to, None))
            }
            Line::Adapted(line) => Ok((&line.from, &line.to, Adaptation::of(line))),
        }
    }

    /// The inputs that nothing is meant for.
    fn undriven(&self, meant: &[End]) -> Vec<Failure> {
        let inputs = self.faces.iter().enumerate().flat_map(|(component, face)| {
            let inputs = face.variables.iter().filter(|variable| variable.causality == Causality::Input);
            inputs.map(move |variable| End { component, variable })
        });
        let undriven = inputs.filter(|end| !meant.iter().any(|other| other.is(*end)));
        undriven
            .map(|end| {
                let (name, unit) = (self.name(end), end.variable.symbol());
                self.failure(format!("nothing drives the input `{name}`")).help(format!(
                    "connect it, or let it rest: \"{name}\" = {{ value = 0.0, unit = \"{unit}\" }} under [parameters]"
                ))
            })
            .collect()
    }

    /// Whether a variable's missing unit is that of the SI for what it is connected to.
    fn is_coherent(&self, silent: End, other: End) -> bool {
        let si = match &self.system.components[silent.component] {
            Part::Theirs(foreign) => foreign.units == Some(Units::Si),
            Part::Ours(_) | Part::Set(_) => false,
        };
        let coherent = |unit: &Unit| unit.base.is_some() && unit.factor == 1.0 && unit.offset == 0.0;
        si && silent.variable.unit().is_none() && other.variable.unit().is_some_and(coherent)
    }

    /// Whether what becomes of a signal can be passed on as it is; if not, what to write.
    fn agree(&self, from: End, to: End, operation: Operation) -> Result<()> {
        self.of_one_type(from, to)?;
        let (from_name, to_name) = (self.name(from), self.name(to));
        let (given, wanted) = (from.variable.symbol(), to.variable.symbol());
        let ends = format!("from = \"{from_name}\", to = \"{to_name}\"");
        let with = |operation: Operation, rest: &str| {
            let operation = match operation {
                Operation::Value => String::new(),
                other => format!(", operation = \"{}\"", other.name()),
            };
            format!("write {{ {ends}{operation}{rest} }}")
        };
        // A rate of change or an integral of what has no unit may be anything.
        let value = operation.power_of_time() == 0;
        if value && (self.is_coherent(from, to) || self.is_coherent(to, from)) {
            return Ok(());
        }
        let leads = self
            .failure(format!("the connection `{from_name} -> {to_name}` leads from {given:?} to {wanted:?}"));
        let same = "connect variables of the same unit";
        Err(match from.variable.fit(to.variable, operation.power_of_time()) {
            Fit::Same => return Ok(()),
            Fit::Linear { factor, offset: 0.0 } => {
                leads.help(with(operation, &format!(", factor = {factor:?}")))
            }
            Fit::Linear { factor, offset } => {
                leads.help(with(operation, &format!(", factor = {factor:?}, offset = {offset:?}")))
            }
            Fit::Derivative => leads
                .help(same)
                .help(format!("or take the rate of change: {}", with(Operation::Derivative, ""))),
            Fit::Integral => {
                leads.help(same).help(format!("or take the integral: {}", with(Operation::Integral, "")))
            }
            Fit::Different => leads.help(same).help(format!(
                "or say what the one is in terms of the other: {}",
                with(operation, ", factor = ...")
            )),
            Fit::Unknown => {
                let silent =
                    if from.variable.unit().is_none_or(|unit| unit.base.is_none()) { from } else { to };
                let other = if silent.is(from) { wanted } else { given };
                let failure =
                    self.failure(format!("`{}` does not tell its unit", self.name(silent))).help(format!(
                        "look it up; if it is that of {other:?} with the same sign, {}",
                        with(operation, ", factor = 1.0")
                    ));
                match &self.system.components[silent.component] {
                    Part::Theirs(foreign) if value && silent.variable.unit().is_none() => failure.help(format!(
                        "if all of its variables without a unit are in SI units, write {{ fmu = {:?}, units = \"SI\" }}",
                        foreign.fmu.display().to_string()
                    )),
                    _ => failure,
                }
            }
        })
    }

    fn of_one_type(&self, from: End, to: End) -> Result<()> {
        let (given, wanted) = (from.variable.kind.name(), to.variable.kind.name());
        if given == wanted {
            return Ok(());
        }
        let (from, to) = (self.name(from), self.name(to));
        Err(self.failure(format!("`{from}` is of type {given} and `{to}` of type {wanted}")))
    }

    /// Whether a signal can be adapted like this.
    fn adaptable(&self, from: End, to: End, adaptation: Adaptation) -> Result<()> {
        self.of_one_type(from, to)?;
        let name = format!("the connection `{} -> {}`", self.name(from), self.name(to));
        if !matches!(from.variable.kind, Kind::Real { .. }) {
            return Err(self
                .failure(format!("{name} is of type {}", from.variable.kind.name()))
                .help("factor, offset and operation are for numbers of type Real"));
        }
        let Adaptation { operation, offset, filter, initial, .. } = adaptation;
        let factor = adaptation.factor();
        if adaptation.factor.is_none() {
            self.agree(from, to, operation)?;
        }
        if ![factor, offset, filter, initial].iter().all(|number| number.is_finite()) || filter < 0.0 {
            return Err(self.failure(format!("{name} has a number that is not finite, or a negative filter")));
        }
        if factor == 0.0 {
            return Err(self
                .failure(format!("{name} has the factor zero"))
                .help("give its input a value under [parameters] instead"));
        }
        if filter > 0.0 && !matches!(operation, Operation::Derivative | Operation::Lag) {
            return Err(self
                .failure(format!("{name} has a filter"))
                .help("it is for operation = \"derivative\" or \"lag\""));
        }
        if filter == 0.0 && operation == Operation::Lag {
            return Err(self
                .failure(format!("{name} has a lag without a time constant"))
                .help("give it in seconds: filter = 0.01"));
        }
        if initial != 0.0 && operation != Operation::Integral {
            return Err(self
                .failure(format!("{name} has an initial value"))
                .help("it is for operation = \"integral\""));
        }
        Ok(())
    }

    /// Lays the wires from an output to an input.
    fn lay(
        &self,
        from: End<'a>,
        to: End<'a>,
        adaptation: Option<Adaptation>,
        wires: &mut Vec<Wire<'a>>,
        adapters: &mut Vec<Adapter>,
    ) -> Result<()> {
        let before = wires.iter().position(|wire| wire.leads_to(to));
        let transforming = self.system.factors == Factors::Connection;
        let way = match (adaptation, before) {
            (None, None) => Some(Way::Straight),
            (None, Some(_)) => return Err(self.twice(from, to)),
            (Some(adaptation), None) if adaptation.is_none() => Some(Way::AsItIs),
            (Some(adaptation), None) if transforming && adaptation.operation == Operation::Value => {
                Some(Way::Transformed { factor: adaptation.factor(), offset: adaptation.offset })
            }
            (Some(adaptation), _) => {
                adapters.push(self.adapter(from, to, adaptation, adapters));
                None
            }
        };
        if let Some(way) = way {
            wires.push(Wire { from: Source::Output(from), to: Sink::Input(to), way });
            return Ok(());
        }
        let adapter = adapters.len() - 1;
        if let Some(index) = before {
            // A further part of a sum: what has led to the input is added to it.
            wires[index].to = Sink::Added(adapter);
            if wires[index].way == Way::Straight {
                wires[index].way = Way::AsItIs;
            }
        }
        wires.extend([
            Wire { from: Source::Output(from), to: Sink::Adapter(adapter), way: Way::AsItIs },
            Wire { from: Source::Adapter(adapter), to: Sink::Input(to), way: Way::AsItIs },
        ]);
        Ok(())
    }

    fn twice(&self, from: End, to: End) -> Failure {
        let (from, to) = (self.name(from), self.name(to));
        self.failure(format!("the input `{to}` is connected twice")).help(format!(
            "if it is to be the sum, write the second as {{ from = \"{from}\", to = \"{to}\", factor = 1.0 }}"
        ))
    }

    fn adapter(&self, from: End, to: End, adaptation: Adaptation, others: &[Adapter]) -> Adapter {
        let taken = |name: &str| {
            self.system.components.contains_key(name) || others.iter().any(|other| other.name == name)
        };
        let (from_name, to_name) = (self.name(from), self.name(to));
        let name = Adapter::name(&to_name, taken);
        let units = [from, to].map(|end| end.variable.unit().cloned());
        let title =
            format!("What stands between the components of {}: {from_name} -> {to_name}", self.system.name);
        Adapter::new(name, &title, units, adaptation, self.system)
    }

    /// The value in the type of its variable.
    fn value(&self, end: End, setting: &Setting) -> Result<Value> {
        let name = self.name(end);
        if !end.variable.settable {
            return Err(self.failure(format!("`{name}` is calculated and cannot be given a value")));
        }
        let wrong = |expected: &str| self.failure(format!("`{name}` must be {expected}"));
        let items = |items: &[(String, i32)]| {
            let names: Vec<&str> = items.iter().map(|(item, _)| item.as_str()).collect();
            wrong(&format!("one of {}", names.join(", ")))
        };
        if !matches!(end.variable.kind, Kind::Real { .. }) && setting.unit.is_some() {
            return Err(self.failure(format!("`{name}` has no unit")));
        }
        match (&end.variable.kind, &setting.value) {
            (Kind::Real { min, max, .. }, Value::Real(_) | Value::Integer(_)) => {
                let value = match setting.value {
                    Value::Integer(value) => f64::from(value),
                    Value::Real(value) => value,
                    _ => unreachable!("matched above"),
                };
                self.in_its_unit(end, setting)?;
                self.within(end, value, *min, *max)
            }
            (Kind::Choice(list), Value::Text(text)) => list
                .iter()
                .find_map(|(item, number)| (item == text).then_some(Value::Integer(*number)))
                .ok_or_else(|| items(list)),
            (Kind::Integer, value @ Value::Integer(_))
            | (Kind::Boolean, value @ Value::Boolean(_))
            | (Kind::Text, value @ Value::Text(_)) => Ok(value.clone()),
            (Kind::Real { .. }, _) => Err(wrong("a number")),
            (Kind::Integer, _) => Err(wrong("a whole number")),
            (Kind::Boolean, _) => Err(wrong("true or false")),
            (Kind::Text, _) => Err(wrong("a text")),
            (Kind::Choice(list), _) => Err(items(list)),
        }
    }

    /// The value is given in the variable's unit.
    fn in_its_unit(&self, end: End, setting: &Setting) -> Result<()> {
        let (name, symbol) = (self.name(end), end.variable.symbol());
        match &setting.unit {
            Some(given) if given == symbol => Ok(()),
            None if matches!(symbol, "" | "1") => Ok(()),
            Some(given) => Err(self
                .failure(format!("`{name}` is given in {given:?} but declared in {symbol:?}"))
                .help("convert the value")),
            None => Err(self.failure(format!("`{name}` must be given with its unit, {symbol:?}"))),
        }
    }

    fn within(&self, end: End, value: f64, min: Option<f64>, max: Option<f64>) -> Result<Value> {
        if value.is_finite() && min.is_none_or(|min| value >= min) && max.is_none_or(|max| value <= max) {
            return Ok(Value::Real(value));
        }
        let bound =
            |bound: Option<f64>, word| bound.map(|bound| format!(" {word} {bound}")).unwrap_or_default();
        let (name, symbol) = (self.name(end), end.variable.symbol());
        Err(self.failure(format!("`{name}` = {value} {symbol} is out of bounds")).help(format!(
            "it must be finite{}{}",
            bound(min, "and at least"),
            bound(max, "and at most")
        )))
    }
}
