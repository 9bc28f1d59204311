//! The loops of the drive, TUM Fig. 5–7: what they are told, what they remember, what they do.

use std::f64::consts::TAU;

use strut_model::{Instant, Real, Variables};

use super::profile::{Point, beyond_dead_zone};
use super::{ExcitationMotor, State};

/// What of the profile goes to the velocity loop directly.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct FeedForward<R> {
    /// Share of the profile's velocity
    #[var(unit = ONE, start = 1.0)]
    pub velocity: R,
    /// Velocity for one unit of the profile's acceleration; makes up for the velocity loop's lag
    #[var(unit = S, start = 2e-3)]
    pub acceleration: R,
}

/// The position loop.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct PositionLoop<R> {
    /// Velocity for one unit of position error
    #[var(unit = PER_S, start = 80.0, min = 0.0)]
    pub gain: R,
}

/// The velocity loop.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct VelocityLoop<R> {
    /// Corner frequency of the filter of the command
    #[var(unit = HZ, start = 600.0, min = 1e-3)]
    pub command_filter: R,
    /// Proportional gain
    #[var(unit = A_S_PER_M, start = 86.0, min = 1e-6)]
    pub proportional: R,
    /// Integral gain
    #[var(unit = A_PER_M, start = 2700.0, min = 0.0)]
    pub integral: R,
    /// Corner frequency of the filter of the output
    #[var(unit = HZ, start = 600.0, min = 1e-3)]
    pub output_filter: R,
}

/// The current loop.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct CurrentLoop<R> {
    /// Proportional gain
    #[var(unit = OHM, start = 60.0, min = 1e-6)]
    pub proportional: R,
    /// Integral gain
    #[var(unit = OHM_PER_S, start = 48e3, min = 0.0)]
    pub integral: R,
}

/// Of the velocity loop.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct VelocityLoopState<R> {
    /// Filtered command
    #[var(unit = M_PER_S, nominal = 0.1)]
    pub command: R,
    /// Integral part
    #[var(unit = A, nominal = 1.0)]
    pub integrator: R,
    /// Filtered output
    #[var(unit = A, nominal = 1.0)]
    pub output: R,
}

/// Of the current loop.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct CurrentLoopState<R> {
    /// Integral part
    #[var(unit = V, nominal = 10.0)]
    pub integrator: R,
}

impl<R: Real> State<R> {
    /// Nothing changes.
    pub(super) fn resting() -> Self {
        strut_model::Bundle::from_fn(|_| R::from(0.0))
    }
}

/// Position and velocity loop, Fig. 4–6: their rates and the current that they demand.
#[inline]
pub(super) fn cascade<R: Real>(now: Instant<'_, ExcitationMotor, R>, current_limit: R) -> (State<R>, R) {
    let (x, p) = (now.state, now.parameters);
    let command = beyond_dead_zone(now.input.command.position, p.dead_zone);
    let target_acceleration = p.profile.derivation(command.clamp(-p.stroke_limit, p.stroke_limit), &x.target);
    let acceleration = p.profile.acceleration(&x.target, target_acceleration, &x.profile);

    let velocity = p.feed_forward.velocity * x.profile.velocity
        + p.feed_forward.acceleration * acceleration
        + p.position_loop.gain * (x.profile.position - x.position);
    let velocity = velocity.clamp(-p.speed_limit, p.speed_limit);
    let Regulated { output, integrator } = regulated(
        [p.velocity_loop.proportional, p.velocity_loop.integral],
        x.velocity_loop.command - x.velocity,
        x.velocity_loop.integrator,
        current_limit,
    );

    let rates = State {
        target: Point { position: x.target.velocity, velocity: target_acceleration },
        profile: Point { position: x.profile.velocity, velocity: acceleration },
        velocity_loop: VelocityLoopState {
            command: p.velocity_loop.command_filter * TAU * (velocity - x.velocity_loop.command),
            integrator,
            output: p.velocity_loop.output_filter * TAU * (output - x.velocity_loop.output),
        },
        ..State::resting()
    };
    (rates, x.velocity_loop.output)
}

/// What a controller gives.
pub(super) struct Regulated<R> {
    /// Its output, limited.
    pub(super) output: R,
    /// The rate of its integral part.
    pub(super) integrator: R,
}

/// A PI controller with gains `[k_p, k_i]` whose output is limited.
#[inline]
pub(super) fn regulated<R: Real>(gains: [R; 2], error: R, integral: R, limit: R) -> Regulated<R> {
    let [proportional, integrating] = gains;
    let wanted = proportional * error + integral;
    let output = wanted.clamp(-limit, limit);
    let excess = wanted - output;
    Regulated { output, integrator: integrating * (error - excess / proportional) }
}
