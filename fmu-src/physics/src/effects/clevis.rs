//! Play between a strut and what it is clamped in.

use strut_model::{Real, Variables};

use super::backlash::CATCHES_UP;
use super::knee::dead_zone;

/// A loose clevis or ball joint in series with all of a strut (docs/effects.md, 12c).
///
/// Of the deflection x the play takes e, and the strut x − e. Within the play nothing moves the strut: its friction keeps it as it
/// is. This holds for a damper whose spring and preload are small beside its friction. Beyond, the strut is dragged along:
/// `e' = v − dz(e, g)/T` with half the play g. The strut moves with the velocity `dz(e, g)/T`, as the ends do, but T later.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Clevis<R> {
    /// Half the play (g); zero holds the strut firmly
    #[var(unit = M, start = 0.0, min = 0.0)]
    pub gap: R,
}

/// What a clevis remembers.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct ClevisState<R> {
    /// Deflection of the play (e)
    #[var(unit = M, nominal = 1e-4)]
    pub deflection: R,
}

impl<R: Real> Clevis<R> {
    /// Deflection and velocity that are left for the strut, and the rate of the state.
    #[inline]
    pub fn behind(&self, state: ClevisState<R>, [x, v]: [R; 2]) -> ([R; 2], ClevisState<R>) {
        let zero = R::from(0.0);
        if self.gap.vanishes() {
            return ([x, v], ClevisState { deflection: zero });
        }
        let dragged = dead_zone(state.deflection, self.gap) / CATCHES_UP;
        // Being varied from zero it is firm still.
        let left = [self.gap.select(x - state.deflection, x), self.gap.select(dragged, v)];
        (left, ClevisState { deflection: self.gap.select(v - dragged, zero) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Deflection and velocity of a strut behind a play of 0.5 mm to either side, along a triangle of 4 mm in half a second.
    fn along_a_triangle() -> Vec<[f64; 4]> {
        const STEP: f64 = 2e-5;
        let clevis = Clevis { gap: 5e-4 };
        let mut state = ClevisState { deflection: 0.0 };
        let mut all = Vec::new();
        for k in 0..100_000 {
            let time = f64::from(k) * STEP;
            let up = (time * 2.0).rem_euclid(2.0) < 1.0;
            let share = (time * 2.0).rem_euclid(1.0);
            let (x, v) = if up { (4e-3 * share, 8e-3) } else { (4e-3 * (1.0 - share), -8e-3) };
            let ([left, speed], rate) = clevis.behind(state, [x, v]);
            all.push([x, v, left, speed]);
            state.deflection += STEP * rate.deflection;
        }
        all
    }

    #[test]
    fn after_a_turn_the_strut_rests_until_the_play_is_used_up() {
        let all = along_a_triangle();
        // After half a second the ends turn; 1 mm of play at 8 mm/s lasts 125 ms.
        let at = |time: f64| all[(time / 2e-5).round() as usize];
        assert!(at(0.55)[3].abs() < 1e-9 && at(0.62)[3].abs() < 1e-9, "{:?} {:?}", at(0.55), at(0.62));
        assert!((at(0.7)[3] + 8e-3).abs() < 1e-6, "{:?}", at(0.7));
        // Half the play and what it is late by are missing of the deflection.
        assert!((at(0.45)[0] - at(0.45)[2] - 5e-4 - 8e-3 * CATCHES_UP).abs() < 1e-8);
    }

    proptest! {
        #[test]
        fn without_play_nothing_changes(x in -0.1..0.1_f64, v in -2.0..2.0_f64, e in -1e-3..1e-3_f64) {
            let (left, rate) = Clevis { gap: 0.0 }.behind(ClevisState { deflection: e }, [x, v]);
            prop_assert_eq!((left, rate.deflection), ([x, v], 0.0));
        }

        #[test]
        fn within_the_play_the_strut_stands_still(share in -1.0..1.0_f64, v in -2.0..2.0_f64) {
            let ([_, speed], rate) = Clevis { gap: 1e-3 }.behind(ClevisState { deflection: share * 1e-3 }, [0.0, v]);
            prop_assert_eq!((speed, rate.deflection), (0.0, v));
        }
    }
}
