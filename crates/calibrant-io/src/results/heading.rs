//! The first fields of every JSON file.

use super::json::SCHEMA;
use super::program::program;
use calibrant_core::json_object;

/// The first fields of a JSON file: to be flattened into it.
#[derive(Debug, Clone, Copy)]
pub struct Heading {
    kind: &'static str,
}

impl Heading {
    /// Of a file of this kind.
    #[must_use]
    pub fn of(kind: &'static str) -> Self {
        Self { kind }
    }
}

json_object! {
    Heading as of {
        /// The version of all JSON files. Added keys do not change it.
        schema: SCHEMA,
        /// What the file is.
        kind: of.kind,
        /// Who wrote it.
        program: program(),
    }
}
