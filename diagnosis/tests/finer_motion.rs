//! Friction between a mass and a moved base at 1 kHz, by equations of this file: more of its motion is above the band that is searched
//! in than its interval is wide.

use std::f64::consts::TAU;

use strut_diagnosis::dataset::recorded::{Dataset, Measured, Source};
use strut_diagnosis::dataset::split::Split;
use strut_diagnosis::diagnosis::{Options, diagnose};
use strut_diagnosis::rig::Rig;

const STEP: f64 = 1e-3;
const SUBSTEPS: usize = 50;
const COUNT: usize = 8000;
/// In N, and the velocity in m/s at which 76 % of it are reached.
const FRICTION: [f64; 2] = [300.0, 5e-3];

/// Height and velocity of the base in m and m/s.
fn base(t: f64, phase: f64) -> [f64; 2] {
    let waves = [(0.03, 1.3), (0.01, 3.1), (0.004, 7.3), (0.0015, 13.7)];
    waves.iter().fold([0.0; 2], |[x, v], (size, hertz)| {
        let angle = TAU * hertz * t + phase * hertz;
        [x + size * angle.sin(), v + size * TAU * hertz * angle.cos()]
    })
}

/// 350 kg on 22 kN/m and 1500 N s/m, from rest.
fn record(rig: &Rig, name: &str, phase: f64) -> Dataset {
    let rates = |t: f64, [x, v]: [f64; 2]| {
        let [xb, vb] = base(t, phase);
        let friction = FRICTION[0] * ((v - vb) / FRICTION[1]).tanh();
        [v, -(22e3 * (x - xb) + 1500.0 * (v - vb) + friction) / 350.0]
    };
    let mut state = base(0.0, phase);
    let (mut acceleration, mut deflection) = (Vec::new(), Vec::new());
    for k in 0..COUNT {
        let t = STEP * k as f64;
        acceleration.push(rates(t, state)[1]);
        deflection.push(state[0] - base(t, phase)[0]);
        let h = STEP / SUBSTEPS as f64;
        for part in 0..SUBSTEPS {
            let t = t + h * part as f64;
            let along = |slope: [f64; 2], by: f64| [state[0] + by * slope[0], state[1] + by * slope[1]];
            let k1 = rates(t, state);
            let k2 = rates(t + 0.5 * h, along(k1, 0.5 * h));
            let k3 = rates(t + 0.5 * h, along(k2, 0.5 * h));
            let k4 = rates(t + h, along(k3, h));
            state = [0, 1].map(|i| state[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        }
    }
    let time = || (0..COUNT).map(|k| base(STEP * k as f64, phase));
    let input = |name: &str| match name {
        "motion.position" => Source::Measured(time().map(|it| it[0]).collect()),
        "motion.velocity" => Source::Measured(time().map(|it| it[1]).collect()),
        _ => Source::Constant(0.0),
    };
    let of = |name: &str, values: Vec<f64>| Measured {
        output: rig.plant.output(name).unwrap(),
        values,
        noise_floor: 0.0,
    };
    Dataset {
        name: name.into(),
        step: STEP,
        inputs: rig.plant.inputs.iter().map(|it| input(&it.name)).collect(),
        measured: vec![of("body.acceleration", acceleration), of("suspension.deflection", deflection)],
        sections: std::iter::once(0..COUNT).collect(),
        ..Dataset::default()
    }
}

#[test]
fn friction_at_a_thousand_samples_a_second_is_that_of_all_its_motion() {
    let rig = Rig::published("sprung-mass").unwrap();
    let records = Split::new(&[record(&rig, "a", 0.0)], vec![record(&rig, "b", 1.0)]);
    let mass = rig.plant.parameter("sprung_mass").unwrap();
    let only = Options { only: vec!["01".into()], known: vec![(mass, 350.0, 1e-3)], ..Options::default() };
    let force = |records: &Split| {
        let diagnosis = diagnose(&rig, records, only.clone(), &|_| {}).unwrap();
        diagnosis.found.extended.point.parameters[rig.plant.parameter("strut.coulomb.force").unwrap()]
    };
    let fine = force(&records);
    let as_searched = [records.train.clone(), records.test.clone()];
    let thin = force(&Split { finer: as_searched, ..records });
    let [fine, thin] = [fine, thin].map(|it| (it / FRICTION[0] - 1.0).abs());
    assert!(fine < 4e-4 && fine < 0.3 * thin, "{fine} {thin}");
}
