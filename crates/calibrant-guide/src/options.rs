//! What is to be guided, and how.

use crate::input::Input;
use calibrant::io::Experiment;
use calibrant::session::SessionOptions;
use calibrant_core::interruption::Interruption;
use std::path::PathBuf;

/// What is to be guided, and how.
pub struct GuideOptions {
    /// The experiment: an IMU or an accelerometer that is held still.
    pub experiment: Experiment,
    /// How the stream is read, beyond what the experiment says, and how the result is named and judged.
    pub session: SessionOptions,
    /// Names of the columns, where the stream has no header.
    pub columns: Vec<String>,
    /// Where the samples come from.
    pub input: Input,
    /// Folder of the session.
    pub directory: PathBuf,
    /// Go on with the session that is there?
    pub resume: bool,
    /// Address of the page; `None` for none.
    pub listen: Option<String>,
    /// Are lines printed?
    pub terminal: bool,
    /// End as soon as it is good enough?
    pub stop_when_good: bool,
    /// Ends the session as a person would by "finish".
    pub interruption: Interruption,
}
