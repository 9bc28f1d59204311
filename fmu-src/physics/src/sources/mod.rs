//! Set-points and test signals: voltages, frequencies.

mod source;

pub use source::{FrequencySource, Shape, VoltageSource};
