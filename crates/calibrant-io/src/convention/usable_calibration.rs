//! The check that every calibration must pass to be usable, whatever its format.

use super::words::{input_error, invalid};
use calibrant_core::error::Refusal;
use calibrant_core::sensor::{CalibratedImu, ImuCorrection, SensorKind};
use calibrant_recording::text::decoding::Checked;
use nalgebra::{DMatrix, Matrix3};

/// Largest number that counts as plausible.
const LARGEST: f64 = 1e12;

/// Can the correction be computed? Everything is finite, the matrices are regular, and the covariance is
/// valid.
pub(super) fn usable(imu: &CalibratedImu) -> Checked<()> {
    if imu.unit(SensorKind::Accelerometer).is_none() && imu.unit(SensorKind::Gyroscope).is_none() {
        return Err(invalid("there is neither an accelerometer nor a gyroscope in it", "give a calibration"));
    }
    for sensor_kind in SensorKind::ALL {
        if imu.unit(sensor_kind).is_none() {
            continue;
        }
        let sensor = imu.parameters.sensor(sensor_kind);
        let believable = |value: &f64| value.is_finite() && value.abs() <= LARGEST;
        if !sensor.bias.iter().chain(sensor.matrix.iter()).all(believable) {
            return Err(invalid(
                format!("a number of the {sensor_kind} is not finite or beyond 1e12"),
                "calibrate again",
            ));
        }
        if !imu.parameters.g_sensitivity.iter().all(believable) {
            return Err(invalid(
                "a number of the g-sensitivity is not finite or beyond 1e12",
                "calibrate again",
            ));
        }
        let regular = sensor.matrix.try_inverse().is_some_and(|inverse| {
            inverse.iter().all(believable) && (sensor.matrix * inverse - Matrix3::identity()).amax() < 1e-6
        });
        if !regular {
            return Err(input_error(
                Refusal::CalibrationUnusable,
                format!("the matrix of the {sensor_kind} is singular: it reports nothing in some direction"),
                "calibrate again",
            ));
        }
    }
    temperature(imu)?;
    ImuCorrection::of(imu).map_err(|error| invalid(error.to_string(), ""))?;
    plausible_covariance(imu)
}

/// Is the covariance one of its quantities, where there is one?
pub(super) fn plausible_covariance(imu: &CalibratedImu) -> Checked<()> {
    imu.covariance.as_ref().map_or(Ok(()), |covariance| covariance_of(covariance, imu.quantities.len()))
}

/// Are the temperature terms finite, and the gains positive over their range?
fn temperature(imu: &CalibratedImu) -> Checked<()> {
    let thermal = &imu.parameters.thermal;
    let [low, high] = thermal.range_c.unwrap_or([thermal.reference_c; 2]);
    let possible = |t: f64| (-273.15..=1000.0).contains(&t);
    if !(possible(thermal.reference_c) && possible(low) && possible(high) && low <= high) {
        return Err(invalid(
            "a temperature is not between -273.15 and 1000 °C, or the range of temperatures is none",
            "reference_c and range_c are in °C, the range from the least to the greatest",
        ));
    }
    for sensor_kind in SensorKind::ALL {
        let terms = thermal.sensor(sensor_kind);
        let all = terms.bias.iter().chain(&terms.scale).flat_map(|vector| vector.iter());
        if !all.into_iter().all(|value| value.is_finite() && value.abs() <= LARGEST) {
            return Err(invalid(
                format!("a temperature term of the {sensor_kind} is not finite or beyond 1e12"),
                "calibrate again",
            ));
        }
        if [low, high].iter().any(|t| terms.gain_factor(thermal.tau_k(*t)).min() <= 0.0) {
            return Err(invalid(
                format!(
                    "the polynomial of the {sensor_kind}'s gain is not positive in the range of temperatures"
                ),
                "calibrate again",
            ));
        }
    }
    Ok(())
}

/// Is a matrix the covariance of this number of quantities: square, finite, symmetric, no negative variance
/// in any direction?
fn covariance_of(covariance: &DMatrix<f64>, size: usize) -> Checked<()> {
    let reject = |message: String| Err(invalid(message, "calibrate again, or remove the covariance"));
    if covariance.shape() != (size, size) {
        return reject(format!("the covariance is not {size} × {size}, one row for each parameter"));
    }
    for i in 0..size {
        for j in 0..=i {
            let (one, other) = (covariance[(i, j)], covariance[(j, i)]);
            if !(one.is_finite() && other.is_finite()) {
                return reject(format!("entry ({}, {}) of the covariance is not a number", i + 1, j + 1));
            }
            let scale = (covariance[(i, i)] * covariance[(j, j)]).abs().sqrt();
            if (one - other).abs() > 1e-9 * scale {
                return reject(format!(
                    "the covariance is not symmetric: entries ({0}, {1}) and ({1}, {0}) differ",
                    i + 1,
                    j + 1
                ));
            }
        }
    }
    let sd = covariance.diagonal().map(|variance| if variance > 0.0 { variance.sqrt() } else { f64::NAN });
    let at = |i: usize, j: usize| {
        let entry = covariance[(i, j)] / sd[i] / sd[j];
        if covariance[(i, j)] == 0.0 { 0.0 } else { entry }
    };
    let correlation = DMatrix::from_fn(size, size, at);
    let is_one = covariance.diagonal().iter().all(|&variance| variance >= 0.0)
        && correlation.iter().all(|entry| entry.is_finite() && entry.abs() <= 1.0 + 1e-9)
        && (size == 0 || correlation.symmetric_eigenvalues().min() > -1e-9 * size as f64);
    if is_one {
        Ok(())
    } else {
        reject("the covariance is not positive definite, so it is no covariance".into())
    }
}
