//! What comes later than it was asked for: a delay and a lag.

use strut_model::{Real, Variables};

/// Below, a delay or a lag is one of this size where it is not off: nothing has to be integrated faster.
const LEAST: f64 = 1e-5;

/// A delay, as the rational function of second order that agrees with it best at low frequencies (Padé;
/// docs/effects.md, 23): of a sine with `ω τ` = 1 the phase is wrong by 1.4 mrad, with `ω τ` = 2 by 35 mrad, the amplitude never.
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

/// A lag of first order (docs/effects.md, 24).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct LagState<R> {
    /// What has arrived
    #[var(unit = N, nominal = 100.0)]
    pub arrived: R,
}

/// What has arrived of a quantity behind a lag with the time constant `time` (T), `T y' = u − y`, and how fast it rises; the
/// quantity itself and zero where the lag is off.
#[inline]
pub fn behind_lag<R: Real>(time: R, arrived: R, quantity: R) -> (R, R) {
    if time.vanishes() {
        return (quantity, R::from(0.0));
    }
    let rate = (quantity - arrived) / time.max(R::from(LEAST));
    (time.select(arrived, quantity), rate)
}

/// A force behind a lag, and the state's rate.
#[inline]
pub fn lagged<R: Real>(time: R, state: LagState<R>, force: R) -> (R, LagState<R>) {
    let (force, arrived) = behind_lag(time, state.arrived, force);
    (force, LagState { arrived })
}

#[cfg(test)]
mod tests {
    use nalgebra::Complex;
    use proptest::prelude::*;
    use strut_model::Dependencies;

    use super::*;

    /// Phase and amplitude of what becomes of a sine: output and states are linear, and solved for at `s = iω`.
    fn delay_at(omega: f64, time: f64) -> (f64, f64) {
        let of = |slow, fast, force| {
            let (output, rates) = delayed(time, DelayState { slow, fast }, force);
            [rates.slow, rates.fast, output].map(Complex::from)
        };
        let [[a11, a21, c1], [a12, a22, c2], [b1, b2, d]] =
            [of(1.0, 0.0, 0.0), of(0.0, 1.0, 0.0), of(0.0, 0.0, 1.0)];
        let s = Complex::new(0.0, omega);
        let determinant = (s - a11) * (s - a22) - a12 * a21;
        let slow = (b1 * (s - a22) + a12 * b2) / determinant;
        let fast = ((s - a11) * b2 + a21 * b1) / determinant;
        let output = c1 * slow + c2 * fast + d;
        (output.arg(), output.norm())
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
