//! What a diagnosis finds: the contents of `report.json`.

mod disagreement;
mod experiment;
mod pictures;
mod records;

use std::collections::BTreeMap;

use serde::Serialize;

use crate::data::check::DataProblem;

pub use crate::decision::evidence::Evidence;
pub use crate::decision::verdict::Verdict;
pub use crate::report::provenance::{Provenance, RecordOrigin};

pub use disagreement::{Disagreement, RecordValue};
pub use experiment::{DecidingExperiment, Distinction, Drive, ExperimentLimit, Setting, SourceFmu, Value};
pub(crate) use pictures::LARGEST;
pub use pictures::{Binned, Coherence, Mark, Parity, Periodogram, Pictures, Spectrum, Trace};
pub use records::{ColumnRead, RecordRead};

/// Version of the format of `report.json`: raised when a reader of an older one would misunderstand it.
pub const FORMAT: u32 = 3;

/// All that a diagnosis has found.
#[derive(Clone, Debug, Serialize)]
pub struct Findings {
    /// [`FORMAT`].
    pub format: u32,
    /// The rig, as the user named it.
    pub rig: String,
    /// Names of the estimation records.
    pub train: Vec<String>,
    /// Names of the validation records.
    pub test: Vec<String>,
    /// The verdict.
    pub verdict: Verdict,
    /// The verdict in one or two sentences for an engineer.
    pub summary: String,
    /// What the time limit left undone; none if all was done.
    pub unfinished: Option<String>,
    /// Nominal parameters on which records disagree, the clearest first.
    pub disagreements: Vec<Disagreement>,
    /// The identified effects, the largest first.
    pub effects: Vec<Effect>,
    /// The nominal parameters: those of the starting model that were fitted.
    pub nominal_parameters: Vec<NominalParameter>,
    /// The errors of the models on the validation data.
    pub signals: Vec<Signal>,
    /// The extended model's states where the simulation of each validation stretch starts.
    pub initial_states: Vec<Start>,
    /// What signals pass on their way into the extended model and out of it; its FMU does not hold it.
    pub distortions: Vec<SignalDistortion>,
    /// Where the power of each signal's error goes, on the validation records.
    pub account: Vec<SignalAccount>,
    /// What is missing and in no catalogue, the largest first.
    pub unmodelled: Vec<Unmodelled>,
    /// The missing signal at the likeliest place, before anything was explained.
    pub missing: Option<Missing>,
    /// What would settle doubts.
    pub experiment: Option<String>,
    /// The experiment that is computed where rivals remain.
    pub deciding_experiment: Option<DecidingExperiment>,
    /// What is wrong with the data.
    pub data_problems: Vec<DataProblem>,
    /// How each record was read, in the order of estimation and validation records.
    pub records: Vec<RecordRead>,
    /// Every candidate.
    pub candidates: Vec<Candidate>,
    /// What the pictures show.
    pub pictures: Pictures,
    /// How long the diagnosis took, in seconds.
    pub seconds: f64,
    /// Version, command, date and hashes of the records; none if nobody says.
    pub provenance: Option<Provenance>,
}

impl Findings {
    /// That the data cannot be used.
    pub fn of_bad_data(rig: &str, train: Vec<String>, test: Vec<String>, problems: Vec<DataProblem>) -> Self {
        let texts =
            problems.iter().filter(|problem| problem.fatal).map(|it| format!("{}: {}", it.record, it.text));
        Self {
            format: FORMAT,
            rig: rig.into(),
            train,
            test,
            verdict: Verdict::BadData,
            summary: format!("The data cannot be used. {}", texts.collect::<Vec<_>>().join(" ")),
            unfinished: None,
            disagreements: Vec::new(),
            effects: Vec::new(),
            nominal_parameters: Vec::new(),
            signals: Vec::new(),
            initial_states: Vec::new(),
            distortions: Vec::new(),
            account: Vec::new(),
            unmodelled: Vec::new(),
            missing: None,
            experiment: None,
            deciding_experiment: None,
            data_problems: problems,
            records: Vec::new(),
            candidates: Vec::new(),
            pictures: Pictures::default(),
            seconds: 0.0,
            provenance: None,
        }
    }
}

/// An effect that was found.
#[derive(Clone, Debug, Serialize)]
pub struct Effect {
    /// Its number in the catalogue: `01`.
    pub id: String,
    /// Where it acts: `strut`, `guide`, `tire`, `actuator`, or the signal of a sensor.
    pub element: String,
    /// What it is called.
    pub name: String,
    /// Its law in plain text.
    pub equation: String,
    /// Its parameters.
    pub parameters: Vec<EffectParameter>,
    /// Why it is believed.
    pub evidence: Evidence,
    /// Numbers and places of the effects that cannot be told from it with these data.
    pub ambiguous_with: Vec<String>,
    /// What would tell them apart.
    pub experiment: Option<String>,
}

/// A parameter of an effect.
#[derive(Clone, Debug, Serialize)]
pub struct EffectParameter {
    /// As in the FMU, or for a sensor `signal.gain`.
    pub name: String,
    /// In `unit`.
    pub value: f64,
    /// SI.
    pub unit: String,
    /// Lower end of the 95 % interval.
    pub low: f64,
    /// Upper end of the 95 % interval.
    pub high: f64,
    /// Both ends of it if the parameter that keeps its value were exact, so that the ratio to it is this sure; none where the records tell
    /// the scale.
    pub of_ratio: Option<[f64; 2]>,
    /// What it is not beyond, where the value is at an end of its range: then the records tell no value, only this.
    pub limit: Option<f64>,
    /// Whether the records reach it, if it is a threshold; otherwise they tell no value, and this one is the farthest that is tried.
    pub reached: bool,
}

/// A parameter of the starting model.
#[derive(Clone, Debug, Default, Serialize)]
pub struct NominalParameter {
    /// As in the FMU.
    pub name: String,
    /// SI.
    pub unit: String,
    /// What the model started with.
    pub before: f64,
    /// What the data say.
    pub after: f64,
    /// Lower end of the 95 % interval.
    pub low: f64,
    /// Upper end of the 95 % interval.
    pub high: f64,
    /// Both ends of it if the parameter that keeps its value were exact; none where the records tell the scale.
    pub of_ratio: Option<[f64; 2]>,
    /// Whether the difference is both significant and large enough to matter.
    pub mismatch: bool,
    /// Whether most of the interval is the tolerance of the parameter set: the data tell it only together with others.
    pub from_parameter_set: bool,
    /// Whether the records tell only ratios to it, so that it keeps the parameter set's value.
    pub is_yardstick: bool,
    /// Whether the data contradict the value that the user gave with its standard deviation.
    pub contradicted: bool,
    /// Effects that do the same on these records: of a parameter that the starting model is without, what it does; of another, what it
    /// and others do together.
    pub equivalent_effects: Vec<String>,
}

/// The error of one signal, on the validation data.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Signal {
    /// As in the FMU.
    pub name: String,
    /// SI.
    pub unit: String,
    /// 1 − rms(e)/rms(z), TUM eq. 16, of the starting model.
    pub fit_before: f64,
    /// The same of the starting model with fitted parameters.
    pub fit_fitted: f64,
    /// The same of the extended model.
    pub fit_after: f64,
    /// The same where the measured inputs are freed of their noise, which a master's are not.
    pub fit_without_input_noise: f64,
    /// Root mean square of the starting model's error.
    pub rms_before: f64,
    /// The same of the starting model with fitted parameters.
    pub rms_fitted: f64,
    /// The same of the extended model.
    pub rms_after: f64,
    /// Root mean square of the noise: of its sensor's, and of what noise of the measured inputs makes of it.
    pub noise_floor: f64,
    /// Root mean square of the difference of two repeats, over √2; where there are repeats.
    pub repeatability: Option<f64>,
}

/// Where a simulation starts.
#[derive(Clone, Debug, Serialize)]
pub struct Start {
    /// The file.
    pub record: String,
    /// Time since the record's first sample in seconds.
    pub time: f64,
    /// Time at which the stretch ends.
    pub end: f64,
    /// Values of the FMU's states by their names, SI.
    pub states: BTreeMap<String, f64>,
}

/// What a signal passes on its way into or out of the extended model:
/// `(1 + gain) lag(delay(y + quadratic y² + cubic y³)) + offset + drift t`, held within the limit.
#[derive(Clone, Debug, Serialize)]
pub struct SignalDistortion {
    /// The signal, as in the FMU.
    pub signal: String,
    /// Whether it goes into the model.
    pub input: bool,
    /// Its parameters by their names, SI.
    #[serde(flatten)]
    pub amounts: BTreeMap<&'static str, f64>,
    /// The step response without a name that the lag's output passes, straight between its points; empty if there is none.
    pub response: Vec<Answer>,
}

/// A point of a step response.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Answer {
    /// Time after the step in seconds.
    pub after: f64,
    /// The response to a step of one.
    pub value: f64,
}

/// Where the power of a signal's error goes: shares of the starting model's that add up to one.
#[derive(Clone, Debug, Default, Serialize)]
pub struct SignalAccount {
    /// As in the FMU.
    pub signal: String,
    /// Root mean square of the starting model's error, in the signal's unit.
    pub error: f64,
    /// Noise of its sensor and of the measured inputs.
    pub noise: f64,
    /// What fitting the nominal parameters takes away; negative if it makes this signal worse.
    pub parameters: f64,
    /// What each effect takes away, in the order of `effects`; a curve without a name comes in the order in which it was found.
    pub effects: Vec<AccountItem>,
    /// What features without a name explain of the rest.
    pub unmodelled: f64,
    /// What nothing explains.
    pub unexplained: f64,
    /// Whether more is missing than three times the noise and a tenth of the signal.
    pub open: bool,
}

/// What an effect takes away of a signal's error.
#[derive(Clone, Debug, Serialize)]
pub struct AccountItem {
    /// The effect.
    pub name: String,
    /// Share of the starting model's error power.
    pub share: f64,
}

/// Something missing that no effect of the catalogue explains.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Unmodelled {
    /// Where: an element such as `strut`, or the signal of a sensor.
    pub place: String,
    /// Unit of the missing signal.
    pub unit: String,
    /// What it depends on, the most important first; empty if it follows nothing that was recorded.
    pub depends_on: Vec<String>,
    /// Share of what is missing that it explains, on the estimation records.
    pub share: f64,
    /// The same on the validation records with the same amounts.
    pub validation_share: f64,
    /// By how much the fit of the worst signal would rise with it.
    pub improvement: f64,
    /// Frequency in Hz where it has one.
    pub frequency: Option<f64>,
    /// From where to where in Hz a signal that nothing explains has four fifths of its power.
    pub band: Option<[f64; 2]>,
    /// One sentence.
    pub description: String,
    /// Its curve, where it is one.
    pub curve: Option<Curve>,
}

/// A missing signal at a place over a part of the first estimation record.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Missing {
    /// Where: an element, or the signal of a sensor.
    pub place: String,
    /// Its unit.
    pub unit: String,
    /// Places that no record of these signals could tell from it.
    pub equivalent_places: Vec<String>,
    /// Every place, the likeliest first.
    pub places: Vec<PlaceLikelihood>,
    /// Time since the record's beginning in seconds.
    pub time: Vec<f64>,
    /// The missing signal.
    pub value: Vec<f64>,
    /// Its standard deviation.
    pub deviation: Vec<f64>,
    /// Deflection there, SI; empty at a sensor.
    pub deflection: Vec<f64>,
    /// Velocity there, SI; empty at a sensor.
    pub velocity: Vec<f64>,
}

/// How likely it is that a signal is missing at a place.
#[derive(Clone, Debug, Serialize)]
pub struct PlaceLikelihood {
    /// Where.
    pub place: String,
    /// Logarithm of the likelihood, beyond that of nothing missing but a little everywhere.
    pub log_likelihood: f64,
}

/// A force, or another quantity, over a variable; without points where it is only known to be there.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Curve {
    /// Where it acts.
    pub location: String,
    /// What it is: `force`, `damping rate`, `step response` of a sensor; empty if it is not known.
    pub quantity: String,
    /// Over which variable.
    pub variable: String,
    /// Unit of the variable.
    pub variable_unit: String,
    /// Unit of the quantity.
    pub unit: String,
    /// The variable's values, within what the data cover.
    pub x: Vec<f64>,
    /// The quantity.
    pub y: Vec<f64>,
    /// Lower end of its 95 % interval.
    pub low: Vec<f64>,
    /// Upper end of its 95 % interval.
    pub high: Vec<f64>,
}

impl Curve {
    /// The [`Curve::quantity`] of a sensor's.
    pub const RESPONSE: &'static str = "step response";

    /// Whether it is of a sensor, not of the plant.
    pub fn is_of_sensor(&self) -> bool {
        self.quantity == Self::RESPONSE
    }
}

/// A candidate that was looked at.
#[derive(Clone, Debug, Serialize)]
pub struct Candidate {
    /// Its number in the catalogue.
    pub id: String,
    /// Where it acts.
    pub element: String,
    /// What it is called.
    pub name: String,
    /// Share of what was missing first that it explains on its own, on the estimation records.
    pub share: f64,
    /// The same on the validation records with the same amounts.
    pub validation_share: f64,
    /// Whether it was fitted.
    pub fitted: bool,
    /// Its parameters in its fit, the one that says how much of it there is first.
    pub values: Vec<FittedValue>,
    /// What its fit showed.
    pub evidence: Option<Evidence>,
    /// What became of it.
    pub outcome: String,
}

/// A parameter in the fit of a candidate; it has no interval, as nothing is claimed of it.
#[derive(Clone, Debug, Serialize)]
pub struct FittedValue {
    /// As in the FMU, or for a sensor `signal.gain`.
    pub name: String,
    /// In `unit`.
    pub value: f64,
    /// SI.
    pub unit: String,
}
