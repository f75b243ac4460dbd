//! The report page on a sensor that a machine carried.

mod geometry;
mod noise;
mod page;
mod parameters;
mod quantity;
mod verdict;

pub use page::machine_report;
pub use quantity::machine_unit;
