//! Reads the temperature model of an IMU in our JSON files: the object `temperature`.
//!
//! The bias of each sensor has the fields in its unit. Fields that are not there are zero.

use super::arrays::{missing, vector3};
use super::words::invalid;
use calibrant_core::sensor::{ReadingUnit, SensorKind, SensorThermal, Thermal};
use calibrant_recording::text::decoding::Checked;
use nalgebra::Vector3;
use serde::Deserialize;

#[derive(Debug, Deserialize)]
pub(super) struct TemperatureCore {
    reference_c: Option<f64>,
    range_c: Option<Vec<f64>>,
    accelerometer: Option<TermsCore>,
    gyroscope: Option<TermsCore>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct TermsCore {
    bias_mps2_per_k: Option<Vec<f64>>,
    bias_mps2_per_k2: Option<Vec<f64>>,
    bias_radps_per_k: Option<Vec<f64>>,
    bias_radps_per_k2: Option<Vec<f64>>,
    bias_counts_per_k: Option<Vec<f64>>,
    bias_counts_per_k2: Option<Vec<f64>>,
    scale_per_k: Option<Vec<f64>>,
    scale_per_k2: Option<Vec<f64>>,
}

impl TemperatureCore {
    /// The temperature model of the fields; units are those of the sensors.
    pub(super) fn into_thermal(self, units: [Option<ReadingUnit>; 2]) -> Checked<Thermal> {
        let Some(reference_c) = self.reference_c else {
            return Err(missing("temperature.reference_c"));
        };
        let range_c = match self.range_c.as_deref() {
            None => None,
            Some([low, high]) => Some([*low, *high]),
            Some(_) => {
                return Err(invalid(
                    "`temperature.range_c` is not two numbers",
                    "give the least and the greatest temperature",
                ));
            }
        };
        let mut thermal = Thermal { reference_c, range_c, ..Thermal::none() };
        let there = [
            (SensorKind::Accelerometer, self.accelerometer, units[0]),
            (SensorKind::Gyroscope, self.gyroscope, units[1]),
        ];
        for (sensor_kind, terms, unit) in there {
            thermal[sensor_kind] = match (terms, unit) {
                (None, _) => SensorThermal::default(),
                (Some(terms), Some(unit)) => terms.into_terms(sensor_kind, unit)?,
                (Some(_), None) => {
                    return Err(invalid(
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
            return Err(invalid(
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
