//! What a signal has at which frequency: power spectra, coherence, cumulative periodograms, filters without phase; what that
//! makes it between its samples.

mod cumulative;
mod filter;
mod refine;
mod welch;

pub(crate) use cumulative::cumulative_periodogram;
pub(crate) use filter::{about_line, filled, in_band};
pub(crate) use refine::{FINER, refined};
pub(crate) use welch::{coherence, periodogram, power_spectrum};

/// White noise of unit variance for tests, the same at every run.
#[cfg(test)]
fn white(seed: u64, count: usize) -> Vec<f64> {
    crate::data::check::tests::noise(seed, count)
}
