//! The FMU as a predictor: as the library's own model with the same equations, and with elements beside it.

use std::path::Path;

use strut_diagnosis::plant::{
    Attachment, Drive, Dynamics, Follower, Foreign, Plant, Role, Seed, Seen, models,
};
use strut_model::Declaration;

use super::rig;

/// The FMU's parameters.
const NAMES: [&str; 6] = ["m_s", "m_u", "k_s", "d_s", "k_t", "d_t"];

/// The FMU as a plant, with elements of the library beside it.
fn plant(folder: &Path, beside: &[Attachment]) -> Plant {
    let foreign = Foreign {
        fmu: folder.join("quarter.fmu"),
        parameters: NAMES.map(str::to_owned).to_vec(),
        locals: ["z_s", "v_s", "z_u", "v_u"].map(str::to_owned).to_vec(),
        beside: beside.to_vec(),
    };
    foreign.plant().unwrap()
}

/// An element in addition to the FMU's own.
fn on_top(role: Role, deflection: &str, velocity: &str, input: &str) -> Attachment {
    Attachment {
        role,
        deflection: deflection.into(),
        rest: 0.0,
        velocity: velocity.into(),
        acts_on: vec![(input.into(), -1.0)],
        replaces: None,
    }
}

/// A plant with its equations and its declared values.
struct Ready {
    plant: Plant,
    dynamics: Box<dyn Dynamics>,
    values: Vec<f64>,
    start: Vec<f64>,
}

impl Ready {
    fn of(plant: Plant) -> Self {
        let dynamics = plant.prepare(&plant.choices).unwrap();
        let starts = |all: &[Declaration]| all.iter().map(|it| it.start).collect();
        Self { values: starts(&plant.parameters), start: starts(&plant.states), dynamics, plant }
    }

    /// The library's model, with the FMU's values.
    fn of_the_library(fmu: &Plant) -> (Self, [usize; 6]) {
        let mut ready = Self::of(models::named("QuarterCar").unwrap());
        let same = [
            "sprung_mass",
            "unsprung_mass",
            "strut.stiffness",
            "strut.damping",
            "tire.stiffness",
            "tire.damping",
        ];
        let own = same.map(|name| ready.plant.parameter(name).unwrap());
        own.iter().zip(&fmu.parameters).for_each(|(index, it)| ready.values[*index] = it.start);
        (ready, own)
    }

    /// The same with other values.
    fn with(mut self, values: &[(&str, f64)]) -> Self {
        for (name, value) in values {
            self.values[self.plant.parameter(name).expect(name)] = *value;
        }
        self
    }

    /// Signals with a sample every millisecond; inputs without a name here rest.
    fn drive(&self, signals: &[(&str, Vec<f64>)]) -> Drive {
        let samples = signals.first().map_or(0, |(_, values)| values.len());
        let mut inputs = vec![vec![0.0; samples]; self.plant.inputs.len()];
        for (name, values) in signals {
            inputs[self.plant.input(name).expect(name)].clone_from(values);
        }
        Drive::sampled(1e-3, inputs)
    }

    /// One output.
    fn output(&self, drive: &Drive, name: &str) -> Vec<f64> {
        let index = self.plant.output(name).expect(name);
        self.dynamics.outputs(&self.values, &self.start, drive).swap_remove(index)
    }
}

/// One signal is the other up to a share of its largest value.
fn near(a: &[f64], b: &[f64], tolerance: f64, what: &str) {
    let largest = b.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
    let error = a.iter().zip(b).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(error < tolerance * largest, "{what}: {error} of {largest}");
}

/// A function of time in s, every millisecond.
fn sampled(samples: u32, f: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..samples).map(|k| f(f64::from(k) * 1e-3)).collect()
}

/// Each with an effect, all at once.
#[test]
fn elements_beside_the_fmu_do_what_they_do_in_a_model_of_the_library() {
    let Some((folder, _)) = rig(&[], |text| text) else { return };
    let beside = [
        on_top(Role::Strut, "z_rel", "v_rel", "F_act"),
        on_top(Role::Guide, "z_s", "v_s", "F_s"),
        on_top(Role::WheelGuide, "z_u", "v_u", "F_u"),
        on_top(Role::Tire, "z_t", "v_t", "F_u"),
    ];
    let effects = [
        ("strut.orifice.coefficient", 300.0),
        ("strut.spring.quadratic", 2e4),
        ("guide.coulomb.force", 20.0),
        ("guide.coulomb.velocity", 0.05),
        ("guide.preload", 5.0),
        ("wheel_guide.damping", 60.0),
        ("tire.quadratic", 4e6),
    ];
    let theirs = Ready::of(plant(folder.path(), &beside)).with(&effects);
    let ours = Ready::of_the_library(&theirs.plant).0.with(&effects);
    let road = sampled(1000, |t| 0.01 * (9.0 * t).sin());
    let rate = sampled(1000, |t| 0.09 * (9.0 * t).cos());
    let drives = [
        theirs.drive(&[("z_r", road.clone()), ("v_r", rate.clone())]),
        ours.drive(&[("road.position", road), ("road.velocity", rate)]),
    ];
    for (name, same) in
        [("z_rel", "suspension.deflection"), ("a_s", "body.acceleration"), ("a_u", "wheel.acceleration")]
    {
        near(&theirs.output(&drives[0], name), &ours.output(&drives[1], same), 1e-5, name);
    }
}

/// The same equations in Rust, with exact derivatives; for so long that the start is forgotten.
#[test]
fn an_fmu_predicts_as_the_same_model_of_the_library_does() {
    let Some((folder, _)) = rig(&[], |text| text) else { return };
    let theirs = Ready::of(plant(folder.path(), &[]));
    let (ours, own) = Ready::of_the_library(&theirs.plant);
    let road = sampled(6000, |t| 0.01 * (9.0 * t).sin() + 2e-3 * (50.0 * t).sin());
    let rate = sampled(6000, |t| 0.09 * (9.0 * t).cos() + 0.1 * (50.0 * t).cos());
    let force = sampled(6000, |t| 30.0 * (20.0 * t).sin());
    let drive = |ready: &Ready, [road_name, rate_name, force_name]: [&str; 3]| {
        ready.drive(&[(road_name, road.clone()), (rate_name, rate.clone()), (force_name, force.clone())])
    };
    let outputs = [("z_rel", "suspension.deflection"), ("a_s", "body.acceleration"), ("F_t", "wheel.force")];
    let linearised = |ready: &Ready, drive: &Drive, own: &[usize], wanted: [&str; 3]| {
        let parameters = own.iter().map(|index| Seed::Parameter(*index));
        let seeds: Vec<Seed> = parameters.chain([Seed::State(0), Seed::State(3)]).collect();
        let wanted = wanted.map(|name| ready.plant.output(name).unwrap());
        ready.dynamics.linearised(&ready.values, &ready.start, drive, &seeds, &wanted)
    };
    let of_fmu = drive(&theirs, ["z_r", "v_r", "F_act"]);
    let found = linearised(&theirs, &of_fmu, &[0, 1, 2, 3, 4, 5], outputs.map(|(name, _)| name));
    let of_ours = drive(&ours, ["road.position", "road.velocity", "actuator.force"]);
    let exact = linearised(&ours, &of_ours, &own, outputs.map(|(_, name)| name));
    for (output, (name, _)) in outputs.iter().enumerate() {
        near(&found.outputs[output], &exact.outputs[output], 1e-12, name);
        for (seed, (found, exact)) in found.slopes.iter().zip(&exact.slopes).enumerate() {
            near(&found[output], &exact[output], 1e-5, &format!("{name}, seed {seed}"));
        }
    }
}

/// Keeps what becomes of the states from sample to sample.
#[derive(Default)]
struct Slopes(Vec<Vec<f64>>);

impl Follower for Slopes {
    fn state(&mut self, _: usize, _: &mut [f64]) {}

    fn seen(&mut self, _: usize, _: Seen<'_>, _: &mut [f64]) {}

    fn advanced(&mut self, _: usize, _: &[f64], slopes: &[f64]) {
        self.0.push(slopes.to_vec());
    }
}

/// The FMU with a strut of the library on top of its own, on a sine of 10 mm that turns by an angle in rad per sample.
fn with_strut_on_a_road(folder: &Path, samples: u32, turned: f64) -> (Ready, Drive) {
    let ready = Ready::of(plant(folder, &[on_top(Role::Strut, "z_rel", "v_rel", "F_act")]));
    let drive = ready.drive(&[("z_r", sampled(samples, |t| 0.01 * (1e3 * turned * t).sin()))]);
    (ready, drive)
}

/// It builds up over a tenth and a hundredth of a millimetre, and at rest nothing of it is fast.
#[test]
fn friction_before_it_slides_is_integrated_beside_the_fmu_however_stiff_it_is() {
    let Some((folder, _)) = rig(&[], |text| text) else { return };
    let with = |stiffness: f64| {
        let (ready, drive) = with_strut_on_a_road(folder.path(), 2000, 0.02);
        let friction =
            [("hysteresis.presliding.force", 50.0), ("hysteresis.presliding.stiffness", stiffness)];
        ready.with(&friction).output(&drive, "z_rel")
    };
    let (soft, stiff) = (with(5e5), with(5e6));
    assert!(stiff.iter().all(|it| it.is_finite()));
    near(&stiff, &soft, 0.05, "deflection");
}

/// No output sees the memory of effects that are off, however often a change of it is made.
#[test]
fn the_memory_of_effects_that_are_off_keeps_its_derivatives() {
    let Some((folder, _)) = rig(&[], |text| text) else { return };
    let (Ready { plant, dynamics, values, start }, drive) = with_strut_on_a_road(folder.path(), 20, 0.1);
    let seeds: Vec<Seed> = (0..start.len()).map(Seed::State).collect();
    for _ in 0..40 {
        dynamics.linearised(&values, &start, &drive, &seeds, &[0]);
    }
    let mut slopes = Slopes::default();
    dynamics.followed(&values, &start, &drive, (&seeds, &[0]), &mut slopes);
    let is_memory = |index: &usize| plant.states[*index].name.contains('.');
    let memory: Vec<usize> = (0..start.len()).filter(is_memory).collect();
    assert!(memory.len() >= 3, "{memory:?}");
    for (sample, slopes) in slopes.0.iter().enumerate() {
        for index in &memory {
            let name = &plant.states[*index].name;
            assert_eq!(slopes[index * start.len() + index], 1.0, "{name} after sample {sample}");
        }
    }
}
