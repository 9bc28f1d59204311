//! A force that cannot be larger than it can.

use strut_model::{Real, Variables};

use super::dead_zone;

/// A limit of a force: `F − ρ dz(F)` with the dead zone dz, which is zero up to ±F_m and has slope one beyond (docs/effects.md,
/// 26). With `ratio` ρ = 1 nothing passes beyond ±F_m.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Saturation<R> {
    /// Share of what is asked for beyond the limit that does not come (ρ): one is a sharp limit; zero switches it off
    #[var(unit = ONE, start = 0.0, min = 0.0, max = 1.0)]
    pub ratio: R,
    /// Force of the limit, to both sides (F_m)
    #[var(unit = N, start = 1000.0, min = 1e-3)]
    pub force: R,
}

impl<R: Real> Saturation<R> {
    /// What becomes of a force.
    #[inline]
    pub fn limited(&self, force: R) -> R {
        if self.ratio.vanishes() {
            return force;
        }
        force - self.ratio * dead_zone(force, self.force)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn half_of_what_is_beyond_a_soft_limit_passes() {
        let limit = Saturation { ratio: 0.5, force: 100.0 };
        assert_eq!((limit.limited(80.0), limit.limited(140.0), limit.limited(-140.0)), (80.0, 120.0, -120.0));
    }

    proptest! {
        #[test]
        fn a_sharp_one_lets_nothing_more_pass(force in -1e3..1e3_f64) {
            let limited = Saturation { ratio: 1.0, force: 100.0 }.limited(force);
            prop_assert!((limited - force.clamp(-100.0, 100.0)).abs() < 1e-12);
        }

        #[test]
        fn without_ratio_it_is_absent(force in -1e3..1e3_f64) {
            prop_assert_eq!(Saturation { ratio: 0.0, force: 100.0 }.limited(force), force);
        }
    }
}
