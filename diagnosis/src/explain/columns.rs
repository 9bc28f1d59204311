//! What each candidate would change along the trajectory.

use crate::dataset::recorded::Dataset;
use crate::estimation::hypothesis::Term;
use crate::estimation::unknowns::{Estimate, Unknown};
use crate::missing::innovations::Column;
use crate::missing::ports::{Entry, Port};
use crate::missing::trajectory::{Setting, Window};
use crate::plant::{Drive, Dynamics, Follower, Seen};
use crate::screening::rms;
use crate::signal::distortion::Fault;

/// Share of a change of the rates, in squares, that a signal at a port may leave if it is all of the change.
const ALL: f64 = 1e-9;
/// Share of a state's magnitude to which a trajectory is known.
const KNOWN: f64 = 0.02;

impl Setting<'_> {
    /// Rates of the states that matter by a unit signal at a port of the plant, sample by sample along a window.
    pub fn pushes(&self, record: &Dataset, window: &Window, (number, port): (usize, &Port)) -> Vec<f64> {
        let size = self.sizes[number];
        let mut point = self.point.clone();
        match port.entry {
            Entry::Constant(index) => point.parameters[index] += size,
            Entry::Input(index) => point.set(Unknown::Input(index, Fault::Offset), size),
            Entry::Sensor(_) => return Vec::new(),
        }
        let mut rates = self.along(record, window, self.dynamics, &point).rates;
        rates.iter_mut().for_each(|it| *it /= size);
        rates
    }

    /// Lets laws act along the trajectory: from here on, changes are counted from there.
    pub fn take_along(&self, record: &Dataset, window: &mut Window, laws: &[Column], lawful: &Estimate) {
        let along = self.along(record, window, self.dynamics, lawful);
        let rates = along.rates.iter().zip(&window.rates).map(|(more, plain)| more + plain).collect();
        let outputs = along.outputs.iter().zip(&window.predicted);
        let outputs = outputs.map(|(more, plain)| f64::from(*more) + plain).collect();
        window.lawful = Some((rates, outputs));
        for law in laws {
            window.defects.iter_mut().zip(&law.next).for_each(|(defect, more)| *defect += f64::from(*more));
            let residuals = window.residuals.iter_mut().zip(&law.outputs);
            residuals.for_each(|(residual, more)| *residual -= f64::from(*more));
        }
    }

    /// Adds the spread of the laws within the accuracy of the trajectory, and of the velocity within which friction turns over: the
    /// friction of a body that hardly moves is anything up to its limit, whatever the sign of the velocity seems to be.
    pub fn loosen(&self, record: &Dataset, window: &mut Window, (lawful, sharp): (&Estimate, &Estimate)) {
        let (n, m, samples) = (window.states, window.outputs, window.samples.len());
        let mut loose = (vec![0.0; samples.saturating_sub(1) * n], vec![0.0; samples * m]);
        let mut add = |spread: &Column, share: f32| {
            let add = |to: &mut [f64], spread: &[f32]| {
                to.iter_mut().zip(spread).for_each(|(to, it)| *to += f64::from(share * it).powi(2));
            };
            add(&mut loose.0, &spread.next);
            add(&mut loose.1, &spread.outputs);
        };
        let at = |point: &Estimate, shift: Option<&Shift>| {
            let along = self.along_shifted(record, (window, shift), self.dynamics, point);
            Column { next: along.increments(), outputs: along.outputs }
        };
        if sharp != lawful {
            add(&at(sharp, None).minus(&at(lawful, None)), 1.0);
        }
        for state in 0..n {
            let reach = reach(window, self.active[state]);
            let law = |sign: f64| {
                let by = reach.iter().map(|it| sign * it).collect();
                let shift = Shift { state, by };
                at(sharp, Some(&shift)).minus(&at(&self.point, Some(&shift)))
            };
            add(&law(1.0).minus(&law(-1.0)), 0.5);
        }
        window.loose = loose;
    }

    fn along<'b>(
        &'b self,
        record: &Dataset,
        window: &'b Window,
        dynamics: &dyn Dynamics,
        point: &Estimate,
    ) -> Along<'b> {
        self.along_shifted(record, (window, None), dynamics, point)
    }

    fn along_shifted<'b>(
        &'b self,
        record: &Dataset,
        (window, shift): (&'b Window, Option<&'b Shift>),
        dynamics: &dyn Dynamics,
        point: &Estimate,
    ) -> Along<'b> {
        // Most laws leave the inputs as they are.
        let changed =
            (point.inputs != self.point.inputs).then(|| record.drive(&window.samples, &point.inputs));
        let drive = changed.as_ref().unwrap_or(&window.drive);
        self.along_driven(record, (window, shift), (dynamics, drive), point)
    }

    fn along_driven<'b>(
        &'b self,
        record: &Dataset,
        (window, shift): (&'b Window, Option<&'b Shift>),
        (dynamics, drive): (&dyn Dynamics, &Drive),
        point: &Estimate,
    ) -> Along<'b> {
        let wanted: Vec<usize> = record.measured.iter().map(|it| it.output).collect();
        let mut along = Along { active: &self.active, window, shift, rates: Vec::new(), outputs: Vec::new() };
        dynamics.followed(&point.parameters, &window.trajectory[0], drive, (&[], &wanted), &mut along);
        along
    }

    /// What another drive changes along the trajectory.
    pub fn driven_otherwise(
        &self,
        record: &Dataset,
        window: &Window,
        drive: &Drive,
        point: &Estimate,
    ) -> Column {
        let along = self.along_driven(record, (window, None), (self.dynamics, drive), point);
        Column { next: along.increments(), outputs: along.outputs }
    }

    /// What other parameters, inputs or outputs change of the predictions in a window; none if the model diverges.
    ///
    /// The states that matter follow the trajectory; what an effect remembers beside them goes its own way.
    pub fn changed(
        &self,
        (records, window): (&[Dataset], &Window),
        (term, dynamics): (Term, &dyn Dynamics),
        point: &Estimate,
    ) -> Option<Column> {
        let record = &records[window.record];
        match term {
            Term::Fault(Unknown::Output(output, _)) | Term::Response(output) => {
                let row = record.measured.iter().position(|it| it.output == output)?;
                let m = window.outputs;
                let plain: Vec<f64> = window.plain().1.iter().skip(row).step_by(m).copied().collect();
                let seen = point.outputs[output].applied(&plain, record.samples(&window.samples));
                let mut outputs = vec![0.0_f32; window.predicted.len()];
                for ((place, seen), plain) in outputs.iter_mut().skip(row).step_by(m).zip(seen).zip(plain) {
                    *place = (seen - plain) as f32;
                }
                Some(Column { next: Vec::new(), outputs })
            }
            _ => {
                let along = self.along(record, window, dynamics, point);
                let next = along.by_port().unwrap_or_else(|| along.increments());
                let column = Column { next, outputs: along.outputs };
                let finite = column.next.iter().chain(&column.outputs).all(|it| it.is_finite());
                finite.then_some(column)
            }
        }
    }
}

/// A state, by its place among those that matter, and by how much it is moved off the trajectory, sample by sample.
struct Shift {
    state: usize,
    by: Vec<f64>,
}

/// How far a state may be from the trajectory, sample by sample: by a share of its magnitude, and by what it moves in a sample,
/// since a record does not show when within a sample a velocity changes its sign.
fn reach(window: &Window, state: usize) -> Vec<f64> {
    let values: Vec<f64> = window.trajectory.iter().map(|it| it[state]).collect();
    let known = KNOWN * rms(&values);
    let last = values.len() - 1;
    (0..=last).map(|k| known + (values[(k + 1).min(last)] - values[k.saturating_sub(1)]).abs()).collect()
}

/// Notes what a model says otherwise along a trajectory.
struct Along<'a> {
    active: &'a [usize],
    window: &'a Window,
    shift: Option<&'a Shift>,
    /// Changes of the rates, sample by sample and state by state.
    rates: Vec<f64>,
    outputs: Vec<f32>,
}

impl Along<'_> {
    /// What changed rates change in the next states, if they are all from a signal at one port: the port's own derivative
    /// holds however stiff the states are, as a light mass in a viscous guide.
    fn by_port(&self) -> Option<Vec<f32>> {
        let (n, width) = (self.window.states, self.window.width);
        if n == 0 {
            return Some(Vec::new());
        }
        let signal = |pushes: &Vec<f64>| -> Option<Vec<f64>> {
            let (mut left, mut all) = (0.0, 0.0);
            let amount = |(rates, pushes): (&[f64], &[f64])| {
                let both: f64 = rates.iter().zip(pushes).map(|(rate, push)| rate * push).sum();
                let own: f64 = pushes.iter().map(|it| it * it).sum();
                let amount = if own > 0.0 { both / own } else { 0.0 };
                all += rates.iter().map(|it| it * it).sum::<f64>();
                left +=
                    rates.iter().zip(pushes).map(|(rate, push)| (rate - amount * push).powi(2)).sum::<f64>();
                amount
            };
            let amounts = self.rates.chunks_exact(n).zip(pushes.chunks_exact(n)).map(amount).collect();
            (left <= ALL * all).then_some(amounts)
        };
        let (port, signal) =
            self.window.pushes.iter().enumerate().find_map(|(port, pushes)| Some((port, signal(pushes)?)))?;
        let slope =
            |sample: usize, state: usize| self.window.next_slopes[(sample * n + state) * width + n + port];
        let means = signal.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).enumerate();
        Some(
            means
                .flat_map(|(sample, mean)| (0..n).map(move |state| (slope(sample, state) * mean) as f32))
                .collect(),
        )
    }

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
    fn given(&self) -> Option<&[usize]> {
        Some(self.active)
    }

    fn state(&mut self, sample: usize, state: &mut [f64]) {
        for index in self.active {
            state[*index] = self.window.trajectory[sample][*index];
        }
        if let Some(Shift { state: moved, by }) = self.shift {
            state[self.active[*moved]] += by[sample];
        }
    }

    fn seen(&mut self, sample: usize, Seen { outputs, rates, .. }: Seen<'_>, _: &mut [f64]) {
        let (plain_rates, plain_outputs) = self.window.plain();
        let predicted = &plain_outputs[sample * outputs.len()..];
        self.outputs.extend(outputs.iter().zip(predicted).map(|(value, plain)| (value - plain) as f32));
        let plain = &plain_rates[sample * self.active.len()..];
        self.rates.extend(self.active.iter().zip(plain).map(|(index, plain)| rates[*index] - plain));
    }

    fn advanced(&mut self, _: usize, _: &[f64], _: &[f64]) {}
}
