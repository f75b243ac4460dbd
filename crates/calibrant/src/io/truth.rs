//! `truth.json`: the parameters that a simulated recording was made with.

use super::json;
use crate::error::Result;
use crate::sensor::{ParameterList, Quantity, ReadingUnit, SensorParameters};
use serde::Serialize;
use std::path::Path;

/// Writes `truth.json`: the seed, and the true value of each parameter of the list.
///
/// # Errors
/// [`Error::Output`](crate::Error::Output) where it cannot be written.
pub fn write_truth(
    path: &Path,
    seed: u64,
    list: &ParameterList,
    unit: ReadingUnit,
    truth: &SensorParameters,
) -> Result<()> {
    json::write_json(path, &TruthFile::of(seed, list, unit, truth))
}

/// The text that [`write_truth`] writes.
///
/// # Examples
/// ```
/// use calibrant::io::truth_json;
/// use calibrant::sensor::{Sensor, SensorParameters};
///
/// let sensor = Sensor::memsic_mxd2020u();
/// let text = truth_json(7, &sensor.parameter_list(), sensor.unit, &SensorParameters::identity());
/// assert!(text.contains("\"seed\": 7"));
/// ```
#[must_use]
pub fn truth_json(seed: u64, list: &ParameterList, unit: ReadingUnit, truth: &SensorParameters) -> String {
    json::to_json(&TruthFile::of(seed, list, unit, truth))
}

#[derive(Serialize)]
struct TruthFile {
    schema: u32,
    seed: u64,
    convention: &'static str,
    parameters: Vec<TrueParameter>,
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
            name: quantity.name(),
            unit: quantity.unit(unit),
            value: quantity.of(truth),
        };
        Self {
            schema: 1,
            seed,
            convention: "true to raw: y = S s + b",
            parameters: list.quantities().iter().map(parameter).collect(),
        }
    }
}
