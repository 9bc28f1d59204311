//! Features of a port's own motion, of commands and of time, in groups that say what a missing signal depends on.

use std::ops::Range;

use crate::dataset::recorded::Dataset;
use crate::missing::motion::Motion;
use crate::missing::trajectory::Window;
use crate::signal::derivative;

use super::resonance::Oscillator;

/// Knots of a curve over a variable …
const KNOTS: usize = 9;
/// … and over one of two.
const FEWER_KNOTS: usize = 7;
/// Times in seconds in which the heat of a damper's work is gone.
const COOLING: [f64; 3] = [2.0, 8.0, 30.0];
/// Time constants of memories in seconds.
const MEMORIES: [f64; 5] = [0.003, 0.01, 0.03, 0.1, 0.3];
/// Lags in seconds with which what another column says may act: a coil's current follows its voltage.
const LAGS: [f64; 3] = [0.0, 0.01, 0.05];
/// Shares of a velocity's root mean square within which friction turns over.
const TURNS: [f64; 3] = [0.02, 0.1, 0.3];

/// A law of deflection, velocity, and a velocity that is small there.
type Law = fn(f64, f64, f64) -> f64;

/// Laws whose size grows or falls with time, with the motion that each follows.
pub const AGEING: [(Option<&str>, Law); 4] = [
    (None, |_, _, _| 1.0),
    (Some("deflection"), |x, _, _| x),
    (Some("velocity"), |_, v, _| v),
    (Some("velocity"), |_, v, small| (v / small).tanh()),
];

/// What a missing signal may depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Group {
    /// Any curve over the deflection.
    Deflection,
    /// Any curve over the velocity.
    Velocity,
    /// In proportion to the acceleration.
    Acceleration,
    /// What remembers the velocity for some time.
    Memory,
    /// An oscillator that the motion drives.
    Resonance(Oscillator),
    /// Damping and friction that are any curve over the deflection.
    DeflectionAndVelocity,
    /// Damping and friction in proportion to the work that was done before and has not cooled off yet.
    Heat,
    /// The laws of [`AGEING`].
    Time,
    /// A command, by the input's index: its curve and its rate.
    Command(usize),
    /// A column that no signal of the rig is, by its place among the record's: itself, and laws that grow with it.
    Other(usize),
}

impl Group {
    /// All of a port, with so many columns that no signal of the rig is.
    pub fn all(commands: &[usize], others: usize) -> Vec<Self> {
        let resonances = Oscillator::first().map(Self::Resonance);
        let commands = commands.iter().map(|it| Self::Command(*it));
        Self::OF_MOTION
            .into_iter()
            .chain(resonances)
            .chain(commands)
            .chain((0..others).map(Self::Other))
            .collect()
    }

    /// Curves over a motion, all that is tried of a further output: all features of all outputs would not fit into memory.
    pub const CURVES: [Self; 3] = [Self::Deflection, Self::Velocity, Self::DeflectionAndVelocity];

    /// Those of a port's own motion and of time.
    const OF_MOTION: [Self; 7] = [
        Self::Deflection,
        Self::Velocity,
        Self::Acceleration,
        Self::Memory,
        Self::DeflectionAndVelocity,
        Self::Heat,
        Self::Time,
    ];
}

/// Features of one group at a port over several windows: signals by feature, each over all windows.
pub fn features(
    group: Group,
    motions: &[Motion],
    (records, windows): (&[Dataset], &[Window]),
) -> Vec<Vec<Vec<f64>>> {
    let over =
        |of: &dyn Fn(&Motion) -> &Vec<f64>| motions.iter().map(|it| of(it).clone()).collect::<Vec<_>>();
    let (x, v) = (over(&|it| &it.deflection), over(&|it| &it.velocity));
    let each = |f: &dyn Fn(f64, f64) -> f64| -> Vec<Vec<f64>> {
        x.iter().zip(&v).map(|(x, v)| x.iter().zip(v).map(|(x, v)| f(*x, *v)).collect()).collect()
    };
    match group {
        Group::Deflection => hats(&x, KNOTS),
        Group::Velocity => {
            let size = size(&v);
            let steps = TURNS.iter().map(|share| each(&|_, v| (v / (share * size)).tanh()));
            hats(&v, KNOTS).into_iter().chain(steps).collect()
        }
        Group::Acceleration => {
            let rate = |(v, window): (&Vec<f64>, &Window)| records[window.record].rate_of(v);
            vec![v.iter().zip(windows).map(rate).collect()]
        }
        Group::Memory => MEMORIES
            .iter()
            .map(|time| {
                v.iter().zip(windows).map(|(v, window)| relaxed(v, 0.0, *time, window.step)).collect()
            })
            .collect(),
        Group::Resonance(oscillator) => {
            let both: Vec<[Vec<f64>; 2]> =
                v.iter().zip(windows).map(|(v, window)| oscillator.forces(v, window.step)).collect();
            (0..2).map(|part| both.iter().map(|it| it[part].clone()).collect()).collect()
        }
        Group::DeflectionAndVelocity => {
            let fast = 0.1 * size(&v);
            let laws = [each(&|_, v| v), each(&|_, v| (v / fast).tanh())];
            let here = hats(&x, FEWER_KNOTS);
            let there = laws.iter().flat_map(|law| here.iter().map(|hat| product(hat, law)));
            std::iter::once(each(&|x, v| x * v.abs())).chain(there).collect()
        }
        Group::Heat => {
            let fast = 0.1 * size(&v);
            let laws = [each(&|_, v| v), each(&|_, v| (v / fast).tanh())];
            let power = each(&|_, v| v * v);
            let span = |it: &Window| (it.record, it.samples.clone(), it.step);
            let spans: Vec<Span> = windows.iter().map(span).collect();
            let heat = COOLING.map(|time| heated(&power, time, &spans));
            heat.iter().flat_map(|heat| laws.iter().map(|law| product(heat, law))).collect()
        }
        Group::Time => {
            let fast = 0.1 * size(&v);
            let timed = |f: &dyn Fn(f64, f64) -> f64| -> Vec<Vec<f64>> {
                let mut all = each(f);
                for (values, window) in all.iter_mut().zip(windows) {
                    for (k, value) in values.iter_mut().enumerate() {
                        *value *= window.step * (window.samples.start + k) as f64;
                    }
                }
                all
            };
            AGEING.map(|(_, law)| timed(&|x, v| law(x, v, fast))).to_vec()
        }
        Group::Command(input) => {
            let u: Vec<Vec<f64>> = windows
                .iter()
                .map(|window| {
                    window.drive.inputs[input].iter().step_by(window.drive.finer).copied().collect()
                })
                .collect();
            let size = size(&u);
            let of = |f: &dyn Fn(f64) -> f64| -> Vec<Vec<f64>> {
                u.iter().map(|u| u.iter().map(|u| f(*u)).collect()).collect()
            };
            let rate = u.iter().zip(windows).map(|(u, window)| derivative(u, window.step)).collect();
            vec![of(&|u| u), of(&|u| u * u.abs() / size), of(&|u| u * u / size), rate]
        }
        Group::Other(number) => {
            let column =
                |window: &Window| &records[window.record].others[number].values[window.samples.clone()];
            let fast = size(&v);
            // What a lag changes, rather than the late column: of one that hardly moves all copies would be the same, and the
            // amounts of each, one against the other, as large as one likes.
            let late = LAGS.iter().flat_map(|lag| {
                let follow = |window: &Window| match (column(window), *lag) {
                    (now, 0.0) => now.to_vec(),
                    (now, lag) => followed(now, lag, window.step)
                        .iter()
                        .zip(now)
                        .map(|(late, now)| late - now)
                        .collect(),
                };
                let c: Vec<Vec<f64>> = windows.iter().map(follow).collect();
                let of = |f: &dyn Fn(f64) -> f64| -> Vec<Vec<f64>> {
                    let both = c.iter().zip(&v);
                    both.map(|(c, v)| c.iter().zip(v).map(|(c, v)| c * f(*v)).collect()).collect()
                };
                let turned = TURNS.map(|share| of(&|v| (v / (share * fast)).tanh()));
                [of(&|_| 1.0), of(&|v| v)].into_iter().chain(turned)
            });
            late.collect()
        }
    }
}

/// Root mean square over all windows.
fn size(signals: &[Vec<f64>]) -> f64 {
    let count = signals.iter().map(Vec::len).sum::<usize>().max(1) as f64;
    (signals.iter().flatten().map(|it| it * it).sum::<f64>() / count).sqrt().max(f64::MIN_POSITIVE)
}

/// The product of two signals, sample by sample, over all windows.
fn product(one: &[Vec<f64>], other: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let of = |(one, other): (&Vec<f64>, &Vec<f64>)| one.iter().zip(other).map(|(a, b)| a * b).collect();
    one.iter().zip(other).map(of).collect()
}

/// Hat functions between quantiles of a variable: any curve that is straight between them.
fn hats(signals: &[Vec<f64>], count: usize) -> Vec<Vec<Vec<f64>>> {
    let mut sorted: Vec<f64> = signals.iter().flatten().copied().collect();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return Vec::new() };
    let mut knots: Vec<f64> = (0..count)
        .map(|knot| {
            // Denser at the ends, where few samples are and most is to be seen.
            let share = 0.5 - 0.5 * (std::f64::consts::PI * knot as f64 / (count - 1) as f64).cos();
            sorted[(share * last as f64).round() as usize]
        })
        .collect();
    knots.dedup();
    let hat = |knot: usize, value: f64| {
        let here = knots[knot];
        let side =
            if value < here { knot.checked_sub(1) } else { Some(knot + 1).filter(|it| *it < knots.len()) };
        match side {
            Some(other) => (1.0 - (value - here) / (knots[other] - here)).max(0.0),
            None => 1.0,
        }
    };
    (0..knots.len())
        .map(|knot| signals.iter().map(|values| values.iter().map(|it| hat(knot, *it)).collect()).collect())
        .collect()
}

/// `τ y' = c − y`, from rest at the first value; the value itself without a lag.
fn followed(values: &[f64], lag: f64, step: f64) -> Vec<f64> {
    let weight = if lag > 0.0 { 1.0 - (-step / lag).exp() } else { 1.0 };
    let mut y = values.first().copied().unwrap_or_default();
    values
        .iter()
        .map(|value| {
            y += weight * (value - y);
            y
        })
        .collect()
}

/// `y' = u − y/τ`, from a start.
fn relaxed(input: &[f64], start: f64, time: f64, step: f64) -> Vec<f64> {
    let decay = (-step / time).exp();
    let mut y = start;
    input
        .iter()
        .map(|u| {
            y = decay * y + time * (1.0 - decay) * u;
            y
        })
        .collect()
}

/// A stretch of a record: the record's number, its samples, and their distance in seconds.
type Span = (usize, Range<usize>, f64);

/// Heat of a power, `y' = p − y/τ`, over stretches of records, from none at each record's first one; where a record was not looked
/// at, the power is the mean of the stretch before.
fn heated(power: &[Vec<f64>], time: f64, spans: &[Span]) -> Vec<Vec<f64>> {
    let mut all: Vec<Vec<f64>> = Vec::with_capacity(power.len());
    let mut before: Option<(&Span, f64, f64)> = None;
    for (power, span) in power.iter().zip(spans) {
        let (record, samples, step) = span;
        let same = before.filter(|((last, ..), ..)| last == record);
        let start = same.map_or(0.0, |((_, last, _), heat, mean)| {
            let kept = (-(samples.start.saturating_sub(last.end) as f64) * step / time).exp();
            kept * heat + time * (1.0 - kept) * mean
        });
        let heat = relaxed(power, start, time, *step);
        let mean = power.iter().sum::<f64>() / power.len().max(1) as f64;
        before = Some((span, heat.last().copied().unwrap_or(start), mean));
        all.push(heat);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Constant power warms up by `p τ (1 − exp(−t/τ))`, also over stretches that were not looked at; another record is cold.
    #[test]
    fn heat_goes_on_from_stretch_to_stretch() {
        const STEP: f64 = 0.01;
        let spans = [(0, 0..100, STEP), (0, 100..250, STEP), (0, 400..500, STEP), (1, 0..100, STEP)];
        let power: Vec<Vec<f64>> = spans.iter().map(|(_, samples, _)| vec![3.0; samples.len()]).collect();
        let heat = heated(&power, 2.0, &spans);
        for ((_, samples, _), heat) in spans.iter().zip(&heat) {
            for (sample, heat) in samples.clone().zip(heat) {
                let exact = 6.0 * (1.0 - (-((sample + 1) as f64) * STEP / 2.0).exp());
                assert!((heat - exact).abs() < 1e-9, "{sample}: {heat} {exact}");
            }
        }
    }

    #[test]
    fn hats_add_up_to_one() {
        let signals = vec![(0..200).map(|k| (0.1 * f64::from(k)).sin()).collect::<Vec<f64>>()];
        for count in [FEWER_KNOTS, KNOTS] {
            let all = hats(&signals, count);
            assert_eq!(all.len(), count);
            let sum = |sample: usize| all.iter().map(|hat| hat[0][sample]).sum::<f64>();
            assert!((0..200).all(|sample| (sum(sample) - 1.0).abs() < 1e-12));
        }
    }
}
