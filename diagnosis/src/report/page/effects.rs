//! The effects: why they are believed, what else they could be, what was added.

use maud::{Markup, html};

use crate::report::evidence::{gates, sentences};
use crate::report::findings::{Effect, Evidence, Findings};
use crate::report::words::{capitalised, cause, interval, located, unit};

/// All effects that were found.
pub fn section(findings: &Findings) -> Markup {
    let several = findings.effects.len() > 1;
    html! {
        @if !findings.effects.is_empty() {
            section {
                h2 { @if several { "What was found" } @else { "Why we think so" } }
                @for (index, effect) in findings.effects.iter().enumerate() {
                    article.effect {
                        h3 {
                            @if several { span.rank { (index + 1) } " " }
                            (capitalised(&located(&effect.name, &effect.element)))
                            span.id { "catalogue " (effect.id) }
                        }
                        div.columns {
                            div {
                                ul.reasons { @for sentence in sentences(&effect.evidence) { li { (sentence) } } }
                                (alternatives(findings, effect))
                            }
                            (evidence(&effect.evidence))
                        }
                        (added(findings, effect))
                    }
                }
            }
        }
    }
}

/// The gates as a table.
fn evidence(evidence: &Evidence) -> Markup {
    html! {
        table.gates {
            thead { tr { th { "Gate" } th.number { "found" } th.number { "required" } th {} } }
            tbody {
                @for gate in gates(evidence) {
                    tr {
                        td { (gate.name) div.small { (gate.meaning) } }
                        td.number { strong { (gate.found) } }
                        td.number { (gate.required) }
                        td {
                            @match (gate.passed, gate.waived) {
                                (true, _) => span.yes { "✓ passed" },
                                (false, Some(reason)) => { "not asked for" div.small { (reason) } },
                                (false, None) => span.no { "✗ not passed" },
                            }
                        }
                    }
                }
            }
        }
    }
}

fn alternatives(findings: &Findings, effect: &Effect) -> Markup {
    let experiment = effect.experiment.as_ref().filter(|text| Some(*text) != findings.experiment.as_ref());
    html! {
        @if effect.ambiguous_with.is_empty() {
            p.alternatives { strong { "What else it could be: " } "nothing else in the catalogue; these data tell all other causes from it." }
        } @else {
            div.alternatives {
                p { strong { "What else it could be" } ", as far as these data can tell:" }
                ul { @for key in &effect.ambiguous_with { li { (capitalised(&cause(findings, key))) } } }
            }
        }
        @if let Some(experiment) = experiment {
            p.alternatives { strong { "To tell them apart: " } (experiment) }
        }
    }
}

/// What the model got.
fn added(findings: &Findings, effect: &Effect) -> Markup {
    let outside = findings.corrections.iter().any(|it| it.signal == effect.element);
    html! {
        @if !effect.equation.is_empty() || !effect.parameters.is_empty() {
            div.added {
                h4 { @if outside { "What the signal passes" } @else { "What was added to the model" } }
                @if outside {
                    p { "It lies outside of the model: " code { "extended.fmu" } " does not hold it. " code { "report.json" } " has it among " code { "corrections" } "." }
                }
                @if !effect.equation.is_empty() { pre { (effect.equation) } }
                @if !effect.parameters.is_empty() {
                    div.scroll { table.tight {
                        thead { tr { th { "Parameter" } th.number { "Value" } th.number { "95 % interval" } th { "Unit" } } }
                        tbody {
                            @for parameter in &effect.parameters {
                                @let [value, low, high] = interval(parameter.value, parameter.low, parameter.high);
                                tr {
                                    td { code { (parameter.name) } }
                                    td.number { strong { (value) } }
                                    td.number { (low) " … " (high) }
                                    td.unit { (unit(&parameter.unit)) }
                                }
                            }
                        }
                    } }
                }
            }
        }
    }
}
