//! What may make errors larger than predicted, other than a covariance that is too small.

use super::unused_error::ErrorKind;
use crate::form::As;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

/// A likely reason of errors that are larger than predicted, other than a covariance that is too small.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "explanation", rename_all = "snake_case")]
pub enum LikelyExplanation {
    /// The calibration has no temperature terms, and the recording is warmer or colder.
    Temperature {
        /// Mean temperature of the recording that was calibrated from, °C.
        #[serde(rename = "calibrated_mean_c")]
        calibrated_c: f64,
        /// That of the other one, °C.
        #[serde(rename = "mean_c")]
        here_c: f64,
    },
    /// The recording lies beyond the temperatures at which the calibration's terms were determined: they extrapolate.
    BeyondTemperatures {
        /// Least and greatest temperature of the calibration, °C.
        #[serde(rename = "calibrated_range_c")]
        calibrated_c: [f64; 2],
        /// Those of the recording, °C.
        #[serde(rename = "range_c")]
        here_c: [f64; 2],
    },
    /// The accelerometer's bias has moved, which explains the magnitudes.
    AccelerometerBias {
        /// By so much, as a specific force, m/s².
        #[serde(with = "As::<[f64; 3]>")]
        shift_mps2: Vector3<f64>,
        /// Its predicted standard deviation, m/s².
        #[serde(rename = "shift_sd_mps2", with = "As::<[f64; 3]>")]
        sd_mps2: Vector3<f64>,
    },
    /// The accelerometer's gains have changed, which explains the magnitudes.
    AccelerometerGain {
        /// By these shares of themselves.
        #[serde(with = "As::<[f64; 3]>")]
        change: Vector3<f64>,
        /// Their predicted standard deviation.
        #[serde(rename = "change_sd", with = "As::<[f64; 3]>")]
        sd: Vector3<f64>,
    },
    /// Both have, which explains the magnitudes, and neither alone does.
    AccelerometerBiasAndGain {
        /// The bias by so much, as a specific force, m/s².
        #[serde(with = "As::<[f64; 3]>")]
        shift_mps2: Vector3<f64>,
        /// Its predicted standard deviation, m/s².
        #[serde(with = "As::<[f64; 3]>")]
        shift_sd_mps2: Vector3<f64>,
        /// The gains by these shares of themselves.
        #[serde(with = "As::<[f64; 3]>")]
        change: Vector3<f64>,
        /// Their predicted standard deviation.
        #[serde(with = "As::<[f64; 3]>")]
        change_sd: Vector3<f64>,
    },
    /// The gyroscope's gains have changed, which explains the rotations.
    GyroscopeGain {
        /// By these shares of themselves.
        #[serde(with = "As::<[f64; 3]>")]
        change: Vector3<f64>,
        /// Their predicted standard deviation.
        #[serde(rename = "change_sd", with = "As::<[f64; 3]>")]
        sd: Vector3<f64>,
    },
    /// The gyroscope's readings are in another unit than the stated one.
    AngularUnit {
        /// Readings times this are in the stated unit: π/180 where they are in deg/s, 180/π where they were taken for deg/s and are in rad/s.
        factor: f64,
    },
}

impl LikelyExplanation {
    /// As written in results: `temperature`, `beyond_temperatures`, `accelerometer_bias`, `accelerometer_gain`, `accelerometer_bias_and_gain`, `gyroscope_gain`, `angular_unit`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Temperature { .. } => "temperature",
            Self::BeyondTemperatures { .. } => "beyond_temperatures",
            Self::AccelerometerBias { .. } => "accelerometer_bias",
            Self::AccelerometerGain { .. } => "accelerometer_gain",
            Self::AccelerometerBiasAndGain { .. } => "accelerometer_bias_and_gain",
            Self::GyroscopeGain { .. } => "gyroscope_gain",
            Self::AngularUnit { .. } => "angular_unit",
        }
    }

    /// May it make errors of this kind larger?
    #[must_use]
    pub fn explains(&self, kind: ErrorKind) -> bool {
        match self {
            Self::Temperature { .. } | Self::BeyondTemperatures { .. } => true,
            Self::AccelerometerBias { .. }
            | Self::AccelerometerGain { .. }
            | Self::AccelerometerBiasAndGain { .. } => {
                matches!(kind, ErrorKind::Magnitude | ErrorKind::Rotation)
            }
            Self::GyroscopeGain { .. } => kind == ErrorKind::Rotation,
            Self::AngularUnit { .. } => matches!(kind, ErrorKind::Rate | ErrorKind::Rotation),
        }
    }
}
