//! A strut alone: its lower end is moved, the force at that end is measured.

use crate::car::{Motion, RATE};
use crate::excitation::Profile;
use crate::friction::Limit;
use crate::strut::{INNER, Inner, Strut};

/// Runs for `duration` seconds. The motion is the [`Motion::road`], the force that pushes the end up the
/// [`Motion::tire_force`]; nothing else moves.
pub fn run(strut: &Strut, friction: &[Limit], profile: &Profile, duration: f64) -> Motion {
    let step = 1.0 / RATE;
    let mut inner: Inner = [0.0; INNER];
    let mut rubbing = vec![0.0; friction.len()];
    let mut motion = Motion::default();
    for k in 0..=(duration * RATE).round() as usize {
        let time = k as f64 * step;
        let law = |time: f64, inner: &Inner| {
            let (height, rise) = profile.at(time);
            strut.force(time, -height, -rise, inner)
        };
        let (height, rise) = profile.at(time);
        let (force, first) = law(time, &inner);
        for (force, limit) in rubbing.iter_mut().zip(friction) {
            // A contact at rest keeps its force.
            let most = limit.at(-height, -rise);
            *force = if rise == 0.0 { f64::clamp(*force, -most, most) } else { -most * rise.signum() };
        }
        motion.road.push(height);
        motion.road_velocity.push(rise);
        motion.tire_force.push(-force - rubbing.iter().sum::<f64>());

        let ahead =
            |rates: &Inner, step: f64| -> Inner { std::array::from_fn(|i| inner[i] + step * rates[i]) };
        let (_, second) = law(time + 0.5 * step, &ahead(&first, 0.5 * step));
        let (_, third) = law(time + 0.5 * step, &ahead(&second, 0.5 * step));
        let (_, fourth) = law(time + step, &ahead(&third, step));
        inner = std::array::from_fn(|i| {
            inner[i] + step / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i])
        });
    }
    motion
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn friction_opens_the_loop_by_twice_its_force() {
        let strut = Strut { stiffness: 8400.0, ..Strut::default() };
        let profile = crate::excitation::triangle(6.0, 2.0, 0.01);
        let motion = run(&strut, &[Limit::Coulomb(60.0)], &profile, 6.0);
        let mut directions = [false; 2];
        for k in 30_000..motion.road.len() {
            if motion.road_velocity[k].abs() > 1e-3 {
                let friction = motion.tire_force[k] - 8400.0 * motion.road[k];
                assert!((friction - 60.0 * motion.road_velocity[k].signum()).abs() < 1e-9);
                directions[usize::from(motion.road_velocity[k] > 0.0)] = true;
            }
        }
        assert_eq!(directions, [true; 2]);
    }
}
