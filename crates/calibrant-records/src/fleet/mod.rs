//! The fleet: how each parameter differs from sensor to sensor.

mod distribution;
mod frame;
mod parameters;

pub use distribution::Distribution;
pub use parameters::{FarSensor, Fleet, FleetParameter, LeftOut};
