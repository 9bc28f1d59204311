//! Models as predictors of records: the outputs that a drive leads to, and their derivatives.
//!
//! A model's equations are integrated over the samples of a record, with dual numbers for the derivatives. The
//! derivatives are those of the integration itself, so that they belong to the outputs to the last digit.

mod filtered;
mod foreign;
mod integrate;
mod jet;
mod joint;
// The unit tests name the models that they need: to compile all of them takes long.
#[cfg(not(test))]
pub mod models;
mod pace;
mod steps;

use std::sync::Arc;

use rayon::prelude::*;
use strut_model::{Bundle, Declaration, Declarations, Model, SettingDeclaration, Settings, Value};

use filtered::Filtered;
use integrate::{Equations, Run};

pub use foreign::{Attachment, Conversion, Face, FaceVariable, Foreign, Own, Replaced, Role, needs_own};
use joint::Joint;
pub use joint::{Instance, placed};
pub use steps::{Follower, Seen};

/// Derivatives that are taken at once.
const DIRECTIONS: usize = 8;

/// A model as a predictor.
#[derive(Clone)]
pub struct Plant {
    /// The model's name.
    pub name: String,
    /// What drives it.
    pub inputs: Vec<Declaration>,
    /// What can be measured: its outputs, then those of its states that are outputs too.
    pub outputs: Vec<Declaration>,
    /// Its parameters.
    pub parameters: Vec<Declaration>,
    /// Its states.
    pub states: Vec<Declaration>,
    /// What can be chosen.
    pub settings: Vec<SettingDeclaration>,
    /// The declared choices.
    pub choices: Vec<Value>,
    /// Elements of which it has several, and what several of them are together.
    pub instances: Vec<Instance>,
    /// Parameters that stand for several of its own; they are the last ones.
    joints: Arc<[Joint]>,
    prepare: Prepare,
}

impl Plant {
    /// A model as a predictor.
    fn of<M: Model + Sync>() -> Self {
        let states = Declarations::of::<M::State<f64>>();
        let mut outputs = Declarations::of::<M::Output<f64>>();
        outputs.extend(states.iter().filter(|state| state.output).cloned());
        let starts = M::Settings::starts();
        let settings = M::Settings::declare();
        Self {
            name: M::ABOUT.name.into(),
            inputs: Declarations::of::<M::Input<f64>>(),
            outputs,
            parameters: Declarations::of::<M::Parameters<f64>>(),
            states,
            choices: (0..settings.len()).filter_map(|index| starts.get(index)).collect(),
            settings,
            instances: Vec::new(),
            joints: Arc::new([]),
            prepare: Arc::new(|choices| {
                let mut settings = M::Settings::starts();
                for (index, choice) in choices.iter().enumerate() {
                    settings.set(index, choice.clone()).ok_or("a setting has a value of a wrong type")?;
                }
                Ok(Box::new(Equations { model: M::prepare(&settings, None)? }))
            }),
        }
    }

    /// The equations with these choices.
    ///
    /// # Errors
    /// The model's own words if it refuses them.
    pub fn prepare(&self, choices: &[Value]) -> Result<Box<dyn Dynamics>, String> {
        Ok(Box::new(Filtered((self.prepare)(choices)?)))
    }

    /// The values of the model's own parameters, joint ones added to their members.
    pub fn own(&self, parameters: &[f64]) -> Vec<f64> {
        joint::own(&self.joints, parameters)
    }

    /// Whether a parameter stands for several of the model's own, by its index.
    pub fn is_joint(&self, index: usize) -> bool {
        index + self.joints.len() >= self.parameters.len()
    }

    /// Index of a parameter.
    pub fn parameter(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|it| it.name == name)
    }

    /// Index of a measurable output.
    pub fn output(&self, name: &str) -> Option<usize> {
        self.outputs.iter().position(|it| it.name == name)
    }

    /// Index of an input.
    pub fn input(&self, name: &str) -> Option<usize> {
        self.inputs.iter().position(|it| it.name == name)
    }

    /// Index of a state.
    pub fn state(&self, name: &str) -> Option<usize> {
        self.states.iter().position(|it| it.name == name)
    }

    /// Index of a setting.
    pub fn setting(&self, name: &str) -> Option<usize> {
        self.settings.iter().position(|it| it.name == name)
    }
}

impl std::fmt::Debug for Plant {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Plant").field("name", &self.name).finish_non_exhaustive()
    }
}

/// Makes equations from choices.
type Prepare = Arc<dyn Fn(&[Value]) -> Result<Box<dyn Dynamics>, String> + Send + Sync>;

/// How signals go from sample to sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Between {
    /// Straight, as a master does with what it reads from a file. Of an oscillation with twenty samples in a period it
    /// leaves out 0.8 %.
    #[default]
    Lines,
    /// Along the cubic through the two samples before and the two after: right for signals without frequencies near half
    /// the sampling rate.
    Curves,
}

impl Between {
    /// A signal at a share of the way from a sample to the next.
    #[inline]
    pub fn value(self, signal: &[f64], sample: usize, share: f64) -> f64 {
        // Most steps begin, have their middle and end at one.
        if share == 0.0 {
            return signal[sample];
        }
        let (from, to) = (signal[sample], signal[(sample + 1).min(signal.len() - 1)]);
        let line = from + share * (to - from);
        let outer = sample.checked_sub(1).and_then(|before| Some((signal[before], *signal.get(sample + 2)?)));
        match (self, outer) {
            (Self::Curves, Some((before, after))) => {
                // Lagrange's form, written as the straight line and what bends it.
                let (rise, fall) = (from - before - (to - from), to - from - (after - to));
                line + share * (1.0 - share) / 6.0 * ((2.0 - share) * rise + (1.0 + share) * fall)
            }
            _ => line,
        }
    }
}

/// What drives a plant: one signal for each input, evenly sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Time of the first sample in seconds: a damper that fades has faded by then.
    pub start: f64,
    /// Time between two samples in seconds.
    pub step: f64,
    /// Values of each input, so many for each step and a last one.
    pub inputs: Vec<Vec<f64>>,
    /// How many of an input's values there are in a step.
    pub finer: usize,
    /// How inputs go on between their values.
    pub between: Between,
    /// Whether outputs are seen at each of these values and go through the filter that the measured signals went through
    /// when only the samples were left of them.
    pub filtered: bool,
}

impl Drive {
    /// One value of each input in a sample, from time zero, with straight lines between them; `step` in seconds.
    pub fn sampled(step: f64, inputs: Vec<Vec<f64>>) -> Self {
        Self { start: 0.0, step, inputs, finer: 1, between: Between::Lines, filtered: false }
    }

    /// The drive with a sample at each value of the inputs; none if outputs are seen at the samples only.
    fn at_each_value(&self) -> Option<Self> {
        let step = self.step / self.finer as f64;
        self.filtered.then(|| Self { step, finer: 1, filtered: false, ..self.clone() })
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.inputs.first().map_or(0, |values| values.len().div_ceil(self.finer))
    }

    /// An input's signal, or a change of it, at a share of the way from a sample to the next.
    #[inline]
    pub fn value(&self, signal: &[f64], sample: usize, share: f64) -> f64 {
        let place = share * self.finer as f64;
        let whole = place as usize;
        self.between.value(signal, sample * self.finer + whole, place - whole as f64)
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// What a derivative is taken with respect to.
#[derive(Clone, Debug, PartialEq)]
pub enum Seed {
    /// A parameter, by its index.
    Parameter(usize),
    /// A state at the start, by its index.
    State(usize),
    /// A change of inputs' signals: each input's index and how it changes.
    Inputs(Vec<(usize, Vec<f64>)>),
}

/// Signals over the samples of a drive, one for each measurable output.
pub type Signals = Vec<Vec<f64>>;

/// Outputs and how they change.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearised {
    /// The outputs that were asked for.
    pub outputs: Signals,
    /// Their derivatives with respect to each seed.
    pub slopes: Vec<Signals>,
}

/// A model that is ready to be run.
pub trait Dynamics: Send + Sync {
    /// The outputs at the samples.
    fn outputs(&self, parameters: &[f64], start: &[f64], drive: &Drive) -> Signals;

    /// The outputs that are asked for, each by its index and once, and their derivatives with respect to the seeds.
    fn linearised(
        &self,
        parameters: &[f64],
        start: &[f64],
        drive: &Drive,
        seeds: &[Seed],
        wanted: &[usize],
    ) -> Linearised;

    /// Goes from sample to sample with a follower, who may say from which state at each: one-sample predictions, and
    /// their derivatives with respect to the seeds. States are seeded anew at every sample.
    fn followed(
        &self,
        parameters: &[f64],
        start: &[f64],
        drive: &Drive,
        of: (&[Seed], &[usize]),
        follower: &mut dyn Follower,
    );

    /// Refuses parameters that do not go together.
    ///
    /// # Errors
    /// The model's own words.
    fn check(&self, parameters: &[f64]) -> Result<(), String>;
}

impl<M: Model + Sync> Dynamics for Equations<M> {
    fn outputs(&self, parameters: &[f64], start: &[f64], drive: &Drive) -> Signals {
        let mut signals = vec![Vec::with_capacity(drive.len()); outputs_of::<M>()];
        let mut run = Run::<M, f64>::new(
            &self.model,
            parameters,
            Bundle::from_fn(|i| parameters[i]),
            Bundle::from_fn(|i| start[i]),
            drive,
        );
        let input = |i: usize, sample: usize, share: f64| drive.value(&drive.inputs[i], sample, share);
        run.through(drive.len(), input, |output, value| signals[output].push(value));
        signals
    }

    fn linearised(
        &self,
        parameters: &[f64],
        start: &[f64],
        drive: &Drive,
        seeds: &[Seed],
        wanted: &[usize],
    ) -> Linearised {
        let of = |seeds: &[Seed]| integrate::linearised(&self.model, parameters, start, drive, seeds, wanted);
        let parts: Vec<Linearised> = seeds.par_chunks(DIRECTIONS).map(of).collect();
        let mut parts = parts.into_iter();
        let mut all = parts.next().unwrap_or_else(|| of(&[]));
        all.slopes.extend(parts.flat_map(|part| part.slopes));
        all
    }

    fn followed(
        &self,
        parameters: &[f64],
        start: &[f64],
        drive: &Drive,
        of: (&[Seed], &[usize]),
        follower: &mut dyn Follower,
    ) {
        steps::followed(&self.model, parameters, start, drive, of, follower);
    }

    fn check(&self, parameters: &[f64]) -> Result<(), String> {
        let parameters = Bundle::from_fn(|i| parameters[i]);
        self.model.check(&parameters, &self.model.derive(&parameters))
    }
}

fn outputs_of<M: Model>() -> usize {
    let states = Declarations::of::<M::State<f64>>();
    Declarations::of::<M::Output<f64>>().len() + states.iter().filter(|state| state.output).count()
}

#[cfg(test)]
mod tests {
    use super::{Between, Drive};

    #[test]
    fn between_samples_there_may_be_values() {
        let drive = Drive { finer: 2, ..Drive::sampled(1.0, vec![vec![0.0, 1.0, 5.0, 6.0, 7.0]]) };
        assert_eq!(drive.len(), 3);
        let at = |sample: usize, share: f64| drive.value(&drive.inputs[0], sample, share);
        assert_eq!([at(0, 0.0), at(0, 0.25), at(0, 0.5), at(0, 0.75), at(0, 1.0)], [0.0, 0.5, 1.0, 3.0, 5.0]);
        assert_eq!([at(1, 0.5), at(1, 1.0), at(2, 0.0)], [6.0, 7.0, 7.0]);
    }

    #[test]
    fn curves_go_through_cubics_and_nearly_through_sines() {
        let cubic = |t: f64| 1.0 - 2.0 * t + 0.5 * t * t - 0.1 * t * t * t;
        let signal: Vec<f64> = (0..6).map(|k| cubic(f64::from(k))).collect();
        for share in [0.0, 0.3, 0.5, 1.0] {
            let value = Between::Curves.value(&signal, 2, share);
            assert!((value - cubic(2.0 + share)).abs() < 1e-12, "{share}: {value}");
        }
        // Straight at the ends, where there is no sample beyond.
        assert!((Between::Curves.value(&signal, 0, 0.5) - 0.5 * (signal[0] + signal[1])).abs() < 1e-15);
        let sine: Vec<f64> = (0..40).map(|k| (0.314 * f64::from(k)).sin()).collect();
        let error = |between: Between| {
            let errors = (1..38).map(|k| between.value(&sine, k, 0.5) - (0.314 * (k as f64 + 0.5)).sin());
            errors.map(f64::abs).fold(0.0, f64::max)
        };
        assert!(error(Between::Curves) < 3e-4, "{}", error(Between::Curves));
        assert!((0.011..0.013).contains(&error(Between::Lines)), "{}", error(Between::Lines));
    }
}
