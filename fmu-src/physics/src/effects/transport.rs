//! What comes later than it was asked for: a delay and a lag.

use strut_model::{Real, Variables};

/// Below, a delay or a lag is one of this size where it is not off: nothing has to be integrated faster.
const LEAST: f64 = 1e-5;

/// A delay, as the rational function of second order that agrees with it best at low frequencies (Padé; catalogue of
/// diagnosis, 23): of a sine with `ω τ` = 1 the phase is wrong by 1.4 mrad, with `ω τ` = 2 by 35 mrad, the amplitude never.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct DelayState<R> {
    /// What has arrived slowly
    #[var(unit = N, nominal = 100.0)]
    pub slow: R,
    /// What is still missing
    #[var(unit = N, nominal = 100.0)]
    pub fast: R,
}

/// A force `time` (τ) seconds later, and the states' rates.
///
/// `(1 − τs/2 + τ²s²/12)/(1 + τs/2 + τ²s²/12)` is `1 − b` with `a' = b/τ` and `b' = (12 (u − a) − 6 b)/τ`.
#[inline]
pub fn delayed<R: Real>(time: R, state: DelayState<R>, force: R) -> (R, DelayState<R>) {
    let zero = R::from(0.0);
    if time.vanishes() {
        return (force, DelayState { slow: zero, fast: zero });
    }
    let per = R::from(1.0) / time.max(R::from(LEAST));
    let fast = ((force - state.slow) * 12.0 - state.fast * 6.0) * per;
    (time.select(force - state.fast, force), DelayState { slow: state.fast * per, fast })
}

/// A lag of first order (catalogue of diagnosis, 24).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct LagState<R> {
    /// What has arrived
    #[var(unit = N, nominal = 100.0)]
    pub arrived: R,
}

/// A force behind a lag with the time constant `time` (T), `T y' = u − y`, and the state's rate.
#[inline]
pub fn lagged<R: Real>(time: R, state: LagState<R>, force: R) -> (R, LagState<R>) {
    if time.vanishes() {
        return (force, LagState { arrived: R::from(0.0) });
    }
    let rate = (force - state.arrived) / time.max(R::from(LEAST));
    (time.select(state.arrived, force), LagState { arrived: rate })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use strut_model::Dependencies;

    /// Phase and amplitude of what becomes of a sine, by complex numbers: states and output are solved for at `s = iω`.
    fn delay_at(omega: f64, time: f64) -> (f64, f64) {
        // b (s τ + 6 + 12/(s τ)) = 12 u.
        let x = omega * time;
        let (re, im) = (6.0, x - 12.0 / x);
        let square = re * re + im * im;
        let (y_re, y_im) = (1.0 - 12.0 * re / square, 12.0 * im / square);
        (y_im.atan2(y_re), y_re.hypot(y_im))
    }

    #[test]
    fn its_phase_is_the_delay_s_and_its_amplitude_one() {
        for (x, error) in [(0.5, 5e-5), (1.0, 1.5e-3), (2.0, 0.036)] {
            let (phase, amplitude) = delay_at(x / 0.004, 0.004);
            assert!((phase + x).abs() < error && (phase + x).abs() > 0.5 * error / 2.0, "{x}: {phase}");
            assert!((amplitude - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn whether_they_are_on_or_off_is_in_what_they_depend_on() {
        let of = Dependencies::on;
        let (force, rates) = delayed(of(0), DelayState { slow: of(1), fast: of(2) }, of(3));
        assert!(force.contains(2) && force.contains(3) && rates.fast.contains(1) && rates.slow.contains(2));
        let (force, rate) = lagged(of(0), LagState { arrived: of(1) }, of(3));
        assert!(force.contains(1) && force.contains(3) && rate.arrived.contains(3));
    }

    proptest! {
        #[test]
        fn a_constant_force_passes_as_it_is(force in -1e3..1e3_f64, time in 1e-4..0.05_f64) {
            let (found, rates) = delayed(time, DelayState { slow: force, fast: 0.0 }, force);
            prop_assert_eq!((found, rates.slow, rates.fast), (force, 0.0, 0.0));
            let (found, rate) = lagged(time, LagState { arrived: force }, force);
            prop_assert_eq!((found, rate.arrived), (force, 0.0));
        }

        #[test]
        fn a_ramp_is_late_by_the_delay_and_by_the_time_constant(slope in -1e3..1e3_f64, time in 1e-3..0.05_f64) {
            // Of u = s t: a = s (t − τ/2), b = s τ, which is u − a less half a step of b.
            let state = DelayState { slow: -slope * time * 0.5, fast: slope * time };
            let (found, rates) = delayed(time, state, 0.0);
            prop_assert!((found + slope * time).abs() < 1e-9);
            prop_assert!((rates.slow - slope).abs() < 1e-9 && rates.fast.abs() < 1e-6);
            let (found, rate) = lagged(time, LagState { arrived: -slope * time }, 0.0);
            prop_assert!((found + slope * time).abs() < 1e-9 && (rate.arrived - slope).abs() < 1e-9);
        }

        #[test]
        fn without_time_they_are_absent(force in -1e3..1e3_f64, slow in -1e3..1e3_f64) {
            let (found, rates) = delayed(0.0, DelayState { slow, fast: slow }, force);
            prop_assert_eq!((found, rates.slow, rates.fast), (force, 0.0, 0.0));
            let (found, rate) = lagged(0.0, LagState { arrived: slow }, force);
            prop_assert_eq!((found, rate.arrived), (force, 0.0));
        }
    }
}
