//! The degrees of freedom behind the covariance in our JSON files: the object `covariance_degrees_of_freedom`.

use super::words::invalid;
use calibrant_core::sensor::CovarianceDegrees;
use calibrant_recording::text::decoding::Checked;
use serde::Deserialize;

/// Those behind each part of the covariance; `null` where its size is known.
#[derive(Debug, Deserialize)]
pub(super) struct DegreesCore {
    accelerometer: Option<f64>,
    gyroscope_at_rest: Option<f64>,
    gyroscope_matrix: Option<f64>,
}

impl DegreesCore {
    pub(super) fn into_degrees(self) -> Checked<CovarianceDegrees> {
        let stated = |degrees: Option<f64>| match degrees {
            None => Ok(f64::INFINITY),
            Some(degrees) if degrees >= 0.0 => Ok(degrees),
            Some(degrees) => Err(invalid(
                format!("`covariance_degrees_of_freedom` has {degrees}"),
                "write a number from 0 on, or null where the variance is known",
            )),
        };
        Ok(CovarianceDegrees {
            accelerometer: stated(self.accelerometer)?,
            gyroscope_at_rest: stated(self.gyroscope_at_rest)?,
            gyroscope_matrix: stated(self.gyroscope_matrix)?,
        })
    }
}
