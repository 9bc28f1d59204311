//! Measured records: reading, mapping to the model's names and units, checking.

/// A measurement: channels over common times.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// The file's name without its folder.
    pub name: String,
    /// Times of the samples in seconds, as the file has them.
    pub time: Vec<f64>,
    /// The channels, in the file's order.
    pub channels: Vec<Channel>,
}

/// One measured signal.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name: the file's, or after mapping the model's.
    pub name: String,
    /// Its unit's symbol: the file's, or after mapping the model's.
    pub unit: String,
    /// One value for each time; NaN where the sample is missing.
    pub values: Vec<f64>,
}
