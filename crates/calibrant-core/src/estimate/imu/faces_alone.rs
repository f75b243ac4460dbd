//! The calibration of an accelerometer alone from holds of known directions: the part of an IMU's that needs no gyroscope.

use crate::diagnostic::{Diagnostic, samples};
use crate::error::Result;
use crate::estimate::at_rest::AtRest;
use crate::estimate::datasheet::{noise_not_as_given, prior};
use crate::estimate::hold_result::HoldCalibration;
use crate::estimate::holds::{beyond, magnitude_rms};
use crate::estimate::imu::initial::known_faces::from_faces;
use crate::estimate::imu::model::{HoldData, ImuModel, singular};
use crate::estimate::imu::shared_face_errors::shared_face_errors;
use crate::estimate::imu::terms::sums::degrees_of_freedom;
use crate::estimate::imu::terms::term::At;
use crate::estimate::problem::{CalibrationProblem, FacesProblem, Stimulus};
use crate::estimate::result::{Calibration, FitStatistics};
use crate::estimate::settings::CalibrationSettings;
use crate::information;
use crate::motion::Hold;
use crate::sensor::{Correction, PerSensor, SensorKind, SensorParameters};
use crate::solve::{CalibrationStatus, Uncertainty, VarianceSource};
use nalgebra::{Matrix3, Vector3};
use std::borrow::Cow;

/// Calibrates an accelerometer from holds of known directions: six faces, or the poses of an arm. Its matrix is that in the frame of the directions, a turn
/// of the sensor against them included.
///
/// # Errors
/// - [`Error::Experiment`](crate::Error::Experiment): the readings contradict the directions, or these are not one for each interval.
/// - [`Error::Recording`](crate::Error::Recording): the recording is unusable.
/// - [`Error::NotIdentifiable`](crate::Error::NotIdentifiable) names the parameters that the directions do not determine.
pub fn calibrate_faces(problem: &FacesProblem<'_>, settings: &CalibrationSettings) -> Result<Calibration> {
    let kind = SensorKind::Accelerometer;
    let (recording, spikes) = match problem.holds.found {
        Some(_) => (Cow::Borrowed(problem.recording), None),
        None => problem.recording.without_spikes(kind),
    };
    let problem = &FacesProblem { recording: &recording, ..*problem };
    let (sensor, stimulus) = (problem.sensor, Stimulus::Holds(problem.holds));
    CalibrationProblem { sensor, recording: &recording, stimulus }.validate()?;
    let mut calibration = solved(problem, settings)?;
    let found = spikes.map(|spikes| Diagnostic::from(samples::Spikes::of(&spikes, kind, recording.unit)));
    calibration.warnings.splice(0..0, found);
    calibration.warnings.extend(beyond(&recording, problem.holds.intervals_s.as_deref().unwrap_or_default()));
    let beyond_datasheet = calibration.beyond_datasheet();
    calibration.warnings.extend(beyond_datasheet);
    let noise = calibration.fit.noise_estimate.zip(calibration.fit.assumed_noise);
    calibration.warnings.extend(noise.and_then(|(found, given)| noise_not_as_given(kind, &found, &given)));
    Ok(calibration)
}

/// The least squares with the face alignment that the first fit found.
fn solved(problem: &FacesProblem<'_>, settings: &CalibrationSettings) -> Result<Calibration> {
    let list = problem.holds.parameter_list_on_faces(problem.sensor.model);
    let stated = problem.sensor.nominal().filter(|_| settings.datasheet_prior);
    let prior = stated.map(|nominal| prior(&list.describe_accelerometer(problem.sensor, &nominal)));
    let first = from_faces(problem, problem.recording, prior.as_ref())?;
    let gains = Matrix3::from_diagonal(&first.sensor.matrix.diagonal());
    let nominal = problem.sensor.nominal().unwrap_or(SensorParameters::linear(first.sensor.bias, gains));
    let parameters = list.describe_accelerometer(problem.sensor, &nominal);
    let (gravity, used) = (problem.holds.gravity.magnitude_mps2, first.used_holds());
    let scatter = first.alignment.map_or_else(Default::default, |alignment| alignment.widened);
    let (means, forces) = first.repeats.means(&used.holds, &used.forces);
    let on_face = |(mean, force): (&Hold, &Vector3<f64>)| {
        let weight = first.weight_by(mean, force, &first.repeats.of_face(&scatter, force));
        HoldData::on_face(mean.mean, weight, *force)
    };
    let holds = means.iter().zip(&forces).map(on_face).collect();
    let model = ImuModel::of_accelerometer(list.of_accelerometer(), gravity, holds, prior);
    let sensor = model.sensor_on_faces().ok_or_else(singular)?;
    let fit = model.linearised_on_faces(&sensor).ok_or_else(singular)?;
    let covariance = information::covariance(&fit.information).ok_or_else(singular)?;
    let weight = model.prior.as_ref().map(|(_, weight)| weight.as_slice());
    let mut uncertainty = Uncertainty::of(covariance, weight);
    let shared_rad = first.alignment.map_or(0.0, |alignment| alignment.tilt.shared_sd_rad);
    for error in shared_face_errors(&model, &fit, shared_rad)? {
        uncertainty.add(VarianceSource::FaceAlignment, &error, 1.0);
    }
    let squares: Vector3<f64> =
        model.holds.iter().zip(&forces).fold(Vector3::zeros(), |sum, (hold, force)| {
            let residual = hold.accelerometer - sensor.reading(force);
            sum + residual.component_mul(&residual) / model.holds.len() as f64
        });
    let at = At { model: &model, state: &fit.state, rotations: &[] };
    let at_rest = AtRest {
        quantities: list.of_accelerometer(),
        parameters,
        units: PerSensor::only(SensorKind::Accelerometer, problem.sensor.unit),
        imu: fit.state.imu,
        uncertainty,
        fit: FitStatistics {
            residual_rms: Some(squares.map(f64::sqrt)),
            assumed_noise: problem.sensor.noise(&sensor.matrix.diagonal()),
            noise_estimate: Some(first.within),
            ..FitStatistics::of_chi2(fit.chi2, degrees_of_freedom(&at))
        },
        status: CalibrationStatus::Converged,
        iterations: 1,
        gradient_norm: 0.0,
        holds: corrected(first.holds, &sensor)?,
    };
    let calibration = at_rest.calibration();
    Ok(Calibration { warnings: first.warnings, datasheet_prior: settings.datasheet_prior, ..calibration })
}

/// The holds, with the gravity residuals by this sensor.
fn corrected(mut holds: HoldCalibration, sensor: &SensorParameters) -> Result<HoldCalibration> {
    let correction = Correction::of(sensor).ok_or_else(singular)?;
    for result in &mut holds.holds {
        result.magnitude_residual_mps2 =
            correction.apply(&result.hold.mean).norm() - holds.gravity.magnitude_mps2;
    }
    holds.magnitude_residual_rms_mps2 = magnitude_rms(&holds.holds);
    Ok(holds)
}
