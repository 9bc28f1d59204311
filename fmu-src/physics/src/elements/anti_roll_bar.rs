//! A torsion bar between the wheels of an axle.

use strut_model::{Real, Variables};

/// Anti-roll bar: it resists the difference of both wheels' deflections, and nothing else.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct AntiRollBar<R> {
    /// Force at either wheel over the difference of both deflections; zero: there is none
    #[var(unit = N_PER_M, start = 0.0, min = 0.0)]
    pub stiffness: R,
}

impl<R: Real> AntiRollBar<R> {
    /// The forces that push body and wheel apart on the left and on the right, added to others.
    #[inline]
    pub fn added_to(&self, [left, right]: [R; 2], deflections: impl FnOnce() -> [R; 2]) -> [R; 2] {
        if self.stiffness.vanishes() {
            return [left, right];
        }
        let [left_deflection, right_deflection] = deflections();
        let force = self.stiffness * (left_deflection - right_deflection);
        [left - force, right + force]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const BAR: AntiRollBar<f64> = AntiRollBar { stiffness: 2e4 };

    #[test]
    fn a_body_that_leans_left_is_held_on_the_left() {
        assert_eq!(BAR.added_to([5.0, 7.0], || [-0.01, 0.02]), [605.0, -593.0]);
    }

    proptest! {
        #[test]
        fn it_is_a_spring_without_losses(left in -0.1..0.1_f64, right in -0.1..0.1_f64) {
            // Minus the gradient of k (δ_l − δ_r)²/2.
            let energy = |left: f64, right: f64| 0.5 * 2e4 * (left - right).powi(2);
            let (h, [on_left, on_right]) = (1e-6, BAR.added_to([0.0; 2], || [left, right]));
            let slope = [
                (energy(left + h, right) - energy(left - h, right)) / (2.0 * h),
                (energy(left, right + h) - energy(left, right - h)) / (2.0 * h),
            ];
            prop_assert!((on_left + slope[0]).abs() < 1e-4 && (on_right + slope[1]).abs() < 1e-4);
        }

        #[test]
        fn without_stiffness_and_in_heave_it_is_absent(deflection in -0.1..0.1_f64) {
            let none = AntiRollBar { stiffness: 0.0 };
            prop_assert_eq!(none.added_to([5.0, 7.0], || [deflection, 0.0]), [5.0, 7.0]);
            prop_assert_eq!(BAR.added_to([5.0, 7.0], || [deflection; 2]), [5.0, 7.0]);
        }
    }
}
