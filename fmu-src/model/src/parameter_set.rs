//! A published parameter set: values with unit and source, as data.

use std::collections::BTreeMap;

use toml::{Table, Value as Toml};

use crate::{
    Declaration, Error, SettingKind, Value,
    layout::{Declared, Section, display, expected},
    unit::{self, OwnedUnit},
};

/// Start values for a model, from a TOML file.
///
/// ```toml
/// fmu = "TumQuarterVehicle"       # name of the FMU
/// model = "QuarterCar"            # the model it is made of
/// title = "..."                   # what it is, one sentence
/// source = "TUM"                  # key in literature.bib
/// files = ["profile.csv"]         # optional: what goes into the FMU's resources
///
/// [values]
/// sprung_mass = { value = 94.38, unit = "kg", source = "Table 10" }
/// tire.lift_off = { value = true, source = "4.3.2", assumed = true }
/// damping = { value = [0.3, 0.5], unit = "N.m.s/rad", source = "Fig. 9" }  # damping[1], damping[2]
///
/// [units]                         # optional: of variables that the model declares for any unit
/// input = { symbol = "kN", base = { kg = 1, m = 1, s = -2 }, factor = 1e3 }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterSet {
    /// Name of the FMU.
    pub fmu: String,
    /// Name of the model.
    pub model: String,
    /// What it is, one sentence.
    pub title: String,
    /// Key of the source document.
    pub source: String,
    /// Files that the values name, beside the set; they go into the FMU's resources.
    pub files: Vec<String>,
    /// Value of each variable that differs from its declaration.
    pub values: BTreeMap<String, Given>,
    /// Unit of each variable that the model declares for any unit.
    pub units: BTreeMap<String, OwnedUnit>,
}

/// A value of a parameter set.
#[derive(Clone, Debug, PartialEq)]
pub struct Given {
    /// The value; an enumeration's item is given by name.
    pub value: Value,
    /// Its unit; none for settings.
    pub unit: Option<String>,
    /// Page, table or equation.
    pub source: String,
    /// Chosen with a reason (in `source`) because the document does not give it.
    pub assumed: bool,
}

impl ParameterSet {
    /// Reads the TOML form.
    ///
    /// # Errors
    /// A sentence with the line for broken syntax, or the key that is missing or of a wrong type.
    pub fn parse(text: &str) -> Result<Self, String> {
        let table: Table = text.parse().map_err(|error: toml::de::Error| error.to_string())?;
        let text_of = |key: &str| match table.get(key) {
            Some(Toml::String(text)) => Ok(text.clone()),
            _ => Err(format!("`{key} = \"...\"` is missing")),
        };
        let mut values = BTreeMap::new();
        match table.get("values") {
            Some(Toml::Table(list)) => collect(list, "", &mut values)?,
            None => {}
            Some(_) => return Err("`values` is not a table".into()),
        }
        let units = match table.get("units") {
            Some(Toml::Table(list)) => list
                .iter()
                .map(|(name, unit)| match OwnedUnit::read(unit) {
                    Ok(unit) => Ok((name.clone(), unit)),
                    Err(error) => Err(format!("the unit of `{name}`: {error}")),
                })
                .collect::<Result<_, _>>()?,
            None => BTreeMap::new(),
            Some(_) => return Err("`units` is not a table".into()),
        };
        let files = match table.get("files") {
            None => Some(Vec::new()),
            Some(Toml::Array(list)) => list.iter().map(|file| file.as_str().map(str::to_owned)).collect(),
            Some(_) => None,
        };
        Ok(Self {
            fmu: text_of("fmu")?,
            model: text_of("model")?,
            title: text_of("title")?,
            source: text_of("source")?,
            files: files.ok_or("`files` is not a list of file names")?,
            values,
            units,
        })
    }
}

/// A table with a `value` is a value, any other is a group of them.
fn collect(table: &Table, prefix: &str, into: &mut BTreeMap<String, Given>) -> Result<(), String> {
    for (key, entry) in table {
        let name = if prefix.is_empty() { key.clone() } else { format!("{prefix}.{key}") };
        match entry {
            Toml::Table(entry) if entry.contains_key("value") => match entry.get("value") {
                Some(Toml::Array(elements)) => {
                    for (number, element) in (1..).zip(elements) {
                        let mut entry = entry.clone();
                        entry.insert("value".into(), element.clone());
                        let name = format!("{name}[{number}]");
                        into.insert(name.clone(), given(&entry, &name)?);
                    }
                }
                _ => {
                    into.insert(name.clone(), given(entry, &name)?);
                }
            },
            Toml::Table(group) => collect(group, &name, into)?,
            _ => {
                return Err(format!(
                    "`{name}` is not of the form {{ value = ..., unit = \"...\", source = \"...\" }}"
                ));
            }
        }
    }
    Ok(())
}

fn given(entry: &Table, name: &str) -> Result<Given, String> {
    let mut given = Given { value: Value::Real(0.0), unit: None, source: String::new(), assumed: false };
    for (key, item) in entry {
        match (key.as_str(), item) {
            ("value", Toml::Float(number)) => given.value = Value::Real(*number),
            ("value", Toml::Integer(number)) => {
                given.value = Value::Integer(
                    i32::try_from(*number).map_err(|_| format!("`{name}`: {number} is too large"))?,
                );
            }
            ("value", Toml::Boolean(flag)) => given.value = Value::Boolean(*flag),
            ("value", Toml::String(text)) => given.value = Value::Text(text.clone()),
            ("unit", Toml::String(text)) => given.unit = Some(text.clone()),
            ("source", Toml::String(text)) => given.source.clone_from(text),
            ("assumed", Toml::Boolean(flag)) => given.assumed = *flag,
            _ => {
                return Err(format!(
                    "`{name}`: `{key}` is unknown or of a wrong type; a value has value, unit, source, assumed"
                ));
            }
        }
    }
    Ok(given)
}

/// A model's start values: declared ones, and a parameter set on top.
pub(crate) struct Starts {
    /// Of each real variable that has one, by value reference.
    pub reals: BTreeMap<u32, f64>,
    /// Of each setting.
    pub settings: Vec<Value>,
}

impl Starts {
    /// That of a real variable; zero if it has none.
    pub fn real(&self, reference: usize) -> f64 {
        self.reals.get(&(reference as u32)).copied().unwrap_or(0.0)
    }

    /// # Errors
    /// If the set names a variable that does not exist or gives a value of a wrong type or unit, or out of bounds.
    pub fn of(all: &Declared, set: Option<&ParameterSet>) -> Result<Self, Error> {
        let name = all.model;
        if let Some(ParameterSet { fmu, model, .. }) = set
            && model != name
        {
            return Err(Error::Refused(format!(
                "the parameter set of {fmu} is one for the model {model}, not for {name}"
            )));
        }
        let mut settings = all.setting_starts.clone();
        let mut declared: Vec<(u32, &Declaration)> = Vec::new();
        for section in [Section::Input, Section::State, Section::Parameter, Section::Solver] {
            declared.extend((all.first(section) as u32..).zip(all.section(section)));
        }
        let mut reals: BTreeMap<u32, f64> =
            declared.iter().map(|(reference, declaration)| (*reference, declaration.start)).collect();
        let outputs = all.section(Section::Output);
        for variable in set.iter().flat_map(|set| set.units.keys()) {
            let mut reals = declared.iter().map(|(_, declaration)| *declaration).chain(outputs);
            let found = reals.find(|declaration| declaration.name == *variable);
            if found.is_none_or(|declaration| declaration.unit != unit::ANY) {
                return Err(Error::Refused(format!(
                    "{name} has no variable `{variable}` whose unit a parameter set gives"
                )));
            }
        }
        for (variable, given) in set.iter().flat_map(|set| &set.values) {
            if let Some((reference, declaration)) =
                declared.iter().find(|(_, declaration)| declaration.name == *variable)
            {
                let unit = set.and_then(|set| set.units.get(variable)).map(|unit| &*unit.symbol);
                reals.insert(*reference, real(declaration, unit, given)?);
            } else if let Some(index) = all.settings.iter().position(|setting| setting.name == variable) {
                settings[index] = setting(&all.settings[index], given)?;
            } else {
                let names = declared.iter().map(|(_, declaration)| declaration.name.as_str());
                let similar = similar(variable, names.chain(all.settings.iter().map(|setting| setting.name)));
                return Err(Error::UnknownName { name: variable.clone(), model: name, similar });
            }
        }
        Ok(Self { reals, settings })
    }
}

/// `unit` is what the set gives for a variable of any unit.
fn real(declaration: &Declaration, unit: Option<&str>, given: &Given) -> Result<f64, Error> {
    let declared = unit.unwrap_or(declaration.unit.symbol);
    let name = || declaration.name.clone();
    let value = match given.value {
        Value::Real(number) => number,
        Value::Integer(number) => f64::from(number),
        _ => return Err(Error::NotFinite { name: name(), value: f64::NAN }),
    };
    if let Some(unit) = &given.unit
        && unit != declared
    {
        return Err(Error::WrongUnit { name: name(), given: unit.clone(), declared: declared.into() });
    }
    crate::layout::check_bounds(declaration, value)?;
    Ok(value)
}

fn setting(declaration: &crate::SettingDeclaration, given: &Given) -> Result<Value, Error> {
    let value = match (declaration.kind, &given.value) {
        (SettingKind::Choice(enumeration), Value::Text(text)) => (1..)
            .zip(enumeration.items)
            .find_map(|(index, (item, _))| (item == text).then_some(Value::Integer(index))),
        (SettingKind::Integer, value @ Value::Integer(_))
        | (SettingKind::Boolean, value @ Value::Boolean(_))
        | (SettingKind::Text, value @ Value::Text(_)) => Some(value.clone()),
        _ => None,
    };
    value.ok_or_else(|| Error::NotAChoice {
        name: declaration.name,
        value: display(&given.value),
        expected: expected(declaration.kind),
    })
}

/// The name with the longest common run of characters at both ends, if it is like the one given.
fn similar<'a>(name: &str, names: impl Iterator<Item = &'a str>) -> Option<String> {
    let likeness = |other: &str| {
        let front = name.chars().zip(other.chars()).take_while(|(a, b)| a == b).count();
        let back = name.chars().rev().zip(other.chars().rev()).take_while(|(a, b)| a == b).count();
        front + back
    };
    names
        .map(|other| (likeness(other), other))
        .max_by_key(|(score, _)| *score)
        .filter(|(score, _)| *score * 2 >= name.len())
        .map(|(_, other)| other.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "fmu = 'A'\nmodel = 'B'\ntitle = 't'\nsource = 's'\n";

    #[test]
    fn values_may_be_nested_or_dotted() {
        let text = format!(
            "{HEAD}[values]\nstrut.stiffness = {{ value = 8400, unit = 'N/m', source = 'Table 10' }}\n\
                            [values.tire]\nlift_off = {{ value = true, assumed = true }}\n"
        );
        let set = ParameterSet::parse(&text).unwrap();
        assert_eq!(set.values["strut.stiffness"].value, Value::Integer(8400));
        assert_eq!(
            set.values["tire.lift_off"],
            Given { value: Value::Boolean(true), unit: None, source: String::new(), assumed: true }
        );
    }

    #[test]
    fn a_list_is_the_values_of_an_array() {
        let text =
            format!("{HEAD}[values]\na.damping = {{ value = [1.5, 2], unit = 'N', source = 'Fig. 9' }}\n");
        let set = ParameterSet::parse(&text).unwrap();
        let names: Vec<&str> = set.values.keys().map(String::as_str).collect();
        assert_eq!(names, ["a.damping[1]", "a.damping[2]"]);
        assert_eq!(set.values["a.damping[2]"].value, Value::Integer(2));
        assert_eq!(set.values["a.damping[2]"].source, "Fig. 9");
    }

    #[test]
    fn mistakes_are_named() {
        for (text, part) in [
            ("fmu = 'A'", "`model = \"...\"` is missing"),
            (&format!("{HEAD}[values]\na = 3"), "`a` is not of the form"),
            (&format!("{HEAD}[values]\na = {{ value = 3, units = 'm' }}"), "`units` is unknown"),
            (&format!("{HEAD}values = 1"), "not a table"),
            (&format!("{HEAD}["), "TOML parse error"),
            (&format!("{HEAD}[units]\na = 'm'"), "the unit of `a`: a unit is { symbol"),
            (&format!("{HEAD}[units]\na = {{ base = {{}} }}"), "the unit of `a`: a symbol is missing"),
            (&format!("{HEAD}[units]\na = {{ symbol = 'x', base = {{ g = 1 }} }}"), "`g` is no base unit"),
        ] {
            let error = ParameterSet::parse(text).unwrap_err();
            assert!(error.contains(part), "{error}");
        }
    }

    #[test]
    fn similar_names_are_proposed() {
        let names = ["strut.stiffness", "tire.stiffness", "sprung_mass"];
        assert_eq!(similar("strut.stifness", names.into_iter()).as_deref(), Some("strut.stiffness"));
        assert_eq!(similar("zzz", names.into_iter()), None);
    }
}
