//! The signals of a rig, its nominal parameters and the effects of its catalogue, in plain text.

use std::collections::BTreeMap;

use strut_model::{Declaration, ParameterSet};
use strut_physics::PARAMETER_SETS;
use unicode_width::UnicodeWidthStr;

use super::capability::headline;
use super::words::{columns, digits, unit};
use crate::catalogue;
use crate::rig::Rig;
use crate::signal::distortion::Fault;

/// Digits of a parameter's value.
const DIGITS: usize = 4;

/// The rigs, one a line: name, model, title of the parameter set.
pub fn rigs() -> String {
    let rigs: Vec<Rig> = Rig::names().iter().filter_map(|name| Rig::published(name).ok()).collect();
    let width = |of: fn(&Rig) -> &str| rigs.iter().map(|rig| of(rig).width()).max().unwrap_or(0);
    let (name, model) = (width(|rig| &rig.name), width(|rig| &rig.plant.name));
    rigs.iter().fold(String::new(), |all, rig| {
        all + &format!("{:name$}  {:model$}  {}\n", rig.name, rig.plant.name, title(&rig.fmu))
    })
}

/// Title of the parameter set of an FMU.
fn title(fmu: &str) -> String {
    let sets = PARAMETER_SETS.iter().filter_map(|(_, text)| ParameterSet::parse(text).ok());
    sets.filter(|set| set.fmu == fmu)
        .map(|set| set.title)
        .next()
        .unwrap_or_else(|| "declared start values".into())
}

/// The signals that a record of the rig may hold, with their units; the nominal parameters; the effects of the catalogue with
/// their parameters.
pub fn sheet(rig: &Rig) -> String {
    let plant = &rig.plant;
    let mut sheet = format!("{}\n", headline(rig));
    let shown = |it: &&Declaration| !rig.is_trivial(&it.name);
    let outputs = plant.outputs.iter().filter(shown);
    section(&mut sheet, "Inputs (a record needs at least one)", plant.inputs.iter(), |it| signal(rig, it));
    section(&mut sheet, "Outputs (a record needs at least one)", outputs, |it| signal(rig, it));
    section(&mut sheet, "Nominal parameters", rig.base().into_iter(), |index| {
        let declared = &plant.parameters[index];
        let value = format!("{} {}", digits(rig.parameters[index], DIGITS), unit(declared.unit.symbol));
        [declared.name.clone(), value.trim_end().into(), declared.doc.clone()]
    });
    let mut effects: BTreeMap<(&str, &str), Vec<&str>> = BTreeMap::new();
    for effect in catalogue::effects(plant) {
        effects.entry((effect.id, effect.name)).or_default().push(effect.element.name());
    }
    let title = "Effects of the catalogue by number; every sensor may have a distortion, too";
    section(&mut sheet, title, effects.into_iter(), |((id, name), elements)| {
        [id.into(), elements.join(", "), name.into()]
    });
    let title = "Parameters of these effects, for `diagnose simulate --hide NAME=VALUE`";
    let mut parameters: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for effect in catalogue::effects(plant) {
        for part in effect.parts {
            let effects = parameters.entry(part.parameter).or_default();
            if !effects.contains(&effect.id) {
                effects.push(effect.id);
            }
        }
    }
    section(&mut sheet, title, parameters.into_iter(), |(name, effects)| {
        let declared = &plant.parameters[plant.parameter(name).expect("the effect is in the plant")];
        [
            name.into(),
            format!("[{}]", declared.unit.symbol),
            format!("{}; effect {}", declared.doc, effects.join(", ")),
        ]
    });
    sheet += "\nDistortions of every signal above, for --hide SIGNAL.DISTORTION=VALUE:\n  ";
    sheet += &Fault::NAMED.map(Fault::name).join(", ");
    sheet.push('\n');
    sheet
}

/// Name, unit and description.
fn signal(rig: &Rig, it: &Declaration) -> [String; 3] {
    let others = rig.kind.aliases(&it.name).filter(|name| *name != it.name);
    let others: Vec<String> = others.map(|it| format!("`{it}`")).collect();
    let also = if others.is_empty() { String::new() } else { format!("; also {}", others.join(", ")) };
    [it.name.clone(), format!("[{}]", it.unit.symbol), format!("{}{also}", it.doc)]
}

/// A title, and below it a row of three cells for each item, the first two in columns.
fn section<T>(
    sheet: &mut String,
    title: &str,
    items: impl Iterator<Item = T>,
    cells: impl Fn(T) -> [String; 3],
) {
    *sheet += &format!("\n{title}:\n{}", columns("  ", items.map(cells)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_names_every_rig() {
        let list = rigs();
        let names: Vec<&str> = list.lines().filter_map(|line| line.split_whitespace().next()).collect();
        assert_eq!(names, Rig::names());
    }

    #[test]
    fn the_sheet_of_a_rig_lists_every_signal_and_effect() {
        for name in Rig::names() {
            let rig = Rig::published(&name).unwrap();
            let sheet = sheet(&rig);
            let outputs = rig.plant.outputs.iter().filter(|it| !rig.is_trivial(&it.name));
            for signal in rig.plant.inputs.iter().chain(outputs) {
                assert!(sheet.contains(&format!("  {} ", signal.name)), "{name}: {}\n{sheet}", signal.name);
            }
            for effect in catalogue::effects(&rig.plant) {
                assert!(sheet.contains(effect.name), "{name}: {}\n{sheet}", effect.name);
                for part in effect.parts {
                    assert!(sheet.contains(&format!("  {} ", part.parameter)), "{name}: {}", part.parameter);
                }
            }
        }
    }
}
