//! The blind benchmark: measured-looking data of rigs with hidden causes, and the score of whoever names them.
//!
//! It shares no code with the models or with the diagnosis: its own equations ([`car`], [`servo`], [`dyno`],
//! [`drive`], [`pneumatic`], [`pump`], [`sas`], [`strut`]), its own integrator at 20 kHz, friction that sticks ([`friction`])
//! instead of a tanh, exact delays, its own [`sensors`]. [`catalogue`] says what can be hidden, [`case`](mod@case) what is asked for,
//! [`generate()`] makes it.

pub mod ablation;
pub mod car;
pub mod case;
pub mod cases;
pub mod catalogue;
pub mod drive;
pub mod dyno;
pub mod excitation;
pub mod files;
pub mod four_wheels;
pub mod friction;
pub mod generate;
pub mod pneumatic;
pub mod pump;
pub mod random;
pub mod rig;
pub mod run;
pub mod sas;
pub mod score;
pub mod sensors;
pub mod servo;
pub mod strut;
pub mod timed;

pub use case::{Case, Generated, Hidden, Plant, Sensors, Table, Truth};
pub use generate::generate;
