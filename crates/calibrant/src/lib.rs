//! calibrant: calibration of inertial sensors.
pub mod error;
pub mod estimate;
pub mod io;
pub mod motion;
pub mod sensor;
pub mod study;
pub use error::{Error, Result};
