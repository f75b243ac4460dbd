//! Atomic output: it writes a result beside its place and then renames it. So a result is whole or absent.

use super::manifest;
use super::standard_input::NAME;
use crate::files::checksum::hex;
use calibrant_core::error::{Error, Result};
use sha2::{Digest, Sha256};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The temporary files that are being written.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Removes the temporary files of results that are being written: for a program that is about to end.
pub fn remove_unfinished() {
    // best effort: the program ends
    unfinished().iter().for_each(|path| drop(std::fs::remove_file(path)));
}

fn unfinished() -> std::sync::MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Writes a file through `fill`: into a temporary file in the same directory, which then takes the name.
///
/// Creates missing directories. Follows a link. Writes directly to what is no regular file (`/dev/stdout`, a
/// pipe); `-` is standard output. Enters the file into the manifest of its folder, `.calibrant.jsonl`.
///
/// # Errors
/// [`Error::Output`] with the path and the system's message. An earlier file of that name is then untouched.
///
/// # Examples
/// ```
/// let directory = tempfile::tempdir().expect("a temporary directory");
/// let path = directory.path().join("new/result.txt");
/// calibrant_recording::write_atomically(&path, |out| writeln!(out, "42"))?;
/// assert_eq!(std::fs::read_to_string(path).expect("written"), "42\n");
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn write_atomically(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    write_entered(path, None, fill)
}

/// The same for a text that is there.
///
/// # Errors
/// As [`write_atomically`].
pub fn write_text(path: &Path, text: &str) -> Result<()> {
    write_atomically(path, |out| out.write_all(text.as_bytes()))
}

/// The same for a recording that was corrected, with the name of the calibration.
pub fn write_entered(
    path: &Path,
    corrected_with: Option<&str>,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<()> {
    write(path, corrected_with, fill).map_err(|source| Error::Output { path: path.to_path_buf(), source })
}

/// A writer that takes the checksum of what it writes.
struct Hashed<W> {
    out: W,
    hash: Sha256,
}

impl<W: Write> Write for Hashed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let length = self.out.write(bytes)?;
        self.hash.update(&bytes[..length]);
        Ok(length)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

fn write(
    path: &Path,
    corrected_with: Option<&str>,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    if path.as_os_str() == NAME {
        let mut out = BufWriter::new(io::stdout().lock());
        return match fill(&mut out).and_then(|()| out.flush()) {
            // a reader that has enough (`| head`) is no failure
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
            written => written,
        };
    }
    // a link's target, where there is one
    let target = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    if let Ok(found) = target.metadata() {
        if found.is_dir() {
            return Err(io::Error::new(
                io::ErrorKind::IsADirectory,
                "a directory of this name is in the way",
            ));
        }
        if !found.is_file() {
            let mut out = BufWriter::new(std::fs::OpenOptions::new().write(true).open(&target)?);
            fill(&mut out)?;
            return out.flush();
        }
    }
    let directory = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    std::fs::create_dir_all(directory).map_err(|error| {
        io::Error::new(error.kind(), format!("cannot create directory {}: {error}", directory.display()))
    })?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(".calibrant-").suffix(".tmp");
    #[cfg(unix)]
    {
        // permissions as of any other file that a program creates: the user's mask decides
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let file = builder.tempfile_in(directory)?;
    let temporary = file.path().to_path_buf();
    unfinished().push(temporary.clone());
    let mut out = BufWriter::with_capacity(1 << 16, Hashed { out: file, hash: Sha256::new() });
    let written = fill(&mut out).and_then(|()| {
        let Hashed { out: file, hash } = out.into_inner().map_err(io::IntoInnerError::into_error)?;
        // before the file has its name: a run that is killed in between leaves no file that it did not enter.
        // best effort: without the entry, another run asks before it replaces the result
        drop(manifest::enter(&target, hex(hash), corrected_with));
        file.persist(&target).map_err(|error| error.error)?;
        Ok(())
    });
    unfinished().retain(|path| *path != temporary);
    written
}
