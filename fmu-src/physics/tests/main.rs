//! The models against published numbers and independent solutions.

mod ajala;
mod catalogue;
mod common;
mod ports;
mod reference;
mod tum_rig;
