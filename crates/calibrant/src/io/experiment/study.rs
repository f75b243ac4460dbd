//! `[calibrate]` and `[study]`: options of these two commands.

use super::document::Section;
use crate::error::Result;
use crate::sensor::Sensor;

/// What is assumed of the parameters before the recording is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Prior {
    /// Nothing.
    #[default]
    None,
    /// The datasheet: nominal values with their spread.
    Datasheet,
}

/// What `[calibrate]` asks for.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CalibrateOptions {
    /// What is assumed of the parameters before the recording is seen.
    pub prior: Prior,
}

/// What `[study]` asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyOptions {
    /// Number of simulated sensors.
    pub sensors: usize,
    /// Seed that everything random follows from.
    pub seed: u64,
}

impl Default for StudyOptions {
    fn default() -> Self {
        Self { sensors: 30, seed: 1 }
    }
}

/// Reads `[calibrate]`.
pub(super) fn read_calibrate(section: &Section<'_>, sensor: &Sensor) -> Result<CalibrateOptions> {
    let prior = section.get("prior").map_or(Ok(Prior::None), |entry| {
        entry.word(&[("none", Prior::None), ("datasheet", Prior::Datasheet)])
    })?;
    if prior == Prior::Datasheet {
        super::need_spreads(section, "prior", sensor)?;
    }
    Ok(CalibrateOptions { prior })
}

/// Reads `[study]`.
pub(super) fn read_study(section: &Section<'_>) -> Result<StudyOptions> {
    let otherwise = StudyOptions::default();
    Ok(StudyOptions {
        sensors: section.get("sensors").map_or(Ok(otherwise.sensors), |entry| entry.size(1, 10_000_000))?,
        seed: section.get("seed").map_or(Ok(otherwise.seed), |entry| entry.whole(0, u64::MAX))?,
    })
}
