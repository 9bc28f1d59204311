//! What turns a command into a force between body and wheel.

mod linear_motor;

pub use linear_motor::LinearMotor;
