//! The summary for the terminal.

use textwrap::Options;
use unicode_width::UnicodeWidthStr;

use super::words::{
    badge, capitalised, cause, count, digits, fit, headline, interval, located, number, percent, unit,
};
use crate::report::findings::{Effect, Findings};

/// Columns that a line has at most.
const WIDTH: usize = 100;

/// Items of a list that are shown; the others are in the page.
const SHOWN: usize = 6;

/// A summary of at most a hundred columns.
pub fn terminal(findings: &Findings) -> String {
    let mut lines = Lines(Vec::new());
    lines.wrapped("", &format!("{}: {}", badge(findings.verdict).0.to_uppercase(), headline(findings)));
    if !findings.summary.is_empty() {
        lines.wrapped("  ", &findings.summary);
    }
    for effect in findings.effects.iter().take(SHOWN) {
        lines.blank();
        lines.effect(findings, effect);
    }
    lines.more(findings.effects.len());
    lines.base_parameters(findings);
    lines.signals(findings);
    for unmodelled in &findings.unmodelled {
        lines.blank();
        lines.wrapped("", &format!("Unmodelled: {}", unmodelled.description));
    }
    if let Some(experiment) = &findings.experiment {
        lines.blank();
        lines.wrapped("", &format!("To settle it: {experiment}"));
    }
    if !findings.data_problems.is_empty() {
        lines.blank();
        lines.wrapped("", "Data:");
        for problem in findings.data_problems.iter().take(SHOWN) {
            let kind = if problem.fatal { "unusable" } else { "note" };
            lines.wrapped("  ", &format!("{kind}: {}, {}: {}", problem.record, problem.signal, problem.text));
        }
        lines.more(findings.data_problems.len());
    }
    lines.blank();
    lines.wrapped(
        "",
        &format!(
            "Diagnosed in {} s from {} and {}.",
            digits(findings.seconds, 2),
            count(findings.train.len(), "training record"),
            count(findings.test.len(), "held-out record")
        ),
    );
    lines.0.join("\n") + "\n"
}

struct Lines(Vec<String>);

impl Lines {
    fn blank(&mut self) {
        self.0.push(String::new());
    }

    /// A paragraph; lines after its first stand two columns further right.
    fn wrapped(&mut self, indent: &str, text: &str) {
        // Names come from files: what moves the cursor must not reach the terminal.
        let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        let next = format!("{indent}  ");
        let options = Options::new(WIDTH).initial_indent(indent).subsequent_indent(&next);
        self.0.extend(textwrap::wrap(text.trim_end(), options).iter().map(|line| line.trim_end().to_owned()));
    }

    fn more(&mut self, all: usize) {
        if all > SHOWN {
            self.wrapped("  ", &format!("… and {} more, see report.html", all - SHOWN));
        }
    }

    fn effect(&mut self, findings: &Findings, effect: &Effect) {
        let evidence = effect.evidence;
        self.wrapped("", &format!("{} {}", effect.id, capitalised(&located(&effect.name, &effect.element))));
        for parameter in &effect.parameters {
            let [value, low, high] = interval(parameter.value, parameter.low, parameter.high);
            let unit = unit(&parameter.unit);
            self.wrapped("  ", &format!("{} = {value} {unit} [{low}, {high}]", parameter.name));
        }
        self.wrapped(
            "  ",
            &format!(
                "held-out t = {}, training t = {}, ΔBIC = {}, explains {} of the error’s power",
                number(evidence.held_out_t),
                number(evidence.block_t),
                number(evidence.delta_bic),
                percent(evidence.explained)
            ),
        );
        if !effect.ambiguous_with.is_empty() {
            let causes: Vec<String> = effect.ambiguous_with.iter().map(|key| cause(findings, key)).collect();
            self.wrapped("  ", &format!("could also be: {}", causes.join("; ")));
        }
        if let Some(experiment) =
            effect.experiment.as_ref().filter(|text| Some(*text) != findings.experiment.as_ref())
        {
            self.wrapped("  ", &format!("to tell: {experiment}"));
        }
    }

    fn base_parameters(&mut self, findings: &Findings) {
        let wrong: Vec<_> = findings.base_parameters.iter().filter(|parameter| parameter.mismatch).collect();
        if wrong.is_empty() {
            return;
        }
        self.blank();
        self.wrapped("", "Parameters that do not fit:");
        for parameter in wrong.iter().take(SHOWN) {
            let [value, low, high] = interval(parameter.after, parameter.low, parameter.high);
            let (before, unit) = (digits(parameter.before, 4), unit(&parameter.unit));
            self.wrapped("  ", &format!("{}: {before} -> {value} {unit} [{low}, {high}]", parameter.name));
        }
        self.more(wrong.len());
    }

    fn signals(&mut self, findings: &Findings) {
        if findings.signals.is_empty() {
            return;
        }
        self.blank();
        let header =
            ["On held-out data", "Φ start", "fitted", "extended", "rms start", "fitted", "extended", "noise"];
        let mut rows = vec![header.map(str::to_owned)];
        rows.extend(findings.signals.iter().take(SHOWN).map(|signal| {
            let unit = unit(&signal.unit);
            let name =
                if unit.is_empty() { signal.name.clone() } else { format!("{} [{unit}]", signal.name) };
            let phi = |value: f64| fit(value, 3);
            [
                shortened(&name, 32),
                phi(signal.phi_before),
                phi(signal.phi_fitted),
                phi(signal.phi_after),
                number(signal.rms_before),
                number(signal.rms_fitted),
                number(signal.rms_after),
                number(signal.noise_floor),
            ]
        }));
        let name_width = rows.iter().map(|row| row[0].width()).max().unwrap_or(0);
        for row in rows {
            let mut line = padded(&row[0], name_width, false);
            for cell in &row[1..] {
                line.push_str(&padded(cell, 9, true));
            }
            self.0.push(line);
        }
        self.more(findings.signals.len());
    }
}

/// The text in a field of `width` columns.
fn padded(text: &str, width: usize, right: bool) -> String {
    let room = " ".repeat(width.saturating_sub(text.width()));
    if right {
        format!("{}{room}{text}", if room.is_empty() { " " } else { "" })
    } else {
        format!("{text}{room}")
    }
}

/// A name that fits into `width` columns, its end replaced if need be.
fn shortened(name: &str, width: usize) -> String {
    let name: String = name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if name.width() <= width {
        return name;
    }
    let mut text = String::new();
    for c in name.chars() {
        if text.width() + 3 > width {
            break;
        }
        text.push(c);
    }
    text + "…"
}
