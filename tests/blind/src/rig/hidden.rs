//! How an effect gets into a rig.

use super::{GUIDE, Rig, STRUT, WHEEL_GUIDE};
use crate::car::{Crosstalk, Frame};
use crate::case::Plant;
use crate::catalogue::{Entry, Place};
use crate::friction::{Contact, Limit};
use crate::sensors::Rattle;
use crate::servo::Servo;
use crate::strut::{Bypass, Hump, memory};

/// Effects that only one plant can have.
const OF_SERVO: [&str; 5] = ["26v", "28", "28h", "29", "30"];
const OF_DRIVE: [&str; 3] = ["02g", "27", "33g"];
const OF_MASS: [&str; 3] = ["16m", "08n", "U9m"];
const OF_PUMP: [&str; 4] = ["30p", "32a", "32b", "32c"];
const OF_SAS: [&str; 2] = ["01p", "19p"];
const OF_PNEUMATIC: [&str; 4] = ["15c", "28c", "29c", "30c"];

/// Whether a plant has the part that the effect sits in, and does not have the effect anyway.
fn is_possible(plant: Plant, entry: &Entry) -> bool {
    let id = entry.id;
    let elsewhere = |own: &[&str]| {
        let all = [&OF_SERVO[..], &OF_DRIVE, &OF_MASS, &OF_PUMP, &OF_SAS, &OF_PNEUMATIC].concat();
        all.contains(&id) && !own.contains(&id)
    };
    let of_record = entry.place == Place::Sensor && !["41", "41h", "42"].contains(&id);
    // Delay and gain of what is commanded.
    let of_command = ["23", "25"].contains(&id);
    match plant {
        Plant::LinearQuarter | Plant::RegulatedQuarter => !elsewhere(&[]),
        Plant::PublishedQuarter => !elsewhere(&[]) && !["01", "02", "04", "16", "19"].contains(&id),
        Plant::ServoQuarter => {
            let of_force = entry.place == Place::Actuator || id == "U15";
            OF_SERVO.contains(&id) || !elsewhere(&OF_SERVO) && !of_force
        }
        Plant::StrutDyno | Plant::MrDyno => match entry.place {
            Place::Strut => !["13", "14", "U7"].contains(&id),
            Place::Sensor => of_record,
            Place::Guide
            | Place::WheelGuide
            | Place::Tire
            | Place::Frame
            | Place::Actuator
            | Place::Pump
            | Place::Pivot
            | Place::Cylinder => false,
        },
        Plant::LinearDrive => OF_DRIVE.contains(&id) || id == "16" || of_record,
        Plant::GuidedMass => OF_MASS.contains(&id) || of_record,
        Plant::PumpDyno => OF_PUMP.contains(&id) || of_command || of_record,
        Plant::SasRig => OF_SAS.contains(&id) || of_command || of_record,
        Plant::PneumaticCylinder => OF_PNEUMATIC.contains(&id) || id == "16" || of_record,
    }
}

impl Rig {
    /// Puts an effect in.
    ///
    /// # Errors
    /// If the plant or its sensors cannot have it.
    pub fn put_in(&mut self, entry: &Entry, values: &[f64], signal: &str) -> Result<(), String> {
        if !is_possible(self.plant, entry) {
            return Err(format!(
                "effect {} cannot be hidden in {:?}: hide it in another plant",
                entry.id, self.plant
            ));
        }
        let actuator = match self.plant {
            Plant::PumpDyno => &mut self.pump.actuator,
            Plant::SasRig => &mut self.sas.actuator,
            _ => &mut self.car.actuator,
        };
        let (strut, drive) = (&mut self.car.strut, &mut self.drive);
        let first = values.first().copied().unwrap_or_default();
        let hump = |values: &[f64]| Hump { height: values[0], centre: values[1], width: values[2] };
        let stribeck = |values: &[f64]| Limit::Stribeck {
            at_rest: values[0] + values[1],
            sliding: values[0],
            velocity: values[2],
        };
        let contact = |along, limit| Contact { along, limit };
        match entry.id {
            "01" => self.car.contacts.push(contact(STRUT, Limit::Coulomb(first))),
            "01p" => self.sas.contacts.push(contact(STRUT, Limit::Coulomb(first))),
            "02" => self.car.contacts.push(contact(STRUT, stribeck(values))),
            "02g" => drive.contacts.push(contact(GUIDE, stribeck(values))),
            "03" => strut.bristles = Some((first, values[1], 0.0)),
            "03b" => strut.loose_slider = Some((first, values[1], values[2])),
            "04" => strut.asymmetry = first,
            "05" => strut.knee = Some((values[1], first)),
            "06" => strut.orifice = first,
            "07" => strut.maxwell[0] = Some((first, values[1])),
            "08" => (strut.quadratic, strut.cubic) = (first, strut.cubic + values[1]),
            "09" => strut.stop = Some((values[1], first)),
            "10" => strut.fade = Some((first, values[1])),
            "12" => strut.bush = Some((first, 1.0 / values[1])),
            "13" => strut.bush = Some((0.0, 1.0 / first)),
            "14" => strut.linkage = first,
            "15" => self.car.guide_damping = first,
            "15c" => self.pneumatic.damping = first,
            "16" if self.plant == Plant::LinearDrive => {
                drive.contacts.push(contact(GUIDE, Limit::Coulomb(first)));
            }
            "16" if self.plant == Plant::PneumaticCylinder => {
                self.pneumatic.contacts.push(contact(GUIDE, Limit::Coulomb(first)));
            }
            "16" => self.car.contacts.push(contact(GUIDE, Limit::Coulomb(first))),
            "16m" => drive.contacts.push(contact(GUIDE, Limit::Coulomb(first))),
            "17" => self.car.contacts.push(contact(WHEEL_GUIDE, Limit::Coulomb(first))),
            "18" => {
                self.car.frame = Some(Frame { mass: first, frequency: values[1], damping_ratio: values[2] });
            }
            "19" => self.car.tire_quadratic = first,
            "19p" => self.sas.tire_quadratic = first,
            // The tyre never pulls; whether it leaves the road is a matter of the excitation.
            "20" => {}
            "21" => self.car.tire_damping += first,
            "22" => self.car.enveloping = first,
            "23" => actuator.delay = first,
            "24" => actuator.lag = first,
            "25" => actuator.gain = first,
            "26" | "26v" => actuator.limit = first,
            "26s" => actuator.slew = 1.0 / first,
            "27" => drive.cogging = Some((first, values[1], values[2])),
            "28" | "28h" | "29" | "30" => put_in_valve(self.car.servo.as_mut(), entry.id, first),
            "28c" => self.pneumatic.overlap = first,
            "29c" => self.pneumatic.conductance = first,
            "30c" => self.pneumatic.leakage = first,
            "30p" => self.pump.leakage = first,
            "32a" => self.pump.charge = first,
            "32b" => self.pump.valves[1].drop.iter_mut().for_each(|drop| *drop *= first),
            "32c" => self.pump.contacts.push(contact(GUIDE, Limit::Coulomb(first))),
            "32" | "32h" => strut.yielding = Some((first, values[1], values[2])),
            "33g" => drive.constant_load = first,
            "U1" => strut.hump = Some(hump(values)),
            "U2" => strut.thick_spot = Some(hump(values)),
            "U3" => self.car.contacts.push(contact(STRUT, Limit::Growing(first))),
            "U4" => {
                let limit = Limit::Periodic { force: first, period: values[1] };
                self.car.contacts.push(contact(WHEEL_GUIDE, limit));
            }
            "U7" => self.car.inertance = first,
            "U8" => strut.memory = (first > 0.0).then(|| memory(first, values[1])),
            // As a mode of the frame, but slower.
            "U9" | "U9m" => {
                let frame = Frame { mass: first, frequency: values[1], damping_ratio: values[2] };
                *(if entry.id == "U9" { &mut self.car.frame } else { &mut drive.absorber }) = Some(frame);
            }
            "U10" => self.timed.dropout_rate = first,
            "U11" => self.timed.uneven_tire = (first, values[1]),
            "U12" => strut.bypass = Some(Bypass { zone: hump(values), velocity: values[3] }),
            "08n" => drive.spring[1] = first,
            "U14" => self.timed.imbalance = (first, values[1]),
            "U15" => self.car.crosstalk = Some(Crosstalk { gain: first, delay: values[1] }),
            _ => return self.put_in_sensor(entry, values, signal),
        }
        Ok(())
    }

    fn put_in_sensor(&mut self, entry: &Entry, values: &[f64], signal: &str) -> Result<(), String> {
        if ["41", "41h"].contains(&entry.id) && signal != "wheel.force" {
            return Err(format!(
                "effect {} sits in the sensor of wheel.force, and not in that of `{signal}`",
                entry.id
            ));
        }
        let known: Vec<String> = self.sensors.keys().cloned().collect();
        let sensor = self.sensors.get_mut(signal).ok_or_else(|| {
            format!(
                "effect {} sits in a sensor, `{signal}` is none; there are {}",
                entry.id,
                known.join(", ")
            )
        })?;
        if entry.id == "U13" {
            if !signal.ends_with("acceleration") {
                return Err(format!(
                    "effect U13 sits in an accelerometer, and not in the sensor of `{signal}`"
                ));
            }
            let [gap, friction, frequency, damping_ratio] = [0, 1, 2, 3].map(|number| values[number]);
            sensor.rattle = Some(Rattle { gap, friction, frequency, damping_ratio });
            return Ok(());
        }
        for (drawn, value) in entry.parameters.iter().zip(values) {
            match drawn.name {
                "offset" => sensor.offset = *value,
                "drift" => sensor.drift = *value,
                "gain" => sensor.gain = *value,
                "lag" => sensor.lag = *value,
                "skew" => sensor.skew += value,
                "quantum" => sensor.quantum = *value,
                "frequency" => sensor.resonance = Some((*value, values[1])),
                "damping_ratio" => {}
                "high_pass" => sensor.high_pass = *value,
                "range" => sensor.range = *value,
                "rate" => sensor.rate_error = *value,
                "alias" => sensor.folded.0 = *value,
                "alias_frequency" => sensor.folded.1 = *value,
                "force_cell.mass" => sensor.moved_mass = *value,
                "force_cell.hysteresis" => sensor.hysteresis = *value,
                _ => sensor.dropout = *value,
            }
        }
        Ok(())
    }
}

fn put_in_valve(servo: Option<&mut Servo>, id: &str, value: f64) {
    let Some(servo) = servo else { return };
    match id {
        "28" => servo.overlap = value,
        "28h" => servo.hysteresis = value,
        "29" => servo.gain = value,
        _ => servo.leakage = value,
    }
}
