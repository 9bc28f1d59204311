//! Simulations of small models whose solutions are known in closed form.

use crate::models::{Counter, Oscillator, read, reference, set, started};
use strut_model::{
    Access, Causality, Initial, Interface, Method, ParameterSet, Simulation, Value, Variability,
};

#[test]
fn a_free_oscillation_is_the_cosine() {
    for method in [1, 2] {
        let mut simulation = Simulation::<Oscillator>::new(None, None).unwrap();
        simulation.set_setting(0, Value::Integer(method), Access::All).unwrap();
        simulation.initialize().unwrap();
        for step in 0..1000 {
            simulation.step(f64::from(step) * 0.01, 0.01).unwrap();
        }
        assert!((read(&mut simulation, "position") - 20_f64.cos()).abs() < 1e-7);
        assert!((read(&mut simulation, "acceleration") + 4.0 * 20_f64.cos()).abs() < 4e-7);
        assert!((read(&mut simulation, "energy") - 2.0).abs() < 1e-6);
        assert_eq!(simulation.work().jacobians > 0, Method::ALL[method as usize - 1] == Method::Rosenbrock);
    }
}

#[test]
fn input_derivatives_make_a_polynomial_input_exact() {
    // x'' = F − 4 x with F = 1 + 2 t + 3 t²/2 has the particular solution a + b t + c t².
    let mut simulation = started::<Oscillator>();
    let force = reference::<Oscillator>("force");
    let (c, b) = (1.5 / 4.0, 0.5);
    let a = (1.0 - 2.0 * c) / 4.0;
    set(&mut simulation, "force", 1.0, Access::Continuous).unwrap();
    simulation.set_input_derivatives(&[force, force], &[1, 2], &[2.0, 3.0]).unwrap();
    simulation.step(0.0, 1.5).unwrap();
    let (t, amplitude) = (1.5_f64, 1.0 - a);
    let exact = a + b * t + c * t * t + amplitude * (2.0 * t).cos() - 0.5 * b * (2.0 * t).sin();
    assert!((read(&mut simulation, "position") - exact).abs() < 1e-8);
    assert!(
        (read(&mut simulation, "force") - (1.0 + 3.0 + 1.5 * 2.25)).abs() < 1e-12,
        "inputs stay where they led to"
    );
}

#[test]
fn output_derivatives_are_exact() {
    let mut simulation = started::<Oscillator>();
    simulation.step(0.0, 0.3).unwrap();
    let mut slopes = [0.0; 2];
    let references = [reference::<Oscillator>("acceleration"), reference::<Oscillator>("position")];
    simulation.output_derivatives(&references, &[1, 1], &mut slopes).unwrap();
    assert!((slopes[0] - 8.0 * 0.6_f64.sin()).abs() < 1e-7, "{slopes:?}");
    assert!((slopes[1] + 2.0 * 0.6_f64.sin()).abs() < 1e-7);
    assert!(simulation.output_derivatives(&references[..1], &[2], &mut slopes).is_err());
}

#[test]
fn directional_derivatives_reach_parameters_and_what_follows_from_them() {
    let mut simulation = started::<Oscillator>();
    let unknowns =
        ["acceleration", "der(velocity)", "angular_frequency", "position"].map(reference::<Oscillator>);
    let mut derivative = [0.0; 4];
    simulation
        .directional_derivative(
            &unknowns,
            (&[reference::<Oscillator>("spring.stiffness")], &[2.0]),
            0.0,
            &mut derivative,
        )
        .unwrap();
    // a = −k x / m, ω = √(k/m) at k = 4, m = 1, x = 1.
    assert_eq!(derivative, [-2.0, -2.0, 0.5, 0.0]);
    let knowns = (&unknowns[..1], &[1.0][..]);
    let error = simulation.directional_derivative(&unknowns, knowns, 0.0, &mut derivative).unwrap_err();
    assert!(error.to_string().contains("`acceleration`"), "{error}");
}

#[test]
fn ticks_do_not_depend_on_the_communication_step() {
    let sum_after = |steps: &[f64]| {
        let mut simulation = started::<Counter>();
        set(&mut simulation, "force", 1.0, Access::Continuous).unwrap();
        let mut time = 0.0;
        for size in steps {
            simulation.step(time, *size).unwrap();
            time += size;
        }
        read(&mut simulation, "sum")
    };
    // Ticks at 0, 0.01, … 0.09; the one at 0.1 belongs to the next step.
    assert_eq!(sum_after(&[0.1]), 10.0);
    assert_eq!(sum_after(&[0.01; 10]), 10.0);
    assert_eq!(sum_after(&[0.003; 33]), 10.0);
    assert_eq!(sum_after(&[0.1, 0.1]), 20.0);
}

#[test]
fn the_first_tick_is_tried_out_until_it_is_made() {
    let mut simulation = Simulation::<Counter>::new(None, None).unwrap();
    for force in [2.0, 5.0] {
        set(&mut simulation, "force", force, Access::All).unwrap();
        assert_eq!(read(&mut simulation, "sum"), force);
    }
    simulation.initialize().unwrap();
    set(&mut simulation, "force", 7.0, Access::Continuous).unwrap();
    for _ in 0..2 {
        assert_eq!(read(&mut simulation, "sum"), 7.0);
    }
    simulation.step(0.0, 1e-3).unwrap();
    assert_eq!(read(&mut simulation, "sum"), 7.0);
}

#[test]
fn structure_is_exact() {
    let interface = Interface::of::<Oscillator>(None, None).unwrap();
    let index = |name: &str| interface.variables.iter().position(|variable| variable.name == name).unwrap();
    let names =
        |list: &[usize]| list.iter().map(|i| interface.variables[*i].name.clone()).collect::<Vec<_>>();
    let of = |list: &[(usize, Vec<usize>)], name: &str| {
        names(&list.iter().find(|(unknown, _)| *unknown == index(name)).unwrap().1)
    };
    let structure = &interface.structure;
    assert_eq!(of(&structure.outputs, "acceleration"), ["force", "position", "velocity"]);
    assert_eq!(of(&structure.outputs, "energy"), ["position", "velocity"]);
    assert_eq!(of(&structure.outputs, "position"), ["position"]);
    assert_eq!(of(&structure.derivatives, "der(position)"), ["velocity"]);
    assert_eq!(of(&structure.initial_unknowns, "angular_frequency"), ["mass", "spring.stiffness"]);
    assert_eq!(
        of(&structure.initial_unknowns, "energy"),
        ["position", "velocity", "mass", "spring.stiffness"]
    );
    assert!(structure.initial_unknowns.is_sorted());
    let variable = interface.variable("spring.damping").unwrap();
    assert_eq!((variable.causality, variable.variability), (Causality::Parameter, Variability::Fixed));
    assert_eq!(interface.variable("position").unwrap().initial, Some(Initial::Exact));

    let counter = Interface::of::<Counter>(None, None).unwrap();
    let sum = counter.variables.iter().position(|variable| variable.name == "sum").unwrap();
    assert_eq!(counter.structure.outputs, [(sum, vec![])], "held between ticks");
    assert_eq!(
        counter.structure.initial_unknowns,
        [(sum, vec![0, 3, 4])],
        "a first tick passes the input through"
    );
    assert_eq!(counter.variables[sum].variability, Variability::Discrete);
}

#[test]
fn the_guid_tells_start_values_apart() {
    let set = |stiffness: &str| {
        ParameterSet::parse(&format!(
            "fmu = 'O'\nmodel = 'Oscillator'\ntitle = 't'\nsource = 's'\n[values]\n{stiffness}"
        ))
        .unwrap()
    };
    let guid = |set: Option<&ParameterSet>| Interface::of::<Oscillator>(set, None).unwrap().guid();
    let nine = set("spring.stiffness = { value = 9.0, unit = 'N/m' }");
    assert_eq!(guid(None), guid(None));
    assert_eq!(guid(None), guid(Some(&set("spring.stiffness = { value = 4.0, unit = 'N/m' }"))));
    assert_ne!(guid(None), guid(Some(&nine)));
    let mut simulation = Simulation::<Oscillator>::new(Some(&nine), None).unwrap();
    assert_eq!(read(&mut simulation, "angular_frequency"), 3.0);
}

#[test]
fn parameter_sets_that_do_not_fit_are_refused_by_name() {
    for (line, part) in [
        ("spring.stifness = { value = 9.0 }", "did you mean `spring.stiffness`?"),
        ("spring.stiffness = { value = 9.0, unit = 'kN/m' }", "given in \"kN/m\" but declared in \"N/m\""),
        (
            "spring.stiffness = { value = -1.0 }",
            "`spring.stiffness` = -1 N/m is out of bounds: it must be at least 0",
        ),
        ("solver.method = { value = 'Euler' }", "give one of 1 (Explicit), 2 (Rosenbrock)"),
    ] {
        let text = format!("fmu = 'O'\nmodel = 'Oscillator'\ntitle = 't'\nsource = 's'\n[values]\n{line}");
        let error =
            Interface::of::<Oscillator>(Some(&ParameterSet::parse(&text).unwrap()), None).unwrap_err();
        assert!(error.to_string().contains(part), "{error}");
    }
}

#[test]
fn a_parameter_set_of_another_model_is_refused() {
    let set = ParameterSet::parse("fmu = 'Mine'\nmodel = 'Counter'\ntitle = 't'\nsource = 's'").unwrap();
    let error = Interface::of::<Oscillator>(Some(&set), None).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the parameter set of Mine is one for the model Counter, not for Oscillator"
    );
}

#[test]
fn what_may_not_be_set_is_refused_by_name() {
    let mut simulation = started::<Oscillator>();
    for (name, value, part) in [
        ("acceleration", 1.0, "`acceleration` cannot be set: it is an output"),
        ("der(velocity)", 1.0, "`der(velocity)` cannot be set: it is the derivative of a state"),
        ("angular_frequency", 1.0, "calculated"),
        ("spring.damping", 1.0, "fixed parameter"),
        ("position", 1.0, "until initialisation ends and, for model exchange"),
        ("mass", -1.0, "`mass` = -1 kg is out of bounds: it must be at least 0.000001"),
        ("force", f64::NAN, "`force` cannot be NaN"),
        ("mass", f64::INFINITY, "`mass` cannot be inf"),
    ] {
        let error = set(&mut simulation, name, value, Access::Tunable).unwrap_err();
        assert!(error.to_string().contains(part), "{error}");
    }
    let unknown = simulation.real(&[999], &mut [0.0]).unwrap_err();
    assert!(unknown.to_string().contains("999 is no real variable of Oscillator"), "{unknown}");
    // Nothing of that had an effect.
    let mut fresh = started::<Oscillator>();
    for simulation in [&mut simulation, &mut fresh] {
        simulation.step(0.0, 0.1).unwrap();
    }
    assert_eq!(simulation.states(), fresh.states());
}

#[test]
fn steps_must_lead_on() {
    let mut simulation = started::<Oscillator>();
    simulation.step(0.0, 0.1).unwrap();
    for (from, size, part) in [
        (0.0, 0.1, "not where the last step ended"),
        (0.1, 0.0, "must be positive and finite"),
        (0.1, -0.1, "must be positive and finite"),
        (0.1, f64::NAN, "must be positive and finite"),
        (0.1, f64::INFINITY, "must be positive and finite"),
        (f64::NAN, 0.1, "leads nowhere"),
        (0.1, 1e-30, "leads nowhere"),
    ] {
        let error = simulation.step(from, size).unwrap_err();
        assert!(error.to_string().contains(part), "{from} {size}: {error}");
    }
    // A clock that has drifted by rounding is not an error.
    simulation.step(0.1 + 1e-12, 0.1).unwrap();
}

#[test]
fn a_setting_that_the_model_refuses_is_told_at_initialisation() {
    let mut simulation = Simulation::<Counter>::new(None, None).unwrap();
    simulation.set_setting(0, Value::Integer(-4), Access::All).unwrap();
    assert!(simulation.initialize().unwrap_err().to_string().contains("seed = -4"));
    simulation.set_setting(0, Value::Integer(4), Access::All).unwrap();
    simulation.initialize().unwrap();
    let error = simulation.set_setting(1, Value::Integer(7), Access::Tunable).unwrap_err();
    assert!(
        error.to_string().contains("`loudness` cannot be 7: give one of 1 (Silent), 2 (Loud)"),
        "{error}"
    );
    assert!(simulation.set_setting(0, Value::Integer(5), Access::Tunable).is_err(), "fixed");
    simulation.set_setting(1, Value::Integer(2), Access::Tunable).unwrap();
    assert!(simulation.setting(0, "boolean").is_err());
}
