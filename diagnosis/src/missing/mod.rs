//! What signal is missing in a model, and where: before any effect is named.
//!
//! Every place where something may be missing is a [port](ports). A smoother about the model's own linearisation estimates
//! the missing signal, port by port, from all records; the likelihoods say where something is missing (N. R. Kristensen,
//! H. Madsen, S. B. Jørgensen, A method for systematic improvement of stochastic grey-box models, Computers & Chemical
//! Engineering 28 (2004)).

pub mod filter;
pub mod innovations;
pub mod likelihood;
pub mod locate;
pub mod ports;
pub mod trajectory;
