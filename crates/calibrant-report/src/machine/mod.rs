//! The sheet of a calibration of a sensor that a machine carried.

mod budget;
mod geometry;
mod mounting;
mod noise;
mod page;
mod parameters;
mod quantity;
mod validation;
mod verdict;

pub(crate) use budget::{bars, shares};
pub use page::machine_sheet;
