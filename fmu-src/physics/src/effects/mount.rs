//! A damper that is held by a soft bush, or by one with backlash.

use strut_model::{Real, Variables};

use super::knee::dead_zone;

/// A bush in series with a damper (docs/effects.md, 12 and 13).
///
/// Of the strut's deflection x the bush takes e and the damper x − e. The bush's force is `F = dz(e, g)/c` with half
/// the backlash `gap` = g and `compliance` = c; the damper has the same force and gives way with the velocity u(F), hence
/// `e' = v − u(F)`. Play without compliance would have no force law: it stands on 1e-6 m/N then. A compliance much
/// smaller than that makes the equations stiff (time constant c d).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Mount<R> {
    /// Half the backlash of the bush (g); without gap and compliance the damper is held firmly
    #[var(unit = M, start = 0.0, min = 0.0)]
    pub gap: R,
    /// Compliance of the bush (c); zero is taken as 1e-6 m/N if there is backlash
    #[var(unit = M_PER_N, start = 0.0, min = 0.0)]
    pub compliance: R,
}

/// What a mount remembers.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct MountState<R> {
    /// Deflection of the bush (e)
    #[var(unit = M, nominal = 1e-4)]
    pub deflection: R,
}

/// Compliance in m/N of a bush that has backlash and no compliance of its own.
const FIRM: f64 = 1e-6;

impl<R: Real> Mount<R> {
    /// Whether the damper is held firmly.
    #[inline]
    pub fn is_firm(&self) -> bool {
        self.gap.vanishes() & self.compliance.vanishes()
    }

    /// The force of bush and damper and the state's rate; `firm` is the damper's force if it is held firmly and
    /// `yielding` the velocity that it has under a force.
    #[inline]
    pub fn force(
        &self,
        state: MountState<R>,
        velocity: R,
        firm: R,
        yielding: impl FnOnce(R) -> R,
    ) -> (R, MountState<R>) {
        let zero = R::from(0.0);
        if self.is_firm() {
            return (firm, MountState { deflection: zero });
        }
        let compliance = self.compliance.select(self.compliance, R::from(FIRM));
        let force = dead_zone(state.deflection, self.gap) / compliance;
        let rate = velocity - yielding(force);
        // Being varied from zero it is firm still.
        let loose = self.gap + self.compliance;
        (loose.select(force, firm), MountState { deflection: loose.select(rate, zero) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const DAMPING: f64 = 1500.0;

    fn at(mount: &Mount<f64>, deflection: f64, v: f64) -> (f64, f64) {
        let (force, rate) = mount.force(MountState { deflection }, v, DAMPING * v, |force| force / DAMPING);
        (force, rate.deflection)
    }

    #[test]
    fn in_steady_motion_the_damper_has_its_whole_velocity() {
        let mount = Mount { gap: 1e-3, compliance: 2e-6 };
        let (force, rate) = at(&mount, 1e-3 + 2e-6 * DAMPING * 0.2, 0.2);
        assert!((force - DAMPING * 0.2).abs() < 1e-9 && rate.abs() < 1e-12);
    }

    #[test]
    fn play_without_compliance_stands_on_a_small_one() {
        assert!((at(&Mount { gap: 1e-3, compliance: 0.0 }, 1.1e-3, 0.0).0 - 100.0).abs() < 1e-9);
    }

    proptest! {
        #[test]
        fn within_the_play_there_is_no_force(share in -1.0..1.0_f64, v in -2.0..2.0_f64) {
            let (force, rate) = at(&Mount { gap: 1e-3, compliance: 0.0 }, share * 1e-3, v);
            prop_assert_eq!((force, rate), (0.0, v));
        }

        #[test]
        fn what_it_does_not_store_it_takes(
            deflection in -5e-3..5e-3_f64,
            v in -2.0..2.0_f64,
            gap in 0.0..3e-3_f64,
            compliance in 1e-7..1e-5_f64,
        ) {
            let (force, rate) = at(&Mount { gap, compliance }, deflection, v);
            // The bush's energy is F² c/2, outside the backlash with F' = e'/c.
            prop_assert!(force * v - force * rate >= -1e-9 * force.abs());
        }

        #[test]
        fn it_is_odd(deflection in -5e-3..5e-3_f64, v in -2.0..2.0_f64) {
            let mount = Mount { gap: 1e-3, compliance: 1e-6 };
            let ((a, b), (c, d)) = (at(&mount, deflection, v), at(&mount, -deflection, -v));
            prop_assert_eq!((a, b), (-c, -d));
        }

        #[test]
        fn without_gap_and_compliance_the_damper_is_held_firmly(deflection in -5e-3..5e-3_f64, v in -2.0..2.0_f64) {
            prop_assert_eq!(at(&Mount { gap: 0.0, compliance: 0.0 }, deflection, v), (DAMPING * v, 0.0));
        }
    }
}
