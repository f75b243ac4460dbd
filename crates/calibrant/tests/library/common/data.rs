//! Recordings that were not made here.

use std::io::Write;
use std::path::{Path, PathBuf};

/// A recording that was not made here, under `../shared/data` beside the workspace (or where `CALIBRANT_DATA` says).
///
/// `None`, and a line on stderr that the harness does not capture, where it is absent: the test that asked is skipped then.
pub(crate) fn shared_data(name: &str) -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let path = std::env::var_os("CALIBRANT_DATA").map_or_else(beside, PathBuf::from).join(name);
    if path.is_file() {
        return Some(path);
    }
    // not eprintln!, which the test harness keeps to itself
    let _ = writeln!(
        std::io::stderr(),
        "SKIPPED: {} is not there; set CALIBRANT_DATA to the directory with the recordings",
        path.display()
    );
    None
}
