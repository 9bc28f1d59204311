//! QuarterCar as an FMU.
