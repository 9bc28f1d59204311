//! Errors over frequency: power, coherence with the inputs, whiteness.

use maud::{Markup, html};

use super::{HALF, density, folded};
use crate::report::findings::{Coherence, Periodogram, Pictures, Spectrum};
use crate::report::plot::{Axis, Plot};
use crate::report::words::digits;

/// Signals whose pictures are shown before the rest is folded away.
const OPEN: usize = 1;

/// All plots over frequency, signal by signal.
pub(super) fn frequencies(pictures: &Pictures, extended: bool) -> Markup {
    let signal = |spectrum: &Spectrum| {
        let coherences = pictures.coherences.iter().filter(|it| it.signal == spectrum.signal);
        let periodogram = pictures.periodograms.iter().find(|it| it.signal == spectrum.signal);
        html! {
            div.wide {
                h4 { code { (spectrum.signal) } }
                div.plots {
                    (power(spectrum, extended))
                    @if let Some(periodogram) = periodogram { (cumulative(periodogram, extended)) }
                    @for coherence in coherences { (driven(coherence, extended)) }
                }
            }
        }
    };
    html! {
        @if !pictures.spectra.is_empty() {
            h3 { "Over frequency" }
            ul.legend {
                li.measured { "measured signal" } li.before { "error, fitted" }
                @if extended { li.after { "error, extended" } }
            }
            ul.explained {
                @if !pictures.periodograms.is_empty() {
                    li {
                        strong { "Is it noise? " } "The cumulative power of white noise stays in the grey band. A step marks a \
                        frequency of the remaining error."
                    }
                }
                @if !pictures.coherences.is_empty() {
                    li {
                        strong { "Is it driven? " } "Above the dashed line, the remaining error follows from that input by a \
                        linear law. Below it, the error is noise or follows by a nonlinear law."
                    }
                }
            }
            (folded(&pictures.spectra, OPEN, "signals", signal))
        }
    }
}

/// The curves of both models; of one alone where nothing was added.
fn both<'a, T: ?Sized>(before: &'a T, after: &'a T, extended: bool) -> Vec<(&'static str, &'a T)> {
    let mut curves = vec![("before", before)];
    if extended {
        curves.push(("after", after));
    }
    curves
}

fn power(spectrum: &Spectrum, extended: bool) -> Markup {
    // The mean of a signal is not a vibration: frequency zero stays out of a logarithmic axis.
    let x = Axis::logarithmic("frequency / Hz", spectrum.frequency.iter().copied(), 0.0);
    let mut curves = vec![("measured", &spectrum.measured)];
    curves.extend(both(&spectrum.before, &spectrum.after, extended));
    let all = curves.iter().flat_map(|(_, values)| values.iter().copied());
    let title = format!("Power spectral density of {}", spectrum.signal);
    let mut plot = Plot::new(title, HALF, x, Axis::logarithmic(&density(&spectrum.unit), all, 0.05));
    for (class, values) in curves {
        plot = plot.curve(class, &spectrum.frequency, values);
    }
    html! { figure { figcaption { "Power of the error over frequency" } (plot.svg()) } }
}

/// How the error's power adds up over frequency.
fn cumulative(periodogram: &Periodogram, extended: bool) -> Markup {
    let frequency = &periodogram.frequency;
    let highest = frequency.last().copied().unwrap_or(f64::NAN);
    let x = Axis::tight("frequency / Hz", frequency.iter().copied().chain([0.0]), 6);
    let line = |offset: f64| frequency.iter().map(|it| it / highest + offset).collect::<Vec<_>>();
    let title = format!("Share of the power of the error of {} up to each frequency", periodogram.signal);
    let mut plot = Plot::new(title, HALF, x, Axis::tight("share", [0.0, 1.0], 5)).band(
        "white",
        frequency,
        &line(-periodogram.limit),
        &line(periodogram.limit),
    );
    for (class, values) in both(&periodogram.before, &periodogram.after, extended) {
        plot = plot.curve(class, frequency, values);
    }
    let distance = if extended { periodogram.distance_after } else { periodogram.distance_before };
    html! {
        figure {
            figcaption {
                "Is it noise? "
                @if distance <= periodogram.limit { "Yes, within the band" }
                @else { "No: distance " (digits(distance, 2)) ", limit " (digits(periodogram.limit, 2)) }
            }
            (plot.svg())
        }
    }
}

/// How much of the error follows from an input.
fn driven(coherence: &Coherence, extended: bool) -> Markup {
    let share = |values: &[Option<f64>]| -> Vec<f64> {
        values.iter().map(|value| value.unwrap_or(f64::NAN)).collect()
    };
    let (before, after) = (share(&coherence.before), share(&coherence.after));
    let known = coherence.frequency.iter().zip(&before).filter(|(_, share)| share.is_finite());
    let x = Axis::logarithmic("frequency / Hz", known.map(|(frequency, _)| *frequency), 0.0);
    let title = format!("Coherence of the error of {} with {}", coherence.signal, coherence.input);
    let mut plot = Plot::new(title, HALF, x, Axis::tight("coherence", [0.0, 1.0], 5)).level(coherence.limit);
    for (class, values) in both(&before, &after, extended) {
        plot = plot.curve(class, &coherence.frequency, values);
    }
    html! { figure { figcaption { "Is it driven by " code { (coherence.input) } "?" } (plot.svg()) } }
}
