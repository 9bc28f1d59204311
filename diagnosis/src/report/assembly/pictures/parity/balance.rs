//! The balances themselves: what is in each, what it needs, what it means.

use crate::dataset::recorded::Dataset;
use crate::report::findings::Parity;
use crate::signal::spectral::in_band;

use super::laws::Laws;
use super::stretch::{Rigged, Sensor, Stretch};

/// Time at the ends of a stretch that is not judged, in seconds: filters have half of their signal only there, and
/// memories begin at rest.
pub(super) const EDGE: f64 = 0.5;

/// One balance.
pub(super) struct Balance {
    id: &'static str,
    name: &'static str,
    equation: &'static str,
    meaning: &'static str,
    needs: &'static [Sensor],
    unit: &'static str,
    /// What is left of it; none if the model has no such law.
    left: fn(&Laws, &Stretch) -> Option<Vec<f64>>,
}

/// All of them.
pub(super) const BALANCES: &[Balance] = &[
    Balance {
        id: "r1",
        name: "forces on the body",
        equation: "m_s a_s + F_strut + F_guide - F_act",
        meaning: "the strut or the body’s guide has a law that the model lacks, or one of these sensors is wrong",
        needs: &[Sensor::BodyAcceleration, Sensor::Deflection, Sensor::ActuatorForce],
        unit: "N",
        left: |laws, it| {
            let strut = laws.strut(&it.moved(Sensor::Deflection, -1.0)?);
            Some(it.sum(&[
                (laws.sprung_mass, it.signal(Sensor::BodyAcceleration)?),
                (1.0, &strut),
                (1.0, &laws.on_body(&it.body_velocity)),
                (-1.0, it.signal(Sensor::ActuatorForce)?),
            ]))
        },
    },
    Balance {
        id: "r2",
        name: "momentum of body and wheel",
        equation: "m_s a_s + m_u a_u + F_guide + F_wheel_guide - F_tire",
        meaning: "a guide rubs, or the tyre’s force cell, an accelerometer or a mass is wrong: whatever acts between body and wheel cancels",
        needs: &[Sensor::BodyAcceleration, Sensor::WheelAcceleration, Sensor::TireForce],
        unit: "N",
        left: |laws, it| {
            Some(it.sum(&[
                (laws.sprung_mass, it.signal(Sensor::BodyAcceleration)?),
                (laws.unsprung_mass, it.signal(Sensor::WheelAcceleration)?),
                (1.0, &laws.on_body(&it.body_velocity)),
                (1.0, &laws.on_wheel(&it.wheel_velocity)),
                (-1.0, it.signal(Sensor::TireForce)?),
            ]))
        },
    },
    Balance {
        id: "r3",
        name: "force of the tyre",
        equation: "F_tire - F_tire(z_r - z_u)",
        meaning: "the tyre has a law that the model lacks, or the sensor of its force or of its deflection is wrong",
        needs: &[Sensor::TireForce, Sensor::Compression],
        unit: "N",
        left: |laws, it| {
            let tire = laws.tire(&it.moved(Sensor::Compression, 1.0)?);
            Some(it.sum(&[(1.0, it.signal(Sensor::TireForce)?), (-1.0, &tire)]))
        },
    },
    Balance {
        id: "r4",
        name: "kinematics",
        equation: "a_s - a_u - x''",
        meaning: "a sensor is wrong, not the plant: there is no law in it",
        needs: &[Sensor::BodyAcceleration, Sensor::WheelAcceleration, Sensor::Deflection],
        unit: "m/s2",
        left: |_, it| {
            Some(it.sum(&[
                (1.0, it.signal(Sensor::BodyAcceleration)?),
                (-1.0, it.signal(Sensor::WheelAcceleration)?),
                (-1.0, &it.bend(Sensor::Deflection)?),
            ]))
        },
    },
    Balance {
        id: "r5",
        name: "force of the actuator",
        equation: "F_act - A p",
        meaning: "the piston rubs, its area is another one, or the sensor of force or pressure is wrong",
        needs: &[Sensor::ActuatorForce, Sensor::Pressure],
        unit: "N",
        left: |laws, it| {
            let made = laws.actuator(it.signal(Sensor::Pressure)?)?;
            Some(it.sum(&[(1.0, it.signal(Sensor::ActuatorForce)?), (-1.0, &made)]))
        },
    },
];

impl Balance {
    /// What is known of it without numbers.
    pub fn unformed(&self, band: f64, rigged: Rigged<'_>) -> Parity {
        let missing: Vec<&str> =
            self.needs.iter().filter(|it| !rigged.has(**it)).map(|it| it.words()).collect();
        let needs = if self.needs.iter().any(|it| !it.is_of(rigged.plant)) {
            Some("an actuator in the model; here its force comes from outside".to_owned())
        } else {
            (!missing.is_empty()).then(|| missing.join(", "))
        };
        Parity {
            id: self.id.into(),
            name: self.name.into(),
            equation: self.equation.into(),
            meaning: self.meaning.into(),
            needs,
            unit: self.unit.into(),
            band,
            rms_before: f64::NAN,
            rms_fitted: f64::NAN,
            rms_after: f64::NAN,
            noise: f64::NAN,
            time: Vec::new(),
            before: Vec::new(),
            after: Vec::new(),
        }
    }

    /// What is left of it over a record; not a number between sections.
    pub fn over(&self, record: &Dataset, laws: &Laws, stretches: &[Stretch]) -> Option<Vec<f64>> {
        let mut whole = vec![f64::NAN; record.len()];
        for (section, stretch) in record.sections.iter().zip(stretches) {
            whole[section.clone()].copy_from_slice(&self.of(laws, stretch)?);
        }
        Some(whole)
    }

    /// What is left of it over a stretch, in the band; not a number near the ends and where a sample is missing.
    fn of(&self, laws: &Laws, stretch: &Stretch) -> Option<Vec<f64>> {
        let left = in_band(&(self.left)(laws, stretch)?, stretch.step, stretch.band, 0);
        let edge = (EDGE / stretch.step) as usize;
        let inside = edge..left.len().saturating_sub(edge);
        let known = left.iter().zip(&stretch.known).enumerate();
        Some(
            known
                .map(|(k, (it, known))| if *known && inside.contains(&k) { *it } else { f64::NAN })
                .collect(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::recorded::{Measured, Source};
    use crate::diagnosis::root_mean_square;
    use crate::estimation::unknowns::Estimate;
    use crate::plant::Drive;
    use crate::rig::Rig;
    use crate::signal::derivative;

    const STEP: f64 = 1e-3;
    const MEASURED: [&str; 5] = [
        "body.acceleration",
        "wheel.acceleration",
        "wheel.force",
        "suspension.deflection",
        "tire.deflection",
    ];

    /// A record of the rig with a hidden parameter.
    fn record(rig: &Rig, hidden: Option<(&str, f64)>) -> Dataset {
        let mut parameters = rig.parameters.clone();
        if let Some((name, value)) = hidden {
            parameters[rig.plant.parameter(name).unwrap()] = value;
        }
        let wave = |size: f64, lines: [f64; 3]| -> Vec<f64> {
            let at =
                |t: f64| lines.iter().map(|f| (f * t + f).sin()).sum::<f64>() * size * (t / 0.5).min(1.0);
            (0..6000).map(|k| at(f64::from(k) * STEP)).collect()
        };
        let (road, force) = (wave(2e-3, [9.0, 31.0, 53.0]), wave(40.0, [5.0, 17.0, 43.0]));
        let inputs = vec![road.clone(), derivative(&road, STEP), force.clone()];
        let drive = Drive::sampled(STEP, inputs);
        let outputs = rig.plant.prepare(&rig.choices).unwrap().outputs(&parameters, &rig.start, &drive);
        let measured = MEASURED.map(|name| {
            let output = rig.plant.output(name).unwrap();
            Measured { output, values: outputs[output].clone(), noise_floor: 1e-9 }
        });
        Dataset {
            step: STEP,
            inputs: vec![Source::Measured(road), Source::DerivativeOf(0), Source::Measured(force)],
            measured: measured.into(),
            sections: vec![0..3000, 3000..6000],
            ..Dataset::default()
        }
    }

    fn point(rig: &Rig) -> Estimate {
        Estimate::undistorted(&rig.plant, &rig.parameters)
    }

    /// What is left of r1 to r4, with the rig's own laws.
    fn left(rig: &Rig, record: &Dataset) -> [f64; 4] {
        let (laws, point) = (Laws::of(rig, &rig.choices, &rig.parameters).unwrap(), point(rig));
        let rigged = Rigged { plant: &rig.plant, record, point: &point, noisy: false };
        let rest = vec![vec![0.0; record.len()]; rig.plant.outputs.len()];
        let stretches: Vec<Stretch> =
            record.sections.iter().map(|section| rigged.stretch(section, 30.0, &rest)).collect();
        std::array::from_fn(|index| {
            root_mean_square(&BALANCES[index].over(record, &laws, &stretches).unwrap())
        })
    }

    /// Each fault breaks the balances that it is in, and no other.
    #[test]
    fn a_balance_breaks_by_what_is_in_it_alone() {
        let rig = Rig::published("tum-linear-measured-quarter-car").unwrap();
        let with = |change: &dyn Fn(&mut Dataset)| {
            let mut record = record(&rig, None);
            change(&mut record);
            left(&rig, &record)
        };
        // Newtons thrice, then metres per second squared.
        let tight = [1.0, 1.0, 1.0, 0.01];
        let offset = |record: &mut Dataset| record.measured[0].values.iter_mut().for_each(|it| *it += 0.5);
        let wheel = |record: &mut Dataset| record.measured[1].values.iter_mut().for_each(|it| *it *= 1.1);
        let force = |record: &mut Dataset| record.measured[2].values.iter_mut().for_each(|it| *it *= 1.1);
        let travel = |record: &mut Dataset| record.measured[3].values.iter_mut().for_each(|it| *it *= 1.1);
        for (what, found, broken) in [
            ("nothing", with(&|_| ()), ""),
            ("friction", left(&rig, &record(&rig, Some(("strut.coulomb.force", 40.0)))), "r1"),
            ("guide", left(&rig, &record(&rig, Some(("guide.coulomb.force", 40.0)))), "r1 r2"),
            ("tyre", left(&rig, &record(&rig, Some(("tire.quadratic", 4e6)))), "r3"),
            ("body's accelerometer", with(&offset), "r1 r2 r4"),
            ("wheel's accelerometer", with(&wheel), "r2 r4"),
            ("force cell", with(&force), "r2 r3"),
            ("deflection", with(&travel), "r1 r4"),
        ] {
            let names = BALANCES.iter().zip(found.iter().zip(tight)).filter(|(_, (rms, tight))| *rms > tight);
            let names: Vec<&str> = names.map(|(balance, _)| balance.id).collect();
            assert_eq!(names.join(" "), broken, "{what}: {found:?}");
        }
    }

    #[test]
    fn a_stretch_shorter_than_its_edges_tells_nothing() {
        let rig = Rig::published("tum-linear-measured-quarter-car").unwrap();
        let (laws, point) = (Laws::of(&rig, &rig.choices, &rig.parameters).unwrap(), point(&rig));
        let record = record(&rig, None);
        let rigged = Rigged { plant: &rig.plant, record: &record, point: &point, noisy: false };
        let rest = vec![vec![0.0; record.len()]; rig.plant.outputs.len()];
        for (samples, known) in [(1, 0), (900, 0), (1000, 0), (1100, 100)] {
            let left = BALANCES[0].of(&laws, &rigged.stretch(&(0..samples), 30.0, &rest)).unwrap();
            assert_eq!(left.iter().filter(|it| it.is_finite()).count(), known, "{samples}");
        }
    }

    #[test]
    fn what_was_not_measured_is_told() {
        let rig = Rig::published("tum-linear-measured-quarter-car").unwrap();
        let mut record = record(&rig, None);
        record.measured.retain(|it| rig.plant.outputs[it.output].name != "wheel.acceleration");
        let point = point(&rig);
        let rigged = Rigged { plant: &rig.plant, record: &record, point: &point, noisy: false };
        let needs: Vec<Option<String>> =
            BALANCES.iter().map(|balance| balance.unformed(30.0, rigged).needs).collect();
        let wheel = Some("the wheel’s acceleration".to_owned());
        assert_eq!((&needs[0], &needs[2]), (&None, &None));
        assert_eq!((&needs[1], &needs[3]), (&wheel, &wheel));
        assert!(needs[4].as_ref().is_some_and(|it| it.contains("comes from outside")));
    }

    /// White noise of the deflection alone, up to a frequency f: σ (2π)² √(f⁵ step 2/5) of its second derivative.
    #[test]
    fn noise_is_what_the_sensors_make_of_it() {
        let rig = Rig::published("tum-linear-measured-quarter-car").unwrap();
        let mut record = record(&rig, None);
        record.measured[3].noise_floor = 1e-5;
        let (laws, point) = (Laws::of(&rig, &rig.choices, &rig.parameters).unwrap(), point(&rig));
        let rest = vec![vec![0.0; record.len()]; rig.plant.outputs.len()];
        let of = |noisy| {
            let rigged = Rigged { plant: &rig.plant, record: &record, point: &point, noisy };
            BALANCES[3].of(&laws, &rigged.stretch(&(0..6000), 30.0, &rest)).unwrap()
        };
        let noise: Vec<f64> = of(true).iter().zip(of(false)).map(|(noisy, clean)| noisy - clean).collect();
        let expected = 1e-5 * 4.0 * std::f64::consts::PI.powi(2) * (30.0_f64.powi(5) * STEP * 0.4).sqrt();
        assert!(
            (root_mean_square(&noise) / expected - 1.0).abs() < 0.15,
            "{} {expected}",
            root_mean_square(&noise)
        );
    }
}
