//! What it gained: Φ and errors per signal, and where the residual power went.

use maud::{Markup, html};

use super::extended;
use crate::report::findings::{Findings, Signal};
use crate::report::plot::px;
use crate::report::words::{digits, fit, number, percent, unit};

/// The models in the order of their making: style class and name.
const MODELS: [(&str, &str); 3] = [("start", "start"), ("before", "fitted"), ("after", "extended")];

/// The most important numbers beside the headline: of all signals, not of the one that gained most.
pub fn facts(findings: &Findings) -> Markup {
    let extended = extended(findings);
    let last = |signal: &Signal| {
        if extended { (signal.phi_after, signal.rms_after) } else { (signal.phi_fitted, signal.rms_fitted) }
    };
    let all = |value: &dyn Fn(&Signal) -> f64| -> Vec<f64> {
        findings.signals.iter().map(value).filter(|value| value.is_finite()).collect()
    };
    // Φ before and after are means over the same signals.
    let known: Vec<&Signal> = findings
        .signals
        .iter()
        .filter(|signal| signal.phi_before.is_finite() && last(signal).0.is_finite())
        .collect();
    let before = mean(known.iter().map(|signal| signal.phi_before));
    let after = mean(known.iter().map(|signal| last(signal).0));
    let falls = all(&|signal| 1.0 - (last(signal).1 / signal.rms_before).powi(2));
    let mut ratios = all(&|signal| last(signal).1 / signal.noise_floor);
    ratios.sort_by(f64::total_cmp);
    html! {
        @if !findings.signals.is_empty() {
            dl.facts {
                div {
                    dt { "Fit Φ, " (of_all(known.len())) }
                    dd { (fit(before, 2)) span.arrow { " → " } (fit(after, 2)) }
                }
                div { dt { "Error’s power" } dd { (fallen(mean(falls.iter().copied()))) } }
                @if let (Some(least), Some(most)) = (ratios.first(), ratios.last()) {
                    div {
                        dt { "Error, × noise floor" }
                        dd {
                            (multiple(*least))
                            @if multiple(*least) != multiple(*most) { span.arrow { " … " } (multiple(*most)) }
                        }
                    }
                }
                @if let Some(effect) = findings.effects.first() {
                    div { dt { "Held-out evidence" } dd { "t = " (number(effect.evidence.held_out_t)) } }
                }
            }
        }
    }
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    // Of nothing: not a number.
    if count > 0.0 { values.map(|value| value / count).sum() } else { f64::NAN }
}

fn of_all(signals: usize) -> String {
    if signals == 1 { "one signal".into() } else { format!("mean of {signals} signals") }
}

/// A fall as a change with its sign.
fn fallen(share: f64) -> String {
    match (percent(share.abs()), share) {
        (size, share) if share > 0.0 => format!("−{}", size.trim_start_matches(">\u{2009}")),
        (size, share) if share < 0.0 => format!("+{size}"),
        (size, _) => size,
    }
}

/// Table and waterfalls of all signals.
pub fn section(findings: &Findings) -> Markup {
    if findings.signals.is_empty() {
        return html! {};
    }
    let extended = extended(findings);
    let models = if extended { &MODELS[..] } else { &MODELS[..2] };
    let repeated = findings.signals.iter().any(|signal| signal.repeatability.is_some());
    html! {
        section {
            h2 { @if extended { "What it gained" } @else { "How well the model fits" } }
            p.note {
                "On held-out data. Φ = 1 − rms(error)/rms(measured): 1 is perfect. “Start” is the model as it came, "
                "“fitted” the same equations with fitted parameters"
                @if extended { ", “extended” the model with what was found" } "."
            }
            div.scroll { table {
                thead {
                    tr {
                        th rowspan="2" { "Signal" }
                        th.group colspan=(models.len()) { "Fit Φ" }
                        th.group colspan=(models.len()) { "rms error" }
                        th rowspan="2" {}
                        th.number rowspan="2" { "Noise floor" }
                        @if repeated { th.number rowspan="2" { "Repeatability" } }
                        th rowspan="2" { "Unit" }
                    }
                    tr { @for _ in 0..2 { @for model in models { th.number { (model.1) } } } }
                }
                tbody { @for signal in &findings.signals { (row(signal, models.len(), repeated)) } }
            } }
            h3 { "Where the error’s power went" }
            div.waterfalls { @for signal in findings.signals.iter().take(8) { (waterfall(signal, extended)) } }
            @if findings.signals.len() > 8 {
                details {
                    summary { "The other " (findings.signals.len() - 8) " signals" }
                    div.waterfalls { @for signal in &findings.signals[8..] { (waterfall(signal, extended)) } }
                }
            }
        }
    }
}

fn row(signal: &Signal, models: usize, repeated: bool) -> Markup {
    let phi = [signal.phi_before, signal.phi_fitted, signal.phi_after].map(|phi| fit(phi, 3));
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

/// How many times as large as noise an error is; of what is far above it, that it is.
fn multiple(ratio: f64) -> String {
    if ratio > 1000.0 { "> 1000".into() } else { digits(ratio, 2) }
}

/// Errors before, fitted and after as bars, with a mark at the noise floor.
fn bars(signal: &Signal, models: usize) -> Markup {
    let errors = [signal.rms_before, signal.rms_fitted, signal.rms_after];
    let errors: Vec<_> = errors.into_iter().zip(MODELS.map(|(class, _)| class)).take(models).collect();
    let largest = errors.iter().map(|(rms, _)| *rms).filter(|rms| rms.is_finite()).fold(0.0, f64::max);
    let length =
        |rms: f64| Some(110.0 * (rms / largest)).filter(|length| length.is_finite() && *length >= 0.0);
    html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 114 25" width="114" height="25" class="plot" {
            title { "rms error of each model; the line is the noise floor" }
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

/// One step of a waterfall: from and to which share of the starting model's error power.
struct Step {
    label: &'static str,
    class: &'static str,
    from: f64,
    to: f64,
}

/// How the error's power falls, from the starting model to the noise floor.
fn waterfall(signal: &Signal, extended: bool) -> Markup {
    let share = |rms: f64| (rms / signal.rms_before).powi(2);
    let (fitted, floor) = (share(signal.rms_fitted), share(signal.noise_floor));
    let after = if extended { share(signal.rms_after) } else { fitted };
    let floor = floor.min(after);
    let mut steps = vec![
        Step { label: "start", class: "start", from: 0.0, to: 1.0 },
        Step { label: "fitted", class: "before", from: fitted, to: 1.0 },
        Step { label: "added", class: "after", from: after, to: fitted },
        Step { label: "left over", class: "left", from: floor, to: after },
        Step { label: "noise", class: "noise", from: 0.0, to: floor },
    ];
    if !extended {
        steps.remove(2);
    }
    let ends = steps.iter().flat_map(|step| [step.from, step.to]);
    let top = ends.filter(|share| share.is_finite()).fold(1.0, f64::max);
    let y = |share: f64| 118.0 - 92.0 * (share / top);
    let known = |step: &Step| step.from.is_finite() && step.to.is_finite();
    html! {
        figure {
            figcaption { code { (signal.name) } }
            svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 266 140" role="img" class="plot" {
                title { "Power of the error of " (signal.name) ", start = 100 %" }
                line class="frame" x1="4" x2="262" y1="118" y2="118" {}
                @for (index, step) in steps.iter().enumerate() {
                    @let x = 8.0 + 52.0 * index as f64;
                    text x=(px(x + 20.0)) y="133" text-anchor="middle" { (step.label) }
                    @if known(step) {
                        @let (high, low) = (y(step.from.max(step.to)), y(step.from.min(step.to)));
                        rect class=(format!("bar {}", step.class)) x=(px(x)) y=(px(high)) width="40" height=(px((low - high).max(0.8))) {}
                        text class="value" x=(px(x + 20.0)) y=(px(high - 5.0)) text-anchor="middle" { (change(step)) }
                        @if steps.get(index + 1).is_some_and(known) {
                            @let level = y(if index == 0 { step.to } else { step.from });
                            line class="link" x1=(px(x)) x2=(px(x + 92.0)) y1=(px(level)) y2=(px(level)) {}
                        }
                    }
                }
            }
        }
    }
}

/// A step's size; changes by fit and extension with their sign.
fn change(step: &Step) -> String {
    let size = step.to - step.from;
    match step.class {
        "before" | "after" => fallen(size),
        _ => percent(size),
    }
}
