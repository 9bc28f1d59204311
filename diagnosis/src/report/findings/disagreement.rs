//! Records that want different parameters.

use serde::Serialize;

/// A nominal parameter of which two records want different values.
#[derive(Clone, Debug, Serialize)]
pub struct Disagreement {
    /// As in the FMU.
    pub name: String,
    /// SI.
    pub unit: String,
    /// The parameter that is the same in both records, where they tell only ratios.
    pub yardstick: Option<String>,
    /// What the two records want that disagree most clearly, the lower value first.
    pub records: [RecordValue; 2],
}

/// The value of a parameter that a record on its own would choose.
#[derive(Clone, Debug, Serialize)]
pub struct RecordValue {
    /// The file.
    pub record: String,
    /// The value.
    pub value: f64,
    /// Lower end of its 95 % interval.
    pub low: f64,
    /// Upper end of its 95 % interval.
    pub high: f64,
}
