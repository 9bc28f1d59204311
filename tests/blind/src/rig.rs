//! A rig with its sensors: nominal parameters, clutter and effects put together.

mod hidden;
mod published;
mod signals;

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use crate::car::{Actuator, Car, Motion, Regulator};
use crate::case::{Case, Plant, Sensors, Value};
use crate::drive::{Drive, Loop};
use crate::dyno;
use crate::excitation::Profile;
use crate::friction::{Contact, Limit};
use crate::pneumatic::Pneumatic;
use crate::pump::Pump;
use crate::random::Random;
use crate::sas::Sas;
use crate::sensors::Sensor;
use crate::servo::Servo;
use crate::strut::Strut;
use crate::timed::{Bursts, Turning};

pub use published::{is_uncertain, start, true_base};
pub use signals::{signals, true_signal};

/// Between body and wheel, or between two arms.
const STRUT: [f64; 2] = [1.0, -1.0];
/// Between body, carriage or rotor and ground.
const GUIDE: [f64; 2] = [1.0, 0.0];
/// Between wheel and ground.
const WHEEL_GUIDE: [f64; 2] = [0.0, 1.0];

/// Of least ∫ 450 (z_s − z_u)² + 30 ż_s² + 5 (z_u − z_r)² + 0.01 ż_u² + 2e-5 F² dt on the linear rig as published: Quanser's weights
/// with a cheaper force, as the rig is forty times as heavy. It raises the body's damping from 0.40 to 0.76.
const REGULATOR: Regulator = Regulator { gains: [1246.76, 805.10, -4282.90, 11.80] };

/// A rig with its sensors.
#[derive(Clone, Debug)]
pub struct Rig {
    plant: Plant,
    /// The moving parts; of a dyno only the strut and its contacts count.
    pub car: Car,
    /// The moving parts of a linear drive, or of a mass on a spring.
    pub drive: Drive,
    /// A pump actuator.
    pub pump: Pump,
    /// The arms of a semi-active rig.
    pub sas: Sas,
    /// A pneumatic cylinder with its valve and its mass.
    pub pneumatic: Pneumatic,
    /// Effects of time alone.
    pub timed: Timed,
    /// Seed of their phases and bursts, which differ from record to record.
    pub seed: u64,
    /// Of each signal.
    pub sensors: BTreeMap<String, Sensor>,
}

/// Effects of time alone; zero is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timed {
    /// Share by which the tyre's stiffness changes, and turns of the wheel a second.
    pub uneven_tire: (f64, f64),
    /// Mass in kg times its distance from the axis in m of a part on the body that turns, and its turns a second.
    pub imbalance: (f64, f64),
    /// Drop-outs of the actuator a second.
    pub dropout_rate: f64,
}

impl Rig {
    /// With given nominal parameters and perfect sensors.
    pub fn new(plant: Plant, base: &[Value]) -> Self {
        let of = |name: &str| base.iter().find(|v| v.name == name).map_or(0.0, |v| v.value);
        let mut car = Car {
            sprung_mass: of("sprung_mass"),
            unsprung_mass: of("unsprung_mass"),
            strut: Strut {
                stiffness: of("strut.stiffness"),
                damping: of("strut.damping"),
                asymmetry: of("strut.asymmetry.ratio"),
                ..Strut::default()
            },
            tire_stiffness: of("tire.stiffness"),
            tire_quadratic: of("tire.quadratic"),
            tire_damping: of("tire.damping"),
            actuator: Actuator::default(),
            regulator: (plant == Plant::RegulatedQuarter).then_some(REGULATOR),
            servo: (plant == Plant::ServoQuarter).then(|| Servo {
                gain: of("actuator.spool.gain"),
                time_constant: of("actuator.spool.time_constant"),
                stroke: of("actuator.spool.stroke"),
                overlap: 0.0,
                hysteresis: 0.0,
                perimeter: of("actuator.valve.perimeter"),
                discharge: of("actuator.valve.discharge_coefficient"),
                supply: of("actuator.supply.pressure"),
                density: of("actuator.fluid.density"),
                oil_stiffness: 4.0 * of("actuator.fluid.bulk_modulus")
                    / (of("actuator.cylinder.volume") + of("actuator.cylinder.hose_volume")),
                area: of("actuator.cylinder.area"),
                leakage: of("actuator.cylinder.leakage"),
            }),
            ..Car::default()
        };
        for (along, name) in [(STRUT, "strut.coulomb.force"), (GUIDE, "guide.coulomb.force")] {
            if of(name) > 0.0 {
                car.contacts.push(Contact { along, limit: Limit::Coulomb(of(name)) });
            }
        }
        let drive = Drive {
            mass: of("moving_mass"),
            damping: of("guide.damping"),
            spring: [of("ground_spring.stiffness"), 0.0],
            control: Loop::for_mass(of("moving_mass")),
            ..Drive::default()
        };
        let sensors = signals(plant, Sensors::Full).into_iter();
        let sensors = sensors.map(|(name, _)| (name.to_owned(), Sensor::default())).collect();
        let (pump, sas, pneumatic) = (Pump::new(of), Sas::new(of), Pneumatic::new(of));
        Self { plant, car, drive, pump, sas, pneumatic, timed: Timed::default(), seed: 0, sensors }
    }

    /// Adds the small effects that no model knows, `level` times.
    pub fn clutter_plant(&mut self, level: f64, random: &mut Random) {
        match self.plant {
            Plant::LinearDrive | Plant::GuidedMass => {
                self.drive.cable = Some((level * random.between(20.0, 60.0), random.between(0.05, 0.15)));
                let share = level * random.between(0.003, 0.008);
                self.drive.ripple = Some((share, random.between(0.02, 0.05), random.phase()));
                return;
            }
            Plant::PumpDyno => return self.pump.clutter(level, random),
            Plant::SasRig => return self.sas.clutter(level, random),
            Plant::PneumaticCylinder => return self.pneumatic.clutter(level, random),
            _ => {}
        }
        let strut = &mut self.car.strut;
        strut.maxwell[1] = Some((level * random.between(1000.0, 2500.0), random.between(0.005, 0.015)));
        strut.cubic += level * random.between(1e6, 4e6);
        strut.cogging = Some((level * random.between(1.0, 4.0), random.between(0.01, 0.03), random.phase()));
    }

    /// Whether its command is a brake's rate, of which only the motion makes the torque that is recorded.
    pub fn is_braked(&self) -> bool {
        self.plant == Plant::SasRig && self.sas.drag.is_some()
    }

    /// Whether a loop commands the voltage that is recorded.
    pub fn is_looped(&self) -> bool {
        self.plant == Plant::PneumaticCylinder && self.pneumatic.control.is_some()
    }

    /// Makes the sensors as slow and as late as such sensors are, `level` times.
    pub fn clutter_sensors(&mut self, level: f64, random: &mut Random) {
        for (name, sensor) in &mut self.sensors {
            sensor.skew += level * random.sign() * random.between(1e-4, 4e-4);
            if name.ends_with("acceleration") {
                sensor.bandwidth = level / (TAU * 200.0);
            }
        }
    }

    /// What the parts do under an excitation: of a car the road and its command, of a dyno the motion of its end, of
    /// a drive the position that it shall follow, of a mass on a spring its force, of a pump actuator its piston's velocity and its
    /// torque, of a semi-active rig the eccentric and its brake, of a pneumatic cylinder the position that it shall follow and a
    /// dither on its valve's voltage. What happens in time does so at the times of a record.
    pub fn run(&self, road: &Profile, command: &Profile, duration: f64, record: &str) -> Motion {
        match self.plant {
            Plant::LinearDrive => self.drive.run(road, duration),
            Plant::GuidedMass => self.drive.pushed(road, duration),
            Plant::PumpDyno => self.pump.run(road, command, duration),
            Plant::SasRig => self.sas.run(road, command, duration),
            Plant::PneumaticCylinder => self.pneumatic.run(road, command, duration),
            Plant::StrutDyno | Plant::MrDyno => {
                let limits: Vec<Limit> = self.car.contacts.iter().map(|contact| contact.limit).collect();
                dyno::run(&self.car.strut, &limits, road, duration)
            }
            Plant::LinearQuarter
            | Plant::RegulatedQuarter
            | Plant::PublishedQuarter
            | Plant::ServoQuarter => self.timed(duration, record).run(road, command, duration, [0.0; 4]),
        }
    }

    /// The car with the effects of time in a record.
    fn timed(&self, duration: f64, record: &str) -> Car {
        let random = |what: &str| Random::new(self.seed, &format!("{what} in {record}"));
        let turning = |what: &str, size: f64, frequency: f64| {
            (size != 0.0).then(|| Turning { size, frequency, phase: random(what).phase() })
        };
        let Timed { uneven_tire, imbalance, dropout_rate } = self.timed;
        // The centrifugal force of a part that turns.
        let force = imbalance.0 * (TAU * imbalance.1).powi(2);
        Car {
            uneven_tire: turning("wheel", uneven_tire.0, uneven_tire.1),
            imbalance: turning("imbalance", force, imbalance.1),
            dropouts: Bursts::new(&mut random("drop-outs"), duration, dropout_rate),
            ..self.car.clone()
        }
    }

    /// What the sensors show of it: one column for each wanted signal, noise from the stream of `record`.
    pub fn measured(&self, case: &Case, motion: &Motion, record: &str) -> Vec<(String, String, Vec<f64>)> {
        let wanted = signals(case.plant, case.sensors).into_iter();
        let column = |(name, unit): (&str, &str)| {
            let mut noise = Random::new(case.seed, &format!("noise of {name} in {record}"));
            let (sensor, mut signal) = (&self.sensors[name], true_signal(self.plant, motion, name));
            if sensor.moved_mass > 0.0 {
                for (value, acceleration) in signal.iter_mut().zip(&motion.wheel_acceleration) {
                    *value -= sensor.moved_mass * acceleration;
                }
            }
            let mut shown = sensor.measure(&signal, case.rate, &mut noise);
            shown.truncate(case.samples());
            (name.to_owned(), unit.to_owned(), shown)
        };
        wanted.map(column).collect()
    }
}
