//! What passes from one component to another. Sender and receiver declare it here, once, so that names, units
//! and signs fit.

use strut_model::Variables;

/// The road under a wheel.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct RoadMotion<R> {
    /// Height (x_g, z_r, w, y_s)
    #[var(unit = M)]
    pub position: R,
    /// Rate of change of the height
    #[var(unit = M_PER_S)]
    pub velocity: R,
}

/// How a mass moves.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Motion<R> {
    /// Height above static equilibrium
    #[var(unit = M, nominal = 0.01, output)]
    pub position: R,
    /// Velocity, positive upwards
    #[var(unit = M_PER_S, nominal = 0.1, output)]
    pub velocity: R,
}

/// How a mass is accelerated.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Acceleration<R> {
    /// Acceleration, positive upwards
    #[var(unit = M_PER_S2)]
    pub acceleration: R,
}

/// What acts on a wheel.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct WheelMotion<R> {
    /// Acceleration, positive upwards
    #[var(unit = M_PER_S2)]
    pub acceleration: R,
    /// Dynamic wheel load, positive if it presses on the road (F_dyn)
    #[var(unit = N)]
    pub force: R,
}

/// An element between two masses, and how fast it moves.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Travel<R> {
    /// Deflection: upper above lower end, positive in rebound (x_c − x_w)
    #[var(unit = M)]
    pub deflection: R,
    /// Rate of change of the deflection
    #[var(unit = M_PER_S)]
    pub velocity: R,
}

/// How fast an element between two masses moves.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct TravelRate<R> {
    /// Rate of change of the deflection, positive in rebound
    #[var(unit = M_PER_S)]
    pub velocity: R,
}

/// An element between two masses.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Deflection<R> {
    /// Deflection: upper above lower end, negative where it is compressed (x_w − x_g)
    #[var(unit = M)]
    pub deflection: R,
}

/// How fast a mass moves.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Velocity<R> {
    /// Velocity, positive upwards
    #[var(unit = M_PER_S)]
    pub velocity: R,
}

/// How fast something turns.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct AngularSpeed<R> {
    /// Angular velocity
    #[var(unit = RAD_PER_S)]
    pub speed: R,
}

/// What an actuator between body and wheel does.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Pushing<R> {
    /// Force, positive if it pushes body and wheel apart (F, F_c, f_s, F_a)
    #[var(unit = N)]
    pub force: R,
}

/// What a controller wants, also what it holds between samples.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Command<R> {
    /// Force that is wanted, positive if it pushes body and wheel apart (F_c, F_a,ref)
    #[var(unit = N)]
    pub force: R,
}

/// What drives a motor's shaft, also what a controller holds between samples.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Torque<R> {
    /// Torque on the shaft, positive in the direction of positive speeds (T_m)
    #[var(unit = N_M)]
    pub torque: R,
}

/// How fast a motor turns.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Speed<R> {
    /// Speed of the shaft (ω_m)
    #[var(unit = RAD_PER_S)]
    pub speed: R,
}

/// Of the oil or gas on both sides of a piston, absolute; an input starts as under the declared charge pressure.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Pressures<R> {
    /// On the side that compression makes smaller (p_ks, p_k)
    #[var(unit = PA, start = 3e6)]
    pub compression: R,
    /// On the side that rebound makes smaller (p_rs, p_r)
    #[var(unit = PA, start = 3e6)]
    pub rebound: R,
}

/// A brake between two parts that turn.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct BrakeTorque<R> {
    /// Torque, positive if it resists a positive relative speed
    #[var(unit = N_M)]
    pub torque: R,
}

/// An eccentric under a wheel.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct EccentricMotion<R> {
    /// Height of its top above its axis (u_1), at the start that of its lowest position
    #[var(unit = M, start = 0.04)]
    pub height: R,
    /// Rate of change of the height
    #[var(unit = M_PER_S)]
    pub velocity: R,
}

/// How fast two parts turn against each other.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct RelativeSpeed<R> {
    /// Speed of the one less that of the other
    #[var(unit = RAD_PER_S)]
    pub speed: R,
}
