//! Set-points and test signals: voltages, frequencies, recorded signals.

mod recorded_source;
mod source;

pub use recorded_source::RecordedSource;
pub use source::{FrequencySource, Shape, VoltageSource};
