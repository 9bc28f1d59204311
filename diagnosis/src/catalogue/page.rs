//! The catalogue as a page in Markdown.

use std::fmt::Write;

use build_fmu::literature::{Work, works};
use strut_model::Declaration;

use super::signals::{Among, DISTORTIONS};
use super::tables::{TABLES, Table, UNNAMED};
use super::{
    Bounds, Distortion, Effect, Element, ElementKind, Onset, Part, Prevalence, RESPONSE, Scale, Signal,
    TURNED, all, first_of, is_replaced, tables,
};
use crate::estimation::coordinates::POINTS;
use crate::plant::Plant;
use crate::rig::Rig;

const INTRODUCTION: &str = "\
# Effects

What the diagnosis looks for, effect by effect. `diagnose effects` prints this page from the catalogue. Do not edit it.

- **Number.** It is unique within a section. 39 and 42 are families: all curvatures, all distortions of a measured input.
- **Parameters.** The first one is the amount of the effect. At zero the effect is absent. The bounds limit the search, not the
  model. Most are multiples of the element's typical magnitudes.
- **Typical magnitudes.** Root mean squares of the element's force, deflection and velocity in the estimation records.
- **Special cases.** Effects that the law contains. They are preferred where they explain nearly as much.
- **Expected effect.** Every rig has it. It is not one of many that are tried: only the records speak for or against it.
- **Background effect.** Every rig has a little of it. It has to improve the fit by more than others before it is identified.
- **Acts.** Nothing is noted of an effect that acts at all times. Otherwise the improvement comes event by event.
- **Models.** Those that contain the law.
- **Experiment.** It separates the effect from those that it is most often confused with.
";

/// The whole page.
pub fn page() -> String {
    let models: Vec<Plant> = Rig::models().collect();
    let works = works(strut_physics::LITERATURE);
    let mut page = Page { text: String::new(), models: &models, works: &works, cited: Vec::new() };
    for element in Element::ALL {
        page.element(element);
    }
    for signal in Signal::ALL {
        page.signal(signal);
    }
    page.unnamed();
    page.literature();
    format!("{INTRODUCTION}\n{}\n{}", contents(&page.text), page.text)
}

/// Links to the sections, in one line.
fn contents(text: &str) -> String {
    let link = |title: &str| format!("[{title}](#{})", title.to_lowercase().replace(' ', "-"));
    text.lines().filter_map(|line| line.strip_prefix("## ")).map(link).collect::<Vec<_>>().join(" · ")
}

struct Page<'a> {
    text: String,
    models: &'a [Plant],
    works: &'a [Work],
    /// Keys of the works that entries refer to.
    cited: Vec<&'static str>,
}

impl Page<'_> {
    fn element(&mut self, element: Element) {
        let (title, text) = about(element);
        self.section(title, text);
        let mut effects: Vec<&'static Effect> = all().filter(|it| it.element == element).collect();
        effects.sort_by_key(|it| it.id);
        effects.into_iter().for_each(|effect| self.effect(effect));
    }

    fn effect(&mut self, effect: &'static Effect) {
        let models: Vec<&Plant> = self.models.iter().filter(|it| first_of(it, effect).is_in(it)).collect();
        self.head(effect.id, effect.name, effect.equation);
        for part in effect.parts {
            let declared = models
                .first()
                .and_then(|plant| plant.parameter(part.parameter).map(|index| &plant.parameters[index]));
            let line = parameter(part, effect.element, declared);
            let _ = writeln!(self.text, "- {line}");
        }
        if let Some(setting) = effect.setting {
            let _ = writeln!(self.text, "- Setting: `{setting}`");
        }
        let names: Vec<String> = effect.contains.iter().map(|id| numbered(effect.element, id)).collect();
        self.item("Special cases", &names.join(", "));
        self.when(effect.onset, effect.prevalence);
        let names: Vec<&str> = models.iter().map(|it| it.name.as_str()).collect();
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
            let unit = part.fault.unit("unit of the signal").replace(")2", ")²");
            let bounds = match part.bounds {
                Bounds::Between(low, high) => format!("{} to {}", plain(low), plain(high)),
                Bounds::OfLargest(low, high) => {
                    format!("{} to {} × the largest magnitude of the signal", plain(low), plain(high))
                }
                Bounds::QuarterOfPeriod(least) if signal == Signal::Output => format!("±{}", plain(least)),
                Bounds::QuarterOfPeriod(least) => {
                    format!("±{}, or a quarter of the signal's period where that is longer", plain(least))
                }
                Bounds::Free => "none".to_owned(),
            };
            let _ = writeln!(self.text, "- `<signal>.{}` [{unit}]. Bounds: {bounds}", part.fault.name());
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
        let models = self.models_with(own, signal);
        self.foot(law.experiment, &models, law.literature);
    }

    /// The models with a signal that a distortion is looked for in.
    fn models_with(&self, own: &Distortion, signal: Signal) -> String {
        let among = own.at(signal).among;
        let is_sought = |plant: &Plant| match signal {
            Signal::Output => plant.outputs.iter().any(|it| among.has(&it.name)),
            _ => plant.inputs.iter().any(|it| {
                let is_own = Signal::of_input(&it.name) == signal && among.has(&it.name);
                is_own && !is_replaced(plant, &it.name, own.fault)
            }),
        };
        self.models
            .iter()
            .filter(|plant| is_sought(plant))
            .map(|plant| plant.name.as_str())
            .collect::<Vec<_>>()
            .join(", ")
    }

    fn unnamed(&mut self) {
        let text = format!(
            "A table of {POINTS} points over a variable. It competes with the named effects and stands for what none of them \
             explains."
        );
        self.section("Curves without a name", &text);
        for law in UNNAMED {
            self.head(law.id, &format!("unnamed {}", law.quantity), "a table over the variable");
            for table in TABLES.iter().filter(|it| it.law.id == law.id) {
                let is_it = |it: &Table| {
                    (it.law.id, it.variable) == (table.law.id, table.variable)
                        && it.element.only() == table.element
                };
                let models = self.models.iter().filter(|plant| tables(plant).any(is_it));
                let names: Vec<&str> = models.map(|it| it.name.as_str()).collect();
                let bounds = scaled(law.bounds, law.point, table.element);
                let _ = writeln!(
                    self.text,
                    "- `{}` [{}]: over the {} of the {}. Bounds: {bounds}. Models: {}",
                    table.points,
                    law.unit,
                    table.variable,
                    about(table.element).0.to_lowercase(),
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
        let prevalence = match prevalence {
            Prevalence::Occasional => return,
            Prevalence::Expected => "Expected effect",
            Prevalence::Background => "Background effect",
        };
        let _ = writeln!(self.text, "- {prevalence}");
    }

    fn foot(&mut self, experiment: &str, models: &str, literature: &'static [&'static str]) {
        let _ = writeln!(self.text, "- Models: {models}");
        self.cite(experiment, literature);
    }

    fn cite(&mut self, experiment: &str, literature: &'static [&'static str]) {
        self.item("Experiment", experiment);
        let cited = literature.iter().filter_map(|key| self.works.iter().find(|work| work.key == *key));
        let cited: Vec<String> = cited.map(Work::cited).collect();
        self.item("Literature", &cited.join("; "));
        self.cited.extend(literature);
    }

    fn literature(&mut self) {
        self.section("Literature", "In the order of the alphabet.");
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
    match element.kind() {
        ElementKind::Strut => {
            ("Strut", "Between body and wheel. x is the deflection, positive in rebound, and v = x'.")
        }
        ElementKind::Guide => {
            ("Guide", "Between body and ground, or between a drive's carriage and its bed.")
        }
        ElementKind::WheelGuide => ("Wheel guide", "Between wheel and ground."),
        ElementKind::Tire => ("Tyre", "Between road and wheel. c = z_r - z_u is the compression."),
        ElementKind::Pivot => ("Pivot", "Between two arms. w is the angular velocity between them."),
        ElementKind::Actuator => ("Actuator", "From the command u to the force F."),
        ElementKind::Valve => {
            ("Valve", "Valve of a hydraulic or pneumatic actuator. x_v is the spool's position.")
        }
        ElementKind::Pump => ("Pump", "Pump of a hydraulic actuator, with its motor. w is the speed."),
        ElementKind::Frame => {
            ("Frame", "Carries the guides and swings with the body. a_s is the body's acceleration.")
        }
        ElementKind::ForceCell => {
            ("Force cell", "Measures the wheel's force. a_u is the wheel's acceleration.")
        }
    }
}

/// Number and name of an effect of an element.
fn numbered(element: Element, id: &str) -> String {
    let found = all().find(|it| it.element == element && it.id == id);
    found.map_or_else(|| id.to_owned(), |it| format!("{id} {}", it.name))
}

/// A parameter with unit, meaning and bounds; unit and meaning are the model's.
fn parameter(part: &Part, element: Element, declared: Option<&Declaration>) -> String {
    let (unit, doc) = declared.map_or(("", ""), |it| (it.unit.symbol, own_doc(it)));
    let bounds = scaled(part.bounds, part.scale, element);
    let within = part.within.map_or_else(String::new, |(scale, most)| {
        format!(", at most {}{}", plain(most), typical(scale, element))
    });
    format!("`{}` [{unit}]: {doc}. Bounds: {bounds}{within}", part.parameter)
}

/// What a declaration says of itself, without what its groups say.
fn own_doc(declared: &Declaration) -> &str {
    let groups = declared.name.matches('.').count();
    let own = declared.doc.splitn(groups + 1, ": ").last();
    own.unwrap_or_default().trim_end_matches('.')
}

/// Bounds in an element's typical magnitudes.
fn scaled((low, high): (f64, f64), scale: Scale, element: Element) -> String {
    format!("{} to {}{}", plain(low), plain(high), typical(scale, element))
}

/// What a number is multiplied by; nothing if it has a unit of its own.
fn typical(scale: Scale, element: Element) -> String {
    if scale == Scale::PITCH {
        return format!(" in m, {TURNED} times as much in rad");
    }
    match magnitude(scale, element) {
        [above, below] if above.is_empty() && below.is_empty() => String::new(),
        [above, below] if above.is_empty() => format!(", divided by the typical {below}"),
        [above, below] if below.is_empty() => format!(" × the typical {above}"),
        [above, below] => format!(" × the typical {above}/{below}"),
    }
}

/// A product of powers of an element's magnitudes: what is multiplied, and what it is divided by.
fn magnitude(scale: Scale, element: Element) -> [String; 2] {
    let words = match element {
        Element::PIVOT | Element::PUMP => ["torque", "angle", "angular velocity"],
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
    let below = factors(-1);
    let divisor = below.join("·");
    [factors(1).join("·"), if below.len() > 1 { format!("({divisor})") } else { divisor }]
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
        let of = |scale, element| scaled((-0.5, 10.0), scale, element);
        assert_eq!(of(Scale::ONE, Element::STRUT), "−0.5 to 10");
        assert_eq!(of(Scale::CUBIC, Element::STRUT), "−0.5 to 10 × the typical force/deflection³");
        assert_eq!(
            of(Scale::SLOWNESS, Element::ACTUATOR),
            "−0.5 to 10 × the typical deflection/(force·velocity)"
        );
        assert_eq!(
            of(Scale::PER_DEFLECTION, Element::STRUT),
            "−0.5 to 10, divided by the typical deflection"
        );
        assert_eq!(of(Scale::FORCE, Element::PIVOT), "−0.5 to 10 × the typical torque");
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
