//! What moves at a port along the trajectory, and what a signal there changes of the predictions.

use rayon::prelude::*;

use crate::dataset::recorded::Dataset;
use crate::plant::{Follower, Seen, Signals};
use crate::rig::Rig;
use crate::signal::derivative;

use super::innovations::Column;
use super::ports::{Entry, Port};
use super::trajectory::{Setting, Window};

/// A port's motion over a window.
pub struct Motion {
    /// Deflection or position.
    pub deflection: Vec<f64>,
    /// Velocity.
    pub velocity: Vec<f64>,
}

/// Every output of the plant along the trajectory of each window.
pub fn outputs(setting: &Setting<'_>, windows: &[Window], outputs: usize) -> Vec<Signals> {
    let wanted: Vec<usize> = (0..outputs).collect();
    let of = |window: &Window| {
        let mut all = All { active: &setting.active, window, signals: vec![Vec::new(); outputs] };
        let start = &window.trajectory[0];
        let parameters = &setting.point.parameters;
        setting.dynamics.followed(parameters, start, &window.drive, (&[], &wanted), &mut all);
        all.signals
    };
    windows.par_iter().map(of).collect()
}

struct All<'a> {
    active: &'a [usize],
    window: &'a Window,
    signals: Signals,
}

impl Follower for All<'_> {
    fn given(&self) -> Option<&[usize]> {
        Some(self.active)
    }

    fn state(&mut self, sample: usize, state: &mut [f64]) {
        for index in self.active {
            state[*index] = self.window.trajectory[sample][*index];
        }
    }

    fn seen(&mut self, _: usize, Seen { outputs, .. }: Seen<'_>, _: &mut [f64]) {
        self.signals.iter_mut().zip(outputs).for_each(|(signal, value)| signal.push(*value));
    }

    fn advanced(&mut self, _: usize, _: &[f64], _: &[f64]) {}
}

/// A motion that the missing signal at a port of the plant may follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mover {
    /// The element at the port.
    Element,
    /// An output, by its index, of a model without elements.
    Output(usize),
}

impl Mover {
    /// All that are known at a port: none at a sensor.
    pub fn all(rig: &Rig, port: &Port, record: &Dataset) -> Vec<Self> {
        if port.is_sensor() {
            Vec::new()
        } else if rig.kind.elements.is_empty() {
            record.measured.iter().map(|it| Self::Output(it.output)).collect()
        } else {
            vec![Self::Element]
        }
    }

    /// The motion over windows; none if the rig file names no output for it.
    pub fn motions(
        self,
        rig: &Rig,
        (port, windows): (&Port, &[Window]),
        outputs: &[Signals],
    ) -> Option<Vec<Motion>> {
        let motions = |output: usize, deflected: &dyn Fn(&[f64]) -> Vec<f64>, velocity: Option<usize>| {
            let motion = |(window, signals): (&Window, &Signals)| Motion {
                deflection: deflected(&signals[output]),
                velocity: velocity
                    .map_or_else(|| derivative(&signals[output], window.step), |it| signals[it].clone()),
            };
            windows.iter().zip(outputs).map(motion).collect()
        };
        match self {
            Self::Output(output) => Some(motions(output, &<[f64]>::to_vec, None)),
            Self::Element => {
                let element = rig.kind.elements.iter().find(|it| Some(it.element) == port.element)?;
                let output = rig.plant.output(&element.deflection)?;
                let velocity = element.velocity.as_ref().and_then(|name| rig.plant.output(name));
                Some(motions(output, &|signal| element.deflected(signal), velocity))
            }
        }
    }
}

/// The place of a port of the plant among the slopes.
pub fn place(setting: &Setting<'_>, port: usize) -> usize {
    setting.active.len() + setting.ports[..port].iter().filter(|it| !it.is_sensor()).count()
}

/// A feature's signal as a column at a port.
pub fn column(port: &Port, place: usize, window: &Window, signal: &[f64]) -> Column {
    let (n, m, width) = (window.states, window.outputs, window.width);
    let samples = window.samples.len();
    let mut column =
        Column { next: vec![0.0; (samples.saturating_sub(1)) * n], outputs: vec![0.0; samples * m] };
    if let Entry::Sensor(row) = port.entry {
        for (value, signal) in column.outputs.iter_mut().skip(row).step_by(m).zip(signal) {
            *value = *signal as f32;
        }
        column.next.clear();
        return column;
    }
    for sample in 0..samples {
        for output in 0..m {
            let slope = window.output_slopes[(sample * m + output) * width + place];
            column.outputs[sample * m + output] = (slope * signal[sample]) as f32;
        }
        if sample + 1 < samples {
            let middle = 0.5 * (signal[sample] + signal[sample + 1]);
            for state in 0..n {
                let slope = window.next_slopes[(sample * n + state) * width + place];
                column.next[sample * n + state] = (slope * middle) as f32;
            }
        }
    }
    column
}
