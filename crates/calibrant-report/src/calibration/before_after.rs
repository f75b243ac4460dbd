//! The improvement by a calibration, in numbers: errors before and after it.

use crate::number_format;
use crate::sheet::{Cell, Table};
use calibrant_core::estimate::{Calibration, HoldCalibration};

/// One error: its name, its value before and after, its unit, and its meaning.
struct Improved {
    name: &'static str,
    before: f64,
    after: f64,
    unit: &'static str,
    meaning: &'static str,
}

/// Gravity residuals, the gyroscope at rest, and rotation errors. Empty if no data are left to check them.
pub(super) fn improvements(calibration: &Calibration, holds: &HoldCalibration) -> Table {
    let mut rows: Vec<Improved> = magnitude(holds).into_iter().collect();
    rows.extend(calibration.gyroscope.as_ref().map(|gyroscope| Improved {
        name: "rate at rest, rms",
        before: gyroscope.still.rate_rms_before_radps.to_degrees(),
        after: gyroscope.still.rate_rms_radps.to_degrees(),
        unit: "°/s",
        meaning: "Mean rate in each hold, all axes together. The mean over all holds is subtracted, also before. A wandering bias and g-sensitivity remain.",
    }));
    if calibration.rotations().iter().any(|rotation| rotation.used) {
        rows.push(Improved {
            name: "rotation error, rms",
            before: calibration.rotation_rms_before_rad().to_degrees(),
            after: calibration.rotation_rms_rad().to_degrees(),
            unit: "°",
            meaning: "Angle from the gravity that the gyroscope propagates through a rotation to the measured gravity, over the used rotations.",
        });
    }
    table(&rows)
}

/// `None` if the fit is exact, with no more holds than parameters.
fn magnitude(holds: &HoldCalibration) -> Option<Improved> {
    (holds.degrees_of_freedom > 0).then_some(())?;
    Some(Improved {
        name: "|f| − g in holds, rms",
        before: holds.magnitude_residual_rms_before_mps2()?,
        after: holds.magnitude_residual_rms_mps2,
        unit: "m/s²",
        meaning: "Magnitude of the mean reading of each hold less gravity, over the used holds.",
    })
}

fn table(rows: &[Improved]) -> Table {
    let mut table = Table::new(["", "before", "after", "unit", "smaller by", "meaning"]);
    for row in rows {
        let factor = match row.before / row.after {
            factor if factor.is_finite() => format!("{} ×", number_format::significant(factor, 3)),
            _ => number_format::UNKNOWN.into(),
        };
        table.row(vec![
            Cell::name(row.name),
            Cell::significant(row.before, 3),
            Cell::significant(row.after, 3),
            Cell::unit(row.unit),
            Cell::Number(factor),
            Cell::Words(row.meaning.to_owned()),
        ]);
    }
    table
}
