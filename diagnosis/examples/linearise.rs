//! What one iteration of a fit costs: residuals of a record and their derivatives with respect to all parameters of a
//! rig that are fitted first and to the states at the start.
//!
//! ```text
//! cargo run --release --package strut-diagnosis --example linearise -- tum-quarter-vehicle record.csv
//! ```
//! prints JSON: median time, what was derived, and the information on each parameter, which is the diagonal of JᵀJ
//! after the states at the start have been eliminated.

use std::time::Instant;

use strut_diagnosis::data::Origin;
use strut_diagnosis::data::map::Map;
use strut_diagnosis::dataset::load::load;
use strut_diagnosis::estimation::fit::Fit;
use strut_diagnosis::estimation::lsq::Problem;
use strut_diagnosis::estimation::unknowns::{Estimate, FreeParameter, Unknown};
use strut_diagnosis::rig::Rig;
use strut_diagnosis::signal::distortion::Correction;

/// Repetitions of which the median counts.
const RUNS: usize = 11;

fn main() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [rig, record] = &arguments[..] else { return Err("give the name of a rig and a record".into()) };
    let mut rig = Rig::published(rig)?;
    let loaded = load(&mut rig, &[&Origin::File(record.into())], &Map::default())?;
    let record = loaded.records.into_iter().next().ok_or("the record cannot be used")?;
    let dynamics = rig.plant.prepare(&rig.choices)?;
    let base = rig.base();
    let coordinate = |index: &usize| FreeParameter {
        handle: Unknown::Parameter(*index),
        bounds: (f64::NEG_INFINITY, f64::INFINITY),
        prior: None,
    };
    let start: Vec<f64> = rig.plant.states.iter().map(|state| state.start).collect();
    let point = Estimate {
        parameters: rig.parameters.clone(),
        inputs: vec![Correction::default(); rig.plant.inputs.len()],
        outputs: vec![Correction::default(); rig.plant.outputs.len()],
        starts: vec![start; record.sections.len()],
    };
    let records = [record];
    let sigma = vec![1.0; rig.plant.outputs.len()];
    let fit = Fit::new(&rig.plant, &*dynamics, &records, base.iter().map(coordinate).collect(), sigma);
    let mut times = Vec::new();
    let mut information = Vec::new();
    for _ in 0..RUNS {
        let clock = Instant::now();
        let (linear, _) = fit.linearise(&point);
        times.push(clock.elapsed().as_secs_f64());
        information = linear.column_norms().iter().map(|norm| norm * norm).collect();
    }
    times.sort_by(f64::total_cmp);
    let names: Vec<&str> = base.iter().map(|index| rig.plant.parameters[*index].name.as_str()).collect();
    let signals: Vec<&str> =
        records[0].measured.iter().map(|it| rig.plant.outputs[it.output].name.as_str()).collect();
    let told = serde_json::json!({
        "seconds": times[RUNS / 2],
        "samples": records[0].len(),
        "parameters": names,
        "signals": signals,
        "information": information,
    });
    println!("{told}");
    Ok(())
}
