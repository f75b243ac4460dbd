//! The calibration of an accelerometer alone from holds of known directions: the part of an IMU's that needs no gyroscope.

use crate::diagnostic::{Diagnostic, samples};
use crate::error::Result;
use crate::estimate::budget::BudgetRow;
use crate::estimate::datasheet::noise_not_as_given;
use crate::estimate::gravity_error::gravity_slope;
use crate::estimate::hold_result::HoldCalibration;
use crate::estimate::holds::{beyond, magnitude_rms};
use crate::estimate::imu::initial::accelerometer::InitialAccelerometer;
use crate::estimate::imu::initial::known_faces::{about, from_faces};
use crate::estimate::imu::model::singular;
use crate::estimate::imu::shared_face_errors::SharedError;
use crate::estimate::problem::{CalibrationProblem, FacesProblem, Stimulus};
use crate::estimate::result::{Calibration, FitStatistics, Recovered};
use crate::estimate::settings::CalibrationSettings;
use crate::information;
use crate::sensor::{Correction, ImuParameters, Parameter, PerSensor, SensorKind, SensorParameters};
use crate::solve::{CalibrationStatus, Uncertainty, VarianceSource, shares_of_prior};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
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
    let mut calibration = solved(problem, from_faces(problem, &recording)?, settings)?;
    let found = spikes.map(|spikes| Diagnostic::from(samples::Spikes::of(&spikes, kind, recording.unit)));
    calibration.warnings.splice(0..0, found);
    calibration.warnings.extend(beyond(&recording, problem.holds.intervals_s.as_deref().unwrap_or_default()));
    let beyond_datasheet = calibration.beyond_datasheet();
    calibration.warnings.extend(beyond_datasheet);
    let noise = calibration.fit.noise_estimate.zip(calibration.fit.assumed_noise);
    calibration.warnings.extend(noise.and_then(|(found, given)| noise_not_as_given(kind, &found, &given)));
    Ok(calibration)
}

/// The least squares with the face alignment that the first fit found. With known directions it is linear.
fn solved(
    problem: &FacesProblem<'_>,
    first: InitialAccelerometer,
    settings: &CalibrationSettings,
) -> Result<Calibration> {
    let list = problem.holds.parameter_list_on_faces(problem.sensor.model);
    let gains = Matrix3::from_diagonal(&first.sensor.matrix.diagonal());
    let nominal = problem.sensor.nominal().unwrap_or(SensorParameters::linear(first.sensor.bias, gains));
    let parameters = list.describe_accelerometer(problem.sensor, &nominal);
    let prior = prior(&parameters, settings.datasheet_prior);
    let mut information = DMatrix::from_diagonal(&prior.weight);
    let mut gradient = prior.weight.component_mul(&prior.mean);
    let used = first.used_holds();
    let scatter = first.alignment.map_or_else(Default::default, |alignment| alignment.widened);
    let weights: Vec<Matrix3<f64>> = used
        .holds
        .iter()
        .zip(&used.forces)
        .map(|(hold, force)| first.weight_on_face(hold, force, &scatter))
        .collect();
    for ((hold, force), weight) in used.holds.iter().zip(&used.forces).zip(&weights) {
        let columns: Vec<Vector3<f64>> =
            list.quantities().iter().map(|of| of.derivative(&first.sensor, force)).collect();
        let weighted = DMatrix::from_fn(list.len(), 3, |k, i| columns[k].dot(&weight.column(i)));
        information += &weighted * DMatrix::from_fn(3, list.len(), |i, k| columns[k][i]);
        gradient += weighted * about(&first.sensor, &hold.mean, force);
    }
    let of_noise = information::covariance(&information).ok_or_else(singular)?;
    let values = &of_noise * gradient;
    let sensor = list.sensor(&values);
    let imu = ImuParameters::identity().with(SensorKind::Accelerometer, sensor);
    let shared_rad = first.alignment.map_or(0.0, |alignment| alignment.tilt.shared_sd_rad);
    let weight = settings.datasheet_prior.then(|| prior.weight.as_slice());
    let mut uncertainty = Uncertainty::of(of_noise.clone(), weight);
    for error in SharedError::all(shared_rad) {
        let mut by = DVector::zeros(list.len());
        for (force, weight) in used.forces.iter().zip(&weights) {
            let weighted = weight * (sensor.by_stimulus(force) * error.of(force));
            for (sum, quantity) in by.iter_mut().zip(list.quantities()) {
                *sum += quantity.derivative(&sensor, force).dot(&weighted);
            }
        }
        uncertainty.add(VarianceSource::FaceAlignment, &(&of_noise * by), 1.0);
    }
    let quantities = list.of_accelerometer();
    let told = weight.map(|weight| (weight, &of_noise));
    let prior_share = told.map_or_else(Vec::new, |(weight, sigma)| shares_of_prior(weight, sigma));
    let slope = gravity_slope(&quantities, &imu, &problem.holds.gravity, told);
    uncertainty.add(VarianceSource::Gravity, &slope, problem.holds.gravity.sd_mps2.powi(2));
    let off = &values - &prior.mean;
    let (mut chi2, mut squares) = (off.component_mul(&off).dot(&prior.weight), Vector3::zeros());
    for ((hold, force), weight) in used.holds.iter().zip(&used.forces).zip(&weights) {
        let residual = hold.mean - sensor.reading(force);
        chi2 += residual.dot(&(weight * residual));
        squares += residual.component_mul(&residual) / used.holds.len() as f64;
    }
    let equations = 3 * used.holds.len() + prior.count();
    Ok(Calibration {
        status: CalibrationStatus::Converged,
        iterations: 1,
        gradient_norm: 0.0,
        values: values.iter().copied().collect(),
        budget: BudgetRow::all(&uncertainty, &quantities),
        quantities,
        parameters,
        covariance: uncertainty.covariance,
        prior_share,
        gravity_slope: slope.iter().copied().collect(),
        datasheet_prior: settings.datasheet_prior,
        imu,
        units: PerSensor::only(SensorKind::Accelerometer, problem.sensor.unit),
        fit: FitStatistics {
            residual_rms: Some(squares.map(f64::sqrt)),
            assumed_noise: problem.sensor.noise(&sensor.matrix.diagonal()),
            noise_estimate: Some(first.within),
            ..FitStatistics::of_chi2(chi2, equations.saturating_sub(list.len()))
        },
        recovered: Recovered::Holds(corrected(first.holds, &sensor)?),
        gyroscope: None,
        changes: Vec::new(),
        warnings: first.warnings,
    })
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

/// What the datasheet says of the parameters: mean and inverse variance, 0 where it says nothing.
struct Prior {
    mean: DVector<f64>,
    weight: DVector<f64>,
}

fn prior(parameters: &[Parameter], counts: bool) -> Prior {
    let of = |parameter: &Parameter| Some((parameter.nominal?, parameter.spread?.powi(-2)));
    let (mean, weight): (Vec<f64>, Vec<f64>) =
        parameters.iter().map(|parameter| of(parameter).filter(|_| counts).unwrap_or_default()).unzip();
    Prior { mean: mean.into(), weight: weight.into() }
}

impl Prior {
    fn count(&self) -> usize {
        self.weight.iter().filter(|weight| **weight > 0.0).count()
    }
}
