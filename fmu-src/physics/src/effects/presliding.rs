//! Friction that builds up with the way after each reversal.

use strut_model::{Real, Variables};

use super::backlash::within;

/// Dahl's friction: a force that follows its limit as a spring would at first (Dahl 1968; docs/effects.md, 03).
///
/// `f' = σ v g(1 − sgn(v) f/F)` with `stiffness` σ, the limit `force` F and `g(u) = |u|ⁿ sgn(u)`. With the exponent
/// n = 1 it nears the limit over the way F/σ, with n < 1 sooner, with n > 1 later. What a step of an integration
/// carries beyond the limit comes back, since g changes its sign there.
///
/// For n ≠ 1 g is rounded within about 1 % of the limit, `g(u) = u ((u² + δ²)/(1 + δ²))^((n−1)/2)` with δ = 0.01, so
/// that its slope is finite for n < 1. It grows and goes through g(0) = 0 and g(1) = 1, which makes the friction passive
/// for every n: `f v − (f²/2σ)' = f v (1 − g(1 − sgn(v) f/F)) ≥ 0`.
///
/// Behind a backlash of b to each side (03b) the spring transmits nothing until its backlash is gone: the state y is what the
/// spring would have without backlash, `y' = σ v g(1 − sgn(v) f/F)`, and the friction is `f = dz(y, σ b)`. After a reversal it
/// falls to zero, rests there over the way 2 b, and builds up on the other side.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Presliding<R> {
    /// Limit of the friction (F); zero switches it off
    #[var(unit = N, start = 0.0, min = 0.0)]
    pub force: R,
    /// Rate with which it builds up after a reversal (σ)
    #[var(unit = N_PER_M, start = 1e5, min = 1.0)]
    pub stiffness: R,
    /// Exponent of the approach to the limit (n)
    #[var(unit = ONE, start = 1.0, min = 0.1, max = 5.0)]
    pub exponent: R,
    /// Half the backlash behind which it acts (b)
    #[var(unit = M, start = 0.0, min = 0.0)]
    pub gap: R,
}

/// What presliding friction remembers.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct PreslidingState<R> {
    /// Friction force, as it would be without backlash (y)
    #[var(unit = N, nominal = 10.0)]
    pub friction: R,
}

/// δ², over which g is rounded.
const ROUNDING: f64 = 1e-4;

impl<R: Real> Presliding<R> {
    /// The force that resists, and the state's rate.
    #[inline]
    pub fn force(&self, state: PreslidingState<R>, velocity: R) -> (R, PreslidingState<R>) {
        let zero = R::from(0.0);
        if self.force.vanishes() {
            return (zero, PreslidingState { friction: zero });
        }
        let mut friction = state.friction;
        if !self.gap.vanishes() {
            friction = friction - within(friction, self.stiffness * self.gap);
        }
        // While it is switched off but being varied there is nothing to divide by.
        let share = friction / self.force.select(self.force, R::from(1.0));
        let one = R::from(1.0);
        let approach = velocity.select(self.approach(one - share), self.approach(one + share));
        (
            self.force.select(friction, zero),
            PreslidingState { friction: self.force.select(self.stiffness * velocity * approach, zero) },
        )
    }

    /// g(u).
    #[inline]
    fn approach(&self, u: R) -> R {
        let beyond_linear = self.exponent - 1.0;
        if beyond_linear.vanishes() {
            return u;
        }
        u * ((u.squared() + ROUNDING) / (1.0 + ROUNDING)).powf(beyond_linear * 0.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_dual::Dual64;
    use proptest::prelude::*;

    fn dahl(exponent: f64) -> Presliding<f64> {
        Presliding { force: 80.0, stiffness: 1e5, exponent, gap: 0.0 }
    }

    /// The friction after a way in one direction, in small steps of Euler's.
    fn after(dahl: &Presliding<f64>, from: f64, way: f64) -> f64 {
        const STEPS: i32 = 20_000;
        (0..STEPS).fold(from, |friction, _| {
            let (_, rate) = dahl.force(PreslidingState { friction }, way.signum());
            friction + rate.friction * way.abs() / f64::from(STEPS)
        })
    }

    #[test]
    fn with_exponent_one_it_nears_its_limit_exponentially_over_the_way() {
        // From rest over F/σ = 0.8 mm; and, reversed, from one limit to the other.
        assert!((after(&dahl(1.0), 0.0, 0.8e-3) - 80.0 * (1.0 - (-1.0_f64).exp())).abs() < 0.01);
        assert!((after(&dahl(1.0), 80.0, -0.8e-3) - 80.0 * (2.0 * (-1.0_f64).exp() - 1.0)).abs() < 0.02);
    }

    #[test]
    fn the_exponent_says_how_soon_it_is_there() {
        let reached = [0.5, 1.0, 2.0].map(|exponent| after(&dahl(exponent), 0.0, 1.2e-3));
        assert!(reached[0] > reached[1] && reached[1] > reached[2], "{reached:?}");
        // n = 2: f/F = s/(1 + s) with the way s in F/σ; n = 1/2: 1 − (1 − s/2)².
        assert!((reached[2] / 80.0 - 0.6).abs() < 1e-3, "{reached:?}");
        assert!((reached[0] / 80.0 - 0.9375).abs() < 1e-3, "{reached:?}");
    }

    /// From one limit to nothing, over the backlash without force, and on the other side as from rest.
    #[test]
    fn behind_play_it_rests_at_zero_between_its_sides() {
        let loose = Presliding { gap: 0.5e-3, ..dahl(1.0) };
        let force = |friction: f64| loose.force(PreslidingState { friction }, -1.0).0;
        // Reversed, f/F = 2 exp(−s) − 1 over the way s in F/σ: gone at s = ln 2.
        let gone = 0.8e-3 * 2.0_f64.ln();
        let limit = 80.0 + 1e5 * 0.5e-3;
        assert_eq!(force(limit), 80.0);
        for inside in [0.01e-3, 0.5e-3, 0.99e-3] {
            assert_eq!(force(after(&loose, limit, -gone - inside)), 0.0);
        }
        let beyond = force(after(&loose, limit, -gone - 1e-3 - 0.8e-3));
        assert!((beyond + 80.0 * (1.0 - (-1.0_f64).exp())).abs() < 0.05, "{beyond}");
    }

    /// So that a search that begins without backlash sees it.
    #[test]
    fn a_play_that_is_varied_from_zero_takes_from_the_force() {
        let law = Presliding {
            force: Dual64::from(80.0),
            stiffness: Dual64::from(1e5),
            exponent: Dual64::from(1.0),
            gap: Dual64::new(0.0, 1.0),
        };
        for (friction, slope) in [(30.0, -1e5), (-30.0, 1e5)] {
            let (force, _) =
                law.force(PreslidingState { friction: Dual64::from(friction) }, Dual64::from(0.3));
            assert_eq!((force.re, force.eps), (friction, slope));
        }
    }

    #[test]
    fn at_the_limit_every_exponent_has_finite_derivatives() {
        for exponent in [0.1, 0.5, 1.0, 2.5, 5.0] {
            let law = Presliding {
                force: Dual64::from(80.0),
                stiffness: Dual64::from(1e5),
                exponent: Dual64::new(exponent, 1.0),
                gap: Dual64::from(0.0),
            };
            for friction in [-80.0, 0.0, 80.0, 80.001] {
                let (_, rate) =
                    law.force(PreslidingState { friction: Dual64::new(friction, 1.0) }, Dual64::from(0.3));
                assert!(
                    rate.friction.re.is_finite() && rate.friction.eps.is_finite(),
                    "{exponent} {friction}"
                );
            }
        }
    }

    #[test]
    fn varied_from_zero_it_is_finite_and_as_large_as_when_it_is_off() {
        let law = Presliding {
            force: Dual64::new(0.0, 1.0),
            stiffness: Dual64::from(1e5),
            exponent: Dual64::from(0.5),
            gap: Dual64::from(0.0),
        };
        let (force, rate) = law.force(PreslidingState { friction: Dual64::from(0.0) }, Dual64::from(0.3));
        assert_eq!((force.re, rate.friction.re), (0.0, 0.0));
        assert!(force.eps.is_finite() && rate.friction.eps.is_finite());
    }

    proptest! {
        #[test]
        fn it_is_odd(friction in -90.0..90.0_f64, v in 1e-6..1.0_f64, exponent in 0.1..5.0_f64) {
            let rate = |friction, v| dahl(exponent).force(PreslidingState { friction }, v).1.friction;
            prop_assert_eq!(rate(-friction, -v), -rate(friction, v));
        }

        #[test]
        fn what_it_does_not_store_it_takes(
            friction in -80.0..80.0_f64, v in -1.0..1.0_f64, n in 0.1..5.0_f64, gap in 0.0..1e-3_f64,
        ) {
            let law = Presliding { gap, ..dahl(n) };
            let (force, rate) = law.force(PreslidingState { friction }, v);
            // Within the backlash nothing is stored.
            let stored = force * rate.friction / law.stiffness;
            prop_assert!(force * v - stored >= -1e-9, "{force} {v} {stored}");
        }

        #[test]
        fn what_is_beyond_the_limit_comes_back(over in 1e-6..10.0_f64, v in 1e-6..1.0_f64, n in 0.1..5.0_f64) {
            let rate = dahl(n).force(PreslidingState { friction: 80.0 + over }, v).1.friction;
            prop_assert!(rate < 0.0);
        }

        #[test]
        fn without_force_it_is_absent(friction in -80.0..80.0_f64, v in -1.0..1.0_f64) {
            let (force, rate) = Presliding { force: 0.0, ..dahl(1.5) }.force(PreslidingState { friction }, v);
            prop_assert_eq!((force, rate.friction), (0.0, 0.0));
        }
    }
}
