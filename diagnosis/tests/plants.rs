//! Every plant on records of a virtual rig of its own: what is hidden is found, what is not there is not claimed.

use std::fs;

use strut_diagnosis::app::virtual_rig::{self, Experiment};
use strut_diagnosis::catalogue::naming::{handle, name};
use strut_diagnosis::data::Origin;
use strut_diagnosis::data::map::Map;
use strut_diagnosis::dataset::load::{Loaded, load};
use strut_diagnosis::dataset::split::Split;
use strut_diagnosis::diagnosis::{Options, diagnose};
use strut_diagnosis::estimation::unknowns::Unknown;
use strut_diagnosis::rig::Rig;

/// A plant whose record is made, read and diagnosed.
struct Case {
    rig: &'static str,
    /// Whether a model's start values are what is known of it: the gains of a drive's loops.
    stated: bool,
    /// Setting of how it is driven.
    drive: Option<&'static str>,
    /// Columns that are kept, with the names that they get; none: all, as they are.
    columns: &'static [(&'static str, &'static str)],
    /// Noise over the root mean square of each signal.
    noise: f64,
    /// Time between two samples in seconds.
    step: f64,
    /// Length of the records in seconds.
    length: f64,
    /// Which draw of the noise.
    seed: u64,
}

/// What a diagnosis says: numbers and places, the extended model's parameters, and what was fitted beside it.
struct Said {
    terms: Vec<String>,
    values: Vec<(String, f64)>,
    /// Half the 95 % interval of what was fitted.
    halves: Vec<(String, f64)>,
}

impl Said {
    fn value(&self, name: &str) -> f64 {
        self.values.iter().find(|(other, _)| other == name).unwrap().1
    }

    /// Whether a parameter's interval holds what was hidden, and is no wider than a share of it.
    fn covers(&self, name: &str, hidden: f64, share: f64) {
        let (found, half) = (self.value(name), self.half(name));
        assert!((found - hidden).abs() <= half, "{name} is {found} ± {half}, {hidden} was hidden");
        assert!(half < share * hidden, "{name} is {found} ± {half}");
    }

    /// The error of a parameter in its standard deviations.
    fn deviations(&self, name: &str, hidden: f64) -> f64 {
        1.96 * (self.value(name) - hidden) / self.half(name)
    }

    fn half(&self, name: &str) -> f64 {
        self.halves.iter().find(|(of, _)| of == name).unwrap().1
    }

    /// Whether a parameter is within a share of what was hidden.
    fn meets(&self, name: &str, hidden: f64, share: f64) {
        let found = self.value(name);
        assert!((found / hidden - 1.0).abs() < share, "{name} is {found}, {hidden} was hidden");
    }
}

impl Case {
    fn of(rig: &'static str) -> Self {
        Self {
            rig,
            stated: false,
            drive: None,
            columns: &[],
            noise: 0.005,
            step: 2.5e-3,
            length: 7.0,
            seed: 3,
        }
    }

    fn diagnosed(&self, hidden: &[(&str, f64)]) -> Said {
        let mut rig = Rig::published(self.rig).unwrap();
        if let Some(input) = self.drive {
            let way = rig.ways(|name| name == input).swap_remove(0);
            rig.drive_by(&way, |name| name == input).unwrap();
        }
        let hidden = hidden.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        let experiment = Experiment {
            hidden,
            amplitude: 1.0,
            noise: self.noise,
            seed: self.seed,
            step: self.step,
            length: self.length,
        };
        let folder = tempfile::tempdir().unwrap();
        let paths = ["train.csv", "test.csv"].map(|file| folder.path().join(file));
        for (path, number) in paths.iter().zip(1..) {
            let text = virtual_rig::record(&rig, &experiment, number).unwrap();
            fs::write(path, self.kept(&text)).unwrap();
        }
        let mut rig = Rig::published(self.rig).unwrap();
        if self.stated {
            rig.stated.fill(true);
        }
        let origins = paths.map(Origin::File);
        let [train, test] = &origins;
        let Loaded { mut records, problems, .. } = load(&mut rig, &[train, test], &Map::default()).unwrap();
        assert_eq!(records.len(), 2, "{problems:?}");
        let test = records.split_off(1);
        let records = Split::new(&records, test);
        let diagnosis = diagnose(&rig, &records, Options::default(), &|_| {}).unwrap();
        // Effects are compared with a fit within the bounds that their fits have.
        assert_eq!(diagnosis.found.base.coordinates, diagnosis.baseline.coordinates(&[]));
        let terms = diagnosis.found.accepted.iter().map(|it| name(it.term, &rig.plant).short()).collect();
        let named = |of: Unknown| handle(of, &rig.plant).0;
        let (extended, intervals) = (&diagnosis.found.extended, &diagnosis.intervals);
        let parameters = (0..rig.plant.parameters.len()).map(Unknown::Parameter);
        let all = parameters.chain(extended.coordinates.iter().map(|it| it.handle));
        Said {
            terms,
            values: all.map(|of| (named(of), extended.point.get(of))).collect(),
            halves: intervals.iter().map(|it| (named(it.handle), it.half)).collect(),
        }
    }

    /// A record with the columns that are kept.
    fn kept(&self, text: &str) -> String {
        if self.columns.is_empty() {
            return text.to_owned();
        }
        let header: Vec<&str> = text.lines().next().unwrap().split(',').collect();
        let column =
            |name: &str| header.iter().position(|title| title.split(" [").next() == Some(name)).unwrap();
        let kept: Vec<usize> =
            std::iter::once(0).chain(self.columns.iter().map(|(of, _)| column(of))).collect();
        let mut lines = text.lines();
        lines.next();
        let mut result = String::from("time [s]");
        for (_, title) in self.columns {
            result.push_str(&format!(",{title}"));
        }
        for line in lines {
            let cells: Vec<&str> = line.split(',').collect();
            let cells: Vec<&str> = kept.iter().map(|index| cells[*index]).collect();
            result.push('\n');
            result.push_str(&cells.join(","));
        }
        result
    }
}

const NOTHING: [String; 0] = [];

const SERVO: &str = "konieczny-servo-suspension";
const PUMP: &str = "ajala-soft-pump-hydraulic-actuator";
const SAS: &str = "kogut-sas-rig";
const DRIVE: &str = "linear-drive";
const MOTOR: &str = "excitation-motor";

#[test]
fn nothing_is_claimed_of_a_sound_servo_suspension() {
    assert_eq!(Case::of(SERVO).diagnosed(&[]).terms, NOTHING);
}

#[test]
#[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
fn a_servo_suspensions_leakage_and_valve_gain_are_parameters_that_do_not_fit() {
    let (leakage, valve_gain) = (("actuator.cylinder.leakage", 45e-12), ("actuator.spool.gain", 0.029e-3));
    let said = Case::of(SERVO).diagnosed(&[leakage, valve_gain]);
    assert_eq!(said.terms, NOTHING);
    said.meets(leakage.0, leakage.1, 0.03);
    said.meets(valve_gain.0, valve_gain.1, 0.03);
}

#[test]
#[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
fn guide_friction_is_found_in_a_servo_suspension() {
    let said = Case::of(SERVO).diagnosed(&[("guide.coulomb.force", 40.0)]);
    assert_eq!(said.terms, ["16 guide"]);
    // The loops make up for most of the friction: what is left of it hides in the noise by some per cent.
    said.covers("guide.coulomb.force", 40.0, 0.15);
}

#[test]
#[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
fn nothing_is_claimed_of_a_sound_pump_actuator() {
    assert_eq!(Case::of(PUMP).diagnosed(&[]).terms, NOTHING);
}

#[test]
#[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
fn a_pump_actuators_gas_and_pump_are_parameters_that_do_not_fit() {
    let said = Case::of(PUMP).diagnosed(&[("gas.charge_pressure", 2.2e6), ("pump.displacement", 13.5e-6)]);
    assert_eq!(said.terms, NOTHING);
    said.meets("gas.charge_pressure", 2.2e6, 0.03);
    said.meets("pump.displacement", 13.5e-6, 0.03);
}

#[test]
#[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
fn leakage_is_found_in_a_pump_actuator() {
    // Within the sensors' accuracy from sample to sample: it is the volume that it makes in time that shows.
    let said = Case { length: 20.0, ..Case::of(PUMP) }.diagnosed(&[("pump.leakage", 5e-11)]);
    assert_eq!(said.terms, ["30 pump"]);
    said.covers("pump.leakage", 5e-11, 0.15);
}

#[test]
fn friction_is_found_in_a_pump_actuator() {
    let said = Case::of(PUMP).diagnosed(&[("pump.coulomb.torque", 0.2)]);
    assert_eq!(said.terms, ["32c pump"]);
    said.covers("pump.coulomb.torque", 0.2, 0.15);
}

#[test]
#[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
fn nothing_is_claimed_of_a_sound_sas_rig() {
    assert_eq!(Case { noise: 0.001, ..Case::of(SAS) }.diagnosed(&[]).terms, NOTHING);
}

#[test]
fn pivot_friction_is_found_in_a_sas_rig() {
    let said =
        Case { noise: 0.001, length: 4.0, ..Case::of(SAS) }.diagnosed(&[("pivot.coulomb.torque", 0.4)]);
    assert_eq!(said.terms, ["01 pivot"]);
    said.meets("pivot.coulomb.torque", 0.4, 0.03);
}

#[test]
fn a_damper_alone_has_no_spring() {
    let hidden = [("strut.stiffness", 200.0), ("strut.damping", 700.0), ("strut.coulomb.force", 20.0)];
    let mut squares = 0.0;
    for seed in 1..4 {
        let said = Case { seed, ..Case::of("element-dyno") }.diagnosed(&hidden);
        assert_eq!(said.terms, ["01 strut"]);
        said.meets("strut.coulomb.force", 20.0, 0.02);
        squares += said.deviations("strut.coulomb.force", 20.0).powi(2);
        // Of 22 kN/m, which its model has.
        assert!((said.value("strut.stiffness") - 200.0).abs() < 50.0, "{}", said.value("strut.stiffness"));
    }
    // Three draws whose errors were larger together would come up once in a hundred (χ²).
    assert!(squares < 11.3, "{squares}");
}

/// Of a thousand samples a second, four hundred are compared. Friction is sharper than these show; in a filtered motion it was 20.2 N.
#[test]
fn friction_that_is_sharper_than_the_samples_compared_is_exact() {
    let hidden = [("strut.stiffness", 200.0), ("strut.damping", 700.0), ("strut.coulomb.force", 20.0)];
    let case = Case { step: 1e-3, length: 10.0, noise: 0.002, ..Case::of("element-dyno") };
    let said = case.diagnosed(&hidden);
    assert_eq!(said.terms, ["01 strut"]);
    said.meets("strut.coulomb.force", 20.0, 2e-3);
    said.covers("strut.coulomb.force", 20.0, 5e-3);
}

/// A damper's preload takes what a cell shows at rest, and nothing takes what it shows more and more of.
#[test]
fn a_cell_that_drifts_is_found_though_its_offset_is_a_preload_s() {
    let said = Case::of("element-dyno").diagnosed(&[("force.drift", 15.0)]);
    assert_eq!(said.terms, ["33 force"]);
    said.covers("force.drift", 15.0, 0.1);
}

/// The records reach the compression stop only. Records of longer rebound must not meet a stop that nobody has seen.
#[test]
fn a_stop_that_is_not_reached_stays_out_of_reach() {
    let hidden = [
        ("strut.stop.stiffness", 2e5),
        ("strut.stop.compression_clearance", 0.006),
        ("strut.stop.rebound_clearance", 0.2),
    ];
    let said = Case::of("element-dyno").diagnosed(&hidden);
    assert_eq!(said.terms, ["09 strut"]);
    said.meets("strut.stop.compression_clearance", 0.006, 0.05);
    assert!(said.value("strut.stop.rebound_clearance") > 0.05, "{:?}", said.values);
}

/// In records of several stretches, each of which has the record's time.
#[test]
#[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
fn a_damper_that_fades_is_found_in_a_long_record() {
    let case = Case { step: 4e-3, length: 24.0, ..Case::of("quarter-car") };
    let said = case.diagnosed(&[("strut.fade.ratio", 0.25), ("strut.fade.time", 8.0)]);
    assert_eq!(said.terms, ["10 strut"]);
    said.covers("strut.fade.ratio", 0.25, 0.15);
}

#[test]
#[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
fn nothing_is_claimed_of_a_sound_drive() {
    assert_eq!(Case { step: 4e-3, ..Case::of(MOTOR) }.diagnosed(&[]).terms, NOTHING);
}

/// The model's start value is 20 kg, and says nothing of this one.
#[test]
fn a_mass_that_nobody_states_may_be_of_any_order() {
    for mass in [0.5, 900.0] {
        let hidden = [("moving_mass", mass), ("guide.damping", 50.0), ("guide.coulomb.force", 8.0)];
        let said = Case::of(DRIVE).diagnosed(&hidden);
        assert_eq!(said.terms, ["16 guide"], "{mass} kg");
        said.meets("moving_mass", mass, 0.02);
        said.meets("guide.coulomb.force", 8.0, 0.05);
    }
}

#[test]
#[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
fn friction_is_found_in_a_drive_from_force_and_position_alone() {
    let columns = &[("command.force", "force [N]"), ("position", "position [m]")];
    let case = Case { drive: Some("command.force"), columns, step: 4e-3, ..Case::of(MOTOR) };
    let said = case.diagnosed(&[("guide.coulomb.force", 20.0)]);
    assert_eq!(said.terms, ["16 guide"]);
    said.meets("guide.coulomb.force", 20.0, 0.05);
}

#[test]
#[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
fn friction_is_found_in_a_drive_from_voltage_current_and_position() {
    let columns = &[("command.voltage", "u [V]"), ("current", "i [A]"), ("position", "x [m]")];
    let case = Case { drive: Some("command.voltage"), columns, step: 4e-3, ..Case::of(MOTOR) };
    let said = case.diagnosed(&[("guide.coulomb.force", 30.0)]);
    assert_eq!(said.terms, ["16 guide"]);
    said.meets("guide.coulomb.force", 30.0, 0.05);
}

/// An amplifier that gives 0.7 A at most, and a tiny bit more for a moment: 65 N.
#[test]
#[ignore = "a further diagnosis: `scripts/long-tests diagnosis`"]
fn a_limit_of_the_current_is_found_in_a_drive_from_its_force() {
    let columns = &[("command.force", "force [N]"), ("position", "position [m]")];
    let case = Case { drive: Some("command.force"), columns, ..Case::of(MOTOR) };
    let said = case.diagnosed(&[("continuous_current", 0.7), ("peak_current", 0.701)]);
    assert_eq!(said.terms, ["26 command.force"]);
    said.meets("command.force.limit", 0.7 * 93.0, 0.01);
}
