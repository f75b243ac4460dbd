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

/// The lesser of two numbers, the first if they cannot be compared. For what is done with every sample: `f64::min` minds NaN and takes thrice as long.
#[inline]
pub(crate) fn lesser(one: f64, other: f64) -> f64 {
    if other < one { other } else { one }
}

/// The greater of two numbers, as [`lesser`].
#[inline]
pub(crate) fn greater(one: f64, other: f64) -> f64 {
    if other > one { other } else { one }
}

/// The inverse of the median step between times in s, Hz; 0 for fewer than two.
pub(crate) fn rate_hz(times_s: &[f64]) -> f64 {
    // whole numbers in the order of the steps, as `f64::total_cmp` has it: they are sorted faster
    let ordered = |bits: i64| bits ^ ((bits >> 63) as u64 >> 1) as i64;
    let mut steps: Vec<i64> =
        times_s.windows(2).map(|pair| ordered((pair[1] - pair[0]).to_bits() as i64)).collect();
    if steps.is_empty() {
        return 0.0;
    }
    let middle = steps.len() / 2;
    let (_, median, _) = steps.select_nth_unstable(middle);
    1.0 / f64::from_bits(ordered(*median) as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_is_that_of_the_median_step() {
        assert_eq!((rate_hz(&[]), rate_hz(&[1.0])), (0.0, 0.0));
        // steps of -1, 0, 0.25, 0.5 and 8
        assert_eq!(rate_hz(&[0.0, 0.5, 8.5, 7.5, 7.5, 7.75]), 4.0);
        let mut times = vec![0.0];
        (1..1000).for_each(|k| times.push(times[k - 1] + 0.01 + 1e-3 * (k as f64).sin()));
        let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        steps.sort_by(f64::total_cmp);
        assert_eq!(rate_hz(&times), 1.0 / steps[steps.len() / 2]);
    }
}
