//! What can be found with a rig file, and from which columns, before there is a record.

mod effects;

use std::collections::BTreeMap;
use std::path::Path;

use strut_model::Declaration;
use textwrap::{Options, WordSplitter};

use super::words::{columns, digits, list, number, percent, unit};
use crate::catalogue::{self, Effect};
use crate::missing::ports::{Entry, Port};
use crate::rig::{Rig, SAME, UNSEEN, Undriven, is_manifest, kebab};

use effects::{impossible, in_elements, in_signals};

/// Width of the text in columns.
const WIDTH: usize = 100;

/// Digits of a parameter's value.
const DIGITS: usize = 4;

/// Difference of outputs beyond which its size says nothing more.
const MANY: f64 = 10.0;

/// What only the model of another maker can tell.
#[derive(Clone, Debug, Default)]
pub struct Foreign {
    /// Its parameters that the rig file does not name.
    pub unnamed: Vec<String>,
    /// The difference of its outputs with a strut of the library in place of its own, relative to how far they move; none
    /// if no strut replaces anything, not a number if it cannot be run.
    pub difference: Option<f64>,
    /// What an `augmented.ssp` would not show, or why there can be none.
    pub augmented: Option<Result<Vec<String>, String>>,
}

/// What can be found with a rig, as text: columns, places, effects, parameters.
///
/// # Errors
/// If no record can be compared with the model: what it lacks.
pub fn capability(rig: &Rig, foreign: &Foreign) -> Result<String, String> {
    let plant = &rig.plant;
    if plant.inputs.is_empty() {
        return Err(format!(
            "{} has no real input that could drive it: no record can be compared with it",
            plant.name
        ));
    }
    if plant.outputs.iter().all(|it| rig.is_trivial(&it.name)) {
        return Err(format!(
            "{} has no output that shows something of it: no record can be compared with it",
            plant.name
        ));
    }
    let mut text = Text::default();
    text.paragraph("", &headline(rig));
    signals(&mut text, rig);
    places(&mut text, rig);
    effects_of(&mut text, rig);
    parameters(&mut text, rig, foreign);
    notes(&mut text, rig, foreign);
    Ok(text.0)
}

/// The first line of what is said of a rig.
pub fn headline(rig: &Rig) -> String {
    if rig.kind.is_foreign() {
        let model = Path::new(&rig.kind.model);
        let file = model.file_name().unwrap_or_default().to_string_lossy();
        match model.parent().filter(|_| is_manifest(model)) {
            Some(folder) => {
                format!("{}: the model {} of the crate in {}", rig.name, rig.fmu, folder.display())
            }
            None => format!("{}: the FMU {file}, of another maker", rig.name),
        }
    } else {
        format!("{}: a {}, in the FMU {}", rig.name, rig.plant.name, rig.fmu)
    }
}

fn signals(text: &mut Text, rig: &Rig) {
    let plant = &rig.plant;
    text.title("Columns that drive the model (a record needs at least one)");
    text.rows(plant.inputs.iter().map(|it| signal(rig, it)));
    for by in &rig.kind.drives {
        let others =
            if by.columns.is_empty() { String::new() } else { format!(", or a column {}", or(&by.columns)) };
        let way = if by.inverse.is_some() { ", with the force compared" } else { "" };
        text.paragraph(
            "  ",
            &format!("One way is `{} = {}`{way}: by `{}`{others}.", by.setting, by.item, by.input),
        );
    }
    if let Some(Undriven { input, model }) = &rig.kind.undriven {
        text.paragraph(
            "  ",
            &format!(
                "Where no column has `{input}`, a {model} stands for it, driven by what was measured above it: `diagnose rigs \
                 {}` says what can be found then. A column of zeros says that it was at rest.",
                kebab(model)
            ),
        );
    }
    let rates = plant.inputs.iter().filter_map(|it| Some((it, rig.rate_of(&it.name)?)));
    for (rate, motion) in rates {
        let motion = &plant.inputs[motion].name;
        text.paragraph("  ", &format!("`{}` follows from `{motion}` where no column has it.", rate.name));
    }
    text.title("Columns that are compared (a record needs at least one)");
    text.rows(plant.outputs.iter().filter(|it| !rig.is_trivial(&it.name)).map(|it| signal(rig, it)));
    let trivial: Vec<String> =
        plant.outputs.iter().filter(|it| rig.is_trivial(&it.name)).map(|it| it.name.clone()).collect();
    if !trivial.is_empty() {
        text.paragraph(
            "  ",
            &format!("Not compared, since they follow from the inputs alone: {}.", list(&trivial, "and")),
        );
    }
    if let Some(opposed) = &rig.kind.opposed {
        let sentence = format!(
            "Beside a column `{}`, `{}` is expected with the opposite sign.",
            opposed.column, opposed.signal
        );
        text.paragraph("  ", &sentence);
    }
    text.paragraph(
        "  ",
        "The unit in a column's header may differ. A map (--map) gives columns of other names.",
    );
}

/// Name, unit, and the description with other names.
fn signal(rig: &Rig, it: &Declaration) -> [String; 3] {
    let others: Vec<String> =
        rig.kind.aliases(&it.name).filter(|name| *name != it.name).map(str::to_owned).collect();
    let also = if others.is_empty() { String::new() } else { format!("also {}", or(&others)) };
    let about: Vec<&str> = [it.doc.as_str(), also.as_str()].into_iter().filter(|it| !it.is_empty()).collect();
    [it.name.clone(), format!("[{}]", it.unit.symbol), about.join("; ")]
}

/// Names as they are written in a record.
fn or(names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().map(|it| format!("`{it}`")).collect();
    list(&quoted, "or")
}

fn places(text: &mut Text, rig: &Rig) {
    let plant = &rig.plant;
    text.title("Places where a missing signal can be located, if their columns are recorded");
    let of_model = Port::of_model(rig, |_| true);
    let what = |port: &Port| match port.entry {
        Entry::Constant(index) => format!("in the model, by `{}`", plant.parameters[index].name),
        Entry::Input(_) => "a command".to_owned(),
        Entry::Sensor(_) => "a sensor".to_owned(),
    };
    let of_model = of_model.iter().map(|it| [it.place.clone(), format!("[{}]", it.unit), what(it)]);
    let outputs = plant.outputs.iter().filter(|it| !rig.is_trivial(&it.name));
    let sensors = outputs.map(|it| [it.name.clone(), format!("[{}]", it.unit.symbol), "a sensor".to_owned()]);
    text.rows(of_model.chain(sensors));
    let no_constant = Port::of_model(rig, |_| false).is_empty();
    if no_constant {
        text.paragraph("  ", "No place is in the model itself: a missing force is seen in the sensors only.");
    }
    let no_command = plant.inputs.iter().all(|it| !catalogue::naming::is_command(&it.name));
    if no_command {
        text.paragraph(
            "  ",
            &format!(
                "No input counts as a command: those have names that begin with {}.",
                list(&catalogue::naming::ACTUATORS.map(str::to_owned), "or")
            ),
        );
    }
}

fn effects_of(text: &mut Text, rig: &Rig) {
    text.title("Effects that can be identified");
    let elements = in_elements(rig);
    if elements.is_empty() {
        text.paragraph("  ", "In the model: none.");
    }
    for possible in elements.iter().chain(&in_signals(rig)) {
        text.paragraph("  ", &format!("{}: {}.", possible.place, possible.effects.join(", ")));
    }
    let impossible = impossible(rig);
    if !impossible.is_empty() {
        text.title("Effects that cannot be identified");
    }
    let model =
        if rig.kind.is_foreign() { format!("The FMU {}", rig.fmu) } else { format!("A {}", rig.plant.name) };
    for (obstacle, effects) in impossible {
        text.paragraph("  ", &format!("{}: {}", named(&effects), obstacle.sentence(&model)));
    }
}

/// Effects by their elements: `guide 15, 16; tire 19`.
fn named(effects: &[&Effect]) -> String {
    let mut elements: BTreeMap<_, Vec<String>> = BTreeMap::new();
    for effect in effects {
        elements.entry(effect.element).or_default().push(format!("{} {}", effect.id, effect.name));
    }
    let parts =
        elements.iter().map(|(element, effects)| format!("{} {}", element.name(), effects.join(", ")));
    parts.collect::<Vec<_>>().join("; ")
}

fn parameters(text: &mut Text, rig: &Rig, foreign: &Foreign) {
    let plant = &rig.plant;
    let base = rig.base();
    let row = |index: usize| {
        let declared = &plant.parameters[index];
        let value = format!("{} {}", digits(rig.parameters[index], DIGITS), unit(declared.unit.symbol));
        let known = rig.known.iter().find(|(of, _, _)| *of == index);
        let known =
            known.map_or(String::new(), |(_, _, deviation)| format!("measured, ± {}", number(*deviation)));
        let about = [known.as_str(), declared.doc.as_str()].into_iter().filter(|it| !it.is_empty());
        [declared.name.clone(), value.trim_end().to_owned(), about.collect::<Vec<_>>().join("; ")]
    };
    text.title("Parameters that are fitted");
    if base.is_empty() {
        text.paragraph("  ", "None: list those that are uncertain in `nominal`.");
    }
    text.rows(base.iter().map(|it| row(*it)));
    let of_effects = |name: &str| {
        let tables = || catalogue::tables(plant);
        catalogue::effects(plant).any(|it| it.parts.iter().any(|part| part.parameter == name))
            || tables().any(|it| it.switch == name || it.range == name)
            || tables().any(|it| name.strip_prefix(it.points).is_some_and(|rest| rest.starts_with('[')))
    };
    let given: Vec<usize> = (0..plant.parameters.len())
        .filter(|it| {
            !base.contains(it)
                && !plant.parameters[*it].port
                && !plant.is_joint(*it)
                && !of_effects(&plant.parameters[*it].name)
        })
        .collect();
    if given.is_empty() && foreign.unnamed.is_empty() {
        return;
    }
    text.title("Parameters that are taken as given");
    text.rows(given.into_iter().map(row));
    if !foreign.unnamed.is_empty() {
        let names = foreign.unnamed.join(", ");
        text.paragraph(
            "  ",
            &format!("With the FMU's own values, since the file does not name them: {names}."),
        );
    }
}

fn notes(text: &mut Text, rig: &Rig, foreign: &Foreign) {
    let notes = said(rig, foreign);
    if !notes.is_empty() {
        text.title("Notes");
    }
    for note in notes {
        text.paragraph("  ", &note);
    }
}

/// What is to be known of how the file describes the model.
fn said(rig: &Rig, foreign: &Foreign) -> Vec<String> {
    let mut notes = Vec::new();
    for it in &rig.kind.elements {
        let name = it.element.name();
        if it.velocity.is_none() {
            notes.push(format!(
                "{name}: no output is its velocity; the derivative of `{}` stands for it.",
                it.deflection
            ));
        }
        if let Some(replaced) = &it.replaces {
            let (stiffness, damping) = (&replaced.stiffness, &replaced.damping);
            let strut = format!("{name}: a strut of the library in place of {stiffness} and {damping}");
            let check = format!(
                "Check the signs in acts_on and of {}, and that the two are this element's spring and damper and act \
                 linearly.",
                it.deflection
            );
            notes.push(match foreign.difference {
                Some(difference) if difference < UNSEEN => format!("{strut} does not change the outputs."),
                Some(difference) if difference <= SAME => {
                    format!("{strut} changes the outputs by {} at most.", percent(difference))
                }
                Some(difference) if difference <= MANY => {
                    format!("{strut} changes the outputs by {}. {check}", percent(difference))
                }
                Some(difference) if difference.is_finite() => {
                    format!("{strut} changes the outputs by more than {MANY} times their size. {check}")
                }
                _ => format!("{strut} makes a model that cannot be run. {check}"),
            });
        } else if !it.acts_on.is_empty() {
            notes.push(format!("{name}: the library's element comes on top of the FMU's own."));
        }
    }
    match &foreign.augmented {
        None => {}
        Some(Err(reason)) => notes.push(format!("A diagnosis writes no augmented.ssp: {reason}.")),
        Some(Ok(untold)) => {
            let untold: Vec<String> = untold.iter().map(|it| format!(" {it}.")).collect();
            notes.push(format!(
                "A diagnosis writes augmented.ssp, the FMU with what was found beside it.{}",
                untold.concat()
            ));
        }
    }
    let sized =
        |effect: &&Effect| rig.kind.elements.iter().all(|it| it.element.kind() != effect.element.kind());
    let mut unsized_: Vec<&str> =
        catalogue::effects(&rig.plant).filter(sized).map(|it| it.element.name()).collect();
    unsized_.dedup();
    unsized_.sort_unstable();
    unsized_.dedup();
    for name in unsized_ {
        notes.push(format!(
            "{name}: the file has no such element. Bounds of its effects hold for a force of 1 N, a deflection of 1 m and a \
             velocity of 1 m/s."
        ));
    }
    notes
}

/// A text of titles, rows and paragraphs.
#[derive(Default)]
struct Text(String);

impl Text {
    fn title(&mut self, title: &str) {
        self.0 += &format!("\n{title}:\n");
    }

    /// A paragraph; lines after its first stand two columns further right.
    fn paragraph(&mut self, indent: &str, text: &str) {
        let next = format!("{indent}  ");
        let options = Options::new(WIDTH)
            .initial_indent(indent)
            .subsequent_indent(&next)
            .word_splitter(WordSplitter::NoHyphenation)
            .break_words(false);
        for line in textwrap::wrap(&visible(text), options) {
            self.0 += line.trim_end();
            self.0.push('\n');
        }
    }

    /// Rows of three cells, the first two in columns.
    fn rows(&mut self, rows: impl Iterator<Item = [String; 3]>) {
        self.0 += &columns("  ", rows.map(|row| row.map(|cell| visible(&cell))));
    }
}

/// Names come from files; control characters must not reach the terminal.
fn visible(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

#[cfg(test)]
mod tests;
