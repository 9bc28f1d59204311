//! What there is, as a table or for programs.

use serde_json::{Value, json};
use strut_model::Interface;
use unicode_width::UnicodeWidthStr;

use crate::failure::Result;
use crate::fmu::Fmu;
use crate::plan::Plan;
use crate::table;

/// What a line of the table may be wide.
const WIDTH: usize = 120;

/// The wanted FMUs and systems, with their titles, since those are what one chooses by.
///
/// # Errors
/// If a parameter set does not fit its model.
pub fn text(plan: &Plan, json: bool) -> Result<String> {
    let fmus = plan.wanted.iter().map(|index| &plan.fmus[*index]);
    let fmus = fmus.map(|fmu| Ok((fmu, fmu.interface()?))).collect::<Result<Vec<_>>>()?;
    if json {
        let systems = plan.systems.iter().map(|(system, _)| {
            let components =
                system.components.iter().map(|(name, part)| (name.clone(), json!(part.to_string())));
            json!({
                "name": system.name, "kind": "system", "title": system.title, "source": system.source,
                "components": Value::Object(components.collect()),
            })
        });
        let all: Vec<Value> =
            fmus.iter().map(|(fmu, interface)| facts(fmu, interface)).chain(systems).collect();
        return Ok(format!("{:#}\n", Value::from(all)));
    }
    let mut rows = Vec::new();
    for (fmu, interface) in &fmus {
        let (inputs, outputs) = Fmu::ports(interface);
        let kind = fmu.entry.about.kind.name().into();
        rows.push(vec![fmu.name.clone(), kind, format!("{inputs} → {outputs}"), fmu.title().to_owned()]);
    }
    for (system, _) in &plan.systems {
        rows.push(vec![
            system.name.clone(),
            "system".into(),
            format!("{} FMUs", system.components.len()),
            system.title.clone(),
        ]);
    }
    // The titles have what the other columns and the space between them leave.
    let width = |column: usize| rows.iter().map(|row| row[column].width()).max().unwrap_or(0);
    let left = WIDTH - (width(0) + width(1).max(4) + width(2).max(8) + 6);
    rows.iter_mut().for_each(|row| row[3] = shortened(&row[3], left));
    Ok(table::aligned(&["NAME", "KIND", "IN → OUT", "WHAT IT IS"], &[], &rows))
}

fn facts(fmu: &Fmu, interface: &Interface) -> Value {
    let (inputs, outputs) = Fmu::ports(interface);
    json!({
        "name": fmu.name, "kind": fmu.entry.about.kind.name(), "title": fmu.title(),
        "model": fmu.entry.about.name, "source": fmu.set.as_ref().map(|set| &set.parsed.source),
        "inputs": inputs, "outputs": outputs, "states": interface.states,
    })
}

/// A title that leaves the table readable; the description has all of it.
fn shortened(title: &str, most: usize) -> String {
    if title.chars().count() <= most {
        return title.to_owned();
    }
    // The dots and their space need two.
    let kept: String = title.chars().take(most - 2).collect();
    let words = kept.rsplit_once(' ').map_or(kept.as_str(), |(words, _)| words);
    format!("{} …", words.trim_end_matches([',', ';', ':']))
}
