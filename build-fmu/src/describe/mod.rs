//! All that there is to know about an FMU or a system, for people and for programs.

mod fmu;
mod json;
mod page;
mod system;

use crate::failure::Result;
use crate::plan::Plan;
use crate::system::Part;

/// The description of the FMU or system of a name.
///
/// # Errors
/// If there is none of that name, or its parameter set does not fit its model.
pub fn text(plan: &Plan, name: &str, json: bool) -> Result<String> {
    if let Some(fmu) = plan.fmus.iter().find(|fmu| fmu.name == name) {
        let interface = fmu.interface()?;
        return Ok(if json { json::fmu(plan, fmu, &interface) } else { fmu::page(plan, fmu, &interface) });
    }
    if let Some((system, _)) = plan.systems.iter().find(|(system, _)| system.name == name) {
        return Ok(if json { json::system(system) } else { system::page(system) });
    }
    let failure = plan.unknown(name);
    let is_file = name.ends_with(".fmu") || name.ends_with(".ssp");
    Err(if is_file {
        failure.help("a name is wanted here, no file; `build-fmu check` takes files")
    } else {
        failure
    })
}

/// The other FMUs of a model, and the systems with an FMU in them: what to look at next.
fn related<'a>(plan: &'a Plan, name: &str, model: &str) -> (Vec<&'a str>, Vec<&'a str>) {
    let sets = plan.fmus.iter().filter(|fmu| fmu.set.is_some() && fmu.name != name);
    let sets = sets.filter(|fmu| fmu.entry.about.name == model).map(|fmu| fmu.name.as_str());
    let systems = plan.systems.iter().map(|(system, _)| system);
    let is_this = |part: &Part| matches!(part, Part::Ours(fmu) if fmu == name);
    let systems = systems.filter(|system| system.components.values().any(is_this));
    (sets.collect(), systems.map(|system| system.name.as_str()).collect())
}
