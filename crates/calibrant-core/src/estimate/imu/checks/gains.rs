//! Gains of readings in SI, which are near one, each axis along its own.

use crate::diagnostic::Diagnostic;
use crate::estimate::imu::checks::directions::turned_frame;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::result::Calibration;
use crate::sensor::{Axis, ReadingUnit, SensorKind};

/// Gains of readings in SI that are plausible.
const PLAUSIBLE_GAINS: std::ops::RangeInclusive<f64> = 0.8..=1.25;

/// Those that are not.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    of_gains(evidence.calibration, evidence.axes.is_some())
}

/// Readings in SI have gains near one, each axis along its own.
fn of_gains(calibration: &Calibration, reordered: bool) -> Diagnostics {
    let mut warnings = Vec::new();
    for (sensor_kind, unit) in [
        (SensorKind::Accelerometer, calibration.accelerometer_unit),
        (SensorKind::Gyroscope, calibration.unit(SensorKind::Gyroscope)),
    ] {
        if unit == ReadingUnit::Counts || (sensor_kind == SensorKind::Gyroscope && reordered) {
            continue;
        }
        let matrix = &calibration.imu.sensor(sensor_kind).matrix;
        if calibration.frame_is_known() && turned_frame(matrix) {
            // the faces and turns say it better
            continue;
        }
        for axis in Axis::ALL {
            let along = matrix[(axis.index(), axis.index())];
            if !PLAUSIBLE_GAINS.contains(&along) {
                warnings.push(Diagnostic::GainImplausible { sensor_kind, axis, gain: along, unit });
            }
        }
    }
    warnings
}
