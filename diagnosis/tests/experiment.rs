//! The experiment that separates rivals: on it the right model wins, on another excitation of the same size it may not.

use strut_diagnosis::catalogue::naming::name;
use strut_diagnosis::data;
use strut_diagnosis::dataset::recorded::{Dataset, Measured, Source};
use strut_diagnosis::dataset::split::Split;
use strut_diagnosis::decision::verdict::Verdict;
use strut_diagnosis::diagnosis::{Diagnosis, Options, diagnose};
use strut_diagnosis::estimation::hypothesis::Baseline;
use strut_diagnosis::estimation::lsq::Stop;
use strut_diagnosis::estimation::unknowns::Estimate;
use strut_diagnosis::experiment::{Excitation, Limits, Rival, Shape, TABLE, Trial, Wave, excitations};
use strut_diagnosis::plant::Drive;
use strut_diagnosis::rig::Rig;
use strut_diagnosis::signal::derivative;

use crate::common::noise;

const STEP: f64 = 2.5e-3;
/// Standard deviation of the force's noise in N.
const NOISE: f64 = 60.0;

/// A record of a strut on a bench: its lower end moves, its force is measured with noise.
fn record(rig: &Rig, parameters: &[f64], motion: Vec<f64>, seed: u64) -> Dataset {
    let (count, velocity) = (motion.len(), derivative(&motion, STEP));
    let no_coil = vec![0.0; count];
    let drive = Drive::sampled(STEP, vec![motion.clone(), velocity, no_coil.clone(), no_coil]);
    let outputs = rig.plant.prepare(&rig.choices).unwrap().outputs(parameters, &rig.start, &drive);
    let (output, mut noise) = (rig.plant.output("force").unwrap(), noise(seed));
    let values = outputs[output].iter().map(|force| force + NOISE * noise()).collect();
    Dataset {
        name: format!("{seed}"),
        step: STEP,
        inputs: vec![
            Source::Measured(motion),
            Source::DerivativeOf(0),
            Source::Constant(0.0),
            Source::Constant(0.0),
        ],
        measured: vec![Measured { output, values, noise_floor: NOISE }],
        sections: std::iter::once(0..count).collect(),
        ..Dataset::default()
    }
}

/// A strut on a bench with orifice damping, moved by sines of nearly one speed.
fn case() -> (Rig, Vec<f64>) {
    let mut rig = Rig::published("element-dyno").unwrap();
    let mut set = |name: &str, value: f64| {
        let index = rig.plant.parameter(name).unwrap();
        rig.parameters[index] = value;
    };
    set("strut.stiffness", 3000.0);
    set("strut.damping", 400.0);
    let mut truth = rig.parameters.clone();
    truth[rig.plant.parameter("strut.orifice.coefficient").unwrap()] = 6000.0;
    (rig, truth)
}

fn records(rig: &Rig, truth: &[f64]) -> Split {
    let sine = |frequency: f64| Shape::Sine { frequency }.signal(0.015, STEP, 2400);
    Split::new(&[record(rig, truth, sine(1.5), 1)], vec![record(rig, truth, sine(1.6), 2)])
}

/// A knee of the damper explains the force at one speed as well as an orifice.
fn diagnosed<'a>(rig: &'a Rig, records: &'a Split) -> Diagnosis<'a> {
    let only = ["05", "06"].map(str::to_owned).to_vec();
    let diagnosis = diagnose(rig, records, Options { only, ..Options::default() }, &|_| {}).unwrap();
    let accepted = &diagnosis.found.accepted;
    let rivals: Vec<Vec<String>> = accepted
        .iter()
        .map(|it| [it.term].iter().chain(&it.rivals).map(|it| name(*it, &rig.plant).short()).collect())
        .collect();
    assert_eq!(rivals, [["06 strut", "05 strut"]]);
    diagnosis
}

/// Twice as fast and more than twice as far as the records.
const WIDER: Limits =
    Limits { stroke: Some(0.04), force: Some(2000.0), rate: Some(0.3), duration: None, bandwidth: None };

#[test]
fn within_what_the_records_have_reached_nothing_decides() {
    let (rig, truth) = case();
    let records = records(&rig, &truth);
    let diagnosis = diagnosed(&rig, &records);
    let deciding = diagnosis.deciding_experiment(Limits::default()).unwrap().unwrap();
    assert!(!deciding.decides && deciding.compared > 30 && deciding.files.is_empty(), "{deciding:?}");
    // As the verdict says of the records themselves.
    let pair = &deciding.pairs[0];
    assert!(pair.recorded < 3.29 && pair.probability < 0.95, "{pair:?}");
    let mut findings = diagnosis.findings(Vec::new(), 1.0);
    assert_eq!(findings.verdict, Verdict::Ambiguous);
    findings.decide(deciding);
    let text = findings.experiment.unwrap();
    assert!(text.starts_with("None of ") && text.contains("damper knee in the strut"), "{text}");
}

#[test]
fn the_right_model_wins_on_the_experiment() {
    let (rig, truth) = case();
    let records = records(&rig, &truth);
    let diagnosis = diagnosed(&rig, &records);
    let deciding = diagnosis.deciding_experiment(WIDER).unwrap().unwrap();
    assert!(deciding.decides && deciding.pairs[0].decides, "{deciding:?}");
    for it in deciding.limits.iter() {
        let reached = it.reached.unwrap();
        assert!(reached > 0.0 && reached <= 1.02 * it.limit, "{it:?}");
    }

    let contest = diagnosis.contest(WIDER).unwrap().unwrap();
    let trials: Vec<Trial> = excitations(&contest.bounds).iter().filter_map(|it| contest.tried(it)).collect();
    let best = contest.best(&trials).unwrap();
    // Whichever is true: noise is drawn again each time, and both are fitted.
    let (output, models) = (rig.plant.output("force").unwrap(), contest.models());
    for right in 0..models.len() {
        for seed in 10..14 {
            let motion = best.excitation.signal(&rig, 0, STEP, 2400);
            let choices = diagnosis.baseline.choices(&models[right].fitted.terms);
            assert_eq!(choices, rig.choices);
            let measured = record(&rig, &models[right].fitted.point.parameters, motion, seed);
            assert_eq!(measured.measured[0].output, output);
            let records = [measured];
            let baseline = Baseline { train: &records, test: &[], ..diagnosis.baseline.clone() };
            let cost = |it: &Rival| {
                let start = Estimate { starts: baseline.starts(&records), ..it.fitted.point.clone() };
                baseline.fitted(&it.fitted.terms, &[start], Stop::NOISY).unwrap().cost
            };
            let costs: Vec<f64> = models.iter().map(cost).collect();
            assert!((0..models.len()).all(|it| costs[right] <= costs[it]), "{right} is right: {costs:?}");
        }
    }

    // Sines of any frequency, as large as the same limits let them be, do less.
    let mut random = noise(3);
    let (low, high) = contest.bounds.inputs[0].band;
    for _ in 0..4 {
        let share = (0.5 + 0.2 * random()).clamp(0.0, 1.0);
        let bound = contest.bounds.inputs[0];
        let shape = Shape::Sine { frequency: low * (high / low).powf(share) };
        let (shape, amplitude) = shape.within_rate(bound.amplitude, bound.rate, contest.bounds.duration);
        let wave = Wave { input: 0, shape, amplitude };
        let trial = contest.tried(&Excitation { waves: vec![wave] }).unwrap();
        let random = contest.fitted(&trial).unwrap();
        assert!(random.separations[0].distance < best.separations[0].distance, "{shape:?}: {random:?}");
    }
}

/// Records in stretches make an experiment in stretches, each with states of its own at the start.
#[test]
fn stretches_of_a_record_are_those_of_the_experiment() {
    let (rig, truth) = case();
    let mut records = records(&rig, &truth);
    for record in records.train.iter_mut().chain(&mut records.test) {
        record.sections = vec![0..1200, 1200..2400];
    }
    let diagnosis = diagnosed(&rig, &records);
    let deciding = diagnosis.deciding_experiment(WIDER).unwrap().unwrap();
    assert!(deciding.decides && deciding.pairs[0].distance > 5.0, "{deciding:?}");
}

#[test]
fn the_table_is_a_record_s_drive() {
    let (rig, truth) = case();
    let records = records(&rig, &truth);
    let deciding = diagnosed(&rig, &records).deciding_experiment(WIDER).unwrap().unwrap();
    let (name, text) = &deciding.files[0];
    assert_eq!(name, TABLE);
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), text).unwrap();
    let table = data::read(&folder.path().join(name), &data::Reading::default()).unwrap();
    assert_eq!((table.channels.len(), &table.channels[0].name[..]), (1, "motion.position"));
    let largest = table.channels[0].values.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
    assert!((largest / deciding.drives[0].amplitude - 1.0).abs() < 0.02, "{largest}: {:?}", deciding.drives);
    assert!((table.time.len() as f64 * STEP - deciding.duration).abs() < 2.0 * STEP);
}
