//! The options for reading a log of a motion.

use crate::recording::TimeUnit;

/// What the user states about a log beyond its content.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ReferenceLogOptions {
    /// Unit of the time column, where its name does not give it.
    pub time_unit: Option<TimeUnit>,
    /// Topic of a bag that has several logs. `/tf:tool0` is the frame `tool0` of the topic `/tf`.
    pub topic: Option<String>,
}
