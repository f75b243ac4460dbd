//! The database: its schema, what is written to it, and questions to it.

mod blob;
mod checksum;
mod failure;
mod query;
mod records;
mod repeated_recording;
mod schema;
mod writable;

pub use query::{KeptRecord, RecordFilter};
pub use records::{Inserted, Records};
#[cfg(test)]
pub(crate) use writable::check_writable;
