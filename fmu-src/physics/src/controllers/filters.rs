//! What sampled controllers are made of: first-order sections by the bilinear transform, and a PID of them.

use strut_model::{Real, Variables};

/// The transfer function (b₁ s + b₀)/(a₁ s + a₀), sampled: s = 2/T (z − 1)/(z + 1) (Tustin).
///
/// At a frequency f it does what the continuous one does at tan(π f T)/(π T). It remembers one number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section<R> {
    now: R,
    before: R,
    again: R,
}

impl<R: Real> Section<R> {
    /// From the coefficients [b₁, b₀] and [a₁, a₀], and the sampling period.
    #[inline]
    pub fn new([b1, b0]: [R; 2], [a1, a0]: [R; 2], period: R) -> Self {
        let s = R::from(2.0) / period;
        let per = R::from(1.0) / (a1 * s + a0);
        Self { now: (b1 * s + b0) * per, before: (b0 - b1 * s) * per, again: (a1 * s - a0) * per }
    }

    /// gain/s.
    #[inline]
    pub fn integrator(gain: R, period: R) -> Self {
        Self::new([R::from(0.0), gain], [R::from(1.0), R::from(0.0)], period)
    }

    /// gain s/(lag s + 1).
    #[inline]
    pub fn derivative(gain: R, lag: R, period: R) -> Self {
        Self::new([gain, R::from(0.0)], [lag, R::from(1.0)], period)
    }

    /// s/(s + ω).
    #[inline]
    pub fn high_pass(omega: R, period: R) -> Self {
        Self::new([R::from(1.0), R::from(0.0)], [R::from(1.0), omega], period)
    }

    /// The output, and what is to be remembered instead of `memory`.
    #[inline]
    pub fn step(&self, memory: R, input: R) -> (R, R) {
        let output = memory + self.now * input;
        (output, self.before * input + self.again * output)
    }
}

/// Proportional, integral and derivative action with a lag on the derivative, the sum being limited.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pid<R> {
    /// Gain.
    pub proportional: R,
    /// Gain of the integral.
    pub integral: R,
    /// Gain of the derivative.
    pub derivative: R,
    /// Lag of the derivative in seconds.
    pub lag: R,
}

/// What a PID remembers, in the unit of its output.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct PidMemory<R> {
    /// Of the integral
    #[var(unit = ONE)]
    pub integral: R,
    /// Of the derivative
    #[var(unit = ONE)]
    pub derivative: R,
}

/// What a PID wants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Action<R> {
    /// Output, within the limit.
    pub output: R,
    /// What the limit has cut off.
    pub excess: R,
    /// What is to be remembered.
    pub memory: PidMemory<R>,
}

impl<R: Real> Pid<R> {
    /// One sample. At the limit the integral waits for an error that leads away from it (anti-windup).
    #[inline]
    pub fn step(&self, memory: &PidMemory<R>, error: R, limit: R, period: R) -> Action<R> {
        let (integral, integrated) = Section::integrator(self.integral, period).step(memory.integral, error);
        let (derivative, derived) =
            Section::derivative(self.derivative, self.lag, period).step(memory.derivative, error);
        let wanted = self.proportional * error + integral + derivative;
        let output = wanted.clamp(-limit, limit);
        let excess = wanted - output;
        let memory =
            PidMemory { integral: waiting(excess * error, memory.integral, integrated), derivative: derived };
        Action { output, excess, memory }
    }
}

/// What an integral remembers: as `before` where the product of excess and error says that it would grow beyond a
/// limit, else the new value.
#[inline]
pub fn waiting<R: Real>(excess_times_error: R, before: R, new: R) -> R {
    excess_times_error.select(before, new)
}

/// The highest order that a [`LowPassRate`] can have.
pub const MAX_ORDER: usize = 4;

/// The disturbance controller K_dd = s G_tp with G_tp = 1 − Gⁿ and the high-pass G = s/(s + ω), Ajala eq. 32, 41, 42.
///
/// The derivative and the low-pass are one: s (1 − G) = ω G, so s (1 − Gⁿ) = ω (G + G² + … + Gⁿ), a chain of n
/// high-passes, all outputs added. Nothing is differentiated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowPassRate<R> {
    /// Order n, at most [`MAX_ORDER`].
    pub order: usize,
    /// ω = 2π f_c in rad/s.
    pub omega: R,
}

impl<R: Real> LowPassRate<R> {
    /// The low-passed rate of change of the input, and what is to be remembered.
    #[inline]
    pub fn step(&self, memory: &[R; MAX_ORDER], input: R, period: R) -> (R, [R; MAX_ORDER]) {
        let high_pass = Section::high_pass(self.omega, period);
        let (mut chain, mut sum, mut new) = (input, R::from(0.0), *memory);
        for remembered in new.iter_mut().take(self.order) {
            (chain, *remembered) = high_pass.step(*remembered, chain);
            sum += chain;
        }
        (self.omega * sum, new)
    }
}

/// The order of a [`LowPassRate`] from a setting.
///
/// # Errors
/// If there is no such order.
pub fn order(order: i32) -> Result<usize, String> {
    match usize::try_from(order) {
        Ok(order @ 1..=MAX_ORDER) => Ok(order),
        _ => Err(format!("disturbance.order = {order} is not possible: the order is from 1 to {MAX_ORDER}")),
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;
    use proptest::prelude::*;

    const PERIOD: f64 = 1e-3;

    /// Gain and phase that a filter settles to at a frequency, as real and imaginary part, from whole periods.
    fn response(frequency: f64, mut filter: impl FnMut(f64) -> f64) -> (f64, f64) {
        let (mut real, mut imaginary) = (0.0, 0.0);
        let count = (20.0 / frequency / PERIOD).round() as usize;
        for k in 0..2 * count {
            let (sine, cosine) = (TAU * frequency * k as f64 * PERIOD).sin_cos();
            let output = filter(sine);
            if k >= count {
                real += 2.0 * output * sine / count as f64;
                imaginary += 2.0 * output * cosine / count as f64;
            }
        }
        (real, imaginary)
    }

    /// (a + bi)(c + di).
    fn times((a, b): (f64, f64), (c, d): (f64, f64)) -> (f64, f64) {
        (a * c - b * d, a * d + b * c)
    }

    /// The imaginary axis of the continuous filter that belongs to a frequency.
    fn warped(frequency: f64) -> f64 {
        2.0 / PERIOD * (PI * frequency * PERIOD).tan()
    }

    fn assert_close(found: (f64, f64), expected: (f64, f64)) {
        let size = expected.0.hypot(expected.1);
        assert!((found.0 - expected.0).hypot(found.1 - expected.1) < 1e-6 * size, "{found:?} {expected:?}");
    }

    #[test]
    fn a_section_has_the_response_of_its_transfer_function() {
        for frequency in [1.0, 10.0, 100.0] {
            let section = Section::new([0.3, 20.0], [0.01, 1.5], PERIOD);
            let mut memory = 0.0;
            let found = response(frequency, |input| {
                let (output, new) = section.step(memory, input);
                memory = new;
                output
            });
            let omega = warped(frequency);
            // (20 + 0.3 iω)/(1.5 + 0.01 iω)
            let size = 1.5_f64.powi(2) + (0.01 * omega).powi(2);
            let expected = times((20.0, 0.3 * omega), (1.5 / size, -0.01 * omega / size));
            assert_close(found, expected);
        }
    }

    #[test]
    fn an_integrator_is_the_trapezoidal_rule() {
        let integrator = Section::integrator(2.0, 0.1);
        let (mut memory, mut output) = (0.0, 0.0);
        for input in [1.0, 3.0, 2.0] {
            (output, memory) = integrator.step(memory, input);
        }
        // 2 · 0.1 · (0.5 + (1 + 3)/2 + (3 + 2)/2): from nothing before the first sample.
        assert!((output - 1.0_f64).abs() < 1e-15, "{output}");
    }

    #[test]
    fn low_pass_and_derivative_are_equations_32_41_and_42() {
        for order in 1..=MAX_ORDER {
            for frequency in [0.5, 3.0, 20.0] {
                let filter = LowPassRate { order, omega: TAU * 3.0 };
                let mut memory = [0.0; MAX_ORDER];
                let found = response(frequency, |input| {
                    let (output, new) = filter.step(&memory, input, PERIOD);
                    memory = new;
                    output
                });
                let (s, omega) = ((0.0, warped(frequency)), TAU * 3.0);
                let size = s.1 * s.1 + omega * omega;
                let high_pass = times(s, (omega / size, -s.1 / size));
                let power = (0..order).fold((1.0, 0.0), |power, _| times(power, high_pass));
                let expected = times(s, (1.0 - power.0, -power.1));
                let size = expected.0.hypot(expected.1);
                let off = (found.0 - expected.0).hypot(found.1 - expected.1);
                // Higher orders settle slowly.
                assert!(off < 1e-4 * size, "{order} {frequency} {found:?} {expected:?}");
            }
        }
    }

    #[test]
    fn an_order_that_there_is_not_is_refused() {
        assert_eq!(order(2), Ok(2));
        for wrong in [-1, 0, 5] {
            assert!(order(wrong).unwrap_err().contains(&format!("disturbance.order = {wrong}")));
        }
    }

    const PID: Pid<f64> = Pid { proportional: 2.0, integral: 30.0, derivative: 0.01, lag: 0.005 };
    const FRESH: PidMemory<f64> = PidMemory { integral: 0.0, derivative: 0.0 };

    #[test]
    fn a_pid_adds_its_three_parts() {
        let mut memory = FRESH;
        let found = response(5.0, |error| {
            let action = PID.step(&memory, error, 1e9, PERIOD);
            memory = action.memory;
            action.output
        });
        let omega = warped(5.0);
        let size = 1.0 + (0.005 * omega).powi(2);
        let derivative = times((0.0, 0.01 * omega), (1.0 / size, -0.005 * omega / size));
        assert_close(found, (2.0 + derivative.0, -30.0 / omega + derivative.1));
    }

    #[test]
    fn at_its_limit_the_integral_does_not_wind_up() {
        let mut memory = FRESH;
        for _ in 0..5000 {
            memory = PID.step(&memory, 10.0, 3.0, PERIOD).memory;
        }
        // The error turns; the output leaves its limit within the lag of the derivative.
        let mut samples = 0;
        loop {
            let action = PID.step(&memory, -0.5, 3.0, PERIOD);
            memory = action.memory;
            if action.output < 0.0 {
                break;
            }
            samples += 1;
        }
        assert!(samples < 20, "{samples}");
    }

    proptest! {
        #[test]
        fn a_pid_keeps_to_its_limit(errors in prop::collection::vec(-10.0..10.0_f64, 1..50)) {
            let mut memory = FRESH;
            for error in errors {
                let action = PID.step(&memory, error, 5.0, PERIOD);
                prop_assert!(action.output.abs() <= 5.0);
                memory = action.memory;
            }
        }
    }
}
