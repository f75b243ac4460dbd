//! Mean and scatter of a sensor's readings over an interval of time.

use super::Recording;
use nalgebra::Vector3;
use std::ops::Range;

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
