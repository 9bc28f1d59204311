//! Error-controlled integration of ordinary differential equations on fixed-size arrays.
//!
//! An [`Integrator`] takes a [`System`] from one time to another, as often as a co-simulation calls
//! it. Short calls, one internal step each, are what it is made for: it allocates nothing, keeps
//! its step size and the last derivative between calls, and computes no root while the step size is
//! dictated by the caller.
//!
//! ```
//! use strut_integrators::{Array, Integrator, Method, Settings, System};
//!
//! struct Decay;
//!
//! impl System<[f64; 1]> for Decay {
//!     fn rates(&mut self, _t: f64, x: &[f64; 1]) -> [f64; 1] {
//!         [-x[0]]
//!     }
//!     fn jacobian(&mut self, _t: f64, _x: &[f64; 1]) -> (<[f64; 1] as Array>::Square, [f64; 1]) {
//!         ([[-1.0]].into(), [0.0])
//!     }
//! }
//!
//! let settings = Settings::new(1e-8, &[1.0]);
//! let mut integrator = Integrator::new(Method::Explicit, settings)?;
//! let mut x = [1.0];
//! for ms in 0..1000 {
//!     let t = f64::from(ms) / 1000.0;
//!     integrator.advance(&mut Decay, t, t + 0.001, &mut x)?;
//! }
//! assert!((x[0] - (-1.0_f64).exp()).abs() < 1e-8);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod array;
mod control;
mod error;
mod explicit;
mod integrator;
mod memory;
mod rosenbrock;
mod settings;
mod system;

pub use array::{Array, Square};
pub use error::{IntegrationError, InvalidSettings};
pub use integrator::{Integrator, Method, SolverStats};
pub use settings::{ABSOLUTE_FRACTION, Settings};
pub use system::System;
