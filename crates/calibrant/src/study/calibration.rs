//! Sensors that are moved by the same command and calibrated once.

use super::{ParameterSummary, SensorOutcome, SingleCase, Study};
use crate::error::Result;
use crate::estimate::{Calibration, CalibrationProblem, CalibrationSettings, Stimulus, calibrate};
use crate::motion::{CommandedMotion, Trust};
use crate::sensor::Sensor;
use crate::simulate::{Purpose, draw_sensor, perturb, sample_times, simulate_recording, stream};
use nalgebra::Vector3;
use rayon::prelude::*;

/// A population and the motion that calibrates it.
#[derive(Debug, Clone, Copy)]
pub struct StudyProblem<'a> {
    /// The datasheet that sensors are drawn from; its noise must be given.
    pub sensor: &'a Sensor,
    /// The command, and how far it is trusted.
    pub command: &'a CommandedMotion,
    /// Sample rate, Hz.
    pub rate_hz: f64,
    /// Number of sensors.
    pub sensors: usize,
}

/// How a study is run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StudySettings {
    /// Seed of everything random.
    pub seed: u64,
    /// How each sensor is calibrated.
    pub calibration: CalibrationSettings,
}

/// The detail case is shown at this multiple of the rate too, as the report does (2 Hz and 10 Hz).
const FINE_RATE: f64 = 5.0;

/// Runs a study, in parallel; `progress` is called with 1 after each sensor.
///
/// The result does not depend on the number of threads.
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
    let fine = simulate_case(problem, settings, problem.rate_hz * FINE_RATE, 0)?;
    let list = problem.sensor.parameter_list();
    let outcomes = (0..problem.sensors as u64)
        .into_par_iter()
        .map(|index| {
            let case = simulate_case(problem, settings, problem.rate_hz, index)?;
            progress(1);
            Ok(SensorOutcome {
                truth: list.quantities().iter().map(|quantity| quantity.of(&case.truth)).collect(),
                sd: case.calibration.sd(),
                values: case.calibration.values,
                p_value: case.calibration.fit.p_value,
                status: case.calibration.status.name(),
            })
        })
        .collect::<Result<Vec<_>>>()?;
    Ok(Study {
        sensor: problem.sensor.clone(),
        parameters: single.calibration.parameters.clone(),
        trust: problem.command.trust.name(),
        seed: settings.seed,
        rate_hz: problem.rate_hz,
        motion: problem.command.motion.clone(),
        summary: summarise(&single.calibration, &outcomes),
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
    let true_motion = match command.trust {
        Trust::Noisy(noise) => perturb(&command.motion, &noise, sensor.axes, command.known_ends, &mut rng)?,
        Trust::Known | Trust::Unknown => command.motion.clone(),
    };
    let noise = sensor.noise(&truth.matrix.diagonal()).unwrap_or_else(Vector3::zeros);
    let times = sample_times(&command.motion, rate_hz);
    let recording =
        simulate_recording(&truth, &noise, sensor.unit, sensor.axes, &true_motion, &times, &mut rng);
    let problem = CalibrationProblem { sensor, recording: &recording, stimulus: Stimulus::Motion(command) };
    let calibration = calibrate(&problem, &settings.calibration)?;
    Ok(SingleCase { truth, true_motion, recording, calibration })
}

/// Half-width of a 95 % interval in standard deviations.
const NORMAL_95: f64 = 1.959_963_984_540_054;

fn summarise(calibration: &Calibration, outcomes: &[SensorOutcome]) -> Vec<ParameterSummary> {
    let mean =
        |f: &dyn Fn(&SensorOutcome) -> f64| outcomes.iter().map(f).sum::<f64>() / outcomes.len() as f64;
    calibration
        .parameters
        .iter()
        .enumerate()
        .map(|(k, parameter)| ParameterSummary {
            name: parameter.name.clone(),
            unit: parameter.unit,
            predicted_sd: mean(&|outcome| outcome.sd[k].powi(2)).sqrt(),
            realised_rms: mean(&|outcome| (outcome.values[k] - outcome.truth[k]).powi(2)).sqrt(),
            mean_error: mean(&|outcome| outcome.values[k] - outcome.truth[k]),
            coverage_95: mean(&|outcome| {
                f64::from((outcome.values[k] - outcome.truth[k]).abs() <= NORMAL_95 * outcome.sd[k])
            }),
        })
        .collect()
}
