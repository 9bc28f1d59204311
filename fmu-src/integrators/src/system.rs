//! What is integrated.

use crate::array::Array;

/// A system of ordinary differential equations x' = f(t, x).
///
/// Methods take `&mut self` so that a system may keep scratch values (the outputs that belong to the
/// last evaluation, work counters).
pub trait System<A: Array> {
    /// f(t, x).
    fn rates(&mut self, t: f64, x: &A) -> A;
    /// The exact partial derivatives of f at (t, x): by state, and by time.
    fn jacobian(&mut self, t: f64, x: &A) -> (A::Square, A);
}
