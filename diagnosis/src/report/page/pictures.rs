//! The pictures: traces, binned scatter, curves, and the errors over frequency.

mod frequency;
mod parity;

use maud::{Markup, html};

use super::extended;
use crate::report::findings::{Binned, Curve, Findings, LARGEST, Mark, Trace};
use crate::report::plot::{Axis, Edge, Plot, Shape};
use crate::report::words::{digits, labelled, list, unit};

/// Width and height of a picture over the whole page, in pixels.
pub const WIDE: (f64, f64) = (1000.0, 250.0);
const STRIP: (f64, f64) = (1000.0, 150.0);
/// The same of one of two beside each other.
pub const HALF: (f64, f64) = (490.0, 300.0);

/// A longer trace than this, in seconds, gets a picture of a part.
const WHOLE: f64 = 6.0;
/// Length of that part in seconds.
const PART: f64 = 3.0;

/// Pictures that are shown before the rest is folded away.
const OPEN_TRACES: usize = 2;
const OPEN_PLOTS: usize = 6;

/// All pictures that the findings have data for.
pub fn section(findings: &Findings) -> Markup {
    let (pictures, extended) = (&findings.pictures, extended(findings));
    html! {
        @if !pictures.scatters.is_empty() {
            section {
                h2 { "Error over the motion" }
                p.note {
                    "Mean error of the model with fitted parameters in bins, with a band of two standard errors. \
                    A curve away from zero is a missing law. A difference between rising and falling is hysteresis or \
                    friction."
                }
                ul.legend { li.rising { "▲ rising" } li.falling { "▼ falling" } }
                (folded(&pictures.scatters, OPEN_PLOTS, "pairs", scatter))
            }
        }
        @if !pictures.traces.is_empty() {
            section {
                h2 { "Measured and simulated" }
                ul.legend { li.measured { "measured" } li.before { "fitted" } @if extended { li.after { "extended" } }
                    (marked(&pictures.traces))
                }
                (folded(&pictures.traces, OPEN_TRACES, "signals", |one| trace(one, extended)))
            }
        }
        @if !pictures.parity.is_empty() || !pictures.spectra.is_empty() {
            section {
                h2 { "Error analysis" }
                (parity::balances(&pictures.parity, extended))
                (frequency::frequencies(pictures, extended))
            }
        }
    }
}

fn folded<T>(all: &[T], open: usize, noun: &str, figure: impl Fn(&T) -> Markup) -> Markup {
    let open = if all.len() > open + 1 { open } else { all.len() };
    html! {
        div.plots { @for one in &all[..open] { (figure(one)) } }
        @if open < all.len() {
            details {
                summary { "The other " (all.len() - open) " " (noun) }
                div.plots { @for one in &all[open..] { (figure(one)) } }
            }
        }
    }
}

fn scatter(binned: &Binned) -> Markup {
    let value = |values: &[Option<f64>]| -> Vec<f64> {
        values.iter().map(|value| value.unwrap_or(f64::NAN)).collect()
    };
    let (rising, falling, sigma) = (value(&binned.rising), value(&binned.falling), value(&binned.two_sigma));
    let edge = |values: &[f64], sign: f64| -> Vec<f64> {
        // A bin without a standard error has a mean all the same.
        let width = |index: usize| sigma.get(index).copied().filter(|width| width.is_finite()).unwrap_or(0.0);
        values.iter().enumerate().map(|(index, value)| value + sign * width(index)).collect()
    };
    let curves = [("falling", Shape::Down, &falling), ("rising", Shape::Up, &rising)];
    let bands: Vec<(Vec<f64>, Vec<f64>)> =
        curves.iter().map(|(.., values)| (edge(values, -1.0), edge(values, 1.0))).collect();
    let all = bands.iter().flat_map(|(low, high)| low.iter().chain(high).copied());
    let x = Axis::linear(&labelled(&binned.variable, &binned.variable_unit), binned.x.iter().copied(), 6);
    let y = Axis::linear(unit_or_none(&binned.unit).as_str(), all.chain([0.0]), 5);
    let title = format!("{} over {}", binned.quantity, binned.variable);
    let mut plot = Plot::new(title.clone(), HALF, x, y).zero();
    for ((class, ..), (low, high)) in curves.iter().zip(&bands) {
        plot = plot.band(class, &binned.x, low, high);
    }
    for (class, shape, values) in curves {
        plot = plot.curve(class, &binned.x, values).points(class, shape, &binned.x, values);
    }
    html! { figure { figcaption { (title) } (plot.svg()) } }
}

/// Values on an axis need a word even if they have no unit.
pub fn unit_or_none(symbol: &str) -> String {
    let unit = unit(symbol);
    if unit.is_empty() { "–".into() } else { unit }
}

fn trace(trace: &Trace, extended: bool) -> Markup {
    let error = |simulated: &[f64]| -> Vec<f64> {
        trace.measured.iter().zip(simulated).map(|(measured, simulated)| measured - simulated).collect()
    };
    let (before, after) = (error(&trace.before), error(&trace.after));
    let (from, to) = part(&trace.time, &before);
    let within = |(time, value): (&f64, &f64)| (from <= *time && *time <= to).then_some(*value);
    let curves = [("measured", &trace.measured), ("before", &trace.before), ("after", &trace.after)];
    let curves = if extended { &curves[..] } else { &curves[..2] };
    let seen = curves.iter().flat_map(|(_, values)| trace.time.iter().zip(*values).filter_map(within));
    let unit = unit_or_none(&trace.unit);
    let time = Axis::tight("time / s", trace.time.iter().copied().filter(|t| (from..=to).contains(t)), 10);
    let mut signals = Plot::new(
        format!("{}, measured and simulated", trace.signal),
        WIDE,
        time,
        Axis::linear(&unit, seen, 5),
    );
    for (class, values) in curves {
        signals = signals.curve(class, &trace.time, values);
    }
    let (largest, active): (Vec<&Mark>, Vec<&Mark>) = trace.marks.iter().partition(|mark| is_largest(mark));
    let span = |marks: &[&Mark]| marks.iter().map(|mark| (mark.from, mark.to)).collect::<Vec<_>>();
    let (largest, active) = (span(&largest), span(&active));
    let signals = signals.marks("active", Edge::Bottom, active.iter().copied());
    let whole = Axis::tight("time / s", trace.time.iter().copied(), 10);
    let both = Axis::linear(&format!("error / {unit}"), before.iter().chain(&after).copied(), 3);
    let mut errors = Plot::new(format!("Error of {}", trace.signal), STRIP, whole, both).zero();
    let is_part = to - from < duration(&trace.time) * 0.999;
    if is_part {
        errors = errors.window(from, to);
    }
    let errors = errors.curve("before", &trace.time, &before);
    let errors = if extended { errors.curve("after", &trace.time, &after) } else { errors };
    let errors = errors.marks("largest", Edge::Top, largest).marks("active", Edge::Bottom, active);
    html! {
        figure.wide {
            figcaption {
                code { (trace.signal) }
                @if is_part {
                    " from " (seconds(from)) " to " (seconds(to)) " s, where the error of the fitted model is largest. \
                    The lower plot shows the error over the whole record."
                }
            }
            (signals.svg())
            (errors.svg())
        }
    }
}

fn is_largest(mark: &Mark) -> bool {
    mark.what == LARGEST
}

/// The legend of the marks.
fn marked(traces: &[Trace]) -> Markup {
    let marks = || traces.iter().flat_map(|trace| &trace.marks);
    let mut active: Vec<String> =
        marks().filter(|mark| !is_largest(mark)).map(|mark| mark.what.clone()).collect();
    active.sort();
    active.dedup();
    html! {
        @if marks().any(is_largest) { li.largest { "largest remaining errors" } }
        @if !active.is_empty() { li.active { (list(&active, "or")) } }
    }
}

/// A time to a tenth of a second.
fn seconds(time: f64) -> String {
    if time.abs() < 1e6 { format!("{time:.1}").replace('-', "−") } else { digits(time, 4) }
}

fn duration(time: &[f64]) -> f64 {
    match (time.first(), time.last()) {
        (Some(first), Some(last)) => last - first,
        _ => 0.0,
    }
}

/// The part of a long stretch of time in which the errors are largest; a short one as a whole.
fn part(time: &[f64], errors: &[f64]) -> (f64, f64) {
    let (Some(&first), Some(&last)) = (time.first(), time.last()) else { return (0.0, 0.0) };
    // Also taken if times are not finite.
    if !(duration(time) > WHOLE && duration(time).is_finite()) {
        return (first, last);
    }
    let parts = (duration(time) / PART).ceil().min(10_000.0);
    let length = duration(time) / parts;
    let mut power = vec![0.0; parts as usize];
    for (time, error) in time.iter().zip(errors) {
        let error = error.powi(2);
        if error.is_finite() {
            // Out of order times land at an end.
            let index = (((time - first) / length) as usize).min(power.len() - 1);
            power[index] += error;
        }
    }
    let largest = (0..power.len()).rev().max_by(|a, b| power[*a].total_cmp(&power[*b])).unwrap_or(0);
    let from = first + length * largest as f64;
    (from, (from + length).min(last))
}

/// An unmodelled curve and its band.
pub fn curve(curve: &Curve) -> Markup {
    let all = curve.y.iter().chain(&curve.low).chain(&curve.high).copied();
    let x = Axis::linear(&labelled(&curve.variable, &curve.variable_unit), curve.x.iter().copied(), 8);
    let y = Axis::linear(unit_or_none(&curve.unit).as_str(), all.chain([0.0]), 5);
    let plot =
        Plot::new(format!("Missing {} over {}", curve.quantity, curve.variable), (1000.0, 330.0), x, y)
            .zero();
    plot.band("after", &curve.x, &curve.low, &curve.high).curve("after", &curve.x, &curve.y).svg()
}

/// Unit of a power spectral density.
pub fn density(symbol: &str) -> String {
    let unit = unit(symbol);
    match unit.as_str() {
        "" => "1/Hz".to_owned(),
        plain if plain.chars().all(char::is_alphabetic) => format!("{plain}²/Hz"),
        composed => format!("({composed})²/Hz"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_trace_is_shown_where_its_error_is_largest() {
        let time: Vec<f64> = (0..6000).map(|index| f64::from(index) * 0.01).collect();
        let errors: Vec<f64> =
            time.iter().map(|t| if (33.0..34.0).contains(t) { 1.0 } else { 0.0 }).collect();
        let (from, to) = part(&time, &errors);
        assert!(from <= 33.0 && to >= 33.9 && to - from <= PART, "{from} … {to}");
    }
}
