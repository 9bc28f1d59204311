//! The magnetorheological brake between the arms of the semi-active rig.

use std::f64::consts::LN_10;
use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, Real, Settings, Stimulus, Variables, bundles,
};

use crate::effects::{Pwm, PwmOptions};
use crate::signals::RelativeSpeed;
use crate::table::Table;

/// The brake of Kogut 2.3: its damping rate follows the duty cycle of its coil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MrRotaryBrake {
    pwm: Pwm,
}

/// What can be switched.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    pwm: PwmOptions,
}

/// Points of the profile: duty cycles from 0 to 1, 0.05 apart.
const POINTS: usize = 21;

/// What the brake is.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Static profile k_MR = b(u) I: damping rate at duty cycles of 0, 5, 10 … 100 %
    #[var(unit = N_M_S_PER_RAD, start = [
        0.2632, 0.5058, 0.7402, 0.9664, 1.1843, 1.3940, 1.5955, 1.7888, 1.9738, 2.1506, 2.3192,
        2.4796, 2.6318, 2.7757, 2.9114, 3.0389, 3.1581, 3.2692, 3.3720, 3.4665, 3.5529,
    ], min = 0.0)]
    pub profile: [R; POINTS],
    /// Time in which nine tenths of a new field are there
    #[var(unit = S, start = 0.01, min = 1e-6)]
    pub response_time: R,
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Duty cycle of the coil's current, held between 0 and 1 (u_2, u_MR)
    #[var(unit = ONE)]
    pub duty: R,
    /// Body arm against wheel arm
    pub relative: RelativeSpeed<R>,
}

/// What goes on inside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// Duty cycle that the field in the fluid corresponds to
    #[var(unit = ONE, nominal = 1.0)]
    pub field: R,
}

/// What comes out.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Torque, positive if it resists a positive relative speed
    #[var(unit = N_M)]
    pub torque: R,
    /// Damping rate (k_MR)
    #[var(unit = N_M_S_PER_RAD)]
    pub damping: R,
}

/// What follows from the parameters.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Derived<R> {
    /// Time constant of the field
    #[var(unit = S)]
    pub time_constant: R,
}

impl Model for MrRotaryBrake {
    const ABOUT: About = About {
        name: "MrRotaryBrake",
        summary: "Magnetorheological rotary brake: the duty cycle of its coil sets a damping rate between two parts \
            that turn",
        kind: Kind::Actuator,
        equations: &[
            Equation { text: "T = k_MR(u) (g' - a_1')", source: "Kogut eq. 1, 13" },
            Equation {
                text: "k_MR(u): 21 points, linear in between",
                source: "Kogut 3.1.2, eq. 10-12, Fig. 9",
            },
            Equation {
                text: "u' = (duty - u)/tau, tau = response_time/ln 10",
                source: "Kogut 2.3: less than 10 ms; first order assumed",
            },
            Equation { text: "duty: 0 to 1, in 2^bits - 1 steps", source: "Kogut 2.1: 8 bits" },
        ],
        notes: &[
            "Kogut Fig. 9, the profile b(u), is a lost figure. Printed is b(0) = 0.1921 1/s (Table 1), times I = \
             1.37 kg.m2. The rest is assumed: the records of 3.1.2, which begin at one deflection and are cut where \
             the oscillation has died away, shrink from 2700 to 200 samples; the time of dying away goes as 1/b, so \
             that b(1) = 13.5 b(0) = 2.593 1/s. In between b(u) = b(0) + (b(1) - b(0)) u (3 - u)/2, which levels \
             off as the iron saturates. With these the body of the rig swings by 0.060, 0.047 and 0.042 rad at 30, \
             70 and 100 % on the eccentric at 1.6 Hz, after 0.071 rad without current: the findings of Figs. 15-17.",
            "Kogut's \"less than 10 ms\" is read as the time to nine tenths, as such brakes are specified.",
            "The torque is proportional to the speed, as in the source, which itself finds this simple. A torque \
             that does not depend on the speed is the friction pivot.coulomb of SasRig.",
        ],
        experiment: Experiment {
            stop: 2.0,
            step: 1e-3,
            tolerance: 1e-7,
            stimuli: &[
                ("duty", Stimulus::Step { at: 1.0, height: 0.7 }),
                ("relative.speed", Stimulus::Sine { amplitude: 1.0, frequency: 1.6 }),
            ],
            plot: &["torque", "damping"],
        },
        ..About::DEFAULT
    };

    bundles! {
        settings: Options,
        parameters: Parameters,
        derived: Derived,
        input: Input,
        state: State,
        output: Output,
    }

    fn prepare(options: &Options, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self { pwm: Pwm::new(&options.pwm)? })
    }

    fn derive<R: Real>(&self, p: &Parameters<R>) -> Derived<R> {
        Derived { time_constant: p.response_time / LN_10 }
    }

    #[inline]
    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let duties = std::array::from_fn(|i| R::from(i as f64 / (POINTS - 1) as f64));
        let damping = Table { x: &duties, y: &now.parameters.profile }.held(now.state.field);
        let missing = self.pwm.made(now.input.duty, 0.0) - now.state.field;
        let output = Output { torque: damping * now.input.relative.speed, damping };
        (State { field: missing / now.derived.time_constant }, output)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use strut_model::{Access, Bundle, Declarations, Interface, NoVariables, Simulation};

    fn evaluate(field: f64, duty: f64, speed: f64, bits: i32) -> (State<f64>, Output<f64>) {
        let declared = Declarations::of::<Parameters<f64>>();
        let p: Parameters<f64> = Bundle::from_fn(|i| declared[i].start);
        let brake = MrRotaryBrake::prepare(&Options { pwm: PwmOptions { bits } }, None).unwrap();
        brake.equations(Instant {
            time: 0.0,
            state: &State { field },
            input: &Input { duty, relative: RelativeSpeed { speed } },
            parameters: &p,
            derived: &brake.derive(&p),
            memory: &NoVariables,
            tick: 0,
        })
    }

    #[test]
    fn the_profile_begins_at_table_1_and_ends_where_the_records_say() {
        assert!((evaluate(0.0, 0.0, 2.0, 0).1.torque - 0.1921 * 1.37 * 2.0).abs() < 1e-4);
        assert!((evaluate(1.0, 1.0, 1.0, 0).1.torque - 0.1921 * 1.37 * 2700.0 / 200.0).abs() < 1e-4);
        for i in 0..=20 {
            let u = f64::from(i) * 0.05;
            let b = 0.1921 * (1.0 + 12.5 * u * (3.0 - u) / 2.0);
            assert!((evaluate(u, u, 1.0, 0).1.damping - 1.37 * b).abs() < 6e-5, "{u}");
        }
    }

    #[test]
    fn nine_tenths_of_a_step_are_there_after_10_milliseconds() {
        let interface = Interface::of::<MrRotaryBrake>(None, None).unwrap();
        let reference = |name: &str| interface.variable(name).unwrap().reference;
        let mut brake = Simulation::<MrRotaryBrake>::new(None, None).unwrap();
        brake.set_up(0.0, None).unwrap();
        brake.initialize().unwrap();
        brake.set_real(&[reference("duty")], &[0.6], Access::Continuous).unwrap();
        brake.step(0.0, 0.01).unwrap();
        assert!((brake.states()[0] - 0.54).abs() < 1e-6, "{:?}", brake.states());
    }

    #[test]
    fn a_duty_cycle_of_eight_bits_has_steps() {
        let rate = |duty| evaluate(0.0, duty, 0.0, 8).0.field;
        assert_eq!(rate(0.5), rate(0.5018));
        assert!(rate(0.505) > rate(0.5));
    }

    proptest! {
        #[test]
        fn it_only_takes_energy(field in -0.5..1.5_f64, duty in -1.0..2.0_f64, speed in -20.0..20.0_f64) {
            let (_, output) = evaluate(field, duty, speed, 8);
            prop_assert!(output.torque * speed >= 0.0 && output.damping > 0.0);
        }

        #[test]
        fn the_field_keeps_between_none_and_all(duty in -3.0..3.0_f64, bits in 0..9_i32) {
            prop_assert!(evaluate(0.0, duty, 0.0, bits).0.field >= 0.0);
            prop_assert!(evaluate(1.0, duty, 0.0, bits).0.field <= 0.0);
        }
    }
}
