//! The FMI 2.0 C interface of a [`Model`](strut_model::Model): co-simulation and model exchange in one
//! library.
//!
//! [`export_fmu!`] makes a library of a model; everything else here is what the functions that it exports
//! are made of. Nothing is shared between instances and there are no globals: any number of instances
//! may live in any threads, each used by one thread at a time.
//!
//! Where the standard leaves a choice:
//! * A call that is refused (wrong state, null pointer, unknown variable, value out of bounds) returns
//!   `fmi2Error` and changes nothing; the host may go on. Of several variables in one call, those before
//!   the wrong one are set.
//! * A step that cannot be integrated returns `fmi2Discard`; time and states are those before it.
//! * A panic returns `fmi2Fatal`; after that only `fmi2FreeInstance` has an effect.
//! * Warnings and errors are always logged, discarded calls if debug logging is on.
//! * A saved state contains the phase of the state machine and the stop time. It belongs to the instance
//!   that saved it and is freed with it at the latest; as bytes it goes to any instance of the same FMU
//!   and type.

mod blob;
mod co_simulation;
mod export;
mod fmu_state;
mod instance;
mod life_cycle;
mod log;
mod model_exchange;
mod pointer;
mod resources;
pub mod state_table;
pub mod types;
mod uri;
mod variables;

pub use strut_model::Entry;

/// The functions of the standard, generic over the model.
pub mod functions {
    pub use crate::{
        co_simulation::{
            cancel_step, do_step, get_boolean_status, get_integer_status, get_real_output_derivatives,
            get_real_status, get_status, get_string_status, set_real_input_derivatives,
        },
        fmu_state::{
            de_serialize_fmu_state, free_fmu_state, get_fmu_state, serialize_fmu_state,
            serialized_fmu_state_size, set_fmu_state,
        },
        life_cycle::{
            enter_initialization_mode, exit_initialization_mode, free_instance, instantiate, reset,
            set_debug_logging, setup_experiment, terminate, types_platform, version,
        },
        model_exchange::{
            completed_integrator_step, enter_continuous_time_mode, enter_event_mode, get_continuous_states,
            get_derivatives, get_event_indicators, get_nominals_of_continuous_states, new_discrete_states,
            set_continuous_states, set_time,
        },
        variables::{
            get_boolean, get_directional_derivative, get_integer, get_real, get_string, set_boolean,
            set_integer, set_real, set_string,
        },
    };
}
