//! What the mounting means for the parameters, in a sentence.

use crate::number_format::significant;
use calibrant_core::estimate::{BudgetRow, VarianceSource};
use calibrant_core::sensor::SensorKind;
use calibrant_machine::estimate::{MachineCalibration, MachineSetup, MountingPrior};

/// Part of a parameter's variance from which on the mounting limits it.
const LIMITING: f64 = 0.5;

/// The gauge of an unknown mounting, or how many parameters a mounting that is known too little limits. `None` where the mounting is no matter.
pub(super) fn mounting_in_words(calibration: &MachineCalibration, setup: &MachineSetup) -> Option<String> {
    match setup.mounting {
        MountingPrior::Exact => None,
        MountingPrior::Unknown => {
            let first = calibration.noise.first().map_or(SensorKind::Accelerometer, |of| of.sensor);
            Some(format!(
                "Nothing is known of the mounting, and a rotation of the sensor reads like one of its matrices. \
                 That of the {first} is upper triangular, which defines the sensor's axes."
            ))
        }
        MountingPrior::Within(sd_rad) => {
            let is_limited = |row: &&BudgetRow| row.share(VarianceSource::Mounting) > LIMITING;
            let limited = calibration.sensors.budget.iter().filter(is_limited).count();
            (limited > 0).then(|| {
                format!(
                    "The mounting is known to {}°, which limits {limited} of {} parameters. A fixture helps; \
                     or give [machine.mount] rotation = \"unknown\" and no rotation_sd_deg, and the data define the sensor's axes.",
                    significant(sd_rad.to_degrees(), 2),
                    calibration.sensors.budget.len()
                )
            })
        }
    }
}
