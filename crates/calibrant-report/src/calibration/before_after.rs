//! The improvement by a calibration, in numbers: errors before and after it.

use crate::number_format::{UNKNOWN, significant};
use crate::sheet::{Cell, Table};
use calibrant_core::estimate::{Calibration, HoldCalibration};

/// Gravity residuals, the gyroscope at rest, and rotation errors. Empty if no data are left to check them.
pub(super) fn improvements(calibration: &Calibration, holds: &HoldCalibration) -> Table {
    let mut table = Table::new(["", "before", "after", "unit", "smaller by", "meaning"]);
    let mut row = |name: &str, [before, after]: [f64; 2], unit: &str, meaning: &str| {
        let factor = match before / after {
            factor if factor.is_finite() => format!("{} ×", significant(factor, 3)),
            _ => UNKNOWN.into(),
        };
        table.row(vec![
            Cell::name(name),
            Cell::significant(before, 3),
            Cell::significant(after, 3),
            Cell::unit(unit),
            Cell::Number(factor),
            Cell::Words(meaning.to_owned()),
        ]);
    };
    // a fit with no more holds than parameters is exact
    if let Some(before) = holds.magnitude_residual_rms_before_mps2().filter(|_| holds.degrees_of_freedom > 0)
    {
        let meaning = "Magnitude of the mean reading of each hold less gravity, over the used holds.";
        row("|f| − g in holds, rms", [before, holds.magnitude_residual_rms_mps2], "m/s²", meaning);
    }
    if let Some(gyroscope) = &calibration.gyroscope {
        let still = &gyroscope.still;
        let rms = [still.rate_rms_before_radps, still.rate_rms_radps].map(f64::to_degrees);
        let meaning = "Mean rate in each hold, all axes together. The mean over all holds is subtracted, also before. A wandering bias and g-sensitivity remain.";
        row("rate at rest, rms", rms, "°/s", meaning);
    }
    if calibration.rotations().iter().any(|rotation| rotation.used) {
        let rms = [calibration.rotation_rms_before_rad(), calibration.rotation_rms_rad()];
        let meaning = "Angle from the gravity that the gyroscope propagates through a rotation to the measured gravity, over the used rotations.";
        row("rotation error, rms", rms.map(f64::to_degrees), "°", meaning);
    }
    table
}
