//! What is examined for noise.

use calibrant_core::interruption::Interruption;
use calibrant_core::sensor::SensorKind;
use nalgebra::Vector3;

/// What is examined for noise.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NoiseOptions {
    /// The sensor; `None`: all that were recorded.
    pub sensor: Option<SensorKind>,
    /// Start and end of the interval at rest, s; `None`: the longest hold.
    pub hold_s: Option<(f64, f64)>,
    /// Nominal gains, counts per m/s² or rad/s: the noise of these sensors is stated in SI.
    pub gains: Vec<(SensorKind, Vector3<f64>)>,
    /// Ends the work without a result.
    pub interruption: Interruption,
}
