use num_dual::Dual64;
use proptest::prelude::*;
use strut_model::{Access, Bundle, Declarations, Interface, Simulation};

use super::*;

const COMPUTED: LqrController = LqrController { enabled: true, computed: true };

fn declared() -> Parameters<f64> {
    let declared = Declarations::of::<Parameters<f64>>();
    Bundle::from_fn(|i| declared[i].start)
}

/// Quanser Table 3.1 and 3.1.1, with another tyre.
fn quanser(tire: f64) -> Parameters<f64> {
    Parameters {
        sprung_mass: 2.45,
        unsprung_mass: 1.0,
        strut: Strut { stiffness: 900.0, damping: 7.5 },
        tire: Tire { stiffness: tire, damping: 5.0 },
        weight: Weight {
            suspension_deflection: 450.0,
            body_velocity: 30.0,
            tire_deflection: 5.0,
            wheel_velocity: 0.01,
            force: 0.01,
        },
        ..declared()
    }
}

fn gain(p: &Parameters<f64>) -> [f64; 4] {
    let mut values = [0.0; 4];
    COMPUTED.derive(p).for_each(|i, value| values[i] = value);
    values
}

#[test]
fn the_printed_gain_belongs_to_2500_newton_per_metre() {
    let printed = [24.66, 48.87, -0.47, 3.68];
    for (found, printed) in gain(&quanser(2500.0)).into_iter().zip(printed) {
        assert!((found - printed).abs() < 0.0051, "{found} {printed}");
    }
    // Not with the tyre of Table 3.1.
    for (found, exact) in gain(&quanser(1250.0)).into_iter().zip([24.66, 47.61, 38.74, 4.51]) {
        assert!((found - exact).abs() < 0.0051, "{found} {exact}");
    }
}

proptest! {
    #[test]
    fn the_gain_solves_the_riccati_equation_and_stabilises(
        masses in prop::array::uniform2(-1.0..1.0_f64), rates in prop::array::uniform2(-1.0..1.0_f64),
        damping in 0.1..3.0_f64, weights in prop::array::uniform5(-1.0..1.0_f64),
    ) {
        // A decade around the declared values, each.
        let around = |start: f64, exponent: f64| start * 10_f64.powf(0.5 * exponent);
        let start = declared();
        let w = start.weight;
        let p = Parameters {
            sprung_mass: around(start.sprung_mass, masses[0]),
            unsprung_mass: around(start.unsprung_mass, masses[1]),
            strut: Strut { stiffness: around(22e3, rates[0]), damping: damping * 1000.0 },
            tire: Tire { stiffness: around(200e3, rates[1]), damping: 50.0 },
            weight: Weight {
                suspension_deflection: around(w.suspension_deflection, weights[0]),
                body_velocity: around(w.body_velocity, weights[1]),
                tire_deflection: around(w.tire_deflection, weights[2]),
                wheel_velocity: around(w.wheel_velocity, weights[3]),
                force: around(w.force, 2.0 * weights[4]),
            },
            ..start
        };
        let problem = problem(&p);
        let solution = problem.solve(shift(&p));
        prop_assert!(problem.residual(&solution) < 1e-9, "{}", problem.residual(&solution));
        prop_assert!(problem.is_stable_with(&problem.gain(&solution)));
        prop_assert_eq!(COMPUTED.check(&p, &COMPUTED.derive(&p)), Ok(()));
    }

    #[test]
    fn the_law_is_linear(x in prop::array::uniform4(-1.0..1.0_f64)) {
        let at = |factor: f64| force(COMPUTED, &quanser(2500.0), x.map(|x| factor * x), 0.0);
        prop_assert!((at(2.0) - 2.0 * at(1.0)).abs() < 1e-9);
    }
}

fn force(controller: LqrController, p: &Parameters<f64>, x: [f64; 4], time: f64) -> f64 {
    let now = Instant {
        time,
        state: &NoVariables,
        input: &Bundle::from_fn(|i| x[i]),
        parameters: p,
        derived: &controller.derive(p),
        memory: &Command { force: 0.0 },
        tick: 0,
    };
    controller.tick(now).force
}

#[test]
fn it_works_from_its_switch_on_time_on_and_only_if_enabled() {
    let p = Parameters { switch_on_time: 5.0, ..quanser(2500.0) };
    let x = [0.0, 1.0, 0.0, 0.0];
    assert_eq!(force(COMPUTED, &p, x, 4.999), 0.0);
    assert!((force(COMPUTED, &p, x, 5.0 - 1e-12) + 48.873).abs() < 1e-3);
    assert_eq!(force(LqrController { enabled: false, computed: true }, &p, x, 6.0), 0.0);
}

#[test]
fn a_given_gain_is_used_as_it_is() {
    let mut p = declared();
    p.gain.given.body_velocity = 12.0;
    assert_eq!(force(LqrController { enabled: true, computed: false }, &p, [9.0, 2.0, 9.0, 9.0], 0.0), -24.0);
}

#[test]
fn an_undamped_plant_that_nothing_is_asked_of_is_refused() {
    let mut p = declared();
    (p.strut.damping, p.tire.damping) = (0.0, 0.0);
    let f = p.weight.force;
    p.weight = Weight {
        suspension_deflection: 0.0,
        body_velocity: 0.0,
        tire_deflection: 0.0,
        wheel_velocity: 0.0,
        force: f,
    };
    let error = COMPUTED.check(&p, &COMPUTED.derive(&p)).unwrap_err();
    assert!(error.contains("strut.damping = 0 N.s/m"), "{error}");
}

#[test]
fn a_gain_depends_on_every_parameter_of_plant_and_weight() {
    let interface = Interface::of::<LqrController>(None, None).unwrap();
    let gain = interface.variables.iter().position(|variable| variable.name == "gain.body_velocity").unwrap();
    let (_, known) =
        interface.structure.initial_unknowns.iter().find(|(unknown, _)| *unknown == gain).unwrap();
    for name in ["sprung_mass", "tire.damping", "weight.force", "gain.given.body_velocity"] {
        assert!(
            known.contains(&interface.variables.iter().position(|variable| variable.name == name).unwrap()),
            "{name}"
        );
    }
}

#[test]
fn derivatives_pass_through_the_riccati_equation() {
    let h = 1e-4;
    let [below, above] = [2500.0 - h, 2500.0 + h].map(|tire| gain(&quanser(tire)));
    let mut parameters = Vec::new();
    quanser(2500.0).for_each(|_, value| parameters.push(value));
    let tire = Declarations::of::<Parameters<f64>>().iter().position(|d| d.name == "tire.stiffness").unwrap();
    let dual: Parameters<Dual64> = Bundle::from_fn(|i| Dual64::new(parameters[i], f64::from(i == tire)));
    COMPUTED.derive(&dual).for_each(|i, found| {
        let difference = (above[i] - below[i]) / (2.0 * h);
        assert!((found.eps - difference).abs() < 1e-6, "{} {difference}", found.eps);
    });
}

#[test]
fn the_force_is_held_for_a_period() {
    let interface = Interface::of::<LqrController>(None, None).unwrap();
    let reference = |name: &str| interface.variable(name).unwrap().reference;
    let mut simulation = Simulation::<LqrController>::new(None, None).unwrap();
    simulation.set_up(0.0, None).unwrap();
    simulation.initialize().unwrap();
    let mut forces = Vec::new();
    for step in 0..8 {
        let time = f64::from(step) * 0.25e-3;
        simulation.set_real(&[reference("body.velocity")], &[f64::from(step)], Access::Continuous).unwrap();
        simulation.step(time, 0.25e-3).unwrap();
        let mut value = [0.0];
        simulation.real(&[reference("force")], &mut value).unwrap();
        forces.push(value[0]);
    }
    assert!(
        forces[..4].iter().all(|force| *force == forces[0])
            && forces[4..].iter().all(|force| *force == forces[4])
    );
    assert!(forces[4] < forces[0]);
}
