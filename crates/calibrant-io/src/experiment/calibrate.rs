//! Reads `[calibrate]`: how a recording is evaluated.

use super::spreads::need_spreads;
use super::toml_document::Section;
use calibrant_core::error::Result;
use calibrant_core::sensor::Sensor;

/// The assumption about the parameters before the recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Prior {
    /// Nothing.
    #[default]
    None,
    /// The datasheet: nominal values with their spread.
    Datasheet,
}

/// The options of `[calibrate]`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CalibrateOptions {
    /// The assumption about the parameters before the recording.
    pub prior: Prior,
}

/// Reads `[calibrate]`.
pub(super) fn read(section: &Section<'_>, sensor: &Sensor) -> Result<CalibrateOptions> {
    let prior = section.get("prior").map_or(Ok(Prior::None), |entry| {
        entry.word(&[("none", Prior::None), ("datasheet", Prior::Datasheet)])
    })?;
    if prior == Prior::Datasheet {
        need_spreads(section, "prior", sensor)?;
    }
    Ok(CalibrateOptions { prior })
}
