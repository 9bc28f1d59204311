//! What each candidate would change along the trajectory.

use crate::dataset::recorded::Recorded;
use crate::estimation::fit::{Handle, Point};
use crate::estimation::hypothesis::Term;
use crate::missing::innovations::Column;
use crate::missing::trajectory::{Setting, Window};
use crate::plant::{Dynamics, Follower, Seen};

impl Setting<'_> {
    /// What other parameters, inputs or outputs change of the predictions in a window; none if the model diverges.
    ///
    /// The states that matter follow the trajectory; what an effect remembers beside them goes its own way.
    pub fn changed(
        &self,
        (records, window): (&[Recorded], &Window),
        (term, dynamics): (Term, &dyn Dynamics),
        point: &Point,
    ) -> Option<Column> {
        let record = &records[window.record];
        match term {
            Term::Fault(Handle::Output(output, _)) | Term::Response(output) => {
                let row = record.measured.iter().position(|it| it.output == output)?;
                let m = window.outputs;
                let plain: Vec<f64> = window.predicted.iter().skip(row).step_by(m).copied().collect();
                let seen = point.outputs[output].applied(&plain, record.samples(&window.samples));
                let mut outputs = vec![0.0_f32; window.predicted.len()];
                for ((place, seen), plain) in outputs.iter_mut().skip(row).step_by(m).zip(seen).zip(plain) {
                    *place = (seen - plain) as f32;
                }
                Some(Column { next: Vec::new(), outputs })
            }
            _ => {
                let drive = record.drive(&window.samples, &point.inputs);
                let wanted: Vec<usize> = record.measured.iter().map(|it| it.output).collect();
                let mut along =
                    Along { active: &self.active, window, rates: Vec::new(), outputs: Vec::new() };
                let start = &window.trajectory[0];
                dynamics.followed(&point.parameters, start, &drive, (&[], &wanted), &mut along);
                let column = Column { next: along.increments(), outputs: along.outputs };
                let finite = column.next.iter().chain(&column.outputs).all(|it| it.is_finite());
                finite.then_some(column)
            }
        }
    }
}

/// Notes what a model says otherwise along a trajectory.
struct Along<'a> {
    active: &'a [usize],
    window: &'a Window,
    /// Changes of the rates, sample by sample and state by state.
    rates: Vec<f64>,
    outputs: Vec<f32>,
}

impl Along<'_> {
    /// What changed rates change in the next states, by the trapezoidal rule along the trajectory: a prediction without the
    /// missing signal would soon leave it, and meet friction on the wrong side.
    fn increments(&self) -> Vec<f32> {
        let (n, width) = (self.window.states, self.window.width);
        if n == 0 {
            return Vec::new();
        }
        let half = 0.5 * self.window.step;
        let mut next = Vec::with_capacity(self.rates.len());
        for (sample, pair) in self.rates.windows(2 * n).step_by(n).enumerate() {
            let (before, after) = pair.split_at(n);
            for (state, after) in after.iter().enumerate() {
                let slopes = &self.window.next_slopes[(sample * n + state) * width..][..n];
                let moved: f64 = slopes.iter().zip(before).map(|(slope, rate)| slope * rate).sum();
                next.push((half * (moved + after)) as f32);
            }
        }
        next
    }
}

impl Follower for Along<'_> {
    fn state(&mut self, sample: usize, state: &mut [f64]) {
        for index in self.active {
            state[*index] = self.window.trajectory[sample][*index];
        }
    }

    fn seen(&mut self, sample: usize, Seen { outputs, rates, .. }: Seen<'_>, _: &mut [f64]) {
        let predicted = &self.window.predicted[sample * outputs.len()..];
        self.outputs.extend(outputs.iter().zip(predicted).map(|(value, plain)| (value - plain) as f32));
        let plain = &self.window.rates[sample * self.active.len()..];
        self.rates.extend(self.active.iter().zip(plain).map(|(index, plain)| rates[*index] - plain));
    }

    fn advanced(&mut self, _: usize, _: &[f64], _: &[f64]) {}
}
