//! A damping valve: what pressure a flow costs.

use strut_model::{Real, Variables};

use crate::table::{Table, check_increasing};

/// Points of a characteristic.
pub const POINTS: usize = 9;

/// Characteristic of a damping valve, Ajala eq. 7 and 8: Δp = q c(q), piecewise linear through its points and on
/// with the slope of the last piece.
///
/// It may differ between the directions, as in shock absorbers: the one has the damping washers, the other a
/// check valve. The declared points are assumed; where they come from stands in the parameter sets.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Valve<R> {
    /// Flow, positive into the gas accumulator (q_ks, q_rs)
    #[var(unit = M3_PER_S, start = [-1e-3, -6e-4, -3e-4, -5e-5, 0.0, 5e-5, 3e-4, 6e-4, 1e-3])]
    pub flow: [R; POINTS],
    /// Pressure that the flow costs (Δp_ks, Δp_rs)
    #[var(unit = PA, start = [-1.4e5, -1e5, -0.7e5, -0.4e5, 0.0, 0.4e5, 1.6e5, 2.7e5, 3.9e5])]
    pub pressure_drop: [R; POINTS],
}

/// Flow below which the resistance is that of this flow: it is a quotient. A thousandth of a millilitre a second.
const SLOW: f64 = 1e-9;

impl<R: Real> Valve<R> {
    /// What `flow` costs.
    #[inline]
    pub fn pressure_drop(&self, flow: R) -> R {
        Table { x: &self.flow, y: &self.pressure_drop }.extended(flow)
    }

    /// Resistance c(q) = Δp/q, eq. 8; at rest its limit from the side of positive flows.
    #[inline]
    pub fn resistance(&self, flow: R) -> R {
        let slow = R::from(SLOW);
        let flow = (flow + slow).select(flow.max(slow), flow);
        self.pressure_drop(flow) / flow
    }
}

impl Valve<f64> {
    /// Resistance to a change of the flow where it is largest: the steepest slope.
    pub fn steepest(&self) -> f64 {
        let pieces = self.flow.windows(2).zip(self.pressure_drop.windows(2));
        pieces.map(|(flow, drop)| (drop[1] - drop[0]) / (flow[1] - flow[0])).fold(0.0, f64::max)
    }

    /// Refuses a characteristic that would feed energy in or leave rest without being pushed.
    ///
    /// # Errors
    /// A sentence that names the table, the values and what must hold.
    pub fn check(&self, name: &str) -> Result<(), String> {
        check_increasing(&format!("{name}.flow"), &self.flow)?;
        check_increasing(&format!("{name}.pressure_drop"), &self.pressure_drop)?;
        if self.flow.iter().zip(&self.pressure_drop).any(|(&flow, &drop)| flow == 0.0 && drop == 0.0) {
            return Ok(());
        }
        Err(format!(
            "the valve's characteristic must go through the origin, or it would feed energy in: one of the \
             points must have {name}.flow = 0 m3/s and {name}.pressure_drop = 0 Pa; at 0 m3/s it has {} Pa",
            self.pressure_drop(0.0)
        ))
    }
}

/// The valves between the chambers of a cylinder and their accumulators.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Valves<R> {
    /// On the compression side (c_k)
    pub compression: Valve<R>,
    /// On the rebound side (c_r)
    pub rebound: Valve<R>,
}

impl Valves<f64> {
    /// As [`Valve::check`], for both.
    ///
    /// # Errors
    /// Those of the valves.
    pub fn check(&self, name: &str) -> Result<(), String> {
        self.compression.check(&format!("{name}.compression"))?;
        self.rebound.check(&format!("{name}.rebound"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use strut_model::{Bundle, Declarations};

    fn valve() -> Valve<f64> {
        let declared = Declarations::of::<Valve<f64>>();
        Bundle::from_fn(|i| declared[i].start)
    }

    #[test]
    fn the_directions_differ() {
        assert_eq!(valve().check("valve"), Ok(()));
        assert!((valve().pressure_drop(6e-4) - 2.7e5).abs() < 1e-9);
        assert!((valve().pressure_drop(-6e-4) + 1e5).abs() < 1e-9);
    }

    #[test]
    fn at_rest_the_resistance_is_the_slope() {
        for flow in [0.0, 1e-12, -1e-12, 1e-6, -1e-6] {
            assert!((valve().resistance(flow) / 8e8 - 1.0).abs() < 1e-6, "{flow}");
        }
    }

    #[test]
    fn the_steepest_piece_is_that_to_its_first_point() {
        // 0.4 bar at 0.05 l/s; the others are flatter: 1.2 bar for 0.25 l/s.
        assert!((valve().steepest() / 8e8 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_characteristic_that_turns_or_misses_the_origin_is_refused() {
        let mut turning = valve();
        turning.pressure_drop[7] = 1e5;
        let error = turning.check("valve").unwrap_err();
        assert!(error.contains("valve.pressure_drop[8] = 100000"), "{error}");
        let mut offset = valve();
        offset.pressure_drop[4] = 1e4;
        let error = offset.check("valve").unwrap_err();
        assert!(error.contains("it has 10000 Pa"), "{error}");
    }

    proptest! {
        #[test]
        fn every_flow_costs_energy(flow in -2e-3..2e-3_f64) {
            prop_assert!(valve().pressure_drop(flow) * flow >= 0.0);
            let resistance = valve().resistance(flow);
            prop_assert!(resistance > 0.0);
            prop_assert!((resistance * flow - valve().pressure_drop(flow)).abs() < 1.0);
        }
    }
}
