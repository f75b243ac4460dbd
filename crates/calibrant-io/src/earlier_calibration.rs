//! Reads `calibration.json` of an earlier calibration. It is the prior knowledge of a sensor for the next
//! design.

use super::json;
use super::text_decoding::{self, Checked};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::information::covariance;
use calibrant_core::sensor::{ParameterList, Quantity, ReadingUnit, SensorParameters};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Largest calibration file, bytes. The file holds the motion, but not the residuals.
const LARGEST: u64 = 1 << 30;

/// The parameters of an earlier calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct EarlierCalibration {
    /// The file, where it came from one.
    pub file: Option<PathBuf>,
    /// Name and unit of each parameter.
    pub parameters: Vec<(String, String)>,
    /// Estimates, in the order of the parameters.
    pub values: Vec<f64>,
    /// Their covariance, p × p; positive definite.
    pub covariance: DMatrix<f64>,
    /// Is the datasheet's prior in it already?
    pub has_datasheet_prior: bool,
    information: DMatrix<f64>,
}

/// Reads a `calibration.json` that [`write_calibration`](super::write_calibration) wrote.
///
/// # Errors
/// [`Error::Experiment`] with the file, and line and column where the JSON itself is broken. The file cannot
/// be read or is not JSON. It has another schema, or no calibration at all. A field is missing. The
/// calibration did not converge. A value or a covariance is not finite. The covariance has the wrong size, is
/// not symmetric or not positive definite.
pub fn read_calibration(path: &Path) -> Result<EarlierCalibration> {
    let bytes = text_decoding::read_bytes(path, LARGEST, "the calibration")
        .map_err(|input_error| Error::experiment(*input_error))?;
    match parse(&bytes) {
        Ok(calibration) => Ok(EarlierCalibration { file: Some(path.to_path_buf()), ..calibration }),
        Err(input_error) => Err(Error::experiment(input_error.in_file(path))),
    }
}

/// Reads the bytes of a `calibration.json`.
///
/// # Errors
/// As [`read_calibration`], without the name of the file.
///
/// # Examples
/// ```
/// use calibrant_io::parse_calibration;
/// let json = r#"{ "schema": 1, "status": "converged", "covariance": [[4e-4]],
///                 "parameters": [{ "name": "bias.x", "unit": "m/s²", "value": 0.1, "sd": 0.02 }] }"#;
/// let calibration = parse_calibration(json.as_bytes())?;
/// assert!((calibration.information()[(0, 0)] - 2500.0).abs() < 1e-9);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn parse_calibration(bytes: &[u8]) -> Result<EarlierCalibration> {
    parse(bytes).map_err(|input_error| Error::experiment(*input_error))
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
        let mut sensor = SensorParameters { bias: Vector3::zeros(), matrix: Matrix3::from_diagonal(&absent) };
        for (quantity, value) in list.quantities().iter().zip(&self.values) {
            quantity.add_to(&mut sensor, *value);
        }
        if sensor.matrix.try_inverse().is_none() {
            return reject(
                "its scale factors make a sensor that reports nothing: the matrix S is singular".into(),
                "calibrate again",
            );
        }
        Ok(sensor)
    }
}

/// The fields that are read. All are optional, so that the reader can name what is missing.
#[derive(Deserialize)]
struct File {
    schema: Option<serde_json::Value>,
    status: Option<String>,
    seed: Option<serde_json::Value>,
    parameters: Option<Vec<ParameterFields>>,
    covariance: Option<Vec<Vec<Option<f64>>>>,
    prior: Option<String>,
}

#[derive(Deserialize)]
struct ParameterFields {
    name: Option<String>,
    unit: Option<String>,
    value: Option<f64>,
}

pub(super) fn parse(bytes: &[u8]) -> Checked<EarlierCalibration> {
    /// The remedy for a broken file.
    const AGAIN: &str = "give a calibration.json that `calibrant calibrate` wrote";
    let reject =
        |message: String| Err(Box::new(InputError::new(Refusal::CalibrationInvalid, message, AGAIN)));
    let text = text_decoding::as_text(bytes)?;
    let file: File =
        serde_json::from_str(text).map_err(|error| json::broken(&error, "a calibration.json", AGAIN))?;
    match file.schema {
        Some(schema) if schema == 1 => (),
        Some(schema) => {
            return reject(format!("schema {schema} of calibration.json is not known to this version"));
        }
        None => return reject("this is no calibration: the field `schema` is missing".into()),
    }
    let missing = |field: &str| {
        InputError::new(Refusal::CalibrationInvalid, format!("the field `{field}` is missing"), AGAIN)
    };
    if file.status.is_none() && file.seed.is_some() {
        return reject("this is the truth of a simulation, not a calibration: it has no covariance".into());
    }
    let status = file.status.ok_or_else(|| missing("status"))?;
    let parameters = file.parameters.ok_or_else(|| missing("parameters"))?;
    let covariance_rows = file.covariance.ok_or_else(|| missing("covariance"))?;
    if status != "converged" {
        let message = format!("this calibration did not converge: its status is \"{status}\"");
        return Err(InputError::new(
            Refusal::CalibrationUnusable,
            message,
            "calibrate again; its report says what is wrong",
        )
        .into());
    }
    let (mut names, mut values) = (Vec::new(), Vec::new());
    for (i, parameter) in parameters.into_iter().enumerate() {
        let field = |field: &str| missing(&format!("parameters[{i}].{field}"));
        let name = parameter.name.ok_or_else(|| field("name"))?;
        let unit = parameter.unit.ok_or_else(|| field("unit"))?;
        let value = parameter.value.ok_or_else(|| field("value"))?;
        names.push((name, unit));
        values.push(value);
    }
    let size = values.len();
    if size == 0 {
        return reject("it has no parameters".into());
    }
    if covariance_rows.len() != size || covariance_rows.iter().any(|row| row.len() != size) {
        return reject(format!("the covariance is not {size} × {size}, one row for each parameter"));
    }
    let entry = |i: usize, j: usize| covariance_rows[i][j].unwrap_or(f64::NAN);
    let matrix = DMatrix::from_fn(size, size, entry);
    for i in 0..size {
        for j in 0..=i {
            let scale = (matrix[(i, i)] * matrix[(j, j)]).sqrt();
            if !matrix[(i, j)].is_finite() {
                return reject(format!("entry ({}, {}) of the covariance is not a number", i + 1, j + 1));
            }
            if (matrix[(i, j)] - matrix[(j, i)]).abs() > 1e-9 * scale {
                return reject(format!(
                    "the covariance is not symmetric: entries ({0}, {1}) and ({1}, {0}) differ",
                    i + 1,
                    j + 1
                ));
            }
        }
    }
    let Some(information) = covariance(&matrix) else {
        return reject("the covariance is not positive definite, so it is no covariance".into());
    };
    Ok(EarlierCalibration {
        file: None,
        parameters: names,
        values,
        covariance: matrix,
        has_datasheet_prior: file.prior.as_deref() == Some("datasheet"),
        information,
    })
}
