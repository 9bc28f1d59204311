//! A first rig file of a rig of the library: the library's own file, with the rig's values.

use strut_model::{Declaration, SettingKind, Value};

use crate::rig::{Kind, Rig};

use super::Draft;
use super::text::{Page, quantity, quoted};

/// The rig file of a rig of the library.
///
/// # Errors
/// If the library has no rig file of the model.
pub fn draft(rig: &Rig) -> Result<Draft, String> {
    let plant = &rig.plant;
    let own = Kind::published_text(&rig.kind.model)
        .ok_or_else(|| format!("there is no rig file of a {}", plant.name))?;
    let mut page = Page::default();
    page.comment(&format!(
        "Rig file of {}, drafted by `diagnose new-rig`. The model is one of the library.",
        rig.name
    ));
    page.comment("Omitted keys keep the library's entries. Values are in base units of the SI.");
    page.comment("`diagnose check FILE` says what can be identified with it.");
    page.blank();
    page.lines(own.trim_end());
    page.blank();
    page.comment("Values of this rig. A measured parameter can have its standard deviation: { value = 94.4, deviation = 0.5 }");
    page.lines("[values]");
    for line in values(rig) {
        page.lines(&line);
    }
    page.blank();
    page.comment("Signals of the model. List other names of their columns under [names].");
    for (title, declared) in [("Inputs", &plant.inputs), ("Outputs", &plant.outputs)] {
        page.comment(&format!("{title}:"));
        page.rows(
            declared.iter().map(|it| [quoted(&it.name), format!("[{}]", it.unit.symbol), it.doc.clone()]),
        );
    }
    Ok(Draft { name: rig.name.clone(), text: page.text() })
}

/// A line for each value that differs from the model's own.
fn values(rig: &Rig) -> Vec<String> {
    let plant = &rig.plant;
    let number = |it: &Declaration, value: f64| {
        let written = toml::Value::Float(value);
        let shown = quantity(value, it.unit.symbol, &it.doc);
        format!("{} = {written} # {shown}", quoted(&it.name))
    };
    let stated = plant.parameters.iter().zip(&rig.parameters).zip(&rig.stated).filter(|(_, stated)| **stated);
    let parameters = stated.map(|((it, value), _)| number(it, *value));
    let starts = plant.states.iter().zip(&rig.start).filter(|(it, value)| it.start != **value);
    let starts = starts.map(|(it, value)| number(it, *value));
    let settings = plant.settings.iter().zip(plant.choices.iter().zip(&rig.choices));
    let settings = settings.filter(|(_, (own, chosen))| own != chosen).filter_map(|(it, (_, chosen))| {
        let value = match (it.kind, chosen) {
            (SettingKind::Choice(enumeration), Value::Integer(number)) => {
                let place = usize::try_from(*number).ok()?.checked_sub(1)?;
                quoted(enumeration.items.get(place)?.0)
            }
            (_, Value::Boolean(flag)) => flag.to_string(),
            (_, Value::Text(text)) => quoted(text),
            (_, Value::Integer(number)) => number.to_string(),
            (_, Value::Real(number)) => toml::Value::Float(*number).to_string(),
        };
        Some(format!("{} = {value} # {}", quoted(it.name), it.doc))
    });
    parameters.chain(starts).chain(settings).collect()
}
