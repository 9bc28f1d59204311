//! Units of measurement and what they are in the base units of the SI.

mod owned;

pub use owned::OwnedUnit;

/// A unit with its decomposition: `value in base units = factor · value + offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// As it is written in a model description, FMI style: `N.s/m`.
    pub symbol: &'static str,
    /// Exponents of the base units.
    pub base: Base,
    /// Factor to base units.
    pub factor: f64,
    /// Offset to base units.
    pub offset: f64,
}

/// Exponents of the base units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Base {
    /// Exponent of the kilogram.
    pub kg: i8,
    /// Exponent of the metre.
    pub m: i8,
    /// Exponent of the second.
    pub s: i8,
    /// Exponent of the ampere.
    pub a: i8,
    /// Exponent of the kelvin.
    pub k: i8,
    /// Exponent of the mole.
    pub mol: i8,
    /// Exponent of the candela.
    pub cd: i8,
    /// Exponent of the radian.
    pub rad: i8,
}

impl Base {
    /// The base units, as FMI names them.
    pub const NAMES: [&str; 8] = ["kg", "m", "s", "A", "K", "mol", "cd", "rad"];

    /// No unit at all.
    pub const NONE: Self = Self { kg: 0, m: 0, s: 0, a: 0, k: 0, mol: 0, cd: 0, rad: 0 };

    /// Exponents with the names that FMI gives the base units, zeros left out.
    pub fn exponents(self) -> impl Iterator<Item = (&'static str, i8)> {
        let Self { kg, m, s, a, k, mol, cd, rad } = self;
        let all = [kg, m, s, a, k, mol, cd, rad];
        Self::NAMES.into_iter().zip(all).filter(|(_, exponent)| *exponent != 0)
    }

    /// From exponents in the order of [`NAMES`](Self::NAMES).
    pub const fn of([kg, m, s, a, k, mol, cd, rad]: [i8; 8]) -> Self {
        Self { kg, m, s, a, k, mol, cd, rad }
    }
}

impl Unit {
    /// A coherent unit: one of it is one of its base units' product.
    pub const fn coherent(symbol: &'static str, base: Base) -> Self {
        Self { symbol, base, factor: 1.0, offset: 0.0 }
    }
}

/// Whatever unit the signal has: only a parameter set can say which, and without one nobody knows.
pub const ANY: Unit = Unit::coherent("", Base::NONE);

macro_rules! units {
    ($($(#[$doc:meta])* $name:ident = $symbol:literal { $($base:ident: $exponent:expr),* };)*) => {
        $($(#[$doc])*
        pub const $name: Unit = Unit::coherent($symbol, Base { $($base: $exponent,)* ..Base::NONE });)*
        /// Every unit that is declared here.
        pub const ALL: &[Unit] = &[$($name),*];
    };
}

units! {
    /// Dimensionless.
    ONE = "1" {};
    /// Kilogram.
    KG = "kg" { kg: 1 };
    /// Kilogram square metre: a moment of inertia.
    KG_M2 = "kg.m2" { kg: 1, m: 2 };
    /// Metre.
    M = "m" { m: 1 };
    /// Second.
    S = "s" { s: 1 };
    /// Ampere.
    A = "A" { a: 1 };
    /// Radian.
    RAD = "rad" { rad: 1 };
    /// Radian per second.
    RAD_PER_S = "rad/s" { rad: 1, s: -1 };
    /// Radian per second squared.
    RAD_PER_S2 = "rad/s2" { rad: 1, s: -2 };
    /// Second per radian: a duty cycle that is made of a speed.
    S_PER_RAD = "s/rad" { s: 1, rad: -1 };
    /// Second squared per radian: a duty cycle that is made of an acceleration.
    S2_PER_RAD = "s2/rad" { s: 2, rad: -1 };
    /// Per radian: a duty cycle that is made of an angle.
    PER_RAD = "1/rad" { rad: -1 };
    /// Hertz.
    HZ = "Hz" { s: -1 };
    /// Hertz per second.
    HZ_PER_S = "Hz/s" { s: -2 };
    /// Per second.
    PER_S = "1/s" { s: -1 };
    /// Metre per second.
    M_PER_S = "m/s" { m: 1, s: -1 };
    /// Metre per second squared.
    M_PER_S2 = "m/s2" { m: 1, s: -2 };
    /// Square metre.
    M2 = "m2" { m: 2 };
    /// Cubic metre; also a road's displacement spectral density over spatial frequency.
    M3 = "m3" { m: 3 };
    /// Cycles per metre.
    PER_M = "1/m" { m: -1 };
    /// Newton.
    N = "N" { kg: 1, m: 1, s: -2 };
    /// Newton per metre.
    N_PER_M = "N/m" { kg: 1, s: -2 };
    /// Newton per square metre of deflection: a quadratic spring rate.
    N_PER_M2 = "N/m2" { kg: 1, m: -1, s: -2 };
    /// Newton per cubic metre of deflection: a cubic spring rate.
    N_PER_M3 = "N/m3" { kg: 1, m: -2, s: -2 };
    /// Metre per newton: a compliance.
    M_PER_N = "m/N" { kg: -1, s: 2 };
    /// Second per newton: how long a force takes to change.
    S_PER_N = "s/N" { kg: -1, m: -1, s: 3 };
    /// Newton second squared per square metre: what an orifice makes of a velocity squared.
    N_S2_PER_M2 = "N.s2/m2" { kg: 1, m: -1 };
    /// Newton second per metre.
    N_S_PER_M = "N.s/m" { kg: 1, s: -1 };
    /// Kilogram per cubic metre.
    KG_PER_M3 = "kg/m3" { kg: 1, m: -3 };
    /// Pascal.
    PA = "Pa" { kg: 1, m: -1, s: -2 };
    /// Cubic metre per second.
    M3_PER_S = "m3/s" { m: 3, s: -1 };
    /// Square metre per second: the flow of one metre of valve opening.
    M2_PER_S = "m2/s" { m: 2, s: -1 };
    /// Cubic metre per second and pascal: a leakage.
    M5_PER_N_S = "m5/(N.s)" { kg: -1, m: 4, s: 1 };
    /// Newton per metre to the fifth: the pressure of one cubic metre of oil that is forced in.
    N_PER_M5 = "N/m5" { kg: 1, m: -4, s: -2 };
    /// Newton metre second per radian: what a rotary damper has.
    N_M_S_PER_RAD = "N.m.s/rad" { kg: 1, m: 2, s: -1, rad: -1 };
    /// Newton metre: a torque.
    N_M = "N.m" { kg: 1, m: 2, s: -2 };
    /// Radian per metre: how far something turns for a way.
    RAD_PER_M = "rad/m" { m: -1, rad: 1 };
    /// Pascal second per cubic metre: what a valve makes of a flow.
    PA_S_PER_M3 = "Pa.s/m3" { kg: 1, m: -4, s: -1 };
    /// Newton metre per radian: the rate of a torsion spring; what a speed controller makes of a speed with time.
    N_M_PER_RAD = "N.m/rad" { kg: 1, m: 2, s: -2, rad: -1 };
    /// Newton metre per radian squared: a quadratic rate of a torsion spring.
    N_M_PER_RAD2 = "N.m/rad2" { kg: 1, m: 2, s: -2, rad: -2 };
    /// Newton metre per radian cubed: a cubic rate of a torsion spring.
    N_M_PER_RAD3 = "N.m/rad3" { kg: 1, m: 2, s: -2, rad: -3 };
    /// Newton metre per volt: what an amplifier makes of its command.
    N_M_PER_V = "N.m/V" { s: 1, a: 1 };
    /// Newton metre second squared per radian: what a speed controller makes of an acceleration.
    N_M_S2_PER_RAD = "N.m.s2/rad" { kg: 1, m: 2, rad: -1 };
    /// Metre per second and newton: what a force controller makes of a force.
    M_PER_S_N = "m/(s.N)" { kg: -1, s: 1 };
    /// Metre per second squared and newton: what a force controller makes of a force with time.
    M_PER_S2_N = "m/(s2.N)" { kg: -1 };
    /// Radian per second and newton: what a force controller makes of a force.
    RAD_PER_S_N = "rad/(s.N)" { kg: -1, m: -1, s: 1, rad: 1 };
    /// Radian per second squared and newton: what a force controller makes of a force with time.
    RAD_PER_S2_N = "rad/(s2.N)" { kg: -1, m: -1, rad: 1 };
    /// Watt.
    W = "W" { kg: 1, m: 2, s: -3 };
    /// Volt.
    V = "V" { kg: 1, m: 2, s: -3, a: -1 };
    /// Volt per second.
    V_PER_S = "V/s" { kg: 1, m: 2, s: -4, a: -1 };
    /// Metre per volt.
    M_PER_V = "m/V" { kg: -1, m: -1, s: 3, a: 1 };
    /// Metre per second and volt.
    M_PER_V_S = "m/(V.s)" { kg: -1, m: -1, s: 2, a: 1 };
    /// Volt second squared per metre: the sensitivity of an accelerometer.
    V_S2_PER_M = "V.s2/m" { kg: 1, m: 1, s: -1, a: -1 };
    /// Volt per newton: the sensitivity of a load cell.
    V_PER_N = "V/N" { m: 1, s: -1, a: -1 };
    /// Volt per ampere: the sensitivity of a current sensor.
    V_PER_A = "V/A" { kg: 1, m: 2, s: -3, a: -2 };
    /// Ampere per volt.
    A_PER_V = "A/V" { kg: -1, m: -2, s: 3, a: 2 };
    /// Newton metre per ampere: what a motor makes of its current.
    N_M_PER_A = "N.m/A" { kg: 1, m: 2, s: -2, a: -1 };
    /// Newton per ampere.
    N_PER_A = "N/A" { kg: 1, m: 1, s: -2, a: -1 };
    /// Newton per volt.
    N_PER_V = "N/V" { m: -1, s: 1, a: 1 };
    /// Ohm: a resistance, or what a current controller makes of a current.
    OHM = "Ohm" { kg: 1, m: 2, s: -3, a: -2 };
    /// Ohm per second: what a current controller makes of a current with time.
    OHM_PER_S = "Ohm/s" { kg: 1, m: 2, s: -4, a: -2 };
    /// Henry.
    H = "H" { kg: 1, m: 2, s: -2, a: -2 };
    /// Ampere per metre: what a velocity controller makes of a velocity with time.
    A_PER_M = "A/m" { a: 1, m: -1 };
    /// Ampere second per metre: what a velocity controller makes of a velocity.
    A_S_PER_M = "A.s/m" { a: 1, m: -1, s: 1 };
    /// Ampere squared second: what an I²t limiter accumulates.
    A2_S = "A2.s" { a: 2, s: 1 };
    /// Per volt: the opening that a voltage asks for.
    PER_V = "1/V" { kg: -1, m: -2, s: 3, a: 1 };
    /// Per volt and second.
    PER_V_S = "1/(V.s)" { kg: -1, m: -2, s: 2, a: 1 };
    /// Per square newton: the weight of a force in a quadratic cost.
    PER_N2 = "1/N2" { kg: -2, m: -2, s: 4 };
    /// Per square metre: the weight of a position in a quadratic cost.
    PER_M2 = "1/m2" { m: -2 };
    /// Second squared per square metre: the weight of a velocity in a quadratic cost.
    S2_PER_M2 = "s2/m2" { m: -2, s: 2 };
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Exponents from the symbol, by an independent reading of it.
    fn parsed(symbol: &str) -> Base {
        let mut total = [0_i8; 6];
        let (numerator, denominator) = symbol.split_once('/').unwrap_or((symbol, ""));
        for (part, sign) in [(numerator, 1), (denominator.trim_matches(['(', ')']), -1)] {
            for factor in part.split('.').filter(|factor| !factor.is_empty() && *factor != "1") {
                let name = factor.trim_end_matches(char::is_numeric);
                let power: i8 = factor[name.len()..].parse().unwrap_or(1);
                let base: [i8; 6] = match name {
                    "kg" => [1, 0, 0, 0, 0, 0],
                    "m" => [0, 1, 0, 0, 0, 0],
                    "s" => [0, 0, 1, 0, 0, 0],
                    "A" => [0, 0, 0, 1, 0, 0],
                    "rad" => [0, 0, 0, 0, 0, 1],
                    "Hz" => [0, 0, -1, 0, 0, 0],
                    "N" => [1, 1, -2, 0, 0, 0],
                    "Pa" => [1, -1, -2, 0, 0, 0],
                    "W" => [1, 2, -3, 0, 0, 0],
                    "V" => [1, 2, -3, -1, 0, 0],
                    "Ohm" => [1, 2, -3, -2, 0, 0],
                    "H" => [1, 2, -2, -2, 0, 0],
                    other => panic!("unknown unit {other}"),
                };
                for (sum, exponent) in total.iter_mut().zip(base) {
                    *sum += sign * power * exponent;
                }
            }
        }
        let [kg, m, s, a, k, rad] = total;
        Base { kg, m, s, a, k, rad, ..Base::NONE }
    }

    #[test]
    fn exponents_agree_with_symbols() {
        for unit in ALL {
            assert_eq!(unit.base, parsed(unit.symbol), "{}", unit.symbol);
        }
    }

    #[test]
    fn rates_of_change_have_a_second_less() {
        for unit in ALL {
            let rate = unit.per_second();
            let base = Base { s: unit.base.s - 1, ..unit.base };
            assert_eq!((rate.base, parsed(&rate.symbol)), (Some(base), base), "{}", rate.symbol);
        }
        for (unit, expected) in [
            (ONE, "1/s"),
            (PA, "Pa/s"),
            (M_PER_S, "m/s2"),
            (N_S_PER_M, "N/m"),
            (A2_S, "A2"),
            (M5_PER_N_S, "m5/(N.s2)"),
            (S_PER_RAD, "1/rad"),
            (M_PER_N, "m/(N.s)"),
        ] {
            assert_eq!(unit.per_second().symbol, expected);
        }
        assert_eq!(ANY.per_second().symbol, "");
    }

    #[test]
    fn symbols_are_unique() {
        for (i, unit) in ALL.iter().enumerate() {
            assert!(ALL[..i].iter().all(|other| other.symbol != unit.symbol), "{}", unit.symbol);
        }
    }
}
