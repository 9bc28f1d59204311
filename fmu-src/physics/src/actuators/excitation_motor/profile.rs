//! What a drive makes of a commanded position before it follows it.

use strut_model::{Real, Variables};

/// Limits of the profile, TUM Fig. 4.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Profile<R> {
    /// Largest velocity
    #[var(unit = M_PER_S, start = 2.6, min = 1e-6)]
    pub velocity_limit: R,
    /// Largest acceleration
    #[var(unit = M_PER_S2, start = 80.0, min = 1e-6)]
    pub acceleration_limit: R,
    /// Pole of both lags that the command is derived through (p)
    #[var(unit = PER_S, start = 1000.0, min = 1e-3)]
    pub pole: R,
}

/// A point that moves.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Point<R> {
    /// Position
    #[var(unit = M, nominal = 0.01)]
    pub position: R,
    /// Velocity
    #[var(unit = M_PER_S, nominal = 0.1)]
    pub velocity: R,
}

/// Share of the acceleration limit that braking counts on; the rest makes up for its own lag.
const BRAKING: f64 = 0.8;

/// No motion around zero, and the command less the dead zone elsewhere.
///
/// TUM 3.2.1: "a dead zone around the idle state to avoid dithering". That the zone is taken from what lies outside is
/// how the drives with these block diagrams do it (Copley: CME 2 user guide, "dead band").
#[inline]
pub fn beyond_dead_zone<R: Real>(command: R, width: R) -> R {
    command - command.clamp(-width, width)
}

impl<R: Real> Profile<R> {
    /// The acceleration of the target: the command through two lags, so that it has a velocity and an acceleration.
    #[inline]
    pub fn derivation(&self, command: R, target: &Point<R>) -> R {
        self.pole * (self.pole * (command - target.position) - target.velocity * 2.0)
    }

    /// The acceleration of the profile, which follows the target within the limits.
    ///
    /// Within the limits a profile that is on the target stays there. Away from it, it approaches with the velocity
    /// from which it can still brake, `√(2 b e + δ²) − δ`: near the target a straight line, so that nothing chatters.
    #[inline]
    pub fn acceleration(&self, target: &Point<R>, target_acceleration: R, profile: &Point<R>) -> R {
        let distance = target.position - profile.position;
        let braking = self.acceleration_limit * BRAKING;
        let rounding = braking * 2.0 / self.pole;
        let root = (braking * distance.abs() * 2.0 + rounding.squared()).sqrt();
        let approach = distance * braking * 2.0 / (root + rounding);

        let gain = self.pole * 2.0;
        let wanted = target_acceleration + gain * (target.velocity + approach - profile.velocity);
        // At the largest velocity nothing accelerates further; a limit that was lowered is returned to.
        let (low, high) = (-self.acceleration_limit, self.acceleration_limit);
        let slowest = (gain * (-self.velocity_limit - profile.velocity)).clamp(low, high);
        let fastest = (gain * (self.velocity_limit - profile.velocity)).clamp(low, high);
        wanted.clamp(slowest, fastest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const PROFILE: Profile<f64> = Profile { velocity_limit: 2.6, acceleration_limit: 80.0, pole: 1000.0 };
    const REST: Point<f64> = Point { position: 0.0, velocity: 0.0 };

    /// The profile's course under a command, by small steps of Heun's method.
    fn run(command: impl Fn(f64) -> f64, stop: f64) -> Vec<(f64, Point<f64>, Point<f64>, f64)> {
        let h = 2e-5;
        let rates = |t: f64, target: &Point<f64>, profile: &Point<f64>| {
            let a = PROFILE.derivation(command(t), target);
            (a, PROFILE.acceleration(target, a, profile))
        };
        let moved = |point: &Point<f64>, velocity: f64, acceleration: f64| Point {
            position: point.position + h * velocity,
            velocity: point.velocity + h * acceleration,
        };
        let (mut target, mut profile, mut rows) = (REST, REST, Vec::new());
        for k in 0..(stop / h) as usize {
            let t = k as f64 * h;
            let (a, b) = rates(t, &target, &profile);
            rows.push((t, target, profile, b));
            let (next_target, next_profile) =
                (moved(&target, target.velocity, a), moved(&profile, profile.velocity, b));
            let (c, d) = rates(t + h, &next_target, &next_profile);
            let mean = |x: f64, y: f64| 0.5 * (x + y);
            target = moved(&target, mean(target.velocity, next_target.velocity), mean(a, c));
            profile = moved(&profile, mean(profile.velocity, next_profile.velocity), mean(b, d));
        }
        rows
    }

    #[test]
    fn a_step_is_taken_at_the_limits_and_without_overshoot() {
        let rows = run(|_| 0.2, 0.3);
        let largest =
            |f: fn(&Point<f64>) -> f64| rows.iter().map(|(_, _, p, _)| f(p)).fold(f64::MIN, f64::max);
        assert!(largest(|p| p.position) < 0.2 + 1e-6, "{}", largest(|p| p.position));
        assert!((rows.last().unwrap().2.position - 0.2).abs() < 1e-6);
        // A triangle of 80 and 64 m/s² would peak at √(2 · 0.2 · 80 · 64/144) = 3.8 m/s, so the limit is met.
        assert!((largest(|p| p.velocity) - 2.6).abs() < 0.01, "{}", largest(|p| p.velocity));
        let bounded =
            rows.iter().all(|(_, _, p, a)| p.velocity.abs() <= 2.6 + 1e-9 && a.abs() <= 80.0 + 1e-9);
        assert!(bounded);
    }

    #[test]
    fn within_the_limits_the_profile_is_the_target() {
        // 5 mm at 10 Hz: 0.31 m/s and 19.7 m/s², starting smoothly.
        let rows = run(|t| 0.005 * (1.0 - (std::f64::consts::TAU * 10.0 * t).cos()), 0.5);
        let apart = rows.iter().map(|(_, t, p, _)| (t.position - p.position).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-9, "{apart}");
        assert!(rows.iter().any(|(_, _, p, _)| p.position > 0.0095));
    }

    #[test]
    fn the_dead_zone_is_taken_from_what_lies_outside() {
        assert_eq!(beyond_dead_zone(0.101, 0.1), 0.101 - 0.1);
        assert_eq!((beyond_dead_zone(0.1, 0.1), beyond_dead_zone(-0.05, 0.1)), (0.0, 0.0));
        assert_eq!(beyond_dead_zone(-0.3, 0.0), -0.3);
    }

    proptest! {
        #[test]
        fn acceleration_and_velocity_keep_to_their_limits(
            target in (-0.1..0.1_f64, -5.0..5.0_f64),
            profile in (-0.1..0.1_f64, -2.6..2.6_f64),
            acceleration in -1e4..1e4_f64,
        ) {
            let point = |(position, velocity)| Point { position, velocity };
            let found = PROFILE.acceleration(&point(target), acceleration, &point(profile));
            prop_assert!(found.abs() <= 80.0);
            for (velocity, sign) in [(2.6, 1.0), (-2.6, -1.0)] {
                let at_limit = Point { velocity, ..point(profile) };
                prop_assert!(sign * PROFILE.acceleration(&point(target), acceleration, &at_limit) <= 1e-9);
            }
        }
    }
}
