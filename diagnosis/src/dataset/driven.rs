//! How a rig can be driven by the columns of its records.

use crate::data::check::DataProblem;
use crate::data::map::{Map, Wanted, plain};
use crate::data::{Channel, Origin, units};
use crate::rig::{DrivenBy, Rig, Undriven};

/// Whether the first of some files has a signal or a column of a name, with or without its unit at the end.
///
/// # Errors
/// If the file cannot be read.
pub fn names<'a>(
    rig: &Rig,
    origins: &[&Origin],
    map: &'a Map,
) -> Result<impl Fn(&str) -> bool + use<'a>, String> {
    let first = origins.first().filter(|_| !rig.kind.drives.is_empty() || rig.kind.undriven.is_some());
    let record = first.map(|origin| origin.read(&map.reading).map_err(|error| error.to_string()));
    let columns = record.transpose()?.map_or(Vec::new(), |it| it.channels);
    let called = |channel: &Channel| {
        let name = channel.name.as_str();
        std::iter::once(name).chain(units::without_suffix(name)).map(plain).collect::<Vec<_>>()
    };
    let columns: Vec<String> = columns.iter().flat_map(called).collect();
    Ok(move |name: &str| map.signals.contains_key(name) || columns.contains(&plain(name)))
}

/// Replaces the rig by the one that stands for it, if no column has what drove it and one has what drives that. The note on it.
///
/// # Errors
/// If the rig's values do not fit the other model.
pub fn undriven(rig: &mut Rig, has: impl Fn(&str) -> bool) -> Result<Option<DataProblem>, String> {
    let Some(Undriven { input, .. }) = &rig.kind.undriven else { return Ok(None) };
    let is_driven = rig.kind.called(input).any(|name| has(name.trim_start_matches('-')));
    if is_driven {
        return Ok(None);
    }
    let Some(part) = rig.undriven()? else { return Ok(None) };
    let drives = |by: &DrivenBy| has(&by.input) || by.columns.iter().any(|it| has(it));
    let Some(by) = part.kind.drives.iter().find(|by| drives(by)) else { return Ok(None) };
    let note = DataProblem {
        record: "all".into(),
        signal: input.clone(),
        text: format!(
            "no column has it, so that a {} stands for the rig, driven by {}: strut and body are judged, tyre and wheel are not. If \
             {input} was at rest, give it a column of zeros",
            part.plant.name, by.input
        ),
        fatal: false,
    };
    *rig = part;
    Ok(Some(note))
}

/// Columns that a record may have in place of the rig's inputs, as the end of a sentence.
///
/// # Errors
/// If the rig's values do not fit the model that stands for it.
pub fn instead(rig: &Rig) -> Result<String, String> {
    let Some(part) = rig.undriven()? else { return Ok(String::new()) };
    let columns = part.kind.drives.iter().flat_map(|by| &by.columns);
    let shown: Vec<&str> = columns.map(String::as_str).filter(|it| rig.plant.output(it).is_some()).collect();
    Ok(format!(", or for the strut alone one of {}", shown.join(", ")))
}

/// The map without signals that only the whole rig has, if another one stands for it: nobody knew that when the map was written.
pub fn of_part(rig: &Rig, map: &Map, wanted: &[Wanted]) -> Map {
    let Some(whole) = &rig.of else { return map.clone() };
    let has = |rig: &Rig, name: &str| {
        let signals = rig.plant.inputs.iter().chain(&rig.plant.outputs);
        signals.flat_map(|it| rig.kind.called(&it.name)).any(|it| it.trim_start_matches('-') == name)
    };
    let mut map = map.clone();
    map.signals.retain(|name, _| wanted.iter().any(|it| it.is_called(name)) || !has(whole, name));
    map
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_of_the_whole_rig_fits_the_one_that_stands_for_it() {
        let car = Rig::published("tum-quarter-vehicle").unwrap();
        let part = car.undriven().unwrap().unwrap();
        let text = "[signals]\n\"wheel.force\" = \"F\"\n\"body.acceleration\" = \"a\"\nnonsense = \"b\"";
        let map = Map::parse(text).unwrap();
        let body = Wanted { name: "body.acceleration".into(), unit: "m/s2".into(), aliases: Vec::new() };
        let names = |rig: &Rig| {
            of_part(rig, &map, std::slice::from_ref(&body)).signals.into_keys().collect::<Vec<_>>()
        };
        // A name that neither has is refused later.
        assert_eq!(names(&part), ["body.acceleration", "nonsense"]);
        assert_eq!(names(&car).len(), 3);
    }
}
