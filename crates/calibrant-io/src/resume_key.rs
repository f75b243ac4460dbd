//! The key of a result: what it depends on, as one checksum.

use super::atomic_output::program;
use super::recording::checksum::hex;
use super::standard_input::open_input;
use sha2::{Digest, Sha256};
use std::io::Read;
use std::path::Path;

/// What a result depends on: program, options and files. Equal keys give equal results.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ResumeKey(pub(super) String);

impl ResumeKey {
    /// The key of these options, in words, and of the content of these files. `None` where a file cannot be read.
    ///
    /// The version of the program counts, too.
    #[must_use]
    pub fn of<'p>(options: &str, files: impl IntoIterator<Item = &'p Path>) -> Option<Self> {
        let mut hash = Sha256::new();
        let mut add = |text: &str| {
            hash.update((text.len() as u64).to_le_bytes());
            hash.update(text.as_bytes());
        };
        add(&program());
        add(options);
        for file in files {
            add(&checksum(file)?);
        }
        Some(Self(hex(hash)))
    }

    /// The key of a result that depends on further files, too.
    #[must_use]
    pub fn with<'p>(&self, files: impl IntoIterator<Item = &'p Path>) -> Option<Self> {
        Self::of(&self.0, files)
    }
}

/// The SHA-256 of a file, which need not fit into memory.
pub(super) fn checksum(path: &Path) -> Option<String> {
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
