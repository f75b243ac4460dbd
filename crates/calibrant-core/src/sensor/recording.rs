//! The recording: readings of a sensor over time. It knows its rate, gaps and extremes, and changes nothing.
//! The mean reading over an interval of time has its scatter beside it.

use super::extremes::{greater, lesser};
use super::sample_rate::rate_hz;
use super::{Axis, ReadingUnit};
use crate::error::{Error, InputError, Refusal, Result};
use nalgebra::Vector3;
use std::ops::Range;

/// A recording: times in seconds, strictly increasing, and a reading for each. A uniaxial sensor uses x; the
/// other components are zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    pub(crate) times_s: Vec<f64>,
    pub(crate) readings: Vec<Vector3<f64>>,
    pub(crate) axes: usize,
    pub(crate) unit: ReadingUnit,
}

/// A step of this number of usual steps is a gap.
const GAP: f64 = 5.0;
/// No gap is shorter than this, s: nothing moves in so short a time.
const MOVED_S: f64 = 0.05;

impl Recording {
    /// Readings of `axes` axes (1 or 3) at their times. A reading may be NaN; it counts as invalid. The readings of a uniaxial sensor are
    /// along x, and zero along the others.
    ///
    /// # Errors
    /// [`Error::Recording`] where there are not as many times as readings, where the times do not increase or are not finite, or where there are
    /// neither one nor three axes.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::sensor::{ReadingUnit, Recording};
    /// use nalgebra::Vector3;
    ///
    /// let (up, unit) = (Vector3::new(0.0, 0.0, 9.81), ReadingUnit::MetrePerSecondSquared);
    /// assert_eq!(Recording::new(vec![0.0, 0.01], vec![up; 2], 3, unit)?.rate_hz(), 100.0);
    /// assert!(Recording::new(vec![0.0, 0.01], vec![up; 3], 3, unit).is_err(), "a time for each reading");
    /// assert!(Recording::new(vec![0.0, 0.0], vec![up; 2], 3, unit).is_err(), "the times increase");
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    pub fn new(
        times_s: Vec<f64>,
        readings: Vec<Vector3<f64>>,
        axes: usize,
        unit: ReadingUnit,
    ) -> Result<Self> {
        let refused =
            |code, message: String, help: &str| Err(Error::recording(InputError::new(code, message, help)));
        if times_s.len() != readings.len() {
            let message = format!("{} times for {} readings", times_s.len(), readings.len());
            return refused(Refusal::RecordingsUnlike, message, "give a time for each reading");
        }
        if let Some(k) = times_s.iter().position(|time| !time.is_finite()) {
            let message = format!("the time of sample {k} is {}", times_s[k]);
            return refused(Refusal::NumberMalformed, message, "leave samples without a time away");
        }
        if let Some(k) = times_s.windows(2).position(|pair| pair[1] <= pair[0]) {
            let message = format!("sample {} is at {} s, after {} s", k + 1, times_s[k + 1], times_s[k]);
            return refused(Refusal::TimesNotIncreasing, message, "sort the samples by time, each once");
        }
        if ![1, 3].contains(&axes) {
            let message = format!("a sensor has one axis or three, not {axes}");
            return refused(Refusal::ValueInvalid, message, "give those of the sensor");
        }
        Ok(Self { times_s, readings, axes, unit })
    }

    /// Sample times, s, increasing.
    #[must_use]
    pub fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    /// The reading at each time, in [`unit`](Recording::unit).
    #[must_use]
    pub fn readings(&self) -> &[Vector3<f64>] {
        &self.readings
    }

    /// The same, to be changed.
    #[must_use]
    pub fn readings_mut(&mut self) -> &mut [Vector3<f64>] {
        &mut self.readings
    }

    /// The samples: each time, and its reading to be changed.
    pub fn samples_mut(&mut self) -> impl Iterator<Item = (&f64, &mut Vector3<f64>)> {
        self.times_s.iter().zip(&mut self.readings)
    }

    /// Number of axes, 1 or 3.
    #[must_use]
    pub fn axes(&self) -> usize {
        self.axes
    }

    /// Unit of the readings.
    #[must_use]
    pub fn unit(&self) -> ReadingUnit {
        self.unit
    }

    /// The first axis alone, or the first three: the readings of the others are zero.
    #[must_use]
    pub fn with_axes(mut self, axes: usize) -> Self {
        self.axes = if axes == 1 { 1 } else { Axis::ALL.len() };
        for axis in &Axis::ALL[self.axes..] {
            self.readings.iter_mut().for_each(|reading| reading[axis.index()] = 0.0);
        }
        self
    }

    /// The same samples at later times.
    #[must_use]
    pub fn later_by(mut self, seconds: f64) -> Self {
        self.times_s.iter_mut().for_each(|time| *time += seconds);
        self
    }

    /// The same times with other readings, in this unit.
    #[must_use]
    pub fn mapped(&self, unit: ReadingUnit, reading: impl FnMut(&Vector3<f64>) -> Vector3<f64>) -> Self {
        let readings = self.readings.iter().map(reading).collect();
        Self { times_s: self.times_s.clone(), readings, unit, ..*self }
    }

    /// The samples of these numbers, from 0.
    #[must_use]
    pub fn only(&self, keep: impl Fn(usize) -> bool) -> Self {
        let places = || (0..self.len()).filter(|&sample| keep(sample));
        Self {
            times_s: places().map(|sample| self.times_s[sample]).collect(),
            readings: places().map(|sample| self.readings[sample]).collect(),
            ..*self
        }
    }

    /// Adds a sample.
    ///
    /// # Errors
    /// [`Error::Recording`] where its time is not after that of the sample before.
    pub fn push(&mut self, time_s: f64, reading: Vector3<f64>) -> Result<()> {
        let after = self.times_s.last().is_none_or(|last| time_s > *last);
        if !after || !time_s.is_finite() {
            let message = format!("the time of a further sample is {time_s} s, not after the one before");
            let help = "give the samples in the order of their times, each once";
            return Err(Error::recording(InputError::new(Refusal::TimesNotIncreasing, message, help)));
        }
        self.times_s.push(time_s);
        self.readings.push(reading);
        Ok(())
    }

    /// Adds the samples of another recording of the sensor, later by `later_s`.
    pub(super) fn append(&mut self, other: &Self, later_s: f64) {
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

/// Mean of samples, and their scatter about it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MeanReading {
    /// The mean.
    pub mean: Vector3<f64>,
    /// Number of samples in the mean.
    pub samples: usize,
    /// Squared deviations from the mean, summed per axis.
    squares: Vector3<f64>,
}

impl MeanReading {
    /// The mean of readings; `None` without any.
    #[must_use]
    pub fn of(readings: &[Vector3<f64>]) -> Option<Self> {
        if readings.is_empty() {
            return None;
        }
        let mean = readings.iter().sum::<Vector3<f64>>() / readings.len() as f64;
        let squares = readings.iter().map(|y| (y - mean).component_mul(&(y - mean))).sum();
        Some(Self { mean, samples: readings.len(), squares })
    }

    /// Standard deviation of one sample about the mean of its segment, pooled over the segments; zero where
    /// none has two samples.
    #[must_use]
    pub fn pooled_sd<'a>(segments: impl IntoIterator<Item = &'a Self>) -> Vector3<f64> {
        let (mut squares, mut degrees) = (Vector3::zeros(), 0);
        for segment in segments {
            squares += segment.squares;
            degrees += segment.samples.saturating_sub(1);
        }
        (squares / degrees.max(1) as f64).map(f64::sqrt)
    }
}

impl Recording {
    /// The samples between two times, both included.
    pub(crate) fn between(&self, start_s: f64, end_s: f64) -> Range<usize> {
        let first = self.times_s.partition_point(|&t| t < start_s);
        let end = self.times_s.partition_point(|&t| t <= end_s);
        first..end.max(first)
    }

    /// Mean and scatter between two times; `None` where there is no sample.
    #[must_use]
    pub fn mean_between(&self, start_s: f64, end_s: f64) -> Option<MeanReading> {
        MeanReading::of(self.readings.get(self.between(start_s, end_s))?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::ReadingUnit;

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

    #[test]
    fn means_and_scatter_are_those_of_the_samples_between_the_times() {
        let values = [9.0, 1.0, 3.0, 10.0, 16.0, 7.0];
        let recording = Recording {
            times_s: (0..6).map(f64::from).collect(),
            readings: values.map(|x| Vector3::new(x, 0.0, -x)).to_vec(),
            axes: 3,
            unit: ReadingUnit::Counts,
        };
        let first = recording.mean_between(1.0, 2.5).expect("samples");
        let second = recording.mean_between(2.9, 4.0).expect("samples");
        assert_eq!((first.mean.x, first.mean.z, first.samples), (2.0, -2.0, 2));
        assert_eq!((second.mean.x, second.samples), (13.0, 2));
        // 1 + 1 + 9 + 9 with two degrees of freedom
        let sd = MeanReading::pooled_sd([&first, &second]);
        assert!((sd - Vector3::new(10.0_f64.sqrt(), 0.0, 10.0_f64.sqrt())).amax() < 1e-15, "{sd}");
        assert_eq!(recording.mean_between(5.2, 9.0), None);
        assert_eq!(recording.mean_between(4.0, 2.0), None);
    }
}
