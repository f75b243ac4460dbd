//! How good a calibration is, in the cells of a row: for tables of several recordings.

use crate::session::Calibrated;
use calibrant_core::estimate::Calibration;
use calibrant_io::{Experiment, Plan};
use calibrant_report::number_format;

/// The columns between the verdict and the codes that decide it.
pub(super) fn columns(experiment: &Experiment) -> &'static [&'static str] {
    match (&experiment.plan, &experiment.imu) {
        (Plan::Machine(_), _) => &["used"],
        (_, Some(_)) => &["holds used", "rotations used", "|f|−g mm/s²", "gravity error °"],
        (_, None) => &["p-value"],
    }
}

/// The cells of these columns. The recording of an IMU may lack a sensor, but its row has the columns of the experiment.
pub(super) fn cells(experiment: &Experiment, calibrated: &Calibrated) -> Vec<String> {
    let sensors = calibrated.sensors();
    match calibrated.machine() {
        Some(machine) => vec![format!("{:.0} %", 100.0 * machine.calibration.used_share)],
        None if experiment.imu.is_some() => of_imu(sensors),
        None => vec![sensors.fit.p_value.map_or_else(unknown, number_format::probability)],
    }
}

fn unknown() -> String {
    "–".to_owned()
}

fn of_imu(calibration: &Calibration) -> Vec<String> {
    let checked = calibration.holds().filter(|holds| holds.degrees_of_freedom > 0);
    vec![
        share(calibration.hold_results().iter().map(|hold| hold.used)),
        share(calibration.rotations().iter().map(|rotation| rotation.used)),
        checked.map_or_else(unknown, |holds| {
            number_format::significant(1e3 * holds.magnitude_residual_rms_mps2, 3)
        }),
        match calibration.rotations().is_empty() {
            true => unknown(),
            false => number_format::significant(calibration.rotation_rms_rad().to_degrees(), 2),
        },
    ]
}

/// How many of them are used, in words.
fn share(used: impl ExactSizeIterator<Item = bool>) -> String {
    match used.len() {
        0 => unknown(),
        all => format!("{} of {all}", used.filter(|used| *used).count()),
    }
}
