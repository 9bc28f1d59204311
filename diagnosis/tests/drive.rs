//! A positioning drive of which nothing was known.

use serde_json::Value;

use crate::simulated::{DAMPING, FRICTION, MASS, plain};

#[test]
fn friction_is_found_in_a_drive_of_which_nothing_was_known() {
    let report = plain();
    let list = |key: &str| report[key].as_array().unwrap().clone();
    let mut named: Vec<String> =
        list("effects").iter().map(|it| it["id"].as_str().unwrap().to_owned()).collect();
    named.sort();
    assert!(
        ["identified", "ambiguous"].contains(&report["verdict"].as_str().unwrap()),
        "{}",
        report["verdict"]
    );
    // Damping and the slope are nominal parameters, told as such.
    assert_eq!(named, ["16"]);
    let parameters = list("effects").into_iter().flat_map(|it| it["parameters"].as_array().unwrap().clone());
    let of = |name: &str, values: &[Value], key: &str| {
        values.iter().find(|it| it["name"] == name).and_then(|it| it[key].as_f64()).unwrap_or(f64::NAN)
    };
    let parameters: Vec<Value> = parameters.collect();
    let base = list("nominal_parameters");
    for (found, there) in [
        (of("moving_mass", &base, "after"), MASS),
        (of("guide.damping", &base, "after"), DAMPING),
        (of("guide.coulomb.force", &parameters, "value"), FRICTION),
    ] {
        assert!((found / there - 1.0).abs() < 0.03, "{found} for {there}");
    }
    // The motion is given and the force compared: the remaining error is the transition of the friction.
    let force = &report["signals"][0];
    assert_eq!(force["name"], "motor.force");
    assert!(force["fit_after"].as_f64().unwrap() > 0.94, "{force}");
}
