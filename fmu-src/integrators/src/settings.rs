//! How accurately, and with what limits.

use crate::{array::Array, error::InvalidSettings};

/// Absolute tolerance as a fraction of relative tolerance times nominal value.
///
/// A state far below its nominal value is resolved to this fraction of what the relative tolerance
/// asks for at its nominal value, so that a state which passes zero does not stop the integration.
/// 0.01 is the customary choice of FMI importers (PyFMI, Dymola).
pub const ABSOLUTE_FRACTION: f64 = 0.01;

/// How accurately to integrate, and with what limits.
///
/// A step is accepted if the error of every state i that it adds is estimated at no more than
/// `absolute_tolerance[i] + relative_tolerance * |x[i]|`. Each state counts for itself, so that
/// further, idle states do not loosen the tolerance as they do in a root mean square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings<A> {
    /// Error per step that is allowed relative to the state's magnitude; dimensionless.
    pub relative_tolerance: f64,
    /// Error per step that is allowed where a state is near zero; in the unit of each state.
    pub absolute_tolerance: A,
    /// Longest internal step, in the unit of time; infinite by default. The step that ends a call
    /// may be 1 % longer, where the alternative were a further, tiny one. No error estimate sees a
    /// pulse that comes and goes between two evaluations: where there are such, this is the remedy.
    pub max_step: f64,
    /// Internal steps, rejected ones included, that one call may take.
    pub max_steps: u32,
}

impl<A: Array> Settings<A> {
    /// Settings that follow from the magnitude each state typically has, in that state's unit.
    ///
    /// Steps are not limited in length; in number they are to 100 000 per call.
    #[must_use]
    pub fn new(relative_tolerance: f64, nominal: &A) -> Self {
        let nominal = nominal.as_slice();
        Settings {
            relative_tolerance,
            absolute_tolerance: A::from_fn(|i| ABSOLUTE_FRACTION * relative_tolerance * nominal[i].abs()),
            max_step: f64::INFINITY,
            max_steps: 100_000,
        }
    }

    /// The first setting that cannot be used.
    pub(crate) fn check(&self) -> Result<(), InvalidSettings> {
        let usable = |tolerance: f64| tolerance > 0.0 && tolerance.is_finite();
        if !usable(self.relative_tolerance) {
            return Err(InvalidSettings::RelativeTolerance(self.relative_tolerance));
        }
        for (component, &value) in self.absolute_tolerance.as_slice().iter().enumerate() {
            if !usable(value) {
                return Err(InvalidSettings::AbsoluteTolerance { component, value });
            }
        }
        if self.max_step.is_nan() || self.max_step <= 0.0 {
            return Err(InvalidSettings::MaxStep(self.max_step));
        }
        if self.max_steps == 0 {
            return Err(InvalidSettings::MaxSteps);
        }
        Ok(())
    }
}
