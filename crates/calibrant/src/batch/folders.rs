//! The names of a batch's sensors, which are those of the folders of their results.

use std::collections::HashSet;
use std::path::Path;

/// The folder of each recording: its [own name](own_names). A number is added if the name repeats, or if another file of the batch has it.
/// Capitals do not count, since not every file system distinguishes them.
#[must_use]
pub fn folder_names(recordings: &[impl AsRef<Path>]) -> Vec<String> {
    let mut seen = HashSet::from(["summary.csv", "batch.html"].map(str::to_owned));
    let own = own_names(recordings);
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

/// The name of each recording: that of its file without the ending. Where two files have one name, each recording has the parts of its path that are not those of all:
/// `line/S31/recording.csv` and `line/S32/recording.csv` are S31 and S32.
///
/// # Examples
/// ```
/// use calibrant::batch::own_names;
/// assert_eq!(own_names(&["line/A.csv", "line/B.csv"]), ["A", "B"]);
/// assert_eq!(own_names(&[r"C:\line\A\rec.csv", r"C:\line\B\rec.csv"]), ["A", "B"]);
/// assert_eq!(own_names(&["1/A/rec.csv", "2/A/rec.csv", "2/B/rec.csv"]), ["1-A", "2-A", "2-B"]);
/// ```
#[must_use]
pub fn own_names(recordings: &[impl AsRef<Path>]) -> Vec<String> {
    let paths: Vec<Vec<String>> = recordings.iter().map(|path| parts(path.as_ref())).collect();
    let files = || paths.iter().map(|parts| parts[0].clone());
    let mut seen = HashSet::new();
    if files().all(|name| seen.insert(name.to_lowercase())) {
        return files().collect();
    }
    let deepest = paths.iter().map(Vec::len).max().unwrap_or(0);
    let differs = |place: &usize| paths.iter().any(|path| path.get(*place) != paths[0].get(*place));
    let places: Vec<usize> = (0..deepest).rev().filter(differs).collect();
    let name = |path: &Vec<String>| {
        let parts: Vec<&str> = places.iter().filter_map(|place| Some(path.get(*place)?.as_str())).collect();
        if parts.is_empty() { path[0].clone() } else { parts.join("-") }
    };
    paths.iter().map(name).collect()
}

/// The name of the file without its ending, then its folders, the nearest first. Paths of Windows are understood on every system.
fn parts(path: &Path) -> Vec<String> {
    let text = path.to_string_lossy();
    let is_part = |part: &&str| !matches!(*part, "" | "." | ".." | "?");
    // `..` leaves the folder before it
    let mut left = 0;
    let mut parts = text.rsplit(['/', '\\']).filter(|part| match *part {
        ".." => {
            left += 1;
            false
        }
        part if !is_part(&part) => false,
        _ if left > 0 => {
            left -= 1;
            false
        }
        _ => true,
    });
    let file = parts.next().unwrap_or_default();
    let stem = file.rsplit_once('.').map_or(file, |(stem, _)| if stem.is_empty() { file } else { stem });
    // the file name `...csv` leaves `..`
    let stem = if is_part(&stem) { stem } else { "recording" };
    // a drive: `C:`
    let folders = parts.map(|part| part.trim_end_matches(':'));
    std::iter::once(stem).chain(folders).map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_of_paths_that_differ_name_the_recordings() {
        let names = |paths: &[&str]| own_names(paths);
        assert_eq!(names(&["line/S1/rec.csv", "./line/S2/rec.csv"]), ["S1", "S2"]);
        assert_eq!(names(&["line/S1/rec.csv", "line/S2/../S4/rec.csv"]), ["S1", "S4"]);
        assert_eq!(
            names(&["S1/left.csv", "S1/right.csv", "S2/left.csv"]),
            ["S1-left", "S1-right", "S2-left"]
        );
        assert_eq!(names(&["rec.csv", "S2/rec.csv"]), ["rec", "S2"]);
        assert_eq!(names(&["rec.csv", "rec.txt", "...csv", ".csv"]), ["rec", "rec", "recording", ".csv"]);
        assert_eq!(names(&[r"C:\rec.csv", r"D:\rec.csv"]), ["C", "D"]);
        assert_eq!(names(&[r"\\?\C:\a b\rec.csv", r"\\?\C:\c\Rec.csv"]), ["a b-rec", "c-Rec"]);
    }

    #[test]
    fn folders_differ() {
        assert_eq!(folder_names(&["a/rec.csv", "a/rec.txt", "A/rec.csv"]), ["a", "a-2", "A-3"]);
        assert_eq!(folder_names(&["summary.csv.gz", "b.csv"]), ["summary.csv-2", "b"]);
    }
}
