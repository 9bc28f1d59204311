//! Effects: what a real element does beyond the linear textbook law.
//!
//! One file an effect: its parameters, its equation, its source, its tests. An effect sits on any element
//! and is neutral at its start values, so that a model without it and a model with it switched off are
//! the same.
//!
//! `docs/effects.md` numbers the effects that a difference between measurement and model is looked for in.

mod asymmetry;
mod backlash;
mod clevis;
mod cogging;
mod constant;
mod coulomb;
mod curve;
mod enveloping;
mod fade;
mod frame;
mod knee;
mod lift_off;
mod linkage;
mod load_dependence;
mod maxwell;
mod mount;
mod orifice;
mod presliding;
mod progression;
mod pwm;
mod quadratic;
mod saturation;
mod slew;
mod stop;
mod stribeck;
mod switched_on;
mod transport;
mod yield_force;

pub use asymmetry::Asymmetry;
pub use backlash::behind_backlash;
pub use clevis::{Clevis, ClevisState};
pub use cogging::Cogging;
pub use constant::with_constant;
pub use coulomb::{Coulomb, RotaryCoulomb};
pub use curve::{CommandCurve, CompressionCurve, ForceCurve, POINTS, VelocityCurve};
pub use enveloping::{Enveloping, EnvelopingState};
pub use fade::Fade;
pub use frame::{FrameMode, FrameState};
pub use knee::{Knee, dead_zone};
pub use lift_off::LiftOff;
pub use linkage::Linkage;
pub use load_dependence::LoadDependence;
pub use maxwell::{Maxwell, MaxwellState};
pub use mount::{Mount, MountState};
pub use orifice::Orifice;
pub use presliding::{Presliding, PreslidingState};
pub use progression::Progression;
pub use pwm::{Pwm, PwmOptions};
pub use quadratic::Quadratic;
pub use saturation::Saturation;
pub use slew::{Slew, SlewState};
pub use stop::Stop;
pub use stribeck::Stribeck;
pub use switched_on::switched_on;
pub use transport::{DelayState, LagState, behind_lag, delayed, lagged};
pub use yield_force::YieldForce;
