//! Calibrations as JSON. Vectors are over the axes that were calibrated; keys of readings end in their unit.

mod budget;
mod calibration;
mod fit;
mod gyroscope;
mod holds;
mod motion;

pub use budget::Budget;
pub use fit::FitInUnit;
