//! The folders of the results.

use std::collections::HashSet;
use std::path::Path;

/// A folder for each recording: its [own name](own_name). A number is added if the name repeats, or if another file of the batch has it.
/// Capitals do not count, since not every file system distinguishes them.
#[must_use]
pub fn folder_names(recordings: &[impl AsRef<Path>]) -> Vec<String> {
    let mut seen = HashSet::from(["summary.csv", "batch.html"].map(str::to_owned));
    let own: Vec<String> = recordings.iter().map(|path| own_name(path.as_ref())).collect();
    let mut taken: HashSet<String> = own.iter().map(|name| name.to_lowercase()).collect();
    let folder = |name: String| {
        if seen.insert(name.to_lowercase()) {
            return name;
        }
        let numbered = |k: usize| format!("{name}-{k}");
        (2..).map(numbered).find(|name| taken.insert(name.to_lowercase())).unwrap_or(name)
    };
    own.into_iter().map(folder).collect()
}

/// The name of a recording's file without its ending.
#[must_use]
pub fn own_name(recording: &Path) -> String {
    let stem = recording.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    // the file name `...csv` leaves `..`
    stem.filter(|stem| stem != "." && stem != "..").unwrap_or_else(|| "recording".into())
}
