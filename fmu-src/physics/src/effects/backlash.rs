//! What follows only where it is pushed: a backlash.

use strut_model::Real;

/// Time in s within which the follower comes back to the band: short beside all that valves and wheels do.
pub(super) const CATCHES_UP: f64 = 5e-4;

/// What becomes of a quantity x behind a backlash of `half_width` h, and the rate of the `follower` y; the quantity itself and
/// zero where there is none (docs/effects.md, 28 and 41).
///
/// The play operator (Krasnosel'skii and Pokrovskii 1989): it stays where it is until x is h away from it, and is then
/// dragged along. A turn of x by less than 2 h does not pass. With `T y' = dz(x − y, h)` the follower is dragged a little
/// late; what passes is `x − clamp(x − y, −h, h)`, which is not late, so that T shows after reversals alone, as
/// `T² x''/2`.
#[inline]
pub fn behind_backlash<R: Real>(half_width: R, follower: R, quantity: R) -> (R, R) {
    if half_width.vanishes() {
        return (quantity, R::from(0.0));
    }
    let apart = quantity - follower;
    let held = within(apart, half_width);
    (quantity - held, (apart - held) / CATCHES_UP)
}

/// What of x is within ±`half_width` of zero: by the side, so that a width that is varied from zero has a derivative of the
/// right sign.
#[inline]
pub(super) fn within<R: Real>(x: R, half_width: R) -> R {
    x.select(x.min(half_width), x.max(-half_width))
}

#[cfg(test)]
mod tests {
    use num_dual::Dual64;
    use proptest::prelude::*;
    use strut_model::Dependencies;

    use super::*;

    /// What passes while the quantity goes straight from point to point at 2 per second, in small steps of Euler's.
    fn along(half_width: f64, points: &[f64]) -> Vec<f64> {
        const STEP: f64 = 1e-5;
        let (mut follower, mut found) = (points[0], vec![]);
        for pair in points.windows(2) {
            let steps = ((pair[1] - pair[0]).abs() / 2.0 / STEP).round();
            for k in 0..steps as usize {
                let quantity = pair[0] + (pair[1] - pair[0]) * k as f64 / steps;
                follower += STEP * behind_backlash(half_width, follower, quantity).1;
            }
            found.push(behind_backlash(half_width, follower, pair[1]).0);
        }
        found
    }

    #[test]
    fn it_is_dragged_and_a_turn_by_less_than_the_band_does_not_pass() {
        // Up; back within the band; on; back beyond it; and by just the band.
        let found = along(0.1, &[0.0, 1.0, 0.85, 1.0, 0.5, 0.7]);
        for (found, expected) in found.iter().zip([0.9, 0.9, 0.9, 0.6, 0.6]) {
            assert!((found - expected).abs() < 2e-3, "{found}, not {expected}");
        }
    }

    #[test]
    fn a_width_that_is_varied_from_zero_takes_from_the_way_that_the_quantity_goes() {
        let from_zero = Dual64::new(0.0, 1.0);
        for (follower, slope) in [(0.3, -1.0), (0.7, 1.0)] {
            let (found, _) = behind_backlash(from_zero, Dual64::from(follower), Dual64::from(0.5));
            assert_eq!((found.re, found.eps), (0.5, slope));
        }
    }

    #[test]
    fn whether_it_is_on_or_off_is_in_what_it_depends_on() {
        let of = Dependencies::on;
        let (found, rate) = behind_backlash(of(0), of(1), of(2));
        assert!([0, 1, 2].iter().all(|it| found.contains(*it) && rate.contains(*it)));
    }

    proptest! {
        #[test]
        fn it_never_leaves_the_band_and_rests_within_it(
            follower in -2.0..2.0_f64, quantity in -1.0..1.0_f64, half_width in 1e-3..0.5_f64,
        ) {
            let (found, rate) = behind_backlash(half_width, follower, quantity);
            prop_assert!((found - quantity).abs() <= half_width + 1e-12);
            if (follower - quantity).abs() <= half_width {
                prop_assert!((found - follower).abs() < 1e-12 && rate.abs() < 1e-9);
            } else {
                // Towards the band, from outside.
                prop_assert!(rate * (quantity - follower) > 0.0);
            }
        }

        #[test]
        fn without_width_it_is_absent(follower in -2.0..2.0_f64, quantity in -1.0..1.0_f64) {
            prop_assert_eq!(behind_backlash(0.0, follower, quantity), (quantity, 0.0));
        }
    }
}
