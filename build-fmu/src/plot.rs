//! Line plots as SVG: one panel for each unit, one time axis.

use maud::{Markup, html};
use strut_model::Trajectory;

use crate::documentation::tables::printed;

/// Okabe and Ito's palette, told apart by colour-blind readers too; the yellow is left out on white.
const COLORS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000"];

const WIDTH: f64 = 860.0;
const LEFT: f64 = 84.0;
const RIGHT: f64 = 16.0;
const PANEL: f64 = 150.0;
const LEGEND: f64 = 26.0;
const GAP: f64 = 18.0;
const BOTTOM: f64 = 44.0;

struct Panel<'a> {
    unit: &'a str,
    signals: Vec<(&'a str, &'a [f64])>,
}

/// The signals of an experiment over time.
pub fn svg(trajectory: &Trajectory) -> Markup {
    let panels = panels(trajectory);
    let end = trajectory.time.last().copied().unwrap_or(1.0);
    let time = Axis::over(0.0, end, 10);
    let x = |t: f64| LEFT + (WIDTH - LEFT - RIGHT) * (t / end.max(f64::MIN_POSITIVE));
    let height = panels.len() as f64 * (LEGEND + PANEL + GAP) - GAP + BOTTOM;
    html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {WIDTH} {height}")) role="img" class="plot" {
            title { "Default experiment" }
            @for (index, panel) in panels.iter().enumerate() {
                (draw(panel, trajectory, index as f64 * (LEGEND + PANEL + GAP) + LEGEND, &time, &x))
            }
            @let base = height - BOTTOM;
            @for tick in &time.ticks {
                text x=(px(x(*tick))) y=(px(base + 17.0)) text-anchor="middle" { (time.label(*tick)) }
            }
            text x=(px((LEFT + WIDTH - RIGHT) / 2.0)) y=(px(base + 36.0)) text-anchor="middle" { "time / s" }
        }
    }
}

/// Signals of one unit share a panel, in order of appearance, as long as colours and legend have room.
fn panels(trajectory: &Trajectory) -> Vec<Panel<'_>> {
    let mut panels: Vec<Panel> = Vec::new();
    for (name, unit, values) in &trajectory.signals {
        let fits = |panel: &Panel| {
            let end = legend_start(panel, panel.signals.len()) + 25.0 + 6.9 * name.chars().count() as f64;
            panel.signals.len() < COLORS.len() && end < WIDTH - RIGHT
        };
        match panels.iter_mut().find(|panel| panel.unit == *unit && fits(panel)) {
            Some(panel) => panel.signals.push((name, values)),
            None => panels.push(Panel { unit, signals: vec![(name, values)] }),
        }
    }
    panels
}

fn draw(panel: &Panel, trajectory: &Trajectory, top: f64, time: &Axis, x: &impl Fn(f64) -> f64) -> Markup {
    let finite =
        panel.signals.iter().flat_map(|(_, values)| values.iter().copied()).filter(|value| value.is_finite());
    let (low, high) =
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
    // A constant gets room to lie in the middle of.
    let margin = if high > low { (high - low) * 0.06 } else { high.abs().max(1.0) * 0.5 };
    let axis = Axis::over(low - margin, high + margin, 5);
    let y = |value: f64| top + PANEL * (axis.high - value) / (axis.high - axis.low);
    let (right, bottom) = (WIDTH - RIGHT, top + PANEL);
    let unit = printed(panel.unit);
    html! {
        g {
            @for tick in &axis.ticks {
                line class="grid" x1=(LEFT) x2=(right) y1=(px(y(*tick))) y2=(px(y(*tick))) {}
                text x=(px(LEFT - 7.0)) y=(px(y(*tick) + 4.0)) text-anchor="end" { (axis.label(*tick)) }
            }
            @for tick in &time.ticks {
                line class="grid" x1=(px(x(*tick))) x2=(px(x(*tick))) y1=(px(top)) y2=(px(bottom)) {}
            }
            rect class="frame" x=(LEFT) y=(px(top)) width=(px(right - LEFT)) height=(px(PANEL)) {}
            text class="unit" transform=(format!("translate(18 {}) rotate(-90)", px(top + PANEL / 2.0))) text-anchor="middle" { (unit) }
            @for (index, (name, values)) in panel.signals.iter().enumerate() {
                path class="curve" stroke=(COLORS[index]) d=(path(&trajectory.time, values, x, &y)) {}
                @let start = legend_start(panel, index);
                line class="key" stroke=(COLORS[index]) x1=(px(start)) x2=(px(start + 20.0)) y1=(px(top - 9.0)) y2=(px(top - 9.0)) {}
                text x=(px(start + 25.0)) y=(px(top - 5.0)) { (name) }
            }
        }
    }
}

/// Where the key of a curve begins; letters are about seven wide.
fn legend_start(panel: &Panel, index: usize) -> f64 {
    let width = |name: &str| 43.0 + 6.9 * name.chars().count() as f64;
    LEFT + panel.signals[..index].iter().map(|(name, _)| width(name)).sum::<f64>()
}

/// A curve. Between two columns of pixels, only the extremes are drawn: ten thousand points say no more.
fn path(time: &[f64], values: &[f64], x: &impl Fn(f64) -> f64, y: &impl Fn(f64) -> f64) -> String {
    let mut path = String::new();
    let bucket = (time.len() / 800).max(1);
    for (times, values) in time.chunks(bucket).zip(values.chunks(bucket)) {
        let mut extremes = [0, values.len() - 1];
        for (index, value) in values.iter().enumerate() {
            if *value < values[extremes[0]] {
                extremes[0] = index;
            }
            if *value > values[extremes[1]] {
                extremes[1] = index;
            }
        }
        extremes.sort_unstable();
        for index in &extremes[usize::from(extremes[0] == extremes[1])..] {
            if values[*index].is_finite() {
                let command = if path.is_empty() { 'M' } else { 'L' };
                path.push_str(&format!("{command}{} {}", px(x(times[*index])), px(y(values[*index]))));
            }
        }
    }
    path
}

/// A tenth of a pixel is fine enough.
fn px(value: f64) -> String {
    let text = format!("{value:.1}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// An axis with ticks at round numbers.
struct Axis {
    low: f64,
    high: f64,
    step: f64,
    ticks: Vec<f64>,
}

impl Axis {
    fn over(low: f64, high: f64, about: usize) -> Self {
        let rough = ((high - low) / about as f64).max(f64::MIN_POSITIVE);
        let magnitude = 10_f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0]
            .map(|factor| factor * magnitude)
            .into_iter()
            .find(|step| *step >= rough * 0.999);
        let step = step.unwrap_or(rough);
        let first = (low / step - 1e-9).ceil();
        let last = (high / step + 1e-9).floor();
        let ticks =
            (0..=((last - first).max(0.0) as usize)).map(|index| (first + index as f64) * step).collect();
        Self { low, high, step, ticks }
    }

    fn label(&self, value: f64) -> String {
        let value = if value.abs() < self.step * 1e-6 { 0.0 } else { value };
        let largest = self.low.abs().max(self.high.abs());
        if !(1e-4..1e6).contains(&largest) && value != 0.0 {
            let text = format!("{value:.1e}");
            return text.replace(".0e", "e").replace('-', "−");
        }
        let decimals = (-self.step.log10().floor()).max(0.0) as usize;
        format!("{value:.decimals$}").replace('-', "−")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers() {
        let labels = |low, high, about| {
            let axis = Axis::over(low, high, about);
            axis.ticks.iter().map(|tick| axis.label(*tick)).collect::<Vec<_>>()
        };
        assert_eq!(labels(0.0, 10.0, 5), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(labels(-0.012, 0.031, 5), ["−0.01", "0.00", "0.01", "0.02", "0.03"]);
        assert_eq!(labels(0.0, 4.0e13, 4), ["0", "1e13", "2e13", "3e13", "4e13"]);
        assert_eq!(labels(0.0, 0.3, 3), ["0.0", "0.1", "0.2", "0.3"]);
    }

    #[test]
    fn a_long_signal_keeps_its_extremes() {
        let time: Vec<f64> = (0..100_000).map(f64::from).collect();
        let mut values = vec![0.0; time.len()];
        values[54_321] = 7.0;
        let path = path(&time, &values, &|t| t / 100.0, &|value| value);
        assert!(path.contains(" 7") && path.len() < 40_000, "{}", path.len());
    }

    #[test]
    fn signals_that_are_not_finite_or_constant_are_drawn_too() {
        let signals = vec![
            ("a".into(), "m".into(), vec![f64::NAN, f64::NAN]),
            ("b".into(), "N".into(), vec![3.0, 3.0]),
        ];
        let svg = svg(&Trajectory { time: vec![0.0, 1.0], signals }).into_string();
        assert!(svg.contains("</svg>") && !svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    }
}
