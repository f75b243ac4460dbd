//! Swapped sensors, taken for each other: files or columns exchanged.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::holds::SensorsSwapped;
use crate::error::{Error, NotIdentifiable};
use crate::estimate::holds::{find_clean_holds, median};
use crate::sensor::{ImuRecording, Recording, SensorKind};
use nalgebra::Vector3;

/// This many segments of rest that differ are those of an accelerometer in several orientations.
const SEVERAL_RESTS: usize = 4;

/// Segments differ if their means scatter by this many standard deviations of a sample.
const DIFFER_SD: f64 = 10.0;

/// Says that the gyroscope rests at different values, as an accelerometer does, and the accelerometer at one value at most.
#[must_use]
pub fn swapped_sensors(recording: &ImuRecording, minimum_s: f64) -> Option<SensorsSwapped> {
    let (accelerometer, gyroscope) =
        (recording[SensorKind::Accelerometer].as_ref()?, recording[SensorKind::Gyroscope].as_ref()?);
    (rests_at_several(gyroscope, minimum_s) && !rests_at_several(accelerometer, minimum_s))
        .then_some(SensorsSwapped {})
}

/// The same error, which came of the holds, with this question.
pub(crate) fn with_swapped_sensors(error: Error, recording: &ImuRecording, minimum_s: f64) -> Error {
    match (error, swapped_sensors(recording, minimum_s)) {
        (Error::NotIdentifiable(undetermined), Some(stated)) => {
            let stated = Diagnostic::from(stated);
            let mut groups = undetermined.groups;
            groups
                .iter_mut()
                .for_each(|group| group.reason = format!("{}; {}", group.reason, stated.message()));
            Error::NotIdentifiable(Box::new(NotIdentifiable { groups }))
        }
        (error, _) => error,
    }
}

fn rests_at_several(recording: &Recording, minimum_s: f64) -> bool {
    let Ok(rests) = find_clean_holds(recording, minimum_s) else { return false };
    if rests.len() < SEVERAL_RESTS {
        return false;
    }
    let center = Vector3::from_fn(|axis, _| median(rests.iter().map(|rest| rest.mean[axis]).collect()));
    let off = median(rests.iter().map(|rest| (rest.mean - center).norm()).collect());
    off > DIFFER_SD * median(rests.iter().map(|rest| rest.sd.norm()).collect())
}
