//! The samples of one sensor, and the noise that they are weighed by.

use calibrant_core::sensor::{Recording, SensorKind};
use nalgebra::Vector3;

/// The readings of a sensor, in m/s² and rad/s or in counts, in the order of time.
#[derive(Debug, Clone)]
pub(crate) struct Stream<'a> {
    pub(crate) sensor: SensorKind,
    pub(crate) recording: &'a Recording,
    /// Standard deviation of one sample, per axis.
    pub(crate) sd: Vector3<f64>,
    /// How many times larger the noise of each sample is, where it grows with motion. Empty: everywhere 1.
    pub(crate) growth: Vec<f64>,
}

impl Stream<'_> {
    /// Standard deviation of sample `k`, per axis.
    pub(crate) fn sd_of(&self, k: usize) -> Vector3<f64> {
        self.sd * self.growth.get(k).copied().unwrap_or(1.0)
    }
}

/// The noise that neighbouring samples do not share: from the median of second differences, per axis.
pub(crate) fn white_noise(recording: &Recording) -> Vector3<f64> {
    /// Standard deviation of a normal distribution in median absolute deviations, of second differences of white noise.
    const OF_MEDIAN: f64 = 0.674_489_75 * 2.449_489_742_783_178;
    Vector3::from_fn(|axis, _| {
        let second =
            |window: &[Vector3<f64>]| (window[0][axis] - 2.0 * window[1][axis] + window[2][axis]).abs();
        let mut differences: Vec<f64> = recording.readings().windows(3).map(second).collect();
        if differences.is_empty() {
            return 1.0;
        }
        let middle = differences.len() / 2;
        let (_, median, _) = differences.select_nth_unstable_by(middle, f64::total_cmp);
        (*median / OF_MEDIAN).max(1e-9)
    })
}
