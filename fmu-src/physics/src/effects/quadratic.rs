//! A spring whose rate grows with deflection.

use strut_model::Real;

/// A spring with a linear and a quadratic rate, TUM 4.3.2 and Fig. 16: `F = a c + b c²`.
///
/// The compression c counts from static equilibrium, so that a is the rate there. (TUM calls 152186 N/m
/// the linearised rate; with the measured a = 149693 N/m and b = 3.94e6 N/m² that is the rate at 0.3 mm,
/// whereas counted from the unloaded tyre the rate would be 199867 N/m: the polynomial is taken about the
/// static operating point.)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadratic<R> {
    /// Rate at static equilibrium (a).
    pub stiffness: R,
    /// Quadratic rate (b); zero makes the spring linear.
    pub quadratic: R,
}

impl<R: Real> Quadratic<R> {
    /// The force at a compression, less that at static equilibrium.
    #[inline]
    pub fn force(&self, compression: R) -> R {
        if self.quadratic.vanishes() {
            return compression * self.stiffness;
        }
        compression * (self.stiffness + self.quadratic * compression)
    }

    /// The compression nearest zero at which the force is `-load`.
    ///
    /// It is the root of `load + a c + b c² = 0`, written without cancellation, so that it holds for b = 0
    /// too. Where there is no root ([`reaches`](Self::reaches)) the result is finite and means nothing.
    #[inline]
    pub fn compression_at_relief(&self, load: R) -> R {
        let square = self.discriminant(load);
        // Not the root of a number below zero, nor of zero, whose derivative is infinite.
        let root = square.select(square, R::from(1.0)).sqrt();
        load * -2.0 / (self.stiffness + square.select(root, R::from(0.0)))
    }

    fn discriminant(&self, load: R) -> R {
        self.stiffness.squared() - self.quadratic * load * 4.0
    }
}

impl Quadratic<f64> {
    /// Whether the force ever falls to `-load`.
    pub fn reaches(&self, load: f64) -> bool {
        self.discriminant(load) > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_rate_of_152186_stands_a_third_of_a_millimetre_off_equilibrium() {
        let measured = Quadratic { stiffness: 149_693.0, quadratic: 3.94e6 };
        let rate = |c: f64| (measured.force(c + 1e-6) - measured.force(c - 1e-6)) / 2e-6;
        assert!((rate(0.316e-3) - 152_186.0).abs() < 5.0);
    }

    proptest! {
        #[test]
        fn relief_is_the_root_nearest_zero(
            stiffness in 1e3..3e5_f64,
            quadratic in -4e6..4e6_f64,
            load in 1.0..5e3_f64,
        ) {
            let spring = Quadratic { stiffness, quadratic };
            prop_assume!(spring.reaches(load));
            let c = spring.compression_at_relief(load);
            prop_assert!((spring.force(c) + load).abs() < 1e-9 * load);
            // Between equilibrium and the root the load is not relieved yet.
            prop_assert!(c < 0.0 && spring.force(0.5 * c) > -load);
        }

        #[test]
        fn without_quadratic_rate_it_is_linear(c in -0.1..0.1_f64, load in 1.0..5e3_f64) {
            let spring = Quadratic { stiffness: 1.5e5, quadratic: 0.0 };
            prop_assert_eq!(spring.force(c), c * 1.5e5);
            prop_assert_eq!(spring.compression_at_relief(load), -load / 1.5e5);
        }
    }

    #[test]
    fn a_parabola_that_turns_too_early_is_told() {
        let spring = Quadratic { stiffness: 1e5, quadratic: 4e6 };
        assert!(!spring.reaches(1e3));
        assert!(spring.compression_at_relief(1e3).is_finite());
    }
}
