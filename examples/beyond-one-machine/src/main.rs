//! The sweep of `sweep.py` in one process: the equations of the QuarterCar for four sets of parameters at
//! once, on all cores.
//!
//! `sweep SETS.csv --out PEAKS.csv [--threads N] [--scalar]`; a set that cannot be computed has empty peaks.

use std::path::{Path, PathBuf};
use std::time;

use clap::Parser;
use rayon::prelude::*;
use strut_model::{Bundle, Declarations, Instant, Lanes, Model, Real, Settings};
use strut_physics::rigs::QuarterCar;

/// Height of the kerb in m.
const KERB: f64 = 0.02;
/// Time between two looks at the outputs, in s.
const SAMPLE: f64 = 5e-3;
/// End, in s.
const STOP: f64 = 2.0;
/// Steps of the classical Runge–Kutta method between two looks. The fastest mode, the wheel on its tyre,
/// has 100 rad/s: h ω = 0.05 leaves an error of 1e-7 of the amplitude in a period.
const STEPS: usize = 10;

const OUTPUTS: [&str; 3] = ["body.acceleration", "suspension.deflection", "wheel.force"];

/// The sweep of sweep.py in one process.
#[derive(Parser)]
struct Cli {
    /// Sets of parameters: a CSV file with the parameters' names as its header
    sets: PathBuf,
    /// Where the peaks go, as CSV
    #[arg(long)]
    out: PathBuf,
    /// Threads; all cores if it is not given
    #[arg(long, default_value_t = 0)]
    threads: usize,
    /// One set at a time instead of four
    #[arg(long)]
    scalar: bool,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let cli = Cli::parse();
    let (names, sets) = read(&cli.sets)?;
    let declared = Declarations::of::<<QuarterCar as Model>::Parameters<f64>>();
    let columns = names
        .iter()
        .map(|name| {
            declared
                .iter()
                .position(|declaration| declaration.name == *name)
                .ok_or_else(|| format!("{}: the QuarterCar has no parameter `{name}`", cli.sets.display()))
        })
        .collect::<Result<Vec<usize>, String>>()?;
    let starts: Vec<f64> = declared.iter().map(|declaration| declaration.start).collect();
    let full: Vec<Vec<f64>> = sets
        .iter()
        .map(|set| {
            let mut numbers = starts.clone();
            columns.iter().zip(set).for_each(|(column, value)| numbers[*column] = *value);
            numbers
        })
        .collect();
    let rig = QuarterCar::prepare(&<QuarterCar as Model>::Settings::starts(), None)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(cli.threads).build()?;
    let clock = time::Instant::now();
    let peaks: Vec<[f64; 3]> = pool.install(|| {
        if cli.scalar {
            full.par_iter().map(|set| peaks::<f64>(&rig, |index| set[index])).collect()
        } else {
            full.par_chunks(Lanes::COUNT).flat_map_iter(|sets| four(&rig, sets)).collect()
        }
    });
    let seconds = clock.elapsed().as_secs_f64();
    write(&cli.out, &peaks)?;
    println!(
        "{} sets on {} threads, {} at a time: {seconds:.4} s, results in {}",
        peaks.len(),
        pool.current_num_threads(),
        if cli.scalar { 1 } else { Lanes::COUNT },
        cli.out.display()
    );
    Ok(())
}

/// Up to four sets, the last one again where there are fewer.
fn four<'a>(rig: &QuarterCar, sets: &'a [Vec<f64>]) -> impl Iterator<Item = [f64; 3]> + use<'a> {
    let lane = |lane: usize| &sets[lane.min(sets.len() - 1)];
    let peaks = peaks(rig, |index| Lanes::new(std::array::from_fn(|number| lane(number)[index])))
        .map(Lanes::to_array);
    (0..sets.len()).map(move |lane| peaks.map(|peak| peak[lane]))
}

/// The largest magnitudes of the outputs after the kerb.
fn peaks<R: Real>(rig: &QuarterCar, parameter: impl Fn(usize) -> R) -> [R; 3] {
    type State<R> = <QuarterCar as Model>::State<R>;
    let parameters = Bundle::from_fn(parameter);
    let derived = rig.derive(&parameters);
    let declared = Declarations::of::<<QuarterCar as Model>::Input<f64>>();
    let kerb = |index: usize| if declared[index].name == "road.position" { KERB } else { 0.0 };
    let input = <QuarterCar as Model>::Input::<R>::from_fn(|index| R::from(kerb(index)));
    let memory = Bundle::from_fn(|_| R::from(0.0));
    let equations = |state: &State<R>| {
        rig.equations(Instant {
            time: R::from(0.0),
            state,
            input: &input,
            parameters: &parameters,
            derived: &derived,
            memory: &memory,
            tick: 0,
        })
    };
    let outputs = Declarations::of::<<QuarterCar as Model>::Output<f64>>();
    let looked_at = OUTPUTS.map(|name| {
        outputs.iter().position(|declaration| declaration.name == name).expect("the rig has this output")
    });
    let starts = Declarations::of::<State<f64>>();
    let mut state = State::<R>::from_fn(|index| R::from(starts[index].start));
    let mut peaks = [R::from(0.0); 3];
    let step = SAMPLE / STEPS as f64;
    for sample in 0..=(STOP / SAMPLE).round() as usize {
        if sample > 0 {
            for _ in 0..STEPS {
                state = runge_kutta(&state, step, |state| equations(state).0);
            }
        }
        equations(&state).1.for_each(|index, value| {
            for (peak, wanted) in peaks.iter_mut().zip(looked_at) {
                if index == wanted {
                    let size = value.select(value, -value);
                    // What is no number stays none.
                    *peak = (size - *peak).select(size, *peak) + size * 0.0;
                }
            }
        });
    }
    peaks
}

/// A step of the classical method.
fn runge_kutta<R: Real, B: Bundle<R>>(x: &B, h: f64, rates: impl Fn(&B) -> B) -> B {
    let k1 = rates(x);
    let k2 = rates(&moved(x, &k1, 0.5 * h));
    let k3 = rates(&moved(x, &k2, 0.5 * h));
    let k4 = rates(&moved(x, &k3, h));
    let middle = moved(&k2, &k3, 1.0);
    let sum = moved(&moved(&k1, &k4, 1.0), &middle, 2.0);
    moved(x, &sum, h / 6.0)
}

/// `x + h k`
fn moved<R: Real, B: Bundle<R>>(x: &B, k: &B, h: f64) -> B {
    let mut sum = [R::from(0.0); 64];
    x.for_each(|index, value| sum[index] = value);
    k.for_each(|index, value| sum[index] += value * h);
    B::from_fn(|index| sum[index])
}

fn read(path: &Path) -> Result<(Vec<String>, Vec<Vec<f64>>), String> {
    let wrong = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let mut reader = csv::Reader::from_path(path).map_err(|error| wrong(&error))?;
    let names = reader.headers().map_err(|error| wrong(&error))?.iter().map(str::to_owned).collect();
    let sets = reader.deserialize().collect::<Result<_, _>>().map_err(|error| wrong(&error))?;
    Ok((names, sets))
}

fn write(path: &Path, peaks: &[[f64; 3]]) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_path(path)?;
    writer.write_record(OUTPUTS.map(|name| format!("peak {name}")))?;
    for row in peaks {
        writer
            .write_record(row.map(|peak| if peak.is_finite() { peak.to_string() } else { String::new() }))?;
    }
    Ok(writer.flush()?)
}
