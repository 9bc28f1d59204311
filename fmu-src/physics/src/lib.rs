//! The equations of active suspensions.
