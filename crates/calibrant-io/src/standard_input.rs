//! Standard input as a file that can be read more than once: a reader looks at the beginning first.

use std::fs::File;
use std::io::{Result, Seek, copy, stdin};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// How standard input is called among files. A file of this name is `./-`.
const NAME: &str = "-";
/// What came from standard input, once it was read.
static READ: Mutex<Option<File>> = Mutex::new(None);

/// Is this standard input?
pub(super) fn is_named(path: &Path) -> bool {
    path.as_os_str() == NAME
}

/// A file with what comes from standard input. Each call gives a file of its own, without a name.
pub(super) fn open() -> Result<File> {
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
