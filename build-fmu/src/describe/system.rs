//! A system on a page for a terminal.

use super::page::Page;
use crate::documentation::tables::{number, printed};
use crate::system::System;

/// The page.
pub fn page(system: &System) -> String {
    let mut page = Page::new();
    page.title(&system.name, "system", &system.title);
    let experiment = system.experiment;
    let (stop, step) = (number(experiment.stop), number(experiment.step));
    page.aside("", &format!("Source: {}; SSP 1.0; {stop} s in steps of {step} s", system.source));
    page.heading("Components");
    let rows = system.components.iter().map(|(name, fmu)| vec![name.clone(), fmu.to_string()]);
    page.table(&["name", "FMU"], None, &rows.collect::<Vec<_>>());
    page.heading("Connections");
    let rows = system.ends().map(|(from, to)| vec![from, format!("→ {to}")]);
    page.table(&["from", "  to"], None, &rows.collect::<Vec<_>>());
    let rows: Vec<_> = system
        .settings()
        .0
        .into_iter()
        .map(|setting| {
            let unit = setting.unit.as_deref().map(printed).unwrap_or_default();
            let value = crate::documentation::rows::value(&setting.value);
            vec![format!("{}.{}", setting.port.component, setting.port.variable), value, unit]
        })
        .collect();
    if !rows.is_empty() {
        page.heading("Parameters");
        page.table(&["name", "value", "unit"], Some(1), &rows);
    }
    if !system.outputs.is_empty() {
        page.heading("What to look at");
        page.paragraph("  ", &system.outputs.join(", "));
    }
    page.finish()
}
