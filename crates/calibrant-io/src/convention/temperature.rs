//! The temperature model of an IMU in our JSON files: the object `temperature`.
//!
//! The bias of each sensor has the fields in its unit. Fields that are not there are zero.

use super::arrays::{missing, vector3};
use super::words::input_error;
use crate::text_decoding::Checked;
use calibrant_core::error::Refusal;
use calibrant_core::sensor::{CalibratedImu, ReadingUnit, SensorKind, SensorThermal, Thermal};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct TemperatureCore {
    formula: Option<String>,
    reference_c: Option<f64>,
    range_c: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    accelerometer: Option<TermsCore>,
    #[serde(skip_serializing_if = "Option::is_none")]
    gyroscope: Option<TermsCore>,
}

/// The formula that the file states.
const FORMULA: &str = "with t = T - reference_c: b(T) = b + bias_per_k t + bias_per_k2 t^2, S(T) = diag(1 + scale_per_k t + scale_per_k2 t^2) S";

#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(default)]
struct TermsCore {
    #[serde(skip_serializing_if = "Option::is_none")]
    bias_mps2_per_k: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bias_mps2_per_k2: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bias_radps_per_k: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bias_radps_per_k2: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bias_counts_per_k: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bias_counts_per_k2: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    scale_per_k: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    scale_per_k2: Option<Vec<f64>>,
}

impl TemperatureCore {
    /// The fields of an IMU that follows temperature.
    pub(super) fn of(imu: &CalibratedImu) -> Option<Self> {
        let thermal = &imu.parameters.thermal;
        let terms =
            |sensor_kind| imu.unit(sensor_kind).map(|unit| TermsCore::of(unit, thermal.sensor(sensor_kind)));
        imu.follows_temperature().then(|| Self {
            formula: Some(FORMULA.into()),
            reference_c: Some(thermal.reference_c),
            range_c: thermal.range_c.map(|range| range.to_vec()),
            accelerometer: terms(SensorKind::Accelerometer),
            gyroscope: terms(SensorKind::Gyroscope),
        })
    }

    /// The temperature model of the fields; units are those of the sensors.
    pub(super) fn into_thermal(self, units: [Option<ReadingUnit>; 2]) -> Checked<Thermal> {
        let Some(reference_c) = self.reference_c else {
            return Err(missing("temperature.reference_c"));
        };
        let range_c = match self.range_c.as_deref() {
            None => None,
            Some([low, high]) => Some([*low, *high]),
            Some(_) => {
                return Err(input_error(
                    Refusal::CalibrationInvalid,
                    "`temperature.range_c` is not two numbers",
                    "give the least and the greatest temperature",
                ));
            }
        };
        let mut thermal = Thermal { reference_c, range_c, ..Thermal::none() };
        let there = [
            (SensorKind::Accelerometer, self.accelerometer, units[0], &mut thermal.accelerometer),
            (SensorKind::Gyroscope, self.gyroscope, units[1], &mut thermal.gyroscope),
        ];
        for (sensor_kind, terms, unit, into) in there {
            *into = match (terms, unit) {
                (None, _) => SensorThermal::default(),
                (Some(terms), Some(unit)) => terms.into_terms(sensor_kind, unit)?,
                (Some(_), None) => {
                    return Err(input_error(
                        Refusal::CalibrationInvalid,
                        format!("`temperature.{sensor_kind}` is there, and no {sensor_kind}"),
                        "correct the one or the other",
                    ));
                }
            };
        }
        Ok(thermal)
    }
}

impl TermsCore {
    fn of(unit: ReadingUnit, terms: &SensorThermal) -> Self {
        let list = |vector: &Vector3<f64>| Some(vector.iter().copied().collect());
        let mut fields = Self {
            scale_per_k: list(&terms.scale[0]),
            scale_per_k2: list(&terms.scale[1]),
            ..Self::default()
        };
        let [first, second] = fields.bias(unit);
        (*first, *second) = (list(&terms.bias[0]), list(&terms.bias[1]));
        fields
    }

    fn bias(&mut self, unit: ReadingUnit) -> [&mut Option<Vec<f64>>; 2] {
        match unit {
            ReadingUnit::MetrePerSecondSquared => [&mut self.bias_mps2_per_k, &mut self.bias_mps2_per_k2],
            ReadingUnit::RadianPerSecond => [&mut self.bias_radps_per_k, &mut self.bias_radps_per_k2],
            ReadingUnit::Counts => [&mut self.bias_counts_per_k, &mut self.bias_counts_per_k2],
        }
    }

    fn into_terms(mut self, sensor_kind: SensorKind, unit: ReadingUnit) -> Checked<SensorThermal> {
        let vector = |values: Option<Vec<f64>>, name: &str| match values {
            Some(values) => vector3(&values, &format!("temperature.{sensor_kind}.{name}")),
            None => Ok(Vector3::zeros()),
        };
        let [first, second] = self.bias(unit).map(Option::take);
        let others = [ReadingUnit::MetrePerSecondSquared, ReadingUnit::RadianPerSecond, ReadingUnit::Counts];
        if others.into_iter().any(|other| self.bias(other).iter().any(|field| field.is_some())) {
            return Err(input_error(
                Refusal::CalibrationInvalid,
                format!(
                    "`temperature.{sensor_kind}` has a bias in another unit than its sensor, {}",
                    unit.symbol()
                ),
                "give it in the unit of the readings",
            ));
        }
        Ok(SensorThermal {
            bias: [vector(first, "bias_per_k")?, vector(second, "bias_per_k2")?],
            scale: [
                vector(self.scale_per_k.take(), "scale_per_k")?,
                vector(self.scale_per_k2.take(), "scale_per_k2")?,
            ],
        })
    }
}
