//! Buffers at the ends of a strut's travel.

use strut_model::{Real, Variables};

/// One-sided linear springs beyond a clearance in either direction (docs/effects.md, 09).
///
/// `F = k_b (⟨x − x_r⟩ − ⟨−x − x_c⟩)` with ⟨·⟩ = max(·, 0): the rebound stop pulls body and wheel together, the
/// compression stop pushes them apart.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Stop<R> {
    /// Rate of both stops (k_b); zero switches them off
    #[var(unit = N_PER_M, start = 0.0, min = 0.0)]
    pub stiffness: R,
    /// Compression up to which the compression stop is not touched (x_c)
    #[var(unit = M, start = 0.05, min = 0.0)]
    pub compression_clearance: R,
    /// Rebound up to which the rebound stop is not touched (x_r)
    #[var(unit = M, start = 0.05, min = 0.0)]
    pub rebound_clearance: R,
}

impl<R: Real> Stop<R> {
    /// The force at a deflection.
    #[inline]
    pub fn force(&self, deflection: R) -> R {
        let zero = R::from(0.0);
        let rebound = (deflection - self.rebound_clearance).max(zero);
        let compression = (-deflection - self.compression_clearance).max(zero);
        self.stiffness * (rebound - compression)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const STOP: Stop<f64> = Stop { stiffness: 1e5, compression_clearance: 0.03, rebound_clearance: 0.04 };

    #[test]
    fn ten_millimetres_beyond_a_clearance_are_a_kilonewton() {
        assert!((STOP.force(0.05) - 1e3).abs() < 1e-9);
        assert!((STOP.force(-0.04) + 1e3).abs() < 1e-9);
    }

    proptest! {
        #[test]
        fn between_the_clearances_it_is_absent(x in -0.03..0.04_f64) {
            prop_assert_eq!(STOP.force(x), 0.0);
        }

        #[test]
        fn it_drives_back_and_is_odd_if_the_clearances_are_equal(x in -0.2..0.2_f64) {
            let stop = Stop { rebound_clearance: 0.03, ..STOP };
            prop_assert!(STOP.force(x) * x >= 0.0);
            prop_assert_eq!(stop.force(-x), -stop.force(x));
        }

        #[test]
        fn without_stiffness_it_is_absent(x in -0.2..0.2_f64) {
            prop_assert_eq!(Stop { stiffness: 0.0, ..STOP }.force(x), 0.0);
        }
    }
}
