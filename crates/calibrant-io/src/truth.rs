//! Writes `truth.json`: the true parameters of a simulated recording.

use super::json;
use calibrant_core::error::Result;
use calibrant_core::sensor::{
    Gauge, ImuParameters, ImuQuantity, ParameterList, Quantity, ReadingUnit, SensorKind, SensorParameters,
};
use calibrant_core::simulate::TrueGravity;
use nalgebra::{Matrix3, Vector3};
use serde::Serialize;
use std::path::Path;

/// Writes `truth.json`: the seed, and the true value of each parameter of the list.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_truth(
    path: &Path,
    seed: u64,
    list: &ParameterList,
    unit: ReadingUnit,
    truth: &SensorParameters,
) -> Result<()> {
    json::write_json(path, &TruthFile::of(seed, list, unit, truth))
}

/// Writes `truth.json` of a motion with gravity: as [`write_truth`], and the gravity that the sensor sensed.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_motion_truth(
    path: &Path,
    seed: u64,
    list: &ParameterList,
    unit: ReadingUnit,
    truth: &SensorParameters,
    gravity: &TrueGravity,
) -> Result<()> {
    let gravity =
        Some(TrueGravityFields { force_mps2: gravity.force_mps2.into(), tilt_rad: gravity.tilt_rad.into() });
    json::write_json(path, &TruthFile { gravity, ..TruthFile::of(seed, list, unit, truth) })
}

/// The text that [`write_truth`] writes.
///
/// # Examples
/// ```
/// use calibrant_io::truth_json;
/// use calibrant_core::sensor::{Sensor, SensorParameters};
///
/// let sensor = Sensor::memsic_mxd2020u();
/// let text = truth_json(7, &sensor.parameter_list(), sensor.unit, &SensorParameters::identity());
/// assert!(text.contains("\"seed\": 7"));
/// ```
#[must_use]
pub fn truth_json(seed: u64, list: &ParameterList, unit: ReadingUnit, truth: &SensorParameters) -> String {
    json::to_json(&TruthFile::of(seed, list, unit, truth))
}

/// Writes `truth.json` of an IMU: the seed, the reference temperature where one is followed, and the true
/// value of each of these quantities. Everything else that differs from an ideal IMU is under `fixed`, so
/// that the file is complete. `units` are those of accelerometer and gyroscope.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_imu_truth(
    path: &Path,
    seed: u64,
    quantities: &[ImuQuantity],
    units: [ReadingUnit; 2],
    truth: &ImuParameters,
) -> Result<()> {
    json::write_json(path, &imu_truth(seed, quantities, units, truth))
}

/// The content of the file that [`write_imu_truth`] writes.
pub(super) fn imu_truth(
    seed: u64,
    quantities: &[ImuQuantity],
    units: [ReadingUnit; 2],
    truth: &ImuParameters,
) -> TruthFile {
    let unit = |sensor_kind: SensorKind| units[usize::from(sensor_kind == SensorKind::Gyroscope)];
    let value = |quantity: &ImuQuantity| TrueParameter {
        name: quantity.name(),
        unit: quantity.unit(unit(quantity.sensor_kind())),
        value: quantity.value(truth),
    };
    let parameters = quantities.iter().map(value).collect();
    let fixed = beside(quantities, truth).iter().map(value).collect();
    let thermal = quantities.iter().any(|quantity| matches!(quantity, ImuQuantity::Thermal(..)));
    let (convention, reference_c) = match thermal {
        false => ("true to raw: y_a = S_a f + b_a, y_g = S_g w + b_g + G f", None),
        true => (
            "true to raw: y_a = S_a(T) f + b_a(T), y_g = S_g(T) w + b_g(T) + G f; b(T) = b + b_1 t + b_2 t^2, S(T) = diag(1 + k_1 t + k_2 t^2) S, t = T - reference_c",
            Some(truth.thermal.reference_c),
        ),
    };
    let of_accelerometer = quantities.iter().filter_map(|quantity| match quantity {
        ImuQuantity::Of(SensorKind::Accelerometer, of) => Some(of),
        _ => None,
    });
    let gauge = gauge_of(of_accelerometer, &truth.accelerometer.matrix);
    TruthFile {
        schema: 1,
        program: crate::atomic_output::program(),
        seed,
        convention,
        gauge,
        reference_c,
        parameters,
        gravity: None,
        fixed,
    }
}

/// The form of a matrix: symmetric where its quantities are so, although rounding may hide it.
fn gauge_of<'q>(
    quantities: impl IntoIterator<Item = &'q Quantity>,
    matrix: &Matrix3<f64>,
) -> Option<&'static str> {
    let symmetric = quantities.into_iter().any(|quantity| matches!(quantity, Quantity::Symmetric(..)));
    if symmetric { Some(Gauge::Symmetric) } else { Gauge::of(matrix) }.map(Gauge::name)
}

/// The quantities that are not zero and not among these, however they are written down.
fn beside(quantities: &[ImuQuantity], truth: &ImuParameters) -> Vec<ImuQuantity> {
    let nothing = SensorParameters { bias: Vector3::zeros(), matrix: Matrix3::zeros() };
    let mut reported =
        ImuParameters { accelerometer: nothing, gyroscope: nothing, ..ImuParameters::identity() };
    for quantity in quantities {
        quantity.add_to(&mut reported, quantity.value(truth));
    }
    let all =
        ImuQuantity::full_list(true, true, true).into_iter().chain(ImuQuantity::all_thermal(true, true));
    // both entries of a symmetric pair are the same up to rounding
    let rounding = |quantity: &ImuQuantity| 1e-12 * quantity.value(truth).abs();
    all.filter(|quantity| (quantity.value(&reported) - quantity.value(truth)).abs() > rounding(quantity))
        .collect()
}

#[derive(Serialize)]
pub(super) struct TruthFile {
    schema: u32,
    program: String,
    seed: u64,
    convention: &'static str,
    /// The form of the accelerometer's matrix, where it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    gauge: Option<&'static str>,
    /// The reference temperature of an IMU that follows temperature, °C.
    #[serde(skip_serializing_if = "Option::is_none")]
    reference_c: Option<f64>,
    parameters: Vec<TrueParameter>,
    /// The gravity beside a commanded motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    gravity: Option<TrueGravityFields>,
    /// The values that a calibration of the experiment takes as given.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    fixed: Vec<TrueParameter>,
}

#[derive(Serialize)]
struct TrueGravityFields {
    /// Specific force of the sensor at rest, m/s².
    force_mps2: [f64; 3],
    /// Tilt about each axis, rad.
    tilt_rad: [f64; 3],
}

#[derive(Serialize)]
struct TrueParameter {
    name: String,
    unit: &'static str,
    value: f64,
}

impl TruthFile {
    fn of(seed: u64, list: &ParameterList, unit: ReadingUnit, truth: &SensorParameters) -> Self {
        let parameter = |quantity: &Quantity| TrueParameter {
            name: ImuQuantity::Of(SensorKind::Accelerometer, *quantity).name(),
            unit: quantity.unit(unit),
            value: quantity.value(truth),
        };
        Self {
            schema: 1,
            program: crate::atomic_output::program(),
            seed,
            convention: "true to raw: y = S s + b",
            gauge: gauge_of(list.quantities(), &truth.matrix),
            reference_c: None,
            parameters: list.quantities().iter().map(parameter).collect(),
            gravity: None,
            fixed: Vec::new(),
        }
    }
}
