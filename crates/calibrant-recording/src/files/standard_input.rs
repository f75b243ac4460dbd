//! Opens files that are read. `-` is standard input, as a file that can be read more than once: a reader looks at the beginning first.

use std::fs::File;
use std::io::{Result, Seek, copy, stdin};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// How standard input is called among files that are read, and standard output among those that are written. A file of this name is `./-`.
pub const NAME: &str = "-";
/// What came from standard input, once it was read.
static READ: Mutex<Option<File>> = Mutex::new(None);

/// Opens a file to be read; `-` is standard input.
pub fn open_input(path: &Path) -> Result<File> {
    if path.as_os_str() == NAME { standard_input() } else { File::open(path) }
}

/// A file with what comes from standard input. Each call gives a file of its own, without a name.
fn standard_input() -> Result<File> {
    let mut read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    let mut all = match read.take() {
        Some(all) => all,
        None => {
            let mut all = tempfile::tempfile()?;
            copy(&mut stdin().lock(), &mut all)?;
            all
        }
    };
    let mut own = tempfile::tempfile()?;
    all.rewind()?;
    copy(&mut all, &mut own)?;
    own.rewind()?;
    *read = Some(all);
    Ok(own)
}
