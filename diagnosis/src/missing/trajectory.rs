//! The trajectory that a rig has taken by all its sensors, and the model's one-sample predictions about it.

use std::borrow::Cow;
use std::ops::Range;

use crate::dataset::recorded::{Dataset, Source};
use crate::diagnosis::root_mean_square;
use crate::estimation::unknowns::Estimate;
use crate::plant::{Drive, Dynamics, Follower, Seed, Seen};
use crate::screening::rms;

use super::filter::{Filter, Passed, Smoothed, smoothed};
use super::innovations::Column;
use super::look::Look;
use super::ports::{Entry, Port};

/// Time in which a missing signal forgets what it was, in seconds: it may change as fast as a rig's own motions.
pub const MEMORY: f64 = 0.3;
/// Samples over which the states that matter are looked for.
const LOOK: usize = 400;
/// Standard deviations of its noise to which a sensor is believed: what filters and even sampling do to a signal is as large.
const BELIEVED: f64 = 2.0;
/// Resolution of a signal without noise, in shares of its root mean square.
const RESOLUTION: f64 = 1e-4;
/// Share of a state's nominal value by which the model's own integration may be wrong in a sample.
pub const ROUNDING: f64 = 1e-7;

/// What a smoother has to know of a rig and its records.
pub struct Setting<'a> {
    /// The equations.
    pub dynamics: &'a dyn Dynamics,
    /// Values of the parameters, and what inputs pass.
    pub point: Estimate,
    /// Where signals may be missing.
    pub ports: &'a [Port],
    /// Parameters of which derivatives are wanted, by their indices.
    pub parameters: &'a [usize],
    /// Size of each state: its nominal value, or more where sensors show more.
    pub state_sizes: Vec<f64>,
    /// States that show in some measured output, directly or by others.
    pub active: Vec<usize>,
    /// For each port: the first one that does the same to every state and output.
    pub ties: Vec<usize>,
    /// Size of each port's signal that would be as large as what the sensors show.
    pub sizes: Vec<f64>,
    /// Standard deviation of each port's missing signal while the trajectory is smoothed.
    pub free: Vec<f64>,
    /// Variance of each measured output's noise.
    pub noise: Vec<f64>,
    /// Variance of each measured output's noise floor.
    pub floors: Vec<f64>,
    /// Root mean square of each measured output.
    pub magnitudes: Vec<f64>,
}

/// The model's one-sample predictions about a trajectory over a stretch of a record.
pub struct Window {
    /// Number of the record.
    pub record: usize,
    /// Its samples.
    pub samples: Range<usize>,
    /// Time between two samples in seconds.
    pub step: f64,
    /// Number of states that matter.
    pub states: usize,
    /// Number of measured outputs.
    pub outputs: usize,
    /// Number of derivatives: by states, ports of the plant, parameters.
    pub width: usize,
    /// States of the model along the trajectory, all of them, sample by sample.
    pub trajectory: Vec<Vec<f64>>,
    /// Derivatives of the next states, sample by sample and state by state.
    pub next_slopes: Vec<f64>,
    /// Derivatives of the outputs, sample by sample and output by output.
    pub output_slopes: Vec<f64>,
    /// Predicted next states less the trajectory's.
    pub defects: Vec<f64>,
    /// Rates of the states that matter, sample by sample.
    pub rates: Vec<f64>,
    /// Predicted outputs, sample by sample.
    pub predicted: Vec<f64>,
    /// Measured outputs less predicted ones, not a number where they are missing.
    pub residuals: Vec<f64>,
    /// What drives the model.
    pub drive: Drive,
    /// What the timing of each channel changes, which every measurement has a little of.
    pub timing: Vec<Column>,
    /// Rates and predicted outputs with the laws that act beside the model, where there are some.
    pub lawful: Option<(Vec<f64>, Vec<f64>)>,
    /// Variances that laws add to the next states and to the outputs, sample by sample, for the limited accuracy of the
    /// trajectory; empty: none.
    pub loose: (Vec<f64>, Vec<f64>),
    /// Rates of the states that matter by a unit signal at each port of the plant, sample by sample.
    pub pushes: Vec<Vec<f64>>,
}

impl Window {
    /// Rates of the states that matter and predicted outputs, with the laws that act beside the model.
    pub fn plain(&self) -> (&[f64], &[f64]) {
        match &self.lawful {
            Some((rates, outputs)) => (rates, outputs),
            None => (&self.rates, &self.predicted),
        }
    }
}

impl<'a> Setting<'a> {
    /// Looks which states matter and how large missing signals may be.
    pub fn new(
        dynamics: &'a dyn Dynamics,
        (point, start): (&Estimate, &[f64]),
        ports: &'a [Port],
        parameters: &'a [usize],
        nominal: &[f64],
        records: &[Dataset],
    ) -> Self {
        let record = &records[0];
        let section = &record.sections[0];
        let drive = record.drive(&(section.start..section.end.min(section.start + LOOK)), &point.inputs);
        let states = nominal.len();
        let moving = ports.iter().filter_map(|it| it.seed(drive.inputs[0].len()));
        let inputs: Vec<usize> =
            (0..record.inputs.len()).filter(|it| matches!(record.inputs[*it], Source::Measured(_))).collect();
        let driven =
            inputs.iter().map(|input| Seed::Inputs(record.change(*input, drive.inputs[*input].clone())));
        let seeds: Vec<Seed> = (0..states).map(Seed::State).chain(moving).chain(driven).collect();
        let wanted: Vec<usize> = record.measured.iter().map(|it| it.output).collect();
        let mut look = Look::new(seeds.len());
        dynamics.followed(&point.parameters, start, &drive, (&seeds, &wanted), &mut look);
        let active = look.active(states);
        let magnitudes: Vec<f64> = (0..wanted.len()).map(|row| magnitude(records, row)).collect();
        // A nominal value may be of another use of the same state: Modelica's angles have one of 1e-4 rad.
        let seen = |(state, declared): (usize, &f64)| declared.max(look.shown(state, &magnitudes));
        let state_sizes = nominal.iter().enumerate().map(seen).collect();
        let floor = |row: usize| records.iter().map(|it| it.measured[row].noise_floor).fold(0.0, f64::max);
        let floors: Vec<f64> = (0..wanted.len()).map(|row| floor(row).powi(2)).collect();
        let noise = floors.iter().zip(&magnitudes);
        let noise =
            noise.map(|(floor, size)| BELIEVED.powi(2) * floor + (RESOLUTION * size).powi(2)).collect();
        let mut column = states;
        let columns: Vec<Option<usize>> = ports
            .iter()
            .map(|port| {
                column += usize::from(!port.is_sensor());
                (!port.is_sensor()).then(|| column - 1)
            })
            .collect();
        let same = |a: usize, b: usize| match (columns[a], columns[b], ports[b].entry) {
            (Some(a), Some(b), _) => look.same(a, b),
            (Some(a), None, Entry::Sensor(row)) => look.shows_only_in(a) == Some(row),
            _ => a == b,
        };
        let ties =
            (0..ports.len()).map(|port| (0..port).find(|it| same(*it, port)).unwrap_or(port)).collect();
        let inputs = column..seeds.len();
        let changes: Vec<f64> = record.measured.iter().map(|it| change(&it.values)).collect();
        let size = |(port, own): (&Port, &Option<usize>)| match (port.entry, own) {
            (Entry::Sensor(row), _) => magnitudes[row],
            (_, own) => own.map_or(f64::MIN_POSITIVE, |own| look.size(own, &magnitudes, &changes, &inputs)),
        };
        let sizes: Vec<f64> = ports.iter().zip(&columns).map(size).collect();
        let point = point.clone();
        let free = sizes.clone();
        Self {
            dynamics,
            point,
            ports,
            parameters,
            state_sizes,
            active,
            ties,
            sizes,
            free,
            noise,
            floors,
            magnitudes,
        }
    }

    /// A share of the size of every place's signal in the plant; none at sensors.
    pub fn shared(&self, share: f64) -> Vec<f64> {
        let own = |number: usize| !self.ports[number].is_sensor() && self.ties[number] == number;
        let of = |(number, size): (usize, &f64)| if own(number) { share * size } else { 0.0 };
        self.sizes.iter().enumerate().map(of).collect()
    }

    /// The ports of the plant.
    fn moving(&self) -> impl Iterator<Item = (usize, &Port)> {
        self.ports.iter().enumerate().filter(|(_, port)| !port.is_sensor())
    }

    /// What derivatives are taken of: states, ports, parameters.
    fn seeds(&self, drive: &Drive) -> Vec<Seed> {
        let states = self.active.iter().map(|it| Seed::State(*it));
        let ports = self.moving().filter_map(|(_, port)| port.seed(drive.inputs[0].len()));
        states.chain(ports).chain(self.parameters.iter().map(|it| Seed::Parameter(*it))).collect()
    }

    /// The model about the trajectory over some samples of a record; none if the model diverges there.
    pub fn window(
        &self,
        records: &[Dataset],
        record: usize,
        samples: Range<usize>,
        start: &[f64],
    ) -> Option<Window> {
        let own = &records[record];
        let drive = own.drive(&samples, &self.point.inputs);
        let start = &self.start(own, &samples, start);
        let (passed, mut trajectory) = self.passed(own, &samples, start);
        let smooth: Vec<Smoothed> = smoothed(&passed);
        for (whole, smooth) in trajectory.iter_mut().zip(&smooth) {
            for (state, value) in self.active.iter().zip(&smooth.x) {
                whole[*state] = *value;
            }
        }
        if !trajectory.iter().flatten().all(|it| it.is_finite()) {
            return None;
        }
        let seeds = self.seeds(&drive);
        let wanted: Vec<usize> = own.measured.iter().map(|it| it.output).collect();
        let mut about = About {
            active: &self.active,
            measured: (0..own.measured.len()).map(|row| own.compared(row, &samples)).collect(),
            window: Window {
                record,
                samples: samples.clone(),
                step: own.step,
                states: self.active.len(),
                outputs: wanted.len(),
                width: seeds.len(),
                trajectory,
                next_slopes: Vec::new(),
                output_slopes: Vec::new(),
                defects: Vec::new(),
                rates: Vec::new(),
                predicted: Vec::new(),
                residuals: Vec::new(),
                drive: drive.clone(),
                timing: Vec::new(),
                lawful: None,
                loose: (Vec::new(), Vec::new()),
                pushes: Vec::new(),
            },
        };
        self.dynamics.followed(&self.point.parameters, start, &drive, (&seeds, &wanted), &mut about);
        let mut window = about.window;
        window.pushes = self.moving().map(|port| self.pushes(own, &window, port)).collect();
        Some(window)
    }

    /// An extended Kalman filter's way through some samples, and the states on it.
    pub(super) fn passed(
        &self,
        own: &Dataset,
        samples: &Range<usize>,
        start: &[f64],
    ) -> (Vec<Passed>, Vec<Vec<f64>>) {
        let drive = own.drive(samples, &self.point.inputs);
        let seeds = self.seeds(&drive);
        let wanted: Vec<usize> = own.measured.iter().map(|it| it.output).collect();
        let (n, moving) = (self.active.len(), self.moving().count());
        let ports: Vec<f64> = self.moving().map(|(port, _)| self.free[port]).collect();
        let variances =
            self.active.iter().map(|it| self.state_sizes[*it].powi(2)).chain(ports.iter().map(|it| it * it));
        let variances: Vec<f64> = variances.collect();
        let decay = (-own.step / MEMORY).exp();
        let driven = (0..n)
            .map(|it| (ROUNDING * self.state_sizes[self.active[it]]).powi(2))
            .chain(ports.iter().map(|it| it * it * (1.0 - decay * decay)));
        let mut filter = Filter::new(&variances, 1);
        for (x, state) in filter.x.iter_mut().zip(&self.active) {
            *x = start[*state];
        }
        let mut pass = Pass {
            filter,
            n,
            width: n + moving,
            decay,
            active: &self.active,
            measured: (0..own.measured.len()).map(|row| own.compared(row, samples)).collect(),
            noise: &self.noise,
            driven: driven.collect(),
            passed: Vec::with_capacity(samples.len()),
            whole: Vec::with_capacity(samples.len()),
        };
        self.dynamics.followed(
            &self.point.parameters,
            start,
            &drive,
            (&seeds[..n + moving], &wanted),
            &mut pass,
        );
        (pass.passed, pass.whole)
    }
}

fn magnitude(records: &[Dataset], row: usize) -> f64 {
    let values: Vec<f64> =
        records.iter().flat_map(|it: &Dataset| it.measured[row].values.iter().copied()).collect();
    rms(&values).max(f64::MIN_POSITIVE)
}

/// Root mean square of what a signal changes by from sample to sample.
fn change(values: &[f64]) -> f64 {
    root_mean_square(&values.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<_>>())
}

/// An extended Kalman filter on its way through a record, every port's signal being free.
struct Pass<'a> {
    filter: Filter,
    n: usize,
    width: usize,
    decay: f64,
    active: &'a [usize],
    measured: Vec<Cow<'a, [f64]>>,
    noise: &'a [f64],
    driven: Vec<f64>,
    passed: Vec<Passed>,
    whole: Vec<Vec<f64>>,
}

impl Follower for Pass<'_> {
    fn state(&mut self, _: usize, state: &mut [f64]) {
        for (index, x) in self.active.iter().zip(&self.filter.x) {
            state[*index] = *x;
        }
    }

    fn seen(&mut self, sample: usize, Seen { outputs, slopes, .. }: Seen<'_>, state: &mut [f64]) {
        let mut passed = Passed { x: self.filter.x.clone(), p: self.filter.p.clone(), ..Passed::default() };
        for (row, h) in slopes.chunks_exact(self.width).enumerate() {
            let measured = self.measured[row][sample];
            if !measured.is_finite() {
                continue;
            }
            // About the prediction, which is nonlinear in the states and linear in the ports.
            let own: f64 = h[..self.n].iter().zip(&passed.x).map(|(h, x)| h * x).sum();
            let mut y = [measured - outputs[row] + own];
            let update = self.filter.measure(h, self.noise[row], &mut y);
            passed.measured.push((h.to_vec(), self.filter.gain().to_vec(), y[0], update.variance));
        }
        for (index, x) in self.active.iter().zip(&self.filter.x) {
            state[*index] = *x;
        }
        self.whole.push(state.to_vec());
        self.passed.push(passed);
    }

    fn advanced(&mut self, _: usize, next: &[f64], slopes: &[f64]) {
        let (n, width) = (self.n, self.width);
        let mut a = vec![0.0; width * width];
        let mut input = vec![0.0; width];
        for (row, state) in self.active.iter().enumerate() {
            let slopes = &slopes[state * width..(state + 1) * width];
            a[row * width..(row + 1) * width].copy_from_slice(slopes);
            let own: f64 = slopes[..n].iter().zip(&self.filter.x).map(|(a, x)| a * x).sum();
            input[row] = next[*state] - own;
        }
        for port in n..width {
            a[port * width + port] = self.decay;
        }
        self.filter.predict(&a, &input, &self.driven);
        if let Some(passed) = self.passed.last_mut() {
            passed.a = a;
        }
    }
}

/// Linearises about a given trajectory.
struct About<'a> {
    active: &'a [usize],
    measured: Vec<Cow<'a, [f64]>>,
    window: Window,
}

impl Follower for About<'_> {
    fn state(&mut self, sample: usize, state: &mut [f64]) {
        for index in self.active {
            state[*index] = self.window.trajectory[sample][*index];
        }
    }

    fn seen(&mut self, sample: usize, Seen { outputs, slopes, rates }: Seen<'_>, state: &mut [f64]) {
        self.window.trajectory[sample].copy_from_slice(state);
        self.window.output_slopes.extend_from_slice(slopes);
        self.window.predicted.extend_from_slice(outputs);
        self.window.rates.extend(self.active.iter().map(|index| rates[*index]));
        let measured = self.measured.iter().map(|it| it[sample]);
        self.window.residuals.extend(measured.zip(outputs).map(|(measured, value)| measured - value));
    }

    fn advanced(&mut self, sample: usize, next: &[f64], slopes: &[f64]) {
        let width = self.window.width;
        for index in self.active {
            self.window.next_slopes.extend_from_slice(&slopes[index * width..(index + 1) * width]);
            self.window.defects.push(next[*index] - self.window.trajectory[sample + 1][*index]);
        }
    }
}
