//! An FMU on a page for a terminal.

use strut_model::{About, Interface, ParameterSet, Stimulus};

use super::{page::Page, related};
use crate::documentation::tables::number;
use crate::documentation::{count, rows, unit, words};
use crate::fmu::Fmu;
use crate::plan::Plan;

/// The page.
pub fn page(plan: &Plan, fmu: &Fmu, interface: &Interface) -> String {
    let about = fmu.entry.about;
    let mut page = Page::new();
    page.title(&fmu.name, about.kind.name(), fmu.title());
    if let Some(set) = &fmu.set {
        let sentence = format!(
            "The model {} with a published parameter set; source: {}. {}.",
            about.name, set.parsed.source, about.summary
        );
        page.paragraph("", &sentence);
    }
    let (inputs, outputs) = Fmu::ports(interface);
    let ports = [count(inputs, "input"), count(outputs, "output"), count(interface.states, "state")];
    let facts =
        format!("FMI 2.0 co-simulation and model exchange; {}; {}", ports.join(", "), interface.guid());
    page.aside("", &facts);
    equations(&mut page, &about);
    if !about.notes.is_empty() {
        page.heading("Notes");
        about.notes.iter().for_each(|note| page.paragraph("  - ", note));
    }
    experiment(&mut page, interface);
    variables(&mut page, interface);
    if let Some(set) = &fmu.set {
        parameter_set(&mut page, interface, &set.parsed);
    }
    let (sets, systems) = related(plan, &fmu.name, about.name);
    if !sets.is_empty() {
        page.heading(if fmu.set.is_some() {
            "Other parameter sets of this model"
        } else {
            "Published parameter sets"
        });
        page.paragraph("  ", &sets.join(", "));
    }
    if !systems.is_empty() {
        page.heading("Systems with it");
        page.paragraph("  ", &systems.join(", "));
    }
    page.finish()
}

fn equations(page: &mut Page, about: &About) {
    if about.equations.is_empty() {
        return;
    }
    page.heading("Equations");
    for equation in about.equations {
        page.paragraph("  ", equation.text);
        page.aside("      ", equation.source);
    }
}

fn experiment(page: &mut Page, interface: &Interface) {
    let experiment = interface.about.experiment;
    let said = |(name, stimulus): &(&str, Stimulus)| {
        let unit = unit(interface, name);
        format!("{name} {}", words(*stimulus, &unit))
    };
    let stimuli: Vec<String> = experiment.stimuli.iter().map(said).collect();
    let inputs = if stimuli.is_empty() { "the inputs rest".to_owned() } else { stimuli.join(", ") };
    page.heading("Default experiment");
    let (stop, step) = (number(experiment.stop), number(experiment.step));
    page.paragraph("  ", &format!("{stop} s in steps of {step} s; {inputs}."));
}

fn variables(page: &mut Page, interface: &Interface) {
    for (heading, causality) in rows::TABLES {
        let rows: Vec<_> = rows::of(interface, causality).into_iter().map(row).collect();
        if !rows.is_empty() {
            page.heading(heading);
            page.table(&["name", "start", "unit", "range", "description"], Some(1), &rows);
        }
    }
}

fn row(row: rows::Row) -> Vec<String> {
    let mut doc = row.doc;
    if !row.items.is_empty() {
        let names: Vec<&str> = row.items.iter().map(|(name, _)| *name).collect();
        doc = format!("{doc}: {}", names.join(", "));
    }
    vec![row.name, row.start, row.unit, row.range, doc]
}

fn parameter_set(page: &mut Page, interface: &Interface, set: &ParameterSet) {
    page.heading("Parameter set");
    let row = |given: rows::GivenRow| {
        let assumed = if given.assumed { "assumed: " } else { "" };
        vec![given.name, given.value, given.unit, format!("{assumed}{}", given.source)]
    };
    let values: Vec<_> = rows::given(interface, set).into_iter().map(row).collect();
    page.table(&["name", "value", "unit", "source"], Some(1), &values);
}
