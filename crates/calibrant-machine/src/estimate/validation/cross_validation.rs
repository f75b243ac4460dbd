//! Validation by blocks of time: the calibration without each block in turn.
//!
//! `θ` is from all data, `θ₋` from all but a block. `θ` uses its data best, so the covariance of the difference is that of the covariances (`hausman1978`):
//!
//! ```text
//! Cov(θ₋ − θ) = Σ₋ − Σ
//! ```
//!
//! The log stays whole; the sensor's samples are left out. Knots and noise are those of the calibration.

use super::{FailedBlock, MachineValidation, MachineValidationSource, Movement, judged, widened};
use crate::estimate::begin::middle_s;
use crate::estimate::least_squares::{Model, Scaled, State, Stream, WeighedLog, minimise};
use crate::estimate::noise::{Activity, Growths};
use crate::estimate::problem::{Layout, TiltedGravity, refused, unsolved};
use crate::estimate::result::undetermined;
use crate::estimate::{MachineCalibration, MachineProblem, MachineSettings};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::estimate::CalibrationStatus;
use calibrant_core::sensor::{ImuRecording, PerSensor, Recording, SensorKind};
use nalgebra::DVector;

/// Shortest block, s.
const SHORTEST_S: f64 = 1.0;

/// Leaves out each of `folds` blocks of time in turn, and compares how far the parameters move with what the covariance predicts.
///
/// # Errors
/// - [`Error::Experiment`](calibrant_core::Error::Experiment): fewer than two blocks, or blocks shorter than 1 s; or the work was interrupted.
/// - [`Error::Recording`](calibrant_core::Error::Recording): no block can be left out.
pub fn cross_validate_on_machine(
    problem: &MachineProblem<'_>,
    calibration: &MachineCalibration,
    settings: &MachineSettings,
    folds: usize,
) -> Result<MachineValidation> {
    let sensors = calibration.sensors.sensor_kinds();
    let Some(main) = sensors.last().and_then(|kind| problem.recording.sensor(*kind)) else {
        return Err(refused("the recording has no sensor", "record an accelerometer or a gyroscope"));
    };
    check_folds(problem, folds)?;
    if calibration.sensors.status != CalibrationStatus::Converged {
        let message = "the calibration did not converge: how far it moves without a block tells nothing";
        return Err(refused(message, "look at the warnings of the calibration"));
    }
    let (first, last) = (main.times_s()[0], main.times_s()[main.len() - 1]);
    let length_s = (last - first) / folds as f64;
    let (mut movements, mut failed) = (Vec::new(), Vec::new());
    for fold in 0..folds {
        let start_s = first + length_s * fold as f64;
        let end_s = if fold + 1 == folds { f64::INFINITY } else { start_s + length_s };
        settings.progress.tell("folds", fold as u64, folds as u64);
        match without(problem, calibration, settings, (start_s, end_s)) {
            Err(error) if error.code() == Refusal::Interrupted => return Err(error),
            Ok(movement) => movements.push(movement),
            Err(error) => {
                failed.push(FailedBlock { start_s, end_s: end_s.min(last), reason: error.to_string() });
            }
        }
    }
    if movements.len() < 2 {
        let reason = failed.first().map_or_else(String::new, |block| format!(": {}", block.reason));
        return Err(refused(
            format!("{} of {folds} blocks can be left out{reason}", movements.len()),
            "record longer, or with more motion in every part",
        ));
    }
    let shifts = sensors.iter().filter_map(|sensor| judged(calibration, *sensor, &movements)).collect();
    let source = MachineValidationSource::Blocks { folds, length_s, failed };
    Ok(MachineValidation { source, shifts, speed_ratio: 1.0 })
}

/// Checks that a recording can be divided into this number of blocks.
///
/// # Errors
/// [`Error::Experiment`](calibrant_core::Error::Experiment): fewer than two blocks, or blocks shorter than 1 s.
pub fn check_folds(problem: &MachineProblem<'_>, folds: usize) -> Result<()> {
    let ends = |of: &Recording| Some((*of.times_s().first()?, *of.times_s().last()?));
    let main = SensorKind::ALL.into_iter().rev().find_map(|kind| problem.recording.sensor(kind));
    let duration_s = main.and_then(ends).map_or(0.0, |(first, last)| last - first);
    let most = (duration_s / SHORTEST_S) as usize;
    if (2..=most).contains(&folds) {
        return Ok(());
    }
    let message = format!("{folds} folds cannot be made of a recording of {duration_s:.1} s");
    let help = match most {
        0 | 1 => format!("record longer: a block has {SHORTEST_S} s at least"),
        most => format!("choose between 2 and {most}: a block has {SHORTEST_S} s at least"),
    };
    Err(Error::experiment(InputError::new(Refusal::ValidationImpossible, message, help)))
}

/// How the quantities move without the samples from `start_s` to `end_s`.
fn without(
    problem: &MachineProblem<'_>,
    calibration: &MachineCalibration,
    settings: &MachineSettings,
    (start_s, end_s): (f64, f64),
) -> Result<Movement> {
    let kept = |kind: SensorKind| -> Option<Recording> {
        let whole = problem.recording.sensor(kind)?;
        Some(whole.only(|k| !(start_s..end_s).contains(&whole.times_s()[k])))
    };
    let recording = ImuRecording { sensors: PerSensor::from_fn(kept), temperature_c: None };
    let state = State { motion: calibration.motion.clone(), parameters: calibration.parameters.clone() };
    let model = model(problem, calibration, &recording, &state);
    undetermined::check(&model, &state)?;
    let minimum = minimise(&model, state, settings)?.ok_or_else(unsolved)?;
    if minimum.status != CalibrationStatus::Converged {
        return Err(refused("the iteration does not converge", "leave fewer blocks"));
    }
    let covariance = Scaled::new(&minimum.solved.information).ok_or_else(unsolved)?.inverse();
    let parameters = &minimum.state.parameters;
    let shift = (calibration.quantities.iter().zip(&calibration.values))
        .map(|(quantity, value)| parameters.value(*quantity, &calibration.nominal) - value);
    Ok(Movement {
        shift: DVector::from_iterator(calibration.values.len(), shift),
        covariance: widened(calibration, &(covariance - &calibration.linear_covariance)),
        without_s: Some(start_s),
    })
}

/// The problem with another part of the recording, weighed as in the calibration.
fn model<'a>(
    problem: &MachineProblem<'a>,
    calibration: &MachineCalibration,
    recording: &'a ImuRecording,
    state: &State,
) -> Model<'a> {
    let stream = |of: &crate::estimate::SensorResidual| {
        let recording = recording.sensor(of.sensor)?;
        Some(Stream { sensor: of.sensor, recording, sd: of.noise, growth: Vec::new() })
    };
    let sensors = calibration.sensors.sensor_kinds();
    let whole = sensors.last().and_then(|kind| problem.recording.sensor(*kind));
    let mut model = Model {
        streams: calibration.noise.iter().filter_map(stream).collect(),
        log: WeighedLog {
            log: problem.log,
            sd: calibration.reference_noise.iter().map(|of| of.sd).collect(),
            rounding_sd: Vec::new(),
            growth: Vec::new(),
        },
        layout: Layout::new(problem.setup, &sensors, problem.quantities, calibration.nominal.clone()),
        gravity: TiltedGravity::new(&problem.setup.up),
        trust: problem.setup.trust,
        middle_s: whole.map_or(0.0, middle_s),
        covered: calibration.covered.clone(),
    };
    let growths = Growths {
        streams: calibration.noise.iter().map(|of| of.growth).collect(),
        log: calibration.reference_noise.first().and_then(|of| of.growth),
    };
    let activity = Activity::along(&model, state);
    growths.apply(&mut model, state, &activity);
    model
}
