//! A corner of a car: a wheel between a strut and the road.

use strut_model::Real;

use crate::effects::LiftOff;
use crate::signals::{Deflection, Motion, RoadMotion, Travel, WheelMotion};

use super::Tire;

/// What carries a corner of a car, or the body of a quarter car (TUM eq. 3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner<'a, R> {
    /// The wheel.
    pub unsprung_mass: R,
    /// Between wheel and road.
    pub tire: &'a Tire<R>,
    /// Where the tyre leaves the road, if it can.
    pub lift_off: Option<LiftOff<R>>,
    /// Zero if no effect is on that [`Tire::force`] calls further.
    pub further: R,
}

/// What a corner does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moving<R> {
    /// Force of the strut, which pulls body and wheel together.
    pub strut_force: R,
    /// The wheel's own motion and force.
    pub wheel: WheelMotion<R>,
    /// Between body and wheel.
    pub suspension: Travel<R>,
    /// Between wheel and road.
    pub tire: Deflection<R>,
}

impl<R: Real> Corner<'_, R> {
    /// Between a body and a road that move; `actuator` is the force that pushes body and wheel apart, `strut` makes of
    /// deflection and velocity the one that pulls them together.
    #[inline(always)]
    pub fn between(
        &self,
        body: Motion<R>,
        wheel: Motion<R>,
        road: RoadMotion<R>,
        actuator: R,
        strut: impl FnOnce(R, R) -> R,
    ) -> Moving<R> {
        let (deflection, velocity) = (body.position - wheel.position, body.velocity - wheel.velocity);
        let strut_force = strut(deflection, velocity);
        let compression = road.position - wheel.position;
        let free = self.tire.force(compression, road.velocity - wheel.velocity, self.further);
        let force = match self.lift_off {
            Some(lift_off) => lift_off.applied(free, compression),
            None => free,
        };
        // The reciprocal does not wait for the forces as the quotient would.
        let acceleration = (strut_force - actuator + force) * (R::from(1.0) / self.unsprung_mass);
        Moving {
            strut_force,
            wheel: WheelMotion { acceleration, force },
            suspension: Travel { deflection, velocity },
            tire: Deflection { deflection: wheel.position - road.position },
        }
    }
}
