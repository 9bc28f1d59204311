//! FMI 3.0.

mod derivatives;
mod events;
mod life_cycle;
mod references;
pub mod state_table;
mod steps;
pub mod types;
mod variables;

/// The functions in the form that only this version has, generic over the model.
pub mod functions {
    pub use super::{
        derivatives::{get_adjoint_derivative, get_directional_derivative, get_output_derivatives},
        events::{
            completed_integrator_step, enter_event_mode, get_number_of_continuous_states,
            get_number_of_event_indicators, update_discrete_states,
        },
        life_cycle::{
            enter_initialization_mode, instantiate_co_simulation, instantiate_model_exchange,
            instantiate_scheduled_execution, set_debug_logging, version,
        },
        steps::{do_step, enter_step_mode},
        variables::{
            absent, get_boolean, get_float64, get_int32, get_int64, get_string, never, set_boolean,
            set_float64, set_int32, set_int64, set_string,
        },
    };
}
