//! What a calibrated IMU is written to, and shown as.

use super::Arguments;
use crate::console;
use calibrant::estimate::ImuCalibration;
use calibrant::io::{ImuFile, Input};

pub(super) fn write(
    arguments: &Arguments,
    calibration: &ImuCalibration,
    file: &ImuFile,
    input: &Input,
) -> calibrant::Result<()> {
    let _ = (arguments, calibration, file, input);
    Ok(())
}

pub(super) fn show(arguments: &Arguments, calibration: &ImuCalibration, input: &Input) {
    let _ = (arguments, input);
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
