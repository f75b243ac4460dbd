//! calibrant: calibration of inertial sensors.
pub mod arrowhead;
pub mod error;
pub mod estimate;
pub mod information;
pub mod motion;
pub mod sensor;
pub mod simulate;
pub mod study;
pub use error::{Error, Result};
