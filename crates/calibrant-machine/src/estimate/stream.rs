//! The samples of one sensor, and the noise that they are weighed by.

use calibrant_core::sensor::{Recording, SensorKind};
use nalgebra::Vector3;

/// The readings of a sensor, in m/s² and rad/s or in counts, in the order of time.
#[derive(Debug, Clone)]
pub(super) struct Stream<'a> {
    pub(super) sensor: SensorKind,
    pub(super) recording: &'a Recording,
    /// Standard deviation of one sample, per axis.
    pub(super) sd: Vector3<f64>,
    /// How many times larger the noise of each sample is, where it grows with motion. Empty: everywhere 1.
    pub(super) growth: Vec<f64>,
    /// Every how many samples are used.
    pub(super) stride: usize,
}

impl Stream<'_> {
    /// Standard deviation of sample `k`, per axis.
    pub(super) fn sd_of(&self, k: usize) -> Vector3<f64> {
        self.sd * self.growth.get(k).copied().unwrap_or(1.0)
    }
}
