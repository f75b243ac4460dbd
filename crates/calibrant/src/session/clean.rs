//! Outliers are taken out of a recording once, for all stages that follow.

use calibrant_core::diagnostic::{Check, Diagnostic, samples};
use calibrant_core::estimate::repeated_readings;
use calibrant_core::estimate::{CalibrationProblem, Stimulus, without_motion_outliers};
use calibrant_core::motion::CommandedMotion;
use calibrant_core::sensor::{ImuRecording, Sensor, SensorKind, Spikes};
use std::borrow::Cow;

/// Takes readings out of a recording that only repeat, and says so.
pub(crate) fn take_out_repeats(recording: &mut ImuRecording) -> Vec<Diagnostic> {
    let Some((clean, found)) = recording.without_repeats() else { return Vec::new() };
    *recording = clean;
    found.iter().flat_map(|(sensor_kind, repeats)| repeated_readings(repeats, *sensor_kind)).collect()
}

/// Takes spikes and invalid readings out of a recording. Gives a diagnostic for each sensor that has some.
pub(crate) fn take_out_outliers(recording: &mut ImuRecording) -> Vec<Diagnostic> {
    let (clean, outliers) = recording.without_spikes();
    let found = diagnostics(recording, &outliers);
    if let Cow::Owned(clean) = clean {
        *recording = clean;
    }
    found
}

/// The same of a recording on a machine, where the movements of both sensors count.
pub(crate) fn take_out_outliers_in_motion(recording: &mut ImuRecording) -> Vec<Diagnostic> {
    let mut found = take_out_repeats(recording);
    let (clean, outliers) = recording.without_spikes_in_motion();
    found.extend(diagnostics(recording, &outliers));
    if let Cow::Owned(clean) = clean {
        *recording = clean;
    }
    found
}

/// Replaces what was found of the gyroscope's spikes: those in movements were kept, those at rest were not.
pub(crate) fn keep_knocks(found: &mut Vec<Diagnostic>, at_rest: Option<&Spikes>, recording: &ImuRecording) {
    let kind = SensorKind::Gyroscope;
    let is_of_it =
        |found: &Diagnostic| found.subject().is_some_and(|subject| subject.starts_with(kind.name()));
    found.retain(|found| found.code() != samples::Spikes::CODE || !is_of_it(found));
    found.extend(at_rest.into_iter().flat_map(|spikes| diagnostics(recording, &[(kind, spikes.clone())])));
}

fn diagnostics(recording: &ImuRecording, outliers: &[(SensorKind, Spikes)]) -> Vec<Diagnostic> {
    let of_sensor = |(sensor_kind, spikes): &(SensorKind, Spikes)| {
        let unit = recording.sensor(*sensor_kind)?.unit();
        Some(samples::Spikes::of(spikes, *sensor_kind, unit).into())
    };
    outliers.iter().filter_map(of_sensor).collect()
}

/// Takes the samples out of the recording of a motion that are far from all others.
pub(crate) fn take_out_motion_outliers(
    sensor: &Sensor,
    command: &CommandedMotion,
    recording: &mut ImuRecording,
) -> Option<Diagnostic> {
    let readings = recording[SensorKind::Accelerometer].as_ref()?;
    let problem = CalibrationProblem { sensor, recording: readings, stimulus: Stimulus::Motion(command) };
    let (clean, found) = without_motion_outliers(&problem)?;
    if clean.is_some() {
        recording[SensorKind::Accelerometer] = clean;
    }
    Some(found)
}
