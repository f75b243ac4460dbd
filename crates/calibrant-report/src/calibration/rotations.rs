//! Tables of the rotations between holds and of the turns of known angle.

use super::quality::milliseconds;
use crate::number_format;
use crate::table::{Cell, Table};
use calibrant_core::diagnostic::RotationReason;
use calibrant_core::estimate::{Calibration, RotationResult};

/// The table of what all rotations have in common.
pub(super) fn rotation_summary(calibration: &Calibration) -> String {
    let rotations = calibration.rotations();
    let used = calibration.used_rotations().count();
    let mut table = Table::explained();
    let mut row = |name: &str, value: String, meaning: &str| table.explain(name, value, meaning);
    row(
        "rotations used",
        format!("{used} of {}", rotations.len()),
        "Each gives two equations for the gyroscope.",
    );
    if used > 0 {
        row(
            "rotation error, rms",
            number_format::missed_angle(calibration.rotation_rms_rad()),
            "Angle from propagated gravity to measured gravity after a rotation, over the used rotations.",
        );
        row(
            "rotation error before",
            number_format::missed_angle(calibration.rotation_rms_before_rad()),
            "With one bias and one gain for all axes, or the datasheet's.",
        );
    }
    let excess = calibration.gyroscope.as_ref().map_or(0.0, |gyroscope| gyroscope.between_rotations_sd_rad);
    row(
        "beyond the noise, sd per axis",
        number_format::missed_angle(excess),
        if excess > 0.0 {
            "The part of these errors that the gyroscope's noise does not explain: a wandering bias, timing, vibration. The standard deviations include it."
        } else {
            "The gyroscope's noise explains the errors."
        },
    );
    if let Some(time) = calibration.gyroscope.as_ref().and_then(|gyroscope| gyroscope.time_offset) {
        row(
            "time offset of the gyroscope",
            milliseconds(&time),
            "How much later it shows movements than the accelerometer. Holds and rotations do not depend on it; a filter that fuses both sensors does.",
        );
    }
    table.html()
}

/// One row for each rotation.
pub(super) fn rotation_table(rotations: &[RotationResult]) -> String {
    let columns = [
        "holds",
        "start (s)",
        "end (s)",
        "path (°)",
        "peak (°/s)",
        "before (°)",
        "after (°)",
        "studentised",
        "used",
    ];
    let mut table = Table::new("", &columns);
    for rotation in rotations {
        let found = |value: f64, decimals: usize| {
            let known = rotation.is_integrated();
            Cell::Number(if known {
                number_format::fixed(value, decimals)
            } else {
                number_format::UNKNOWN.to_string()
            })
        };
        let mut cells = vec![
            Cell::Name(format!("{} → {}", rotation.from_hold + 1, rotation.to_hold + 1)),
            Cell::Number(number_format::fixed(rotation.start_s, 2)),
            Cell::Number(number_format::fixed(rotation.end_s, 2)),
            found(rotation.path_rad.to_degrees(), 0),
            found(rotation.peak_radps.to_degrees(), 0),
            found(rotation.error_before_rad.to_degrees(), 2),
            found(rotation.error_rad.to_degrees(), 3),
            found(rotation.studentised, 2),
        ];
        if rotation.used {
            cells.push(Cell::Text("yes".to_string()));
            table.row(cells);
        } else {
            let reason = rotation.reason.unwrap_or(RotationReason::Unfit);
            cells.push(Cell::Mark(format!("no: {reason}")));
            table.row_left_out(cells);
        }
    }
    table.html()
}

/// One row for each turn of known angle.
pub(super) fn turn_table(calibration: &Calibration) -> String {
    let columns = [
        "turn",
        "start (s)",
        "end (s)",
        "made x, y, z (°)",
        "shown x, y, z (°)",
        "difference (°)",
        "of the angle",
    ];
    let mut table = Table::new("", &columns);
    let checked = calibration.turns_check_the_gains();
    for (number, turn) in calibration.turns().iter().enumerate() {
        let axes = |angle: &nalgebra::Vector3<f64>| {
            angle.iter().map(|a| number_format::fixed(a.to_degrees(), 2)).collect::<Vec<_>>().join(", ")
        };
        let missed = (turn.measured_rad - turn.angle_rad).norm();
        table.row(vec![
            Cell::Name((number + 1).to_string()),
            Cell::Number(number_format::fixed(turn.start_s, 2)),
            Cell::Number(number_format::fixed(turn.end_s, 2)),
            Cell::Number(axes(&turn.angle_rad)),
            Cell::Number(axes(&turn.measured_rad)),
            Cell::Number(if checked { number_format::fixed(missed.to_degrees(), 3) } else { "exact".into() }),
            Cell::Number(if checked {
                number_format::percent(missed / turn.angle_rad.norm())
            } else {
                "–".into()
            }),
        ]);
    }
    table.html()
}
