//! Outliers are taken out of a recording once, for all stages that follow.

use calibrant_core::sensor::{ImuRecording, SensorKind};
use std::borrow::Cow;

/// Takes spikes and invalid readings out of a recording. A warning for each sensor that has some.
pub(crate) fn take_out_outliers(recording: &mut ImuRecording) -> Vec<String> {
    let (clean, outliers) = recording.without_spikes();
    let unit = |sensor_kind: SensorKind| recording.sensor(sensor_kind).map_or("", |of| of.unit.symbol());
    let warnings = outliers
        .iter()
        .map(|(sensor_kind, outliers)| outliers.words(*sensor_kind, unit(*sensor_kind)))
        .collect();
    if let Cow::Owned(clean) = clean {
        *recording = clean;
    }
    warnings
}
