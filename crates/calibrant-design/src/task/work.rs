//! What a design takes, estimated before it begins.

use crate::local_search::sequential_programming::SHORT;
use crate::{DesignProblem, DesignSettings};
use calibrant_core::budget::Budget;
use calibrant_core::motion::Trust;
use calibrant_core::sensor::SensorModel;

impl DesignSettings {
    /// What the design of this motion takes at most. The search ends earlier where starts agree.
    #[must_use]
    pub fn work(&self, problem: &DesignProblem<'_>) -> Budget {
        let sensor = problem.sensor;
        // measured, within a factor of four: the axes of a full sensor are one problem, of their cube in time
        let (parts, size) = match sensor.model {
            SensorModel::ScaleBias => (sensor.axes, 1.0),
            SensorModel::Full => (1, (sensor.axes as f64).powi(3)),
        };
        let noisy = if matches!(problem.trust, Trust::Noisy(_)) { 2.0 } else { 1.0 };
        let (starts, intervals) = ((self.starts * parts) as f64, problem.intervals as f64);
        // the program of a long motion takes time in proportion to its length, as far as its iterations do
        let axes = if parts == 1 { sensor.axes } else { 1 };
        let per_interval = 2e-4 + 1e-5 * intervals;
        let per_interval =
            if (problem.intervals + 1) * axes > SHORT { per_interval.min(5e-4) } else { per_interval };
        Budget {
            bytes: starts * (24.0 * intervals + 500.0) + 1e4 * intervals,
            seconds: self.seconds.unwrap_or(starts * size * noisy * intervals * per_interval),
        }
    }
}
