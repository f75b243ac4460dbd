//! A recording by another clock.

use calibrant::sensor::Recording;

/// The same samples at other times.
pub(crate) fn retimed(recording: &Recording, time: impl Fn(f64) -> f64) -> Recording {
    let times_s = recording.times_s().iter().map(|t| time(*t)).collect();
    let readings = recording.readings().to_vec();
    Recording::new(times_s, readings, recording.axes(), recording.unit()).expect("samples in order")
}
