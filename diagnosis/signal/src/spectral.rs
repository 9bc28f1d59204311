//! What a signal has at which frequency: power spectra, coherence, cumulative periodograms, lines, filters without phase; what
//! that makes it between its samples.

mod cumulative;
mod decimate;
mod filter;
mod line;
mod refine;
mod welch;

pub use cumulative::cumulative_periodogram;
pub use decimate::{decimated, left_of_noise};
pub use filter::{Line, about_line, filled, in_band};
pub use line::line;
pub use refine::{FINER, refined};
pub use rustfft::num_complex::Complex;
pub use welch::{below, coherence, periodogram, power_spectrum};

/// What is kept of the band below half the rate where a signal gets another rate.
pub const KEPT: f64 = 0.8;
