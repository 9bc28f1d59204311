//! FMI 2.0.

mod co_simulation;
mod life_cycle;
mod log;
mod model_exchange;
pub mod state_table;
pub mod types;
mod variables;

/// The functions in the form that only this version has, generic over the model.
pub mod functions {
    pub use super::{
        co_simulation::{
            cancel_step, do_step, get_boolean_status, get_integer_status, get_real_output_derivatives,
            get_real_status, get_status, get_string_status, set_real_input_derivatives,
        },
        life_cycle::{
            enter_initialization_mode, instantiate, set_debug_logging, setup_experiment, types_platform,
            version,
        },
        model_exchange::{completed_integrator_step, new_discrete_states},
        variables::{
            get_boolean, get_directional_derivative, get_integer, get_real, get_string, set_boolean,
            set_integer, set_real, set_string,
        },
    };
}
