//! How good a calibration is, in the cells of a row: for tables of several recordings.

use calibrant::estimate::{Calibration, ImuCalibration};
use calibrant::pipeline::SensorCalibration;
use calibrant::report::number_format;

/// The columns between the status and the number of warnings.
pub(super) fn columns(is_imu: bool) -> &'static [&'static str] {
    match is_imu {
        true => &["holds used", "rotations used", "|f|−g mm/s²", "gravity error °"],
        false => &["p-value"],
    }
}

/// The cells of these columns.
pub(super) fn cells(calibration: &SensorCalibration) -> Vec<String> {
    match calibration {
        SensorCalibration::Accelerometer(calibration) => of_accelerometer(calibration),
        SensorCalibration::Imu(calibration) => of_imu(calibration),
    }
}

fn of_accelerometer(calibration: &Calibration) -> Vec<String> {
    vec![calibration.fit.p_value.map_or_else(|| "–".into(), number_format::probability)]
}

fn of_imu(calibration: &ImuCalibration) -> Vec<String> {
    let magnitude = calibration.holds.magnitude_residual_rms_mps2;
    vec![
        share(calibration.holds.holds.iter().map(|hold| hold.used)),
        share(calibration.rotations.iter().map(|rotation| rotation.used)),
        match calibration.holds.degrees_of_freedom {
            0 => "–".into(),
            _ => number_format::significant(1e3 * magnitude, 3),
        },
        match calibration.rotations.is_empty() {
            true => "–".into(),
            false => number_format::significant(calibration.rotation_rms_rad().to_degrees(), 2),
        },
    ]
}

/// How many of them are used, in words.
fn share(used: impl ExactSizeIterator<Item = bool>) -> String {
    match used.len() {
        0 => "–".into(),
        all => format!("{} of {all}", used.filter(|used| *used).count()),
    }
}
