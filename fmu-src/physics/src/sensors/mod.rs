//! What is measured, and what measuring makes of it.

mod analog;
mod angle_sensor_chain;
mod encoder;
mod sensor_chain;
mod velocity_estimator;

pub use analog::{
    AccelerationChannel, AnalogState, Channel, Converter, CurrentChannel, Dynamics, Filter, ForceChannel,
    Sensor,
};
pub use angle_sensor_chain::AngleSensorChain;
pub use encoder::{AngleEncoder, Encoder, PositionEncoder, Rounding};
pub use sensor_chain::SensorChain;
pub use velocity_estimator::VelocityEstimator;
