//! The missing signal: where, over time, over the motion there, over frequency.

use maud::{Markup, html};

use super::pictures::{HALF, WIDE, density};
use crate::report::findings::{Findings, Missing};
use crate::report::plot::{Axis, Plot};
use crate::report::words::{digits, labelled, list, place};
use crate::signal::spectral::power_spectrum;

/// Half the width of a 95 % interval in standard deviations.
const NORMAL: f64 = 1.96;
/// Rows of the ranking.
const PLACES: usize = 5;
/// Samples that a spectrum needs.
const FEW: usize = 64;
/// Largest deviation of a step from the mean step that a spectrum allows for.
const UNEVEN: f64 = 0.01;

/// The missing signal, if there is one.
pub fn section(findings: &Findings) -> Markup {
    let Some(missing) = findings.missing.as_ref().filter(|it| !it.place.is_empty()) else { return html! {} };
    // A torque is missing where something turns.
    let [moved, moving] = if missing.unit == "N.m" { ["rad", "rad/s"] } else { ["m", "m/s"] };
    html! {
        section {
            h2 { "The missing signal" }
            p {
                "The likeliest place of the missing signal: " strong { (missing.place) }
                @if !missing.equivalent_places.is_empty() { " (these records cannot tell it from " (list(&missing.equivalent_places, "or")) ")" }
                "."
            }
            p.note { "The estimate uses the starting model, before any effect is added. The band covers 95 %." }
            (over_time(missing))
            div.plots {
                (over_motion(missing, "deflection", moved, &missing.deflection))
                (over_motion(missing, "velocity", moving, &missing.velocity))
                (over_frequency(missing))
                (ranking(missing))
            }
        }
    }
}

/// `missing signal / N`.
fn what(missing: &Missing) -> String {
    labelled("missing signal", &missing.unit)
}

fn over_time(missing: &Missing) -> Markup {
    let edge = |sign: f64| -> Vec<f64> {
        missing
            .value
            .iter()
            .zip(&missing.deviation)
            .map(|(value, deviation)| value + sign * NORMAL * deviation)
            .collect()
    };
    let (low, high) = (edge(-1.0), edge(1.0));
    let x = Axis::tight("time / s", missing.time.iter().copied(), 10);
    let shown = missing.value.iter().chain(&low).chain(&high).copied();
    let y = Axis::linear(&what(missing), shown.chain([0.0]), 5);
    let title = format!("Missing signal {} over time", place(&missing.place));
    let plot = Plot::new(title, WIDE, x, y).zero();
    let plot = plot.band("after", &missing.time, &low, &high).curve("after", &missing.time, &missing.value);
    html! {
        @if !missing.time.is_empty() {
            figure.wide { figcaption { "Over time, first estimation record" } (plot.svg()) }
        }
    }
}

fn over_motion(missing: &Missing, variable: &str, unit: &str, values: &[f64]) -> Markup {
    let x = Axis::linear(&labelled(variable, unit), values.iter().copied(), 6);
    let y = Axis::linear(&what(missing), missing.value.iter().copied().chain([0.0]), 5);
    let title = format!("Missing signal over the {variable} {}", place(&missing.place));
    let plot = Plot::new(title, HALF, x, y).zero().dots("after", values, &missing.value);
    html! {
        @if !values.is_empty() { figure { figcaption { "Over the " (variable) } (plot.svg()) } }
    }
}

fn over_frequency(missing: &Missing) -> Markup {
    let Some((frequency, power)) = spectrum(&missing.time, &missing.value) else { return html! {} };
    let x = Axis::logarithmic("frequency / Hz", frequency.iter().copied(), 0.0);
    let y = Axis::logarithmic(&density(&missing.unit), power.iter().copied(), 0.05);
    let title = format!("Power spectral density of the missing signal {}", place(&missing.place));
    let plot = Plot::new(title, HALF, x, y).curve("after", &frequency, &power);
    html! { figure { figcaption { "Over frequency" } (plot.svg()) } }
}

/// Frequencies in hertz and one-sided power spectral density of a signal with even steps.
fn spectrum(time: &[f64], value: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
    let (first, last) = (time.first()?, time.last()?);
    if time.len() < FEW || time.len() != value.len() {
        return None;
    }
    let step = (last - first) / (time.len() - 1) as f64;
    let even = time.windows(2).all(|pair| (pair[1] - pair[0] - step).abs() < UNEVEN * step);
    (step > 0.0 && step.is_finite() && even).then(|| power_spectrum(value, step))
}

/// The likeliest places.
fn ranking(missing: &Missing) -> Markup {
    let best = missing.places.first().map_or(f64::NAN, |it| it.log_likelihood);
    html! {
        @if !missing.places.is_empty() {
            figure {
                figcaption { "Ranking of the places" }
                table.tight {
                    thead { tr { th { "Place" } th.number { "log-likelihood" } th.number { "behind the first" } } }
                    tbody {
                        @for it in missing.places.iter().take(PLACES) {
                            tr {
                                td { (it.place) }
                                td.number { (digits(it.log_likelihood, 4)) }
                                td.number { (digits(best - it.log_likelihood, 3)) }
                            }
                        }
                    }
                }
                p.small {
                    "A place 5 behind the first is 150 times less likely. The reference is a small signal at every place."
                    @if missing.places.len() > PLACES { " Further places: " (missing.places.len() - PLACES) "." }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn the_spectrum_of_a_sine_peaks_at_its_frequency_and_holds_its_power() {
        let time: Vec<f64> = (0..1500).map(|index| f64::from(index) * 0.01).collect();
        let value: Vec<f64> = time.iter().map(|t| 3.0 * (TAU * 7.0 * t).sin()).collect();
        let (frequency, power) = spectrum(&time, &value).unwrap();
        let peak = (0..power.len()).max_by(|a, b| power[*a].total_cmp(&power[*b])).unwrap();
        assert!((frequency[peak] - 7.0).abs() < 0.2, "{}", frequency[peak]);
        let total: f64 = power.iter().sum::<f64>() * (frequency[1] - frequency[0]);
        assert!((total - 4.5).abs() < 0.2, "{total}");
    }

    #[test]
    fn uneven_or_few_samples_have_no_spectrum() {
        let mut time: Vec<f64> = (0..200).map(f64::from).collect();
        let value = vec![1.0; 200];
        assert!(spectrum(&time, &value).is_some());
        assert!(spectrum(&time[..20], &value[..20]).is_none() && spectrum(&time, &value[..100]).is_none());
        time[100] += 0.5;
        assert!(spectrum(&time, &value).is_none());
        time[100] = f64::NAN;
        assert!(spectrum(&time, &value).is_none() && spectrum(&[], &[]).is_none());
    }
}
