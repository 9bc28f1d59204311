//! The linear motor below the wheel of the TUM rig, with its drive.

mod loops;
mod profile;

use std::path::Path;

use strut_model::{
    About, Choice, Equation, Experiment, Instant, Kind, Model, Real, Settings, Stimulus, Variables, bundles,
};

use crate::effects::Coulomb;

use super::Overload;
use super::linear_motor::{Speed, Stroke};
use loops::{
    CurrentLoop, CurrentLoopState, FeedForward, PositionLoop, Regulated, VelocityLoop, VelocityLoopState,
    cascade, regulated,
};
use profile::{Point, Profile};

/// The excitation actuator of TUM 3.2.1 and Fig. 4–7: a cascade from position to velocity to current moves a rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExcitationMotor {
    drive: Drive,
}

/// What the drive controls.
#[derive(Choice, Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// Position: the whole cascade of TUM Fig. 4–7
    Position,
    /// Force: the current loop alone
    Force,
    /// Voltage: no loop at all
    Voltage,
}

/// What can be chosen.
#[derive(Settings, Clone, Debug, PartialEq)]
pub struct Options {
    /// What the drive controls
    #[set(start = Drive::Position)]
    drive: Drive,
}

/// What the motor, its load and its drive are. TUM gives peak and continuous force only; the other declared values are
/// chosen, and argued for in the parameter set TumExcitationMotor.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Moving mass: rod, base plate and what else moves with them
    #[var(unit = KG, start = 16.0, min = 1e-3)]
    pub moving_mass: R,
    /// Guide of the rod
    pub guide: Guide<R>,
    /// Springs that carry the static load of the rig (3)
    pub base_spring: BaseSpring<R>,
    /// Static load that the springs leave to the motor, positive downwards
    #[var(unit = N, start = 0.0, port)]
    pub constant_load: R,
    /// Force of one ampere, and voltage that is induced at one metre per second
    #[var(unit = N_PER_A, start = 93.0, min = 1e-6)]
    pub force_constant: R,
    /// Resistance
    #[var(unit = OHM, start = 12.7, min = 1e-6)]
    pub resistance: R,
    /// Inductance
    #[var(unit = H, start = 0.016, min = 1e-6)]
    pub inductance: R,
    /// Largest voltage that the drive can give
    #[var(unit = V, start = 329.0, min = 0.0)]
    pub voltage_limit: R,
    /// Current that is allowed for a short time (3.2.1: 1860 N)
    #[var(unit = A, start = 20.0, min = 1e-3)]
    pub peak_current: R,
    /// Current that is allowed for ever (3.2.1: 276 N)
    #[var(unit = A, start = 2.967741935483871, min = 1e-3)]
    pub continuous_current: R,
    /// How long the peak current is allowed, from cold (eq. 1)
    #[var(unit = S, start = 1.0, min = 1e-3)]
    pub peak_time: R,
    /// Last part of the overload capacity over which the limit goes from peak to continuous current
    #[var(unit = ONE, start = 0.02, min = 1e-4, max = 1.0)]
    pub fade: R,
    /// Largest deflection to either side; a position command is held within it
    #[var(unit = M, start = 0.06, min = 0.0)]
    pub stroke_limit: R,
    /// Largest speed; the velocity loop's command is held within it
    #[var(unit = M_PER_S, start = 3.0, min = 0.0)]
    pub speed_limit: R,
    /// Half the width of the dead zone of the position command
    #[var(unit = M, start = 5e-5, min = 0.0)]
    pub dead_zone: R,
    /// Profile that the drive makes of the command (Fig. 4)
    pub profile: Profile<R>,
    /// Feed-forward from the profile to the velocity loop (Fig. 5)
    pub feed_forward: FeedForward<R>,
    /// Position loop (Fig. 5)
    pub position_loop: PositionLoop<R>,
    /// Velocity loop (Fig. 6)
    pub velocity_loop: VelocityLoop<R>,
    /// Current loop (Fig. 7)
    pub current_loop: CurrentLoop<R>,
    /// Force that the drive adds against a static load, positive upwards (Fig. 7: offset)
    #[var(unit = N, start = 0.0)]
    pub force_offset: R,
}

/// The guide of the rod.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Guide<R> {
    /// Friction
    pub coulomb: Coulomb<R>,
    /// Viscous friction, eddy currents included
    #[var(unit = N_S_PER_M, start = 3.7, min = 0.0)]
    pub damping: R,
}

/// The springs below the base plate.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct BaseSpring<R> {
    /// Rate of all together
    #[var(unit = N_PER_M, start = 4000.0, min = 0.0)]
    pub stiffness: R,
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Command to the drive
    pub command: Command<R>,
    /// External force on the rod
    pub load: Load<R>,
    /// Wheel on the base plate
    pub wheel: Wheel<R>,
}

/// What the drive is told; which of it acts is told by the setting `drive`.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Command<R> {
    /// Position (setting Position)
    #[var(unit = M)]
    pub position: R,
    /// Force; with the setting Position it adds to what the loops demand
    #[var(unit = N)]
    pub force: R,
    /// Voltage (setting Voltage)
    #[var(unit = V)]
    pub voltage: R,
}

/// What else acts on the rod.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Load<R> {
    /// Force, positive upwards
    #[var(unit = N)]
    pub force: R,
}

/// The wheel on the base plate, as a rig puts it out.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Wheel<R> {
    /// Dynamic wheel load, positive if it presses on the plate
    #[var(unit = N)]
    pub force: R,
}

/// What goes on inside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// Height of the rod above its static equilibrium
    #[var(unit = M, nominal = 0.01, output)]
    pub position: R,
    /// Velocity of the rod, positive upwards
    #[var(unit = M_PER_S, nominal = 0.1, output)]
    pub velocity: R,
    /// Current
    #[var(unit = A, nominal = 1.0, output)]
    pub current: R,
    /// Overload: what the I²t limiter has accumulated (I²T_acc)
    #[var(unit = A2_S, nominal = 10.0)]
    pub overload: R,
    /// Command, derived
    pub target: Point<R>,
    /// Profile: the command within its limits
    pub profile: Point<R>,
    /// Velocity loop
    pub velocity_loop: VelocityLoopState<R>,
    /// Current loop
    pub current_loop: CurrentLoopState<R>,
}

/// What comes out.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Acceleration of the rod, positive upwards
    #[var(unit = M_PER_S2)]
    pub acceleration: R,
    /// Force of the motor, positive upwards
    #[var(unit = N)]
    pub force: R,
    /// Voltage
    #[var(unit = V)]
    pub voltage: R,
    /// Electrical power
    #[var(unit = W)]
    pub power: R,
    /// Commanded position less the rod's
    #[var(unit = M)]
    pub following_error: R,
    /// Stroke
    pub stroke: Stroke<R>,
    /// Speed
    pub speed: Speed<R>,
}

/// What follows from the parameters.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Derived<R> {
    /// Force that is allowed for a short time
    #[var(unit = N)]
    pub peak_force: R,
    /// Force that is allowed for ever
    #[var(unit = N)]
    pub continuous_force: R,
    /// Overload at which only the continuous current is left (I²T_set)
    #[var(unit = A2_S)]
    pub overload_capacity: R,
}

impl<R: Real> Parameters<R> {
    #[inline]
    fn overload(&self) -> Overload<R> {
        let Self { peak_current, continuous_current, peak_time, fade, .. } = *self;
        Overload { peak_current, continuous_current, peak_time, fade }
    }
}

impl Model for ExcitationMotor {
    const ABOUT: About = About {
        name: "ExcitationMotor",
        summary: "Linear motor that moves the road plate of a rig: drive with profile, position, velocity and \
            current loop and I²t limit; rod, friction, base springs",
        kind: Kind::Actuator,
        equations: &[
            Equation {
                text: "target r: r'' = p^2 (c - r) - 2 p r', c = command.position less the dead zone, |c| <= \
                    stroke limit",
                source: "TUM 3.2.1, Fig. 4",
            },
            Equation {
                text: "profile s: s'' = r'' + 2 p (r' + a(r - s) - s'), |s''| <= limit, |s'| <= limit",
                source: "TUM Fig. 4",
            },
            Equation {
                text: "a(e) = sign(e) (sqrt(2 b |e| + d^2) - d), b = 0.8 of the acceleration limit, d = 2 b/p",
                source: "chosen: the velocity from which it can still brake",
            },
            Equation {
                text: "v_c = k_v s' + k_a s'' + k_x (s - x), |v_c| <= speed limit, then a filter",
                source: "TUM Fig. 5, 6",
            },
            Equation {
                text: "i_v = k_p (v_c - v) + integral of k_i (v_c - v), then a filter",
                source: "TUM Fig. 6",
            },
            Equation {
                text: "i_c = i_v + (command.force + offset)/k_f, |i_c| <= i_limit",
                source: "TUM Fig. 7",
            },
            Equation {
                text: "u = k_c (i_c - i) + integral of k_ci (i_c - i), |u| <= voltage limit",
                source: "TUM Fig. 7",
            },
            Equation {
                text: "L i' = u - R i - k_f v, F = k_f i",
                source: "TUM 3.2.1: force proportional to current",
            },
            Equation {
                text: "m x'' = F - k x - d x' - F_c tanh(x'/v_0) - F_const + load.force - wheel.force",
                source: "TUM 3, 3.2.1; friction: eq. 12",
            },
            Equation { text: "q' = i^2 - i_c^2 between 0 and Q = (i_p^2 - i_c^2) t_p", source: "TUM eq. 1" },
            Equation {
                text: "i_limit = i_c + (i_p - i_c) clamp((Q - q)/(0.02 Q), 0, 1)",
                source: "TUM eq. 1, smoothed",
            },
        ],
        notes: &[
            "Positions count upwards from static equilibrium. wheel.force is a rig's output of this name: it \
             presses the plate down. load.force is for anything else and counts upwards. position and velocity \
             are what a rig takes as its road.",
            "With the setting Force only the current loop works, with the setting Voltage no loop: the same \
             motor as a linear positioning drive, force or voltage in and position out. The current limit needs \
             the current loop; under Voltage it does not act.",
            "The loops of such a drive are digital. Their sampling (15 kHz for the current, 3 kHz for the others in \
             the drives with these block diagrams) lies a hundred times above the 25 Hz that the rig is made for, so \
             the loops are continuous here. The model then has exact derivatives and costs no ticks.",
            "How the profile is made is not printed. Here the command passes two lags, so that it has a velocity and \
             an acceleration; a profile follows them exactly within its limits, and beyond them approaches with the \
             velocity from which it can still brake.",
            "TUM eq. 1 switches from peak to continuous current at once when the overload reaches Q, and back as \
             soon as it has fallen: the current would chatter between both. Here the limit moves linearly over the \
             last 2 % of Q, so that under a lasting demand the current settles at the continuous one.",
            "TUM 2.1 wants amplitudes of up to 5 cm in 0-25 Hz. Both together are out of reach: 5 cm at 25 Hz are \
             1234 m/s2, for which 1860 N could move 1.5 kg, less than the rod alone. With the declared 16 kg and \
             80 m/s2 the amplitude is 5 cm up to 6.4 Hz, 20 mm at 10 Hz and 3.2 mm at 25 Hz, for a second; for ever \
             (276 N rms) 33 mm at 5 Hz, 6.6 mm at 10 Hz and 1 mm at 25 Hz, friction and the wheel's load not counted.",
            "Both integrators stop running away when what they feed is limited (back-calculation with their own \
             time constant).",
        ],
        experiment: Experiment {
            stop: 2.0,
            step: 1e-3,
            // Limits that are reached and left within milliseconds ask for it.
            tolerance: 1e-7,
            stimuli: &[("command.position", Stimulus::Sine { amplitude: 0.02, frequency: 3.0 })],
            plot: &["position", "velocity", "force", "following_error"],
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
        Ok(Self { drive: options.drive })
    }

    fn derive<R: Real>(&self, p: &Parameters<R>) -> Derived<R> {
        Derived {
            peak_force: p.force_constant * p.peak_current,
            continuous_force: p.force_constant * p.continuous_current,
            overload_capacity: p.overload().capacity(),
        }
    }

    fn check(&self, p: &Parameters<f64>, _: &Derived<f64>) -> Result<(), String> {
        p.overload().check()
    }

    #[inline]
    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (x, u, p) = (now.state, now.input, now.parameters);
        let resting = State::resting();
        let limit = p.overload().current_limit(now.derived.overload_capacity, x.overload);

        let (mut rates, demand) = match self.drive {
            Drive::Position => cascade(now, limit),
            Drive::Force | Drive::Voltage => (resting, R::from(0.0)),
        };
        let voltage = match self.drive {
            Drive::Position | Drive::Force => {
                let command = demand + (u.command.force + p.force_offset) / p.force_constant;
                let Regulated { output, integrator } = regulated(
                    [p.current_loop.proportional, p.current_loop.integral],
                    command.clamp(-limit, limit) - x.current,
                    x.current_loop.integrator,
                    p.voltage_limit,
                );
                rates.current_loop.integrator = integrator;
                output
            }
            Drive::Voltage => u.command.voltage.clamp(-p.voltage_limit, p.voltage_limit),
        };

        let force = p.force_constant * x.current;
        let passive = || p.base_spring.stiffness * x.position + p.guide.damping * x.velocity;
        let held_back = p.guide.coulomb.added_to(passive, x.velocity) + p.constant_load;
        let acceleration = (force - held_back + u.load.force - u.wheel.force) / p.moving_mass;

        rates.position = x.velocity;
        rates.velocity = acceleration;
        rates.current = (voltage - p.resistance * x.current - p.force_constant * x.velocity) / p.inductance;
        rates.overload = p.overload().rate(now.derived.overload_capacity, x.overload, x.current);
        let output = Output {
            acceleration,
            force,
            voltage,
            power: voltage * x.current,
            following_error: u.command.position - x.position,
            stroke: Stroke { reserve: p.stroke_limit - x.position.abs() },
            speed: Speed { reserve: p.speed_limit - x.velocity.abs() },
        };
        (rates, output)
    }
}

#[cfg(test)]
mod tests;
