//! Many calibrations of many sensors: what a sensor does over the years, and how the sensors differ.
//!
//! Two calibrations of one sensor are compared by [`Comparison`](crate::estimate::Comparison). Several show its [`Aging`]: a line over time through each quantity that
//! does not depend on the true frame. A [`Distribution`] says how a quantity differs from sensor to sensor.

mod aging;
mod distribution;
mod sensor_aging;

pub use aging::{Aging, Dated};
pub use distribution::Distribution;
pub use sensor_aging::{DatedCalibration, QuantityAging, aging_of};
