//! What designs and studies take, estimated before they begin.

use super::sequential_programming::SHORT;
use super::study::{DesignStudyProblem, StudiesProblem, StudyProblem, StudySettings};
use super::{DesignProblem, DesignSettings};
use calibrant_core::budget::Budget;
use calibrant_core::motion::Trust;
use calibrant_core::sensor::{SensorModel, SensorParameters};
use std::ops::Add;

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

impl StudiesProblem<'_> {
    /// What these studies take.
    #[must_use]
    pub fn work(&self, settings: &StudySettings) -> Budget {
        let calibrations = self.calibration.iter().map(|problem| of_calibrations(problem, settings));
        let designs = [&self.design, &self.noisy].into_iter().flatten();
        calibrations
            .chain(designs.map(|problem| of_designs(problem, settings)))
            .fold(Budget::NONE, Budget::add)
    }
}

/// The calibration of one simulated recording. As many as there are threads are in memory at once.
fn of_calibration(samples: f64, sensors: usize) -> Budget {
    let at_once = rayon::current_num_threads().min(sensors) as f64;
    Budget { bytes: 500.0 * samples * at_once, seconds: 1e-6 * samples + 1e-3 }
}

fn of_calibrations(problem: &StudyProblem<'_>, settings: &StudySettings) -> Budget {
    let times = problem.command.motion.times_s();
    let duration_s = times[times.len() - 1] - times[0];
    let detail = of_calibration(duration_s * settings.detail_rate_hz(problem.rate_hz), 1);
    of_calibration(duration_s * problem.rate_hz, problem.sensors).repeated(problem.sensors as f64) + detail
}

fn of_designs(problem: &DesignStudyProblem<'_>, settings: &StudySettings) -> Budget {
    let samples = problem.intervals as f64 * problem.interval_s * problem.rate_hz;
    let nominal = problem.sensor.nominal().unwrap_or_else(SensorParameters::identity);
    let design = settings.design.work(&problem.design_at(nominal, None));
    let calibrations = of_calibration(samples, problem.sensors).repeated(2.0);
    (design + calibrations).repeated(problem.sensors as f64)
}
