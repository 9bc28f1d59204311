//! All records of a diagnosis, read in the way in which a rig can be compared with them.

use rayon::prelude::*;

use crate::data::Origin;
use crate::data::check::DataProblem;
use crate::data::map::Map;
use crate::dataset::recorded::Dataset;
use crate::report::findings::RecordRead;
use crate::rig::{Inverse, Rig};

use super::driven::{names, undriven};
use super::import::{FEWEST, import};
use super::inverse;
use super::rate::compared;
use super::zero::zeroed;

/// Records on a rig that can be compared with each other.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The records, in the order of their files; none where a problem is fatal.
    pub records: Vec<Dataset>,
    /// What is wrong with the data.
    pub problems: Vec<DataProblem>,
    /// How each file was read.
    pub read: Vec<RecordRead>,
}

/// Reads all records of a diagnosis. How the rig is driven follows from what they have: inversely only if all of them can be
/// compared so. Where no column has what drove it, the rig becomes the one that stands for it then.
///
/// # Errors
/// If a file cannot be read, or has not the signals that the rig needs: what to do.
pub fn load(rig: &mut Rig, origins: &[&Origin], map: &Map) -> Result<Loaded, String> {
    let has = names(rig, origins, map)?;
    let note = undriven(rig, &has)?;
    let mut loaded = as_driven(rig, origins, map, has)?;
    loaded.problems.splice(0..0, note);
    loaded.problems.extend(zeroed(rig, &mut loaded.records));
    Ok(loaded)
}

/// Reads all records in the first of the rig's ways in which they can be compared.
fn as_driven(
    rig: &mut Rig,
    origins: &[&Origin],
    map: &Map,
    has: impl Fn(&str) -> bool,
) -> Result<Loaded, String> {
    let (mut notes, mut refused): (Vec<DataProblem>, Option<Inverse>) = (Vec::new(), None);
    for by in rig.ways(&has) {
        rig.drive_by(&by, &has)?;
        let Some(inverse) = &by.inverse else { break };
        let rate = inverse.rate.as_deref().filter(|rate| rig.kind.called(rate).any(&has));
        let by_rate = rate.and_then(|rate| forward(rig, origins, map, Some(rate)).ok());
        if let Ok(by_position) = forward(rig, origins, map, None) {
            match within(rig, inverse, by_position, by_rate) {
                Ok(loaded) => return Ok(loaded),
                Err(note) => {
                    notes.extend(note);
                    refused = Some(inverse.clone());
                }
            }
        }
    }
    let mut loaded = forward(rig, origins, map, None)?;
    let instead = match rig.driven().filter(|by| by.inverse.is_none()) {
        Some(by) => {
            format!("so {} drives the model, and the motion is compared. Friction shows less in it", by.input)
        }
        None => "but it is differentiated all the same".into(),
    };
    // Of data that cannot be used, more is wrong than that.
    let refused = refused.filter(|_| !loaded.records.is_empty());
    notes.extend(refused.map(|it| inverse::refused(&it, &instead)));
    loaded.problems.splice(0..0, notes);
    Ok(loaded)
}

/// Records in the band in which their motion is known: by the rate that a sensor of its own measures, if that goes with the position,
/// and the force follows from it more closely.
///
/// # Errors
/// If there is no such band: what is to be said of the rate.
fn within(
    rig: &Rig,
    inverse: &Inverse,
    by_position: Loaded,
    by_rate: Option<Loaded>,
) -> Result<Loaded, Option<DataProblem>> {
    let banded = |loaded: &Loaded| inverse::banded(rig, &loaded.records, inverse);
    let (one, two) = (banded(&by_position), by_rate.as_ref().and_then(banded));
    let tops = [&one, &two].into_iter().flatten().map(|it| it.top);
    let top = tops.reduce(f64::min);
    let is_coarse = one.is_none();
    let seen = by_rate
        .as_ref()
        .zip(top)
        .and_then(|(it, top)| compared(rig, inverse, &by_position.records, &it.records, (top, is_coarse)));
    let note = seen.as_ref().and_then(|it| it.note(inverse));
    let used = match (by_rate, two) {
        (Some(by_rate), Some(two)) if seen.is_some_and(|it| it.is_better) => Some((by_rate, two)),
        _ => one.map(|one| (by_position, one)),
    };
    let Some((loaded, banded)) = used else { return Err(note) };
    // What drives the model comes first: it matters more than single samples.
    let problems = note.into_iter().chain([banded.note]).chain(loaded.problems).collect();
    Ok(Loaded { records: banded.records, problems, ..loaded })
}

/// Reads all records as the rig is driven; `rate` is the output whose column drives it, too, as the rate of its motion.
fn forward(rig: &Rig, origins: &[&Origin], map: &Map, rate: Option<&str>) -> Result<Loaded, String> {
    let (mut records, mut problems, mut read) = (Vec::new(), Vec::new(), Vec::new());
    let all: Vec<_> = origins.par_iter().map(|origin| import(rig, origin, map, rate)).collect();
    // The error of the first file that cannot be read, whichever thread is ready first.
    for imported in all {
        let imported = imported?;
        problems.extend(imported.problems);
        records.extend(imported.recorded);
        read.push(imported.read);
    }
    if problems.iter().any(|it| it.fatal) {
        records.clear();
    }
    if !records.is_empty() {
        align(&mut records)?;
    }
    Ok(Loaded { records, problems, read })
}

/// Keeps the outputs that all records have, so that they can be compared.
///
/// # Errors
/// If there are none.
fn align(records: &mut [Dataset]) -> Result<(), String> {
    let Some(first) = records.first() else { return Err("there is no record".into()) };
    let mut common: Vec<usize> = first.measured.iter().map(|measured| measured.output).collect();
    for record in records.iter() {
        common.retain(|output| record.measured.iter().any(|measured| measured.output == *output));
    }
    if common.is_empty() {
        return Err("the records have no output in common: give records of the same signals".into());
    }
    let mut names: Vec<String> = first.others.iter().map(|it| it.name.clone()).collect();
    names.retain(|name| records.iter().all(|record| record.others.iter().any(|it| it.name == *name)));
    for record in records.iter_mut() {
        record.others.retain(|it| names.contains(&it.name));
        record.others.sort_by_key(|it| names.iter().position(|name| *name == it.name));
        record.measured.retain(|measured| common.contains(&measured.output));
        if record.sections.is_empty() {
            return Err(format!("{}: no stretch of {FEWEST} samples without a gap", record.name));
        }
    }
    Ok(())
}
