//! The fit and the error of each signal, for the models in the order of their making.

use maud::{Markup, html};

use super::extended;
use crate::report::findings::{Findings, Signal};
use crate::report::plot::px;
use crate::report::words::{digits, fit, number, unit};

/// The models in the order of their making: style class and name.
const MODELS: [(&str, &str); 3] = [("start", "start"), ("before", "fitted"), ("after", "extended")];

/// The most important numbers beside the headline, of all signals.
pub fn facts(findings: &Findings) -> Markup {
    let extended = extended(findings);
    let last = |signal: &Signal| {
        if extended { (signal.fit_after, signal.rms_after) } else { (signal.fit_fitted, signal.rms_fitted) }
    };
    // Both means are over the same signals.
    let known: Vec<&Signal> = findings
        .signals
        .iter()
        .filter(|signal| signal.fit_before.is_finite() && last(signal).0.is_finite())
        .collect();
    let before = mean(known.iter().map(|signal| signal.fit_before));
    let after = mean(known.iter().map(|signal| last(signal).0));
    let ratios = findings.signals.iter().map(|signal| last(signal).1 / signal.noise_floor);
    let mut ratios: Vec<f64> = ratios.filter(|ratio| ratio.is_finite()).collect();
    ratios.sort_by(f64::total_cmp);
    html! {
        @if !findings.signals.is_empty() {
            dl.facts {
                div {
                    dt { "Fit, " (of_all(known.len())) }
                    dd { (fit_or_none(before)) span.arrow { " → " } (fit_or_none(after)) }
                }
                @if let (Some(least), Some(most)) = (ratios.first(), ratios.last()) {
                    div {
                        dt { "Remaining error, × sensor noise" }
                        dd {
                            (multiple(*least))
                            @if multiple(*least) != multiple(*most) { span.arrow { " … " } (multiple(*most)) }
                        }
                    }
                }
                @if let Some(effect) = findings.effects.first() {
                    div { dt { "Validation" } dd { "t = " (number(effect.evidence.validation_t)) } }
                }
            }
        }
    }
}

/// A fit; below zero, where its size means nothing, that it is.
fn fit_or_none(value: f64) -> String {
    if value < 0.0 { "< 0".into() } else { fit(value, 2) }
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    // Of nothing: not a number.
    if count > 0.0 { values.map(|value| value / count).sum() } else { f64::NAN }
}

fn of_all(signals: usize) -> String {
    if signals == 1 { "one signal".into() } else { format!("mean of {signals} signals") }
}

/// The table of all signals.
pub fn section(findings: &Findings) -> Markup {
    if findings.signals.is_empty() {
        return html! {};
    }
    let extended = extended(findings);
    let models = if extended { &MODELS[..] } else { &MODELS[..2] };
    let repeated = findings.signals.iter().any(|signal| signal.repeatability.is_some());
    html! {
        section {
            h2 { "Fit" }
            p.note {
                "On the validation data. Fit (NRMSE) = 1 − rms(error)/rms(signal); it is the fit of MATLAB’s "
                code { "compare" } " divided by 100. A fit of 1 is perfect. A model with a fit of 0 or less does not predict \
                the signal. “Start” is the model with its starting values, “fitted” the same with fitted nominal parameters"
                @if extended { ", “extended” the model with its effects" } "."
            }
            div.scroll { table {
                thead {
                    tr {
                        th rowspan="2" { "Signal" }
                        th.group colspan=(models.len()) { "Fit (NRMSE)" }
                        th.group colspan=(models.len()) { "rms error" }
                        th rowspan="2" {}
                        th.number rowspan="2" { "Sensor noise" }
                        @if repeated { th.number rowspan="2" { "Repeatability" } }
                        th rowspan="2" { "Unit" }
                    }
                    tr { @for _ in 0..2 { @for model in models { th.number { (model.1) } } } }
                }
                tbody { @for signal in &findings.signals { (row(signal, models.len(), repeated)) } }
            } }
        }
    }
}

fn row(signal: &Signal, models: usize, repeated: bool) -> Markup {
    let phi = [signal.fit_before, signal.fit_fitted, signal.fit_after].map(|phi| fit(phi, 3));
    let rms = [signal.rms_before, signal.rms_fitted, signal.rms_after].map(number);
    html! {
        tr {
            td { code { (signal.name) } }
            @for values in [phi, rms] {
                @for (index, value) in values[..models].iter().enumerate() {
                    td.number { @if index + 1 == models { strong { (value) } } @else { (value) } }
                }
            }
            td.bars { (bars(signal, models)) }
            td.number { (number(signal.noise_floor)) }
            @if repeated { td.number { (signal.repeatability.map_or("–".into(), number)) } }
            td.unit { (unit(&signal.unit)) }
        }
    }
}

/// A multiple of the noise; far above it, its digits mean nothing.
fn multiple(ratio: f64) -> String {
    if ratio > 1000.0 { "> 1000".into() } else { digits(ratio, 2) }
}

/// Errors before, fitted and after as bars, with a line at the sensor noise.
fn bars(signal: &Signal, models: usize) -> Markup {
    let errors = [signal.rms_before, signal.rms_fitted, signal.rms_after];
    let errors: Vec<_> = errors.into_iter().zip(MODELS.map(|(class, _)| class)).take(models).collect();
    let largest = errors.iter().map(|(rms, _)| *rms).filter(|rms| rms.is_finite()).fold(0.0, f64::max);
    let length =
        |rms: f64| Some(110.0 * (rms / largest)).filter(|length| length.is_finite() && *length >= 0.0);
    html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 114 25" width="114" height="25" class="plot" {
            title { "rms error of each model; the line is the sensor noise" }
            @for (index, (rms, class)) in errors.iter().enumerate() {
                @if let Some(length) = length(*rms) {
                    rect class=(format!("bar {class}")) x="1" y=(index * 8 + 1) width=(px(length.max(0.5))) height="6" {}
                }
            }
            @if let Some(floor) = length(signal.noise_floor).filter(|floor| *floor <= 110.0) {
                line class="floor" x1=(px(floor + 1.0)) x2=(px(floor + 1.0)) y1="0" y2="25" {}
            }
        }
    }
}
