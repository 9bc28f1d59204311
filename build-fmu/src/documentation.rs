//! The page that an FMU brings along.

pub mod mathml;
pub mod rows;
pub mod tables;

use maud::{DOCTYPE, Markup, html};
use strut_model::{About, Interface, ParameterSet, Stimulus, Trajectory, VariableKind};

use crate::fmu::Fmu;
use crate::literature::Work;
use crate::plot;

/// What a page is about.
pub struct Page<'a> {
    /// The FMU.
    pub fmu: &'a Fmu,
    /// Its variables.
    pub interface: &'a Interface,
    /// Its default experiment.
    pub trajectory: &'a Trajectory,
    /// What the keys of sources stand for.
    pub works: &'a [Work],
}

/// Where the equations of effects are explained.
const EFFECTS: &str = "docs/effects.md";

/// The page as well-formed HTML with nothing outside but the icon.
pub fn html(page: &Page) -> String {
    let Page { fmu, interface, .. } = page;
    let about = fmu.entry.about;
    let (inputs, outputs) = Fmu::ports(interface);
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (fmu.name) }
                style { (maud::PreEscaped(include_str!("documentation/style.css"))) }
            }
            body {
                header {
                    img src="../model.png" alt=(about.kind.name()) width="72" height="72";
                    div {
                        h1 { (fmu.name) span.kind { (about.kind.name()) } }
                        p.title { (fmu.title()) }
                    }
                }
                p.facts {
                    span { "FMI 2.0 co-simulation and model exchange" }
                    span { (count(inputs, "input")) }
                    span { (count(outputs, "output")) }
                    span { (count(interface.states, "state")) }
                    span { code { (interface.guid()) } }
                }
                @if fmu.set.is_some() {
                    p { "The model " code { (about.name) } " with a published parameter set. " (about.summary) }
                }
                (equations(&about))
                (notes(&about))
                (experiment(page))
                (tables::parameter_set(page))
                (tables::variables(page))
                (sources(page))
            }
        }
    }
    .into_string()
}

/// `no inputs`, `1 input`, `2 inputs`.
pub fn count(number: usize, of: &str) -> String {
    match number {
        0 => format!("no {of}s"),
        1 => format!("1 {of}"),
        _ => format!("{number} {of}s"),
    }
}

fn equations(about: &About) -> Markup {
    html! {
        @if !about.equations.is_empty() {
            section {
                h2 { "Equations" }
                table.equations {
                    @for equation in about.equations {
                        tr { td { div.law { (mathml::set(equation.text)) } } td.source { (source(equation.source)) } }
                    }
                }
            }
        }
    }
}

/// A source, with a link where it names the catalogue of effects.
fn source(text: &str) -> Markup {
    let mut parts = text.split(EFFECTS);
    html! {
        (parts.next().unwrap_or_default())
        @for part in parts {
            a href=(concat!(env!("CARGO_PKG_REPOSITORY"), "/blob/main/docs/effects.md")) { "effects" } (part)
        }
    }
}

/// The works that a model's equations and notes and its parameter set name.
pub fn cited<'a>(works: &'a [Work], about: &About, set: Option<&ParameterSet>) -> Vec<&'a Work> {
    let given = set.into_iter().flat_map(|set| {
        set.values
            .values()
            .map(|given| given.source.as_str())
            .chain([set.source.as_str(), set.title.as_str()])
    });
    let equations = about.equations.iter().map(|equation| equation.source);
    let texts: Vec<&str> = equations.chain(about.notes.iter().copied()).chain(given).collect();
    let named = |key: &str| {
        let mut words = texts.iter().flat_map(|text| text.split(|c: char| !c.is_alphanumeric()));
        words.any(|word| word == key)
    };
    works
        .iter()
        .filter(|work| named(&work.key) || texts.iter().any(|it| it.contains(&work.cited())))
        .collect()
}

fn sources(page: &Page) -> Markup {
    let set = page.fmu.set.as_ref().map(|set| &set.parsed);
    let cited = cited(page.works, &page.fmu.entry.about, set);
    html! {
        @if !cited.is_empty() {
            section {
                h2 { "Sources" }
                ul {
                    @for work in cited {
                        @let [authors, title, rest] = work.parts();
                        li {
                            strong { (work.key) } ": " (authors) em { (title) } (rest)
                            @if let Some((doi, address)) = work.doi() { ". " a href=(address) { (doi) } }
                        }
                    }
                }
            }
        }
    }
}

fn notes(about: &About) -> Markup {
    html! {
        @if !about.notes.is_empty() {
            section {
                h2 { "Notes" }
                ul { @for note in about.notes { li { (note) } } }
            }
        }
    }
}

fn experiment(page: &Page) -> Markup {
    let experiment = page.fmu.entry.about.experiment;
    html! {
        @if !page.trajectory.signals.is_empty() {
            section {
                h2 { "Default experiment" }
                p {
                    (tables::number(experiment.stop)) " s in steps of " (tables::number(experiment.step)) " s"
                    @if experiment.stimuli.is_empty() { "; the inputs rest." }
                    @for (index, (name, stimulus)) in experiment.stimuli.iter().enumerate() {
                        @if index == 0 { "; " } @else { ", " }
                        code { (name) } " " (words(*stimulus, &unit(page.interface, name)))
                    }
                    @if !experiment.stimuli.is_empty() { "." }
                }
                (plot::svg(page.trajectory))
            }
        }
    }
}

/// The unit of a variable as one reads it; empty for settings.
pub fn unit(interface: &Interface, name: &str) -> String {
    match interface.variable(name).map(|variable| &variable.kind) {
        Some(VariableKind::Real { unit, .. }) => tables::printed(&unit.symbol),
        _ => String::new(),
    }
}

/// What an input does, as the rest of a sentence.
pub fn words(stimulus: Stimulus, unit: &str) -> String {
    let n = tables::number;
    match stimulus {
        Stimulus::Step { at, height } => format!("steps to {} {unit} at {} s", n(height), n(at)),
        Stimulus::Sine { amplitude, frequency } => {
            format!("is a sine of {} {unit} at {} Hz", n(amplitude), n(frequency))
        }
        Stimulus::Cosine { amplitude, frequency } => {
            format!("is a cosine of {} {unit} at {} Hz", n(amplitude), n(frequency))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    use crate::fmu::Set;

    /// Elements of HTML that have no end tag.
    fn closed(html: &str) -> String {
        let mut text = html.replace("<!DOCTYPE html>", "").replace("<br>", "<br/>");
        for void in ["<meta ", "<img "] {
            let parts: Vec<&str> = text.split(void).collect();
            let closed: Vec<String> = parts[1..].iter().map(|part| part.replacen('>', "/>", 1)).collect();
            text =
                parts[0].to_owned() + &closed.iter().map(|part| format!("{void}{part}")).collect::<String>();
        }
        text
    }

    fn page(fmu: &Fmu) -> String {
        let set = fmu.set.as_ref().map(|set| &set.parsed);
        let resources = fmu.set.as_ref().map(|set| set.folder.as_path());
        let interface = fmu.entry.interface(set, resources).unwrap();
        let trajectory = fmu.entry.demonstrate(set, resources).unwrap();
        let works = crate::literature::works(strut_physics::LITERATURE);
        html(&Page { fmu, interface: &interface, trajectory: &trajectory, works: &works })
    }

    #[test]
    fn every_page_is_well_formed_and_says_everything() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fmu-src/physics/parameters/resources");
        let plain = strut_physics::CATALOGUE.iter().map(|entry| Fmu {
            name: entry.about.name.into(),
            entry: *entry,
            set: None,
            related: None,
        });
        let published = strut_physics::PARAMETER_SETS.iter().map(|(_, text)| {
            let parsed = ParameterSet::parse(text).unwrap();
            let entry =
                *strut_physics::CATALOGUE.iter().find(|entry| entry.about.name == parsed.model).unwrap();
            Fmu {
                name: parsed.fmu.clone(),
                entry,
                set: Some(Set { parsed, text: (*text).into(), folder: folder.clone() }),
                related: None,
            }
        });
        for fmu in plain.chain(published) {
            let html = page(&fmu);
            let xml = closed(&html);
            let document =
                roxmltree::Document::parse(&xml).unwrap_or_else(|error| panic!("{}: {error}", fmu.name));
            assert!(!html.contains("NaN") && !html.contains(">inf"), "{}", fmu.name);
            let text: String = document.descendants().filter_map(|node| node.text()).collect();
            let plain = mathml::plain(&xml);
            for variable in fmu.interface().unwrap().variables {
                let name = variable.name.split('[').next().unwrap_or_default();
                assert!(rows::is_rate(&variable) || text.contains(name), "{}: {}", fmu.name, variable.name);
            }
            for equation in fmu.entry.about.equations {
                let source = equation.source.split(EFFECTS).last().unwrap_or_default();
                assert!(plain.contains(equation.text) && text.contains(source), "{}", fmu.name);
            }
            // A key that leads nowhere is no source.
            if let Some(set) = &fmu.set {
                assert!(html.contains(&format!("<strong>{}</strong>", set.parsed.source)), "{}", fmu.name);
            }
        }
    }
}
