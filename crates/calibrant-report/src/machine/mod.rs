//! The report page on a sensor that a machine carried.

mod geometry;
mod mounting;
mod noise;
mod page;
mod parameters;
mod quantity;
mod validation;
mod verdict;

pub use mounting::mounting_in_words;
pub use page::machine_report;
pub use quantity::machine_unit;
pub use validation::{machine_validation_heading, machine_validation_rows, machine_validation_sentences};
