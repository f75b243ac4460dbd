//! How each parameter differs from sensor to sensor.

use super::distribution::Distribution;
use super::frame::FleetFrame;
use crate::database::{KeptRecord, Records};
use calibrant_core::error::Result;
use calibrant_core::sensor::{CalibratedImu, Gauge};
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::HashMap;

/// The parameters of all sensors, in one true frame and at one reference temperature.
#[derive(Debug, Clone, PartialEq)]
pub struct Fleet {
    /// The gauge of all; `None` where all have one frame of another kind, or where their matrices are diagonal.
    pub gauge: Option<Gauge>,
    /// The reference temperature of those that follow temperature, °C.
    pub reference_c: Option<f64>,
    /// The parameters, in the order in which the sensors have them.
    pub parameters: Vec<FleetParameter>,
    /// Number of sensors that do not follow temperature, where others do. They are as they were recorded.
    pub without_temperature: usize,
    /// Sensors that could not be brought into this frame or to this temperature.
    pub left_out: Vec<LeftOut>,
}

/// A sensor that is not compared with the others.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct LeftOut {
    /// The sensor.
    pub sensor: String,
    /// The number of its calibration.
    pub id: i64,
    /// Why.
    pub reason: String,
}

/// A parameter over all sensors.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct FleetParameter {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// The values of the sensors.
    #[serde(flatten)]
    pub values: Distribution,
    /// Root mean square of the standard deviations of the calibrations; `None` where they have none.
    pub calibration_sd: Option<f64>,
    /// The sensors that are farthest from the median, the farthest first.
    pub farthest: Vec<FarSensor>,
}

/// A sensor that is far from the median.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct FarSensor {
    /// The sensor.
    pub sensor: String,
    /// Its value.
    pub value: f64,
    /// Its distance from the median ([`Distribution::distance`]).
    pub in_robust_sd: f64,
}

/// Number of sensors that are named.
const FARTHEST: usize = 3;

impl Records {
    /// The parameters over all sensors. The latest calibration of each sensor counts, unless it is bad.
    ///
    /// All are brought to the gauge and to the reference temperature of the first that has one; those that do not follow temperature stay as they were recorded. Where there is no gauge, and frames of several kinds, it is the lower gauge.
    /// Where all have one frame of another kind, they stay in it.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) where the records are damaged.
    pub fn fleet(&self) -> Result<Fleet> {
        let newest = self.newest()?;
        let frame = FleetFrame::of(newest.iter().map(|kept| &kept.record.imu));
        let bring = |KeptRecord { id, record, .. }: KeptRecord| match frame.bring(record.imu) {
            Ok(imu) => Ok((record.sensor, imu)),
            Err(error) => Err(LeftOut { sensor: record.sensor, id, reason: error.to_string() }),
        };
        let brought: Vec<_> = newest.into_par_iter().map(bring).collect();
        let (mut found, mut left_out, mut without_temperature) = (Parameters::default(), Vec::new(), 0);
        for brought in brought {
            match brought {
                Ok((sensor, imu)) => {
                    without_temperature +=
                        usize::from(frame.reference_c.is_some() && !imu.follows_temperature());
                    found.add(&sensor, &imu);
                }
                Err(reason) => left_out.push(reason),
            }
        }
        let parameters = found.list.into_iter().filter_map(Found::over_sensors).collect();
        let FleetFrame { gauge, reference_c, .. } = frame;
        Ok(Fleet { gauge, reference_c, parameters, without_temperature, left_out })
    }
}

/// The parameters of the sensors so far.
#[derive(Default)]
struct Parameters {
    list: Vec<Found>,
    /// The place of a parameter, by its name and unit.
    places: HashMap<(String, &'static str), usize>,
}

struct Found {
    name: String,
    unit: &'static str,
    sensors: Vec<(String, f64)>,
    variances: Vec<f64>,
}

impl Parameters {
    fn add(&mut self, sensor: &str, imu: &CalibratedImu) {
        for (k, quantity) in imu.quantities.iter().enumerate() {
            let readings = imu.unit(quantity.sensor_kind()).unwrap_or(quantity.sensor_kind().stimulus_unit());
            let (name, unit) = (quantity.name(), quantity.unit(readings));
            let list = &mut self.list;
            let place = *self.places.entry((name, unit)).or_insert_with_key(|(name, unit)| {
                list.push(Found { name: name.clone(), unit, sensors: Vec::new(), variances: Vec::new() });
                list.len() - 1
            });
            let found = &mut list[place];
            found.sensors.push((sensor.to_owned(), quantity.value(&imu.parameters)));
            let variance = imu.covariance.as_ref().map(|sigma| sigma[(k, k)]);
            found.variances.extend(variance.filter(|variance| *variance > 0.0));
        }
    }
}

impl Found {
    fn over_sensors(self) -> Option<FleetParameter> {
        let values = Distribution::of(self.sensors.iter().map(|(_, value)| *value))?;
        let far = |(sensor, value)| Some(FarSensor { sensor, value, in_robust_sd: values.distance(value)? });
        let mut farthest: Vec<FarSensor> = self.sensors.into_iter().filter_map(far).collect();
        let distance = |of: &FarSensor| of.in_robust_sd.abs();
        farthest.sort_by(|one, other| {
            distance(other).total_cmp(&distance(one)).then_with(|| one.sensor.cmp(&other.sensor))
        });
        farthest.truncate(FARTHEST);
        let count = self.variances.len() as f64;
        let calibration_sd = (count > 0.0).then(|| (self.variances.iter().sum::<f64>() / count).sqrt());
        Some(FleetParameter { name: self.name, unit: self.unit, values, calibration_sd, farthest })
    }
}
