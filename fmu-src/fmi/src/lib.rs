//! The C interfaces FMI 2.0 and FMI 3.0 of a [`Model`](strut_model::Model): co-simulation and model exchange, both versions in
//! one library.
//!
//! [`export_fmu!`] makes a library of a model; everything else here is what the functions that it exports
//! are made of. Nothing is shared between instances and there are no globals: any number of instances
//! may live in any threads, each used by one thread at a time. The names of the two versions differ (`fmi2…`, `fmi3…`), and
//! an instance of one is none of the other.
//!
//! Where the standards leave a choice:
//! * A call that is refused (wrong state, null pointer, unknown variable, value out of bounds) returns
//!   an error and changes nothing; the host may go on. (FMI 3.0 has the instance terminated then: what a host may still
//!   call there works.) Of several variables in one call, those before the wrong one are set.
//! * A step that cannot be integrated is discarded; time and states are those before it.
//! * A panic is fatal; after that only freeing the instance has an effect.
//! * A saved state contains the phase of the state machine and the stop time. It belongs to the instance
//!   that saved it and is freed with it at the latest; as bytes it goes to any instance of the same FMU
//!   and type.

mod export;
pub mod fmi2;
pub mod fmi3;
mod interface;

pub use strut_model::Entry;

/// The functions that both versions share, generic over the model; the first argument is the version's function.
pub mod shared {
    pub use crate::interface::{
        life_cycle::{exit_initialization_mode, free_instance, reset, terminate},
        model_exchange::{
            enter_continuous_time_mode, enter_event_mode, get_continuous_states, get_derivatives,
            get_event_indicators, get_nominals_of_continuous_states, set_continuous_states, set_time,
        },
        saved_states::{
            de_serialize_fmu_state, free_fmu_state, get_fmu_state, serialize_fmu_state,
            serialized_fmu_state_size, set_fmu_state,
        },
        state::{Function, Kind, Phase, State, StateSet, Version},
    };
}
