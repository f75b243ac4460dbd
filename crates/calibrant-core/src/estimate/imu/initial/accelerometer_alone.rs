//! The steps of the initial accelerometer: directions or magnitudes of the holds, their temperatures, its temperature terms.

use crate::error::Result;
use crate::estimate::imu::estimated::expected_terms;
use crate::estimate::imu::initial::accelerometer::InitialAccelerometer;
use crate::estimate::imu::initial::known_faces::from_faces;
use crate::estimate::imu::initial::temperature_terms::with_temperature_terms;
use crate::estimate::imu::initial::unknown_directions::from_unknown_directions;
use crate::estimate::imu::known_term::KnownTerm;
use crate::estimate::imu::problem::ImuProblem;
use crate::estimate::imu::temperature::{RecordingTemperature, at_reference};
use crate::estimate::settings::CalibrationSettings;
use crate::motion::Hold;
use crate::sensor::{ImuQuantity, Recording, SensorKind, SensorParameters};

/// The recording at one temperature by the terms that are expected, and its holds as they are; `None` where nothing is expected. Far from what is usual, holds without
/// these terms would look like outliers.
fn as_expected<'a>(
    problem: &ImuProblem<'a>,
    recording: &Recording,
) -> Result<Option<(Recording, &'a [Hold])>> {
    let kind = SensorKind::Accelerometer;
    let is_term = |usual: &KnownTerm| {
        matches!(usual.quantity, ImuQuantity::Thermal(of, _) if of == kind) && usual.value != 0.0
    };
    let holds = problem.setup.holds.found.as_deref().filter(|_| problem.setup.usual.iter().any(is_term));
    let Some(holds) = holds else { return Ok(None) };
    let temperature = RecordingTemperature::of(problem, holds)?;
    let thermal = expected_terms(problem.setup, temperature.start);
    let nominal = problem.accelerometer.nominal().unwrap_or(SensorParameters::identity());
    Ok(Some((at_reference(recording, kind, &nominal, &thermal, &temperature), holds)))
}

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
    let expected = as_expected(problem, accelerometer)?;
    let recording = expected.as_ref().map_or(accelerometer, |(recording, _)| recording);
    let mut first = from(recording, setup.holds.intervals_s.clone())?;
    for (result, raw) in first.holds.holds.iter_mut().zip(expected.iter().flat_map(|(_, raw)| *raw)) {
        result.hold = raw.clone();
    }
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
