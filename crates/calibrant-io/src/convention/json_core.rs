//! Reads the core of our JSON files: the fields that describe a calibrated IMU. They are direction, frame, gauge,
//! the unit of each sensor, the named quantities with their covariance, and the recordings.
//!
//! Numbers carry their unit in the field's name. Values stand twice. The sensors' matrices are complete. The
//! list of parameters has the quantities of the covariance. The reader refuses a file where they contradict
//! each other.

use super::arrays::{Rows, matrix3, missing, vector3};
use super::degrees_of_freedom::DegreesCore;
use super::temperature::TemperatureCore;
use super::words::{invalid, unit_named};
use crate::results::input::Input;
use calibrant_core::estimate::shared_gravity;
use calibrant_core::form::block;
use calibrant_core::motion::Gravity;
use calibrant_core::sensor::{
    CalibratedImu, Correction, Gauge, ImuParameters, ImuQuantity, NonlinearTerm, PerSensor, Quantity,
    ReadingUnit, SensorKind, SensorParameters, SharedErrors, correction_name,
};
use calibrant_recording::text::decoding::Checked;
use nalgebra::{DMatrix, Matrix3};
use serde::Deserialize;
use std::collections::HashMap;

/// A standard deviation and the root of its variance differ by rounding to the digits that people keep.
const AS_WRITTEN: f64 = 1e-5;

/// The fields of a calibrated IMU in a file. All are optional, so that the reader can name what is missing.
#[derive(Debug, Deserialize)]
pub struct ImuCore {
    direction: Option<String>,
    frame: Option<String>,
    gauge: Option<String>,
    accelerometer: Option<SensorCore>,
    gyroscope: Option<SensorCore>,
    temperature: Option<TemperatureCore>,
    parameters: Option<Vec<ParameterCore>>,
    covariance: Option<Vec<Vec<Option<f64>>>>,
    covariance_degrees_of_freedom: Option<DegreesCore>,
    shared_errors: Option<SharedCore>,
    /// Earlier versions wrote no shared errors: their gravity stands here.
    holds: Option<HoldsCore>,
    inputs: Option<Vec<Input>>,
}

#[derive(Debug, Deserialize)]
struct SharedCore {
    sources: Vec<String>,
    root: Rows,
}

#[derive(Debug, Deserialize)]
struct HoldsCore {
    gravity_mps2: Option<f64>,
    gravity_sd_mps2: Option<f64>,
}

/// One sensor. Each quantity has the field in its unit.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct SensorCore {
    reading_unit: String,
    counts_per_mps2: Option<f64>,
    counts_per_radps: Option<f64>,
    bias_mps2: Option<Vec<f64>>,
    bias_radps: Option<Vec<f64>>,
    bias_counts: Option<Vec<f64>>,
    matrix: Option<Rows>,
    matrix_counts_per_mps2: Option<Rows>,
    matrix_counts_per_radps: Option<Rows>,
    g_sensitivity_radps_per_mps2: Option<Rows>,
    g_sensitivity_counts_per_mps2: Option<Rows>,
    /// The coefficients by their keys, and the formula.
    nonlinearity: Option<HashMap<String, serde_json::Value>>,
    correction: Option<CorrectionCore>,
}

/// Raw → true, for readers of the file; our reader checks that it is the inverse.
#[derive(Debug, PartialEq, Deserialize)]
struct CorrectionCore {
    matrix: Option<Rows>,
    matrix_mps2_per_count: Option<Rows>,
    matrix_radps_per_count: Option<Rows>,
}

#[derive(Debug, Deserialize)]
struct ParameterCore {
    name: Option<String>,
    unit: Option<String>,
    value: Option<f64>,
    sd: Option<f64>,
    prior_share: Option<f64>,
}

impl ImuCore {
    /// Is the accelerometer one of a single axis?
    pub(super) fn has_one_axis(&self) -> bool {
        let is_one = |bias: &Option<Vec<f64>>| bias.as_ref().is_some_and(|bias| bias.len() == 1);
        self.accelerometer
            .as_ref()
            .is_some_and(|fields| is_one(&fields.bias_mps2) || is_one(&fields.bias_counts))
    }

    /// The IMU that the fields describe, and its recordings.
    ///
    /// # Errors
    /// A field is missing, or contradicts another.
    pub fn into_imu(self) -> Checked<(CalibratedImu, Vec<Input>)> {
        let missing = |field: &str| missing(field);
        check_direction("direction", &self.direction.ok_or_else(|| missing("direction"))?)?;
        let mut parameters = ImuParameters::identity();
        let mut units = [None, None];
        let mut counts_per_unit = PerSensor::default();
        for (sensor_kind, fields) in
            [(SensorKind::Accelerometer, self.accelerometer), (SensorKind::Gyroscope, self.gyroscope)]
        {
            let Some(fields) = fields else { continue };
            counts_per_unit[sensor_kind] = fields.sensitivity(sensor_kind)?;
            let (unit, sensor, g_sensitivity) = fields.into_sensor(sensor_kind)?;
            match sensor_kind {
                SensorKind::Accelerometer => {
                    (units[0], parameters[SensorKind::Accelerometer]) = (Some(unit), sensor)
                }
                SensorKind::Gyroscope => {
                    (units[1], parameters[SensorKind::Gyroscope]) = (Some(unit), sensor);
                    parameters.g_sensitivity = g_sensitivity;
                }
            }
        }
        if let Some(temperature) = self.temperature {
            parameters.thermal = temperature.into_thermal(units)?;
        }
        let mut imu =
            CalibratedImu::new(parameters, units, vec![], self.frame.ok_or_else(|| missing("frame"))?);
        imu.counts_per_unit = counts_per_unit;
        let listed = self.parameters.ok_or_else(|| missing("parameters"))?;
        let names: Vec<_> = listed.iter().filter_map(|parameter| parameter.name.clone()).collect();
        let symmetric = self.gauge.as_deref() == Some(Gauge::Symmetric.name());
        let stated_sd: Vec<Option<f64>> = listed.iter().map(|parameter| parameter.sd).collect();
        let prior_share: Vec<f64> =
            listed.iter().map(|parameter| parameter.prior_share.unwrap_or_default()).collect();
        for (i, parameter) in listed.into_iter().enumerate() {
            let quantity = parameter.into_quantity(i, &imu, symmetric.then_some(&names))?;
            if imu.quantities.contains(&quantity) {
                return Err(invalid(
                    format!("{} stands twice in `parameters`", quantity.name()),
                    "remove one",
                ));
            }
            imu.quantities.push(quantity);
        }
        imu.covariance =
            self.covariance.map(|rows| covariance_of(&rows, imu.quantities.len())).transpose()?;
        check_sd(&imu, &stated_sd)?;
        imu.degrees_of_freedom =
            self.covariance_degrees_of_freedom.map(DegreesCore::into_degrees).transpose()?;
        imu.shared = match (self.shared_errors, self.holds) {
            (Some(shared), _) => Some(shared.into_errors(&imu)?),
            (None, Some(holds)) => holds.shared_errors(&imu, &prior_share),
            (None, None) => None,
        };
        if let Some(gauge) = self.gauge {
            let matrix = imu.parameters.sensor(imu.reference()).matrix;
            if !Gauge::ALL.into_iter().any(|known| known.name() == gauge && known.is_form_of(&matrix)) {
                return Err(invalid(
                    format!(
                        "`gauge` is \"{gauge}\", but the matrix of the {} has not this form",
                        imu.reference()
                    ),
                    "correct the one or the other",
                ));
            }
        }
        Ok((imu, self.inputs.unwrap_or_default()))
    }
}

impl SharedCore {
    /// The shared errors of this IMU: they are a part of its covariance.
    fn into_errors(self, imu: &CalibratedImu) -> Checked<SharedErrors> {
        let (size, sources) = (imu.quantities.len(), self.sources.len());
        let reject = |message: String| invalid(message, "calibrate again, or remove `shared_errors`");
        if self.root.len() != size || self.root.iter().any(|row| row.len() != sources) {
            return Err(reject(format!(
                "`shared_errors.root` is not {size} × {sources}, one row for each parameter"
            )));
        }
        let root = DMatrix::from_fn(size, sources, |i, j| self.root[i][j]);
        let variance = |i: usize| imu.covariance.as_ref().map_or(0.0, |sigma| sigma[(i, i)]);
        let too_large = |i: &usize| root.row(*i).norm_squared() > variance(*i) * (1.0 + AS_WRITTEN);
        if let Some(i) = (0..size).find(too_large) {
            let name = imu.quantities[i].name();
            return Err(reject(format!("`shared_errors.root` has more of {name} than its variance")));
        }
        Ok(SharedErrors { sources: self.sources, root })
    }
}

impl HoldsCore {
    /// The error of gravity, where it fits into the covariance.
    fn shared_errors(&self, imu: &CalibratedImu, prior_share: &[f64]) -> Option<SharedErrors> {
        let (magnitude_mps2, sd_mps2) = (self.gravity_mps2?, self.gravity_sd_mps2?);
        let gravity =
            Some(Gravity { magnitude_mps2, sd_mps2 }).filter(|_| magnitude_mps2 > 0.0 && sd_mps2 > 0.0)?;
        let shared = shared_gravity(&imu.quantities, prior_share, &imu.parameters, &gravity)?;
        let sigma = imu.covariance.as_ref()?;
        let fits = |i: usize| shared.root.row(i).norm_squared() <= sigma[(i, i)] * (1.0 + AS_WRITTEN);
        (0..imu.quantities.len()).all(fits).then_some(shared)
    }
}

/// Is each stated standard deviation the root of its variance? Numbers that were exchanged, or scaled, are not.
fn check_sd(imu: &CalibratedImu, stated: &[Option<f64>]) -> Checked<()> {
    for (i, (quantity, sd)) in imu.quantities.iter().zip(stated).enumerate() {
        let Some(sd) = *sd else { continue };
        let name = quantity.name();
        if sd < 0.0 {
            return Err(invalid(format!("the sd of {name} is negative"), "correct it"));
        }
        // a variance that is none is refused with the covariance
        let variance = imu.covariance.as_ref().map(|sigma| sigma[(i, i)]);
        let Some(variance) = variance.filter(|variance| *variance > 0.0) else { continue };
        let root = variance.sqrt();
        if (sd - root).abs() > AS_WRITTEN * root {
            let message = format!(
                "the sd of {name} is {sd} in `parameters`, and its variance in `covariance` gives {root}: \
                 the one or the other was changed, or parameters were exchanged"
            );
            return Err(invalid(message, "calibrate again, or give the file as it was written"));
        }
    }
    Ok(())
}

impl SensorCore {
    /// Counts per m/s² or rad/s of the raw readings.
    fn sensitivity(&self, sensor_kind: SensorKind) -> Checked<Option<f64>> {
        let (name, stated) = match sensor_kind {
            SensorKind::Accelerometer => ("counts_per_mps2", self.counts_per_mps2),
            SensorKind::Gyroscope => ("counts_per_radps", self.counts_per_radps),
        };
        let is_of_counts = unit_named(&self.reading_unit, sensor_kind) == Some(ReadingUnit::Counts);
        match stated {
            Some(counts) if is_of_counts || counts.is_nan() || counts <= 0.0 => Err(invalid(
                format!("`{sensor_kind}.{name}` is {counts}, of readings in {}", self.reading_unit),
                "it is a number above 0, of readings in m/s² or rad/s: correct or remove it",
            )),
            stated => Ok(stated),
        }
    }

    fn into_sensor(self, sensor_kind: SensorKind) -> Checked<(ReadingUnit, SensorParameters, Matrix3<f64>)> {
        let unit = unit_named(&self.reading_unit, sensor_kind).ok_or_else(|| {
            invalid(
                format!("`{sensor_kind}.reading_unit` is \"{}\"", self.reading_unit),
                &format!("write \"{}\" or \"counts\"", sensor_kind.stimulus_unit().symbol()),
            )
        })?;
        let (bias_name, bias) = match unit {
            ReadingUnit::MetrePerSecondSquared => ("bias_mps2", self.bias_mps2),
            ReadingUnit::RadianPerSecond => ("bias_radps", self.bias_radps),
            ReadingUnit::Counts => ("bias_counts", self.bias_counts),
        };
        let (matrix_name, matrix) = match (unit, sensor_kind) {
            (ReadingUnit::Counts, SensorKind::Accelerometer) => {
                ("matrix_counts_per_mps2", self.matrix_counts_per_mps2)
            }
            (ReadingUnit::Counts, SensorKind::Gyroscope) => {
                ("matrix_counts_per_radps", self.matrix_counts_per_radps)
            }
            _ => ("matrix", self.matrix),
        };
        let (g_name, g_sensitivity) = match unit {
            ReadingUnit::Counts => ("g_sensitivity_counts_per_mps2", self.g_sensitivity_counts_per_mps2),
            _ => ("g_sensitivity_radps_per_mps2", self.g_sensitivity_radps_per_mps2),
        };
        let field = |name: &str| format!("{sensor_kind}.{name}");
        let bias = bias.ok_or_else(|| missing(&field(bias_name)))?;
        let matrix = matrix.ok_or_else(|| missing(&field(matrix_name)))?;
        let mut sensor = match (bias.as_slice(), matrix.as_slice()) {
            ([bias], [row]) if row.len() == 1 => of_one_axis(*bias, row[0]),
            _ => SensorParameters {
                bias: vector3(&bias, &field(bias_name))?,
                matrix: matrix3(&matrix, &field(matrix_name))?,
                ..SensorParameters::identity()
            },
        };
        for term in NonlinearTerm::ALL {
            let Some(values) = self.nonlinearity.as_ref().and_then(|of| of.get(term.key())) else { continue };
            let name = field(&format!("nonlinearity.{}", term.key()));
            let no_list =
                |_| invalid(format!("`{name}` is no list of numbers"), "write one number for each axis");
            let values: Vec<f64> = serde_json::from_value(values.clone()).map_err(no_list)?;
            *sensor.nonlinearity.of_mut(term) = vector3(&values, &name)?;
        }
        // a gyroscope without a g-sensitivity has the matrix zero
        let g_sensitivity = match (sensor_kind, g_sensitivity) {
            (SensorKind::Gyroscope, Some(rows)) => matrix3(&rows, &field(g_name))?,
            _ => Matrix3::zeros(),
        };
        if let (Some(stated), Some(correction)) = (&self.correction, Correction::of(&sensor))
            && !stated.is_near(correction_name(unit, sensor_kind), &block(&correction.matrix, bias.len()))
        {
            return Err(invalid(
                format!("the correction of the {sensor_kind} is not the inverse of its matrix"),
                "correct one of them, or remove `correction`",
            ));
        }
        Ok((unit, sensor, g_sensitivity))
    }
}

/// A sensor whose other axes count as perfect.
fn of_one_axis(bias: f64, scale: f64) -> SensorParameters {
    let mut sensor = SensorParameters::identity();
    (sensor.bias.x, sensor.matrix[(0, 0)]) = (bias, scale);
    sensor
}

impl CorrectionCore {
    /// Does the file state no other matrix than the computed one of this name, to the digits that people keep?
    fn is_near(&self, name: &str, computed: &[Vec<f64>]) -> bool {
        let stated = [
            ("matrix", &self.matrix),
            ("matrix_mps2_per_count", &self.matrix_mps2_per_count),
            ("matrix_radps_per_count", &self.matrix_radps_per_count),
        ];
        stated
            .into_iter()
            .all(|(key, rows)| rows.as_ref().is_none_or(|rows| key == name && near(rows, computed)))
    }
}

fn near(stated: &[Vec<f64>], computed: &[Vec<f64>]) -> bool {
    let (stated, computed) = (stated.concat(), computed.concat());
    let largest = computed.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    stated.len() == computed.len()
        && stated.iter().zip(&computed).all(|(one, other)| (one - other).abs() <= 1e-4 * largest)
}

impl ParameterCore {
    /// The quantity of this name; its unit and value must be those of the IMU.
    fn into_quantity(
        self,
        i: usize,
        imu: &CalibratedImu,
        symmetric: Option<&Vec<String>>,
    ) -> Checked<ImuQuantity> {
        let field = |field: &str| missing(&format!("parameters[{i}].{field}"));
        let name = self.name.ok_or_else(|| field("name"))?;
        let unit = self.unit.ok_or_else(|| field("unit"))?;
        let value = self.value.ok_or_else(|| field("value"))?;
        let quantity = quantity_of(&name, imu, symmetric).ok_or_else(|| {
            invalid(format!("\"{name}\" is no parameter of this IMU"), "names are accelerometer.bias.x, …")
        })?;
        let wanted = imu.unit_of(quantity);
        if unit != wanted {
            return Err(invalid(
                format!("{name} is in {unit}, its sensor says {wanted}"),
                "correct one of them",
            ));
        }
        let in_matrix = quantity.value(&imu.parameters);
        if (value - in_matrix).abs() > 1e-9 * value.abs().max(in_matrix.abs()) {
            return Err(invalid(
                format!("{name} is {value} in `parameters` and {in_matrix} in its sensor"),
                "correct one of them",
            ));
        }
        Ok(quantity)
    }
}

/// The quantity of a name. In the symmetric gauge, with all names of the list, an off-diagonal quantity of
/// the reference is that of the pair.
pub(super) fn quantity_of(
    name: &str,
    imu: &CalibratedImu,
    symmetric: Option<&Vec<String>>,
) -> Option<ImuQuantity> {
    let (accelerometer, gyroscope) =
        (imu.unit(SensorKind::Accelerometer).is_some(), imu.unit(SensorKind::Gyroscope).is_some());
    let found =
        ImuQuantity::all(accelerometer, gyroscope).into_iter().find(|quantity| quantity.name() == name)?;
    imu.unit(found.sensor_kind())?;
    match (found, symmetric) {
        (ImuQuantity::Of(sensor_kind, Quantity::CrossAxis(row, column)), Some(names))
            if sensor_kind == imu.reference() =>
        {
            let mirrored = ImuQuantity::Of(sensor_kind, Quantity::CrossAxis(column, row)).name();
            let pair = ImuQuantity::Of(sensor_kind, Quantity::Symmetric(row, column));
            Some(if names.contains(&mirrored) { found } else { pair })
        }
        _ => Some(found),
    }
}

/// The covariance of this number of parameters. An entry that is no number becomes one that
/// [`check`](super::usable_calibration) refuses.
pub(super) fn covariance_of(rows: &[Vec<Option<f64>>], size: usize) -> Checked<DMatrix<f64>> {
    if rows.len() != size || rows.iter().any(|row| row.len() != size) {
        let message = format!("the covariance is not {size} × {size}, one row for each parameter");
        return Err(invalid(message, "calibrate again, or remove the covariance"));
    }
    Ok(DMatrix::from_fn(size, size, |i, j| rows[i][j].unwrap_or(f64::NAN)))
}

/// Returns an error for a field that states another direction than that of our own files.
pub(super) fn check_direction(field: &str, stated: &str) -> Checked<()> {
    if stated.starts_with("true to raw") {
        return Ok(());
    }
    Err(invalid(
        format!(
            "`{field}` must be true to raw in this format, not {:?}",
            stated.chars().take(40).collect::<String>()
        ),
        "write y = S s + b, the reading of a true value; or give imu_tk's .calib, which is raw to true",
    ))
}
