//! Effects: what a real element does beyond the linear textbook law.
//!
//! One file an effect: its parameters, its equation, its source, its tests. An effect sits on any element
//! and is neutral at its start values, so that a model without it and a model with it switched off are
//! the same.

mod asymmetry;
mod coulomb;
mod lift_off;
mod pwm;
mod quadratic;

pub use asymmetry::Asymmetry;
pub use coulomb::{Coulomb, RotaryCoulomb};
pub use lift_off::LiftOff;
pub use pwm::{Pwm, PwmOptions};
pub use quadratic::Quadratic;
