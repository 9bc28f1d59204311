//! The identified effects: value, law, evidence, alternatives.

use maud::{Markup, html};

use crate::report::evidence::{gates, sentences};
use crate::report::findings::{Effect, Evidence, Findings};
use crate::report::words::{UNREACHED, capitalised, effect_name, interval, limit, located, of_ratio, unit};

/// All identified effects.
pub fn section(findings: &Findings) -> Markup {
    let several = findings.effects.len() > 1;
    html! {
        @if !findings.effects.is_empty() {
            section {
                h2 { @if several { "Identified effects" } @else { "Identified effect" } }
                @for (index, effect) in findings.effects.iter().enumerate() {
                    article.effect {
                        h3 {
                            @if several { span.rank { (index + 1) } " " }
                            (capitalised(&located(&effect.name, &effect.element)))
                            span.id { "catalogue " (effect.id) }
                        }
                        (added(findings, effect))
                        div.columns {
                            div {
                                h4 { "Evidence" }
                                ul.reasons { @for sentence in sentences(&effect.evidence) { li { (sentence) } } }
                                (alternatives(findings, effect))
                            }
                            (evidence(&effect.evidence))
                        }
                    }
                }
            }
        }
    }
}

/// The tests as a table.
fn evidence(evidence: &Evidence) -> Markup {
    html! {
        table.gates {
            thead { tr { th { "Test" } th.number { "result" } th.number { "limit" } th {} } }
            tbody {
                @for gate in gates(evidence) {
                    tr {
                        td { (gate.name) div.small { (gate.meaning) } }
                        td.number { strong { (gate.found) } }
                        td.number { (gate.required) }
                        td {
                            @match (gate.passed, gate.waived) {
                                (true, _) => span.yes { "✓ passed" },
                                (false, Some(reason)) => { "not required" div.small { (reason) } },
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
            p.alternatives { strong { "Alternatives: " } "no other effect of the catalogue fits these data as well." }
        } @else {
            div.alternatives {
                p { strong { "Alternatives" } " that fit these data as well:" }
                ul { @for key in &effect.ambiguous_with { li { (capitalised(&effect_name(findings, key))) } } }
            }
        }
        @if let Some(experiment) = experiment {
            p.alternatives { strong { "To tell them apart: " } (experiment) }
        }
    }
}

/// The law and the values of its parameters.
fn added(findings: &Findings, effect: &Effect) -> Markup {
    let outside = findings.distortions.iter().any(|it| it.signal == effect.element);
    html! {
        @if !effect.equation.is_empty() || !effect.parameters.is_empty() {
            div.added {
                h4 { @if outside { "Signal distortion" } @else { "Extension of the model" } }
                @if outside {
                    p {
                        "The distortion acts outside the model. " code { "extended.fmu" } " does not contain it; "
                        code { "report.json" } " lists it under " code { "distortions" } "."
                    }
                }
                @if !effect.equation.is_empty() { pre { (effect.equation) } }
                @if !effect.parameters.is_empty() {
                    div.scroll { table.tight {
                        thead { tr { th { "Parameter" } th.number { "Value" } th.number { "95 % interval" } th { "Unit" } } }
                        tbody {
                            @for parameter in &effect.parameters {
                                tr {
                                    td { code { (parameter.name) } }
                                    @if let Some(limit) = limit(parameter).filter(|_| parameter.reached) {
                                        td.number { strong { (limit) } }
                                        td.number { "–" }
                                        td.unit { (unit(&parameter.unit)) }
                                    } @else if parameter.reached {
                                        @let [value, low, high] = interval(parameter.value, parameter.low, parameter.high);
                                        td.number { strong { (value) } }
                                        td.number {
                                            (low) " … " (high)
                                            @if let Some(it) = of_ratio(findings, parameter.value, parameter.of_ratio) { br; (it) }
                                        }
                                        td.unit { (unit(&parameter.unit)) }
                                    } @else {
                                        td colspan="3" { (UNREACHED) }
                                    }
                                }
                            }
                        }
                    } }
                }
            }
        }
    }
}
