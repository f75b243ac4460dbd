//! `[temperature]`: which biases and gains of an IMU follow temperature, and by which polynomials.

use super::number::{Count, Within};
use super::ranges::{Celsius, Lag, LagSd};
use super::refused_key::refused;
use calibrant_core::error::Result;
use calibrant_core::estimate::{ThermalModel, ThermometerLag};
use calibrant_core::sensor::HIGHEST_ORDER;
use serde::{Deserialize, Serialize};

/// The order of a polynomial.
type Order = Count<0, { HIGHEST_ORDER as u64 }>;

/// `[temperature]`: the orders of polynomials in the temperature; 0 where they are not there.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TemperatureSection {
    /// The reference; without it, the mean over the holds.
    pub reference_c: Option<Within<Celsius>>,
    /// Order of the accelerometer's bias.
    pub accelerometer_bias: Option<Order>,
    /// Order of the accelerometer's gains.
    pub accelerometer_scale: Option<Order>,
    /// Order of the gyroscope's bias.
    pub gyroscope_bias: Option<Order>,
    /// Order of the gyroscope's gains.
    pub gyroscope_scale: Option<Order>,
    /// By how much the thermometer lags the sensor; 0 by default.
    pub lag_s: Option<Within<Lag>>,
    /// Its standard deviation; 0 for the lag as it is stated.
    pub lag_sd_s: Option<Within<LagSd>>,
}

impl TemperatureSection {
    /// The model.
    pub(super) fn model(&self) -> ThermalModel {
        let order = |order: Option<Order>| order.map_or(0, Count::size);
        ThermalModel {
            reference_c: self.reference_c.map(f64::from),
            accelerometer_bias: order(self.accelerometer_bias),
            accelerometer_scale: order(self.accelerometer_scale),
            gyroscope_bias: order(self.gyroscope_bias),
            gyroscope_scale: order(self.gyroscope_scale),
        }
    }

    /// The orders that are stated: bias and gains of the accelerometer, then of the gyroscope.
    pub(super) fn orders(&self) -> [Option<usize>; 4] {
        [self.accelerometer_bias, self.accelerometer_scale, self.gyroscope_bias, self.gyroscope_scale]
            .map(|order| order.map(Count::size))
    }

    /// Refuses what is of a gyroscope.
    pub(super) fn without_gyroscope(&self) -> Result<()> {
        let keys = [("gyroscope_bias", self.gyroscope_bias), ("gyroscope_scale", self.gyroscope_scale)];
        match keys.into_iter().find(|(_, order)| order.is_some()) {
            Some((key, _)) => {
                let help = "take this key out, or set kind = \"imu\" in [sensor]";
                Err(refused(format!("temperature.{key}"), "only an IMU has a gyroscope", help))
            }
            None => Ok(()),
        }
    }

    /// What is known of the thermometer.
    pub(super) fn thermometer(&self) -> ThermometerLag {
        let unknown = ThermometerLag::default();
        ThermometerLag {
            lag_s: self.lag_s.map_or(unknown.lag_s, f64::from),
            sd_s: self.lag_sd_s.map_or(unknown.sd_s, f64::from),
        }
    }
}
