//! Noise densities that are given beside a calibration.

use super::words::invalid;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::convention::RatesDiffer;
use calibrant_core::sensor::SensorKind;
use calibrant_recording::text::decoding::Checked;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Rates are the same within this share. Clocks of two sensors differ by less, and half of it changes the
/// noise of a sample.
const SAME_RATE: f64 = 0.01;

/// Noise densities of an IMU, as Kalibr's `imu.yaml` has them.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct ImuNoise {
    /// White noise of the accelerometer, m/s²/√Hz.
    #[serde(rename = "accelerometer_density_mps2_per_sqrt_hz")]
    pub accelerometer_density: Option<f64>,
    /// Random walk of its bias, m/s³/√Hz.
    #[serde(rename = "accelerometer_random_walk_mps3_per_sqrt_hz")]
    pub accelerometer_random_walk: Option<f64>,
    /// White noise of the gyroscope, rad/s/√Hz.
    #[serde(rename = "gyroscope_density_radps_per_sqrt_hz")]
    pub gyroscope_density: Option<f64>,
    /// Random walk of its bias, rad/s²/√Hz.
    #[serde(rename = "gyroscope_random_walk_radps2_per_sqrt_hz")]
    pub gyroscope_random_walk: Option<f64>,
    /// Sample rate, Hz.
    pub update_rate_hz: Option<f64>,
    /// Sample rates at which the densities of accelerometer and gyroscope were measured, Hz, where they are
    /// known: the files have one rate.
    #[serde(skip)]
    pub measured_at_hz: [Option<f64>; 2],
    /// The ROS topic of the readings.
    pub rostopic: Option<String>,
    /// Upper limits of the random walks of accelerometer and gyroscope that no axis determines, in their units.
    #[serde(skip)]
    pub walk_limits: [Option<f64>; 2],
    /// What was supposed of axes that do not determine a random walk.
    #[serde(skip)]
    pub findings: Vec<Diagnostic>,
}

impl ImuNoise {
    /// The same densities, if its numbers are positive and finite.
    pub(super) fn checked(self) -> Checked<Self> {
        for (name, value) in self.fields() {
            if value.is_some_and(|value| !(value.is_finite() && value > 0.0)) {
                return Err(invalid(format!("`{name}` is not a positive number"), "correct it or remove it"));
            }
        }
        Ok(self)
    }

    /// The densities of either; where both have one, that of `self`.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            accelerometer_density: self.accelerometer_density.or(other.accelerometer_density),
            accelerometer_random_walk: self.accelerometer_random_walk.or(other.accelerometer_random_walk),
            gyroscope_density: self.gyroscope_density.or(other.gyroscope_density),
            gyroscope_random_walk: self.gyroscope_random_walk.or(other.gyroscope_random_walk),
            update_rate_hz: self.update_rate_hz.or(other.update_rate_hz),
            measured_at_hz: [0, 1].map(|k| self.measured_at_hz[k].or(other.measured_at_hz[k])),
            rostopic: self.rostopic.or(other.rostopic),
            walk_limits: [0, 1].map(|k| self.walk_limits[k].or(other.walk_limits[k])),
            findings: self.findings.into_iter().chain(other.findings).collect(),
        }
    }

    /// The upper limit of a field that is not determined.
    pub(super) fn limit(&self, name: &str) -> Option<f64> {
        match name {
            "accelerometer_random_walk" => self.walk_limits[0],
            "gyroscope_random_walk" => self.walk_limits[1],
            _ => None,
        }
    }

    /// The warning where the single rate of a file is not that of a sensor.
    pub(super) fn of_rates(&self) -> Option<Diagnostic> {
        let rate = self.update_rate_hz?;
        let is_other = |measured: &f64| (measured / rate - 1.0).abs() > SAME_RATE;
        let (sensor_kind, measured) = SensorKind::ALL
            .into_iter()
            .zip(self.measured_at_hz)
            .find_map(|(sensor_kind, measured)| Some((sensor_kind, measured.filter(is_other)?)))?;
        Some(RatesDiffer { sensor_kind, measured_hz: measured, written_hz: rate }.into())
    }

    pub(super) fn fields(&self) -> [(&'static str, Option<f64>); 5] {
        [
            ("accelerometer_noise_density", self.accelerometer_density),
            ("accelerometer_random_walk", self.accelerometer_random_walk),
            ("gyroscope_noise_density", self.gyroscope_density),
            ("gyroscope_random_walk", self.gyroscope_random_walk),
            ("update_rate", self.update_rate_hz),
        ]
    }
}
