//! Paths of curves: between two columns of pixels, only the extremes are drawn.

use std::fmt::Write;

/// A point in pixels.
pub type Point = (f64, f64);

/// A tenth of a pixel is fine enough.
pub fn px(value: f64) -> String {
    let text = format!("{value:.1}");
    let text = text.strip_suffix(".0").unwrap_or(&text);
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// A curve within one column of pixels.
struct Column {
    index: f64,
    low: Point,
    high: Point,
    falls: bool,
}

impl Column {
    fn new(point: Point) -> Self {
        Self { index: point.0.floor(), low: point, high: point, falls: false }
    }

    fn take(&mut self, point: Point) {
        if point.1 < self.low.1 {
            self.low = point;
            self.falls = true;
        } else if point.1 > self.high.1 {
            self.high = point;
            self.falls = false;
        }
    }

    /// Draws the extremes in the order in which they came.
    fn draw(&self, path: &mut String, first: &mut bool) {
        let (one, two) = if self.falls { (self.high, self.low) } else { (self.low, self.high) };
        for (x, y) in [Some(one), (one != two).then_some(two)].into_iter().flatten() {
            let command = if std::mem::take(first) { 'M' } else { 'L' };
            // Writing to a string cannot fail.
            let _ = write!(path, "{command}{} {}", px(x), px(y));
        }
    }
}

/// A curve; it is broken where a point is missing.
pub fn curve(points: impl IntoIterator<Item = Option<Point>>) -> String {
    let mut path = String::new();
    let mut first = true;
    let mut column: Option<Column> = None;
    for point in points {
        match (point, &mut column) {
            (Some(point), Some(column)) if column.index == point.0.floor() => column.take(point),
            (point, column) => {
                if let Some(column) = column.as_ref() {
                    column.draw(&mut path, &mut first);
                }
                first |= point.is_none();
                *column = point.map(Column::new);
            }
        }
    }
    if let Some(column) = column {
        column.draw(&mut path, &mut first);
    }
    path
}

/// The area between two curves, given as x, lower and upper y in pixels; several where points are missing.
pub fn band(points: impl IntoIterator<Item = Option<(f64, f64, f64)>>) -> String {
    let mut path = String::new();
    let mut segment: Vec<(f64, f64, f64)> = Vec::new();
    for point in points.into_iter().chain([None]) {
        match (point, segment.last_mut()) {
            (Some((x, low, high)), Some(last)) if last.0.floor() == x.floor() => {
                last.1 = last.1.min(low);
                last.2 = last.2.max(high);
            }
            (Some(point), _) => segment.push(point),
            (None, _) => {
                let forth = segment.iter().map(|(x, low, _)| (x, low));
                let back = segment.iter().rev().map(|(x, _, high)| (x, high));
                for (index, (x, y)) in forth.chain(back).enumerate() {
                    let command = if index == 0 { 'M' } else { 'L' };
                    let _ = write!(path, "{command}{} {}", px(*x), px(*y));
                }
                if !segment.is_empty() {
                    path.push('Z');
                }
                segment.clear();
            }
        }
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_curve_keeps_its_extremes() {
        let spike = |index: i32| if index == 54_321 { 7.0 } else { 0.0 };
        let path = curve((0..100_000).map(|index| Some((f64::from(index) / 100.0, spike(index)))));
        assert!(path.contains(" 7") && path.len() < 16_000, "{}", path.len());
    }

    #[test]
    fn a_missing_point_breaks_the_curve_and_the_band() {
        let points = [Some((0.0, 1.0)), Some((1.0, 2.0)), None, Some((3.0, 1.0)), Some((4.0, 0.0))];
        assert_eq!(curve(points), "M0 1L1 2M3 1L4 0");
        let band = band(points.map(|point| point.map(|(x, y)| (x, y, y + 1.0))));
        assert_eq!(band, "M0 1L1 2L1 3L0 2ZM3 1L4 0L4 1L3 2Z");
    }

    #[test]
    fn extremes_within_a_column_come_in_their_order() {
        assert_eq!(curve([0.0, 5.0, -5.0, 1.0].map(|y| Some((0.5, y)))), "M0.5 5L0.5 -5");
        assert_eq!(curve([0.0, -5.0, 5.0, 1.0].map(|y| Some((0.5, y)))), "M0.5 -5L0.5 5");
    }
}
