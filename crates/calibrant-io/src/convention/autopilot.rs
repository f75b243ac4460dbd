//! What the parameters of PX4 and ArduPilot share: a gain for each axis of the accelerometer, an offset for each of both sensors, a
//! polynomial of temperature, in numbers of 32 bits.

use super::words::input_error;
use calibrant_core::error::Refusal;
use calibrant_core::sensor::{CalibratedImu, SensorKind, Thermal};
use calibrant_recording::text::decoding::Checked;
use nalgebra::Vector3;
use std::ops::RangeInclusive;

/// Names of the axes.
pub(super) const AXES: [&str; 3] = ["X", "Y", "Z"];
/// The highest power of temperature.
pub(super) const POWERS: usize = 3;

/// `k_i = C_ii` of the accelerometer, whose matrix is diagonal here.
pub(super) fn gains(imu: &CalibratedImu, title: &str, bounds: RangeInclusive<f64>) -> Checked<Vector3<f64>> {
    let gains = imu.parameters[SensorKind::Accelerometer].matrix.diagonal().map(f64::recip);
    if let Some(gain) = gains.iter().find(|gain| !bounds.contains(gain)) {
        let (low, high) = (bounds.start(), bounds.end());
        return Err(input_error(
            Refusal::ConversionImpossible,
            format!("{title} takes gains of the accelerometer from {low} to {high}, and one is {gain:.4}"),
            "the axes of the calibration are to be those of the sensor, and its readings in m/s²: see option `gauge`",
        ));
    }
    Ok(gains)
}

/// The range of temperatures, where a term follows temperature.
pub(super) fn range(thermal: &Thermal, title: &str) -> Checked<Option<[f64; 2]>> {
    match thermal.range_c {
        _ if thermal.is_none() => Ok(None),
        Some(range) => Ok(Some(range)),
        None => Err(input_error(
            Refusal::ConversionImpossible,
            format!("{title} wants the range of temperatures, and this calibration does not have it"),
            "calibrate again, or take the values at one temperature with option `temperature` CELSIUS",
        )),
    }
}

/// A number of 32 bits, in the fewest digits that read back to it.
pub(super) fn single(value: f64) -> String {
    format!("{}", value as f32 + 0.0)
}
