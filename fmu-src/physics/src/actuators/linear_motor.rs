//! The electrical linear motor in the suspension of the TUM rig.

use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Model, NoSettings, Real, Stimulus, Variables, bundles,
};

use crate::signals::Travel;

use super::Overload;

/// The suspension actuator of TUM 3.2.2 and 4.2: a voltage commands a current, the current makes the force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearMotor;

/// What the motor and its inverter are.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Pole of the current loop (eq. 10)
    #[var(unit = PER_S, start = 320.4019, min = 1e-3)]
    pub electric_pole: R,
    /// Gain from the voltage (eq. 10)
    #[var(unit = PER_V_S, start = 1.2131, min = 1e-6)]
    pub input_gain: R,
    /// Pole of the lag that stands for the delay of 4 ms (eq. 10)
    #[var(unit = PER_S, start = 250.0, min = 1e-3)]
    pub delay_pole: R,
    /// Gain to the current (eq. 11)
    #[var(unit = A, start = 839.4076, min = 1e-6)]
    pub current_gain: R,
    /// Force of one ampere
    #[var(unit = N_PER_A, start = 100.0, min = 1e-6)]
    pub force_constant: R,
    /// Largest command
    #[var(unit = V, start = 10.0, min = 0.0)]
    pub voltage_limit: R,
    /// Current that is allowed for a short time (Table 3: 3200 N)
    #[var(unit = A, start = 32.0, min = 1e-3)]
    pub peak_current: R,
    /// Current that is allowed for ever (Table 3: 800 N)
    #[var(unit = A, start = 8.0, min = 1e-3)]
    pub continuous_current: R,
    /// How long the peak current is allowed, from cold (eq. 1)
    #[var(unit = S, start = 1.0, min = 1e-3)]
    pub peak_time: R,
    /// Last part of the overload capacity over which the limit goes from peak to continuous current
    #[var(unit = ONE, start = 0.02, min = 1e-4, max = 1.0)]
    pub fade: R,
    /// Largest deflection to either side (Table 3: 100 mm traverse path)
    #[var(unit = M, start = 0.05, min = 0.0)]
    pub stroke_limit: R,
    /// Largest speed (Table 3)
    #[var(unit = M_PER_S, start = 4.0, min = 0.0)]
    pub speed_limit: R,
}

impl<R: Real> Parameters<R> {
    #[inline]
    fn overload(&self) -> Overload<R> {
        let Self { peak_current, continuous_current, peak_time, fade, .. } = *self;
        Overload { peak_current, continuous_current, peak_time, fade }
    }
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Command of the inverter (u_v)
    #[var(unit = V)]
    pub voltage: R,
    /// Force that is wanted; adds to the voltage what gives this force in the long run
    #[var(unit = N)]
    pub force_reference: R,
    /// Suspension
    pub suspension: Travel<R>,
}

/// What goes on inside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// State of the current loop (v_1)
    #[var(unit = ONE, nominal = 0.01)]
    pub current_loop: R,
    /// State of the lag that stands for the delay (v_2)
    #[var(unit = ONE, nominal = 0.01)]
    pub delayed: R,
    /// Overload: what the I²t limiter has accumulated (I²T_acc)
    #[var(unit = A2_S, nominal = 10.0)]
    pub overload: R,
}

/// What comes out.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Current (i_act)
    #[var(unit = A)]
    pub current: R,
    /// Force that pushes body and wheel apart
    #[var(unit = N)]
    pub force: R,
    /// Stroke
    pub stroke: Stroke<R>,
    /// Speed
    pub speed: Speed<R>,
}

/// The stroke.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Stroke<R> {
    /// Distance to the nearer end; below zero the rod would hit it
    #[var(unit = M)]
    pub reserve: R,
}

/// The speed.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Speed<R> {
    /// Margin to the largest speed
    #[var(unit = M_PER_S)]
    pub reserve: R,
}

/// What follows from the parameters.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Derived<R> {
    /// Current of one volt in the long run
    #[var(unit = A_PER_V)]
    pub static_gain: R,
    /// Force of one volt in the long run
    #[var(unit = N_PER_V)]
    pub force_gain: R,
    /// Overload at which only the continuous current is left (I²T_set)
    #[var(unit = A2_S)]
    pub overload_capacity: R,
}

impl Model for LinearMotor {
    const ABOUT: About = About {
        name: "LinearMotor",
        summary: "Linear motor in a suspension: current loop with a lag, voltage and I²t limits, stroke and \
            speed reserve",
        kind: Kind::Actuator,
        equations: &[
            Equation { text: "v1' = -320.4019 v1 + 1.2131 u, v2' = 250 (v1 - v2)", source: "TUM eq. 10" },
            Equation { text: "i = 839.4076 v2, F = 100 N/A i", source: "TUM eq. 11, corrected" },
            Equation {
                text: "u = voltage + force_reference/(force per volt), |u| <= 10 V, |u| <= i_limit/(current \
                    per volt)",
                source: "TUM 3.5, Table 3",
            },
            Equation { text: "q' = i^2 - i_c^2 between 0 and Q = (i_p^2 - i_c^2) 1 s", source: "TUM eq. 1" },
            Equation {
                text: "i_limit = i_c + (i_p - i_c) clamp((Q - q)/(0.02 Q), 0, 1)",
                source: "TUM eq. 1, smoothed",
            },
        ],
        notes: &[
            "TUM prints \"1 A ~ 1 kN\" at eq. 11. The static gain of eq. 10-11 is 3.178 A/V, so 10 V would \
             make 31.8 kN; with 100 N/A they make 3178 N, which is the motor's peak force of 3200 N (Table \
             3). 100 N/A is used.",
            "TUM calls the second row of eq. 10 a first-order Padé approximation of 4 ms; as printed it is \
             a lag of 4 ms.",
            "The gain is down by exactly 3 dB at 28.619 Hz; printed are 28.6 Hz.",
            "TUM eq. 1 switches from peak to continuous current at once when the overload reaches Q, and \
             back as soon as it has fallen: the current would chatter between both. Here the limit moves \
             linearly over the last 2 % of Q, so that under a lasting demand the current settles at the \
             continuous one.",
            "Eq. 1 is given for the excitation motor (1860 N for 1 s, 276 N rms); peak and continuous force \
             of this motor are those of Table 3, the second is taken over.",
        ],
        experiment: Experiment {
            stop: 8.0,
            step: 1e-3,
            tolerance: 1e-6,
            stimuli: &[("voltage", Stimulus::Step { at: 0.1, height: 5.0 })],
            plot: &["current", "force"],
        },
        ..About::DEFAULT
    };

    bundles! { parameters: Parameters, derived: Derived, input: Input, state: State, output: Output }

    fn prepare(_: &NoSettings, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self)
    }

    fn derive<R: Real>(&self, p: &Parameters<R>) -> Derived<R> {
        let static_gain = p.input_gain * p.current_gain / p.electric_pole;
        Derived {
            static_gain,
            force_gain: static_gain * p.force_constant,
            overload_capacity: p.overload().capacity(),
        }
    }

    fn check(&self, p: &Parameters<f64>, _: &Derived<f64>) -> Result<(), String> {
        p.overload().check()
    }

    #[inline]
    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (x, u, p) = (now.state, now.input, now.parameters);
        let current = p.current_gain * x.delayed;

        let rates = State {
            current_loop: p.input_gain * command(now) - p.electric_pole * x.current_loop,
            delayed: p.delay_pole * (x.current_loop - x.delayed),
            overload: p.overload().rate(now.derived.overload_capacity, x.overload, current),
        };
        let output = Output {
            current,
            force: p.force_constant * current,
            stroke: Stroke { reserve: p.stroke_limit - u.suspension.deflection.abs() },
            speed: Speed { reserve: p.speed_limit - u.suspension.velocity.abs() },
        };
        (rates, output)
    }
}

/// The voltage that reaches the current loop.
#[inline]
fn command<R: Real>(now: Instant<'_, LinearMotor, R>) -> R {
    let (p, derived) = (now.parameters, now.derived);
    let current_limit = p.overload().current_limit(derived.overload_capacity, now.state.overload);
    let bound = p.voltage_limit.min(current_limit / derived.static_gain);
    (now.input.voltage + now.input.force_reference / derived.force_gain).clamp(-bound, bound)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use strut_model::{Access, Bundle, Declarations, Interface, Simulation};

    fn parameters() -> Parameters<f64> {
        let declared = Declarations::of::<Parameters<f64>>();
        Bundle::from_fn(|i| declared[i].start)
    }

    fn evaluate(x: [f64; 3], u: [f64; 4]) -> (State<f64>, Output<f64>) {
        let p = parameters();
        LinearMotor.equations(Instant {
            time: 0.0,
            state: &Bundle::from_fn(|i| x[i]),
            input: &Bundle::from_fn(|i| u[i]),
            parameters: &p,
            derived: &LinearMotor.derive(&p),
            memory: &strut_model::NoVariables,
            tick: 0,
        })
    }

    #[test]
    fn ten_volts_are_the_peak_force_of_table_3() {
        let derived = LinearMotor.derive(&parameters());
        assert!((derived.static_gain - 3.178).abs() < 5e-4);
        assert!((derived.force_gain * 10.0 / 3200.0 - 1.0).abs() < 0.01);
    }

    /// Gain of the linear part at a frequency, from the rates at unit states and unit voltage.
    fn gain(frequency: f64) -> f64 {
        let omega = std::f64::consts::TAU * frequency;
        let (a11, a21) = {
            let (rates, _) = evaluate([1.0, 0.0, 0.0], [0.0; 4]);
            (rates.current_loop, rates.delayed)
        };
        let a22 = evaluate([0.0, 1.0, 0.0], [0.0; 4]).0.delayed;
        let b1 = evaluate([0.0; 3], [1.0, 0.0, 0.0, 0.0]).0.current_loop;
        let c2 = evaluate([0.0, 1.0, 0.0], [0.0; 4]).1.current;
        c2 * a21 * b1 / ((a11.hypot(omega)) * (a22.hypot(omega)))
    }

    #[test]
    fn the_gain_is_3_decibels_down_at_28_6_hertz() {
        let decibels = 20.0 * (gain(28.619) / gain(0.0)).log10();
        assert!((decibels + 3.0).abs() < 1e-3, "{decibels}");
    }

    fn simulation(voltage: f64) -> Simulation<LinearMotor> {
        let mut simulation = Simulation::new(None, None).unwrap();
        let reference =
            Interface::of::<LinearMotor>(None, None).unwrap().variable("voltage").unwrap().reference;
        simulation.set_up(0.0, None).unwrap();
        simulation.initialize().unwrap();
        simulation.set_real(&[reference], &[voltage], Access::Continuous).unwrap();
        simulation
    }

    fn current(simulation: &mut Simulation<LinearMotor>) -> f64 {
        let reference =
            Interface::of::<LinearMotor>(None, None).unwrap().variable("current").unwrap().reference;
        let mut value = [0.0];
        simulation.real(&[reference], &mut value).unwrap();
        value[0]
    }

    #[test]
    fn the_answer_to_5_volts_is_that_of_two_lags() {
        let (p1, p2) = (320.4019, 250.0);
        let mut motor = simulation(5.0);
        for step in 0..40 {
            motor.step(f64::from(step) * 1e-3, 1e-3).unwrap();
            let t = f64::from(step + 1) * 1e-3;
            let exact = 5.0 * gain(0.0) * (1.0 - (p1 * (-p2 * t).exp() - p2 * (-p1 * t).exp()) / (p1 - p2));
            assert!((current(&mut motor) - exact).abs() < 1e-5, "{t}");
        }
    }

    #[test]
    fn a_lasting_demand_gets_the_continuous_current() {
        let mut motor = simulation(10.0);
        let (mut squares, mut peak) = (0.0, 0.0_f64);
        for step in 0..30_000 {
            motor.step(f64::from(step) * 1e-3, 1e-3).unwrap();
            if step % 10 == 9 {
                let i = current(&mut motor);
                peak = peak.max(i);
                squares += if step >= 20_000 { i * i } else { 0.0 };
            }
        }
        assert!(peak > 31.7, "{peak}");
        assert!(((squares / 1000.0).sqrt() - 8.0).abs() < 1e-3, "{squares}");
    }

    proptest! {
        #[test]
        fn the_command_keeps_to_both_limits(q in 0.0..960.0_f64, voltage in -50.0..50.0_f64, force in -1e4..1e4_f64) {
            let (rates, _) = evaluate([0.0, 0.0, q], [voltage, force, 0.0, 0.0]);
            let command = rates.current_loop / 1.2131;
            prop_assert!(command.abs() <= 10.0 + 1e-12);
            if q >= 959.999_999 {
                prop_assert!(command.abs() * 3.1782 <= 8.001);
            }
        }

        #[test]
        fn a_force_reference_is_the_force_in_the_long_run(force in -3000.0..3000.0_f64) {
            let (rates, _) = evaluate([0.0; 3], [0.0, force, 0.0, 0.0]);
            let delayed = rates.current_loop / 320.4019;
            prop_assert!((evaluate([delayed, delayed, 0.0], [0.0; 4]).1.force - force).abs() < 1e-9);
        }

        #[test]
        fn the_overload_stays_between_nothing_and_its_capacity(delayed in -0.04..0.04_f64) {
            prop_assert!(evaluate([0.0, delayed, 0.0], [0.0; 4]).0.overload >= 0.0);
            prop_assert!(evaluate([0.0, delayed, 960.0], [0.0; 4]).0.overload <= 0.0);
        }
    }

    #[test]
    fn reserves_count_to_the_nearer_end() {
        let (_, output) = evaluate([0.0; 3], [0.0, 0.0, -0.03, 1.5]);
        assert!((output.stroke.reserve - 0.02).abs() < 1e-15 && output.speed.reserve == 2.5);
    }
}
