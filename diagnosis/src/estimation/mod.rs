//! Estimating parameters: hypotheses, output error, least squares, intervals.

pub mod beside;
pub mod comparison;
pub mod coordinates;
pub mod deadline;
pub mod fit;
pub mod held;
pub mod hypothesis;
pub mod intervals;
pub mod lsq;
pub mod scale;
pub mod unknowns;
