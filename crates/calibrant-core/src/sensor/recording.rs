//! The recording: readings of a sensor over time. It knows its rate, gaps and extremes, and changes nothing.

use super::extremes::{greater, lesser};
use super::sample_rate::rate_hz;
use super::{Axis, ReadingUnit};
use nalgebra::Vector3;

/// A recording: times in seconds, strictly increasing, and a reading for each. A uniaxial sensor uses x; the
/// other components are zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// Sample times, s.
    pub times_s: Vec<f64>,
    /// Readings, in [`unit`](Recording::unit).
    pub readings: Vec<Vector3<f64>>,
    /// Number of axes, 1 or 3.
    pub axes: usize,
    /// Unit of the readings.
    pub unit: ReadingUnit,
}

/// A step of this number of usual steps is a gap.
const GAP: f64 = 5.0;
/// No gap is shorter than this, s: nothing moves in so short a time.
const MOVED_S: f64 = 0.05;

impl Recording {
    /// Adds another recording of the sensor, which begins `pause_s` after the end of this one.
    pub fn append(&mut self, other: &Self, pause_s: f64) {
        let end_s = self.times_s.last().copied().unwrap_or_default();
        let later_s = end_s + pause_s - other.times_s.first().copied().unwrap_or_default();
        self.times_s.extend(other.times_s.iter().map(|t| t + later_s));
        self.readings.extend_from_slice(&other.readings);
    }

    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.times_s.len()
    }

    /// Is there no sample?
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.times_s.is_empty()
    }

    /// The one value of an axis that never changes; `None` where it does.
    #[must_use]
    pub fn constant(&self, axis: Axis) -> Option<f64> {
        let value = self.readings.first()?[axis.index()];
        self.readings.iter().all(|reading| reading[axis.index()] == value).then_some(value)
    }

    /// Least and largest reading of each axis; ∞ and −∞ where there is no sample.
    #[must_use]
    pub fn extremes(&self) -> [Vector3<f64>; 2] {
        let infinite = Vector3::repeat(f64::INFINITY);
        self.readings.iter().fold([infinite, -infinite], |[least, most], y| {
            [least.zip_map(y, lesser), most.zip_map(y, greater)]
        })
    }

    /// The axes that were recorded.
    #[must_use]
    pub fn active_axes(&self) -> &'static [Axis] {
        &Axis::ALL[..self.axes]
    }

    /// Sample rate in Hz: the inverse of the usual time between samples, so that gaps do not matter; 0 for
    /// fewer than two samples.
    ///
    /// The usual time is the median step. Steps may jitter or come in coarse units, as at 400 Hz in whole
    /// milliseconds: then it is the mean step. Where samples are lost, it is the least usual step.
    #[must_use]
    pub fn rate_hz(&self) -> f64 {
        rate_hz(&self.times_s)
    }

    /// A longer time between samples, s, is a gap that separates the samples before it from those after. It
    /// is five usual steps, but at least the time in which a sensor can be moved.
    #[must_use]
    pub(crate) fn gap_s(&self) -> f64 {
        gap_s(self.rate_hz())
    }
}

/// The same for readings at this rate.
pub(crate) fn gap_s(rate_hz: f64) -> f64 {
    (GAP / rate_hz).max(MOVED_S)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_is_of_five_steps_and_lasts_long_enough_to_be_moved() {
        let at = |time: &dyn Fn(usize) -> f64| -> Vec<f64> { (0..40_000).map(time).collect() };
        let recording = |times_s| Recording {
            times_s,
            readings: Vec::new(),
            axes: 3,
            unit: ReadingUnit::RadianPerSecond,
        };
        assert_eq!(recording(at(&|k| k as f64 * 0.0625)).gap_s(), 0.3125);
        assert_eq!(recording(at(&|k| k as f64 / 1024.0)).gap_s(), 0.05);
    }
}
