//! The report page on a sensor that a machine carried.

mod geometry;
mod mounting;
mod noise;
mod page;
mod parameters;
mod quantity;
mod verdict;

pub use mounting::mounting_in_words;
pub use page::machine_report;
pub use quantity::machine_unit;
