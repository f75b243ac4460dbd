//! Readings that repeat, as diagnostics.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::samples::{ReadingsPolled, ReadingsStuck, ReadingsStuckBriefly};
use crate::sensor::{Repeats, SensorKind};

/// What readings that repeat say of a sensor.
#[must_use]
pub fn repeated_readings(found: &Repeats, sensor_kind: SensorKind) -> Vec<Diagnostic> {
    /// Share of the samples from which on the recording is in doubt.
    const DOUBTED: f64 = 0.01;
    let polled = found.each.map(|times_each| {
        Diagnostic::from(ReadingsPolled { sensor_kind, times_each, rate_hz: found.rate_hz })
    });
    let stuck = found.stuck.iter().map(|stuck| {
        let (axis, runs, samples) = (stuck.axis, stuck.runs, stuck.samples);
        let share = samples as f64 / found.of_samples as f64;
        let (start_s, end_s) = (stuck.start_s, stuck.end_s);
        match share > DOUBTED {
            true => ReadingsStuck { sensor_kind, axis, samples, share, runs, start_s, end_s }.into(),
            false => ReadingsStuckBriefly { sensor_kind, axis, samples, share, runs, start_s, end_s }.into(),
        }
    });
    polled.into_iter().chain(stuck).collect()
}
