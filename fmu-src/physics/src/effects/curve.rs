//! Forces without a law: curves that are fitted to what a model leaves over.

use strut_model::{Real, Variables};

use crate::table::Table;

/// Number of points of a curve.
pub const POINTS: usize = 11;

/// The value at `x` of a curve whose points are equally spaced from −`range` to `range`; beyond them that of the end.
fn held<R: Real>(over: &[R; POINTS], range: R, x: R) -> R {
    const HALF: f64 = (POINTS / 2) as f64;
    let knots = std::array::from_fn(|i| R::from(i as f64 - HALF));
    Table { x: &knots, y: over }.held(x / range * HALF)
}

/// An unnamed force between body and wheel: one curve over the deflection, one over the velocity, and a damping rate over
/// the deflection (docs/effects.md, G1–G5).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct ForceCurve<R> {
    /// Factor of both curves; zero switches them off
    #[var(unit = ONE, start = 0.0)]
    pub scale: R,
    /// Deflection of the last point, that of the first one being its opposite
    #[var(unit = M, start = 0.05, min = 1e-6)]
    pub deflection_range: R,
    /// Force at equally spaced deflections, held beyond them
    #[var(unit = N, start = 0.0)]
    pub over_deflection: [R; POINTS],
    /// Velocity of the last point, that of the first one being its opposite
    #[var(unit = M_PER_S, start = 0.5, min = 1e-6)]
    pub velocity_range: R,
    /// Force at equally spaced velocities, held beyond them
    #[var(unit = N, start = 0.0)]
    pub over_velocity: [R; POINTS],
    /// Damping rate at equally spaced deflections, held beyond them
    #[var(unit = N_S_PER_M, start = 0.0)]
    pub damping: [R; POINTS],
}

impl<R: Real> ForceCurve<R> {
    /// The force at a deflection and a velocity.
    #[inline]
    pub fn force(&self, deflection: R, velocity: R) -> R {
        if self.scale.vanishes() {
            return self.scale;
        }
        let over_deflection = held(&self.over_deflection, self.deflection_range, deflection);
        let damping = held(&self.damping, self.deflection_range, deflection);
        let over_velocity = held(&self.over_velocity, self.velocity_range, velocity);
        self.scale * (over_deflection + over_velocity + damping * velocity)
    }
}

/// An unnamed force that resists a velocity (docs/effects.md, G1–G5).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct VelocityCurve<R> {
    /// Factor of the curve; zero switches it off
    #[var(unit = ONE, start = 0.0)]
    pub scale: R,
    /// Velocity of the last point, that of the first one being its opposite
    #[var(unit = M_PER_S, start = 0.5, min = 1e-6)]
    pub velocity_range: R,
    /// Force at equally spaced velocities, held beyond them
    #[var(unit = N, start = 0.0)]
    pub over_velocity: [R; POINTS],
}

impl<R: Real> VelocityCurve<R> {
    /// The force at a velocity.
    #[inline]
    pub fn force(&self, velocity: R) -> R {
        if self.scale.vanishes() {
            return self.scale;
        }
        self.scale * held(&self.over_velocity, self.velocity_range, velocity)
    }
}

/// An unnamed force of a tyre over its compression, z_r − z_u (docs/effects.md, G1–G5).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct CompressionCurve<R> {
    /// Factor of the curve; zero switches it off
    #[var(unit = ONE, start = 0.0)]
    pub scale: R,
    /// Compression (road above wheel) of the last point, that of the first one being its opposite
    #[var(unit = M, start = 0.05, min = 1e-6)]
    pub deflection_range: R,
    /// Force at equally spaced compressions (road above wheel), held beyond them
    #[var(unit = N, start = 0.0)]
    pub over_deflection: [R; POINTS],
}

impl<R: Real> CompressionCurve<R> {
    /// No force at all, for a tyre that has no such parameters.
    #[inline]
    pub fn none() -> Self {
        let zero = R::from(0.0);
        Self { scale: zero, deflection_range: R::from(1.0), over_deflection: [zero; POINTS] }
    }

    /// The force at a compression.
    #[inline]
    pub fn force(&self, compression: R) -> R {
        if self.scale.vanishes() {
            return self.scale;
        }
        self.scale * held(&self.over_deflection, self.deflection_range, compression)
    }
}

/// An unnamed force of an actuator over what it is asked for (docs/effects.md, G1–G5).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct CommandCurve<R> {
    /// Factor of the curve; zero switches it off
    #[var(unit = ONE, start = 0.0)]
    pub scale: R,
    /// Force asked for at the last point, that of the first one being its opposite
    #[var(unit = N, start = 100.0, min = 1e-6)]
    pub force_range: R,
    /// Force beside it at equally spaced forces asked for, held beyond them
    #[var(unit = N, start = 0.0)]
    pub over_force: [R; POINTS],
}

impl<R: Real> CommandCurve<R> {
    /// The force that comes beside the one that is asked for.
    #[inline]
    pub fn force(&self, asked: R) -> R {
        if self.scale.vanishes() {
            return self.scale;
        }
        self.scale * held(&self.over_force, self.force_range, asked)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_dual::Dual64;
    use proptest::prelude::*;

    /// One, four, nine …: so that a point is not mistaken for another.
    fn squares() -> [f64; POINTS] {
        std::array::from_fn(|i| (i * i) as f64)
    }

    fn curve(scale: f64) -> ForceCurve<f64> {
        ForceCurve {
            scale,
            deflection_range: 0.05,
            over_deflection: squares(),
            velocity_range: 0.5,
            over_velocity: [0.0; POINTS],
            damping: [0.0; POINTS],
        }
    }

    #[test]
    fn it_goes_through_its_points_and_is_held_beyond_them() {
        for (i, force) in squares().into_iter().enumerate() {
            let x = -0.05 + 0.01 * i as f64;
            assert!((curve(2.0).force(x, 0.3) - 2.0 * force).abs() < 1e-9, "{x}");
        }
        assert_eq!((curve(1.0).force(-1.0, 0.0), curve(1.0).force(1.0, 0.0)), (0.0, 100.0));
        assert!((curve(1.0).force(0.005, 0.0) - 0.5 * (25.0 + 36.0)).abs() < 1e-9);
    }

    #[test]
    fn points_carry_derivatives_even_while_the_curve_is_scaled_from_zero() {
        let mut over_velocity = squares().map(Dual64::from);
        over_velocity[5] = over_velocity[5].derivative();
        let range = Dual64::from(0.5);
        let on = VelocityCurve { scale: Dual64::from(3.0), velocity_range: range, over_velocity };
        assert!((on.force(Dual64::from(0.025)).eps - 3.0 * 0.75).abs() < 1e-12);
        let varied = VelocityCurve { scale: Dual64::new(0.0, 1.0), ..on };
        assert!((varied.force(Dual64::from(0.0)).eps - 25.0).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn a_damping_rate_over_the_deflection_is_one(x in -0.1..0.1_f64, v in -1.0..1.0_f64) {
            let damper = ForceCurve { over_deflection: [0.0; POINTS], damping: squares(), ..curve(1.5) };
            prop_assert!((damper.force(x, v) - curve(1.5).force(x, 0.0) * v).abs() < 1e-9);
        }

        #[test]
        fn both_curves_add_and_each_over_its_own_variable(x in -0.1..0.1_f64, v in -1.0..1.0_f64) {
            let both = ForceCurve { over_velocity: squares(), ..curve(1.5) };
            let over_velocity =
                VelocityCurve { scale: 1.5, velocity_range: 0.5, over_velocity: squares() }.force(v);
            let over_deflection =
                CompressionCurve { scale: 1.5, deflection_range: 0.05, over_deflection: squares() }.force(x);
            prop_assert!((both.force(x, v) - over_velocity - over_deflection).abs() < 1e-9);
        }

        #[test]
        fn a_rising_curve_through_zero_resists(v in -1.0..1.0_f64) {
            let over_velocity = std::array::from_fn(|i| 10.0 * (i as f64 - 5.0));
            let curve = VelocityCurve { scale: 1.0, velocity_range: 0.5, over_velocity };
            prop_assert!(curve.force(v) * v >= 0.0 && (curve.force(v) + curve.force(-v)).abs() < 1e-9);
        }

        #[test]
        fn without_scale_it_is_absent(x in -0.1..0.1_f64, v in -1.0..1.0_f64) {
            prop_assert_eq!(curve(0.0).force(x, v), 0.0);
            prop_assert_eq!(CompressionCurve::none().force(x), 0.0);
        }
    }
}
