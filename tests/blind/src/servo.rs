//! A cylinder between body and wheel, driven through a servo valve: Konieczny eq. 2.11 to 2.13 and 2.18.

/// Valve and cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Servo {
    /// Spool travel for a volt, in m/V (k_sv).
    pub gain: f64,
    /// Of the spool, in s (τ).
    pub time_constant: f64,
    /// Largest spool travel to each side, in m (u_1max).
    pub stroke: f64,
    /// Spool travel to each side that opens nothing, in m.
    pub overlap: f64,
    /// How far to each side the spool can be from where the opening was left, in m, before the opening moves.
    pub hysteresis: f64,
    /// Width of the valve's port, in m (l).
    pub perimeter: f64,
    /// Discharge coefficient of the port (C_d).
    pub discharge: f64,
    /// In Pa (P_z).
    pub supply: f64,
    /// Of the oil, in kg/m³ (ρ).
    pub density: f64,
    /// Pressure for a volume of oil pressed into the chambers, in Pa/m³: 4 E/(V_t + V_p) (α; the seed prints 44.4495
    /// for 4.44495·10¹³).
    pub oil_stiffness: f64,
    /// Of the piston, in m² (A_a).
    pub area: f64,
    /// From chamber to chamber, in m⁵/(N s) (C_tm).
    pub leakage: f64,
}

impl Servo {
    /// Where the opening is left that stood at `left`, by a spool at `spool`, in m.
    pub fn dragged(&self, left: f64, spool: f64) -> f64 {
        left.clamp(spool - self.hysteresis, spool + self.hysteresis)
    }

    /// Flow into the chamber that drives body and wheel apart, in m³/s, with the opening left at `left` before; beyond the
    /// supply's pressure the load drives oil back.
    fn flow(&self, left: f64, spool: f64, pressure: f64) -> f64 {
        let travel = self.dragged(left, spool).clamp(-self.stroke, self.stroke);
        let opening = travel - travel.clamp(-self.overlap, self.overlap);
        let drop = (self.supply - opening.signum() * pressure) / self.density;
        opening * self.perimeter * self.discharge * drop.signum() * drop.abs().sqrt()
    }

    /// Rates of the pressure difference in Pa/s and of the spool in m/s, at a voltage and a velocity in m/s with
    /// which body and wheel move apart; the opening was left at `left` before.
    pub fn rates(&self, left: f64, [pressure, spool]: [f64; 2], voltage: f64, velocity: f64) -> (f64, f64) {
        let flow = self.flow(left, spool, pressure) - self.area * velocity - self.leakage * pressure;
        (self.oil_stiffness * flow, (self.gain * voltage - spool) / self.time_constant)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn konieczny() -> Servo {
        Servo {
            gain: 0.025e-3,
            time_constant: 2.32e-3,
            stroke: 0.5e-3,
            overlap: 0.0,
            hysteresis: 0.0,
            perimeter: 15.708e-3,
            discharge: 0.611,
            supply: 12e6,
            density: 880.0,
            oil_stiffness: 4.0 * 1.4e9 / (45.9458e-6 + 80.0398e-6),
            area: 0.765_786e-3,
            leakage: 15e-12,
        }
    }

    #[test]
    fn oil_is_as_stiff_as_published() {
        assert!((konieczny().oil_stiffness / 4.444_95e13 - 1.0).abs() < 1e-5);
    }

    /// C_d l k_sv v √(P_z/ρ) over the piston's area: 36.6 mm/s for a volt.
    #[test]
    fn without_load_the_flow_moves_the_piston() {
        let servo = konieczny();
        let velocity = servo.flow(0.0, 0.025e-3, 0.0) / servo.area;
        assert!((velocity - 0.036_589).abs() < 1e-5, "{velocity} m/s");
        assert!(servo.rates(0.0, [0.0, 0.025e-3], 1.0, velocity).0.abs() < 1.0);
        assert_eq!(servo.flow(0.0, 0.025e-3, 12e6), 0.0);
        assert!(servo.flow(0.0, 0.025e-3, 13e6) < 0.0 && servo.flow(0.0, -0.025e-3, 13e6) < 0.0);
    }

    #[test]
    fn within_its_overlap_the_spool_opens_nothing() {
        let servo = Servo { overlap: 1e-5, ..konieczny() };
        assert_eq!(servo.flow(0.0, 0.9e-5, 1e6), 0.0);
        assert!((servo.flow(0.0, -3e-5, 0.0) - konieczny().flow(0.0, -2e-5, 0.0)).abs() < 1e-18);
    }

    #[test]
    fn within_its_hysteresis_the_spool_moves_no_opening() {
        let servo = Servo { hysteresis: 1e-5, ..konieczny() };
        let mut left = 0.0;
        for (spool, expected) in [(3e-5, 2e-5), (1.5e-5, 2e-5), (2.9e-5, 2e-5), (-1e-5, 0.0), (-4e-5, -3e-5)]
        {
            left = servo.dragged(left, spool);
            assert!((left - expected).abs() < 1e-15, "{left} m at {spool} m");
            assert!((servo.flow(left, spool, 1e6) - konieczny().flow(0.0, expected, 1e6)).abs() < 1e-12);
        }
    }
}
