//! All studies that one experiment file asks for.

use super::{
    DesignStudy, DesignStudyProblem, Rehearsal, Study, StudyProblem, StudySettings, run_design_study,
    run_study,
};
use calibrant_core::budget::Budget;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::design::SeriesInterrupted;
use calibrant_core::error::Result;
use calibrant_core::sensor::{Sensor, SensorParameters};
use calibrant_design::{SurfaceSettings, TraceSurface, trace_surface};
use std::ops::Add;

/// The studies that are wanted.
#[derive(Debug, Clone, Default)]
pub struct StudiesProblem<'a> {
    /// Sensors calibrated without a design.
    pub calibration: Option<StudyProblem<'a>>,
    /// The criterion over the jerks of two intervals, for the first axis of this sensor.
    pub surface: Option<(&'a Sensor, SurfaceSettings)>,
    /// Initial against optimal motion.
    pub design: Option<DesignStudyProblem<'a>>,
    /// The same with process noise.
    pub noisy: Option<DesignStudyProblem<'a>>,
    /// What a reader should know: studies that are not wanted although one might expect them, and why.
    pub notes: Vec<Diagnostic>,
}

impl StudiesProblem<'_> {
    /// How often `progress` will be called: the number of sensors.
    #[must_use]
    pub fn steps(&self) -> u64 {
        let designs = [&self.design, &self.noisy].into_iter().flatten().map(|problem| problem.sensors);
        let sensors = self.calibration.iter().map(|problem| problem.sensors).chain(designs).sum::<usize>();
        sensors as u64
    }
}

/// The result of `calibrant study`: the studies that were wanted. The preset `report` wants all of them.
#[derive(Debug, Clone, Default)]
pub struct Studies {
    /// Sensors calibrated without a design: the thesis's chapter 3, where only the ends of the motion are
    /// known (Figures 4 to 6).
    pub calibration: Option<Study>,
    /// The criterion over the jerks of two intervals (Figure 7).
    pub surface: Option<TraceSurface>,
    /// Initial against optimal motion, as `[motion]` and `[limits]` say (Figures 8 to 11).
    pub design: Option<DesignStudy>,
    /// The same with process noise, of `[study.noisy]` (Figures 13 and 14).
    pub noisy: Option<DesignStudy>,
    /// Of a machine: plain routine against best trajectory.
    pub rehearsal: Option<Rehearsal>,
    /// What a reader should know: studies that were not run although one might expect them, and why.
    pub notes: Vec<Diagnostic>,
}

/// Runs the wanted studies, one after the other; `progress` is called with 1 after each sensor.
///
/// Where it is interrupted, it has the sensors that are finished, and a note says so.
///
/// # Errors
/// As [`run_study`], [`trace_surface`] and [`run_design_study`].
pub fn run_studies(
    problem: &StudiesProblem<'_>,
    settings: &StudySettings,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<Studies> {
    let interruption = &settings.design.interruption;
    let designed = |problem: &Option<DesignStudyProblem<'_>>| {
        let wanted = problem.as_ref().filter(|_| !interruption.is_asked());
        wanted.map(|problem| run_design_study(problem, settings, progress)).transpose()
    };
    let mut studies = Studies {
        calibration: problem
            .calibration
            .as_ref()
            .map(|problem| run_study(problem, settings, progress))
            .transpose()?,
        surface: problem
            .surface
            .as_ref()
            .map(|(sensor, surface)| trace_surface(sensor, surface))
            .transpose()?,
        design: designed(&problem.design)?,
        noisy: designed(&problem.noisy)?,
        rehearsal: None,
        notes: problem.notes.clone(),
    };
    if interruption.is_asked() {
        let designed = [&studies.design, &studies.noisy].into_iter().flatten();
        let finished = designed.map(|study| study.outcomes.len()).sum::<usize>()
            + studies.calibration.as_ref().map_or(0, |study| study.outcomes.len());
        let all = problem.steps() as usize;
        studies.notes.push(SeriesInterrupted { series: "study", items: "sensors", finished, all }.into());
    }
    Ok(studies)
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

/// The calibration of one simulated recording. Each thread holds one recording in memory at a time.
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
