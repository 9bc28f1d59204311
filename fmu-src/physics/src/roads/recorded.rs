//! Measured profiles from a file.

use std::path::Path;

use strut_model::Real;

use crate::recording::{self, Header};

/// A measured profile between whose points a monotone cubic leads (PCHIP: F. N. Fritsch, J. Butland, A method
/// for constructing local monotone piecewise cubic interpolants, SIAM J. Sci. Stat. Comput. 5 (1984)): the
/// velocity is continuous and nothing overshoots the measured points.
///
/// Before the first and after the last point the height is held.
#[derive(Clone, Debug, PartialEq)]
pub struct Recorded {
    points: Vec<Point>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Point {
    time: f64,
    position: f64,
    velocity: f64,
}

/// What the first line of the file says.
const HEADER: Header =
    Header { what: "profile", columns: "time [s], position [m]", is_second: |name| name == "position [m]" };

impl Recorded {
    /// Reads a file of the FMU's resources, or one with an absolute path.
    ///
    /// # Errors
    /// A sentence with file and line.
    pub fn read(file: &str, resources: Option<&Path>) -> Result<Self, String> {
        recording::read(file, resources, HEADER).map(Self::of)
    }

    /// Reads the text of a file.
    ///
    /// # Errors
    /// A sentence with the line.
    pub fn parse(text: &str) -> Result<Self, String> {
        recording::parse(text, HEADER).map(Self::of)
    }

    fn of(rows: Vec<[f64; 2]>) -> Self {
        let point = |[time, position]: [f64; 2]| Point { time, position, velocity: 0.0 };
        let mut points: Vec<Point> = rows.into_iter().map(point).collect();
        set_velocities(&mut points);
        Self { points }
    }

    /// Height and velocity.
    pub(super) fn at<R: Real>(&self, time: R) -> [R; 2] {
        time.lookup(|time| {
            let [position, velocity, acceleration] = self.motion(time);
            ([position, velocity], [velocity, acceleration])
        })
    }

    fn motion(&self, time: f64) -> [f64; 3] {
        let after = self.points.partition_point(|point| point.time <= time);
        match (after.checked_sub(1).map(|before| self.points[before]), self.points.get(after)) {
            (None, Some(first)) => [first.position, 0.0, 0.0],
            (Some(a), Some(b)) => cubic(a, *b, time - a.time),
            (Some(last), None) => [last.position, 0.0, 0.0],
            (None, None) => [0.0; 3],
        }
    }
}

/// The cubic between two points with given velocities, `x` after the first one.
fn cubic(a: Point, b: Point, x: f64) -> [f64; 3] {
    let h = b.time - a.time;
    let slope = (b.position - a.position) / h;
    let c = (3.0 * slope - 2.0 * a.velocity - b.velocity) / h;
    let d = (a.velocity + b.velocity - 2.0 * slope) / (h * h);
    [
        a.position + x * (a.velocity + x * (c + x * d)),
        a.velocity + x * (2.0 * c + x * 3.0 * d),
        2.0 * c + 6.0 * d * x,
    ]
}

/// Velocities at the points: the weighted harmonic mean of the slopes on both sides, zero at an extremum.
fn set_velocities(points: &mut [Point]) {
    let steps: Vec<f64> = points.windows(2).map(|pair| pair[1].time - pair[0].time).collect();
    let slopes: Vec<f64> = points
        .windows(2)
        .zip(&steps)
        .map(|(pair, step)| (pair[1].position - pair[0].position) / step)
        .collect();
    let last = slopes.len() - 1;
    for i in 1..=last {
        let (before, after) = (slopes[i - 1], slopes[i]);
        if before * after > 0.0 {
            let (w1, w2) = (2.0 * steps[i] + steps[i - 1], steps[i] + 2.0 * steps[i - 1]);
            points[i].velocity = (w1 + w2) / (w1 / before + w2 / after);
        }
    }
    let neighbour = |i: usize| i.min(last);
    points[0].velocity = end_velocity(steps[0], steps[neighbour(1)], slopes[0], slopes[neighbour(1)]);
    let inner = last.saturating_sub(1);
    points[last + 1].velocity = end_velocity(steps[last], steps[inner], slopes[last], slopes[inner]);
}

/// At an end: the parabola through three points, held back where it would not be monotone.
fn end_velocity(step: f64, next_step: f64, slope: f64, next_slope: f64) -> f64 {
    let parabola = ((2.0 * step + next_step) * slope - step * next_slope) / (step + next_step);
    if parabola * slope <= 0.0 {
        0.0
    } else if slope * next_slope <= 0.0 && parabola.abs() > 3.0 * slope.abs() {
        3.0 * slope
    } else {
        parabola
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const HEAD: &str = "time [s], position [m]\n";

    fn profile(rows: &str) -> Recorded {
        Recorded::parse(&format!("{HEAD}{rows}")).unwrap()
    }

    /// Time, value and derivative by scipy.interpolate.PchipInterpolator.
    const WITH_EXTREMUM: [[f64; 3]; 4] = [
        [0.4, 0.18742857142857147, 0.8914285714285715],
        [1.2, 1.827428571428571, 5.554285714285713],
        [2.0, 2.8703703703703707, -0.4444444444444444],
        [3.3, 2.5, 0.0],
    ];
    const GROWING: [[f64; 3]; 3] = [
        [0.4, 0.42438709677419356, 1.0312903225806451],
        [1.2, 1.1624159231297189, 0.7583905284831848],
        [3.3, 2.948643617021276, 1.8029255319148934],
    ];

    #[test]
    fn it_agrees_with_scipys_pchip() {
        let check = |rows: &str, expected: &[[f64; 3]]| {
            for [time, value, rate] in expected {
                let [z, v, _] = profile(rows).motion(*time);
                assert!((z - value).abs() < 1e-14 && (v - rate).abs() < 1e-13, "{time}: {z} {v}");
            }
        };
        check("0,0\n1,1\n1.5,3\n3,2.5\n4,2.5\n", &WITH_EXTREMUM);
        check("0,0\n1,1\n3,2.5\n4,4.5\n", &GROWING);
    }

    proptest! {
        #[test]
        fn nothing_overshoots_and_the_velocity_is_the_rate(
            heights in prop::collection::vec(-0.1..0.1_f64, 3..12), at in 0.0..1.0_f64) {
            let rows: String = heights.iter().enumerate().map(|(i, z)| format!("{},{z}\n", i as f64 * 0.1)).collect();
            let recorded = profile(&rows);
            let time = at * 0.1 * (heights.len() - 1) as f64;
            let i = ((time / 0.1) as usize).min(heights.len() - 2);
            let (low, high) = (heights[i].min(heights[i + 1]), heights[i].max(heights[i + 1]));
            let [z, v, _] = recorded.motion(time);
            prop_assert!(z >= low - 1e-12 && z <= high + 1e-12);
            let h = 1e-7;
            prop_assume!((time / 0.1).fract() > 1e-4 && (time / 0.1).fract() < 1.0 - 1e-4);
            let difference = (recorded.motion(time + h)[0] - recorded.motion(time - h)[0]) / (2.0 * h);
            prop_assert!((v - difference).abs() < 1e-5, "{v} {difference}");
        }
    }

    #[test]
    fn outside_the_record_the_height_is_held() {
        let recorded = profile("1,0.5\n2,0.7\n");
        assert_eq!((recorded.motion(0.0), recorded.motion(3.0)), ([0.5, 0.0, 0.0], [0.7, 0.0, 0.0]));
        assert!(
            (recorded.motion(1.5)[0] - 0.6).abs() < 1e-15 && (recorded.motion(1.5)[1] - 0.2).abs() < 1e-14
        );
    }

    #[test]
    fn mistakes_are_named_with_their_line() {
        for (text, part) in [
            ("t, z\n0,0\n", "line 1: expected the header"),
            (&format!("{HEAD}0,0\n1,x\n"), "line 3: `x` is not a finite number"),
            (&format!("{HEAD}0,0\n1,NaN\n"), "line 3: `NaN` is not a finite number"),
            (&format!("{HEAD}0,0\n\n0,1\n"), "line 4: time 0 s does not come after 0 s"),
            (&format!("{HEAD}0,0,0\n"), "line 2: expected two numbers, found 3 fields"),
            (&format!("{HEAD}0,0\n"), "1 rows of numbers"),
        ] {
            let error = Recorded::parse(text).unwrap_err();
            assert!(error.contains(part), "{error}");
        }
        let folder = tempfile::tempdir().unwrap();
        let error = Recorded::read("none.csv", Some(folder.path())).unwrap_err();
        assert!(error.contains("none.csv cannot be read"), "{error}");
        std::fs::write(folder.path().join("bad.csv"), format!("{HEAD}0;0\n")).unwrap();
        let error = Recorded::read("bad.csv", Some(folder.path())).unwrap_err();
        assert!(error.contains("bad.csv: line 2"), "{error}");
        #[cfg(unix)]
        for endless in ["/dev/zero", "/"] {
            let error = Recorded::read(endless, Some(folder.path())).unwrap_err();
            assert!(error.contains("cannot be read: it is no file"), "{error}");
        }
        assert!(Recorded::read("bad.csv", None).unwrap_err().contains("no resource folder"));
    }
}
