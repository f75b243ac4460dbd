//! Reads the accelerometer of an earlier `calibration.json`. It is the prior knowledge of a sensor for the
//! next design.

use crate::convention::read_estimates;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::information::covariance;
use calibrant_core::sensor::{
    ImuQuantity, ParameterList, Quantity, ReadingUnit, SensorKind, SensorParameters,
};
use calibrant_recording::text::decoding::{self, Checked, refuse};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Largest calibration file, bytes. The file holds the motion, but not the residuals.
const LARGEST: u64 = 1 << 30;

/// The beginning of the names of an accelerometer's parameters.
const ACCELEROMETER: &str = "accelerometer.";

/// The parameters of an earlier calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct EarlierCalibration {
    /// The file, where it came from one.
    pub file: Option<PathBuf>,
    /// Name and unit of each parameter of the accelerometer: `bias.x`.
    pub parameters: Vec<(String, String)>,
    /// Estimates, in the order of the parameters.
    pub values: Vec<f64>,
    /// Their covariance, p × p; positive definite.
    pub covariance: DMatrix<f64>,
    /// Is the datasheet's prior in it already?
    pub has_datasheet_prior: bool,
    /// Scatter between its holds that the noise does not explain, m/s², where it had holds.
    pub between_holds_sd_mps2: Option<f64>,
    /// Standard deviation of one sample's noise on each axis, pooled over its holds, in the unit of its readings, where it had holds.
    pub noise: Option<Vector3<f64>>,
    information: DMatrix<f64>,
}

/// The part of calibration.json that describes the holds.
#[derive(Deserialize, Default)]
struct WithHolds {
    #[serde(default)]
    holds: Holds,
}

#[derive(Deserialize, Default)]
struct Holds {
    #[serde(default)]
    between_holds_sd_mps2: Option<f64>,
    #[serde(default)]
    table: Vec<Hold>,
}

#[derive(Deserialize)]
struct Hold {
    samples: f64,
    #[serde(alias = "sd_mps2")]
    sd_counts: [f64; 3],
    used: bool,
}

impl Holds {
    /// The noise within the used holds.
    fn noise(&self) -> Option<Vector3<f64>> {
        let used = || self.table.iter().filter(|hold| hold.used);
        let samples: f64 = used().map(|hold| hold.samples).sum();
        let of_axis =
            |axis: usize| used().map(|hold| hold.samples * hold.sd_counts[axis].powi(2)).sum::<f64>();
        let noise = Vector3::from_fn(|axis, _| (of_axis(axis) / samples).sqrt());
        noise.iter().all(|sd| sd.is_finite() && *sd > 0.0).then_some(noise)
    }
}

/// Reads a `calibration.json` with a [`CalibrationFile`](crate::CalibrationFile).
///
/// # Errors
/// [`Error::Experiment`] with the file, as [`read_calibrated_imu`](crate::read_calibrated_imu). Also where it
/// has no accelerometer, no covariance, or one that is not positive definite.
pub fn read_calibration(path: &Path) -> Result<EarlierCalibration> {
    let calibration = decoding::parsed(path, (LARGEST, "the calibration"), parse)?;
    Ok(EarlierCalibration { file: Some(path.to_path_buf()), ..calibration })
}

/// Reads the bytes of a `calibration.json`.
///
/// # Errors
/// As [`read_calibration`], without the name of the file.
///
/// # Examples
/// ```
/// use calibrant_io::parse_calibration;
/// let json = r#"{ "schema": 2, "status": "converged", "direction": "true to raw", "frame": "its own",
///                 "accelerometer": { "reading_unit": "m/s²", "bias_mps2": [0.1], "matrix": [[1.0]] },
///                 "covariance": [[4e-4]],
///                 "parameters": [{ "name": "accelerometer.bias.x", "unit": "m/s²", "value": 0.1, "sd": 0.02 }] }"#;
/// let calibration = parse_calibration(json.as_bytes())?;
/// assert!((calibration.information()[(0, 0)] - 2500.0).abs() < 1e-9);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn parse_calibration(bytes: &[u8]) -> Result<EarlierCalibration> {
    parse(bytes).map_err(Error::Experiment)
}

impl EarlierCalibration {
    /// Its information: the inverse of the covariance.
    #[must_use]
    pub fn information(&self) -> &DMatrix<f64> {
        &self.information
    }

    /// The squared distance of its estimates from those of another calibration, in units of their joint
    /// covariance. If both are of one sensor, it is χ² with one degree of freedom for each parameter. `None`
    /// where the parameters are not the same.
    #[must_use]
    pub fn chi2_against(&self, other: &Self) -> Option<f64> {
        if self.parameters != other.parameters {
            return None;
        }
        let between: Vec<f64> = self.values.iter().zip(&other.values).map(|(a, b)| a - b).collect();
        let between = DVector::from_vec(between);
        let information = covariance(&(&self.covariance + &other.covariance))?;
        Some(between.dot(&(information * &between)))
    }

    /// The sensor of the calibration, whose parameters must be those of `list`.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the parameters or their units are not the same.
    pub fn sensor_of(&self, list: &ParameterList, unit: ReadingUnit) -> Result<SensorParameters> {
        let reject = |message: String, help: &str| {
            let input_error = InputError::new(Refusal::CalibrationUnsuited, message, help);
            Err(Error::experiment(match &self.file {
                Some(file) => input_error.in_file(file),
                None => input_error,
            }))
        };
        let (names, found): (Vec<_>, Vec<_>) =
            (list.names(), self.parameters.iter().map(|(name, _)| name.clone()).collect());
        if names != found {
            let of = |names: &[String]| names.join(", ");
            return reject(
                format!(
                    "this calibration is of another sensor model: its parameters are {}, those of the experiment {}",
                    of(&found),
                    of(&names)
                ),
                "use the calibration of a [motion] experiment with the same axes and model",
            );
        }
        for (quantity, (name, found)) in list.quantities().iter().zip(&self.parameters) {
            let needed = quantity.unit(unit);
            if found != needed {
                return reject(
                    format!("{name} is in {found} here, in the experiment in {needed}"),
                    "use the calibration of a sensor whose readings have the same unit",
                );
            }
        }
        // axes that the sensor does not have count as perfect
        let axes = list.quantities().iter().filter(|quantity| matches!(quantity, Quantity::Bias(_))).count();
        let absent = Vector3::from_fn(|k, _| if k < axes { 0.0 } else { 1.0 });
        let mut sensor = SensorParameters {
            bias: Vector3::zeros(),
            matrix: Matrix3::from_diagonal(&absent),
            ..SensorParameters::identity()
        };
        for (quantity, value) in list.quantities().iter().zip(&self.values) {
            quantity.add_to(&mut sensor, *value);
        }
        Ok(sensor)
    }
}

fn parse(bytes: &[u8]) -> Checked<EarlierCalibration> {
    /// The remedy for a file that is no prior.
    const AGAIN: &str = "give a calibration.json that `calibrant calibrate` wrote";
    let reject = |message: &str| refuse(Refusal::CalibrationInvalid, message, AGAIN);
    let text = decoding::as_text(bytes)?;
    let (imu, has_datasheet_prior) = read_estimates(text)?;
    let WithHolds { holds } = serde_json::from_str(text).unwrap_or_default();
    let imu = imu.only(SensorKind::Accelerometer);
    let Some(unit) = imu.unit(SensorKind::Accelerometer).filter(|_| !imu.quantities.is_empty()) else {
        return reject("it has no parameters of an accelerometer");
    };
    let Some(matrix) = imu.covariance else { return reject("the field `covariance` is missing") };
    let Some(information) = covariance(&matrix) else {
        return reject("the covariance is not positive definite, so it is no covariance");
    };
    let described = |quantity: &ImuQuantity| {
        let name = quantity.name().trim_start_matches(ACCELEROMETER).to_owned();
        (name, quantity.unit(unit).to_owned())
    };
    Ok(EarlierCalibration {
        file: None,
        parameters: imu.quantities.iter().map(described).collect(),
        values: imu.quantities.iter().map(|quantity| quantity.value(&imu.parameters)).collect(),
        covariance: matrix,
        has_datasheet_prior,
        noise: holds.noise(),
        between_holds_sd_mps2: holds.between_holds_sd_mps2.filter(|sd| sd.is_finite() && *sd >= 0.0),
        information,
    })
}
