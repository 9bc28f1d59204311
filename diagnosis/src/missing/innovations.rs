//! Records and candidates through the same filter: what is left is white, and its sums of squares are likelihoods.

use std::ops::Range;

use rayon::prelude::*;

use super::filter::{Filter, Passed, Smoothed, smoothed};
use super::likelihood::Sums;
use super::ports::{Entry, Port};
use super::trajectory::{MEMORY, ROUNDING, Setting, Window};

/// Measurements of which the innovations are summed in one go.
const TOGETHER: usize = 256;

/// How much signal is missing at each port, and how noisy each output is.
#[derive(Clone, Debug, PartialEq)]
pub struct Noise {
    /// Standard deviation of each port's missing signal, in its unit; zero: none is missing there.
    pub ports: Vec<f64>,
    /// Variance of each measured output's noise.
    pub outputs: Vec<f64>,
    /// Length of simulations in seconds, if states follow from their starts and the inputs alone: innovations are the errors of the
    /// simulations then.
    pub simulated: Option<f64>,
}

/// What a candidate changes in the next state and in the outputs, along a trajectory.
#[derive(Clone, Debug, Default)]
pub struct Column {
    /// Sample by sample and state by state; empty: nothing.
    pub next: Vec<f32>,
    /// Sample by sample and output by output; empty: nothing.
    pub outputs: Vec<f32>,
}

impl Column {
    /// The difference from another one.
    pub fn minus(&self, other: &Self) -> Self {
        let minus = |one: &[f32], two: &[f32]| one.iter().zip(two).map(|(one, two)| one - two).collect();
        Self { next: minus(&self.next, &other.next), outputs: minus(&self.outputs, &other.outputs) }
    }
}

impl Window {
    /// What laws and inputs add to the variances; nothing where a model is simulated.
    fn loose(&self, noise: &Noise) -> [&[f64]; 2] {
        let (next, outputs) = &self.loose;
        if noise.simulated.is_some() { [&[]; 2] } else { [next, outputs] }
    }

    /// Variance of an output's noise at a sample.
    fn noise(&self, noise: &Noise, sample: usize, output: usize) -> f64 {
        let [_, loose] = self.loose(noise);
        noise.outputs[output] + loose.get(sample * self.outputs + output).unwrap_or(&0.0)
    }

    /// Variances of what drives states and ports after a sample.
    fn driven<'a>(&self, noise: &Noise, driven: &[f64], sample: usize, all: &'a mut Vec<f64>) -> &'a [f64] {
        all.clear();
        all.extend_from_slice(driven);
        let [loose, _] = self.loose(noise);
        let loose = loose.iter().skip(sample * self.states);
        all[..self.states].iter_mut().zip(loose).for_each(|(own, more)| *own += more);
        all
    }
}

/// Candidates that pass the filter beside the record.
#[derive(Clone, Copy, Debug, Default)]
pub struct Columns<'a> {
    /// All their columns, in each window.
    pub windows: &'a [Vec<Column>],
    /// The range of columns of each candidate.
    pub candidates: &'a [Range<usize>],
}

/// Sums over a window's innovations.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// Number of the record.
    pub record: usize,
    /// Sums over the innovations of the record, of what parameters and timing change, and of the candidates.
    pub sums: Sums,
}

impl Stretch {
    /// Sums over some of the records, by their numbers; none of no record.
    pub fn total(stretches: &[Self], of: impl Fn(usize) -> bool) -> Option<Sums> {
        Sums::of(stretches.iter().filter(|it| of(it.record)).map(|it| &it.sums))
    }
}

/// Which of a window's ports are in the filter, and how their signals show.
struct Entered<'a> {
    window: &'a Window,
    /// For each active port: its column among the slopes, or the output that it offsets; and its standard deviation.
    ports: Vec<(Result<usize, usize>, f64)>,
}

impl<'a> Entered<'a> {
    fn new(window: &'a Window, ports: &[Port], noise: &Noise) -> Self {
        let mut column = window.states;
        let mut entered = Vec::new();
        for (port, deviation) in ports.iter().zip(&noise.ports) {
            let place = match port.entry {
                Entry::Sensor(row) => Err(row),
                Entry::Constant(_) | Entry::Input(_) => {
                    column += 1;
                    Ok(column - 1)
                }
            };
            if *deviation > 0.0 {
                entered.push((place, *deviation));
            }
        }
        Self { window, ports: entered }
    }

    fn width(&self) -> usize {
        self.window.states + self.ports.len()
    }

    /// How states and active ports show in an output.
    fn row(&self, sample: usize, output: usize, h: &mut [f64]) {
        let (n, width) = (self.window.states, self.window.width);
        let slopes = &self.window.output_slopes[(sample * self.window.outputs + output) * width..][..width];
        h[..n].copy_from_slice(&slopes[..n]);
        for ((place, _), h) in self.ports.iter().zip(&mut h[n..]) {
            *h = match place {
                Ok(column) => slopes[*column],
                Err(row) => f64::from(*row == output),
            };
        }
    }

    /// The transition of states and active ports to the next sample.
    fn transition(&self, sample: usize, decay: f64, a: &mut [f64]) {
        let (n, width, own) = (self.window.states, self.window.width, self.width());
        a.fill(0.0);
        for state in 0..n {
            let slopes = &self.window.next_slopes[(sample * n + state) * width..][..width];
            let row = &mut a[state * own..(state + 1) * own];
            row[..n].copy_from_slice(&slopes[..n]);
            for ((place, _), a) in self.ports.iter().zip(&mut row[n..]) {
                *a = place.map_or(0.0, |column| slopes[column]);
            }
        }
        for port in n..own {
            a[port * own + port] = decay;
        }
    }
}

impl Setting<'_> {
    /// Variances of the states at a window's start, then of the active ports.
    fn variances(&self, entered: &Entered<'_>) -> Vec<f64> {
        let states = self.active.iter().map(|it| self.state_sizes[*it].powi(2));
        states.chain(entered.ports.iter().map(|(_, deviation)| deviation * deviation)).collect()
    }

    fn driven(&self, entered: &Entered<'_>, noise: &Noise, decay: f64) -> Vec<f64> {
        let rounding = if noise.simulated.is_some() { 0.0 } else { ROUNDING };
        let states = self.active.iter().map(|it| (rounding * self.state_sizes[*it]).powi(2));
        let ports = entered.ports.iter().map(|(_, deviation)| deviation * deviation * (1.0 - decay * decay));
        states.chain(ports).collect()
    }

    /// The record of each window, the change by each parameter, and the candidates through the filter.
    pub fn innovations(&self, windows: &[Window], noise: &Noise, beside: Columns<'_>) -> Vec<Stretch> {
        let parts = windows.par_iter().enumerate();
        let of = |(index, window): (usize, &Window)| {
            let columns = beside.windows.get(index).map_or(&[][..], |it| it);
            let sums = self.through(window, noise, (columns, beside.candidates));
            Stretch { record: window.record, sums }
        };
        parts.map(of).collect()
    }

    fn through(
        &self,
        window: &Window,
        noise: &Noise,
        (candidates, ranges): (&[Column], &[Range<usize>]),
    ) -> Sums {
        let entered = Entered::new(window, self.ports, noise);
        let (n, m, width, own) = (window.states, window.outputs, window.width, entered.width());
        let decay = (-window.step / MEMORY).exp();
        let parameters = self.parameters.len();
        let known = 1 + parameters + window.timing.len();
        let columns = known + candidates.len();
        let start = self.variances(&entered);
        let mut filter = Filter::new(&start, columns);
        let restart = noise.simulated.map_or(usize::MAX, |length| ((length / window.step) as usize).max(2));
        let (driven, mut spread) = (self.driven(&entered, noise, decay), Vec::new());
        let samples = window.samples.len();
        let (mut h, mut a) = (vec![0.0; own], vec![0.0; own * own]);
        let (mut y, mut input) = (vec![0.0; columns], vec![0.0; own * columns]);
        let mut rows: Vec<f64> = Vec::with_capacity(columns * (TOGETHER + m));
        let mut sums = Sums::none(known, ranges);
        let mut log_variance = 0.0;
        for sample in 0..samples {
            if sample % restart == 0 {
                filter = Filter::new(&start, columns);
            }
            for output in 0..m {
                let residual = window.residuals[sample * m + output];
                if !residual.is_finite() {
                    continue;
                }
                entered.row(sample, output, &mut h);
                let slopes = &window.output_slopes[(sample * m + output) * width..][..width];
                y[0] = residual;
                for (y, slope) in y[1..=parameters].iter_mut().zip(&slopes[width - parameters..]) {
                    *y = -slope;
                }
                for (y, column) in y[1 + parameters..].iter_mut().zip(window.timing.iter().chain(candidates))
                {
                    *y = column.outputs.get(sample * m + output).map_or(0.0, |it| -f64::from(*it));
                }
                let update = filter.measure(&h, window.noise(noise, sample, output), &mut y);
                let scale = update.variance.sqrt().recip();
                rows.extend(y.iter().map(|it| it * scale));
                log_variance += update.variance.ln();
            }
            if rows.len() >= columns * TOGETHER || sample + 1 == samples {
                sums.take(&rows, log_variance);
                rows.clear();
                log_variance = 0.0;
            }
            if sample + 1 == samples {
                break;
            }
            for state in 0..n {
                let input = &mut input[state * columns..(state + 1) * columns];
                input[0] = window.defects[sample * n + state];
                let slopes = &window.next_slopes[(sample * n + state) * width..][..width];
                input[1..=parameters].copy_from_slice(&slopes[width - parameters..]);
                for (input, column) in
                    input[1 + parameters..].iter_mut().zip(window.timing.iter().chain(candidates))
                {
                    *input = column.next.get(sample * n + state).map_or(0.0, |it| f64::from(*it));
                }
            }
            entered.transition(sample, decay, &mut a);
            filter.predict(&a, &input, window.driven(noise, &driven, sample, &mut spread));
        }
        sums
    }

    /// The deviation from the trajectory and the missing signals of a window by all its data: states first, then the ports
    /// that are in the filter. What is known beside, parameters and candidates times their amounts, is taken off.
    pub fn smoothed(
        &self,
        window: &Window,
        noise: &Noise,
        known: &[(f64, &Column)],
        moved: &[f64],
    ) -> Vec<Smoothed> {
        let entered = Entered::new(window, self.ports, noise);
        let (n, m, width, own) = (window.states, window.outputs, window.width, entered.width());
        let decay = (-window.step / MEMORY).exp();
        let mut filter = Filter::new(&self.variances(&entered), 1);
        let (driven, mut spread) = (self.driven(&entered, noise, decay), Vec::new());
        let samples = window.samples.len();
        let mut passed = Vec::with_capacity(samples);
        let parameters = |slopes: &[f64]| -> f64 {
            slopes[width - self.parameters.len()..].iter().zip(moved).map(|(slope, by)| slope * by).sum()
        };
        for sample in 0..samples {
            let mut at = Passed { x: filter.x.clone(), p: filter.p.clone(), ..Passed::default() };
            for output in 0..m {
                let place = sample * m + output;
                let residual = window.residuals[place];
                if !residual.is_finite() {
                    continue;
                }
                let mut h = vec![0.0; own];
                entered.row(sample, output, &mut h);
                let taken: f64 = known
                    .iter()
                    .map(|(amount, column)| {
                        amount * column.outputs.get(place).map_or(0.0, |it| f64::from(*it))
                    })
                    .sum();
                let mut y = [residual - taken - parameters(&window.output_slopes[place * width..][..width])];
                let update = filter.measure(&h, window.noise(noise, sample, output), &mut y);
                at.measured.push((h, filter.gain().to_vec(), y[0], update.variance));
            }
            if sample + 1 < samples {
                let mut a = vec![0.0; own * own];
                entered.transition(sample, decay, &mut a);
                let mut input = vec![0.0; own];
                for (state, input) in input[..n].iter_mut().enumerate() {
                    let place = sample * n + state;
                    let taken: f64 = known
                        .iter()
                        .map(|(amount, column)| {
                            amount * column.next.get(place).map_or(0.0, |it| f64::from(*it))
                        })
                        .sum();
                    *input = window.defects[place]
                        + taken
                        + parameters(&window.next_slopes[place * width..][..width]);
                }
                filter.predict(&a, &input, window.driven(noise, &driven, sample, &mut spread));
                at.a = a;
            }
            passed.push(at);
        }
        smoothed(&passed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimation::unknowns::Estimate;
    use crate::plant::Drive;
    use crate::rig::Rig;

    const DECAY: f64 = 0.9;

    /// A state that is measured, and decays: what drives it and what is measured beside it are given.
    fn window(defects: &[f64], residuals: &[f64]) -> Window {
        let samples = residuals.len();
        Window {
            record: 0,
            samples: 0..samples,
            step: 0.01,
            states: 1,
            outputs: 1,
            width: 1,
            trajectory: vec![vec![0.0]; samples],
            next_slopes: vec![DECAY; samples - 1],
            output_slopes: vec![1.0; samples],
            defects: defects.to_vec(),
            rates: vec![0.0; samples],
            predicted: vec![0.0; samples],
            residuals: residuals.to_vec(),
            drive: Drive::sampled(0.01, vec![]),
            timing: vec![],
            lawful: None,
            loose: (vec![1.0; samples - 1], vec![1.0; samples]),
            pushes: vec![],
        }
    }

    /// Of a simulation from a known start nothing is corrected: its errors are those of all that has driven it by then.
    #[test]
    fn a_simulations_innovations_are_its_errors() {
        let rig = Rig::published("quarter-car").unwrap();
        let dynamics = rig.plant.prepare(&rig.choices).unwrap();
        let setting = Setting {
            dynamics: &*dynamics,
            point: Estimate { parameters: vec![], inputs: vec![], outputs: vec![], starts: vec![] },
            ports: &[],
            parameters: &[],
            state_sizes: vec![1e-9],
            active: vec![0],
            ties: vec![],
            sizes: vec![],
            free: vec![],
            noise: vec![0.01],
            floors: vec![0.01],
            magnitudes: vec![1.0],
        };
        let drives = [0.3, -0.2, 0.5, 0.0, 0.1];
        let measured = [0.1, 0.0, -0.4, 0.2, 0.3, -0.1];
        let window = window(&drives, &measured);
        // The candidate is what drives it, so that nothing but what is measured is left with it.
        let candidate = Column { next: drives.map(|it| it as f32).to_vec(), outputs: vec![] };
        let (columns, only) = ([vec![candidate]], 0..1);
        let normal = |length: f64| {
            let noise = Noise { ports: vec![], outputs: vec![0.25], simulated: Some(length) };
            let beside = Columns { windows: &columns, candidates: std::slice::from_ref(&only) };
            let stretches = setting.innovations(std::slice::from_ref(&window), &noise, beside);
            Stretch::total(&stretches, |_| true).unwrap().with(0)
        };
        let squares = |restart: usize| {
            let (mut state, mut all) = (0.0, 0.0);
            for (k, measured) in measured.iter().enumerate() {
                state = if k % restart == 0 { 0.0 } else { DECAY * state + drives[k - 1] };
                all += (measured - state).powi(2) / 0.25;
            }
            all
        };
        for (length, restart) in [(1.0, 6), (0.03, 3)] {
            let sum = normal(length).products[(0, 0)];
            assert!((sum - squares(restart)).abs() < 1e-5, "{sum} and {}", squares(restart));
        }
        let without = normal(1.0).moved(&[-1.0]).products[(0, 0)];
        let left: f64 = measured.iter().map(|it| it * it / 0.25).sum();
        assert!((without - left).abs() < 1e-5, "{without} and {left}");
    }
}
