//! What several tests make their records with.

use strut_diagnosis::dataset::recorded::{Dataset, Measured, Source};
use strut_diagnosis::rig::Rig;

/// A record of a bench whose named inputs are these signals, all others being at rest, and of its force with the noise of a load cell.
pub fn on_a_bench(
    rig: &Rig,
    (name, step): (String, f64),
    driven: &[(&str, Vec<f64>)],
    (force, noise_floor): (Vec<f64>, f64),
) -> Dataset {
    let of = |name: &str| {
        let signal = driven.iter().find(|(driven, _)| *driven == name);
        signal.map_or(Source::Constant(0.0), |(_, values)| Source::Measured(values.clone()))
    };
    Dataset {
        name,
        step,
        inputs: rig.plant.inputs.iter().map(|it| of(&it.name)).collect(),
        sections: std::iter::once(0..force.len()).collect(),
        measured: vec![Measured { output: rig.plant.output("force").unwrap(), values: force, noise_floor }],
        imposed: rig.imposes_motion(),
        ..Dataset::default()
    }
}

/// Noise of a standard deviation of one, nearly normal, the same for the same seed.
pub fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        let mut sum = 0.0;
        for _ in 0..12 {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            sum += (state >> 11) as f64 / (1_u64 << 53) as f64;
        }
        sum - 6.0
    }
}
