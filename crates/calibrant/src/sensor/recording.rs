//! Readings of a sensor over time.

use super::{Axis, ReadingUnit};
use nalgebra::Vector3;

/// A recording: times in seconds, strictly increasing, and a reading for each. A uniaxial sensor uses x, the others are zero.
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

impl Recording {
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
    pub(crate) fn extremes(&self) -> [Vector3<f64>; 2] {
        // comparisons, as `f64::min` minds NaN and takes thrice as long
        let lesser = |one: f64, other: f64| if other < one { other } else { one };
        let greater = |one: f64, other: f64| if other > one { other } else { one };
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

    /// Sample rate in Hz: the inverse of the median time between samples, so that gaps do not matter; 0 for fewer than two samples.
    #[must_use]
    pub fn rate_hz(&self) -> f64 {
        rate_hz(&self.times_s)
    }
}

/// The inverse of the median step between times in s, Hz; 0 for fewer than two.
pub(crate) fn rate_hz(times_s: &[f64]) -> f64 {
    let mut steps: Vec<f64> = times_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if steps.is_empty() {
        return 0.0;
    }
    let middle = steps.len() / 2;
    let (_, median, _) = steps.select_nth_unstable_by(middle, f64::total_cmp);
    1.0 / *median
}
