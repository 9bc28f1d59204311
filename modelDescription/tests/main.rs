//! The XML files of a model.

mod description;
mod fmi3;
mod model;
