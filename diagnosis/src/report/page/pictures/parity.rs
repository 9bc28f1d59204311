//! Balances of measured signals.

use maud::{Markup, html};

use super::{part, unit_or_none};
use crate::report::findings::Parity;
use crate::report::plot::{Axis, Plot};
use crate::report::words::{digits, number, unit};

/// Width and height of a balance's picture, in pixels.
const SIZE: (f64, f64) = (490.0, 170.0);

/// Times the noise up to which a balance holds.
const HOLDS: f64 = 2.0;

/// All balances: those with a picture first.
pub(super) fn balances(all: &[Parity], extended: bool) -> Markup {
    let (formed, unformed): (Vec<&Parity>, Vec<&Parity>) = all.iter().partition(|it| it.needs.is_none());
    html! {
        @if !all.is_empty() {
            h3 { "Balances" }
            p.note {
                "Each balance combines a few sensors with at most one law of the model. Its residual should be sensor noise. \
                A balance that does not hold shows where to look."
                @if let Some(one) = formed.first() {
                    " On the validation data; all terms pass the same filter, up to " (digits(one.band, 2)) " Hz."
                }
            }
            @if !formed.is_empty() {
                ul.legend { li.before { "fitted" } @if extended { li.after { "extended" } } li.white { "twice the sensor noise" } }
                div.plots { @for one in formed { (balance(one, extended)) } }
            }
            @if !unformed.is_empty() {
                ul.explained {
                    @for one in unformed {
                        li {
                            strong { (one.id) " " (one.name) } " is not available; it needs "
                            (one.needs.as_deref().unwrap_or_default()) "."
                        }
                    }
                }
            }
        }
    }
}

fn balance(parity: &Parity, extended: bool) -> Markup {
    let left = if extended { parity.rms_after } else { parity.rms_fitted };
    let (from, to) = part(&parity.time, &parity.before);
    let within = |values: &[f64]| -> Vec<f64> {
        let inside = parity.time.iter().zip(values).filter(|(time, _)| (from..=to).contains(*time));
        inside.map(|(_, value)| *value).collect()
    };
    let (time, before, after) = (within(&parity.time), within(&parity.before), within(&parity.after));
    let high = vec![HOLDS * parity.noise; time.len()];
    let low: Vec<f64> = high.iter().map(|it| -it).collect();
    let shown = before.iter().chain(&after).chain(&high).chain(&low).copied();
    let x = Axis::tight("time / s", time.iter().copied(), 6);
    let y = Axis::linear(&unit_or_none(&parity.unit), shown, 4);
    let plot = Plot::new(format!("Residual of {}", parity.equation), SIZE, x, y).zero();
    let plot = plot.band("white", &time, &low, &high).curve("before", &time, &before);
    let plot = if extended { plot.curve("after", &time, &after) } else { plot };
    let times = |rms: f64| format!("{} × noise", digits(rms / parity.noise, 2));
    let violated = |rms: f64| rms > HOLDS * parity.noise;
    html! {
        figure.balance {
            figcaption {
                strong { (parity.id) " " (parity.name) } " "
                @if extended && violated(parity.rms_fitted) && times(left) != times(parity.rms_fitted) {
                    span.no { "✗ " (times(parity.rms_fitted)) } " → "
                }
                @if violated(left) { span.no { "✗ " (times(left)) } }
                @else if left.is_finite() { span.yes { "✓ holds" } }
            }
            code { (parity.equation) }
            (plot.svg())
            p.small {
                "rms: start " (number(parity.rms_before)) ", fitted " (number(parity.rms_fitted))
                @if extended { ", extended " strong { (number(parity.rms_after)) } }
                ", noise " (number(parity.noise)) " " (unit(&parity.unit)) ". If it does not hold: " (parity.meaning) "."
            }
        }
    }
}
