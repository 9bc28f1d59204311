//! Trajectories against those of independent solvers (`tests/reference` of the repository).

mod common;

use common::{Case, Named, cases};
use strut_model::{Model, Value};
use strut_physics::{
    actuators::LinearMotor,
    controllers::{LqrController, Skyhook},
    rigs::QuarterCar,
    roads::Road,
};

/// Largest error relative to the column's scale at the default tolerance.
const BOUND: f64 = 1e-6;

/// Name of the reference's variable in the FMU.
fn own_name(column: &str) -> &str {
    match column {
        "v1" => "current_loop",
        "v2" => "delayed",
        "q" => "overload",
        other => other
            .strip_prefix("road.")
            .filter(|rest| ["position", "velocity"].contains(rest))
            .unwrap_or(other),
    }
}

/// The largest relative error of each column.
fn run<M: Model>(case: &Case) -> Vec<(String, f64)> {
    let mut model = Named::<M>::new();
    for (name, value) in case.numbers("parameters").into_iter().chain(case.numbers("start")) {
        model.start(own_name(&name), value);
    }
    if let Some(lift_off) = case.json["settings"]["tire.lift_off"].as_bool() {
        model.choose("tire.lift_off", Value::Boolean(lift_off));
    }
    model.initialize();
    let (step, stop) = (case.number("step"), case.number("stop"));
    let steps = (stop / step).round() as usize;
    let mut errors: Vec<(String, f64)> =
        case.columns[1..].iter().map(|column| (column.clone(), 0.0)).collect();
    let mut compare = |model: &mut Named<M>, row: &[f64]| {
        for ((column, worst), expected) in errors.iter_mut().zip(&row[1..]) {
            // An input's name in the table is the FMU's own.
            let name = if model.has(column) { column.as_str() } else { own_name(column) };
            let error = (model.get(name) - expected).abs() / case.scale(column);
            *worst = if error <= *worst { *worst } else { error };
        }
    };
    let mut rows = case.rows.iter().peekable();
    for k in 0..=steps {
        let t = k as f64 * step;
        let due = rows.next_if(|row| (row[0] - t).abs() < 0.5 * step);
        if k == 0 {
            case.inputs(t).into_iter().for_each(|(name, value)| model.set(name, value));
        }
        if let Some(row) = due {
            compare(&mut model, row);
        }
        case.inputs(t).into_iter().for_each(|(name, value)| model.set(name, value));
        if k < steps {
            model.simulation.step(t, step).unwrap();
        }
    }
    assert_eq!(rows.next(), None, "{}: rows were left out", case.name);
    errors
}

fn check(case: &Case, errors: &[(String, f64)]) {
    for (column, error) in errors {
        assert!(*error < BOUND, "{}: {column} is off by {error:.1e} of its scale", case.name);
    }
}

#[test]
fn rigs_and_actuators_follow_the_reference_solutions() {
    let mut count = 0;
    for case in cases("single") {
        let errors = match case.text("fmu") {
            "QuarterCar" => run::<QuarterCar>(&case),
            "LinearMotor" => run::<LinearMotor>(&case),
            other => panic!("{}: {other} is not tested here", case.name),
        };
        check(&case, &errors);
        count += 1;
    }
    assert!(count >= 12);
}

#[test]
fn roads_follow_the_reference_formulas() {
    for case in cases("road") {
        let mut road = Named::<Road>::new();
        let kind = match case.text("road_kind") {
            "sine" => 2,
            "square" => 3,
            "chirp" => 4,
            "frequency_ramp" => 5,
            "step" => 6,
            "bump" => 7,
            "iso8608" => 8,
            other => panic!("{}: {other} is not tested here", case.name),
        };
        road.choose("kind", Value::Integer(kind));
        let parameters = &case.json["parameters"];
        if let Some(class) = parameters["road_class"].as_str() {
            let index = "ABCDEFGH".find(class).unwrap() as i32;
            road.choose("iso_class", Value::Integer(index + 1));
            road.choose("seed", Value::Integer(parameters["seed"].as_i64().unwrap() as i32));
        }
        for (name, value) in case.numbers("parameters") {
            let own = match (case.text("road_kind"), name.as_str()) {
                (_, "seed") => continue,
                (_, "start") => "start_time",
                ("step", "amplitude") => "step.height",
                ("chirp", "start_frequency") => "chirp.start_frequency",
                ("chirp", "end_frequency") => "chirp.end_frequency",
                ("chirp", "duration") => "chirp.duration",
                ("frequency_ramp", "rate") => "ramp.rate",
                ("bump", "height") => "bump.height",
                ("bump", "length") => "bump.length",
                (_, other) => other,
            };
            road.start(own, value);
        }
        road.initialize();
        let mut now = 0.0;
        for row in &case.rows {
            if row[0] > now {
                road.simulation.step(now, row[0] - now).unwrap();
                now = road.simulation.time();
            }
            for (column, expected) in case.columns[1..].iter().zip(&row[1..]) {
                let error = (road.get(own_name(column)) - expected).abs() / case.scale(column);
                assert!(
                    error < 1e-11,
                    "{}: {column} at {now} s is off by {error:.1e} of its scale",
                    case.name
                );
            }
        }
    }
}

#[test]
fn controllers_follow_the_reference_laws() {
    for case in cases("static") {
        let errors = match case.text("fmu") {
            "Skyhook" => held::<Skyhook>(&case, &[("damping", case.number("damping"))]),
            "LqrController" => held::<LqrController>(
                &case,
                &[
                    ("switch_on_time", case.number("switch_on_time")),
                    ("sprung_mass", 2.45),
                    ("unsprung_mass", 1.0),
                    ("strut.stiffness", 900.0),
                    ("strut.damping", 7.5),
                    ("tire.stiffness", 2500.0),
                    ("tire.damping", 5.0),
                    ("weight.suspension_deflection", 450.0),
                    ("weight.body_velocity", 30.0),
                    ("weight.tire_deflection", 5.0),
                    ("weight.wheel_velocity", 0.01),
                    ("weight.force", 0.01),
                ],
            ),
            other => panic!("{}: {other} is not tested here", case.name),
        };
        assert!(errors < 1e-12, "{}: {errors:.1e}", case.name);
    }
}

/// The largest relative error of the force of a sampled law: that of t_k acts after the tick at t_k.
fn held<M: Model>(case: &Case, parameters: &[(&str, f64)]) -> f64 {
    let mut controller = Named::<M>::new();
    for (name, value) in parameters {
        controller.start(name, *value);
    }
    controller.initialize();
    let (step, stop) = (case.number("step"), case.number("stop"));
    let force = case.columns.iter().position(|column| column == "force").unwrap();
    let mut rows = case.rows.iter().peekable();
    let mut worst = 0.0_f64;
    for k in 0..=(stop / step).round() as usize {
        let t = k as f64 * step;
        case.inputs(t).into_iter().for_each(|(name, value)| controller.set(name, value));
        controller.simulation.step(t, step).unwrap();
        if let Some(row) = rows.next_if(|row| (row[0] - t).abs() < 0.5 * step) {
            worst = worst.max((controller.get("force") - row[force]).abs() / case.scale("force"));
        }
    }
    assert_eq!(rows.next(), None, "{}: rows were left out", case.name);
    worst
}
