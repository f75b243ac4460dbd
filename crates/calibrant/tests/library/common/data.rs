//! Access to real recordings, which lie outside the repository.

use std::io::Write;
use std::path::{Path, PathBuf};

/// A real recording, under `../shared/data` beside the workspace (or where `CALIBRANT_DATA` points).
///
/// `None` where it is absent, and a line on stderr that the harness does not capture. The test is skipped
/// then.
pub(crate) fn shared_data(name: &str) -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let path = std::env::var_os("CALIBRANT_DATA").map_or_else(beside, PathBuf::from).join(name);
    if path.is_file() {
        return Some(path);
    }
    // not eprintln!, which the test harness captures
    let _ = writeln!(
        std::io::stderr(),
        "SKIPPED: {} is not there; set CALIBRANT_DATA to the directory with the recordings",
        path.display()
    );
    None
}
