//! FMI 3.0: from the same declarations to its elements.

mod content;
mod schema;
mod terminals;

pub use content::document;
pub use terminals::terminals;
