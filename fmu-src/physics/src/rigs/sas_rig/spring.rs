//! The spring between the two arms.

use strut_model::{Choice, Real, Variables};

/// With which levers the spring's force turns the arms.
#[derive(Choice, Clone, Copy, Debug, PartialEq)]
pub enum SpringLever {
    /// As Kogut eq. 13 prints it: r_s1 on the wheel arm, r_s2 on the body arm; not conservative
    Printed,
    /// r_s2 on both arms: the simplification of Kogut 3.1.1, a force perpendicular to r_s2, carried through
    Perpendicular,
    /// The distance of the spring from the pivot, which is the same for both arms
    Exact,
}

/// A spring between a point of each arm, where both arms turn about one axis, Kogut eq. 2 and 14.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Spring<R> {
    /// Spring rate (k_s = a_1 I/r_s2 with Table 1 and I = 1.37 kg.m2; printed 3.79e3)
    #[var(unit = N_PER_M, start = 528.57 * 1.37 / 0.191, min = 1.0)]
    pub stiffness: R,
    /// Length without load (l_s0)
    #[var(unit = M, start = 0.189, min = 1e-3)]
    pub free_length: R,
    /// Distance of the mount on the wheel arm from the pivot (r_s1)
    #[var(unit = M, start = 0.275, min = 1e-3)]
    pub wheel_arm_mount: R,
    /// Distance of the mount on the body arm from the pivot (r_s2)
    #[var(unit = M, start = 0.191, min = 1e-3)]
    pub body_arm_mount: R,
}

/// A spring that is held at an angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loaded<R> {
    /// How much shorter it is than without load (l_s).
    pub compression: R,
    /// The force with which it pushes its ends apart.
    pub force: R,
    /// The moment that presses the wheel arm down.
    pub on_wheel_arm: R,
    /// The moment that lifts the body arm.
    pub on_body_arm: R,
    /// By how much the moments on wheel arm and body arm fall with the angle.
    pub rates: [R; 2],
}

impl<R: Real> Spring<R> {
    /// The spring when the body arm stands at `angle` above the wheel arm (γ − α₁).
    ///
    /// Its energy is k l²/2 with ∂l/∂γ = −r_s1 r_s2 sin(γ − α₁)/length = −∂l/∂α₁, so the lever is that quotient
    /// for both arms: what the spring does to one arm it does to the other, the axis being one. Levers that
    /// differ make a moment out of nothing.
    #[inline]
    pub fn at(&self, angle: R, lever: SpringLever) -> Loaded<R> {
        let (r1, r2) = (self.wheel_arm_mount, self.body_arm_mount);
        let product = r1 * r2;
        let along = product * angle.cos();
        let length = (r1.squared() + r2.squared() - along * 2.0).sqrt();
        let distance = product * angle.sin() / length;
        let compression = self.free_length - length;
        let force = self.stiffness * compression;
        let stiffening = self.stiffness * distance;
        let (levers, rates) = match lever {
            SpringLever::Printed => ([r1, r2], [stiffening * r1, stiffening * r2]),
            SpringLever::Perpendicular => ([r2; 2], [stiffening * r2; 2]),
            SpringLever::Exact => {
                let turning = (along - distance.squared()) / length;
                ([distance; 2], [stiffening * distance - force * turning; 2])
            }
        };
        let [on_wheel_arm, on_body_arm] = levers.map(|lever| force * lever);
        Loaded { compression, force, on_wheel_arm, on_body_arm, rates }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use SpringLever::{Exact, Perpendicular, Printed};
    use proptest::prelude::*;

    const SPRING: Spring<f64> = Spring {
        stiffness: 528.57 * 1.37 / 0.191,
        free_length: 0.189,
        wheel_arm_mount: 0.275,
        body_arm_mount: 0.191,
    };

    #[test]
    fn it_carries_the_body_arm_at_the_angle_of_part_one() {
        assert!((SPRING.stiffness / 3.79e3 - 1.0).abs() < 1e-3);
        // Eq. 3 at x_1 = 0.57 rad: a_1 l_s = a_2 cos x_1, 18.59 against 18.58 with Table 1.
        let moment = SPRING.at(0.57, Printed).on_body_arm / 1.37;
        assert!((moment - 18.59).abs() < 5e-3 && (22.07 * 0.57_f64.cos() - 18.58).abs() < 5e-3, "{moment}");
    }

    #[test]
    fn the_printed_lever_of_the_wheel_arm_is_half_as_much_again_as_the_true_one() {
        // At rest, γ − α_1 = 0.548 rad; that of the body arm is 5 % off.
        let lever = |kind| {
            let loaded = SPRING.at(0.548, kind);
            (loaded.on_wheel_arm / loaded.force, loaded.on_body_arm / loaded.force)
        };
        let (_, exact) = lever(Exact);
        assert!((exact - 0.1827).abs() < 1e-4, "{exact}");
        assert_eq!(lever(Exact), (exact, exact));
        assert_eq!(lever(Perpendicular).0, lever(Perpendicular).1);
        let (wheel, body) = lever(Printed);
        assert!((wheel / exact - 1.505).abs() < 1e-3 && (body / exact - 1.046).abs() < 1e-3);
    }

    proptest! {
        #[test]
        fn with_exact_levers_the_moment_is_the_slope_of_the_energy(angle in 0.05..2.5_f64) {
            let energy = |angle: f64| 0.5 * SPRING.stiffness * SPRING.at(angle, Exact).compression.powi(2);
            let h = 1e-5;
            let slope = (energy(angle + h) - energy(angle - h)) / (2.0 * h);
            prop_assert!((SPRING.at(angle, Exact).on_body_arm + slope).abs() < 1e-6);
        }

        #[test]
        fn the_rates_are_the_slopes_of_the_moments(angle in 0.05..2.5_f64, kind in 0..3_usize) {
            let kind = [Printed, Perpendicular, Exact][kind];
            let h = 1e-5;
            let (before, after) = (SPRING.at(angle - h, kind), SPRING.at(angle + h, kind));
            let slope = |before: f64, after: f64| (after - before) / (2.0 * h);
            let [on_wheel, on_body] = SPRING.at(angle, kind).rates;
            prop_assert!((on_wheel + slope(before.on_wheel_arm, after.on_wheel_arm)).abs() < 1e-5);
            prop_assert!((on_body + slope(before.on_body_arm, after.on_body_arm)).abs() < 1e-5);
        }
    }
}
