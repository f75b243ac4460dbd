//! The places of a command's results: decided, tried and held before the work begins.

use super::finished;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_recording::files::manifest;
use calibrant_recording::files::standard_input::NAME;
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};
use std::fs::{File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// What a command reads and writes.
#[derive(Debug, Default)]
pub struct ResultPlaces {
    /// The directory of the results, where the command has one of its own.
    pub directory: Option<PathBuf>,
    /// Every file that the command may write.
    pub results: Vec<PathBuf>,
    /// Every file that it may read, and records to which it adds.
    pub inputs: Vec<PathBuf>,
}

/// Places that no other run takes as long as this lives.
#[derive(Debug)]
pub struct ClaimedPlaces {
    /// The results that are there already, with their version.
    earlier: Vec<(PathBuf, Option<(SystemTime, u64)>)>,
    /// Directories that were made for the results, the innermost first.
    made: Vec<PathBuf>,
    /// The directory of the results, locked.
    _lock: Option<File>,
}

impl ResultPlaces {
    /// Is a result written to standard output (`-`)?
    #[must_use]
    pub fn has_standard_output(&self) -> bool {
        self.results.iter().any(|result| result.as_os_str() == NAME)
    }

    /// Checks the places, tries the directory for writing, and takes it.
    ///
    /// Paths are compared after links are resolved. With `replace`, files of others, and results that were edited,
    /// are replaced; inputs never are.
    ///
    /// # Errors
    /// [`Error::Experiment`] where a result would replace an input, or a file that this program did not write as it is,
    /// or where another run writes into the directory. [`Error::Output`] where the directory cannot be written.
    pub fn claim(self, replace: bool) -> Result<ClaimedPlaces> {
        let refuse = |file: &Path, what: &str, help: &str| {
            Err(Error::experiment(InputError::new(Refusal::FileTaken, what, help).in_file(file)))
        };
        let mut links = Links::default();
        // one that is not there yet may be made and then replaced, too
        let inputs: HashSet<_> = self.inputs.iter().map(|input| links.resolved(input)).collect();
        let files = self.results.iter().filter(|result| result.as_os_str() != NAME);
        let all: Vec<_> = files.map(|result| (result.clone(), links.resolved(result))).collect();
        if let Some((result, _)) = all.iter().find(|(_, resolved)| inputs.contains(resolved)) {
            let what = "this file is read, and would be replaced by the result";
            return refuse(result, what, "give another name for the result");
        }
        let there: Vec<_> = all.into_iter().filter(|(_, resolved)| resolved.is_file()).collect();
        let is_of_others = |(_, resolved): &&(PathBuf, PathBuf)| !replace && !is_ours(resolved);
        if let Some((result, _)) = there.par_iter().find_first(is_of_others) {
            let what = "this file is there already, and calibrant did not write it as it is";
            return refuse(result, what, "choose another place, or add option `force`");
        }
        let earlier = there.into_iter().map(|(result, _)| (result.clone(), version(&result))).collect();
        let mut claimed = ClaimedPlaces { earlier, made: Vec::new(), _lock: None };
        let Some(directory) = self.directory else { return Ok(claimed) };
        let in_place = |source| Error::Output { path: directory.clone(), source };
        let missing =
            directory.ancestors().take_while(|place| !place.as_os_str().is_empty() && !place.exists());
        claimed.made = missing.map(Path::to_path_buf).collect();
        if let Some(place) =
            directory.ancestors().find(|place| place.exists()).filter(|place| !place.is_dir())
        {
            let reason = format!("{} is a file, not a directory", place.display());
            return Err(in_place(io::Error::new(io::ErrorKind::NotADirectory, reason)));
        }
        std::fs::create_dir_all(&directory).map_err(in_place)?;
        tempfile::tempfile_in(&directory).map_err(in_place)?;
        // where the system cannot lock a directory, there is no lock
        if let Ok(lock) = File::open(&directory) {
            if matches!(lock.try_lock(), Err(TryLockError::WouldBlock)) {
                let what = "another run of calibrant writes into this directory";
                return refuse(&directory, what, "wait for it, or choose another directory");
            }
            claimed._lock = Some(lock);
        }
        Ok(claimed)
    }
}

impl ClaimedPlaces {
    /// The results of an earlier run that are there still, as they were.
    pub fn left_over(&self) -> impl Iterator<Item = &Path> {
        let unchanged = |(path, before): &&(PathBuf, Option<(SystemTime, u64)>)| {
            path.exists() && version(path) == *before
        };
        self.earlier.iter().filter(unchanged).map(|(path, _)| path.as_path())
    }
}

impl Drop for ClaimedPlaces {
    /// Removes the directories that were made and have no results.
    fn drop(&mut self) {
        // one that is not empty stays
        self.made.iter().for_each(|directory| drop(std::fs::remove_dir(directory)));
    }
}

/// Paths without links, as far as they are there. The results of a batch share their folders: each folder is looked up once.
#[derive(Default)]
struct Links {
    folders: HashMap<PathBuf, PathBuf>,
}

impl Links {
    fn resolved(&mut self, path: &Path) -> PathBuf {
        let full = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
        // a name that is not there costs one look, a resolution one for each part of the path
        let found = full.symlink_metadata().and_then(|_| full.canonicalize());
        found.unwrap_or_else(|_| match (full.parent(), full.components().next_back()) {
            (Some(folder), Some(name)) => self.folder(folder).join(name),
            _ => full,
        })
    }

    fn folder(&mut self, folder: &Path) -> PathBuf {
        if let Some(found) = self.folders.get(folder) {
            return found.clone();
        }
        let found = self.resolved(folder);
        self.folders.insert(folder.to_path_buf(), found.clone());
        found
    }
}

/// What differs once a result has been replaced: the file itself, where the system numbers files.
fn version(path: &Path) -> Option<(SystemTime, u64)> {
    let found = path.metadata().ok()?;
    #[cfg(unix)]
    let number = std::os::unix::fs::MetadataExt::ino(&found);
    #[cfg(not(unix))]
    let number = found.len();
    Some((found.modified().ok()?, number))
}

/// Did this program write the file as it is? An empty one may be replaced, too; and one that only this program reads, whatever has become of it.
fn is_ours(path: &Path) -> bool {
    path.metadata().is_ok_and(|found| found.len() == 0)
        || manifest::entry(path).is_some()
        || path.ends_with(finished::NAME) && manifest::names(path)
}
