//! The files of a session: every row is in `recording.csv` before it is used, every decision in `events.jsonl`.

use calibrant::io::write_text;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use serde_json::Value;
use std::fs::{File, OpenOptions};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Rows reach the file after this time, and the disk after this time.
const FLUSH: Duration = Duration::from_millis(500);
const SYNC: Duration = Duration::from_secs(5);

/// The files of a session.
pub(crate) struct SessionLog {
    path: PathBuf,
    recording: Option<BufWriter<File>>,
    events: File,
    flushed: Instant,
    synced: Instant,
}

impl SessionLog {
    /// Begins a session in a folder, or goes on with one: then with its rows, the header first.
    ///
    /// # Errors
    /// [`Error::Experiment`] where there is a session and none is to be continued, or none where one is; [`Error::Output`] where the folder cannot be written.
    pub(crate) fn open(directory: &Path, resume: bool) -> Result<(Self, Vec<String>)> {
        let path = directory.join("recording.csv");
        std::fs::create_dir_all(directory).map_err(|error| output(directory, error))?;
        let exists = path.exists();
        if exists && !resume {
            let message = format!("{} is there already", path.display());
            let help = "go on with it by option `resume`, or give another folder";
            return Err(Error::experiment(InputError::new(Refusal::FileTaken, message, help)));
        }
        let lines =
            if exists { whole_lines(&path).map_err(|error| output(&path, error))? } else { Vec::new() };
        let events = directory.join("events.jsonl");
        if resume && !exists && !events.exists() {
            let message = format!("{} has no session to go on with", directory.display());
            let help = "leave option `resume` away to begin one, or give its folder";
            return Err(Error::experiment(InputError::new(Refusal::FileUnreadable, message, help)));
        }
        if events.exists() {
            whole_lines(&events).map_err(|error| output(&events, error))?;
        }
        let open = |path: &Path| OpenOptions::new().create(true).append(true).open(path);
        let events = open(&events).map_err(|error| output(&events, error))?;
        let recording = if exists {
            Some(BufWriter::new(open(&path).map_err(|error| output(&path, error))?))
        } else {
            None
        };
        let now = Instant::now();
        Ok((Self { path, recording, events, flushed: now, synced: now }, lines))
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Appends a line to the recording.
    pub(crate) fn row(&mut self, line: &str) -> Result<()> {
        let written = (|| {
            if self.recording.is_none() {
                let file = OpenOptions::new().create(true).append(true).open(&self.path)?;
                self.recording = Some(BufWriter::new(file));
            }
            let Some(recording) = &mut self.recording else { return Ok(()) };
            recording.write_all(line.as_bytes())?;
            recording.write_all(b"\n")
        })();
        written.map_err(|error: std::io::Error| output(&self.path, error))
    }

    /// Takes the recording away: its rows will be written again.
    pub(crate) fn begin_anew(&mut self) -> Result<()> {
        self.recording = None;
        std::fs::remove_file(&self.path).map_err(|error| output(&self.path, error))
    }

    /// Appends a decision.
    pub(crate) fn event(&mut self, event: &Value) -> Result<()> {
        writeln!(self.events, "{event}")
            .map_err(|error| output(&self.path.with_file_name("events.jsonl"), error))
    }

    /// Brings the rows to the file and to the disk, where it is time.
    pub(crate) fn keep(&mut self, at_once: bool) -> Result<()> {
        let Some(recording) = &mut self.recording else { return Ok(()) };
        let failed = |error: std::io::Error| output(&self.path, error);
        if at_once || self.flushed.elapsed() >= FLUSH {
            recording.flush().map_err(failed)?;
            self.flushed = Instant::now();
        }
        if at_once || self.synced.elapsed() >= SYNC {
            recording.get_ref().sync_data().map_err(failed)?;
            self.synced = Instant::now();
        }
        Ok(())
    }

    /// Changes rows of the recording: another file takes its place at once.
    pub(crate) fn rewrite(&mut self, change: impl Fn(&str) -> String) -> Result<()> {
        self.keep(true)?;
        let lines = whole_lines(&self.path).map_err(|error| output(&self.path, error))?;
        let mut text = String::new();
        for (number, line) in lines.iter().enumerate() {
            text.push_str(&if number == 0 { line.clone() } else { change(line) });
            text.push('\n');
        }
        self.recording = None;
        write_text(&self.path, &text)
    }
}

fn output(path: &Path, source: std::io::Error) -> Error {
    Error::Output { path: path.to_path_buf(), source }
}

/// The lines of a file up to the last whole one; what is behind it is cut off.
fn whole_lines(path: &Path) -> std::io::Result<Vec<String>> {
    let bytes = std::fs::read(path)?;
    let end = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |last| last + 1);
    if end < bytes.len() {
        OpenOptions::new().write(true).open(path)?.set_len(end as u64)?;
    }
    Ok(String::from_utf8_lossy(&bytes[..end]).lines().map(str::to_owned).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_half_line_is_cut_off_and_a_session_is_not_overwritten() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mut log, lines) = SessionLog::open(folder.path(), false).expect("opens");
        assert!(lines.is_empty());
        for line in ["t_s,ax,ay,az", "0,1,2,3", "1,4,5,6"] {
            log.row(line).expect("writes");
        }
        log.keep(true).expect("writes");
        drop(log);
        let path = folder.path().join("recording.csv");
        let mut text = std::fs::read_to_string(&path).expect("there");
        text.push_str("2,7,8");
        std::fs::write(&path, text).expect("writes");
        assert!(SessionLog::open(folder.path(), false).is_err());
        let (mut log, lines) = SessionLog::open(folder.path(), true).expect("opens");
        assert_eq!(lines, ["t_s,ax,ay,az", "0,1,2,3", "1,4,5,6"]);
        log.rewrite(|row| row.replace("4,5,6", ",,")).expect("writes");
        log.row("3,7,8,9").expect("writes");
        log.keep(true).expect("writes");
        assert_eq!(std::fs::read_to_string(&path).expect("there"), "t_s,ax,ay,az\n0,1,2,3\n1,,,\n3,7,8,9\n");
    }
}
