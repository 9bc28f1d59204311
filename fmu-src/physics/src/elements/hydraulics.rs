//! Pump, piston and gas of a hydraulic strut.

use std::f64::consts::TAU;

use strut_model::{Real, Variables};

/// Pump without leakage, Ajala eq. 4 and 5.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Pump<R> {
    /// Volume that one revolution moves (V_c)
    #[var(unit = M3, start = 12e-6, min = 1e-9)]
    pub displacement: R,
}

impl<R: Real> Pump<R> {
    /// Volume that one radian moves, V_c/2π: the flow of 1 rad/s (eq. 5) and the torque of 1 Pa (eq. 4).
    #[inline]
    pub fn per_radian(&self) -> R {
        self.displacement / TAU
    }
}

/// Piston with its rod on one side, Ajala eq. 6.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Piston<R> {
    /// Area in the chamber that compression makes smaller (A_k)
    #[var(unit = M2, start = 10.2e-4, min = 1e-6)]
    pub compression_area: R,
    /// Area in the chamber that rebound makes smaller (A_r)
    #[var(unit = M2, start = 8.6e-4, min = 1e-6)]
    pub rebound_area: R,
}

/// Gas in two accumulators, Ajala eq. 1 to 3. Pressures are absolute.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Gas<R> {
    /// Pressure at rest, absolute (p_0)
    #[var(unit = PA, start = 3e6, min = 1e3)]
    pub charge_pressure: R,
    /// Polytropic exponent (κ): 1 for slow, 1.4 for fast changes
    #[var(unit = ONE, start = 1.3, min = 1.0, max = 1.7)]
    pub exponent: R,
    /// Gas volume at rest of the accumulator that compression fills (V_k0)
    #[var(unit = M3, start = 0.5e-3, min = 1e-6)]
    pub compression_volume: R,
    /// Gas volume at rest of the accumulator that rebound fills (V_r0)
    #[var(unit = M3, start = 0.5e-3, min = 1e-6)]
    pub rebound_volume: R,
}

impl<R: Real> Gas<R> {
    /// Pressure over volume, p/V = p^(1 + 1/κ)/(V_0 p_0^(1/κ)), eq. 46, of the gas with volume V_0 at rest, when
    /// its pressure is `overpressure` above that at rest.
    #[inline]
    pub fn pressure_per_volume(&self, overpressure: R, volume_at_rest: R) -> R {
        let ratio = R::from(1.0) + overpressure / self.charge_pressure;
        // p/V = p_0/V_0 (p/p_0) (V_0/V) and V_0/V = (p/p_0)^(1/κ).
        self.charge_pressure / volume_at_rest * ratio * ratio.powf(R::from(1.0) / self.exponent)
    }

    /// p_0/V_k0 + p_0/V_r0, eq. 18.
    #[inline]
    pub fn pressure_per_volumes_at_rest(&self) -> R {
        self.charge_pressure / self.compression_volume + self.charge_pressure / self.rebound_volume
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const GAS: Gas<f64> =
        Gas { charge_pressure: 3e6, exponent: 1.3, compression_volume: 0.5e-3, rebound_volume: 0.4e-3 };

    #[test]
    fn one_revolution_moves_the_displacement() {
        assert_eq!(Pump { displacement: 12e-6_f64 }.per_radian() * TAU, 12e-6);
    }

    proptest! {
        /// Eq. 1: p V^κ stays; the volume of eq. 46 is the one that keeps it.
        #[test]
        fn the_gas_is_polytropic(overpressure in -2.5e6..9e6_f64) {
            let pressure = GAS.charge_pressure + overpressure;
            let volume = pressure / GAS.pressure_per_volume(overpressure, GAS.compression_volume);
            let kept = pressure * volume.powf(1.3) / (3e6 * 0.5e-3_f64.powf(1.3));
            prop_assert!((kept - 1.0).abs() < 1e-12, "{}", kept);
        }
    }
}
