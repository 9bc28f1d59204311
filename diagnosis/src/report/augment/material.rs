//! What an augmented model is made of, and what follows from it.

use std::path::Path;

use crate::plant::{Attachment, Face, FaceVariable, Own, needs_own};
use crate::signal::distortion::Correction;

/// Difference of two signals, as a share of how far they move, that is rounding.
const ROUNDING: f64 = 1e-9;

/// What a system is made of, in base units of the SI.
#[derive(Clone, Debug)]
pub struct Material<'a> {
    /// The other maker's FMU.
    pub fmu: &'a Path,
    /// What it declares.
    pub face: &'a Face,
    /// Where Strut's elements are attached to it.
    pub beside: &'a [Attachment],
    /// Whether the strut does just what it replaces, so that the FMU may keep it.
    pub stands_in: bool,
    /// Parameters of the FMU and of the elements beside it.
    pub parameters: Vec<Value<'a>>,
    /// Memory of the elements at the start.
    pub memory: Vec<Value<'a>>,
    /// Start values of other variables that the FMU takes.
    pub starts: Vec<(String, f64)>,
    /// What drives the FMU.
    pub inputs: Vec<(&'a str, &'a [f64])>,
    /// What the augmented model computes then.
    pub outputs: Vec<(&'a str, &'a [f64])>,
    /// Time between two values of inputs and outputs in seconds.
    pub sampling: f64,
    /// The measured outputs, and what their sensors do.
    pub measured: Vec<(&'a str, Correction)>,
    /// Communication step in seconds.
    pub step: f64,
    /// The record and which part of it.
    pub record: String,
}

/// A value with what it is declared as.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Value<'a> {
    /// Name.
    pub name: &'a str,
    /// Value.
    pub value: f64,
    /// Declared start value.
    pub start: f64,
    /// Unit.
    pub unit: &'a str,
}

/// An output of the FMU that shows a signal: `signal = factor · output + offset`, in base units.
pub struct Shown<'a> {
    /// The output.
    pub output: &'a FaceVariable,
    /// Factor.
    pub factor: f64,
    /// Offset.
    pub offset: f64,
}

impl Shown<'_> {
    /// Whether it is the signal.
    pub fn is_itself(&self) -> bool {
        self.factor == 1.0 && self.offset == 0.0
    }
}

impl Material<'_> {
    /// Spring and damper of an element; none if the system does not need the element, since it has no effect.
    pub fn own(&self, at: &Attachment) -> Option<Own> {
        let of_element = || self.parameters.iter().filter(|it| at.role.has(it.name));
        let adds = of_element().any(|it| !at.role.rates().contains(&it.name) && it.value != it.start);
        let all = Own { spring: true, damper: true };
        if at.replaces.is_none() || !self.stands_in {
            return (adds || at.replaces.is_some()).then_some(all);
        }
        // A force that passes between components is late, so that the FMU does itself what it can.
        let own = needs_own(of_element().map(|it| (it.name, it.value)));
        (adds || own.spring || own.damper).then_some(own)
    }

    /// Whether a parameter is one of an element beside the FMU.
    fn is_beside(&self, name: &str) -> bool {
        self.beside.iter().any(|it| it.role.has(name))
    }

    /// The FMU's fitted parameters and its start values, in base units.
    pub fn given(&self) -> Vec<(String, f64)> {
        let named = |name: &str| self.parameters.iter().find(|it| it.name == name).map(|it| it.value);
        let fitted = self.parameters.iter().filter(|it| !self.is_beside(it.name) && it.value != it.start);
        let mut given: Vec<(String, f64)> = fitted.map(|it| (it.name.to_owned(), it.value)).collect();
        for (at, replaced) in self.beside.iter().filter_map(|it| Some((it, it.replaces.as_ref()?))) {
            let own = self.own(at).unwrap_or_default();
            let [spring, damper] = at.role.rates();
            let rates = [(&replaced.stiffness, spring, own.spring), (&replaced.damping, damper, own.damper)];
            for (name, of, taken) in rates {
                given.extend(named(of).map(|value| (name.clone(), if taken { 0.0 } else { value })));
            }
        }
        given.extend(self.starts.iter().cloned());
        given
    }

    /// The output that shows a signal: itself, or one that follows it along a straight line.
    pub fn shown(&self, signal: &str) -> Option<Shown<'_>> {
        let output = |name: &str| self.face.variable(name).filter(|it| it.causality == "output");
        if let Some(output) = output(signal) {
            return Some(Shown { output, factor: 1.0, offset: 0.0 });
        }
        let (_, of) = self.outputs.iter().find(|(name, _)| *name == signal)?;
        self.outputs.iter().find_map(|(name, by)| {
            let (output, (factor, offset)) = (output(name)?, line(of, by)?);
            Some(Shown { output, factor, offset })
        })
    }
}

/// The straight line along which one signal follows another: factor and offset. None if it follows no line.
fn line(of: &[f64], by: &[f64]) -> Option<(f64, f64)> {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (of_mean, by_mean) = (mean(of), mean(by));
    let pairs = || of.iter().zip(by).map(|(y, x)| (y - of_mean, x - by_mean));
    let power: f64 = pairs().map(|(_, x)| x * x).sum();
    let factor = pairs().map(|(y, x)| x * y).sum::<f64>() / power;
    let range = pairs().map(|(y, _)| y.abs()).fold(0.0, f64::max);
    let follows = pairs().all(|(y, x)| (y - factor * x).abs() <= ROUNDING * range);
    if of.len() < 3 || range <= 0.0 || !factor.is_finite() || !follows {
        return None;
    }
    // A sum of ten thousand numbers is off in its last digits.
    let factor = if (factor - factor.round()).abs() <= ROUNDING { factor.round() } else { factor };
    let offset = of_mean - factor * by_mean;
    let is_nothing = offset.abs() <= ROUNDING * range.max(of_mean.abs());
    (factor != 0.0).then_some((factor, if is_nothing { 0.0 } else { offset }))
}
