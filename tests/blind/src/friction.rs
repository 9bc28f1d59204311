//! Dry friction that really sticks.
//!
//! Each contact carries a force that is held during a step of the smooth equations. At the step's end it is
//! corrected to the force that would stop the sliding, as far as its limit allows. A contact that can hold
//! its load therefore does not move at all, and one that slides feels exactly its limit. There is no
//! smoothed sign function. With several contacts the corrections are repeated until they agree
//! (projected Gauss–Seidel).

use std::f64::consts::TAU;

/// How much a contact can carry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// The same at every velocity, in N.
    Coulomb(f64),
    /// Falling from `at_rest` to `sliding` N with the velocity, over `velocity` m/s.
    Stribeck {
        /// Force that it holds at rest.
        at_rest: f64,
        /// Force once it slides fast.
        sliding: f64,
        /// Velocity by which 63 % of the difference are lost.
        velocity: f64,
    },
    /// Growing with the distance from the middle, in N/m.
    Growing(f64),
    /// Changing over the position between 0 and `force`, every `period` metres.
    Periodic {
        /// The largest force, in N.
        force: f64,
        /// In m.
        period: f64,
    },
}

impl Limit {
    /// In N, at a position in m and a sliding velocity in m/s.
    pub fn at(self, position: f64, velocity: f64) -> f64 {
        match self {
            Self::Coulomb(force) => force,
            Self::Stribeck { at_rest, sliding, velocity: scale } => {
                sliding + (at_rest - sliding) * (-(velocity / scale).powi(2)).exp()
            }
            Self::Growing(rate) => rate * position.abs(),
            Self::Periodic { force, period } => force * (0.5 + 0.5 * (TAU * position / period).cos()),
        }
    }
}

/// A place where two parts rub.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Share of each mass's velocity in the sliding velocity: `[1, −1]` between body and wheel.
    pub along: [f64; 2],
    /// How much it can carry.
    pub limit: Limit,
}

impl Contact {
    /// Of two velocities or positions, what the contact sees.
    pub fn seen(&self, of: [f64; 2]) -> f64 {
        self.along[0] * of[0] + self.along[1] * of[1]
    }
}

/// Two masses in kg, and the inertance in kg of an inerter between them: its force is so many times the difference of their
/// accelerations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia {
    /// In kg.
    pub masses: [f64; 2],
    /// In kg.
    pub inertance: f64,
}

impl Inertia {
    /// The accelerations in m/s² under two forces in N; the changes of velocity under two impulses.
    pub fn accelerations(&self, forces: [f64; 2]) -> [f64; 2] {
        let ([one, other], between) = (self.masses, self.inertance);
        if between == 0.0 {
            return [forces[0] / one, forces[1] / other];
        }
        let determinant = one * other + between * (one + other);
        let both = between * (forces[0] + forces[1]);
        [(other * forces[0] + both) / determinant, (one * forces[1] + both) / determinant]
    }
}

impl From<[f64; 2]> for Inertia {
    fn from(masses: [f64; 2]) -> Self {
        Self { masses, inertance: 0.0 }
    }
}

/// Corrects the contacts' forces and the velocities at the end of a step of `step` seconds.
///
/// `forces` resist the sliding velocity; the step was done with them.
pub fn settle(
    contacts: &[Contact],
    forces: &mut [f64],
    positions: [f64; 2],
    velocities: &mut [f64; 2],
    inertia: impl Into<Inertia>,
    step: f64,
) {
    let inertia = inertia.into();
    for _ in 0..60 {
        let mut change = 0.0_f64;
        for (contact, force) in contacts.iter().zip(forces.iter_mut()) {
            let sliding = contact.seen(*velocities);
            let mobility = contact.seen(inertia.accelerations(contact.along));
            let limit = contact.limit.at(contact.seen(positions), sliding);
            let corrected = (*force + sliding / (step * mobility)).clamp(-limit, limit);
            let impulse = (corrected - *force) * step;
            let changes = inertia.accelerations(contact.along.map(|along| impulse * along));
            for (velocity, change) in velocities.iter_mut().zip(changes) {
                *velocity -= change;
            }
            change = change.max((corrected - *force).abs());
            *force = corrected;
        }
        if contacts.len() < 2 || change < 1e-9 {
            break;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MASSES: [f64; 2] = [94.0, 24.0];
    const STEP: f64 = 5e-5;

    #[test]
    fn a_load_below_the_limit_does_not_move() {
        let contacts = [Contact { along: [1.0, 0.0], limit: Limit::Coulomb(50.0) }];
        let (mut forces, mut velocities) = ([0.0], [0.0; 2]);
        for k in 0..1000 {
            let load = 49.0 * (f64::from(k) * 0.01).sin();
            velocities[0] += (load - forces[0]) * STEP / MASSES[0];
            settle(&contacts, &mut forces, [0.0; 2], &mut velocities, MASSES, STEP);
            assert!(velocities[0].abs() < 1e-15);
            assert!((forces[0] - load).abs() < 1e-6);
        }
    }

    #[test]
    fn what_slides_feels_the_limit() {
        let contacts = [Contact { along: [1.0, -1.0], limit: Limit::Coulomb(50.0) }];
        let (mut forces, mut velocities) = ([0.0], [0.3, -0.1]);
        settle(&contacts, &mut forces, [0.0; 2], &mut velocities, MASSES, STEP);
        assert_eq!(forces, [50.0]);
        assert!((velocities[0] - (0.3 - 50.0 * STEP / 94.0)).abs() < 1e-12);
        assert!((velocities[1] - (-0.1 + 50.0 * STEP / 24.0)).abs() < 1e-12);
    }

    /// A contact with an inerter beside it stops both masses as one without, and no momentum is lost.
    #[test]
    fn an_inerter_couples_what_friction_does() {
        let inertia = Inertia { masses: MASSES, inertance: 10.0 };
        let [body, wheel] = inertia.accelerations([940.0, 240.0]);
        assert!((94.0 * body + 24.0 * wheel - 1180.0).abs() < 1e-9);
        assert!((94.0 * body + 10.0 * (body - wheel) - 940.0).abs() < 1e-9);
        let contacts = [Contact { along: [1.0, -1.0], limit: Limit::Coulomb(1e6) }];
        let (mut forces, mut velocities) = ([0.0], [0.3, -0.1]);
        settle(&contacts, &mut forces, [0.0; 2], &mut velocities, inertia, STEP);
        let common = (94.0 * 0.3 - 24.0 * 0.1) / 118.0;
        assert!(velocities.iter().all(|v| (v - common).abs() < 1e-9), "{velocities:?}");
    }

    #[test]
    fn three_contacts_agree() {
        let contacts =
            [[1.0, -1.0], [1.0, 0.0], [0.0, 1.0]].map(|along| Contact { along, limit: Limit::Coulomb(1e6) });
        let (mut forces, mut velocities) = ([0.0; 3], [0.3, -0.1]);
        settle(&contacts, &mut forces, [0.0; 2], &mut velocities, MASSES, STEP);
        assert!(velocities.iter().all(|v| v.abs() < 1e-6), "{velocities:?}");
    }
}
