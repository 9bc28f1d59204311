//! The page: one file, readable in a minute.

mod account;
mod effects;
mod experiment;
mod fit;
mod missing;
mod pictures;
mod schematic;
mod tables;
mod unmodelled;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::words::{badge, count, digits, headline};
use crate::report::findings::{Findings, Provenance, Verdict};

const STYLE: &str = include_str!("style.css");

/// The findings as one page of HTML, which needs no other file, no network and no scripts.
pub fn html(findings: &Findings) -> String {
    let (word, kind) = badge(findings);
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { "Diagnosis of " (findings.rig) ": " (word) }
                style { (PreEscaped(STYLE)) }
            }
            body class=(kind) {
                (header(findings, word))
                @let parameters_first = findings.verdict == Verdict::ParameterMismatch;
                main {
                    (tables::fatal_problems(findings))
                    (account::section(findings))
                    @if parameters_first { (tables::nominal_parameters(findings)) }
                    (missing::section(findings))
                    (effects::section(findings))
                    (unmodelled::section(findings))
                    (experiment::section(findings))
                    (fit::section(findings))
                    @if !parameters_first { (tables::nominal_parameters(findings)) }
                    (pictures::section(findings))
                    (tables::candidates(findings))
                    (tables::records(findings))
                    (tables::other_problems(findings))
                }
                (footer(findings))
            }
        }
    };
    // Names come from files; control characters are not allowed in a page.
    page.into_string().replace(|c: char| c.is_control() && c != '\n', " ")
}

fn header(findings: &Findings, word: &str) -> Markup {
    html! {
        header {
            p.top {
                span.badge { (word) }
                span.rig { (findings.rig) }
                @if !findings.train.is_empty() { span { "estimation data " (files(&findings.train)) } }
                @if !findings.test.is_empty() { span { "validation data " (files(&findings.test)) } }
            }
            div.hero {
                div {
                    h1 { (headline(findings)) }
                    @if !findings.summary.is_empty() { p.lead { (findings.summary) } }
                    (fit::facts(findings))
                }
                (schematic::figure(findings))
            }
        }
    }
}

fn files(names: &[String]) -> Markup {
    html! {
        @for (index, name) in names.iter().take(3).enumerate() {
            @if index > 0 { ", " } code { (name) }
        }
        @if names.len() > 3 { " and " (names.len() - 3) " more" }
    }
}

/// Whether anything was added to the starting model.
fn extended(findings: &Findings) -> bool {
    !findings.effects.is_empty() || findings.unmodelled.iter().any(|it| it.curve.is_some())
}

fn footer(findings: &Findings) -> Markup {
    let problems = findings.data_problems.len();
    html! {
        footer {
            "Diagnosed in " (digits(findings.seconds, 2)) " s from "
            (count(findings.train.len(), "estimation record")) " and " (count(findings.test.len(), "validation record"))
            @if problems > 0 && findings.verdict != Verdict::BadData { ", with " (count(problems, "note")) " on the data" }
            ". " code { "report.json" } " holds the same findings for programs (format " (findings.format) ")."
            @if let Some(it) = &findings.provenance { (provenance(it)) }
        }
    }
}

/// Version, command, date and the records with their hashes.
fn provenance(it: &Provenance) -> Markup {
    html! {
        p {
            "Strut " (it.version) ", " (it.date)
            @if !it.command.is_empty() { ": " code { (it.command) } }
        }
        ul {
            @for record in &it.records {
                li { code { (record.path) } @if !record.sha256.is_empty() { " SHA-256 " code { (record.sha256) } } }
            }
        }
    }
}
