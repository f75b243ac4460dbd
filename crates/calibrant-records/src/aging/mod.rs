//! What a sensor does over the years: its aging, its history, and which sensors drift most.

mod drift;
mod history;
mod line;
mod sensor_aging;

pub use drift::SensorDrift;
pub use history::{SensorChange, SensorHistory};
pub use line::{Aging, Dated};
pub use sensor_aging::{DatedCalibration, QuantityAging, aging_of};
