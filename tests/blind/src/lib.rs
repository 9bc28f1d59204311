//! The blind benchmark: measured-looking data of rigs with hidden causes, and the score of whoever names them.
//!
//! It shares no code with the models or with the diagnosis: its own equations ([`car`], [`strut`]), its own
//! integrator at 20 kHz, friction that sticks ([`friction`]) instead of a tanh, exact delays, its own sensors.

pub mod car;
pub mod excitation;
pub mod friction;
pub mod random;
pub mod sensors;
pub mod strut;
