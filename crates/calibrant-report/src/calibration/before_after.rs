//! The improvement by a calibration, in numbers: errors before and after it.

use crate::number_format;
use crate::table::{Cell, Table};
use calibrant_core::estimate::{Calibration, HoldCalibration};

/// One error: its name, its value before and after, its unit, and its meaning.
struct Improved {
    name: &'static str,
    before: f64,
    after: f64,
    unit: &'static str,
    meaning: &'static str,
}

/// The magnitude in holds, the gyroscope at rest, and gravity after rotations; empty where nothing is left to check them.
pub(super) fn improvements(calibration: &Calibration, holds: &HoldCalibration) -> String {
    let mut rows: Vec<Improved> = magnitude(holds).into_iter().collect();
    rows.extend(calibration.gyroscope.as_ref().map(|gyroscope| Improved {
        name: "rate shown at rest, rms",
        before: gyroscope.still.rate_rms_before_radps.to_degrees(),
        after: gyroscope.still.rate_rms_radps.to_degrees(),
        unit: "°/s",
        meaning: "Mean rate in each hold, all axes together. Its mean over all holds is taken out before, too: what is left is a bias that wanders, and g-sensitivity.",
    }));
    if calibration.rotations().iter().any(|rotation| rotation.used) {
        rows.push(Improved {
            name: "gravity after a rotation, rms",
            before: calibration.rotation_rms_before_rad().to_degrees(),
            after: calibration.rotation_rms_rad().to_degrees(),
            unit: "°",
            meaning: "Angle between gravity carried by the gyroscope through a rotation and gravity found after it, over the rotations that were used.",
        });
    }
    table(&rows)
}

/// `None` where the fit to the holds is exact, with no more of them than parameters.
fn magnitude(holds: &HoldCalibration) -> Option<Improved> {
    (holds.degrees_of_freedom > 0).then_some(())?;
    Some(Improved {
        name: "|f| − g in holds, rms",
        before: holds.magnitude_residual_rms_before_mps2()?,
        after: holds.magnitude_residual_rms_mps2,
        unit: "m/s²",
        meaning: "Magnitude of the mean reading of each hold less gravity, over the holds that were used.",
    })
}

fn table(rows: &[Improved]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let mut table = Table::new("", &["", "before → after, smaller by", "what it means"]);
    for row in rows {
        let factor = row.before / row.after;
        let factor = if factor.is_finite() {
            format!(", {}×", number_format::significant(factor, 3))
        } else {
            String::new()
        };
        let [before, after] = [row.before, row.after].map(|value| number_format::significant(value, 3));
        table.row(vec![
            Cell::Name(row.name.to_string()),
            Cell::Number(format!("{before} → {after} {}{factor}", row.unit)),
            Cell::Words(row.meaning.to_string()),
        ]);
    }
    table.html()
}
