//! FMUs that are coupled hard, and what a master can ask them for. The Python files beside this folder say more.

use std::collections::HashMap;
use std::path::Path;

use nalgebra::{DMatrix, DVector};

use crate::Error;
use crate::methods::Method;
use crate::slave::Slave;

/// What is larger than this, in multiples of the connections' sizes, has run away.
const LIMIT: f64 = 1e3;

/// Value and slope at a time, which hold to the step's end.
pub type Course = fn(f64) -> (f64, f64);

/// How a system is put together.
#[derive(Default)]
pub struct Plan<'a> {
    /// Name and FMU.
    pub components: &'a [(&'a str, &'a str)],
    /// `component.output`, `component.input` and the size that the values have.
    pub connections: &'a [(&'a str, &'a str, f64)],
    /// What inputs do that nobody else feeds.
    pub stimulus: &'a [(&'a str, Course)],
    /// Parameters other than the FMUs' own.
    pub parameters: &'a [(&'a str, f64)],
}

/// A component as the others see it.
pub struct Part {
    pub slave: Slave,
    references: HashMap<String, u32>,
    /// The connections that it feeds and that feed it.
    pub made: Vec<usize>,
    pub taken: Vec<usize>,
    outputs: Vec<u32>,
    inputs: Vec<u32>,
    stimulus: Vec<(u32, Course)>,
    states: Vec<u32>,
    rates: Vec<u32>,
}

impl Part {
    fn new(folder: &Path, name: &str, fmu: &str, plan: &Plan) -> Result<Self, Error> {
        let mut slave = Slave::new(&folder.join(format!("{fmu}.fmu")), name)?;
        let references: HashMap<String, u32> = slave
            .variables()
            .map(|(variable, reference)| (format!("{name}.{variable}"), reference))
            .collect();
        let of = |name: &str| references.get(name).copied();
        let (states, rates) = slave.states();
        let (mut made, mut outputs, mut taken, mut inputs) = (vec![], vec![], vec![], vec![]);
        for (index, (source, target, _)) in plan.connections.iter().enumerate() {
            if let Some(reference) = of(source) {
                made.push(index);
                outputs.push(reference);
            }
            if let Some(reference) = of(target) {
                taken.push(index);
                inputs.push(reference);
            }
        }
        let stimulus =
            plan.stimulus.iter().filter_map(|(target, course)| Some((of(target)?, *course))).collect();
        for (parameter, value) in plan.parameters {
            if let Some(reference) = of(parameter) {
                slave.set_real(&[reference], &[*value])?;
            }
        }
        Ok(Self { slave, references, made, taken, outputs, inputs, stimulus, states, rates })
    }

    /// The values of its outputs, at their places in `values`.
    pub fn read(&self, values: &mut DVector<f64>) -> Result<(), Error> {
        let read = self.slave.real(&self.outputs)?;
        self.made.iter().zip(read).for_each(|(index, value)| values[*index] = value);
        Ok(())
    }

    /// The slopes of its outputs, as its inputs are now.
    pub fn slopes(&self, values: &mut DVector<f64>) -> Result<(), Error> {
        let read = self.slave.slopes(&self.outputs)?;
        self.made.iter().zip(read).for_each(|(index, value)| values[*index] = value);
        Ok(())
    }

    /// The course of its inputs in the step that starts now: value, slope, curvature of all connections.
    pub fn steer(&mut self, time: f64, path: &[DVector<f64>]) -> Result<(), Error> {
        for (order, derivative) in path.iter().enumerate().filter(|_| !self.inputs.is_empty()) {
            let values: Vec<f64> = self.taken.iter().map(|index| derivative[*index]).collect();
            match order {
                0 => self.slave.set_real(&self.inputs, &values)?,
                _ => self.slave.set_input_derivatives(&self.inputs, order as i32, &values)?,
            }
        }
        for (reference, course) in &self.stimulus {
            let (value, slope) = course(time);
            self.slave.set_real(&[*reference], &[value])?;
            self.slave.set_input_derivatives(&[*reference], 1, &[slope])?;
        }
        Ok(())
    }
}

/// All components about the present point, side by side, not yet connected: with what has changed since the step's
/// start, `x' = rates + a x + b u + moved s`, `y = c x + d u + seen s`.
pub struct Linear {
    pub a: DMatrix<f64>,
    pub b: DMatrix<f64>,
    pub c: DMatrix<f64>,
    pub d: DMatrix<f64>,
    pub rates: DVector<f64>,
    pub moved: DVector<f64>,
    pub seen: DVector<f64>,
}

/// Components that a method takes from step to step.
pub struct Coupled {
    pub parts: Vec<Part>,
    pub scales: DVector<f64>,
    /// Calls of `fmi2DoStep` so far.
    pub steps: usize,
}

impl Coupled {
    /// Loads the components and connects them.
    pub fn new(folder: &Path, plan: &Plan) -> Result<Self, Error> {
        let parts = plan
            .components
            .iter()
            .map(|(name, fmu)| Part::new(folder, name, fmu, plan))
            .collect::<Result<_, _>>()?;
        let scales =
            DVector::from_iterator(plan.connections.len(), plan.connections.iter().map(|(.., scale)| *scale));
        Ok(Self { parts, scales, steps: 0 })
    }

    /// Number of connections.
    pub fn width(&self) -> usize {
        self.scales.len()
    }

    /// All outputs.
    pub fn read(&self) -> Result<DVector<f64>, Error> {
        let mut values = DVector::zeros(self.width());
        self.parts.iter().try_for_each(|part| part.read(&mut values))?;
        Ok(values)
    }

    /// All slopes.
    pub fn slopes(&self) -> Result<DVector<f64>, Error> {
        let mut values = DVector::zeros(self.width());
        self.parts.iter().try_for_each(|part| part.slopes(&mut values))?;
        Ok(values)
    }

    /// Inputs go along their paths in the step that starts now.
    pub fn steer(&mut self, time: f64, path: &[DVector<f64>]) -> Result<(), Error> {
        self.parts.iter_mut().try_for_each(|part| part.steer(time, path))
    }

    /// A component takes the step.
    pub fn advance_one(&mut self, index: usize, time: f64, size: f64, last: bool) -> Result<(), Error> {
        self.steps += 1;
        self.parts[index].slave.step(time, size, last)
    }

    /// Every component takes the step.
    pub fn advance(&mut self, time: f64, size: f64, last: bool) -> Result<(), Error> {
        (0..self.parts.len()).try_for_each(|index| self.advance_one(index, time, size, last))
    }

    /// Every component keeps its state.
    pub fn save(&mut self) -> Result<(), Error> {
        self.parts.iter_mut().try_for_each(|part| part.slave.save())
    }

    /// Every component goes back to the state that it has kept.
    pub fn rewind(&mut self) -> Result<(), Error> {
        self.parts.iter_mut().try_for_each(|part| part.slave.rewind())
    }

    /// The components about the present point, their inputs as they are.
    pub fn linear(&self, time: f64) -> Result<Linear, Error> {
        let (n, width) = (self.parts.iter().map(|part| part.states.len()).sum(), self.width());
        let mut linear = Linear {
            a: DMatrix::zeros(n, n),
            b: DMatrix::zeros(n, width),
            c: DMatrix::zeros(width, n),
            d: DMatrix::zeros(width, width),
            rates: DVector::zeros(n),
            moved: DVector::zeros(n),
            seen: DVector::zeros(width),
        };
        let mut first = 0;
        for part in &self.parts {
            let unknown = [&part.rates[..], &part.outputs].concat();
            let count = part.rates.len();
            let column = |known: u32| part.slave.derivatives(&unknown, known);
            linear.rates.rows_mut(first, count).copy_from_slice(&part.slave.real(&part.rates)?);
            for (index, state) in part.states.iter().enumerate() {
                let found = column(*state)?;
                linear.a.view_mut((first, first + index), (count, 1)).copy_from_slice(&found[..count]);
                part.made
                    .iter()
                    .zip(&found[count..])
                    .for_each(|(row, value)| linear.c[(*row, first + index)] = *value);
            }
            for (input, to) in part.inputs.iter().zip(&part.taken) {
                let found = column(*input)?;
                linear.b.view_mut((first, *to), (count, 1)).copy_from_slice(&found[..count]);
                part.made.iter().zip(&found[count..]).for_each(|(row, value)| linear.d[(*row, *to)] = *value);
            }
            for (input, course) in &part.stimulus {
                let (found, (_, slope)) = (column(*input)?, course(time));
                (0..count).for_each(|row| linear.moved[first + row] += found[row] * slope);
                part.made
                    .iter()
                    .zip(&found[count..])
                    .for_each(|(row, value)| linear.seen[*row] += value * slope);
            }
            first += count;
        }
        Ok(linear)
    }

    /// Simulates from 0 to `stop`; rows of signals at 0 and after every step.
    pub fn run(
        &mut self,
        method: &mut Method,
        stop: f64,
        size: f64,
        signals: &[&str],
    ) -> Result<Vec<Vec<f64>>, Error> {
        for part in &mut self.parts {
            part.slave.enter_initialization()?;
        }
        // A value that passes through a component arrives only in the next exchange.
        for _ in 0..self.parts.len() {
            let values = self.read()?;
            for part in &mut self.parts {
                let taken: Vec<f64> = part.taken.iter().map(|index| values[*index]).collect();
                part.slave.set_real(&part.inputs, &taken)?;
                for (reference, course) in &part.stimulus {
                    part.slave.set_real(&[*reference], &[course(0.0).0])?;
                }
            }
        }
        self.parts.iter_mut().try_for_each(|part| part.slave.exit_initialization())?;
        let mut rows = vec![self.row(signals)?];
        for index in 0..(stop / size).round() as u32 {
            // Not added up: after many steps a sum of steps is no longer a multiple of the step.
            let time = f64::from(index) * size;
            method.step(self, time, size)?;
            if self.read()?.iter().zip(self.scales.iter()).any(|(value, scale)| value.abs() >= LIMIT * scale)
            {
                return Err(Error::RunAway { time: time + size });
            }
            rows.push(self.row(signals)?);
        }
        Ok(rows)
    }

    fn row(&self, signals: &[&str]) -> Result<Vec<f64>, Error> {
        let one = |signal: &&str| {
            let found = self.parts.iter().find_map(|part| Some((part, *part.references.get(*signal)?)));
            let (part, reference) = found.ok_or_else(|| Error::Fmi(format!("there is no {signal:?}")))?;
            Ok(part.slave.real(&[reference])?[0])
        };
        signals.iter().map(one).collect()
    }
}
