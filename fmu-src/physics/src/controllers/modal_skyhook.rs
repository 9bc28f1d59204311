//! Dampers between a car's body and the sky, one for each of heave, roll and pitch.

use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, NoSettings, NoVariables, Real, Stimulus, Variables,
    bundles,
};

use crate::car::{Corners, Geometry, Modal};
use crate::signals::{AngularSpeed, Command, Velocity};

/// Modal skyhook control, Ajala eq. 47–49: three virtual dampers, distributed to four actuators; sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModalSkyhook;

/// What the controller is.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Damper to the sky
    pub damping: Damping<R>,
    /// Where the actuators are
    pub geometry: Geometry<R>,
    /// Sampling period
    #[var(unit = S, start = 1e-3, min = 1e-6, fixed)]
    pub period: R,
}

/// The skyhook damping parameters. Declared is what a damper of 1500 N s/m to the sky at each corner would be
/// (assumed).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Damping<R> {
    /// Against heave (C_SH,H)
    #[var(unit = N_S_PER_M, start = 6000.0, min = 0.0)]
    pub heave: R,
    /// Against roll (C_SH,R)
    #[var(unit = N_M_S_PER_RAD, start = 3650.0, min = 0.0)]
    pub roll: R,
    /// Against pitch (C_SH,P)
    #[var(unit = N_M_S_PER_RAD, start = 10935.0, min = 0.0)]
    pub pitch: R,
}

/// What is measured.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Body's centre of mass
    pub heave: Velocity<R>,
    /// Body, left side up
    pub roll: AngularSpeed<R>,
    /// Body, rear up
    pub pitch: AngularSpeed<R>,
}

/// What is wanted of the actuators, also what is held between samples.
pub type Commands<R> = Corners<Command<R>>;

impl Model for ModalSkyhook {
    const ABOUT: About = About {
        name: "ModalSkyhook",
        summary: "Skyhook controller of a car: dampers between body and sky in heave, roll and pitch, distributed \
            to four actuators",
        kind: Kind::Controller,
        equations: &[
            Equation {
                text: "F_H = -C_SH,H z_H', M_R = -C_SH,R phi_R', M_P = -C_SH,P phi_P'",
                source: "Ajala eq. 47",
            },
            Equation { text: "(F_fl, F_fr, F_rl, F_rr) = M (F_H, M_R, M_P)", source: "Ajala eq. 48" },
            Equation {
                text: "M = [l_r w_r, l_r, -w_r; l_r w_l, -l_r, -w_l; l_f w_r, l_f, w_r; l_f w_l, -l_f, w_l]/((l_f + \
                    l_r)(w_l + w_r))",
                source: "Ajala eq. 49, corrected",
            },
        ],
        notes: &[
            "Ajala eq. 49 prints the denominator (l_f + l_r)(w_f + w_r). The second factor means w_l + w_r, the \
             half tracks on the left and on the right: only then do unit demands come out as unit force and \
             moments.",
            "The last entry of M is printed -w_l and must be +w_l: as printed, a pitch demand M_P would come with \
             a heave force of -2 w_l M_P/((l_f + l_r)(w_l + w_r)), on the car of the set AjalaFullCar -0.37 N for \
             each N.m, and with a moment in roll. Checked by multiplying M by the corners' lever arms.",
            "Roll is positive if the left side rises, pitch if the rear rises: that is what the signs of M say.",
            "Ajala gives no values for C_SH,H, C_SH,R and C_SH,P; the declared ones are assumed. Section 5 refers \
             to the body control law as eq. 27; it is eq. 28.",
            "The forces are held between samples.",
        ],
        experiment: Experiment {
            stop: 2.0,
            step: 1e-3,
            stimuli: &[
                ("heave.velocity", Stimulus::Sine { amplitude: 0.2, frequency: 1.2 }),
                ("roll.speed", Stimulus::Sine { amplitude: 0.2, frequency: 1.6 }),
                ("pitch.speed", Stimulus::Cosine { amplitude: 0.1, frequency: 1.3 }),
            ],
            plot: &["front_left.force", "front_right.force", "rear_left.force", "rear_right.force"],
            ..Experiment::DEFAULT
        },
        ..About::DEFAULT
    };

    bundles! { parameters: Parameters, input: Input, memory: Commands, output: Commands }

    fn prepare(_: &NoSettings, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self)
    }

    fn period(parameters: &Parameters<f64>) -> Option<f64> {
        Some(parameters.period)
    }

    fn tick<R: Real>(&self, now: Instant<'_, Self, R>) -> Commands<R> {
        let (Parameters { damping, geometry, .. }, input) = (now.parameters, now.input);
        let demand = Modal {
            heave: -(damping.heave * input.heave.velocity),
            roll: -(damping.roll * input.roll.speed),
            pitch: -(damping.pitch * input.pitch.speed),
        };
        geometry.distribution(demand).map(|force| Command { force }).into()
    }

    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (NoVariables, Commands<R>) {
        (NoVariables, *now.memory)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const CAR: Geometry<f64> = Geometry { front: 1.2, rear: 1.5, left: 0.8, right: 0.7 };

    fn forces(geometry: Geometry<f64>, damping: Damping<f64>, velocities: [f64; 3]) -> [f64; 4] {
        let [heave, roll, pitch] = velocities;
        let now = Instant {
            time: 0.0,
            state: &NoVariables,
            input: &Input {
                heave: Velocity { velocity: heave },
                roll: AngularSpeed { speed: roll },
                pitch: AngularSpeed { speed: pitch },
            },
            parameters: &Parameters { damping, geometry, period: 1e-3 },
            derived: &NoVariables,
            memory: &[Command { force: 0.0 }; 4].into(),
            tick: 0,
        };
        ModalSkyhook.tick(now).to_array().map(|command| command.force)
    }

    #[test]
    fn unit_demands_make_unit_force_and_moments() {
        let unit = Damping { heave: 1.0, roll: 1.0, pitch: 1.0 };
        for (i, expected) in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].into_iter().enumerate() {
            let velocities = std::array::from_fn(|j| if i == j { -1.0 } else { 0.0 });
            let sum = CAR.resultant(forces(CAR, unit, velocities));
            for (found, expected) in [sum.heave, sum.roll, sum.pitch].into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-15, "{i}: {sum:?}");
            }
        }
    }

    #[test]
    fn on_a_symmetric_car_a_rising_rear_is_pulled_down_at_the_rear() {
        let car = Geometry { front: 1.35, rear: 1.35, left: 0.78, right: 0.78 };
        let damping = Damping { heave: 6000.0, roll: 3650.0, pitch: 10935.0 };
        // Of −C_SH,P ϕ̇_P each corner carries a quarter over its lever: 0.1 · 10935/(4 · 1.35).
        let found = forces(car, damping, [0.0, 0.0, 0.1]);
        for (force, expected) in found.into_iter().zip([202.5, 202.5, -202.5, -202.5]) {
            assert!((force - expected).abs() < 1e-9, "{found:?}");
        }
    }

    proptest! {
        #[test]
        fn it_takes_energy_from_the_body(
            velocities in prop::array::uniform3(-1.0..1.0_f64),
            rates in prop::array::uniform3(0.0..1e4_f64),
        ) {
            let [heave, roll, pitch] = velocities;
            let damping = Damping { heave: rates[0], roll: rates[1], pitch: rates[2] };
            let corners = CAR.at_corners(Modal { heave, roll, pitch });
            let power: f64 = forces(CAR, damping, velocities).iter().zip(corners).map(|(f, v)| f * v).sum();
            prop_assert!(power <= 1e-9, "{power}");
        }
    }
}
