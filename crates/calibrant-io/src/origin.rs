//! Where a result comes from: the sensor, its station, and the files.

use super::hashed_file::HashedFile;
use super::input::Input;
use super::utc_time::UtcTime;
use serde::Serialize;

/// Where a calibration comes from. There is no time of day in it: the same files give the same origin.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Origin {
    /// The sensor: its serial number, or what else names it.
    pub sensor: Option<String>,
    /// When the recording was made, by itself or by its name.
    pub recorded: Option<UtcTime>,
    /// Where it was made.
    pub station: Option<String>,
    /// The experiment file.
    pub experiment: Option<HashedFile>,
    /// The commanded motion, or the log of a machine, where it is one file for all recordings.
    pub motion: Option<HashedFile>,
    /// The files of the recording.
    pub inputs: Vec<Input>,
}

impl Origin {
    /// Of these files of a recording, with nothing else known.
    #[must_use]
    pub fn of_inputs(inputs: impl IntoIterator<Item = Input>) -> Self {
        Self { inputs: inputs.into_iter().collect(), ..Self::default() }
    }

    /// Its fields at the head of a file.
    pub(super) fn fields(&self) -> OriginFields<'_> {
        let Self { sensor, recorded, station, experiment, motion, .. } = self;
        OriginFields {
            sensor: sensor.as_deref(),
            recorded: *recorded,
            station: station.as_deref(),
            experiment: experiment.as_ref(),
            motion_file: motion.as_ref(),
        }
    }
}

/// To be flattened into a file, after its heading.
#[derive(Serialize)]
pub(super) struct OriginFields<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    sensor: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    recorded: Option<UtcTime>,
    #[serde(skip_serializing_if = "Option::is_none")]
    station: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    experiment: Option<&'a HashedFile>,
    #[serde(skip_serializing_if = "Option::is_none")]
    motion_file: Option<&'a HashedFile>,
}
