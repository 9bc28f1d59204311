//! A measured quantity on its way to a number: sensor, filter, converter.

use std::f64::consts::TAU;

use strut_model::{Choice, Real, Variables, noise};

/// How a sensor follows what it measures.
#[derive(Choice, Clone, Copy, Debug, PartialEq)]
pub enum Dynamics {
    /// At once
    Direct,
    /// As a lag with the sensor's bandwidth
    FirstOrder,
    /// As a damped mass with the sensor's bandwidth
    SecondOrder,
}

/// What makes a voltage of a quantity.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Sensor<R> {
    /// Frequency at which the gain is down by 3 dB
    #[var(unit = HZ, start = 1000.0, min = 1e-3)]
    pub bandwidth: R,
    /// Damping ratio of a sensor of second order
    #[var(unit = ONE, start = 0.707, min = 1e-3, max = 100.0)]
    pub damping: R,
    /// Voltage beyond which it does not go
    #[var(unit = V, start = 10.0, min = 1e-6)]
    pub full_scale: R,
    /// Relative error of the sensitivity
    #[var(unit = ONE, start = 0.0, min = -0.99)]
    pub gain_error: R,
    /// Voltage without anything to measure
    #[var(unit = V, start = 0.0)]
    pub offset: R,
}

/// A resistor and a capacitor in front of the converter.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Filter<R> {
    /// Corner frequency (f_c)
    #[var(unit = HZ, start = 380.0, min = 1e-3)]
    pub corner_frequency: R,
}

/// What makes a number of a voltage.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Converter<R> {
    /// Largest voltage of either sign
    #[var(unit = V, start = 10.0, min = 1e-6)]
    pub range: R,
    /// Voltage of one step; zero switches the rounding off
    #[var(unit = V, start = 0.0, min = 0.0)]
    pub resolution: R,
    /// Relative error of the gain
    #[var(unit = ONE, start = 0.0, min = -0.99)]
    pub gain_error: R,
    /// Voltage that is added
    #[var(unit = V, start = 0.0)]
    pub offset: R,
}

/// The voltages of one channel.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct AnalogState<R> {
    /// Voltage of the sensor before its errors
    #[var(unit = V, nominal = 1.0)]
    pub sensor: R,
    /// How fast it changes, over its natural frequency
    #[var(unit = V, nominal = 1.0)]
    pub trend: R,
    /// Voltage behind the filter
    #[var(unit = V, nominal = 1.0)]
    pub filtered: R,
}

/// One analogue channel; everything but the sensitivity counts in volts and is the same for every quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Channel<R> {
    /// Volts for one unit of the quantity.
    pub sensitivity: R,
    /// Sensor.
    pub sensor: Sensor<R>,
    /// Filter.
    pub filter: Filter<R>,
    /// Converter.
    pub converter: Converter<R>,
    /// Root mean square of the noise at the converter.
    pub noise: R,
}

/// Which way a channel's signal takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Path {
    /// How the sensor follows.
    pub dynamics: Dynamics,
    /// There is a filter.
    pub filtered: bool,
}

/// The parameters of a channel for a quantity: only the sensitivity's unit differs.
macro_rules! channels {
    ($($(#[$about:meta])* $name:ident: $unit:ident, $start:literal;)*) => {$(
        $(#[$about])*
        #[derive(Variables, Clone, Copy, Debug, PartialEq)]
        pub struct $name<R> {
            /// Voltage for one unit of the quantity
            #[var(unit = $unit, start = $start, min = 1e-12)]
            pub sensitivity: R,
            /// Sensor
            pub sensor: Sensor<R>,
            /// Filter in front of the converter
            pub filter: Filter<R>,
            /// Converter
            pub converter: Converter<R>,
            /// Noise at the converter, behind the filter, root mean square; independent from sample to sample
            #[var(unit = V, start = 0.0, min = 0.0)]
            pub noise: R,
        }

        impl<R: Copy> $name<R> {
            /// The channel.
            #[inline]
            pub fn channel(&self) -> Channel<R> {
                let Self { sensitivity, sensor, filter, converter, noise } = *self;
                Channel { sensitivity, sensor, filter, converter, noise }
            }
        }
    )*};
}

channels! {
    /// A channel for an acceleration.
    AccelerationChannel: V_S2_PER_M, 0.08;
    /// A channel for a force.
    ForceChannel: V_PER_N, 2e-3;
    /// A channel for a current.
    CurrentChannel: V_PER_A, 0.3;
}

impl<R: Real> Sensor<R> {
    /// The natural frequency with which a sensor of second order has its bandwidth.
    pub fn natural_frequency(&self) -> R {
        let slack = R::from(1.0) - self.damping.squared() * 2.0;
        self.bandwidth / (slack + (slack.squared() + 1.0).sqrt()).sqrt()
    }
}

impl<R: Real> Channel<R> {
    /// What the sensor gives: its following of the quantity with its errors and limits.
    #[inline]
    fn sensed(&self, path: Path, quantity: R, state: &AnalogState<R>) -> R {
        let voltage = match path.dynamics {
            Dynamics::Direct => self.sensitivity * quantity,
            Dynamics::FirstOrder | Dynamics::SecondOrder => state.sensor,
        };
        let sensor = &self.sensor;
        (voltage * (sensor.gain_error + 1.0) + sensor.offset).clamp(-sensor.full_scale, sensor.full_scale)
    }

    /// The rates of the voltages.
    #[inline]
    pub fn rates(
        &self,
        path: Path,
        natural_frequency: R,
        quantity: R,
        state: &AnalogState<R>,
    ) -> AnalogState<R> {
        let zero = R::from(0.0);
        let missing = self.sensitivity * quantity - state.sensor;
        let (sensor, trend) = match path.dynamics {
            Dynamics::Direct => (zero, zero),
            Dynamics::FirstOrder => (self.sensor.bandwidth * TAU * missing, zero),
            Dynamics::SecondOrder => {
                let omega = natural_frequency * TAU;
                (omega * state.trend, omega * (missing - self.sensor.damping * state.trend * 2.0))
            }
        };
        let filtered = if path.filtered {
            self.filter.corner_frequency * TAU * (self.sensed(path, quantity, state) - state.filtered)
        } else {
            zero
        };
        AnalogState { sensor, trend, filtered }
    }

    /// The quantity that is read off the converter.
    pub fn sample(&self, path: Path, quantity: R, state: &AnalogState<R>, draw: Draw) -> R {
        let voltage = if path.filtered { state.filtered } else { self.sensed(path, quantity, state) };
        self.converter.convert(voltage + draw.noise(self.noise)) / self.sensitivity
    }
}

impl Channel<f64> {
    /// Refuses a converter whose step is as large as its range.
    ///
    /// # Errors
    /// A sentence with both.
    pub fn check(&self, name: &str) -> Result<(), String> {
        let Converter { range, resolution, .. } = self.converter;
        if resolution < range {
            return Ok(());
        }
        Err(format!(
            "{name}.converter.resolution = {resolution} V must be smaller than {name}.converter.range = {range} V: \
             the converter would know no step above zero"
        ))
    }
}

impl<R: Real> Converter<R> {
    /// The voltage that a converter reports: the nearest of its steps.
    #[inline]
    pub fn convert(&self, voltage: R) -> R {
        let voltage = voltage * (self.gain_error + 1.0) + self.offset;
        let step = self.resolution.select(self.resolution, R::from(1.0));
        let rounded = (voltage / step + 0.5).floor() * step;
        // Two's complement: one step less on the upper side.
        self.resolution.select(rounded, voltage).clamp(-self.range, self.range - self.resolution)
    }
}

/// Where in the sequence of random numbers a sample stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Draw {
    /// Seed.
    pub seed: i32,
    /// Number of the channel.
    pub stream: u64,
    /// Number of the tick.
    pub tick: u64,
}

impl Draw {
    /// Normally distributed noise of a root mean square.
    #[inline]
    fn noise<R: Real>(self, rms: R) -> R {
        if rms.vanishes() {
            return R::from(0.0);
        }
        rms * noise(self.seed as u64, self.stream, self.tick)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Table 4: 16 bits over 20 V.
    const CONVERTER: Converter<f64> =
        Converter { range: 10.0, resolution: 20.0 / 65536.0, gain_error: 0.0, offset: 0.0 };

    #[test]
    fn resolutions_are_those_of_table_4() {
        assert!((CONVERTER.resolution * 1e3 - 0.3).abs() < 0.05);
        assert!((20.0 / 4096.0 * 1e3 - 4.9_f64).abs() < 0.05);
        assert_eq!(CONVERTER.convert(20.0), 10.0 - CONVERTER.resolution);
        assert_eq!(CONVERTER.convert(-20.0), -10.0);
    }

    #[test]
    fn errors_of_the_converter_add_up() {
        let converter = Converter { resolution: 0.0, gain_error: 0.0025, offset: -0.005, ..CONVERTER };
        assert!((converter.convert(4.0) - (4.0 * 1.0025 - 0.005)).abs() < 1e-15);
    }

    #[test]
    fn a_sensor_of_second_order_is_3_decibels_down_at_its_bandwidth() {
        for damping in [0.05, 0.5, 0.707, 1.5] {
            let sensor = Sensor { bandwidth: 400.0, damping, full_scale: 4.0, gain_error: 0.0, offset: 0.0 };
            let ratio: f64 = 400.0 / sensor.natural_frequency();
            let gain = 1.0 / (1.0 - ratio * ratio).hypot(2.0 * damping * ratio);
            assert!((gain - 0.5_f64.sqrt()).abs() < 1e-12, "{damping}");
        }
    }

    #[test]
    fn a_step_as_large_as_the_range_is_refused() {
        let mut channel = Channel {
            sensitivity: 1.0,
            sensor: Sensor { bandwidth: 1e3, damping: 0.7, full_scale: 10.0, gain_error: 0.0, offset: 0.0 },
            filter: Filter { corner_frequency: 380.0 },
            converter: CONVERTER,
            noise: 0.0,
        };
        assert_eq!(channel.check("wheel_force"), Ok(()));
        channel.converter.resolution = 10.0;
        let error = channel.check("wheel_force").unwrap_err();
        assert!(error.contains("wheel_force.converter.resolution = 10 V"), "{error}");
    }

    proptest! {
        #[test]
        fn a_converter_is_off_by_half_a_step_at_most(voltage in -10.0..9.999_f64) {
            prop_assert!((CONVERTER.convert(voltage) - voltage).abs() <= 0.5 * CONVERTER.resolution + 1e-12);
        }

        #[test]
        fn without_steps_it_is_absent(voltage in -10.0..10.0_f64) {
            prop_assert_eq!(Converter { resolution: 0.0, ..CONVERTER }.convert(voltage), voltage);
        }
    }
}
