//! A draft as the text of a rig file: what is uncertain stands in comments.

use strut_model::Declaration;
use textwrap::{Options, WordSplitter};
use unicode_width::UnicodeWidthStr;

use crate::plant::Role;
use crate::report::words::{columns, list, trimmed, unit};

use super::guess::{Declared, Force, Guess, Motion, Strut};
use super::names::Place;

/// Columns of a comment.
const WIDTH: usize = 110;

/// Digits of a value in a comment.
const DIGITS: usize = 6;

/// The text of a rig file that is being written.
#[derive(Default)]
pub struct Page(String);

impl Page {
    /// Lines of TOML.
    pub fn lines(&mut self, text: &str) {
        self.0 += text;
        self.0.push('\n');
    }

    /// An empty line.
    pub fn blank(&mut self) {
        self.0.push('\n');
    }

    /// A paragraph in a comment.
    pub fn comment(&mut self, text: &str) {
        // A name with a hyphen stays in one piece.
        let options = Options::new(WIDTH)
            .initial_indent("# ")
            .subsequent_indent("# ")
            .word_splitter(WordSplitter::NoHyphenation)
            .break_words(false);
        for line in textwrap::wrap(&plain(text), options) {
            self.lines(line.trim_end());
        }
    }

    /// Rows of three cells in comments, the first two in columns.
    pub fn rows(&mut self, rows: impl Iterator<Item = [String; 3]>) {
        self.0 += &columns("#   ", rows.map(|[name, middle, text]| [name, middle, plain(&text)]));
    }

    /// The whole text.
    pub fn text(self) -> String {
        self.0
    }
}

/// A name as TOML writes it.
pub fn quoted(name: &str) -> String {
    toml::Value::String(name.to_owned()).to_string()
}

/// A value with its unit and a description, as a comment tells it: `250 kg, sprung mass`.
pub fn quantity(value: f64, symbol: &str, doc: &str) -> String {
    let value = format!("{} {}", trimmed(value, DIGITS).replace('−', "-"), unit(symbol));
    [value.trim_end(), &plain(doc)].into_iter().filter(|it| !it.is_empty()).collect::<Vec<_>>().join(", ")
}

/// A description on one line: a comment has no control characters.
fn plain(text: &str) -> String {
    let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A rig file of a foreign model with a strut, or without one; `notes` say why less was written than was guessed.
pub fn text(
    model: &str,
    declared: &Declared,
    guess: &Guess,
    strut: Option<&Strut>,
    notes: &[String],
) -> String {
    let mut page = Page::default();
    page.comment(&format!(
        "Rig file of {model}, drafted by `diagnose new-rig` from the declarations of the FMU."
    ));
    page.comment("Entries marked GUESS follow from units and names: check each of them.");
    page.comment("Values are in base units of the SI. `diagnose check FILE` says what can be identified with this file.");
    page.blank();
    page.lines(&format!("model = {}", quoted(model)));
    page.blank();
    nominal(&mut page, declared, guess, strut);
    keys(&mut page, declared, guess);
    names(&mut page, declared);
    rates(&mut page, declared, guess);
    elements(&mut page, declared, guess, strut, notes);
    page.text()
}

fn nominal(page: &mut Page, declared: &Declared, guess: &Guess, strut: Option<&Strut>) {
    let replaced = strut.filter(|it| it.replaces).and_then(|it| match it.force {
        Force::Rates(spring, damper) => Some((spring, damper)),
        Force::Output(_) => None,
    });
    page.comment(
        "Parameters that are fitted. GUESS: all masses, moments of inertia, spring and damping rates, resistances, \
         inductances and motor constants. Remove those that are known exactly.",
    );
    let is_own = |index: &&usize| replaced.is_none_or(|(spring, damper)| ![spring, damper].contains(index));
    let mut rows: Vec<[String; 2]> = Vec::new();
    for index in guess.nominal.iter().filter(is_own) {
        let it = &declared.parameters[*index];
        rows.push([quoted(&it.name), quantity(it.start, it.unit.symbol, &it.doc)]);
    }
    for (name, of) in
        replaced.iter().flat_map(|(spring, damper)| [("strut.stiffness", spring), ("strut.damping", damper)])
    {
        let it = &declared.parameters[*of];
        let value = quantity(it.start, it.unit.symbol, "");
        rows.push([quoted(name), format!("{value}, in place of {}", it.name)]);
    }
    if rows.is_empty() {
        page.lines("nominal = []");
        page.comment("No parameter has such a unit. List the uncertain ones by their names.");
    } else {
        let width = rows.iter().map(|[name, _]| name.width()).max().unwrap_or(0);
        page.lines("nominal = [");
        for [name, about] in rows {
            page.lines(&format!("    {name},{} # {about}", " ".repeat(width - name.width())));
        }
        page.lines("]");
    }
    page.blank();
    let (reserved, others): (Vec<usize>, Vec<usize>) =
        guess.others.iter().partition(|it| Role::Strut.has(&declared.parameters[**it].name));
    let row = |index: &usize| {
        let it = &declared.parameters[*index];
        [
            quoted(&it.name),
            format!("{} {}", trimmed(it.start, DIGITS).replace('−', "-"), it.unit.symbol),
            it.doc.clone(),
        ]
    };
    if !others.is_empty() {
        page.comment("These parameters keep their values. List one in `nominal` to have it fitted.");
        page.rows(others.iter().map(row));
        page.blank();
    }
    if !reserved.is_empty() {
        page.comment(
            "These cannot be fitted: names that begin like this belong to the strut of the library.",
        );
        page.rows(reserved.iter().map(row));
        page.blank();
    }
}

/// Keys that stand before any table, and the table of values.
fn keys(page: &mut Page, declared: &Declared, guess: &Guess) {
    if !guess.at_once.is_empty() {
        page.comment(
            "By the FMU's own word, these outputs depend on inputs alone. List here those that only repeat an input: \
             they show nothing of the model.",
        );
        let names: Vec<String> = guess.at_once.iter().map(|it| quoted(&declared.outputs[*it].name)).collect();
        page.comment(&format!("follows_inputs = [{}]", names.join(", ")));
        page.blank();
    }
    page.comment(
        "Longest segment that is simulated in one go, in s. A model that drifts needs a shorter one.",
    );
    page.comment("segment = 60.0");
    page.blank();
    page.comment(
        "Values that differ from the FMU's own, and measured parameters with their standard deviation.",
    );
    page.comment("[values]");
    if let Some(it) = guess.nominal.first().map(|it| &declared.parameters[*it]) {
        let value = toml::Value::Float(it.start);
        let deviation = toml::Value::Float(0.01 * it.start.abs());
        page.comment(&format!("{} = {{ value = {value}, deviation = {deviation} }}", quoted(&it.name)));
    }
    page.blank();
}

fn names(page: &mut Page, declared: &Declared) {
    page.comment(
        "A column of a record is a signal if it has the signal's name. List its other names here; `-name` is the negative.",
    );
    page.lines("[names]");
    for (title, all) in
        [("Inputs: a record needs one", &declared.inputs), ("Outputs: a record needs one", &declared.outputs)]
    {
        page.comment(&format!("{title}."));
        let line = |it: &Declaration| {
            [format!("{} = []", quoted(&it.name)), format!("[{}]", it.unit.symbol), it.doc.clone()]
        };
        page.rows(all.iter().map(line));
    }
    page.blank();
}

fn rates(page: &mut Page, declared: &Declared, guess: &Guess) {
    if guess.input_rates.is_empty() {
        return;
    }
    page.comment(
        "Inputs that are the rate of change of another one. They follow from it where no column has them.",
    );
    page.lines("[rates]");
    for (rate, motion) in &guess.input_rates {
        let name = |input: &usize| quoted(&declared.inputs[*input].name);
        page.lines(&format!("{} = {} # GUESS", name(rate), name(motion)));
    }
    page.blank();
}

fn elements(page: &mut Page, declared: &Declared, guess: &Guess, strut: Option<&Strut>, notes: &[String]) {
    page.comment(
        "The element whose effects are looked for. Its deflection is positive in rebound, where its ends move apart. \
         `acts_on` lists the inputs that take the force of such an element of the library: strut, guide, wheel_guide, tire. \
         That force is positive where it pulls the ends together; `-name` takes the negative. `replaces` names the spring \
         and the damper that the strut stands for. Without `acts_on`, only sensors and parameters can be wrong.",
    );
    for note in notes {
        page.comment(note);
    }
    match strut {
        Some(strut) => element(page, declared, guess, strut),
        None => {
            page.comment("No element is certain. Complete the lines and remove their marks:");
            for line in [
                "[[elements]]",
                "element = \"strut\"",
                "deflection = \"…\"",
                "velocity = \"…\"",
                "force = { stiffness = \"…\", damping = \"…\" } # or { output = \"…\" }",
                "acts_on = [\"…\"]",
                "replaces = { stiffness = \"…\", damping = \"…\" } # force: \"strut.stiffness\" and \"strut.damping\" then",
            ] {
                page.comment(line);
            }
        }
    }
    candidates(page, declared, guess, strut);
}

fn element(page: &mut Page, declared: &Declared, guess: &Guess, strut: &Strut) {
    let output = |index: usize| &declared.outputs[index];
    let about = |it: &Declaration| {
        let unit = format!("[{}]", it.unit.symbol);
        format!("{unit} {}", plain(&it.doc)).trim_end().to_owned()
    };
    let (deflection, velocity) = (output(strut.motion.deflection), output(strut.motion.velocity));
    page.lines("[[elements]]");
    page.lines("element = \"strut\"");
    page.lines(&format!(
        "deflection = {} # GUESS: {}; check that rebound is positive",
        quoted(&deflection.name),
        about(deflection)
    ));
    page.lines(&format!("velocity = {} # GUESS: {}", quoted(&velocity.name), about(velocity)));
    let parameter = |index: usize| quoted(&declared.parameters[index].name);
    let rates = |spring: &str, damper: &str| format!("{{ stiffness = {spring}, damping = {damper} }}");
    match strut.force {
        Force::Rates(..) if strut.replaces => {
            page.lines(&format!("force = {}", rates("\"strut.stiffness\"", "\"strut.damping\"")));
        }
        Force::Rates(spring, damper) => {
            page.lines(&format!("force = {} # GUESS", rates(&parameter(spring), &parameter(damper))));
        }
        Force::Output(index) => {
            page.lines(&format!(
                "force = {{ output = {} }} # GUESS: {}",
                quoted(&output(index).name),
                about(output(index))
            ));
        }
    }
    match strut.acts_on {
        Some((input, sign)) => {
            let name = &declared.inputs[input].name;
            let minus = if sign < 0.0 { "-" } else { "" };
            let way = if sign < 0.0 { "raises" } else { "lowers" };
            page.lines(&format!(
                "acts_on = [{}] # GUESS: a step of {name} {way} the deflection",
                quoted(&format!("{minus}{name}"))
            ));
        }
        None if guess.forces.is_empty() => {
            page.comment("acts_on: no input in N moves this deflection other than at once.");
        }
        None => page.comment("acts_on = [\"…\"], see below"),
    }
    if let (true, Force::Rates(spring, damper)) = (strut.replaces, strut.force) {
        page.lines(&format!("replaces = {} # GUESS", rates(&parameter(spring), &parameter(damper))));
    }
}

/// What else could be meant.
fn candidates(page: &mut Page, declared: &Declared, guess: &Guess, strut: Option<&Strut>) {
    let output = |index: usize| quoted(&declared.outputs[index].name);
    page.blank();
    let others: Vec<&Motion> =
        guess.motions.iter().filter(|it| strut.is_none_or(|strut| strut.motion != **it)).collect();
    if !others.is_empty() {
        page.comment("Other deflections with a velocity:");
        page.rows(others.iter().map(|it| {
            let place = it.place.map_or(String::new(), |place| format!("perhaps {}", part(place)));
            [output(it.deflection), output(it.velocity), place]
        }));
    }
    if strut.is_none_or(|it| it.acts_on.is_none()) && !guess.forces.is_empty() {
        let signed = |(input, sign): &(usize, Option<f64>)| {
            let name = &declared.inputs[*input].name;
            match sign {
                Some(sign) => quoted(&format!("{}{name}", if *sign < 0.0 { "-" } else { "" })),
                None => format!("{} (sign unknown)", quoted(name)),
            }
        };
        let inputs: Vec<String> = guess.forces.iter().map(signed).collect();
        page.comment(&format!("Candidates for acts_on: {}.", list(&inputs, "and")));
    }
    if strut.is_none_or(|it| !it.replaces) {
        let named = |all: &[usize]| {
            let names: Vec<String> = all.iter().map(|it| quoted(&declared.parameters[*it].name)).collect();
            if names.is_empty() { "none".to_owned() } else { list(&names, "and") }
        };
        let [springs, dampers] = &guess.rates;
        page.comment(&format!(
            "Candidates for replaces: stiffness {}; damping {}.",
            named(springs),
            named(dampers)
        ));
    }
}

/// What a part is called.
fn part(place: Place) -> &'static str {
    match place {
        Place::Tire => "the tyre",
        Place::Strut => "the strut",
        Place::Body => "the body",
        Place::Wheel => "the wheel",
        Place::Road => "the road",
    }
}
