//! What studies take, estimated before they begin.

use super::{DesignStudyProblem, StudiesProblem, StudyProblem, StudySettings};
use calibrant_core::budget::Budget;
use calibrant_core::sensor::SensorParameters;
use std::ops::Add;

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
