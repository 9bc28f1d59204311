//! VoltageSource as an FMU.

strut_fmi2::export_fmu!(strut_physics::sources::VoltageSource);
