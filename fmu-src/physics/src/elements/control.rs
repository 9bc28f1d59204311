//! A damper that an electric current sets.

use std::borrow::Cow;

use strut_model::{Real, Variables};

use crate::effects::{behind_lag, switched_on};

use super::Strut;

/// Smallest share of its damping rate that a damper keeps, whatever sets it.
const LEAST: f64 = 1e-3;

/// What a current makes of a damper whose fluid is magnetorheological or whose valve is a magnet's, over the share
/// `s = |i|/i_r` of a rated current or voltage: `d + d_s m(s)` and `F_y + F_s m(s)` with `m(s) = s/(1 + κ s)`, `s` behind a lag.
///
/// Yield force and damping rate that rise with what drives the coil, and the lag, are those of Spencer et al. (1997); κ is
/// the magnet's saturation by Fröhlich and Kennelly (1891), `B = H/(a + b H)`. Either direction of the current does the same.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Control<R> {
    /// Current of a share of one (i_r)
    #[var(unit = A, start = 1.0, min = 1e-6)]
    pub rated_current: R,
    /// Voltage of a share of one
    #[var(unit = V, start = 1.0, min = 1e-6)]
    pub rated_voltage: R,
    /// Yield force that the rated current adds (F_s)
    #[var(unit = N, start = 0.0)]
    pub yield_force: R,
    /// Damping rate that the rated current adds (d_s)
    #[var(unit = N_S_PER_M, start = 0.0)]
    pub damping: R,
    /// How much less than in proportion they grow (κ): at the rated current, both are divided by 1 + κ
    #[var(unit = ONE, start = 0.0, min = 0.0)]
    pub saturation: R,
    /// Time constant of the lag
    #[var(unit = S, start = 0.0, min = 0.0)]
    pub lag: R,
}

/// What is on its way from current to force.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct ControlState<R> {
    /// Share of the rated current that has arrived
    #[var(unit = ONE)]
    pub arrived: R,
}

impl<R: Real> Control<R> {
    /// The strut as this share of the rated current makes it, and how fast the share that has arrived rises. Only a strut that
    /// is set is copied.
    #[inline]
    pub fn acting_on<'a>(
        &self,
        strut: &'a Strut<R>,
        state: ControlState<R>,
        share: R,
    ) -> (Cow<'a, Strut<R>>, ControlState<R>) {
        if self.is_off() {
            return (Cow::Borrowed(strut), Self::rest());
        }
        let (arrived, rate) = behind_lag(self.lag, state.arrived, share.abs());
        let field = arrived / (arrived * self.saturation + 1.0);
        let mut set = *strut;
        set.r#yield.force = (strut.r#yield.force + self.yield_force * field).max(R::from(0.0));
        set.damping = (strut.damping + self.damping * field).max(strut.damping * LEAST);
        (Cow::Owned(set), ControlState { arrived: rate })
    }

    /// How many effects are on.
    pub fn active_effects(&self) -> R {
        switched_on([self.yield_force, self.damping])
    }

    /// Nothing on its way; also the rate while nothing is set.
    #[inline]
    pub fn rest() -> ControlState<R> {
        ControlState { arrived: R::from(0.0) }
    }

    #[inline]
    fn is_off(&self) -> bool {
        self.yield_force.vanishes() & self.damping.vanishes()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use strut_model::{Bundle, Declarations};

    use super::*;

    fn neutral<B: Bundle<f64>>() -> B {
        let declared = Declarations::of::<B>();
        B::from_fn(|i| declared[i].start)
    }

    fn damper() -> Strut<f64> {
        let mut damper: Strut<f64> = neutral();
        (damper.stiffness, damper.damping) = (0.0, 1285.0);
        (damper.r#yield.force, damper.r#yield.velocity) = (235.0, 0.01);
        damper
    }

    const CONTROL: Control<f64> = Control {
        rated_current: 1.0,
        rated_voltage: 1.0,
        yield_force: 354.0,
        damping: 428.0,
        saturation: 0.0,
        lag: 0.0,
    };

    /// The force at a velocity with a share of the rated current that has been there for long.
    fn force(control: Control<f64>, share: f64, velocity: f64) -> f64 {
        let damper = damper();
        let (damper, _) = control.acting_on(&damper, ControlState { arrived: share.abs() }, share);
        damper.force(0.0, 0.0, velocity, 1.0)
    }

    #[test]
    fn damping_and_yield_force_rise_with_the_current() {
        // Far beyond the yield force's velocity: (1285 + 2 * 428) 0.2 + 235 + 2 * 354.
        assert!((force(CONTROL, 2.0, 0.2) - (2141.0 * 0.2 + 943.0)).abs() < 1e-9);
        assert!((force(CONTROL, 0.0, 0.2) - (1285.0 * 0.2 + 235.0)).abs() < 1e-9);
    }

    #[test]
    fn a_saturated_magnet_adds_less() {
        let saturated = Control { saturation: 0.5, ..CONTROL };
        assert!((force(saturated, 2.0, 0.2) - force(CONTROL, 1.0, 0.2)).abs() < 1e-9);
    }

    #[test]
    fn what_sets_it_arrives_late() {
        let late = Control { lag: 0.02, ..CONTROL };
        let damper = damper();
        let (damper, rate) = late.acting_on(&damper, ControlState { arrived: 0.5 }, -1.0);
        assert!((damper.damping - 1499.0).abs() < 1e-9 && (rate.arrived - 25.0).abs() < 1e-9);
    }

    #[test]
    fn what_is_on_counts_and_what_is_off_changes_nothing() {
        assert_eq!((CONTROL.active_effects(), neutral::<Control<f64>>().active_effects()), (2.0, 0.0));
        let off = Control { lag: 0.02, saturation: 1.0, ..neutral() };
        let damper = damper();
        assert_eq!(off.acting_on(&damper, Control::rest(), 3.0), (Cow::Borrowed(&damper), Control::rest()));
    }

    proptest! {
        #[test]
        fn it_takes_energy_whatever_sets_it(
            share in -5.0..5.0_f64,
            velocity in -2.0..2.0_f64,
            yield_force in -1e3..1e3_f64,
            damping in -3e3..3e3_f64,
            saturation in 0.0..3.0_f64,
        ) {
            let control = Control { yield_force, damping, saturation, ..CONTROL };
            prop_assert!(force(control, share, velocity) * velocity >= 0.0);
            prop_assert_eq!(force(control, share, velocity), force(control, -share, velocity));
        }
    }
}
