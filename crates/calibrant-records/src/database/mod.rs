//! The database: its schema, what is written to it, and questions to it.

mod checksum;
mod failure;
mod model;
mod query;
mod records;
mod repeated_recording;
mod schema;
mod writable;

pub use query::{KeptRecord, RecordFilter};
pub use records::{Inserted, Records};
#[cfg(test)]
pub(crate) use writable::check_writable;
