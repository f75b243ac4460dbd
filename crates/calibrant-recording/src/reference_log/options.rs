//! The options for reading a log of a motion.

use super::log_columns::LogColumns;
use crate::recording::TimeUnit;

/// What the user states about a log beyond its content.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ReferenceLogOptions {
    /// Unit of the time column, where its name does not give it.
    pub time_unit: Option<TimeUnit>,
    /// Topic of a bag that has several logs, or body of a tracker's export. `/tf:tool0` is the frame `tool0` of the topic `/tf`.
    pub topic: Option<String>,
    /// What the columns hold, where their names do not say it.
    pub columns: LogColumns,
    /// Are poses wanted, where the columns may be of joints as well?
    pub poses: bool,
}
