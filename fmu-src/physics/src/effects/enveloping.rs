//! A tyre that rolls over short bumps.

use strut_model::{Real, Variables};

use crate::signals::RoadMotion;

use super::transport::behind_lag;

/// The road as a tyre with a contact patch sees it: behind a low-pass, `T z' = z_r − z` (docs/effects.md, 22).
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Enveloping<R> {
    /// Time constant: half the contact's length over the speed (T); zero switches it off
    #[var(unit = S, start = 0.0, min = 0.0)]
    pub time: R,
}

/// What the tyre sees of the road.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct EnvelopingState<R> {
    /// Height (z)
    #[var(unit = M, nominal = 0.01)]
    pub height: R,
}

impl<R: Real> Enveloping<R> {
    /// The road that the tyre sees, and the state's rate.
    #[inline]
    pub fn seen(
        &self,
        state: EnvelopingState<R>,
        road: RoadMotion<R>,
    ) -> (RoadMotion<R>, EnvelopingState<R>) {
        let (position, rate) = behind_lag(self.time, state.height, road.position);
        let velocity = self.time.select(rate, road.velocity);
        (RoadMotion { position, velocity }, EnvelopingState { height: rate })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn on_a_slope_it_is_late_by_its_time(height in -0.1..0.1_f64, slope in -1.0..1.0_f64, time in 1e-3..0.02_f64) {
            let state = EnvelopingState { height: height - slope * time };
            let road = RoadMotion { position: height, velocity: slope };
            let (seen, rate) = Enveloping { time }.seen(state, road);
            prop_assert!((seen.velocity - slope).abs() < 1e-9 && (rate.height - slope).abs() < 1e-9);
            prop_assert_eq!(seen.position, state.height);
        }

        #[test]
        fn without_time_the_road_is_seen_as_it_is(position in -0.1..0.1_f64, velocity in -1.0..1.0_f64) {
            let road = RoadMotion { position, velocity };
            let (seen, rate) = Enveloping { time: 0.0 }.seen(EnvelopingState { height: 0.3 }, road);
            prop_assert_eq!((seen, rate.height), (road, 0.0));
        }
    }
}
