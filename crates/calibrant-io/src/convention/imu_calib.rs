//! The YAML of imu_calib, a node of ROS 1 and its ports to ROS 2, that corrects the accelerometer of a topic.
//!
//! The direction is raw → true, with the bias taken away after the matrix: `s = SM y − bias`. So `SM = C`, row by row, and `bias = C b`. The gyroscope
//! has no place: the node takes a bias of its own at its start.

use super::file::CalibratedImuFile;
use super::words::{input_error, singular, written_by};
use super::yaml::line;
use calibrant_core::error::Refusal;
use calibrant_core::sensor::SensorKind;
use calibrant_recording::text::decoding::Checked;

pub(super) fn write(file: &CalibratedImuFile) -> Checked<String> {
    let imu = &file.imu;
    if imu.unit(SensorKind::Gyroscope).is_some() {
        let message = "imu_calib's YAML has no place for the gyroscope";
        let help =
            "write the accelerometer alone with option `sensor` accelerometer, or choose another format";
        return Err(input_error(Refusal::ConversionImpossible, message, help));
    }
    let sensor = imu.parameters.sensor(SensorKind::Accelerometer);
    let c = sensor.matrix.try_inverse().ok_or_else(|| singular(SensorKind::Accelerometer))?;
    let mut out = format!(
        "# {}: corrected = SM raw - bias, in m/s^2\n# frame: {}\n",
        written_by(),
        imu.frame.replace(['\n', '\r'], " ").trim()
    );
    line(&mut out, "SM: ", c.transpose().as_slice());
    line(&mut out, "bias: ", (c * sensor.bias).as_slice());
    Ok(out)
}
