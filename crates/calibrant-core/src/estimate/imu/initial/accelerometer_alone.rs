//! The steps of the initial accelerometer: directions or magnitudes of the holds, their temperatures, its temperature terms.

use crate::error::Result;
use crate::estimate::imu::initial::accelerometer::InitialAccelerometer;
use crate::estimate::imu::initial::known_faces::from_faces;
use crate::estimate::imu::initial::temperature_terms::with_temperature_terms;
use crate::estimate::imu::initial::unknown_directions::from_unknown_directions;
use crate::estimate::imu::problem::ImuProblem;
use crate::estimate::imu::temperature::RecordingTemperature;
use crate::estimate::settings::CalibrationSettings;
use crate::motion::Hold;
use crate::sensor::Recording;

/// The initial accelerometer and the temperatures of its holds. This step does not need the gyroscope.
pub(crate) fn initial_accelerometer<'a>(
    problem: &ImuProblem<'a>,
    accelerometer: &Recording,
    settings: &CalibrationSettings,
) -> Result<(InitialAccelerometer, RecordingTemperature<'a>)> {
    let setup = problem.setup;
    let from = |recording: &Recording, intervals: Option<Vec<(f64, f64)>>| match &setup.directions {
        Some(directions) => from_faces(&problem.on_faces(directions, accelerometer), recording, None),
        None => from_unknown_directions(problem, recording, settings, intervals),
    };
    let first = from(accelerometer, setup.holds.intervals_s.clone())?;
    let found: Vec<Hold> = first.holds.holds.iter().map(|result| result.hold.clone()).collect();
    let temperature = RecordingTemperature::of(problem, &found)?;
    let first = with_temperature_terms(
        problem,
        accelerometer,
        first,
        &temperature,
        settings,
        |recording, intervals| from(recording, Some(intervals)),
    )?;
    Ok((first, temperature))
}
