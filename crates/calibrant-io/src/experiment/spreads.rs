//! The check that the datasheet gives spreads where an option needs them.

use super::refused_key::refused;
use calibrant_core::error::Result;
use calibrant_core::sensor::{ReadingUnit, Sensor, SensorModel};

/// Returns an error where `key` needs the datasheet and a spread is missing there. A spread of zero is an
/// error, too: it would leave nothing to estimate.
pub(super) fn need_spreads(key: &str, sensor: &Sensor) -> Result<()> {
    let mut missing = Vec::new();
    let positive = |spread: Option<nalgebra::Vector3<f64>>| spread.is_some_and(|sd| sd.min() > 0.0);
    if !positive(sensor.bias_sd_mps2) {
        missing.push("bias_sd_mps2");
    }
    if !positive(sensor.scale_sd) {
        missing.push("scale_sd");
    }
    if sensor.model == SensorModel::Full && !sensor.cross_axis_sd.is_some_and(|sd| sd > 0.0) {
        missing.push("cross_axis_sd");
    }
    if sensor.unit == ReadingUnit::Counts {
        if sensor.gain.is_none() {
            missing.push("gain_counts_per_mps2");
        }
        if sensor.offset.is_none() {
            missing.push("offset_counts");
        }
    }
    if missing.is_empty() {
        return Ok(());
    }
    let message = format!("\"datasheet\" needs {} in [sensor] (spreads above 0)", missing.join(", "));
    Err(refused(key, message, "add what is missing, or write \"none\""))
}
