//! The experiment that separates rivals.

use serde::Serialize;

/// The excitation that separates the chosen effect from its rivals best within limits.
#[derive(Clone, Debug, Default, Serialize)]
pub struct DecidingExperiment {
    /// Whether it separates the effect from at least one rival.
    pub decides: bool,
    /// Number of excitations that were compared.
    pub compared: usize,
    /// Duration in seconds.
    pub duration: f64,
    /// What drives each input that moves; empty if no excitation decides.
    pub drives: Vec<Drive>,
    /// Limits, and how far the experiment goes.
    pub limits: Vec<ExperimentLimit>,
    /// The effect and each of its rivals.
    pub pairs: Vec<Distinction>,
    /// Name and text of each file beside the report.
    #[serde(skip)]
    pub files: Vec<(String, String)>,
}

/// What drives an input.
#[derive(Clone, Debug, Serialize)]
pub struct Drive {
    /// The input, as in the FMU.
    pub input: String,
    /// Its unit.
    pub unit: String,
    /// Shape of the signal: `chirp`, `sine`, `square wave`, `triangle` or `multisine`.
    pub shape: String,
    /// Largest distance from rest, in the unit.
    pub amplitude: f64,
    /// Its frequency in Hz, or the first one.
    pub frequency: f64,
    /// Its last frequency in Hz, if there are several.
    pub last_frequency: Option<f64>,
    /// The FMU that makes the signal; none: only the table does.
    pub source: Option<SourceFmu>,
}

/// An FMU that makes a signal.
#[derive(Clone, Debug, Serialize)]
pub struct SourceFmu {
    /// Its name.
    pub fmu: String,
    /// Its settings.
    pub settings: Vec<Setting>,
    /// Its parameters.
    pub parameters: Vec<Value>,
    /// Whether its signal has to pass a `SignalAdapter` of factor one, since it is a voltage.
    pub adapter: bool,
}

/// A setting of an FMU.
#[derive(Clone, Debug, Serialize)]
pub struct Setting {
    /// As in the FMU.
    pub name: String,
    /// What is chosen.
    pub choice: String,
}

/// A parameter of an FMU.
#[derive(Clone, Debug, Serialize)]
pub struct Value {
    /// As in the FMU.
    pub name: String,
    /// In `unit`.
    pub value: f64,
    /// SI, or volts in place of the input's unit behind a `SignalAdapter`.
    pub unit: String,
}

/// A limit of an experiment.
#[derive(Clone, Debug, Serialize)]
pub struct ExperimentLimit {
    /// The signal, or `rate of` it.
    pub signal: String,
    /// Its unit.
    pub unit: String,
    /// Largest magnitude.
    pub limit: f64,
    /// Largest magnitude in the experiment, as any of the models predicts it; none without an experiment.
    pub reached: Option<f64>,
}

/// How far an experiment separates an effect from a rival, whichever of them is true.
#[derive(Clone, Debug, Serialize)]
pub struct Distinction {
    /// Number and place of the effect.
    pub effect: String,
    /// Number and place of the rival.
    pub rival: String,
    /// Expected distance d' of their predictions, in standard deviations of the errors, the wrong model fitted.
    pub distance: f64,
    /// Probability of a right decision, Φ(d'/2).
    pub probability: f64,
    /// By how much the wrong model's error power exceeds the right one's, as a share.
    pub excess: f64,
    /// Whether that is enough.
    pub decides: bool,
    /// The distance in the estimation records.
    pub recorded: f64,
}
