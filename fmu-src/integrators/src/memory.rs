//! What an integrator remembers from one call to the next.

use crate::array::Array;

/// All that a later call depends on, apart from the settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Memory<A> {
    /// The step that the error control suggests; zero before the first one is chosen.
    pub step: f64,
    /// Error of the last step that the controller looked at, as a fraction of the tolerance.
    pub error: f64,
    /// Where `rates` were evaluated.
    pub time: f64,
    /// f(time, x) for the state at which the last call ended.
    pub rates: A,
    /// Whether `time` and `rates` hold.
    pub valid: bool,
}

impl<A: Array> Memory<A> {
    pub fn new() -> Self {
        Memory { step: 0.0, error: 1e-4, time: 0.0, rates: A::zeros(), valid: false }
    }

    pub fn save(&self) -> impl Iterator<Item = u64> + '_ {
        [u64::from(self.valid), self.step.to_bits(), self.error.to_bits(), self.time.to_bits()]
            .into_iter()
            .chain(self.rates.as_slice().iter().map(|rate| rate.to_bits()))
    }

    /// None if words are missing, or are not what `save` gives.
    pub fn load(words: &mut impl Iterator<Item = u64>) -> Option<Self> {
        let valid = match words.next()? {
            0 => false,
            1 => true,
            _ => return None,
        };
        let mut number = || words.next().map(f64::from_bits);
        let step = number().filter(|step| *step >= 0.0 && step.is_finite())?;
        let error = number().filter(|error| *error > 0.0 && error.is_finite())?;
        let time = number()?;
        let mut rates = A::zeros();
        for rate in rates.as_mut_slice() {
            *rate = number()?;
        }
        Some(Memory { step, error, time, rates, valid })
    }
}
