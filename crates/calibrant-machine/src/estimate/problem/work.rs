//! What a calibration on a machine takes, estimated before it begins.

use super::MachineProblem;
use crate::log::ReferenceLog;
use calibrant_core::budget::Budget;
use calibrant_core::sensor::SensorKind;

impl MachineProblem<'_> {
    /// What this calibration takes.
    #[must_use]
    pub fn work(&self) -> Budget {
        let columns = match self.log {
            ReferenceLog::Joints(log) => log.names.len(),
            ReferenceLog::Poses(_) => 6,
        };
        let values = (self.log.times_s().len() * columns) as f64;
        let sensors = SensorKind::ALL.into_iter().filter_map(|kind| self.recording.sensor(kind));
        let samples = sensors.map(|sensor| sensor.len()).sum::<usize>() as f64;
        // measured, within a factor of three: logs of one to six joints and of poses, from a minute to ten
        Budget { bytes: 200.0 * values + 300.0 * samples, seconds: 4e-5 * values + 5e-5 * samples }
    }
}
