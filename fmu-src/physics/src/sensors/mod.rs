//! What is measured, and what measuring makes of it; what adapts a signal.

mod analog;
mod angle_sensor_chain;
mod encoder;
mod sensor_chain;
mod signal_adapter;
mod velocity_estimator;

pub use analog::{
    AccelerationChannel, AnalogState, Channel, Converter, CurrentChannel, Dynamics, Filter, ForceChannel,
    Sensor,
};
pub use angle_sensor_chain::AngleSensorChain;
pub use encoder::{AngleEncoder, Encoder, PositionEncoder, Rounding};
pub use sensor_chain::SensorChain;
pub use signal_adapter::SignalAdapter;
pub use velocity_estimator::VelocityEstimator;
