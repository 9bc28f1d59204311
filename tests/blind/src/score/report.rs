//! What of a report is judged.

use serde::Deserialize;

use super::spot::ACTUATORS;

/// The fields of `report.json` that are judged, in formats 1 and 2. Other fields are ignored.
#[derive(Clone, Debug, Deserialize)]
pub struct Report {
    /// `no_effect`, `parameter_mismatch`, `identified`, `ambiguous`, `unmodelled`, `sensor_fault`, `model_inadequate` or `bad_data`.
    pub verdict: String,
    /// In the order of their gain.
    #[serde(default)]
    pub effects: Vec<Named>,
    /// Parameters of the starting model.
    #[serde(default)]
    pub nominal_parameters: Vec<Fitted>,
    /// Errors on the validation data.
    #[serde(default)]
    pub signals: Vec<Signal>,
    /// A cause without a name, in format 1.
    #[serde(default)]
    pub unnamed: Option<Unnamed>,
    /// Causes that no effect of the catalogue accounts for, the largest first. [`Report::read`] adds that of format 1.
    #[serde(default)]
    pub unmodelled: Vec<Unmodelled>,
    /// What is wrong with the data.
    #[serde(default)]
    pub data_problems: Vec<Problem>,
    /// How long it took.
    #[serde(default)]
    pub seconds: f64,
}

impl Report {
    /// Reads a report of either format.
    ///
    /// # Errors
    /// If it is no report.
    pub fn read(text: &str) -> serde_json::Result<Self> {
        let mut report: Self = serde_json::from_str(text)?;
        report.verdict = match report.verdict.as_str() {
            "named" => "identified".into(),
            "unnamed" => "unmodelled".into(),
            _ => report.verdict,
        };
        if let (Some(Unnamed { location, variable }), true) = (&report.unnamed, report.unmodelled.is_empty())
        {
            let depends_on = vec![variable.clone()];
            report.unmodelled =
                vec![Unmodelled { place: location.clone(), share: None, depends_on, frequency: None }];
        }
        let share = |it: &Unmodelled| it.share.unwrap_or(0.0);
        report.unmodelled.sort_by(|one, other| share(other).total_cmp(&share(one)));
        Ok(report)
    }
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

/// The error of one signal on the validation data; what could not be determined is none.
#[derive(Clone, Debug, Deserialize)]
pub struct Signal {
    /// As in the FMU.
    pub name: String,
    /// 1 − rms(e)/rms(z) of the extended model.
    pub fit_after: Option<f64>,
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

/// A cause that no effect of the catalogue accounts for, in format 2.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Unmodelled {
    /// An element, or a signal as the FMU names it.
    pub place: String,
    /// Share of the error that it accounts for.
    #[serde(default)]
    pub share: Option<f64>,
    /// What it depends on, the most likely first; see [`words`].
    #[serde(default)]
    pub depends_on: Vec<String>,
    /// Of what repeats or rings, in Hz.
    #[serde(default)]
    pub frequency: Option<f64>,
}

impl Unmodelled {
    /// Whether something is said to explain it. What has no share describes the rest beside a name.
    pub fn is_claimed(&self) -> bool {
        self.share != Some(0.0)
    }

    /// How many of its [words](Self::words) count.
    pub const COUNTED: usize = 2;

    /// What it depends on, in the words of [`WORDS`](crate::catalogue::WORDS) as far as possible.
    pub fn words(&self) -> Vec<&str> {
        self.depends_on.iter().flat_map(|text| words(text)).take(Self::COUNTED).collect()
    }
}

/// The words in a text: `deflection and velocity` has two. A signal's name stands for its quantity: a position is a deflection, and
/// the input of an actuator is a command.
pub fn words(text: &str) -> impl Iterator<Item = &str> {
    let parts = text.split(" and ").flat_map(|part| part.split([',', '+']));
    let parts = parts.map(str::trim).filter(|part| !part.is_empty());
    parts.map(|part| {
        if part == "force" || ACTUATORS.iter().any(|prefix| part.starts_with(prefix)) {
            return "command";
        }
        match part.rsplit('.').next().unwrap_or(part) {
            "position" | "displacement" | "angle" => "deflection",
            "speed" => "velocity",
            word => word,
        }
    })
}

/// Something wrong with the data.
#[derive(Clone, Debug, Deserialize)]
pub struct Problem {
    /// The signal.
    #[serde(default)]
    pub signal: String,
}
