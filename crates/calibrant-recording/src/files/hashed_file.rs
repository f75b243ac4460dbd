//! A file by its content.

use super::standard_input::open_input;
use crate::files::checksum::{hex, hex_of_lists, hex_sha256};
use crate::files::file_name::file_name;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::io::Read;
use std::path::Path;

/// A file by its content.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct HashedFile {
    /// Name of the file, without its directory.
    pub file: String,
    /// SHA-256 of the file, hexadecimal.
    pub sha256: String,
}

impl HashedFile {
    /// What is in memory, by the name that results give it.
    #[must_use]
    pub fn of_bytes(name: impl Into<String>, bytes: &[u8]) -> Self {
        Self { file: name.into(), sha256: hex_sha256(bytes) }
    }

    /// Lists of numbers in memory, each with its name.
    #[must_use]
    pub fn of_numbers(name: impl Into<String>, lists: &[(&str, Vec<f64>)]) -> Self {
        let lists = lists.iter().map(|(name, values)| (*name, values.iter().copied()));
        Self { file: name.into(), sha256: hex_of_lists(lists) }
    }

    /// A file as it is now; `None` where it cannot be read.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        Some(Self { file: file_name(path), sha256: checksum(path)? })
    }
}

/// The SHA-256 of a file, which need not fit into memory.
pub fn checksum(path: &Path) -> Option<String> {
    let mut file = open_input(path).ok()?;
    let (mut hash, mut piece) = (Sha256::new(), vec![0; 1 << 16]);
    loop {
        match file.read(&mut piece) {
            Ok(0) => return Some(hex(hash)),
            Ok(length) => hash.update(&piece[..length]),
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(_) => return None,
        }
    }
}
