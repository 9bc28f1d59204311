//! Whether a step was good enough, and how long the next one may be.

use crate::{array::Array, settings::Settings, system::System};

/// What a method makes of one step.
pub(crate) struct Trial<A> {
    /// The state at the end.
    pub x: A,
    /// Its rates. The system evaluated these last.
    pub rates: A,
    /// The estimated error of `x`.
    pub error: A,
}

/// A one-step method with an error estimate of order h^5.
pub(crate) trait Stepper<A: Array> {
    /// Evaluations of the rates in one step.
    const RATES: u64;
    /// Jacobians in one `begin`, and inversions in one `step`: 1 if the method needs them.
    const JACOBIANS: u64;
    /// Exponent of the controller's reply to the error of the step before. Zero for a plain
    /// controller, positive to damp the sequence of step sizes where stability limits them
    /// (Hairer, Nørsett & Wanner, Solving ODEs I, section II.4; and II, section IV.2).
    const BETA: f64;

    /// Evaluates what all trials from (t, x) share. An error is the row that is not finite.
    fn begin<S: System<A>>(&mut self, system: &mut S, t: f64, x: &A) -> Result<(), usize>;

    /// One step of length `h` from (t, x) with the given rates, to `end` = t + h but for rounding.
    /// None if a matrix is singular.
    fn step<S: System<A>>(
        &self,
        system: &mut S,
        t: f64,
        end: f64,
        h: f64,
        x: &A,
        rates: &A,
    ) -> Option<Trial<A>>;
}

/// A step whose error is below this fraction of the tolerance can be repeated at the same length.
///
/// The controller would lengthen a step up to 0.9^5 = 0.59; below 0.5 it does so certainly, and if
/// the step's length was dictated by the end of the call there is nothing to compute.
const COMFORTABLE: f64 = 0.5;

/// The controller aims at 0.9 of the step that would just meet the tolerance, never shortens to
/// less than a tenth (a jump is then found in few trials) nor lengthens to more than ten times.
const SAFETY: f64 = 0.9;
const SHORTEN: f64 = 0.1;
const LENGTHEN: f64 = 10.0;

impl<A: Array> Settings<A> {
    /// Whether the trial's error is well below the tolerance, and everything finite.
    ///
    /// Without a division or a root: this is all that most calls compute of the error control.
    #[inline(always)]
    pub(crate) fn comfortable(&self, x: &A, trial: &Trial<A>) -> bool {
        let (x, y) = (x.as_slice(), trial.x.as_slice());
        let (error, rates) = (trial.error.as_slice(), trial.rates.as_slice());
        let absolute = self.absolute_tolerance.as_slice();
        let mut good = true;
        for i in 0..A::LEN {
            let scale = absolute[i] + self.relative_tolerance * x[i].abs().max(y[i].abs());
            // Both comparisons are false for NaN; max alone would have dropped a NaN in y, but the
            // error is then NaN as well.
            good &= error[i].abs() < COMFORTABLE * scale;
            good &= scale < f64::MAX && rates[i].abs() < f64::MAX;
        }
        good
    }

    /// Square of the largest ratio of estimated to tolerated error, or the first component that is
    /// not finite.
    pub(crate) fn measure(&self, x: &A, trial: &Trial<A>) -> Result<f64, usize> {
        let (x, y) = (x.as_slice(), trial.x.as_slice());
        let (error, rates) = (trial.error.as_slice(), trial.rates.as_slice());
        let absolute = self.absolute_tolerance.as_slice();
        let mut largest = 0.0_f64;
        for i in 0..A::LEN {
            if !(y[i].is_finite() && rates[i].is_finite() && error[i].is_finite()) {
                return Err(i);
            }
            let scale = absolute[i] + self.relative_tolerance * x[i].abs().max(y[i].abs());
            largest = largest.max(error[i] / scale * (error[i] / scale));
        }
        Ok(largest)
    }

    /// The first step after a fresh start, no longer than `span`, the length of the call.
    ///
    /// Hairer's estimate (Solving ODEs I, section II.4) from the first and, by a small Euler step,
    /// the second derivative. Where the state rests at zero, its scale says nothing about time, and
    /// a thousandth of the call stands in.
    #[cold]
    #[inline(never)]
    pub(crate) fn first_step<S: System<A>>(
        &self,
        system: &mut S,
        t: f64,
        x: &A,
        rates: &A,
        span: f64,
    ) -> f64 {
        let (x, f) = (x.as_slice(), rates.as_slice());
        let norm = |value: &dyn Fn(usize) -> f64| {
            (0..A::LEN).fold(0.0_f64, |largest, i| {
                let scale = self.absolute_tolerance.as_slice()[i] + self.relative_tolerance * x[i].abs();
                largest.max((value(i) / scale).abs())
            })
        };
        let longest = span.min(self.max_step);
        let size = norm(&|i| x[i]);
        let slope = norm(&|i| f[i]);
        let small = if size < 1e-5 || slope < 1e-5 { 1e-3 * span } else { 0.01 * size / slope };
        let small = small.min(longest);
        let euler = A::from_fn(|i| x[i] + small * f[i]);
        let g = system.rates(t + small, &euler);
        let g = g.as_slice();
        let curvature = norm(&|i| g[i] - f[i]) / small;
        let steepest = slope.max(curvature);
        let step = if steepest <= 1e-15 { small } else { libm::pow(0.01 / steepest, 0.2).min(100.0 * small) };
        // Not finite if the Euler step left the domain of the rates; `small` is what is left.
        if step > 0.0 { step.min(longest) } else { small }
    }
}

/// By what factor to change a step that was accepted; `previous` is the error of the one before.
pub(crate) fn accepted_factor<A: Array, M: Stepper<A>>(squared: f64, previous: f64) -> f64 {
    // A product of powers by one exponential. An error of zero gives infinity, and the longest step.
    let mut exponent = -0.5 * (0.2 - 0.75 * M::BETA) * libm::log(squared);
    if M::BETA != 0.0 {
        exponent += M::BETA * libm::log(previous);
    }
    (SAFETY * libm::exp(exponent)).clamp(SHORTEN, LENGTHEN)
}

/// By what factor to shorten a step that was rejected.
pub(crate) fn rejected_factor(squared: f64) -> f64 {
    (SAFETY * libm::exp(-0.1 * libm::log(squared))).clamp(SHORTEN, SAFETY)
}
