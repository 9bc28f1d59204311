//! The summary for the terminal.

use textwrap::Options;
use unicode_width::UnicodeWidthStr;

use super::words::{
    UNREACHED, badge, capitalised, chance, count, digits, effect_name, effect_rank, headline, interval,
    limit, located, number, of_ratio, percent, quantity, unit,
};
use crate::report::findings::{AccountItem, Effect, Findings, RecordRead, SignalAccount};
use crate::report::words;

/// Columns that a line has at most.
const WIDTH: usize = 100;

/// Items of a list that are shown; the others are in the page.
const SHOWN: usize = 6;

/// Columns of a number in the account.
const CELL: usize = 11;

/// A summary of at most a hundred columns.
pub fn terminal(findings: &Findings) -> String {
    let mut lines = Lines(Vec::new());
    lines.wrapped("", &format!("{}: {}", badge(findings).0.to_uppercase(), headline(findings)));
    if !findings.summary.is_empty() {
        lines.wrapped("  ", &findings.summary);
    }
    lines.account(findings);
    for effect in findings.effects.iter().take(SHOWN) {
        lines.blank();
        lines.effect(findings, effect);
    }
    lines.more(findings.effects.len());
    lines.unmodelled(findings);
    lines.nominal_parameters(findings);
    if let Some(experiment) = &findings.experiment {
        lines.blank();
        lines.wrapped("", &format!("Next experiment: {experiment}"));
        lines.deciding(findings);
    }
    lines.data_problems(findings);
    lines.blank();
    lines.wrapped(
        "",
        &format!(
            "Diagnosed in {} s from {} and {}.",
            digits(findings.seconds, 2),
            count(findings.train.len(), "estimation record"),
            count(findings.test.len(), "validation record")
        ),
    );
    lines.0.join("\n") + "\n"
}

/// How the records were read.
pub fn read(records: &[RecordRead]) -> String {
    let mut lines = Lines(Vec::new());
    for record in records {
        let (size, rest) = words::records::read(record);
        lines.wrapped("", &format!("read {}: {size}", record.record));
        rest.iter().for_each(|line| lines.wrapped("  ", line));
    }
    lines.0.join("\n") + "\n"
}

struct Lines(Vec<String>);

impl Lines {
    fn blank(&mut self) {
        self.0.push(String::new());
    }

    /// A paragraph; lines after its first stand two columns further right.
    fn wrapped(&mut self, indent: &str, text: &str) {
        // Names come from files; control characters must not reach the terminal.
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

    /// Where the power of each signal's error goes, in per cent.
    fn account(&mut self, findings: &Findings) {
        if findings.account.is_empty() {
            return;
        }
        self.blank();
        self.wrapped("", "Error power of the starting model on the validation data, in %:");
        let header =
            ["signal", "rms error", "noise", "parameters", "effects", "unmodelled", "unexplained", ""];
        let mut rows = vec![header.map(str::to_owned)];
        rows.extend(findings.account.iter().take(SHOWN).map(|it| account_row(findings, it)));
        let width = |column: usize| rows.iter().map(|row| row[column].width()).max().unwrap_or(0);
        let rest: usize = (1..header.len()).map(|column| width(column) + 2).sum();
        let name = width(0).min(WIDTH.saturating_sub(rest + 2));
        for row in &rows {
            let mut line = format!("  {}", padded(&shortened(&row[0], name), name, false));
            for (column, cell) in row.iter().enumerate().skip(1) {
                line += &format!("  {}", padded(cell, width(column), true));
            }
            self.0.push(line.trim_end().to_owned());
        }
        self.more(findings.account.len());
    }

    fn effect(&mut self, findings: &Findings, effect: &Effect) {
        let evidence = effect.evidence;
        self.wrapped("", &format!("{} {}", effect.id, capitalised(&located(&effect.name, &effect.element))));
        for parameter in &effect.parameters {
            if !parameter.reached {
                self.wrapped("  ", &format!("{}: {UNREACHED}", parameter.name));
                continue;
            }
            let [value, low, high] = interval(parameter.value, parameter.low, parameter.high);
            let unit = unit(&parameter.unit);
            let text = match limit(parameter) {
                Some(limit) => format!("{} {limit} {unit}", parameter.name),
                None => {
                    let text = format!("{} = {value} {unit}", parameter.name);
                    let ratio = of_ratio(findings, parameter.value, parameter.of_ratio);
                    within(&text, [low, high], ratio)
                }
            };
            self.wrapped("  ", text.trim_end());
        }
        self.wrapped(
            "  ",
            &format!(
                "explains {} of the error power; validation t = {}, p-value = {}, ΔBIC = {}",
                percent(evidence.variance_explained),
                number(evidence.validation_t),
                number(evidence.p_value),
                number(evidence.delta_bic)
            ),
        );
        if !effect.ambiguous_with.is_empty() {
            let others: Vec<String> =
                effect.ambiguous_with.iter().map(|key| effect_name(findings, key)).collect();
            self.wrapped("  ", &format!("could also be: {}", others.join("; ")));
        }
        if let Some(experiment) =
            effect.experiment.as_ref().filter(|text| Some(*text) != findings.experiment.as_ref())
        {
            self.wrapped("  ", &format!("to tell them apart: {experiment}"));
        }
    }

    fn unmodelled(&mut self, findings: &Findings) {
        for it in findings.unmodelled.iter().take(SHOWN) {
            self.blank();
            self.wrapped("", &format!("Unmodelled: {}", it.description));
            // What follows nothing covers nothing.
            if it.share == 0.0 {
                continue;
            }
            self.wrapped(
                "  ",
                &format!(
                    "covers {} of the missing signal on the estimation data, {} on the validation data",
                    percent(it.share),
                    percent(it.validation_share)
                ),
            );
        }
        self.more(findings.unmodelled.len());
    }

    fn nominal_parameters(&mut self, findings: &Findings) {
        let wrong: Vec<_> =
            findings.nominal_parameters.iter().filter(|parameter| parameter.mismatch).collect();
        if wrong.is_empty() {
            return;
        }
        self.blank();
        self.wrapped("", "Nominal parameters that differ:");
        for parameter in wrong.iter().take(SHOWN) {
            let [value, low, high] = interval(parameter.after, parameter.low, parameter.high);
            let (before, unit) = (digits(parameter.before, 4), unit(&parameter.unit));
            let text = format!("{}: {before} -> {value} {unit}", parameter.name);
            let ratio = of_ratio(findings, parameter.after, parameter.of_ratio);
            self.wrapped("  ", &within(&text, [low, high], ratio));
        }
        self.more(wrong.len());
    }

    /// How well the computed experiment separates effects from their rivals.
    fn deciding(&mut self, findings: &Findings) {
        let Some(deciding) = &findings.deciding_experiment else { return };
        for it in deciding.pairs.iter().take(SHOWN) {
            self.wrapped("  ", &chance(findings, it));
        }
        self.more(deciding.pairs.len());
    }

    fn data_problems(&mut self, findings: &Findings) {
        if findings.data_problems.is_empty() {
            return;
        }
        self.blank();
        self.wrapped("", "Data:");
        for problem in findings.data_problems.iter().take(SHOWN) {
            let kind = if problem.fatal { "unusable" } else { "note" };
            self.wrapped("  ", &format!("{kind}: {}, {}: {}", problem.record, problem.signal, problem.text));
        }
        self.more(findings.data_problems.len());
    }
}

/// A value with its interval, and the interval that it has beside what is held.
fn within(value: &str, [low, high]: [String; 2], ratio: Option<String>) -> String {
    let ratio = ratio.map_or(String::new(), |it| format!("; {it}"));
    format!("{} (95 %: {low} … {high}{ratio})", value.trim_end())
}

fn account_row(findings: &Findings, account: &SignalAccount) -> [String; 8] {
    let unit = findings.signals.iter().find(|it| it.name == account.signal).map_or("", |it| it.unit.as_str());
    let share = |share: f64| shortened(percent(share).trim_end_matches(" %"), CELL);
    let [noise, parameters, effects, unmodelled, unexplained] = shares(findings, account).map(share);
    [
        account.signal.clone(),
        shortened(&quantity(account.error, unit), CELL),
        noise,
        parameters,
        effects,
        unmodelled,
        unexplained,
        if account.open { "open".into() } else { String::new() },
    ]
}

/// Shares of a signal's error power: noise, parameters, effects, unmodelled (curves without a name among it), unexplained.
pub fn shares(findings: &Findings, account: &SignalAccount) -> [f64; 5] {
    let (effects, curves): (Vec<&AccountItem>, Vec<&AccountItem>) =
        account.effects.iter().partition(|item| effect_rank(findings, item).is_some());
    let sum = |items: &[&AccountItem]| items.iter().map(|it| it.share).sum::<f64>();
    let unmodelled = sum(&curves) + account.unmodelled;
    [account.noise, account.parameters, sum(&effects), unmodelled, account.unexplained]
}

/// The text in a field of `width` columns.
fn padded(text: &str, width: usize, right: bool) -> String {
    let room = " ".repeat(width.saturating_sub(text.width()));
    if right { format!("{room}{text}") } else { format!("{text}{room}") }
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
