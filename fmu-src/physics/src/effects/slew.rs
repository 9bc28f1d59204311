//! A force that changes no faster than it can.

use strut_model::{Real, Variables};

/// A limit of a force's rate of change, `|F'| <= R` (docs/effects.md, 26): what a voltage leaves of the rate of a current
/// in a coil, or a valve's full flow of that of a pressure.
///
/// Its parameter is 1/R, so that there is no limit where it is zero. With `T y' = clamp(u − y, −R T, R T)` what acts is
/// `y + T y'`: the force u that is asked for, as long as that changes no faster than R, and otherwise a force that changes by
/// just R. After a jump of u it is T ahead: within a duration d it changes by R (d + 2 T) at most.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Slew<R> {
    /// Time that a change of the force by one newton takes at least (1/R); zero switches it off
    #[var(unit = S_PER_N, start = 0.0, min = 0.0)]
    pub slowness: R,
}

/// What a force remembers that cannot jump.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct SlewState<R> {
    /// Force, a little later
    #[var(unit = N, nominal = 100.0)]
    pub force: R,
}

/// T in s: short beside what a force in a rig is asked for.
const BEHIND: f64 = 5e-4;

/// Least slowness in s/N: 1 GN/s is no limit.
const LEAST: f64 = 1e-9;

impl<R: Real> Slew<R> {
    /// What becomes of a force, and the state's rate.
    #[inline]
    pub fn limited(&self, state: SlewState<R>, force: R) -> (R, SlewState<R>) {
        if self.slowness.vanishes() {
            return (force, SlewState { force: R::from(0.0) });
        }
        let ahead = R::from(BEHIND) / self.slowness.max(R::from(LEAST));
        let step = (force - state.force).clamp(-ahead, ahead);
        // Being varied from zero it limits nothing still.
        (self.slowness.select(state.force + step, force), SlewState { force: step / BEHIND })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use strut_model::Dependencies;

    use super::*;

    const SLEW: Slew<f64> = Slew { slowness: 1e-4 };

    /// What acts of a force over the time, by Euler's steps of 10 µs.
    fn acting(force: impl Fn(f64) -> f64, duration: f64) -> Vec<f64> {
        let mut state = SlewState { force: force(0.0) };
        (0..(duration * 1e5) as usize)
            .map(|k| {
                let (acting, rate) = SLEW.limited(state, force(k as f64 * 1e-5));
                state.force += 1e-5 * rate.force;
                acting
            })
            .collect()
    }

    #[test]
    fn a_jump_of_100_newtons_takes_10_milliseconds() {
        let found = acting(|time| if time > 0.0 { 100.0 } else { 0.0 }, 0.02);
        // 10 kN/s, half a millisecond ahead.
        for (k, due) in [(100, 15.0), (500, 55.0), (900, 95.0), (1000, 100.0), (1900, 100.0)] {
            assert!((found[k] - due).abs() < 0.2, "{} N for {due} N", found[k]);
        }
    }

    #[test]
    fn whether_it_is_on_or_off_is_in_what_it_depends_on() {
        let of = Dependencies::on;
        let (force, rate) = Slew { slowness: of(0) }.limited(SlewState { force: of(1) }, of(2));
        assert!([0, 1, 2].iter().all(|it| force.contains(*it) && rate.force.contains(*it)));
    }

    proptest! {
        #[test]
        fn what_is_slower_passes_as_it_is(size in 10.0..500.0_f64, share in 0.01..0.99_f64) {
            let omega = share * 1e4 / size;
            let asked = |time: f64| size * (omega * time).sin();
            for (k, found) in acting(asked, 0.2).iter().enumerate() {
                prop_assert!((found - asked(k as f64 * 1e-5)).abs() < 1e-9);
            }
        }

        #[test]
        fn what_is_faster_changes_by_the_limit(size in 10.0..500.0_f64, times in 1.1..6.0_f64) {
            let omega = times * 1e4 / size;
            let asked = |time: f64| size * (omega * time).sin();
            let found = acting(asked, 0.2);
            let behind = |k: usize| (found[k] - asked(k as f64 * 1e-5)).abs() > 1e-9;
            for k in (1..found.len()).filter(|k| behind(k - 1) && behind(*k)) {
                prop_assert!(((found[k] - found[k - 1]).abs() / 0.1 - 1.0).abs() < 1e-6);
            }
            for pair in found.windows(101) {
                prop_assert!((pair[100] - pair[0]).abs() <= 1e4 * (1e-3 + 2.0 * BEHIND) * (1.0 + 1e-6));
            }
        }

        #[test]
        fn without_slowness_it_is_absent(force in -1e3..1e3_f64, state in -1e3..1e3_f64) {
            let (found, rate) = Slew { slowness: 0.0 }.limited(SlewState { force: state }, force);
            prop_assert_eq!((found, rate.force), (force, 0.0));
        }
    }
}
