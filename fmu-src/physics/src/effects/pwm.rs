//! The steps of a pulse-width modulated output.

use strut_model::{Real, Settings};

/// A duty cycle that a counter of some bits makes: it has so many steps, and a direction of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pwm {
    steps: Option<f64>,
}

/// How finely a duty cycle is made.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct PwmOptions {
    /// Pulse width modulation: bits of the duty cycle; with 0 it has no steps
    #[set(name = "pwm.bits", start = 0)]
    pub bits: i32,
}

/// More bits than these no counter has.
const MOST: i32 = 32;

impl Pwm {
    /// Without steps.
    pub const CONTINUOUS: Self = Self { steps: None };

    /// # Errors
    /// If there are less than no bits, or more than 32.
    pub fn new(options: &PwmOptions) -> Result<Self, String> {
        match options.bits {
            0 => Ok(Self::CONTINUOUS),
            bits @ 1..=MOST => Ok(Self { steps: Some(f64::exp2(f64::from(bits)) - 1.0) }),
            bits => Err(format!(
                "pwm.bits = {bits} must be from 1 to {MOST}, or 0 for a duty cycle without steps"
            )),
        }
    }

    /// The duty cycle that is made when `duty` is wanted, between `least` and one.
    #[inline]
    pub fn made<R: Real>(&self, duty: R, least: f64) -> R {
        let held = duty.clamp(R::from(least), R::from(1.0));
        match self.steps {
            None => held,
            Some(steps) => (held * steps).round() / steps,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn pwm(bits: i32) -> Pwm {
        Pwm::new(&PwmOptions { bits }).unwrap()
    }

    #[test]
    fn eight_bits_are_255_steps() {
        assert_eq!(pwm(8).made(0.5, 0.0), 128.0 / 255.0);
        assert_eq!(pwm(8).made(0.0019, 0.0), 0.0);
        assert_eq!(pwm(8).made(-0.5, -1.0), -128.0 / 255.0);
        assert_eq!(
            [pwm(8).made(1.3, 0.0), pwm(8).made(-0.2, 0.0), pwm(0).made(-3.0, -1.0)],
            [1.0, 0.0, -1.0]
        );
    }

    #[test]
    fn bits_that_no_counter_has_are_refused() {
        for bits in [-1, 33] {
            let error = Pwm::new(&PwmOptions { bits }).unwrap_err();
            assert!(error.contains(&format!("pwm.bits = {bits}")), "{error}");
        }
    }

    proptest! {
        #[test]
        fn it_is_off_by_half_a_step_at_most(duty in -1.0..1.0_f64, bits in 1..33_i32) {
            let error = (pwm(bits).made(duty, -1.0) - duty).abs();
            prop_assert!(error <= 0.5 / (f64::exp2(f64::from(bits)) - 1.0) + 1e-15);
        }

        #[test]
        fn without_bits_it_is_absent(duty in -1.0..1.0_f64) {
            prop_assert_eq!(pwm(0).made(duty, -1.0), duty);
        }
    }
}
