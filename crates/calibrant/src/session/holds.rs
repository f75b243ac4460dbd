//! The holds of a recording are found once, and handed on to the estimator, the noise and the validation.

use calibrant_core::error::Result;
use calibrant_core::estimate::{HoldsSetup, find_clean_holds, find_clean_imu_holds, holds_between};
use calibrant_core::motion::Hold;
use calibrant_core::sensor::{ImuRecording, SensorKind};

/// The setup with the holds of this recording, from which outliers were taken out: those in the given intervals, else those that are found.
///
/// Where there are none to be found, the setup has none, and the estimator says why.
pub(crate) fn with_holds(setup: &HoldsSetup, recording: &ImuRecording) -> HoldsSetup {
    HoldsSetup { found: holds_of(setup, recording).ok().flatten(), ..setup.clone() }
}

/// The holds of this recording, or why there are none; `None` without an accelerometer.
pub(crate) fn holds_of(setup: &HoldsSetup, recording: &ImuRecording) -> Result<Option<Vec<Hold>>> {
    let minimum_s = setup.minimum_hold_s;
    let (accelerometer, gyroscope) =
        (&recording[SensorKind::Accelerometer], &recording[SensorKind::Gyroscope]);
    match (&setup.intervals_s, accelerometer, gyroscope) {
        (_, None, _) => return Ok(None),
        (Some(intervals), Some(accelerometer), _) => holds_between(accelerometer, intervals),
        (None, Some(accelerometer), None) => find_clean_holds(accelerometer, minimum_s),
        (None, Some(_), Some(_)) => find_clean_imu_holds(recording, minimum_s),
    }
    .map(Some)
}

/// Are the given holds one sample each: rows that are means? The first tells: the estimator refuses some of one sample and some of more.
pub(crate) fn are_means(setup: &HoldsSetup, recording: &ImuRecording) -> bool {
    let first = setup.intervals_s.as_ref().and_then(|given| given.get(..1));
    let accelerometer = recording[SensorKind::Accelerometer].as_ref();
    let held = first.zip(accelerometer).and_then(|(first, of)| holds_between(of, first).ok());
    held.is_some_and(|held| held[0].samples() == 1)
}
