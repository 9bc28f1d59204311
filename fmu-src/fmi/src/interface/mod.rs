//! What FMI 2.0 and FMI 3.0 share: the instance, the way into it, its life and its log. A version adds its C types, its table
//! of states and the names of its functions.

pub mod blob;
pub mod instance;
pub mod life_cycle;
pub mod log;
pub mod model_exchange;
pub mod pointer;
pub mod resources;
pub mod saved_states;
pub mod state;
pub mod steps;
pub mod types;
mod uri;
pub mod variables;

pub use uri::to_path;
