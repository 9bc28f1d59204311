//! Plants: masses and what holds them together.

mod quarter_car;

pub use quarter_car::QuarterCar;
