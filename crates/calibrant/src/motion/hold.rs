//! A hold: the sensor kept still in one orientation.

use nalgebra::Vector3;

/// A stretch of a recording in which the sensor is still, reduced to its mean.
#[derive(Debug, Clone, PartialEq)]
pub struct Hold {
    /// First sample (index into the recording).
    pub first: usize,
    /// One past the last sample.
    pub end: usize,
    /// Time of the first sample, s.
    pub start_s: f64,
    /// Time of the last sample, s.
    pub end_s: f64,
    /// Mean reading ȳ, in the unit of the recording.
    pub mean: Vector3<f64>,
    /// Standard deviation of single readings within the hold.
    pub sd: Vector3<f64>,
}

impl Hold {
    /// Number of samples n.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.end - self.first
    }

    /// Standard deviation of single readings within holds, pooled over them.
    pub(crate) fn pooled_sd<'a>(holds: impl IntoIterator<Item = &'a Self>) -> Vector3<f64> {
        let (mut squares, mut degrees) = (Vector3::zeros(), 0.0_f64);
        for hold in holds {
            let own = (hold.samples() - 1) as f64;
            squares += hold.sd.component_mul(&hold.sd) * own;
            degrees += own;
        }
        (squares / degrees.max(1.0)).map(f64::sqrt)
    }

    /// Duration, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.end_s - self.start_s
    }
}
