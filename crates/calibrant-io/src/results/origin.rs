//! Where a result comes from: the sensor, its station, and the files.

use super::input::Input;
use calibrant_core::json::if_some;
use calibrant_core::json_object;
use calibrant_recording::files::hashed_file::HashedFile;
use calibrant_recording::files::utc_time::UtcTime;

/// Where a calibration comes from. There is no time of day in it: the same files give the same origin.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Origin {
    /// The sensor: its serial number, or what else names it.
    pub sensor: Option<String>,
    /// When the recording was made, by itself or by its name.
    pub recorded: Option<UtcTime>,
    /// Where it was made.
    pub station: Option<String>,
    /// The experiment: its file, or its text where it came from none.
    pub experiment: Option<HashedFile>,
    /// The commanded motion, or the log of a machine, where it is one file for all recordings.
    pub motion: Option<HashedFile>,
    /// The files of the recording.
    pub inputs: Vec<Input>,
}

json_object! {
    /// Where a result comes from.
    Origin as origin {
        /// The serial number, or what else names the sensor.
        sensor: if_some(origin.sensor.as_deref()),
        /// When the recording was made, UTC.
        recorded: if_some(origin.recorded),
        /// Where it was made.
        station: if_some(origin.station.as_deref()),
        /// The experiment file.
        experiment: if_some(origin.experiment.as_ref()),
        /// The commanded motion, or the log of a machine, where it is one file for all recordings.
        motion_file: if_some(origin.motion.as_ref()),
        /// The files of the recording.
        inputs: &origin.inputs,
    }
}

impl Origin {
    /// Of these files of a recording, with nothing else known.
    #[must_use]
    pub fn of_inputs(inputs: impl IntoIterator<Item = Input>) -> Self {
        Self { inputs: inputs.into_iter().collect(), ..Self::default() }
    }
}
