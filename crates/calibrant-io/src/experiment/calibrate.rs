//! `[calibrate]`: how a recording is evaluated.

use serde::{Deserialize, Serialize};

/// The assumption about the parameters before the recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Prior {
    /// Nothing.
    #[default]
    None,
    /// The datasheet: nominal values with their spread.
    Datasheet,
}

/// The options of `[calibrate]`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CalibrateOptions {
    /// The assumption about the parameters before the recording.
    pub prior: Prior,
}
