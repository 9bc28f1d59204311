//! Tables: nominal parameters, candidates, problems of the data.

use maud::{Markup, html};

use crate::data::check::DataProblem;
use crate::report::findings::{Findings, NominalParameter, RecordRead};
use crate::report::words::records::read;
use crate::report::words::{
    capitalised, count, digits, interval, number, of_ratio, percent, place, reservation, unit,
};

/// Change below which its sign is no matter.
const UNCHANGED: f64 = 5e-4;

/// Rows that a table shows before the rest is folded away.
const OPEN_ROWS: usize = 12;

/// Problems that make the data unusable.
pub fn fatal_problems(findings: &Findings) -> Markup {
    problems(findings, true, "Data errors")
}

/// Problems that the diagnosis can work around.
pub fn other_problems(findings: &Findings) -> Markup {
    problems(findings, false, "Notes on the data")
}

fn problems(findings: &Findings, fatal: bool, title: &str) -> Markup {
    let chosen: Vec<_> = findings.data_problems.iter().filter(|problem| problem.fatal == fatal).collect();
    let table = |problems: &[&DataProblem]| {
        html! {
            table {
                thead { tr { th { "Record" } th { "Signal" } th { "Problem and remedy" } } }
                tbody {
                    @for problem in problems {
                        tr { td { code { (problem.record) } } td { code { (problem.signal) } } td { (problem.text) } }
                    }
                }
            }
        }
    };
    html! {
        @if !chosen.is_empty() {
            section class=(if fatal { "fatal" } else { "" }) { h2 { (title) } (folded(&chosen, "problems", table)) }
        }
    }
}

/// How each record was read.
pub fn records(findings: &Findings) -> Markup {
    let all: Vec<&RecordRead> = findings.records.iter().collect();
    let table = |records: &[&RecordRead]| {
        html! {
            table {
                thead { tr { th { "Record" } th { "Size" } th { "Columns" } } }
                tbody {
                    @for record in records {
                        @let (size, lines) = read(record);
                        tr { td { code { (record.record) } } td { (size) } td { @for line in lines { p { (line) } } } }
                    }
                }
            }
        }
    };
    html! { @if !all.is_empty() { section { h2 { "Records" } (folded(&all, "records", table)) } } }
}

/// The first rows as a table, the others behind a line to click on.
fn folded<'a, T>(rows: &[&'a T], noun: &str, table: impl Fn(&[&'a T]) -> Markup) -> Markup {
    let open = if rows.len() > OPEN_ROWS + 2 { OPEN_ROWS } else { rows.len() };
    html! {
        div.scroll { (table(&rows[..open])) }
        @if open < rows.len() {
            details { summary { "The other " (rows.len() - open) " " (noun) } div.scroll { (table(&rows[open..])) } }
        }
    }
}

/// Starting and fitted values of the nominal parameters.
pub fn nominal_parameters(findings: &Findings) -> Markup {
    // Mismatches come first; otherwise the order stays.
    let mut all: Vec<&NominalParameter> = findings.nominal_parameters.iter().collect();
    all.sort_by_key(|parameter| !parameter.mismatch);
    let table = |parameters: &[&NominalParameter]| {
        html! {
            table {
                thead { tr {
                    th { "Parameter" } th.number { "Start" } th.number { "Fitted" } th.number { "95 % interval" }
                    th { "Unit" } th.number { "Change" } th {}
                } }
                tbody { @for parameter in parameters {
                    @let [after, low, high] = interval(parameter.after, parameter.low, parameter.high);
                    tr class=(if parameter.mismatch { "mismatch" } else { "" }) {
                        td { code { (parameter.name) } }
                        td.number { (digits(parameter.before, 4)) }
                        td.number { strong { (after) } }
                        td.number {
                            (low) " … " (high)
                            @if let Some(it) = of_ratio(findings, parameter.after, parameter.of_ratio) { br; (it) }
                        }
                        td.unit { (unit(&parameter.unit)) }
                        td.number { (change(parameter)) }
                        td {
                            @if parameter.mismatch { span.no { "mismatch" } }
                            @if parameter.is_yardstick { "kept" }
                        }
                    }
                } }
            }
        }
    };
    html! {
        @if !all.is_empty() {
            section {
                h2 { "Nominal parameters" }
                p.note {
                    "A mismatch is a significant difference that is large enough to matter."
                    @if let Some(it) = reservation(findings) { " " (it) }
                }
                (folded(&all, "parameters", table))
            }
        }
    }
}

fn change(parameter: &NominalParameter) -> String {
    if parameter.before == 0.0 {
        return "–".into();
    }
    let change = parameter.after / parameter.before - 1.0;
    let sign = if change >= UNCHANGED { "+" } else { "" };
    format!("{sign}{}", percent(if change.abs() < UNCHANGED { change.abs() } else { change }))
}

/// A place without its preposition, for a narrow column.
fn site(element: &str) -> String {
    place(element).trim_start_matches("in the ").trim_start_matches("measurement of ").to_owned()
}

/// All candidates with their share of the missing signal.
pub fn candidates(findings: &Findings) -> Markup {
    let all = &findings.candidates;
    if all.is_empty() {
        return html! {};
    }
    let fitted = all.iter().filter(|candidate| candidate.fitted).count();
    html! {
        section {
            h2 { "Candidates" }
            p.note {
                "“Share” is the part of the missing signal that a candidate explains on its own, on the estimation data. \
                “Validated” is the part on the validation data, with the same values. “Variance explained” and the tests \
                are results of the fit."
            }
            details {
                summary {
                    (count(all.len(), "candidate")) ": " (fitted) " fitted, " (all.len() - fitted) " compared only"
                }
                div.scroll { table {
                    thead { tr {
                        th { "No." } th { "Effect" } th { "Place" } th.number { "Share" } th.number { "Validated" } th { "Outcome" }
                        th.number { "Validation t" } th.number { "Estimation t" } th.number { "ΔBIC" }
                        th.number { "Variance explained" }
                    } }
                    tbody { @for candidate in all {
                        tr class=(if candidate.outcome == "accepted" { "accepted" } else { "" }) {
                            td { (candidate.id) }
                            td { (capitalised(&candidate.name)) }
                            td { (site(&candidate.element)) }
                            td.number { (percent(candidate.share)) }
                            td.number { (percent(candidate.validation_share)) }
                            td { (candidate.outcome) @if !candidate.fitted { span.small { " (compared)" } } }
                            @if let Some(evidence) = candidate.evidence {
                                td.number { (number(evidence.validation_t)) }
                                td.number { (number(evidence.estimation_t)) }
                                td.number { (number(evidence.delta_bic)) }
                                td.number { (percent(evidence.variance_explained)) }
                            } @else { td.number {} td.number {} td.number {} td.number {} }
                        }
                    } }
                } }
            }
        }
    }
}
