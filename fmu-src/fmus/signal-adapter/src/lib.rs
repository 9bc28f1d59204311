//! SignalAdapter as an FMU.

strut_fmi2::export_fmu!(strut_physics::sensors::SignalAdapter);
