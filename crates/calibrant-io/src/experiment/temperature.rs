//! Reads `[temperature]`: which biases and gains of an IMU follow temperature, and by which polynomials.

use super::number_range::Bounds;
use super::toml_document::Section;
use calibrant_core::error::Result;
use calibrant_core::estimate::ThermalModel;
use calibrant_core::sensor::{HIGHEST_ORDER, WORKING_C};

/// Range of a temperature.
const CELSIUS: Bounds = Bounds::from(*WORKING_C.start(), *WORKING_C.end(), "°C");

/// Reads `[temperature]`; orders that are not there are 0.
pub(super) fn read(section: &Section<'_>) -> Result<ThermalModel> {
    let order = |key: &str| section.get(key).map_or(Ok(0), |entry| entry.size(0, HIGHEST_ORDER as u64));
    Ok(ThermalModel {
        reference_c: section.get("reference_c").map(|entry| entry.number(&CELSIUS)).transpose()?,
        accelerometer_bias: order("accelerometer_bias")?,
        accelerometer_scale: order("accelerometer_scale")?,
        gyroscope_bias: order("gyroscope_bias")?,
        gyroscope_scale: order("gyroscope_scale")?,
    })
}
