//! The one error type of the library, and the questions that a caller asks of it. It depends on no other
//! module's behaviour.
//!
//! An [`Error`] says what is wrong, where, and what to do about it. It is for input that makes no sense. An
//! iteration that does not converge is a [`CalibrationStatus`](crate::estimate::CalibrationStatus) in a
//! complete result.

mod answer;
mod refusal;

pub use answer::{Answer, TaskOption, with_options_worded, word_options_as};
pub use refusal::Refusal;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;
use std::path::{Path, PathBuf};

/// Shorthand for results of this library.
pub type Result<T> = std::result::Result<T, Error>;

/// Everything that can go wrong.
///
/// Ask it with [`is_invalid_experiment`](Error::is_invalid_experiment),
/// [`is_invalid_recording`](Error::is_invalid_recording), [`is_not_identifiable`](Error::is_not_identifiable)
/// and [`is_infeasible`](Error::is_infeasible). Do not match on it: variants may be added.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The experiment file, the commanded motion or an option makes no sense (exit status 2).
    #[error("{0}")]
    Experiment(Box<InputError>),
    /// The limits admit no motion (exit status 4).
    #[error("{0}")]
    Infeasible(Box<InputError>),
    /// The recording cannot be used (exit status 3).
    #[error("{0}")]
    Recording(Box<InputError>),
    /// The data cannot determine some of the parameters (exit status 4).
    #[error("{0}")]
    NotIdentifiable(Box<NotIdentifiable>),
    /// A result could not be written (exit status 2: choose another place).
    #[error("cannot write {}: {source}", path.display())]
    Output {
        /// What was to be written.
        path: PathBuf,
        /// Why the system refused.
        source: std::io::Error,
    },
}

/// What is wrong with an input, where, and what to do about it.
#[derive(Debug, Clone, PartialEq)]
pub struct InputError {
    /// Its code, which never changes.
    pub code: Refusal,
    /// The file, where the input is one.
    pub file: Option<PathBuf>,
    /// Line in the file, counted from 1.
    pub line: Option<usize>,
    /// Column in the line, counted in characters from 1.
    pub column: Option<usize>,
    /// The key, for experiment files: `motion.interval_s`.
    pub key: Option<String>,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub help: String,
    /// What the user may say, where the error is a question; `help` has it in words.
    pub answers: Vec<Answer>,
    /// The text of the file and the range of bytes at fault, so that it can be shown underlined.
    pub excerpt: Option<(String, std::ops::Range<usize>)>,
}

impl InputError {
    /// An input error that is not about a place in a file.
    #[must_use]
    pub fn new(code: Refusal, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            code,
            file: None,
            line: None,
            column: None,
            key: None,
            message: with_options_worded(message.into()),
            help: with_options_worded(help.into()),
            answers: Vec::new(),
            excerpt: None,
        }
    }

    /// A question to the user, with the options that answer it.
    #[must_use]
    pub fn question(code: Refusal, message: impl Into<String>, answers: Vec<Answer>) -> Self {
        let words: Vec<String> = answers.iter().map(Answer::to_string).collect();
        Self { answers, ..Self::new(code, message, format!("say {}", words.join("; "))) }
    }

    /// The same error, which this option answers, with one of these values.
    #[must_use]
    pub fn answered_by<'v>(mut self, option: TaskOption, values: impl IntoIterator<Item = &'v str>) -> Self {
        self.answers.push(Answer::new(option, values));
        self
    }

    /// The same error, with another remedy.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = with_options_worded(help.into());
        self
    }

    /// The same error, in this file.
    #[must_use]
    pub fn in_file(mut self, file: &Path) -> Self {
        self.file = Some(file.to_path_buf());
        self
    }

    /// The same error, at this line (from 1).
    #[must_use]
    pub fn at_line(mut self, line: usize) -> Self {
        self.line = Some(line);
        self
    }

    /// The same error, at this column (from 1).
    #[must_use]
    pub fn at_column(mut self, column: usize) -> Self {
        self.column = Some(column);
        self
    }

    /// The same error, about this key of an experiment file.
    #[must_use]
    pub fn about_key(mut self, key: impl Into<String>) -> Self {
        self.key = Some(key.into());
        self
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{}", file.display())?;
            if let Some(line) = self.line {
                write!(f, ":{line}")?;
                if let Some(column) = self.column {
                    write!(f, ":{column}")?;
                }
            }
            write!(f, ": ")?;
        } else if let Some(line) = self.line {
            write!(f, "line {line}")?;
            if let Some(column) = self.column {
                write!(f, ", column {column}")?;
            }
            write!(f, ": ")?;
        }
        if let Some(key) = &self.key {
            write!(f, "`{key}`: ")?;
        }
        write!(f, "{}", self.message)?;
        if !self.help.is_empty() {
            write!(f, " ({})", self.help)?;
        }
        Ok(())
    }
}

/// The parameters that a recording cannot determine, in the user's words.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NotIdentifiable {
    /// One entry for each group of parameters that the data cannot separate.
    pub groups: Vec<UndeterminedGroup>,
}

/// Parameters that the data cannot separate, why, and what would fix it.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct UndeterminedGroup {
    /// Names of the parameters that are involved.
    pub parameters: Vec<String>,
    /// How many independent combinations of them the data leave free.
    pub free_combinations: usize,
    /// Why, in words.
    pub reason: String,
    /// What would fix it.
    pub remedy: String,
}

/// The reasons of recordings with no hold, and with one.
pub(crate) const HARDLY_A_HOLD: [&str; 2] = [
    "no hold was found in the recording: the sensor was never still for long enough",
    "only one hold was found",
];

impl NotIdentifiable {
    /// Has the recording no hold, or only one?
    #[must_use]
    pub fn has_hardly_a_hold(&self) -> bool {
        self.groups.iter().any(|group| HARDLY_A_HOLD.contains(&group.reason.as_str()))
    }
}

impl fmt::Display for NotIdentifiable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the data cannot determine the parameters")?;
        // a reason that several groups share is given once
        for groups in self.groups.chunk_by(|one, next| one.reason == next.reason) {
            let what: Vec<String> = groups.iter().filter_map(UndeterminedGroup::what).collect();
            let colon = if what.is_empty() { "" } else { ": " };
            write!(f, "; {}{colon}{}", what.join("; "), groups[0].reason)?;
            let mut remedies: Vec<&str> = groups.iter().map(|group| group.remedy.as_str()).collect();
            remedies.dedup();
            let all = remedies.clone();
            remedies.retain(|one| {
                !one.is_empty() && !all.iter().any(|other| other != one && other.starts_with(one))
            });
            if !remedies.is_empty() {
                write!(f, " ({})", remedies.join("; "))?;
            }
        }
        Ok(())
    }
}

impl UndeterminedGroup {
    /// What the data leave unknown of the parameters; `None` where nothing is unknown.
    #[must_use]
    pub fn what(&self) -> Option<String> {
        match self.parameters.as_slice() {
            [] => None,
            [one] => Some(format!("{one} is not determined")),
            [one, two] => Some(format!("{one} and {two} cannot be separated")),
            many => Some(format!(
                "{} combination{} of {} left free",
                self.free_combinations,
                if self.free_combinations == 1 { "" } else { "s" },
                many.join(", ")
            )),
        }
    }
}

impl Error {
    /// Is the experiment file, the commanded motion or an option at fault?
    #[must_use]
    pub fn is_invalid_experiment(&self) -> bool {
        matches!(self, Self::Experiment(_))
    }

    /// Is the recording at fault?
    #[must_use]
    pub fn is_invalid_recording(&self) -> bool {
        matches!(self, Self::Recording(_))
    }

    /// Are the data unable to determine the parameters?
    #[must_use]
    pub fn is_not_identifiable(&self) -> bool {
        matches!(self, Self::NotIdentifiable(_))
    }

    /// Do the limits admit no motion?
    #[must_use]
    pub fn is_infeasible(&self) -> bool {
        matches!(self, Self::Infeasible(_))
    }

    /// Its code, which never changes.
    #[must_use]
    pub fn code(&self) -> Refusal {
        match self {
            Self::Experiment(input_error) | Self::Infeasible(input_error) | Self::Recording(input_error) => {
                input_error.code
            }
            Self::NotIdentifiable(_) => Refusal::NotIdentifiable,
            Self::Output { .. } => Refusal::OutputUnwritable,
        }
    }

    /// The input error, where this is one.
    #[must_use]
    pub fn input_error(&self) -> Option<&InputError> {
        match self {
            Self::Experiment(input_error) | Self::Recording(input_error) | Self::Infeasible(input_error) => {
                Some(input_error)
            }
            _ => None,
        }
    }

    /// The experiment, the commanded motion or an option at fault.
    #[must_use]
    pub fn experiment(input_error: InputError) -> Self {
        Self::Experiment(Box::new(input_error))
    }

    /// Limits that admit no motion.
    #[must_use]
    pub fn infeasible(input_error: InputError) -> Self {
        Self::Infeasible(Box::new(input_error))
    }

    /// One group of parameters that the data cannot determine.
    #[must_use]
    pub fn undetermined(group: UndeterminedGroup) -> Self {
        Self::NotIdentifiable(Box::new(NotIdentifiable { groups: vec![group] }))
    }

    /// A recording at fault.
    #[must_use]
    pub fn recording(input_error: InputError) -> Self {
        Self::Recording(Box::new(input_error))
    }

    /// The same error; one about limits, or about a key of an experiment, names this file, where it names none.
    #[must_use]
    pub fn in_experiment(self, file: &Path) -> Self {
        match self {
            Self::Experiment(input_error) if input_error.key.is_some() && input_error.file.is_none() => {
                Self::experiment(input_error.in_file(file))
            }
            Self::Infeasible(input_error) if input_error.file.is_none() => {
                Self::infeasible(input_error.in_file(file))
            }
            other => other,
        }
    }

    /// The same error; one about a recording names this file, where it names none.
    #[must_use]
    pub fn in_recording(self, file: &Path) -> Self {
        match self {
            Self::Recording(input_error) if input_error.file.is_none() => {
                Self::recording(input_error.in_file(file))
            }
            other => other,
        }
    }
}
