//! The calibration of an IMU, stage by stage (`tedaldi2014`).
//!
//! 1. Stationary intervals: the accelerometer's holds, and the gyroscope's means in them.
//! 2. Initial values: the accelerometer alone, the gyroscope's bias.
//! 3. Alignment of the two sensors, from the rotations between the holds.
//! 4. Least squares of all data, with the variance components as weights.
//! 5. Covariance, result and checks.

use crate::error::{Error, Result};
use crate::estimate::imu::alignment::stage::align_sensors;
use crate::estimate::imu::assembly::imu_calibration::Finished;
use crate::estimate::imu::checks::changing_gyroscope::Changing;
use crate::estimate::imu::checks::evidence::Evidence;
use crate::estimate::imu::checks::identifiability::{self, with_obstacles};
use crate::estimate::imu::checks::list::all_checks;
use crate::estimate::imu::checks::time_offset_by_activity::with_time_offset;
use crate::estimate::imu::checks::wrong_turns;
use crate::estimate::imu::clock::ClockDifference;
use crate::estimate::imu::covariance::ImuUncertainty;
use crate::estimate::imu::drift_errors::drift_errors;
use crate::estimate::imu::earth_rate::EarthRate;
use crate::estimate::imu::estimated::{estimated_quantities, prior_of};
use crate::estimate::imu::initial::accelerometer_alone::initial_accelerometer;
use crate::estimate::imu::initial::gyroscope::{explained_means, initial_values};
use crate::estimate::imu::model::{ImuModel, RotationScatter, State};
use crate::estimate::imu::problem::ImuProblem;
use crate::estimate::imu::recording_biases::{gyroscope_biases, recording_bias_errors};
use crate::estimate::imu::recordings::recordings;
use crate::estimate::imu::rotations::movement::Movement;
use crate::estimate::imu::shared_face_errors::shared_face_errors;
use crate::estimate::imu::stationary::gyroscope::StationaryGyroscope;
use crate::estimate::imu::thermometer_lag::LagEffect;
use crate::estimate::imu::variance_components::bias_drift::follow_drift;
use crate::estimate::imu::variance_components::solution::solve;
use crate::estimate::imu::white_noise_search::WhiteNoiseSearch;
use crate::estimate::recording_biases::Recordings;
use crate::estimate::result::Calibration;
use crate::estimate::settings::CalibrationSettings;
use crate::sensor::SensorKind;
use crate::solve::VarianceSource;
use nalgebra::DVector;

/// Calibrates an IMU. The search `white_noise` runs while the accelerometer is fitted.
pub(crate) fn solve_imu(
    problem: &ImuProblem<'_>,
    settings: &CalibrationSettings,
    white_noise: &WhiteNoiseSearch<'_>,
) -> Result<Calibration> {
    stages(problem, settings, white_noise).map_err(|error| with_time_offset(error, problem.recording))
}

fn stages(
    problem: &ImuProblem<'_>,
    settings: &CalibrationSettings,
    white_noise: &WhiteNoiseSearch<'_>,
) -> Result<Calibration> {
    let setup = problem.setup;
    let (as_read, gyroscope_recording) = recordings(problem)?;
    // stationary intervals and initial values
    let (first, white_noise) =
        rayon::join(|| initial_accelerometer(problem, as_read, settings), || white_noise.result());
    let (first, temperature) = first?;
    let recording = first.adjusted.as_ref().unwrap_or(as_read);
    let used = first.used_holds();
    let quantities = estimated_quantities(problem);
    let prior = prior_of(problem, &quantities);
    let unknowns = (quantities.as_slice(), prior.as_ref());
    let as_recorded = (gyroscope_recording, white_noise);
    let biases = gyroscope_biases(problem, (&first, &temperature), &used, as_recorded, unknowns)?;
    let steady = biases.as_ref().map(|biases| biases.taken_out_of(gyroscope_recording));
    let gyroscope_recording = steady.as_ref().unwrap_or(gyroscope_recording);
    let gyroscope = StationaryGyroscope::measure(problem, gyroscope_recording, &used.holds, white_noise)?;
    let mut means = explained_means(problem, (&first, &temperature), &used, &gyroscope, unknowns);
    means.by.recordings =
        biases.as_ref().map_or_else(Recordings::default, |biases| biases.recordings(&used.holds));
    let initial = initial_values(problem, (&first, &temperature), &used.numbers, &means);
    // rotations and turns between them
    let movement = Movement::of(problem, (recording, &first.sensor), gyroscope_recording, &used.holds);
    let explained = |error: Error| with_obstacles(error, &movement.obstacles());
    let mut model = ImuModel {
        gravity: setup.holds.gravity.magnitude_mps2,
        earth: EarthRate::of(setup, &quantities),
        rotations: movement.rotations(&initial.holds),
        turns: movement.turns(problem, &gyroscope.noise, (&initial.imu, &temperature))?,
        holds: initial.holds,
        gyroscope_noise: gyroscope.noise,
        rotation_scatter: RotationScatter::none(),
        turns_in_holds: movement.turns_in_holds,
        prior,
        quantities,
    };
    let on_faces = setup.directions.is_some();
    let turns = wrong_turns::check(problem.gyroscope, &initial.imu, &model.turns, &setup.turns, on_faces)?;
    // alignment of the two sensors
    let state = State { imu: initial.imu, forces: used.forces.clone() };
    let (state, axes) = align_sensors(problem, &model, state, &first.holds).map_err(explained)?;
    let start = state.imu;
    follow_drift(&mut model, &state, &initial.between);
    let linearised = model.linearised(&state, settings)?;
    identifiability::check(&model, &state, &linearised).map_err(explained)?;
    // least squares and variance components
    let solution = solve(&mut model, (state, linearised.residuals), &means, initial.between, settings)?;
    let mut systematic = Vec::new();
    let mut by = |source: VarianceSource, errors: Vec<DVector<f64>>| {
        systematic.extend(errors.into_iter().map(|error| (source, error)));
    };
    by(VarianceSource::BiasDrift, drift_errors(&model, &solution.fit, &first.holds)?);
    if let Some(tilt) = first.holds.tilt {
        let errors = shared_face_errors(&model, &solution.fit, tilt.shared_sd_rad)?;
        by(VarianceSource::FaceAlignment, errors);
    }
    let of_accelerometer = first.holds.recording_biases.as_deref();
    for (sensor_kind, biases) in SensorKind::ALL.into_iter().zip([of_accelerometer, biases.as_ref()]) {
        if let Some(biases) = biases {
            let errors = recording_bias_errors(&model, &solution.fit, &used.holds, (sensor_kind, biases))?;
            by(VarianceSource::OtherRecordings, errors);
        }
    }
    let where_from = (&temperature, used.holds.as_slice(), setup.turns.as_slice());
    let lag = LagEffect::of(&model, &solution.fit, where_from, &setup.thermometer, settings)?;
    by(VarianceSource::Thermometer, lag.iter().map(|lag| lag.error.clone()).collect());
    let uncertainty = ImuUncertainty::of(&model, &solution, setup.rate_sd, (&gyroscope.coarse, systematic))?;
    let recorded = problem.recording[SensorKind::Accelerometer].as_ref();
    let clock = recorded.and_then(|recorded| ClockDifference::of(&model, &solution.fit.state, recorded));
    let changes = Changing {
        model: &model,
        fit: &solution.fit,
        readings: &gyroscope.measured,
        between: solution.between,
        holds: &first.holds,
        numbers: &used.numbers,
    }
    .changes();
    let calibration = Finished {
        problem,
        accelerometer: &first,
        temperature: &temperature,
        numbers: &used.numbers,
        gyroscope: &gyroscope,
        movement: &movement,
        start: &start,
        biases: biases.as_ref(),
        model: &model,
        solution: &solution,
        uncertainty,
        clock,
        thermometer: lag.as_ref().map(|_| setup.thermometer),
        changes,
    }
    .assemble()?;
    let warnings = all_checks(&Evidence {
        problem,
        accelerometer: &first,
        accelerometer_recording: recording,
        used: &used,
        gyroscope: &gyroscope,
        temperature: &temperature,
        model: &model,
        fit: &solution.fit,
        axes: axes.as_ref(),
        turns,
        clock,
        lag: lag.as_ref(),
        calibration: &calibration,
    });
    Ok(Calibration { warnings, ..calibration })
}
