//! What the pictures of the report show.

use serde::Serialize;

/// What a mark says where the error is largest.
pub(crate) const LARGEST: &str = "largest error";

/// What the pictures of the report show.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Pictures {
    /// Measured and simulated signals of a validation record.
    pub traces: Vec<Trace>,
    /// Error power over frequency for each signal.
    pub spectra: Vec<Spectrum>,
    /// What of each signal's error follows from each input.
    pub coherences: Vec<Coherence>,
    /// Whether each signal's error is white.
    pub periodograms: Vec<Periodogram>,
    /// Error of the fitted starting model over a variable, in bins.
    pub scatters: Vec<Binned>,
    /// Balances of what was measured.
    pub parity: Vec<Parity>,
}

/// A signal over time.
#[derive(Clone, Debug, Serialize)]
pub struct Trace {
    /// As in the FMU.
    pub signal: String,
    /// SI.
    pub unit: String,
    /// In seconds.
    pub time: Vec<f64>,
    /// Measured.
    pub measured: Vec<f64>,
    /// Simulated by the starting model with fitted parameters.
    pub before: Vec<f64>,
    /// Simulated by the extended model.
    pub after: Vec<f64>,
    /// Where something is to be seen.
    pub marks: Vec<Mark>,
}

/// A stretch of time in which something is to be seen.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mark {
    /// What: `largest error`, or the part that acts beyond a threshold there.
    pub what: String,
    /// Its beginning in seconds.
    pub from: f64,
    /// Its end in seconds.
    pub to: f64,
}

/// Power spectral density.
#[derive(Clone, Debug, Serialize)]
pub struct Spectrum {
    /// As in the FMU.
    pub signal: String,
    /// SI; the densities are in its square per hertz.
    pub unit: String,
    /// In hertz.
    pub frequency: Vec<f64>,
    /// Of the measured signal.
    pub measured: Vec<f64>,
    /// Of the error of the starting model with fitted parameters.
    pub before: Vec<f64>,
    /// Of the error of the extended model.
    pub after: Vec<f64>,
}

/// Magnitude-squared coherence of a signal's error with an input: the share of its power that follows from the input
/// linearly.
#[derive(Clone, Debug, Serialize)]
pub struct Coherence {
    /// Whose error, as in the FMU.
    pub signal: String,
    /// As in the FMU.
    pub input: String,
    /// In hertz.
    pub frequency: Vec<f64>,
    /// Of the error of the starting model with fitted parameters; null where the input is no more than its noise.
    pub before: Vec<Option<f64>>,
    /// Of the error of the extended model.
    pub after: Vec<Option<f64>>,
    /// What signals that have nothing to do with each other exceed at one frequency in twenty.
    pub limit: f64,
}

/// Normalised cumulative periodogram of a signal's error: the share of its power up to each frequency.
#[derive(Clone, Debug, Serialize)]
pub struct Periodogram {
    /// Whose error, as in the FMU.
    pub signal: String,
    /// In hertz.
    pub frequency: Vec<f64>,
    /// Of the starting model with fitted parameters.
    pub before: Vec<f64>,
    /// Of the extended model.
    pub after: Vec<f64>,
    /// Largest distance of `before` from the straight line, which is white noise.
    pub distance_before: f64,
    /// The same of `after`.
    pub distance_after: f64,
    /// The distance below which white noise stays in 95 % of all cases.
    pub limit: f64,
}

/// A balance of measured signals, on the validation data: its residual is noise if the laws and the sensors in it are
/// right, whatever the rest of the model is like.
#[derive(Clone, Debug, Serialize)]
pub struct Parity {
    /// `r1` to `r5`.
    pub id: String,
    /// What is balanced.
    pub name: String,
    /// What is zero.
    pub equation: String,
    /// What it means if it is not.
    pub meaning: String,
    /// What is needed to form it and was not measured.
    pub needs: Option<String>,
    /// SI.
    pub unit: String,
    /// Highest frequency in hertz of what is balanced: all terms pass the same filter.
    pub band: f64,
    /// Root mean square with the laws of the starting model as it was given.
    pub rms_before: f64,
    /// The same with fitted parameters: the extended model, what was found being taken away.
    pub rms_fitted: f64,
    /// The same with the laws of the extended model, its faults of the sensors being removed.
    pub rms_after: f64,
    /// What the sensors' noise alone makes of it.
    pub noise: f64,
    /// In seconds, of the first validation record.
    pub time: Vec<f64>,
    /// What is left of the balance with fitted parameters.
    pub before: Vec<f64>,
    /// The same with the extended model.
    pub after: Vec<f64>,
}

/// Mean of an error over bins of a variable, by the direction in which the variable moves.
#[derive(Clone, Debug, Serialize)]
pub struct Binned {
    /// What is shown: `force missing in the strut`.
    pub quantity: String,
    /// Its unit.
    pub unit: String,
    /// Over which variable.
    pub variable: String,
    /// Its unit.
    pub variable_unit: String,
    /// Middle of each bin.
    pub x: Vec<f64>,
    /// Mean in each bin while the variable rises; null where there are too few samples.
    pub rising: Vec<Option<f64>>,
    /// Mean in each bin while the variable falls.
    pub falling: Vec<Option<f64>>,
    /// Twice the standard error of the means.
    pub two_sigma: Vec<Option<f64>>,
}
