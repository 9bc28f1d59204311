//! Small plots as SVG: axes, curves, bands and points. Colours come from the page's style sheet.

mod axis;
mod path;

pub use axis::Axis;
pub use path::px;

use maud::{Markup, html};

const LEFT: f64 = 54.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 24.0;
const BOTTOM: f64 = 40.0;

/// Points that a plot draws one by one; more would hide each other.
const POINTS: usize = 200;

/// Dots that a plot draws at most.
const DOTS: usize = 1500;

/// Shape of a point.
#[derive(Clone, Copy)]
pub enum Shape {
    /// A triangle that points upwards.
    Up,
    /// A triangle that points downwards.
    Down,
}

/// Where along the frame segments of the x axis are marked.
#[derive(Clone, Copy)]
pub enum Edge {
    /// Along its top.
    Top,
    /// Along its bottom.
    Bottom,
}

/// Thickness of such marks in pixels.
const MARK: f64 = 5.0;

/// A plot, built layer by layer from back to front.
pub struct Plot {
    title: String,
    width: f64,
    height: f64,
    x: Axis,
    y: Axis,
    layers: Vec<Markup>,
}

impl Plot {
    /// An empty plot of a size in pixels; screen readers read the title.
    pub fn new(title: String, (width, height): (f64, f64), x: Axis, y: Axis) -> Self {
        Self { title, width, height, x, y, layers: Vec::new() }
    }

    /// A curve in the colour of `class`.
    pub fn curve(mut self, class: &str, x: &[f64], y: &[f64]) -> Self {
        let d = path::curve(x.iter().zip(y).map(|(x, y)| self.point(*x, *y)));
        self.layers.push(html! { path class=(format!("curve {class}")) d=(d) {} });
        self
    }

    /// The area between two curves, where both and `x` are finite.
    pub fn band(mut self, class: &str, x: &[f64], low: &[f64], high: &[f64]) -> Self {
        let both = x.iter().zip(low.iter().zip(high)).map(|(x, (low, high))| {
            let ((px, low), (_, high)) = (self.point(*x, *low)?, self.point(*x, *high)?);
            Some((px, low, high))
        });
        let d = path::band(both);
        self.layers.push(html! { path class=(format!("band {class}")) d=(d) {} });
        self
    }

    /// Points; at most two hundred of them, evenly taken.
    pub fn points(mut self, class: &str, shape: Shape, x: &[f64], y: &[f64]) -> Self {
        let stride = x.len().div_ceil(POINTS).max(1);
        let d: String = x
            .iter()
            .zip(y)
            .step_by(stride)
            .filter_map(|(x, y)| self.point(*x, *y))
            .map(|(x, y)| match shape {
                Shape::Up => format!("M{} {}l3.6 6.4h-7.2z", px(x), px(y - 3.8)),
                Shape::Down => format!("M{} {}l3.6 -6.4h-7.2z", px(x), px(y + 3.8)),
            })
            .collect();
        self.layers.push(html! { path class=(format!("points {class}")) d=(d) {} });
        self
    }

    /// Small dots; at most fifteen hundred of them, evenly taken.
    pub fn dots(mut self, class: &str, x: &[f64], y: &[f64]) -> Self {
        let stride = x.len().min(y.len()).div_ceil(DOTS).max(1);
        let points = x.iter().zip(y).step_by(stride).filter_map(|(x, y)| self.point(*x, *y));
        let d: String = points.map(|(x, y)| format!("M{} {}h0", px(x), px(y))).collect();
        self.layers.push(html! { path class=(format!("dots {class}")) d=(d) {} });
        self
    }

    /// A segment of the x axis that is shown in another plot.
    pub fn window(mut self, from: f64, to: f64) -> Self {
        if let Some((x, width)) = self.segment(from, to) {
            self.layers.push(html! {
                rect class="window" x=(px(x)) y=(px(TOP)) width=(px(width)) height=(px(self.bottom() - TOP)) {}
            });
        }
        self
    }

    /// Marks at segments of the x axis.
    pub fn marks(mut self, class: &str, edge: Edge, segments: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let y = match edge {
            Edge::Top => TOP,
            Edge::Bottom => self.bottom() - MARK,
        };
        for (from, to) in segments {
            if let Some((x, width)) = self.segment(from, to) {
                // The shortest one stays visible.
                let width = px(width.max(1.5));
                self.layers.push(html! {
                    rect class=(format!("mark {class}")) x=(px(x)) y=(px(y)) width=(width) height=(px(MARK)) {}
                });
            }
        }
        self
    }

    /// Start and width of a segment of the x axis in pixels; none if it is out of sight.
    fn segment(&self, from: f64, to: f64) -> Option<(f64, f64)> {
        let (from, to) = (self.x.share(from)?, self.x.share(to)?);
        let (from, to) = (from.clamp(0.0, 1.0), to.clamp(0.0, 1.0));
        let inner = self.width - LEFT - RIGHT;
        (from < to).then_some((LEFT + inner * from, inner * (to - from)))
    }

    /// A level that values are compared to.
    pub fn level(mut self, y: f64) -> Self {
        if let Some(share) = self.y.share(y) {
            let y = px(self.bottom() - (self.bottom() - TOP) * share.clamp(-1.0, 2.0));
            let right = px(self.width - RIGHT);
            self.layers.push(html! { line class="level" x1=(px(LEFT)) x2=(right) y1=(y) y2=(y) {} });
        }
        self
    }

    /// The line y = 0, if it is in sight.
    pub fn zero(mut self) -> Self {
        if let Some(share) = self.y.share(0.0).filter(|share| (0.0..=1.0).contains(share)) {
            let y = px(self.bottom() - (self.bottom() - TOP) * share);
            let right = px(self.width - RIGHT);
            self.layers.push(html! { line class="zero" x1=(px(LEFT)) x2=(right) y1=(y) y2=(y) {} });
        }
        self
    }

    fn bottom(&self) -> f64 {
        self.height - BOTTOM
    }

    fn point(&self, x: f64, y: f64) -> Option<path::Point> {
        let (x, y) = (self.x.share(x)?, self.y.share(y)?);
        // A little outside of the frame is cut off there; far outside, viewers differ.
        let y = y.clamp(-1.0, 2.0);
        let seen = (-1e-6..=1.0 + 1e-6).contains(&x);
        let inner = (self.width - LEFT - RIGHT, self.bottom() - TOP);
        seen.then(|| (LEFT + inner.0 * x, self.bottom() - inner.1 * y))
    }

    /// The finished picture.
    pub fn svg(&self) -> Markup {
        let (width, height, bottom, right) = (self.width, self.height, self.bottom(), self.width - RIGHT);
        let x = |share: f64| px(LEFT + (right - LEFT) * share);
        let y = |share: f64| px(bottom - (bottom - TOP) * share);
        html! {
            svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {width} {height}")) role="img" class="plot" {
                title { (self.title) }
                @for (share, label) in &self.y.ticks {
                    line class="grid" x1=(px(LEFT)) x2=(px(right)) y1=(y(*share)) y2=(y(*share)) {}
                    text x=(px(LEFT - 6.0)) y=(y(*share)) dy="4" text-anchor="end" { (label) }
                }
                @for (share, label) in &self.x.ticks {
                    line class="grid" x1=(x(*share)) x2=(x(*share)) y1=(px(TOP)) y2=(px(bottom)) {}
                    text x=(x(*share)) y=(px(bottom + 16.0)) text-anchor="middle" { (label) }
                }
                svg x=(px(LEFT)) y=(px(TOP)) width=(px(right - LEFT)) height=(px(bottom - TOP))
                    viewBox=(format!("{LEFT} {TOP} {} {}", right - LEFT, bottom - TOP)) {
                    @for layer in &self.layers { (layer) }
                }
                rect class="frame" x=(px(LEFT)) y=(px(TOP)) width=(px(right - LEFT)) height=(px(bottom - TOP)) {}
                text class="label" x=(px(LEFT)) y=(px(TOP - 8.0)) { (self.y.label) }
                text class="label" x=(px(right)) y=(px(height - 5.0)) text-anchor="end" { (self.x.label) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_number_that_is_not_finite_reaches_the_picture() {
        let odd = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN, 0.0];
        for (x, y) in [
            (Axis::linear("x", odd, 5), Axis::linear("y", odd, 5)),
            (Axis::logarithmic("x", odd, 0.0), Axis::logarithmic("y", odd, 0.1)),
        ] {
            let plot =
                Plot::new("odd".into(), (300.0, 200.0), x, y).zero().window(f64::NAN, 1.0).level(f64::NAN);
            let plot = plot.marks("m", Edge::Top, [(f64::NAN, 1.0), (f64::MIN, f64::MAX), (2.0, 1.0)]);
            let plot = plot.curve("a", &odd, &odd).band("b", &odd, &odd, &odd);
            let text = plot.points("c", Shape::Up, &odd, &odd).dots("d", &odd, &odd).svg().into_string();
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        }
    }
}
