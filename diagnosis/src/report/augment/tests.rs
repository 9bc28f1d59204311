//! The system that is made of what was found.

use strut_check::import::Unit;
use toml::Table;

use super::material::{Material, Value};
use super::system::{System, system};
use super::{obstacle, starts};
use crate::plant::{Attachment, Conversion, Face, FaceVariable, Replaced, Role};
use crate::signal::distortion::{Correction, Fault};

/// A mass on a spring of another maker: position in mm, force in kN, velocity as a local variable.
fn face() -> Face {
    let unit = |symbol: &str, base: &[(&'static str, i32)], factor: f64| Unit {
        symbol: symbol.into(),
        base: Some(base.to_vec()),
        factor,
        offset: 0.0,
    };
    let variable = |name: &str, causality: &str, unit: Option<Unit>| FaceVariable {
        name: name.into(),
        kind: "Real".into(),
        causality: causality.into(),
        settable: causality != "output",
        start: None,
        conversion: unit
            .as_ref()
            .map_or(Conversion::NONE, |it| Conversion { factor: it.factor, offset: 0.0 }),
        unit,
    };
    let variables = vec![
        variable("F", "input", Some(unit("kN", &[("kg", 1), ("m", 1), ("s", -2)], 1e3))),
        variable("gravity", "input", None),
        variable("z", "output", Some(unit("mm", &[("m", 1)], 1e-3))),
        variable("length", "local", None),
        variable("v", "local", None),
        variable("m", "parameter", Some(unit("kg", &[("kg", 1)], 1.0))),
        variable("k", "parameter", Some(unit("N/mm", &[("kg", 1), ("s", -2)], 1e3))),
        variable("d", "parameter", None),
    ];
    Face { is_of_fmi_2: true, co_simulates: true, variables }
}

fn attachment() -> Attachment {
    Attachment {
        role: Role::Strut,
        deflection: "length".into(),
        rest: 0.3,
        velocity: "v".into(),
        acts_on: vec![("F".into(), -1.0)],
        replaces: Some(Replaced { stiffness: "k".into(), damping: "d".into() }),
    }
}

/// Position in m; the length is 0.5 m less, and has a spring that is 0.3 m long; a velocity that follows no output.
const SIGNALS: [[f64; 4]; 3] = [[0.0, 0.01, 0.03, 0.02], [-0.5, -0.49, -0.47, -0.48], [0.1, 0.5, 0.2, -0.3]];
const DRIVE: [[f64; 4]; 2] = [[0.0, 500.0, 1000.0, -20.0], [9.81; 4]];

fn value(name: &'static str, value: f64, start: f64) -> Value<'static> {
    Value { name, value, start, unit: "N" }
}

/// What was found: the mass, the strut's rates, and these parameters of effects.
fn material<'a>(face: &'a Face, beside: &'a [Attachment], effects: &[Value<'static>]) -> Material<'a> {
    let rates = [value("strut.stiffness", 9000.0, 1e4), value("strut.damping", 12.0, 10.0)];
    Material {
        fmu: std::path::Path::new("/made by/others/Mass.fmu"),
        face,
        beside,
        stands_in: true,
        parameters: [value("m", 1.1, 1.0)].into_iter().chain(rates).chain(effects.iter().copied()).collect(),
        memory: vec![value("hysteresis.presliding.friction", 0.5, 0.0)],
        starts: vec![("z".into(), 0.004)],
        inputs: vec![("F", &DRIVE[0]), ("gravity", &DRIVE[1])],
        outputs: vec![("z", &SIGNALS[0]), ("length", &SIGNALS[1]), ("v", &SIGNALS[2])],
        sampling: 1e-3,
        measured: vec![("z", Correction::default())],
        step: 1e-4,
        record: "test.csv, 0 s to 0.003 s".into(),
    }
}

const FRICTION: Value<'static> = Value { name: "strut.coulomb.force", value: 8.0, start: 0.0, unit: "N" };
const ASYMMETRY: Value<'static> = Value { name: "strut.asymmetry.ratio", value: 0.4, start: 0.0, unit: "1" };
const LINKAGE: Value<'static> = Value { name: "strut.linkage.slope", value: 2.0, start: 0.0, unit: "1/m" };

/// A file of a system as a table.
fn table(system: &System, name: &str) -> Table {
    let file = system.files.iter().find(|(file, _)| file == name);
    file.unwrap_or_else(|| panic!("no {name}")).1.parse().unwrap()
}

/// Where a connection comes from, its factor, its offset and its operation, by where it goes.
fn connections(system: &System) -> Vec<(String, String, f64, f64, String)> {
    let text = |it: &toml::Value, key: &str| it.get(key).and_then(|it| it.as_str()).unwrap_or("").to_owned();
    let number =
        |it: &toml::Value, key: &str, none: f64| it.get(key).and_then(toml::Value::as_float).unwrap_or(none);
    let all = table(system, "augmented.toml");
    let one = |it: &toml::Value| {
        let (factor, offset) = (number(it, "factor", 1.0), number(it, "offset", 0.0));
        (text(it, "to"), text(it, "from"), factor, offset, text(it, "operation"))
    };
    all["connections"].as_array().unwrap().iter().map(one).collect()
}

/// The start value of a variable of the FMU, in its own unit.
fn given(system: &System, name: &str) -> Option<f64> {
    let all = table(system, "augmented.toml");
    all["parameters"].get(name).and_then(|it| it["value"].as_float())
}

#[test]
fn the_strut_has_the_effect_and_the_fmu_the_rest() {
    let (face, at) = (face(), attachment());
    let system = system(&material(&face, std::slice::from_ref(&at), &[FRICTION])).unwrap();
    let set = table(&system, "strut.toml");
    let values = |name: &str| set["values"].get(name).map(|it| it["value"].as_float().unwrap());
    assert_eq!(set["model"].as_str(), Some("ElementDyno"));
    let expected = [Some(0.0), Some(0.0), Some(8.0), Some(0.5)];
    let names = ["strut.stiffness", "strut.damping", "strut.coulomb.force", "hysteresis.presliding.friction"];
    assert_eq!(names.map(values), expected);
    // Its spring and damper stay in the FMU, in its units, with the values found.
    let own = ["model.m", "model.k", "model.d", "model.z", "model.gravity"].map(|name| given(&system, name));
    assert_eq!(own, [1.1, 9.0, 12.0, 4.0, 9.81].map(Some));
    assert_eq!(
        system.notes,
        ["v is no output of the FMU: the velocity of the strut is the rate of change of z"]
    );
}

#[test]
fn a_guide_and_a_tyre_are_benches_too_and_stand_there_only_with_an_effect() {
    let face = face();
    let at = |role: Role| Attachment { role, replaces: None, ..attachment() };
    let (all, found) = ([Role::Strut, Role::Guide, Role::Tire].map(at), |name, value| Value {
        name,
        value,
        start: 0.0,
        unit: "N",
    });
    let effects = [
        found("ground_spring.stiffness", 40.0),
        found("guide.coulomb.force", 8.0),
        found("tire.quadratic", 4e6),
    ];
    let system = system(&Material { memory: Vec::new(), ..material(&face, &all, &effects) }).unwrap();
    let values = |name: &str| {
        let set = table(&system, &format!("{name}.toml"));
        set["values"]
            .as_table()
            .unwrap()
            .iter()
            .map(|(name, it)| (name.clone(), it["value"].to_string()))
            .collect::<Vec<_>>()
    };
    let expected = [("strut.stiffness", "40.0"), ("strut.damping", "0.0"), ("strut.coulomb.force", "8.0")];
    assert_eq!(values("guide"), expected.map(|(name, value)| (name.to_owned(), value.to_owned())));
    let expected = [
        ("element", "\"Tire\""),
        ("tire.lift_off", "false"),
        ("tire.stiffness", "0.0"),
        ("tire.damping", "0.0"),
        ("tire.quadratic", "4000000.0"),
    ];
    assert_eq!(values("tire"), expected.map(|(name, value)| (name.to_owned(), value.to_owned())));
    assert!(system.files.iter().all(|(name, _)| name != "strut.toml"));
    let forces = connections(&system).into_iter().filter(|it| it.0 == "model.F").map(|it| it.1);
    assert_eq!(forces.collect::<Vec<_>>(), ["record_F.signal", "guide.force", "tire.force"]);
}

#[test]
fn an_effect_in_the_damper_takes_the_damper_along_and_a_linkage_the_spring_too() {
    let (face, at) = (face(), attachment());
    let rates = |effects: &[Value<'static>], stands_in: bool| {
        let material = Material { stands_in, ..material(&face, std::slice::from_ref(&at), effects) };
        let system = system(&material).unwrap();
        let strut = table(&system, "strut.toml");
        let of = |name: &str| strut["values"][name]["value"].as_float().unwrap();
        [
            of("strut.stiffness"),
            of("strut.damping"),
            given(&system, "model.k").unwrap(),
            given(&system, "model.d").unwrap(),
        ]
    };
    assert_eq!(rates(&[ASYMMETRY], true), [0.0, 12.0, 9.0, 0.0]);
    assert_eq!(rates(&[LINKAGE], true), [9000.0, 12.0, 0.0, 0.0]);
    // What does not do the same cannot stay.
    assert_eq!(rates(&[FRICTION], false), [9000.0, 12.0, 0.0, 0.0]);
}

#[test]
fn signs_units_and_zeros_are_those_of_the_bench_and_of_the_fmu() {
    let (face, at) = (face(), attachment());
    let system = system(&material(&face, std::slice::from_ref(&at), &[FRICTION])).unwrap();
    let all = connections(&system);
    let to = |name: &str| all.iter().filter(|it| it.0 == name).collect::<Vec<_>>();
    // The length is z in m less 0.5 m, of which 0.3 m are the spring's: at z = 20 mm it is drawn out by -0.78 m.
    let [position] = to("strut.motion.position")[..] else { panic!("{all:?}") };
    assert_eq!(position.1, "model.z");
    assert!((position.2 * 20.0 + position.3 - 0.78).abs() < 1e-12, "{position:?}");
    let [velocity] = to("strut.motion.velocity")[..] else { panic!("{all:?}") };
    assert_eq!((velocity.1.as_str(), velocity.4.as_str()), ("model.z", "derivative"));
    assert!((velocity.2 + 1e-3).abs() < 1e-15 && velocity.3 == 0.0, "{velocity:?}");
    // The bench's force is positive in compression, and the FMU's input takes the negative of what pulls the ends together.
    let [record, strut] = to("model.F")[..] else { panic!("{all:?}") };
    assert_eq!((record.1.as_str(), record.2), ("record_F.signal", 1.0));
    assert_eq!((strut.1.as_str(), strut.2), ("strut.force", 1e-3));
}

#[test]
fn the_record_is_in_the_unit_of_its_input_and_what_rests_is_a_value() {
    let face = face();
    let system = system(&material(&face, &[], &[])).unwrap();
    let (_, csv) = system.files.iter().find(|(name, _)| name == "record_F.csv").unwrap();
    assert_eq!(csv, "time [s], signal [kN]\n0,0\n0.001,0.5\n0.002,1\n0.003,-0.02\n");
    let set = table(&system, "record_F.toml");
    assert_eq!(set["units"]["signal"]["symbol"].as_str(), Some("kN"));
    assert_eq!(set["files"][0].as_str(), Some("record_F.csv"));
    let all = table(&system, "augmented.toml");
    assert_eq!(all["experiment"]["stop"].as_float(), Some(0.003));
    assert_eq!(all["outputs"].as_array().unwrap().len(), 1);
    // Nothing was found in a strut, and there is none.
    let names: Vec<&String> = all["components"].as_table().unwrap().keys().collect();
    assert_eq!(names, ["model", "record_F"]);
}

#[test]
fn a_sensor_that_is_wrong_is_a_component_in_the_output_s_unit() {
    let face = face();
    let mut correction = Correction::default();
    for (fault, amount) in [
        (Fault::Gain, 0.1),
        (Fault::Offset, 0.002),
        (Fault::Lag, 0.05),
        (Fault::Drift, 1e-3),
        (Fault::Delay, 1e-5),
    ] {
        correction.set(fault, amount);
    }
    let material =
        Material { measured: vec![("z", correction), ("v", correction)], ..material(&face, &[], &[]) };
    let system = system(&material).unwrap();
    let set = table(&system, "sensor_z.toml");
    let of = |name: &str| set["values"][name]["value"].as_float().unwrap();
    assert_eq!(set["values"]["operation"]["value"].as_str(), Some("Lag"));
    assert_eq!(["factor", "offset", "filter", "period"].map(of), [1.1, 2.0, 0.05, 1e-4]);
    assert_eq!(set["units"]["output"]["symbol"].as_str(), Some("mm"));
    let all = table(&system, "augmented.toml");
    assert_eq!(all["outputs"][0].as_str(), Some("sensor_z.output"));
    let told = [
        "the sensor of z is without its drift, which the report has",
        "v is no output of the FMU and cannot be looked at",
    ];
    assert_eq!(system.notes, told);
}

#[test]
fn a_local_variable_that_follows_an_output_is_looked_at_through_it() {
    let face = face();
    let measured = vec![("length", Correction::default())];
    let system = system(&Material { measured, ..material(&face, &[], &[]) }).unwrap();
    let set = table(&system, "sensor_length.toml");
    let of = |name: &str| set["values"][name]["value"].as_float().unwrap();
    // In mm, as the output is.
    assert!((of("factor") - 1.0).abs() < 1e-12 && (of("offset") + 500.0).abs() < 1e-9, "{set}");
    assert_eq!(system.notes, Vec::<String>::new());
}

#[test]
fn what_cannot_be_in_a_system_is_said() {
    let mut face = face();
    assert_eq!(obstacle(&face), None);
    face.co_simulates = false;
    assert!(obstacle(&face).unwrap().contains("model exchange only"));
    face.is_of_fmi_2 = false;
    assert!(obstacle(&face).unwrap().contains("not of FMI 2.0"));
    let mut face = self::face();
    let gear = FaceVariable { kind: "Enumeration".into(), name: "gear".into(), ..face.variables[0].clone() };
    face.variables.push(gear);
    let error = system(&material(&face, &[], &[])).unwrap_err();
    assert_eq!(error, "nothing drives its input gear of type Enumeration");
    // A strut whose deflection no output follows.
    let face = self::face();
    let at = Attachment { deflection: "v".into(), ..attachment() };
    let error = system(&material(&face, std::slice::from_ref(&at), &[FRICTION])).unwrap_err();
    assert!(error.starts_with("the deflection of the strut v is no output of the FMU"), "{error}");
}

#[test]
fn start_values_are_given_where_the_fmu_takes_them() {
    let face = face();
    let state =
        |name: &str| strut_model::Declaration { name: name.into(), ..strut_model::Declaration::named(name) };
    let states = [state("v"), state("hidden")];
    let outputs: [(&str, &[f64]); 2] = [("z", &SIGNALS[0]), ("length", &SIGNALS[1])];
    let found = starts(&face, (&states, &[0.2, 0.3]), &outputs);
    assert_eq!(found, [("v".to_owned(), 0.2), ("length".to_owned(), -0.5)]);
}
