//! The spring that anyone measures of a strut: its own and, of what the clutter adds to it, all that a spring of the model can
//! follow over what the records to learn from cover.

use crate::car::Motion;
use crate::case::{Case, Plant, Value};
use crate::rig::{Rig, true_signal};
use crate::strut::Strut;

/// What comes to the strut's own spring.
pub(super) struct Measured([f64; 3]);

/// Rates of x, x² and x³ as the FMU calls them.
const RATES: [&str; 3] = ["strut.stiffness", "strut.spring.quadratic", "strut.spring.cubic"];

impl Measured {
    /// Of the force in N that the clutter adds over the strut's length, where a rig moves it so.
    pub(super) fn new(case: &Case, rig: &Rig, motions: &[Motion], added: impl Fn(f64) -> f64) -> Self {
        // A model with a curved spring takes cubes for that, one with a straight one for stiffness.
        let curved = case.effects.iter().any(|hidden| hidden.id == "08");
        let lengths: Vec<f64> = motions.iter().flat_map(|motion| lengths(rig, case.plant, motion)).collect();
        Self(nearest(if curved { 3 } else { 1 }, &lengths, added))
    }

    /// Has a strut whose spring follows it.
    pub(super) fn add_to(&self, strut: &mut Strut) {
        let rates = [&mut strut.stiffness, &mut strut.quadratic, &mut strut.cubic];
        rates.into_iter().zip(self.0).for_each(|(rate, more)| *rate += more);
    }

    /// Has the truth tell it.
    pub(super) fn tell<'a>(&self, values: impl Iterator<Item = &'a mut Value>) {
        for value in values {
            if let Some(power) = RATES.iter().position(|name| *name == value.name) {
                value.value += self.0[power];
            }
        }
    }
}

/// The strut's length over a motion, in m, less that at rest; nothing where there is no strut.
fn lengths(rig: &Rig, plant: Plant, motion: &Motion) -> Vec<f64> {
    let strut = &rig.car.strut;
    match plant {
        Plant::LinearQuarter | Plant::RegulatedQuarter | Plant::PublishedQuarter | Plant::ServoQuarter => {
            let deflections = true_signal(plant, motion, "suspension.deflection");
            deflections.into_iter().map(|x| strut.length(x)).collect()
        }
        // What moves is its lower end.
        Plant::StrutDyno | Plant::MrDyno => motion.road.iter().map(|height| strut.length(-height)).collect(),
        Plant::LinearDrive
        | Plant::GuidedMass
        | Plant::PumpDyno
        | Plant::SasRig
        | Plant::PneumaticCylinder => vec![],
    }
}

/// Coefficients of x, x² and x³ of the polynomial of a degree up to 3 that is nearest to a force in N (least squares) over
/// deflections x in m. It may have a constant, too; beyond its degree it has nothing.
fn nearest(degree: usize, deflections: &[f64], force: impl Fn(f64) -> f64) -> [f64; 3] {
    let largest = deflections.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    if largest == 0.0 {
        return [0.0; 3];
    }
    // Of deflections over the largest one, so that no power outweighs the others.
    let mut sums = [[0.0; 5]; 4];
    for x in deflections {
        let (share, force) = (x / largest, force(*x));
        let powers = [1.0, share, share.powi(2), share.powi(3)];
        for (row, power) in sums.iter_mut().zip(powers).take(degree + 1) {
            for (sum, other) in row.iter_mut().zip([powers[0], powers[1], powers[2], powers[3], force]) {
                *sum += power * other;
            }
        }
    }
    // Elimination; the matrix is positive definite, so that it needs no other order.
    for pivot in 0..=degree {
        for row in (0..=degree).filter(|row| *row != pivot) {
            let (own, share) = (sums[pivot], sums[row][pivot] / sums[pivot][pivot]);
            for (value, own) in sums[row].iter_mut().zip(own) {
                *value -= share * own;
            }
        }
    }
    let coefficient = |power: usize| {
        if power > degree { 0.0 } else { sums[power][4] / sums[power][power] / largest.powf(power as f64) }
    };
    [1, 2, 3].map(coefficient)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::case::Hidden;
    use crate::random::Random;
    use crate::rig::start;

    fn sine(amplitude: f64) -> Vec<f64> {
        (0..3600).map(|k| amplitude * (TAU * f64::from(k) / 3600.0).sin()).collect()
    }

    /// Of magnets' force F sin(2πx/p + φ) a straight line over x = A sin ωt keeps 2 F J₁(2πA/p) cos φ/A.
    #[test]
    fn magnets_count_where_their_period_is_long_and_not_where_it_is_short() {
        let (force, phase) = (3.0, 0.7_f64);
        let kept = |period: f64| {
            let strut = Strut { cogging: Some((force, period, phase)), ..Strut::default() };
            let slope = nearest(1, &sine(0.01), |x| strut.spring(x))[0];
            slope / (force * TAU / period * phase.cos())
        };
        assert!((kept(1.0) - 1.0).abs() < 1e-3, "{}", kept(1.0));
        assert!(kept(1e-3).abs() < 0.01, "{}", kept(1e-3));
        // J₁(1) = 0.440051 (Abramowitz and Stegun, table 9.1).
        assert!((kept(TAU * 0.01) - 2.0 * 0.440_051).abs() < 1e-5, "{}", kept(TAU * 0.01));
    }

    /// ¾ c A² of a sine, 3 c σ² of a normal distribution.
    #[test]
    fn a_cube_is_a_stiffness_for_who_knows_no_cubes() {
        let cube = |x: f64| 2e6 * x.powi(3);
        let found = nearest(1, &sine(0.02), cube);
        assert!((found[0] / (0.75 * 2e6 * 0.02 * 0.02) - 1.0).abs() < 1e-9, "{found:?}");
        assert_eq!(found[1..], [0.0, 0.0]);
        let mut random = Random::new(5, "test");
        let normal: Vec<f64> = (0..200_000).map(|_| 0.005 * random.normal()).collect();
        let found = nearest(1, &normal, cube);
        assert!((found[0] / (3.0 * 2e6 * 0.005 * 0.005) - 1.0).abs() < 0.02, "{found:?}");
    }

    #[test]
    fn who_knows_cubes_finds_the_polynomial_itself() {
        let law = |x: f64| 4.0 - 120.0 * x + 3e4 * x * x + 2e6 * x.powi(3);
        let found = nearest(3, &sine(0.02), law);
        for (found, due) in found.iter().zip([-120.0, 3e4, 2e6]) {
            assert!((found / due - 1.0).abs() < 1e-9, "{found} for {due}");
        }
        assert_eq!(nearest(1, &[0.0; 9], law), [0.0; 3]);
    }

    /// With a curved spring in the model the clutter's cube is its cube, and none of its stiffness.
    #[test]
    fn the_model_decides_what_the_clutter_is_taken_for() {
        let (plant, cube) = (Plant::StrutDyno, |x: f64| 2e6 * x.powi(3));
        let rig = Rig::new(plant, &start(plant));
        let motion = [Motion { road: sine(0.02), ..Motion::default() }];
        let told = |effects: &[&str]| {
            let hidden = effects.iter().map(|id| Hidden::new(id)).collect();
            let case = Case { plant, ..Case::standard("test", hidden, 1) };
            let mut values =
                RATES.map(|name| Value { name: name.into(), unit: String::new(), value: 10.0 }).to_vec();
            let measured = Measured::new(&case, &rig, &motion, cube);
            measured.tell(values.iter_mut());
            let mut strut = Strut { stiffness: 10.0, quadratic: 10.0, cubic: 10.0, ..Strut::default() };
            measured.add_to(&mut strut);
            let told: Vec<f64> = values.into_iter().map(|it| it.value).collect();
            assert_eq!(told, [strut.stiffness, strut.quadratic, strut.cubic]);
            [0, 1, 2].map(|power| (told[power] - 10.0).round())
        };
        assert_eq!(told(&["01"]), [600.0, 0.0, 0.0]);
        assert_eq!(told(&["01", "08"]), [0.0, 0.0, 2e6]);
    }
}
