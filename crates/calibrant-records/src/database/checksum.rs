//! Checksums in the database: SQLite has none, and a number of which a byte has changed is still a number.

use rusqlite::Row;
use rusqlite::types::ValueRef;
use sha2::{Digest, Sha256};

/// The checksum of values as they stand in tables.
#[derive(Default)]
pub(super) struct Checksum(Sha256);

impl Checksum {
    /// Takes this number of values from the beginning of a row: each with its type and its length.
    pub(super) fn take(&mut self, row: &Row<'_>, values: usize) -> rusqlite::Result<()> {
        for place in 0..values {
            match row.get_ref(place)? {
                ValueRef::Null => self.value(b'n', &[]),
                ValueRef::Integer(number) => self.value(b'i', &number.to_le_bytes()),
                ValueRef::Real(number) => self.value(b'r', &number.to_le_bytes()),
                ValueRef::Text(bytes) => self.value(b't', bytes),
                ValueRef::Blob(bytes) => self.value(b'b', bytes),
            }
        }
        Ok(())
    }

    fn value(&mut self, kind: u8, bytes: &[u8]) {
        self.0.update([kind]);
        self.0.update((bytes.len() as u64).to_le_bytes());
        self.0.update(bytes);
    }

    /// Its bytes, as they are kept.
    pub(super) fn bytes(self) -> Vec<u8> {
        self.0.finalize().to_vec()
    }
}
