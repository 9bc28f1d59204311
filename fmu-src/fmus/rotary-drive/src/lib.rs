//! RotaryDrive as an FMU.

strut_fmi::export_fmu!(strut_physics::rigs::RotaryDrive);
