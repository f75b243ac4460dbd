//! The key of a result: what it depends on, as one checksum.

use calibrant_recording::files::checksum::hex;
use calibrant_recording::files::hashed_file::HashedFile;
use calibrant_recording::files::program::program;
use sha2::{Digest, Sha256};

/// What a result depends on: program, options and files. Equal keys give equal results.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ResumeKey(pub(crate) String);

impl ResumeKey {
    /// The checksum, hexadecimal.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// The key of these options, in words, and of the content of these files.
    ///
    /// The version of the program counts, too; the names of the files do not.
    #[must_use]
    pub fn of(options: &str, files: &[HashedFile]) -> Self {
        let mut hash = Sha256::new();
        let mut add = |text: &str| {
            hash.update((text.len() as u64).to_le_bytes());
            hash.update(text.as_bytes());
        };
        add(&program());
        add(options);
        files.iter().for_each(|file| add(&file.sha256));
        Self(hex(hash))
    }

    /// The key of a result that depends on further files, too.
    #[must_use]
    pub fn with(&self, files: &[HashedFile]) -> Self {
        Self::of(&self.0, files)
    }
}
