//! Reads the temperature model of an IMU in our JSON files: the object `temperature`.
//!
//! The bias of each sensor has the fields in its unit. Fields that are not there are zero.

use super::arrays::{missing, vector3};
use super::words::invalid;
use calibrant_core::sensor::{PER_K, ReadingUnit, SensorKind, SensorThermal, Thermal};
use calibrant_recording::text::decoding::Checked;
use serde::Deserialize;
use std::collections::BTreeMap;

#[derive(Debug, Deserialize)]
pub(super) struct TemperatureCore {
    reference_c: Option<f64>,
    range_c: Option<Vec<f64>>,
    accelerometer: Option<TermsCore>,
    gyroscope: Option<TermsCore>,
}

/// Fields by their names: `bias_mps2_per_k`, `scale_per_k2`.
#[derive(Debug, Deserialize)]
#[serde(transparent)]
struct TermsCore(BTreeMap<String, Vec<f64>>);

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
    fn into_terms(self, sensor_kind: SensorKind, unit: ReadingUnit) -> Checked<SensorThermal> {
        let others = [ReadingUnit::MetrePerSecondSquared, ReadingUnit::RadianPerSecond, ReadingUnit::Counts]
            .map(|other| format!("bias_{}_", other.suffix()));
        let bias = format!("bias_{}", unit.suffix());
        let is_other = |name: &String| {
            others.iter().any(|other| name.starts_with(other)) && !name.starts_with(&format!("{bias}_"))
        };
        if self.0.keys().any(is_other) {
            return Err(invalid(
                format!(
                    "`temperature.{sensor_kind}` has a bias in another unit than its sensor, {}",
                    unit.symbol()
                ),
                "give it in the unit of the readings",
            ));
        }
        let mut terms = SensorThermal::default();
        for (start, of_orders) in [(&*bias, &mut terms.bias), ("scale", &mut terms.scale)] {
            for (per, of_order) in PER_K.iter().zip(of_orders) {
                let name = format!("{start}_{per}");
                if let Some(values) = self.0.get(&name) {
                    *of_order = vector3(values, &format!("temperature.{sensor_kind}.{name}"))?;
                }
            }
        }
        Ok(terms)
    }
}
