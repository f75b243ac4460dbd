//! What a calibrated IMU is written to, and shown as.

use super::Arguments;
use crate::console;
use calibrant::estimate::ImuCalibration;
use calibrant::io::{ImuFile, Input, imu_calibration_json, write_imu_calibration};

pub(super) fn write(
    arguments: &Arguments,
    calibration: &ImuCalibration,
    file: &ImuFile,
    input: &Input,
) -> calibrant::Result<()> {
    let _ = file;
    write_imu_calibration(
        &arguments.output.join("calibration.json"),
        calibration,
        std::slice::from_ref(input),
    )
}

pub(super) fn show(arguments: &Arguments, calibration: &ImuCalibration, input: &Input) {
    if arguments.json {
        return console::print(&imu_calibration_json(calibration, std::slice::from_ref(input)));
    }
    for ((quantity, value), sd) in
        calibration.quantities.iter().zip(&calibration.values).zip(calibration.sd())
    {
        console::print(&format!(
            "{:28} {value:14.6} {sd:12.6} {}\n",
            quantity.name(),
            calibration.unit_of(*quantity)
        ));
    }
    console::print(&format!(
        "rotations miss gravity by {:.3}° rms\n",
        calibration.rotation_rms_rad().to_degrees()
    ));
}
