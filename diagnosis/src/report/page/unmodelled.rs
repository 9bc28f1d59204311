//! Missing signals that no effect of the catalogue explains.

use maud::{Markup, html};

use super::pictures;
use crate::report::findings::{Curve, Findings, Unmodelled};
use crate::report::words::{capitalised, digits, fit, labelled, list, percent, place};

/// All of them, the largest first.
pub fn section(findings: &Findings) -> Markup {
    html! {
        @if !findings.unmodelled.is_empty() {
            section {
                h2 { "Unmodelled" }
                p.note { "No effect of the catalogue explains these signals. The shares are shares of the missing signal." }
                @for it in &findings.unmodelled { (entry(it)) }
            }
        }
    }
}

fn entry(it: &Unmodelled) -> Markup {
    html! {
        article.effect {
            h3 { "Missing " (place(&it.place)) }
            p { (capitalised(&it.description)) "." }
            dl.facts {
                @if it.share > 0.0 {
                    div { dt { "Estimation data" } dd { (percent(it.share)) } }
                    div { dt { "Validation data" } dd { (percent(it.validation_share)) } }
                    div { dt { "Possible rise of the fit" } dd { (fit(it.improvement, 2)) } }
                }
                @if let Some(frequency) = it.frequency { div { dt { "Frequency" } dd { (digits(frequency, 3)) " Hz" } } }
                div {
                    dt { "Depends on" }
                    dd { @if it.depends_on.is_empty() { "nothing that was found" } @else { (list(&it.depends_on, "and")) } }
                }
            }
            @if let Some(curve) = it.curve.as_ref().filter(|curve| !curve.x.is_empty()) {
                figure.wide {
                    figcaption { (caption(curve)) }
                    (pictures::curve(curve))
                }
            }
        }
    }
}

fn caption(curve: &Curve) -> String {
    let what = if curve.quantity.is_empty() { "quantity" } else { &curve.quantity };
    format!("Missing {} with its 95 % band", labelled(what, &curve.unit))
}
