//! Pump, piston and gas of a hydraulic strut.

use std::f64::consts::TAU;

use strut_model::{Real, Variables};

use crate::effects::{RotaryCoulomb, with_constant};

/// Pump without losses, Ajala eq. 4 and 5.
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

/// Pump that leaks and rubs (docs/effects.md, 30 and 32c), with a constant torque and a constant flow as ports of
/// diagnosis. Each of the four costs one question if it is off.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct PumpWithLosses<R> {
    /// The pump itself
    #[var(flatten)]
    pub ideal: Pump<R>,
    /// Leakage from chamber to chamber (C_l)
    #[var(unit = M5_PER_N_S, start = 0.0, min = 0.0)]
    pub leakage: R,
    /// Constant torque on pump and motor, opposing positive speed
    #[var(unit = N_M, start = 0.0, port)]
    pub load: R,
    /// Constant flow that fills the compression side beside that of the pump
    #[var(unit = M3_PER_S, start = 0.0, port)]
    pub flow_offset: R,
    /// Friction of pump and motor
    pub coulomb: RotaryCoulomb<R>,
}

impl<R: Real> PumpWithLosses<R> {
    /// Flow to the compression side at a speed, before the leak.
    #[inline]
    pub fn pumped(&self, speed: R) -> R {
        with_constant(self.ideal.per_radian() * speed, self.flow_offset)
    }

    /// Torque that a pressure difference on the piston and the losses hold against the motor.
    #[inline]
    pub fn resistance(&self, difference: impl FnOnce() -> R, speed: R) -> R {
        let rubbing = self.coulomb.added_to(|| self.ideal.per_radian() * difference(), speed);
        with_constant(rubbing, self.load)
    }

    /// Flows into the chambers, less what leaks from that of the higher pressure to the other: C_l Δp,
    /// laminar as in Konieczny eq. 2.11. `difference` is the pressure difference on the piston with those
    /// flows.
    ///
    /// The leak changes the flow through both valves, and so the difference that drives it: an algebraic
    /// loop. It is cut at the difference without the leak, which makes the leak too large by C_l (c_k +
    /// c_r) times itself: at 1e-11 m5/(N.s) by 1.6 % with the soft valves of Ajala's sets and by 3.4 %
    /// with the hard ones, and by less where the piston is faster than 0.05 m/s.
    #[inline]
    pub fn leaked(&self, [compression, rebound]: [R; 2], difference: impl FnOnce() -> R) -> [R; 2] {
        if self.leakage.vanishes() {
            return [compression, rebound];
        }
        let leak = self.leakage * difference();
        [compression - leak, rebound + leak]
    }
}

impl PumpWithLosses<f64> {
    /// Refuses a leak that would turn over the pressure difference that drives it: it would feed energy in.
    /// `resistance` is what both valves have at most against a change of their flow.
    ///
    /// # Errors
    /// A sentence that names the values and what must hold.
    pub fn check(&self, name: &str, resistance: f64) -> Result<(), String> {
        if self.leakage * resistance < 1.0 {
            return Ok(());
        }
        Err(format!(
            "{name}.leakage = {:e} m5/(N.s) must be below one over the steepest slopes of both valves \
             together, {resistance:e} Pa.s/m3: beyond, the leak would turn over the pressure that drives it, \
             and feed energy in",
            self.leakage
        ))
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

/// Piston with a constant force as a port of diagnosis.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct PistonWithPreload<R> {
    /// The piston itself
    #[var(flatten)]
    pub ideal: Piston<R>,
    /// Constant force that pulls body and wheel together
    #[var(unit = N, start = 0.0, port)]
    pub preload: R,
}

impl<R: Real> PistonWithPreload<R> {
    /// Force that pushes body and wheel apart, Ajala eq. 6.
    #[inline]
    pub fn force(&self, on_compression: R, on_rebound: R) -> R {
        let Piston { compression_area, rebound_area } = self.ideal;
        with_constant(compression_area * on_compression - rebound_area * on_rebound, -self.preload)
    }
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

    const LEAKING: PumpWithLosses<f64> = PumpWithLosses {
        ideal: Pump { displacement: 12e-6 },
        leakage: 1e-11,
        load: 0.0,
        flow_offset: 0.0,
        coulomb: RotaryCoulomb { torque: 0.0, speed: 2.0 },
    };

    #[test]
    fn oil_leaks_to_the_chamber_of_the_lower_pressure() {
        // 3 bar times 1e-11 m5/(N.s) are 3 ml/s.
        let [compression, rebound] = LEAKING.leaked([1e-4, -2e-4], || 3e5);
        assert!((compression - 97e-6).abs() < 1e-18 && (rebound + 197e-6).abs() < 1e-18);
        let tight = PumpWithLosses { leakage: 0.0, ..LEAKING };
        assert_eq!(tight.leaked([1e-4, -2e-4], || panic!("nobody asks for it")), [1e-4, -2e-4]);
    }

    #[test]
    fn a_leak_that_would_turn_its_pressure_over_is_refused() {
        assert_eq!(LEAKING.check("pump", 0.9e11), Ok(()));
        let error = LEAKING.check("pump", 1.1e11).unwrap_err();
        assert!(error.contains("pump.leakage = 1e-11 m5/(N.s)"), "{error}");
        assert!(LEAKING.check("pump", f64::NAN).is_err());
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
