//! Encoders: what they measure is counted.

use std::f64::consts::TAU;

use strut_model::{Choice, Real, Variables};

/// What a counter makes of a position between two counts.
#[derive(Choice, Clone, Copy, Debug, PartialEq)]
pub enum Rounding {
    /// The count that was passed last, as a counter does
    Floor,
    /// The nearest count, as a counter does that starts in the middle between two
    Nearest,
}

/// An incremental encoder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoder<R> {
    /// Counts for one unit; zero switches the counting off.
    pub density: R,
    /// Relative error of the scale.
    pub gain_error: R,
    /// Where the count is zero.
    pub zero: R,
}

/// An encoder of a position.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct PositionEncoder<R> {
    /// Counts for one metre; zero switches the counting off
    #[var(unit = PER_M, start = 0.0, min = 0.0)]
    pub density: R,
    /// Relative error of the scale
    #[var(unit = ONE, start = 0.0, min = -0.99)]
    pub gain_error: R,
    /// Position at which the count is zero
    #[var(unit = M, start = 0.0)]
    pub zero: R,
}

/// An encoder of an angle.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct AngleEncoder<R> {
    /// Counts for one turn; zero switches the counting off
    #[var(unit = ONE, start = 0.0, min = 0.0)]
    pub counts_per_turn: R,
    /// Angle at which the count is zero
    #[var(unit = RAD, start = 0.0)]
    pub zero: R,
}

impl<R: Real> PositionEncoder<R> {
    /// The encoder.
    pub fn encoder(&self) -> Encoder<R> {
        let Self { density, gain_error, zero } = *self;
        Encoder { density, gain_error, zero }
    }
}

impl<R: Real> AngleEncoder<R> {
    /// The encoder.
    pub fn encoder(&self) -> Encoder<R> {
        Encoder { density: self.counts_per_turn / TAU, gain_error: R::from(0.0), zero: self.zero }
    }
}

impl<R: Real> Encoder<R> {
    /// The position that the count stands for.
    pub fn read(&self, rounding: Rounding, position: R) -> R {
        let scaled = (position - self.zero) * (self.gain_error + 1.0);
        let density = self.density.select(self.density, R::from(1.0));
        let shift = match rounding {
            Rounding::Floor => 0.0,
            Rounding::Nearest => 0.5,
        };
        self.density.select((scaled * density + shift).floor() / density, scaled) + self.zero
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_quantum_of_4096_counts_is_kogut_s_accuracy() {
        let encoder = AngleEncoder { counts_per_turn: 4096.0, zero: 0.0 }.encoder();
        let quantum = encoder.read(Rounding::Floor, 0.002);
        assert!((quantum - 0.001534_f64).abs() < 5e-7, "{quantum}");
        assert_eq!(encoder.read(Rounding::Floor, 0.0015), 0.0);
    }

    #[test]
    fn twelve_pulses_are_a_millimetre() {
        let encoder = PositionEncoder { density: 12e3, gain_error: 0.0, zero: 0.0 }.encoder();
        let distinct: std::collections::BTreeSet<i64> = (0..10_000)
            .map(|k| (encoder.read(Rounding::Floor, f64::from(k) * 1e-7) * 12e3).round() as i64)
            .collect();
        assert_eq!(distinct.len(), 12);
        assert!((encoder.read(Rounding::Nearest, -1e-4) + 1.0 / 12e3).abs() < 1e-15);
    }

    proptest! {
        #[test]
        fn floor_is_late_by_less_than_a_count_and_nearest_by_half_of_one(x in -0.1..0.1_f64, zero in -0.1..0.1_f64) {
            let encoder = PositionEncoder { density: 12e3, gain_error: 0.0, zero }.encoder();
            let late = (x - encoder.read(Rounding::Floor, x)) * 12e3;
            let off = (x - encoder.read(Rounding::Nearest, x)) * 12e3;
            prop_assert!((-1e-9..1.0 + 1e-9).contains(&late) && off.abs() <= 0.5 + 1e-9, "{late} {off}");
        }

        #[test]
        fn without_counts_it_is_absent(x in -0.1..0.1_f64) {
            let ideal = Encoder { density: 0.0, gain_error: 0.0, zero: 0.0 };
            prop_assert_eq!(ideal.read(Rounding::Floor, x), x);
        }
    }
}
