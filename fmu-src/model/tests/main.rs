//! A simulation of models that are small enough to calculate by hand.

mod models;
mod simulation;
mod snapshots;
