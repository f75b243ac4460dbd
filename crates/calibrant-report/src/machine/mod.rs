//! The sheet of a calibration of a sensor that a machine carried.

mod geometry;
mod mounting;
mod noise;
mod page;
mod parameters;
mod quantity;
mod validation;
mod verdict;

pub use page::machine_sheet;
