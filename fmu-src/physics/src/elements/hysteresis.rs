//! What of a strut depends on its past.

use strut_model::{Real, Variables};

use crate::effects::{Maxwell, MaxwellState, Mount, MountState, Presliding, PreslidingState, switched_on};

/// Effects of a strut that have states of their own.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Hysteresis<R> {
    /// Presliding friction
    pub presliding: Presliding<R>,
    /// Maxwell branch
    pub maxwell: Maxwell<R>,
    /// Mount of the damper
    pub mount: Mount<R>,
}

/// What a strut remembers; an effect that is off does not move.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct HysteresisState<R> {
    /// Presliding friction
    pub presliding: PreslidingState<R>,
    /// Maxwell branch
    pub maxwell: MaxwellState<R>,
    /// Mount of the damper
    pub mount: MountState<R>,
}

impl<R: Real> Hysteresis<R> {
    /// How many of these effects are on.
    pub fn active_effects(&self) -> R {
        let Self { presliding, maxwell, mount } = self;
        switched_on([presliding.force, maxwell.stiffness, mount.gap, mount.compliance])
    }
}

impl Hysteresis<f64> {
    /// Refuses a mount in front of no damper.
    ///
    /// # Errors
    /// The parameters, their values and what must hold.
    pub fn check(&self, damping: f64) -> Result<(), String> {
        let Mount { gap, compliance } = self.mount;
        if self.mount.is_firm() || damping > 0.0 {
            return Ok(());
        }
        Err(format!(
            "hysteresis.mount.gap = {gap} m and hysteresis.mount.compliance = {compliance} m/N hold a damper that is \
             not there, strut.damping = {damping} N.s/m: set strut.damping above 0, or both of them to 0"
        ))
    }
}

impl<R: Real> HysteresisState<R> {
    /// Nothing to remember; also the rates of effects that are off.
    #[inline]
    pub fn rest() -> Self {
        let zero = R::from(0.0);
        Self {
            presliding: PreslidingState { friction: zero },
            maxwell: MaxwellState { deflection: zero },
            mount: MountState { deflection: zero },
        }
    }
}
