//! The page: one file, readable in a minute.

mod effects;
mod gain;
mod pictures;
mod schematic;
mod tables;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::words::{badge, capitalised, cause, count, digits, headline, labelled};
use crate::report::findings::{Findings, Verdict};

const STYLE: &str = include_str!("style.css");

/// The findings as one page of HTML, which needs no other file, no network and no scripts.
pub fn html(findings: &Findings) -> String {
    let (word, kind) = badge(findings.verdict);
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
                    @if parameters_first { (tables::base_parameters(findings)) }
                    (effects::section(findings))
                    (unmodelled(findings))
                    (experiment(findings))
                    (gain::section(findings))
                    @if !parameters_first { (tables::base_parameters(findings)) }
                    (pictures::section(findings))
                    (tables::candidates(findings))
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
                @if !findings.train.is_empty() { span { "learnt from " (files(&findings.train)) } }
                @if !findings.test.is_empty() { span { "judged on " (files(&findings.test)) } }
            }
            div.hero {
                div {
                    h1 { (headline(findings)) }
                    @if !findings.summary.is_empty() { p.lead { (findings.summary) } }
                    (gain::facts(findings))
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

/// What is missing and in no catalogue.
fn unmodelled(findings: &Findings) -> Markup {
    html! {
        @for it in &findings.unmodelled {
            section {
                h2 { "Not in the catalogue" }
                p { (capitalised(&it.description)) "." }
                @if let Some(curve) = it.curve.as_ref().filter(|curve| !curve.x.is_empty()) {
                    figure {
                        figcaption { (labelled(&format!("Missing {}", curve.quantity), &curve.unit)) " with its 95 % band" }
                        (pictures::unnamed(curve))
                    }
                }
            }
        }
    }
}

fn experiment(findings: &Findings) -> Markup {
    let known: Vec<String> = findings
        .effects
        .iter()
        .flat_map(|effect| &effect.ambiguous_with)
        .map(|key| cause(findings, key))
        .collect();
    html! {
        @if let Some(experiment) = &findings.experiment {
            section.experiment {
                h2 { @if known.is_empty() { "What to measure next" } @else { "The experiment that would settle it" } }
                p { (experiment) }
            }
        }
    }
}

fn footer(findings: &Findings) -> Markup {
    let problems = findings.data_problems.len();
    html! {
        footer {
            "Diagnosed in " (digits(findings.seconds, 2)) " s from "
            (count(findings.train.len(), "training record")) " and " (count(findings.test.len(), "held-out record"))
            @if problems > 0 && findings.verdict != Verdict::BadData { ", with " (count(problems, "remark")) " on the data" }
            ". The same findings for programs: " code { "report.json" } ", format version " (findings.format) "."
        }
    }
}
