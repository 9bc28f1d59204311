//! What a record of a rig may hold, and what is looked for in it, in plain text.

use std::collections::BTreeMap;

use strut_model::Declaration;
use unicode_width::UnicodeWidthStr;

use super::words::{digits, unit};
use crate::catalogue;
use crate::rig::Rig;

/// Digits of a parameter's value.
const DIGITS: usize = 4;

/// A rig's signals with their units, as a record may have them, the parameters that are fitted, and the causes that are
/// looked for in it.
pub fn sheet(rig: &Rig) -> String {
    let plant = &rig.plant;
    let mut sheet = format!("{}: a {}, in the FMU {}\n", rig.name, plant.name, rig.fmu);
    let shown = |it: &&Declaration| !rig.kind.trivial.contains(&it.name.as_str());
    let outputs = plant.outputs.iter().filter(shown);
    section(&mut sheet, "Inputs, of which a record has at least one", plant.inputs.iter(), |it| {
        signal(rig, it)
    });
    section(&mut sheet, "Outputs, of which a record has at least one", outputs, |it| signal(rig, it));
    section(&mut sheet, "Parameters that are fitted first", rig.base().into_iter(), |index| {
        let declared = &plant.parameters[index];
        let value = format!("{} {}", digits(rig.parameters[index], DIGITS), unit(declared.unit.symbol));
        (declared.name.clone(), value.trim_end().into(), declared.doc.clone())
    });
    let mut causes: BTreeMap<(&str, &str), Vec<&str>> = BTreeMap::new();
    for cause in catalogue::causes(plant) {
        causes.entry((cause.id, cause.name)).or_default().push(cause.element.name());
    }
    let title = "Causes that are looked for, by their numbers, beside faults of each sensor";
    section(&mut sheet, title, causes.into_iter(), |((id, name), elements)| {
        (id.into(), elements.join(", "), name.into())
    });
    sheet
}

/// Name, unit, and what it is.
fn signal(rig: &Rig, it: &Declaration) -> (String, String, String) {
    let aliases = rig.kind.aliases.iter().filter(|(name, _)| *name == it.name);
    let others: Vec<String> =
        aliases.flat_map(|(_, names)| names.iter().map(|it| format!("`{it}`"))).collect();
    let also = if others.is_empty() { String::new() } else { format!("; also {}", others.join(", ")) };
    (it.name.clone(), format!("[{}]", it.unit.symbol), format!("{}{also}", it.doc))
}

/// A title, and below it a row of three cells for each item, the first two in columns.
fn section<T>(
    sheet: &mut String,
    title: &str,
    items: impl Iterator<Item = T>,
    cells: impl Fn(T) -> (String, String, String),
) {
    let rows: Vec<_> = items.map(cells).collect();
    let width = |of: fn(&(String, String, String)) -> &String| rows.iter().map(|row| of(row).width()).max();
    let (first, second) = (width(|row| &row.0).unwrap_or(0), width(|row| &row.1).unwrap_or(0));
    *sheet += &format!("\n{title}:\n");
    for (name, middle, text) in &rows {
        let pad = |cell: &str, to: usize| " ".repeat(to - cell.width());
        *sheet += &format!("  {name}{}  {middle}{}  {text}\n", pad(name, first), pad(middle, second));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rig_has_a_sheet_with_all_that_a_record_may_hold() {
        for name in Rig::names() {
            let rig = Rig::published(&name).unwrap();
            let sheet = sheet(&rig);
            let outputs = rig.plant.outputs.iter().filter(|it| !rig.kind.trivial.contains(&it.name.as_str()));
            for signal in rig.plant.inputs.iter().chain(outputs) {
                assert!(sheet.contains(&format!("  {} ", signal.name)), "{name}: {}\n{sheet}", signal.name);
            }
            for cause in catalogue::causes(&rig.plant) {
                assert!(sheet.contains(cause.name), "{name}: {}\n{sheet}", cause.name);
            }
        }
    }
}
