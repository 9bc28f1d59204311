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

/// What a controller wants, also what it holds between samples.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Command<R> {
    /// Force that is wanted, positive if it pushes body and wheel apart (F_c, F_a,ref)
    #[var(unit = N)]
    pub force: R,
}
