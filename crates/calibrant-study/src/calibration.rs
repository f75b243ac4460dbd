//! The calibration study: sensors that are moved by the same command and calibrated once.

use super::simulated_recording::record;
use super::summary::summarise;
use super::{SensorOutcome, SingleCase, Study};
use calibrant_core::error::Result;
use calibrant_core::estimate::{CalibrationProblem, CalibrationSettings, Stimulus, calibrate};
use calibrant_core::motion::CommandedMotion;
use calibrant_core::sensor::{Sensor, SensorKind};
use calibrant_core::simulate::{Purpose, draw_sensor, stream};
use calibrant_design::DesignSettings;
use rayon::prelude::*;

/// A population and the motion that calibrates it.
#[derive(Debug, Clone, Copy)]
pub struct StudyProblem<'a> {
    /// The datasheet from which sensors are drawn; its noise must be given.
    pub sensor: &'a Sensor,
    /// The command, and how far it is trusted.
    pub command: &'a CommandedMotion,
    /// Sample rate, Hz.
    pub rate_hz: f64,
    /// Number of sensors.
    pub sensors: usize,
}

/// The settings of all studies.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StudySettings {
    /// Seed of everything random. Sensors of the same number are the same in every study under one seed.
    pub seed: u64,
    /// How each sensor is calibrated.
    pub calibration: CalibrationSettings,
    /// How each motion is designed. Every sensor's design has a seed of its own that follows from the study's, and only the first sensor's has a
    /// certificate.
    pub design: DesignSettings,
    /// Rate at which the sensor in detail is recorded once more, Hz. Where it is not given, it is five times
    /// the rate, as in the report (2 Hz and 10 Hz).
    pub detail_rate_hz: Option<f64>,
}

impl StudySettings {
    /// The rate at which the sensor in detail is recorded once more, where the others are recorded at `rate_hz`.
    pub(crate) fn detail_rate_hz(&self, rate_hz: f64) -> f64 {
        self.detail_rate_hz.unwrap_or(rate_hz * DETAIL_RATE)
    }
}

/// Multiple of the rate at which the case in detail is shown, too.
const DETAIL_RATE: f64 = 5.0;

/// Runs a study, in parallel; `progress` is called with 1 after each sensor.
///
/// The result does not depend on the number of threads. Where it is interrupted, it has the sensors that are finished.
///
/// # Errors
/// As [`calibrate`].
///
/// # References
/// `vamvaka2021`
pub fn run_study(
    problem: &StudyProblem<'_>,
    settings: &StudySettings,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<Study> {
    let single = simulate_case(problem, settings, problem.rate_hz, 0)?;
    let fine = simulate_case(problem, settings, settings.detail_rate_hz(problem.rate_hz), 0)?;
    let list = problem.sensor.parameter_list();
    let interruption = &settings.design.interruption;
    let outcomes = (0..problem.sensors as u64)
        .into_par_iter()
        .filter(|index| *index == 0 || !interruption.is_asked())
        .map(|index| {
            let case = simulate_case(problem, settings, problem.rate_hz, index)?;
            progress(1);
            Ok(SensorOutcome {
                truth: list.quantities().iter().map(|quantity| quantity.value(&case.truth)).collect(),
                sd: case.calibration.sd(),
                values: case.calibration.values,
                p_value: case.calibration.fit.p_value,
                status: case.calibration.status.name(),
            })
        })
        .collect::<Result<Vec<_>>>()?;
    let triples: Vec<_> =
        outcomes.iter().map(|outcome| (&outcome.truth[..], &outcome.values[..], &outcome.sd[..])).collect();
    let nominal = problem.sensor.nominal().unwrap_or(single.calibration.imu[SensorKind::Accelerometer]);
    let parameters = list.describe(problem.sensor, &nominal);
    Ok(Study {
        sensor: problem.sensor.clone(),
        trust: problem.command.trust.name(),
        seed: settings.seed,
        rate_hz: problem.rate_hz,
        motion: problem.command.motion.clone(),
        summary: summarise(&parameters, &triples),
        parameters,
        outcomes,
        single,
        fine,
    })
}

/// Draws sensor `index`, moves it, records it, calibrates it.
fn simulate_case(
    problem: &StudyProblem<'_>,
    settings: &StudySettings,
    rate_hz: f64,
    index: u64,
) -> Result<SingleCase> {
    let sensor = problem.sensor;
    let mut rng = stream(settings.seed, Purpose::Sensor, index);
    let truth = draw_sensor(sensor, &mut rng);
    let command = problem.command;
    let (true_motion, recording) = record(sensor, &truth, command, rate_hz, &mut rng)?;
    let problem = CalibrationProblem { sensor, recording: &recording, stimulus: Stimulus::Motion(command) };
    let calibration = calibrate(&problem, &settings.calibration)?;
    Ok(SingleCase { truth, true_motion, recording, calibration })
}
