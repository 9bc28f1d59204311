//! What of a report is judged.

use serde::Deserialize;

/// What of `report.json` is judged.
#[derive(Clone, Debug, Deserialize)]
pub struct Report {
    /// `no_effect`, `named`, …
    pub verdict: String,
    /// In the order of their gain.
    #[serde(default)]
    pub effects: Vec<Named>,
    /// Parameters of the starting model.
    #[serde(default)]
    pub base_parameters: Vec<Fitted>,
    /// Errors on the held-out data.
    #[serde(default)]
    pub signals: Vec<Signal>,
    /// A cause without a name.
    #[serde(default)]
    pub unnamed: Option<Unnamed>,
    /// What is wrong with the data.
    #[serde(default)]
    pub data_problems: Vec<Problem>,
    /// How long it took.
    #[serde(default)]
    pub seconds: f64,
}

/// A cause that was named.
#[derive(Clone, Debug, Deserialize)]
pub struct Named {
    /// Number in the catalogue.
    pub id: String,
    /// Where it sits: an element or a signal.
    #[serde(default)]
    pub element: String,
    /// With intervals.
    #[serde(default)]
    pub parameters: Vec<Interval>,
    /// Numbers, each perhaps with a place.
    #[serde(default)]
    pub ambiguous_with: Vec<String>,
}

/// A parameter's interval; an end that could not be determined is none.
#[derive(Clone, Debug, Deserialize)]
pub struct Interval {
    /// As in the FMU, or `signal.gain`.
    pub name: String,
    /// Lower end.
    pub low: Option<f64>,
    /// Upper end.
    pub high: Option<f64>,
}

/// A parameter of the starting model.
#[derive(Clone, Debug, Deserialize)]
pub struct Fitted {
    /// With its interval.
    #[serde(flatten)]
    pub interval: Interval,
    /// Whether it is said to be another one.
    #[serde(default)]
    pub mismatch: bool,
}

/// The error of one signal on the held-out data; what could not be determined is none.
#[derive(Clone, Debug, Deserialize)]
pub struct Signal {
    /// As in the FMU.
    pub name: String,
    /// 1 − rms(e)/rms(z) of the extended model.
    pub phi_after: Option<f64>,
    /// Root mean square of the error of the starting model with fitted parameters.
    pub rms_fitted: Option<f64>,
    /// The same of the extended model.
    pub rms_after: Option<f64>,
}

/// A cause without a name.
#[derive(Clone, Debug, Deserialize)]
pub struct Unnamed {
    /// Where it acts.
    pub location: String,
    /// Over which variable.
    #[serde(default)]
    pub variable: String,
}

/// Something wrong with the data.
#[derive(Clone, Debug, Deserialize)]
pub struct Problem {
    /// The signal.
    #[serde(default)]
    pub signal: String,
}
