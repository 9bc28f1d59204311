//! Events of an FMU between samples, and between the steps of the integration.

use strut_diagnosis::plant::{Between, Drive, Foreign, Seed};

use super::packed;

/// The FMU's values.
const SLOPE: f64 = 1.3;
const WIDTH: f64 = 0.3;
/// Time in s from which it is twice as fast.
const FASTER: f64 = 0.7;
const SAMPLES: usize = 60;
const STEP: f64 = 0.05;

/// Length of the relay's way since the start.
fn way(slope: f64, time: f64) -> f64 {
    slope * (time + (time - FASTER).max(0.0))
}

/// Its position, and its direction.
fn relay(way: f64) -> (f64, f64) {
    let phase = way % (4.0 * WIDTH);
    if phase < WIDTH {
        (phase, 1.0)
    } else if phase < 3.0 * WIDTH {
        (2.0 * WIDTH - phase, -1.0)
    } else {
        (phase - 4.0 * WIDTH, 1.0)
    }
}

#[test]
fn a_relay_turns_and_changes_its_speed_between_samples_and_its_derivatives_are_those_of_the_way() {
    let Some(folder) = packed("relay", &[]) else { return };
    let foreign = Foreign {
        fmu: folder.path().join("relay.fmu"),
        parameters: vec!["c".into()],
        locals: Vec::new(),
        beside: Vec::new(),
    };
    let plant = foreign.plant().unwrap();
    let dynamics = plant.prepare(&plant.choices).unwrap();
    let inputs = vec![vec![0.0; SAMPLES]];
    let drive = Drive::sampled(STEP, inputs);
    let seen = dynamics.linearised(&[SLOPE], &[0.0, 0.0], &drive, &[Seed::Parameter(0)], &[0, 1]);
    let (mut area, mut before) = (0.0, 0.0);
    for sample in 0..SAMPLES {
        let time = sample as f64 * STEP;
        // The area by the trapezium rule in steps that end wherever it turns.
        for part in 1..=5000 {
            let now = time - STEP * (1.0 - f64::from(part) / 5000.0);
            if sample > 0 {
                area += (now - before) * 0.5 * (relay(way(SLOPE, before)).0 + relay(way(SLOPE, now)).0);
                before = now;
            }
        }
        let (position, direction) = relay(way(SLOPE, time));
        let [found, under] = [0, 1].map(|output| seen.outputs[output][sample]);
        assert!((found - position).abs() < 1e-9, "{time} s: {found}, and it is {position}");
        assert!((under - area).abs() < 1e-6, "{time} s: {under}, and it is {area}");
        let (slope, exact) = (seen.slopes[0][0][sample], direction * way(SLOPE, time) / SLOPE);
        assert!((slope - exact).abs() < 1e-3 * (1.0 + exact.abs()), "{time} s: {slope}, and it is {exact}");
    }
}

/// A segment that begins later has the model of its own time.
#[test]
fn an_event_before_the_beginning_of_a_segment_has_happened() {
    let Some(folder) = packed("relay", &[]) else { return };
    let (parameters, locals, beside) = (vec!["c".into()], Vec::new(), Vec::new());
    let plant = Foreign { fmu: folder.path().join("relay.fmu"), parameters, locals, beside }.plant().unwrap();
    let dynamics = plant.prepare(&plant.choices).unwrap();
    let drive = Drive {
        start: 1.0,
        step: STEP,
        inputs: vec![vec![0.0; 3]],
        finer: 1,
        between: Between::Lines,
        filtered: false,
    };
    let found = &dynamics.outputs(&[SLOPE], &[0.0, 0.0], &drive)[0];
    let wanted = [0.0, 2.0, 2.0 * 2.0].map(|steps: f64| relay(SLOPE * steps * STEP).0);
    assert!(found.iter().zip(wanted).all(|(found, it)| (found - it).abs() < 1e-9), "{found:?}");
}
