//! Numbers, units, declared variables and models: what every Strut FMU is written in.
//!
//! A variable is declared once, beside the equation that uses it, with its unit, start value, bounds and
//! doc comment ([`Variables`], [`Settings`]). The equations are generic over their scalar ([`Real`]) in
//! states, inputs *and* parameters, so that one writing serves simulation, derivatives, dependency
//! analysis and SIMD. A [`Model`] is those equations; a [`Simulation`] runs it, an [`Interface`]
//! describes it.

// The derive macros name this crate, also inside it.
extern crate self as strut_model;

mod bundle;
mod dependencies;
mod entry;
mod error;
mod interface;
mod lanes;
mod layout;
mod log;
mod model;
mod noise;
mod parameter_set;
mod real;
mod setting;
mod simulation;
mod switching;
mod tanh;
pub mod unit;

pub use bundle::{Bundle, Declaration, Declarations, NoVariables};
#[doc(hidden)]
pub use bundle::{each, elements};
pub use dependencies::Dependencies;
pub use entry::{Entry, Inputs, Instance, Trajectory};
pub use error::Error;
pub use interface::{
    Causality, Dependency, Initial, Interface, Numbering, Structure, Table, Timely, Variability, Variable,
    VariableKind,
};
pub use lanes::Lanes;
pub use log::LOG_CATEGORIES;
pub use model::{About, Equation, Experiment, Instant, Kind, Method, Model, Stimulus};
pub use noise::{noise, uniform};
pub use parameter_set::{Given, ParameterSet};
pub use real::Real;
pub use setting::{Enumeration, NoSettings, Setting, SettingDeclaration, SettingKind, Settings, Value};
pub use simulation::{Access, Simulation, Snapshot};
pub use strut_integrators::{Array, IntegrationError, SolverStats};
pub use strut_model_derive::{Choice, Settings, Variables};
