//! librealsense's `calibration.json`, as its rs-imu-calibration writes it.
//!
//! The direction is raw → true, with the bias taken away after the matrix: `s = C y − c`, `c = C b`. Its tool multiplies rows of readings
//! by a matrix that it lists row by row; that is `C` column by column. A device corrects before it turns the frame into that of
//! its depth camera.

use super::file::CalibratedImuFile;
use super::words::singular;
use crate::results::json;
use calibrant_recording::text::decoding::Checked;
use serde::Serialize;
use std::collections::BTreeMap;

#[derive(Serialize)]
struct Calibration {
    device_type: &'static str,
    imus: [BTreeMap<&'static str, Sensor>; 1],
}

#[derive(Serialize)]
struct Sensor {
    bias: Vec<f64>,
    scale_and_alignment: Vec<f64>,
}

pub(super) fn write(file: &CalibratedImuFile) -> Checked<String> {
    let mut sensors = BTreeMap::new();
    for (sensor_kind, _) in file.imu.units.present() {
        let sensor = file.imu.parameters.sensor(sensor_kind);
        let c = sensor.matrix.try_inverse().ok_or_else(|| singular(sensor_kind))?;
        // nalgebra's order is column by column
        let list = |values: &[f64]| values.iter().map(|value| value + 0.0).collect();
        let bias = list((c * sensor.bias).as_slice());
        sensors.insert(sensor_kind.name(), Sensor { bias, scale_and_alignment: list(c.as_slice()) });
    }
    Ok(json::to_json(&Calibration { device_type: "D435i", imus: [sensors] }))
}
