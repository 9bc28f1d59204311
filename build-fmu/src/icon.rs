//! The icon of each kind of component.

use strut_model::Kind;
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, Transform,
};

/// Side length in pixels. Drawings are made on a grid of 128.
const SIZE: u32 = 256;
const SCALE: f32 = SIZE as f32 / 128.0;

/// The icon as a PNG file.
pub fn png(kind: Kind) -> Vec<u8> {
    let mut canvas = Canvas(Pixmap::new(SIZE, SIZE).expect("a size above zero"));
    canvas.fill(&rounded(6.0, 6.0, 116.0, 116.0, 24.0), background(kind));
    match kind {
        Kind::Rig => canvas.rig(),
        Kind::Actuator => canvas.actuator(),
        Kind::Controller => canvas.controller(),
        Kind::Road => canvas.road(),
        Kind::Source => canvas.source(),
        Kind::Sensor => canvas.sensor(),
        Kind::Other => canvas.other(),
    }
    canvas.0.encode_png().expect("memory is written without errors")
}

/// A colour for each kind, dark enough for white drawings.
pub fn background(kind: Kind) -> [u8; 3] {
    match kind {
        Kind::Rig => [0x1f, 0x4e, 0x79],
        Kind::Actuator => [0xa3, 0x3b, 0x20],
        Kind::Controller => [0x2d, 0x6a, 0x4f],
        Kind::Road => [0x4a, 0x4e, 0x69],
        Kind::Source => [0x7a, 0x5c, 0x14],
        Kind::Sensor => [0x7b, 0x4b, 0x94],
        Kind::Other => [0x37, 0x47, 0x4f],
    }
}

const WHITE: [u8; 3] = [0xff, 0xff, 0xff];

struct Canvas(Pixmap);

impl Canvas {
    fn fill(&mut self, path: &Path, color: [u8; 3]) {
        self.0.fill_path(path, &paint(color), FillRule::Winding, scale(), None);
    }

    fn line(&mut self, width: f32, points: &[(f32, f32)]) {
        let mut path = PathBuilder::new();
        path.move_to(points[0].0, points[0].1);
        points[1..].iter().for_each(|&(x, y)| path.line_to(x, y));
        self.stroke(width, path);
    }

    fn stroke(&mut self, width: f32, path: PathBuilder) {
        let stroke =
            Stroke { width, line_cap: LineCap::Round, line_join: LineJoin::Round, ..Stroke::default() };
        let path = path.finish().expect("a drawing has points");
        self.0.stroke_path(&path, &paint(WHITE), &stroke, scale(), None);
    }

    fn circle(&mut self, width: f32, (x, y): (f32, f32), radius: f32) {
        let mut path = PathBuilder::new();
        path.push_circle(x, y, radius);
        self.stroke(width, path);
    }

    fn arrow(&mut self, width: f32, from: (f32, f32), to: (f32, f32)) {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let length = dx.hypot(dy);
        let (ux, uy) = (dx / length * 10.0, dy / length * 10.0);
        self.line(width, &[from, to]);
        self.line(
            width,
            &[(to.0 - ux - uy * 0.8, to.1 - uy + ux * 0.8), to, (to.0 - ux + uy * 0.8, to.1 - uy - ux * 0.8)],
        );
    }

    /// A zigzag between two heights.
    fn spring(&mut self, x: f32, top: f32, bottom: f32) {
        let mut points = vec![(x, top), (x, top + 4.0)];
        let pitch = (bottom - top - 8.0) / 5.0;
        for turn in 0..5_u8 {
            let side = if turn % 2 == 0 { 9.0 } else { -9.0 };
            points.push((x + side, top + 4.0 + pitch * (f32::from(turn) + 0.5)));
        }
        points.extend([(x, bottom - 4.0), (x, bottom)]);
        self.line(3.5, &points);
    }

    /// Body on spring and damper, wheel on the ground.
    fn rig(&mut self) {
        self.fill(&rounded(30.0, 18.0, 68.0, 18.0, 5.0), WHITE);
        self.spring(46.0, 36.0, 76.0);
        self.line(3.5, &[(82.0, 36.0), (82.0, 57.0)]);
        self.line(3.5, &[(75.0, 57.0), (89.0, 57.0)]);
        self.line(3.5, &[(72.0, 49.0), (72.0, 65.0), (92.0, 65.0), (92.0, 49.0)]);
        self.line(3.5, &[(82.0, 65.0), (82.0, 76.0)]);
        self.line(5.0, &[(38.0, 76.0), (90.0, 76.0)]);
        self.circle(5.0, (64.0, 92.0), 13.0);
        self.line(4.0, &[(24.0, 108.0), (104.0, 108.0)]);
    }

    /// A cylinder with its rod and the force both ways.
    fn actuator(&mut self) {
        self.line(5.0, &[(40.0, 22.0), (88.0, 22.0)]);
        self.line(5.0, &[(64.0, 22.0), (64.0, 40.0)]);
        self.fill(&rounded(48.0, 40.0, 32.0, 38.0, 5.0), WHITE);
        self.line(7.0, &[(64.0, 78.0), (64.0, 106.0)]);
        self.line(5.0, &[(40.0, 106.0), (88.0, 106.0)]);
        self.arrow(5.0, (28.0, 60.0), (28.0, 36.0));
        self.arrow(5.0, (100.0, 60.0), (100.0, 36.0));
        self.arrow(5.0, (28.0, 68.0), (28.0, 92.0));
        self.arrow(5.0, (100.0, 68.0), (100.0, 92.0));
    }

    /// A feedback loop.
    fn controller(&mut self) {
        self.arrow(5.0, (16.0, 48.0), (32.0, 48.0));
        self.circle(5.0, (42.0, 48.0), 8.0);
        self.line(5.0, &[(50.0, 48.0), (60.0, 48.0)]);
        self.fill(&rounded(60.0, 32.0, 34.0, 32.0, 5.0), WHITE);
        self.line(5.0, &[(94.0, 48.0), (112.0, 48.0)]);
        self.line(5.0, &[(103.0, 48.0), (103.0, 92.0), (42.0, 92.0)]);
        self.arrow(5.0, (42.0, 92.0), (42.0, 60.0));
    }

    /// A wheel on its way over a profile.
    fn road(&mut self) {
        let height = |x: f32| 82.0 - 10.0 * ((x - 14.0) * std::f32::consts::TAU / 66.0).sin();
        let profile: Vec<(f32, f32)> = (14..=114_u8).map(|x| (f32::from(x), height(f32::from(x)))).collect();
        self.line(6.0, &profile);
        for x in (24..=108_u8).step_by(14) {
            let (x, y) = (f32::from(x), height(f32::from(x)) + 9.0);
            self.line(3.5, &[(x, y), (x - 6.0, y + 9.0)]);
        }
        // The first crest is a quarter of a wave in.
        self.circle(6.0, (30.5, height(30.5) - 21.0), 15.0);
        self.arrow(5.0, (58.0, 46.0), (98.0, 46.0));
    }

    /// One wave of a signal on its way out.
    fn source(&mut self) {
        let wave = |x: f32| 64.0 - 22.0 * ((x - 26.0) * std::f32::consts::TAU / 46.0).sin();
        self.circle(6.0, (49.0, 64.0), 34.0);
        let points: Vec<(f32, f32)> = (26..=72_u8).map(|x| (f32::from(x), wave(f32::from(x)))).collect();
        self.line(5.0, &points);
        self.arrow(5.0, (86.0, 64.0), (114.0, 64.0));
    }

    /// A dial.
    fn sensor(&mut self) {
        let mut arc = PathBuilder::new();
        let centre = (64.0, 78.0);
        let at = |radius: f32, degrees: f32| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            (centre.0 - radius * cos, centre.1 - radius * sin)
        };
        let start = at(44.0, 0.0);
        arc.move_to(start.0, start.1);
        (1..=60_u8).map(|step| at(44.0, f32::from(step) * 3.0)).for_each(|(x, y)| arc.line_to(x, y));
        self.stroke(6.0, arc);
        for degrees in [30.0, 60.0, 90.0, 120.0, 150.0] {
            self.line(4.0, &[at(34.0, degrees), at(39.0, degrees)]);
        }
        self.line(5.0, &[centre, at(30.0, 125.0)]);
        let mut hub = PathBuilder::new();
        hub.push_circle(centre.0, centre.1, 6.0);
        self.fill(&hub.finish().expect("a circle"), WHITE);
        self.line(5.0, &[(28.0, 98.0), (100.0, 98.0)]);
    }

    /// A block with ports.
    fn other(&mut self) {
        let outline = rounded(36.0, 36.0, 56.0, 56.0, 8.0);
        let stroke = Stroke { width: 6.0, ..Stroke::default() };
        self.0.stroke_path(&outline, &paint(WHITE), &stroke, scale(), None);
        for y in [52.0, 76.0] {
            self.arrow(5.0, (14.0, y), (32.0, y));
            self.arrow(5.0, (94.0, y), (113.0, y));
        }
    }
}

fn scale() -> Transform {
    Transform::from_scale(SCALE, SCALE)
}

fn paint([r, g, b]: [u8; 3]) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color(Color::from_rgba8(r, g, b, 0xff));
    paint.anti_alias = true;
    paint
}

/// A rectangle with round corners.
fn rounded(x: f32, y: f32, width: f32, height: f32, radius: f32) -> Path {
    let rect = Rect::from_xywh(x, y, width, height).expect("sides above zero");
    let (left, top, right, bottom) = (rect.left(), rect.top(), rect.right(), rect.bottom());
    let mut path = PathBuilder::new();
    path.move_to(left + radius, top);
    path.line_to(right - radius, top);
    path.quad_to(right, top, right, top + radius);
    path.line_to(right, bottom - radius);
    path.quad_to(right, bottom, right - radius, bottom);
    path.line_to(left + radius, bottom);
    path.quad_to(left, bottom, left, bottom - radius);
    path.line_to(left, top + radius);
    path.quad_to(left, top, left + radius, top);
    path.close();
    path.finish().expect("a rectangle has points")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_has_its_own_drawing() {
        let kinds = [
            Kind::Rig,
            Kind::Actuator,
            Kind::Controller,
            Kind::Road,
            Kind::Source,
            Kind::Sensor,
            Kind::Other,
        ];
        let icons: Vec<Vec<u8>> = kinds.into_iter().map(png).collect();
        for (index, icon) in icons.iter().enumerate() {
            assert!(icon.starts_with(b"\x89PNG") && icon.len() < 10_000, "{} bytes", icon.len());
            assert!(!icons[..index].contains(icon));
            assert_eq!(*icon, png(kinds[index]));
        }
    }
}
