//! An FMU with other values than the published ones, as `--set` gives them.

use std::path::Path;

use strut_model::{ParameterSet, VariableKind};
use toml::{Table, Value};

use crate::failure::{Failure, Result, similar};
use crate::fmu::{Fmu, Set};

/// Where such a value comes from.
const SOURCE: &str = "set by the user";

/// The FMU with values `NAME=VALUE`, perhaps under another name. `files` is where the files of a model's own set would be.
///
/// # Errors
/// If a value is not of that form, or the model has no such parameter or refuses it.
pub fn with_values(fmu: &Fmu, values: &[String], name: Option<&str>, files: &Path) -> Result<Fmu> {
    let mut table = match &fmu.set {
        Some(set) => set.text.parse::<Table>().expect("it was read before"),
        None => Table::from_iter([
            ("fmu".to_owned(), Value::from(fmu.name.as_str())),
            ("model".to_owned(), fmu.entry.about.name.into()),
            ("title".to_owned(), fmu.entry.about.summary.into()),
            ("source".to_owned(), SOURCE.into()),
        ]),
    };
    if let Some(name) = name {
        table.insert("fmu".into(), name.into());
    }
    let interface = fmu.interface()?;
    let list = table.entry("values").or_insert_with(|| Table::new().into());
    let list = list.as_table_mut().ok_or_else(|| Failure::new("`values` is not a table"))?;
    let mut changed = Vec::new();
    for text in values {
        let (variable, value) = text.split_once('=').ok_or_else(|| {
            Failure::new(format!("--set {text}: write NAME=VALUE, as in strut.stiffness=9000"))
        })?;
        let variable = variable.trim();
        let declared = interface.variable(variable).ok_or_else(|| {
            let names = interface.variables.iter().map(|variable| variable.name.as_str());
            Failure::new(format!("{} has no parameter `{variable}`", fmu.name))
                .help_if(similar(variable, names))
                .help(format!("`build-fmu describe {}` lists them", fmu.name))
        })?;
        let mut entry = Table::from_iter([("value".to_owned(), read(value.trim()))]);
        if let VariableKind::Real { unit, .. } = &declared.kind {
            entry.insert("unit".into(), unit.symbol.to_string().into());
        }
        entry.insert("source".into(), SOURCE.into());
        // What the set says of it stands in nested tables, or under the whole name.
        remove(list, variable);
        list.insert(variable.to_owned(), entry.into());
        changed.push(variable);
    }
    let title = table.get("title").and_then(Value::as_str).unwrap_or_default();
    let title = format!("{title}; changed: {}", changed.join(", "));
    table.insert("title".into(), title.into());
    let text = table.to_string();
    let parsed = ParameterSet::parse(&text)
        .map_err(|error| Failure::new(format!("the values for {} do not fit: {error}", fmu.name)))?;
    let folder = fmu.set.as_ref().map_or_else(|| files.to_owned(), |set| set.folder.clone());
    let (name, set) = (parsed.fmu.clone(), Some(Set { parsed, text, folder }));
    let custom = Fmu { name, entry: fmu.entry, set, related: None };
    custom.interface()?;
    Ok(custom)
}

/// A number, `true`, `false`, or else a text, with quotes or without.
fn read(text: &str) -> Value {
    let parsed = format!("value = {text}").parse::<Table>().ok();
    parsed.and_then(|mut table| table.remove("value")).unwrap_or_else(|| text.into())
}

fn remove(table: &mut Table, name: &str) {
    table.remove(name);
    for (position, _) in name.match_indices('.') {
        let (group, rest) = (&name[..position], &name[position + 1..]);
        if let Some(Value::Table(group)) = table.get_mut(group) {
            remove(group, rest);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strut_physics::{CATALOGUE, PARAMETER_SETS};

    fn published(name: &str) -> Fmu {
        let (_, text) = PARAMETER_SETS.iter().find(|(file, _)| *file == format!("{name}.toml")).unwrap();
        let parsed = ParameterSet::parse(text).unwrap();
        let entry = CATALOGUE.iter().find(|entry| entry.about.name == parsed.model).unwrap();
        let set = Set { parsed, text: (*text).into(), folder: "".into() };
        Fmu { name: name.into(), entry: *entry, set: Some(set), related: None }
    }

    fn with(fmu: &Fmu, values: &[&str], name: Option<&str>) -> Result<Fmu> {
        let values: Vec<String> = values.iter().map(|text| (*text).to_owned()).collect();
        with_values(fmu, &values, name, Path::new(""))
    }

    fn start(fmu: &Fmu, name: &str) -> VariableKind {
        fmu.interface().unwrap().variable(name).unwrap().kind.clone()
    }

    #[test]
    fn a_value_changes_and_the_others_stay() {
        let fmu = published("TumQuarterVehicle");
        let given = ["strut.stiffness=9000", "tire.lift_off = false"];
        let custom = with(&fmu, &given, Some("StiffRig")).unwrap();
        assert_eq!(custom.name, "StiffRig");
        let VariableKind::Real { start: stiffness, .. } = start(&custom, "strut.stiffness") else { panic!() };
        assert_eq!(stiffness, Some(9000.0));
        assert_eq!(start(&custom, "tire.lift_off"), VariableKind::Boolean { start: false });
        assert_eq!(start(&custom, "sprung_mass"), start(&fmu, "sprung_mass"));
        assert!(custom.title().ends_with("changed: strut.stiffness, tire.lift_off"));
        // And once more, on what was written then.
        let again = with(&custom, &["strut.stiffness=9100.5"], None).unwrap();
        let VariableKind::Real { start: stiffness, .. } = start(&again, "strut.stiffness") else { panic!() };
        assert_eq!((stiffness, again.name.as_str()), (Some(9100.5), "StiffRig"));
    }

    #[test]
    fn a_point_of_a_table_changes_alone() {
        let fmu = published("KogutMrRotaryBrake");
        let names = fmu.interface().unwrap().variables;
        let points = names.iter().filter(|it| it.name.ends_with("[3]")).map(|it| it.name.clone());
        let point = points.into_iter().next().expect("the brake has a profile");
        let other = point.replace("[3]", "[4]");
        let custom = with(&fmu, &[&format!("{point}=0.125")], None).unwrap();
        assert_ne!(start(&custom, &point), start(&fmu, &point));
        assert_eq!(start(&custom, &other), start(&fmu, &other));
    }

    #[test]
    fn what_does_not_fit_is_said() {
        let fmu = published("TumQuarterVehicle");
        for (given, part) in [
            ("strut.stifness=9000", "did you mean `strut.stiffness`"),
            ("strut.stiffness", "write NAME=VALUE"),
            ("strut.stiffness=-1", "strut.stiffness"),
            ("strut.stiffness=stiff", "strut.stiffness"),
            ("body.acceleration=1", "body.acceleration"),
        ] {
            let error = with(&fmu, &[given], None).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
    }
}
