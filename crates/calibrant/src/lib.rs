//! calibrant: calibration of inertial sensors.
pub mod error;
pub mod estimate;
pub mod motion;
pub mod report;
pub mod sensor;
pub mod study;
pub use error::{Error, Result};
