//! Pure functions of samples: spectra, filters, what a sensor does to a signal.

pub mod distortion;
pub(crate) mod random;
pub(crate) mod spectral;
