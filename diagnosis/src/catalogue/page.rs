//! The catalogue as a page in Markdown.

use std::fmt::Write;

use strut_model::Declaration;

use super::literature::Work;
use super::signals::{Among, DISTORTIONS};
use super::tables::{TABLES, UNNAMED};
use super::{Bounds, Cause, Distortion, Element, Onset, Part, Prevalence, RESPONSE, Scale, Signal, all};
use crate::plant::Plant;
use crate::rig::Rig;

const INTRODUCTION: &str = "\
# Effects

What the diagnosis looks for, effect by effect: law, parameters, special cases, literature, and the experiment that separates the
effect from others. `diagnose effects` prints this page from the catalogue. Do not edit it.

- **Number.** It is unique within a section, but for 39 and 42: each stands for all curvatures, or all distortions, of a signal.
- **Parameters.** The first parameter is the amount of the effect. At zero the effect is absent. Bounds limit the search, not the
  model. Most bounds are multiples of the element's typical magnitudes, so that they fit a toy and a truck.
- **Typical magnitudes.** They are root mean squares of the element's force, deflection and velocity in the estimation records.
- **Background effect.** Every rig has a little of it. It needs stronger evidence before it is identified.
- **Acts.** An effect that acts beyond a threshold, or near standstill only, improves a fit unevenly. The improvement is judged event
  by event.
";

/// The whole page.
pub fn page() -> String {
    let models: Vec<(&str, Plant)> = Rig::models().collect();
    let works = Work::all();
    let mut page = Page { text: INTRODUCTION.into(), models: &models, works: &works, cited: Vec::new() };
    for element in Element::ALL {
        page.element(element);
    }
    for signal in Signal::ALL {
        page.signal(signal);
    }
    page.unnamed();
    page.literature();
    page.text
}

struct Page<'a> {
    text: String,
    models: &'a [(&'static str, Plant)],
    works: &'a [Work],
    /// Keys of the works that entries refer to.
    cited: Vec<&'static str>,
}

impl Page<'_> {
    fn element(&mut self, element: Element) {
        let (title, text) = about(element);
        self.section(title, text);
        for effect in all().filter(|it| it.element == element) {
            self.effect(effect);
        }
    }

    fn effect(&mut self, effect: &Cause) {
        let models: Vec<&(&str, Plant)> = self.models.iter().filter(|(_, it)| effect.is_in(it)).collect();
        self.head(effect.id, effect.name, effect.equation);
        for part in effect.parts {
            let declared = models
                .first()
                .and_then(|(_, plant)| plant.parameter(part.parameter).map(|index| &plant.parameters[index]));
            let line = parameter(part, effect.element, declared);
            let _ = writeln!(self.text, "- {line}");
        }
        if let Some(setting) = effect.setting {
            let _ = writeln!(self.text, "- Setting: `{setting}`");
        }
        let names: Vec<String> = effect.contains.iter().map(|id| numbered(effect.element, id)).collect();
        self.item("Special cases", &names.join(", "));
        self.when(effect.onset, effect.prevalence);
        let names: Vec<&str> = models.iter().map(|(name, _)| *name).collect();
        self.foot(effect.experiment, &names.join(", "), effect.literature);
    }

    fn signal(&mut self, signal: Signal) {
        let (title, text) = match signal {
            Signal::Command => ("Commands", "An input that an actuator follows. y is the command."),
            Signal::Input => {
                ("Measured inputs", "Another input, as its sensor shows it. y is the true signal.")
            }
            Signal::Output => {
                ("Measured outputs", "An output, as its sensor shows it. y is the true signal.")
            }
        };
        self.section(title, text);
        for own in DISTORTIONS.into_iter().filter(|it| it.at(signal).among != Among::None) {
            self.distortion(own, signal);
        }
        if RESPONSE.at(signal).among != Among::None {
            self.distortion(&RESPONSE, signal);
        }
    }

    fn distortion(&mut self, own: &Distortion, signal: Signal) {
        let at = own.at(signal);
        let with = at.with.map(super::distortion);
        let law = with.unwrap_or(own);
        self.head(at.id, &law.called(signal), law.equation);
        for part in [Some(own), with].into_iter().flatten() {
            let unit = match part.fault.unit("*").as_str() {
                "1" => "1".to_owned(),
                "*" => "unit of the signal".to_owned(),
                other => other.replace("(*)", "unit of the signal").replace('*', "unit of the signal "),
            };
            let bounds = match part.bounds {
                Bounds::Between(low, high) => format!("{} to {}", plain(low), plain(high)),
                Bounds::OfLargest(low, high) => {
                    format!("{} to {} × the largest magnitude of the signal", plain(low), plain(high))
                }
                Bounds::Free => "without bounds".to_owned(),
            };
            let _ = writeln!(self.text, "- `<signal>.{}` [{unit}], {bounds}", part.fault.name());
        }
        let contains: Vec<String> =
            own.contains.iter().map(|it| super::distortion(*it).called(signal)).collect();
        self.item("Special cases", &contains.join(", "));
        self.when(law.onset, at.prevalence);
        let among = match at.among {
            Among::Ending(end) => format!("signals whose name ends in `{end}`"),
            Among::NotEnding(end) => format!("signals whose name does not end in `{end}`"),
            Among::All | Among::None => String::new(),
        };
        self.item("Looked for in", &among);
        let replaced = all().filter_map(|effect| {
            let replaced = effect.replaces.filter(|it| it.distortion == own.fault)?;
            let is_own = signal != Signal::Output && Signal::of_input(replaced.inputs) == signal;
            is_own.then(|| format!("`{}*` in a model with {} {}", replaced.inputs, effect.id, effect.name))
        });
        let replaced: Vec<String> = replaced.collect();
        self.item("Not looked for in", &replaced.join(", "));
        self.foot(law.experiment, "all", law.literature);
    }

    fn unnamed(&mut self) {
        self.section(
            "Curves without a name",
            "A table of eleven points. It competes with the named effects and stands for what none of them explains.",
        );
        for law in UNNAMED {
            self.head(law.id, &format!("unnamed {}", law.quantity), "a table over the variable");
            for table in TABLES.iter().filter(|it| it.law.id == law.id) {
                let models = self.models.iter().filter(|(_, plant)| table.is_in(plant));
                let names: Vec<&str> = models.map(|(name, _)| *name).collect();
                let _ = writeln!(
                    self.text,
                    "- `{}` [{}] over the {} of the {}, −10 to 10 × the typical {}. Models: {}",
                    table.points,
                    law.unit,
                    table.variable,
                    about(table.element).0.to_lowercase(),
                    magnitude(law.point, table.element),
                    names.join(", ")
                );
            }
            self.when(Onset::Always, law.prevalence);
            self.cite(law.experiment, law.literature);
        }
    }

    fn section(&mut self, title: &str, text: &str) {
        let _ = write!(self.text, "\n## {title}\n\n{text}\n");
    }

    fn head(&mut self, id: &str, name: &str, equation: &str) {
        let _ = write!(self.text, "\n### {id} {name}\n\n`{equation}`\n\n");
    }

    /// A line of the list, unless there is nothing to say.
    fn item(&mut self, title: &str, text: &str) {
        if !text.is_empty() {
            let _ = writeln!(self.text, "- {title}: {text}");
        }
    }

    fn when(&mut self, onset: Onset, prevalence: Prevalence) {
        let onset = match onset {
            Onset::Always => "",
            Onset::Threshold => "beyond a threshold only",
            Onset::Standstill => "near standstill only",
        };
        self.item("Acts", onset);
        if prevalence == Prevalence::Background {
            let _ = writeln!(self.text, "- Background effect");
        }
    }

    fn foot(&mut self, experiment: &str, models: &str, literature: &'static [&'static str]) {
        let _ = writeln!(self.text, "- Models: {models}");
        self.cite(experiment, literature);
    }

    fn cite(&mut self, experiment: &str, literature: &'static [&'static str]) {
        self.item("Separate it", experiment);
        let cited = literature.iter().filter_map(|key| self.works.iter().find(|work| work.key == *key));
        let cited: Vec<String> = cited.map(Work::cited).collect();
        self.item("Literature", &cited.join("; "));
        self.cited.extend(literature);
    }

    fn literature(&mut self) {
        self.section("Literature", "TUM, Konieczny and others are the sources of the rigs' models.");
        self.text.push('\n');
        let mut lines: Vec<String> = self
            .works
            .iter()
            .filter(|work| self.cited.contains(&work.key.as_str()))
            .map(|work| format!("- {}: {}\n", work.cited(), work.listed()))
            .collect();
        lines.sort();
        self.text.extend(lines);
    }
}

/// Title and explanation of an element's section.
fn about(element: Element) -> (&'static str, &'static str) {
    match element {
        Element::Strut => {
            ("Strut", "Between body and wheel. x is the deflection, positive in rebound, and v = x'.")
        }
        Element::Guide => ("Guide", "Between body and ground, or between a drive's carriage and its bed."),
        Element::WheelGuide => ("Wheel guide", "Between wheel and ground."),
        Element::Tire => ("Tyre", "Between road and wheel. c = z_r - z_u is the compression."),
        Element::Pivot => ("Pivot", "Between two arms. w is the angular velocity between them."),
        Element::Actuator => ("Actuator", "From the command u to the force F."),
        Element::Valve => ("Valve", "Valve of a hydraulic actuator. x_v is the spool's position."),
        Element::Pump => ("Pump", "Pump of a hydraulic actuator, with its motor. w is the speed."),
        Element::Frame => {
            ("Frame", "Carries the guides and swings with the body. a_s is the body's acceleration.")
        }
        Element::ForceCell => ("Force cell", "Measures the wheel's force. a_u is the wheel's acceleration."),
    }
}

/// Number and name of an effect of an element.
fn numbered(element: Element, id: &str) -> String {
    let found = all().find(|it| it.element == element && it.id == id);
    found.map_or_else(|| id.to_owned(), |it| format!("{id} {}", it.name))
}

/// A parameter with unit, bounds and meaning; the unit and the meaning are the model's.
fn parameter(part: &Part, element: Element, declared: Option<&Declaration>) -> String {
    let unit = declared.map_or("", |it| it.unit.symbol);
    let (low, high) = (plain(part.bounds.0), plain(part.bounds.1));
    let scale = if part.scale == Scale::ONE {
        String::new()
    } else {
        format!(" × the typical {}", magnitude(part.scale, element))
    };
    let within = part.within.map_or_else(String::new, |(scale, most)| {
        format!(", at most {} × the typical {}", plain(most), magnitude(scale, element))
    });
    let doc = declared.map_or("", |it| it.doc.trim_end_matches('.'));
    format!("`{}` [{unit}], {low} to {high}{scale}{within}. {doc}", part.parameter)
}

/// A product of powers of the element's magnitudes: `force/deflection²`.
fn magnitude(scale: Scale, element: Element) -> String {
    let words = match element {
        Element::Pivot | Element::Pump => ["torque", "angle", "angular velocity"],
        _ => ["force", "deflection", "velocity"],
    };
    let powers = [scale.force, scale.deflection, scale.velocity];
    let factors = |sign: i32| -> Vec<String> {
        let of = |(word, power): (&str, i32)| match sign * power {
            1 => Some(word.to_owned()),
            2 => Some(format!("{word}²")),
            3 => Some(format!("{word}³")),
            _ => None,
        };
        words.into_iter().zip(powers).filter_map(of).collect()
    };
    let (above, below) = (factors(1).join("·"), factors(-1));
    let above = if above.is_empty() { "1".to_owned() } else { above };
    match below.as_slice() {
        [] => above,
        [one] => format!("{above}/{one}"),
        more => format!("{above}/({})", more.join("·")),
    }
}

/// A number as people write it.
fn plain(number: f64) -> String {
    if number != 0.0 && number.abs() < 1e-3 { format!("{number:e}") } else { number.to_string() }
        .replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_is_in_the_element_s_magnitudes() {
        assert_eq!(magnitude(Scale::CUBIC, Element::Strut), "force/deflection³");
        assert_eq!(magnitude(Scale::SLOWNESS, Element::Actuator), "deflection/(force·velocity)");
        assert_eq!(magnitude(Scale::PER_DEFLECTION, Element::Strut), "1/deflection");
        assert_eq!(magnitude(Scale::FORCE, Element::Pivot), "torque");
        assert_eq!([0.0, 2e-3, 1e-4, -0.5, 1000.0].map(plain), ["0", "0.002", "1e−4", "−0.5", "1000"]);
    }

    #[test]
    fn the_page_in_docs_is_that_of_the_catalogue() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/effects.md");
        let stored = std::fs::read_to_string(file).unwrap_or_default();
        assert!(
            stored == page(),
            "docs/effects.md is not what the catalogue says; run \
             `cargo run --package strut-diagnosis -- effects > docs/effects.md`"
        );
    }
}
