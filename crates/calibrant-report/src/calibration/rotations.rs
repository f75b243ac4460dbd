//! Tables of the rotations between holds and of the turns of known angle.

use super::quality::milliseconds;
use crate::number_format::{fixed, missed_angle};
use crate::sheet::{Cell, Column, Table};
use calibrant_core::diagnostic::RotationReason;
use calibrant_core::estimate::{Calibration, RotationResult};

/// The table of what all rotations have in common.
pub(super) fn rotation_summary(calibration: &Calibration) -> Table {
    let rotations = calibration.rotations();
    let used = calibration.used_rotations().count();
    let mut table = Table::explained();
    table.explain_on_page(
        "rotations used",
        format!("{used} of {}", rotations.len()),
        "Each gives two equations for the gyroscope.",
    );
    if used > 0 {
        table.explain_on_page(
            "rotation error, rms",
            missed_angle(calibration.rotation_rms_rad()),
            "Angle from propagated gravity to measured gravity after a rotation, over the used rotations.",
        );
        table.explain_on_page(
            "rotation error before",
            missed_angle(calibration.rotation_rms_before_rad()),
            "With one bias and one gain for all axes, or the datasheet's.",
        );
    }
    let excess = calibration.gyroscope.as_ref().map_or(0.0, |gyroscope| gyroscope.between_rotations_sd_rad);
    table.explain_on_page(
        "beyond the noise, sd per axis",
        missed_angle(excess),
        if excess > 0.0 {
            "The part of these errors that the gyroscope's noise does not explain: a wandering bias, timing, vibration. The standard deviations include it."
        } else {
            "The gyroscope's noise explains the errors."
        },
    );
    if let Some(time) = calibration.gyroscope.as_ref().and_then(|gyroscope| gyroscope.time_offset) {
        table.explain(
            "time offset of the gyroscope",
            milliseconds(&time),
            "How much later it shows movements than the accelerometer. Holds and rotations do not depend on it; a filter that fuses both sensors does.",
        );
    }
    table
}

pub(super) fn rotation_table(rotations: &[RotationResult]) -> Table {
    let columns = [
        ("holds", ""),
        ("start", "s"),
        ("end", "s"),
        ("path", "°"),
        ("peak", "°/s"),
        ("before", "°"),
        ("after", "°"),
        ("studentised", ""),
        ("used", ""),
    ];
    let mut table = Table::new(columns.map(|(heading, unit)| Column::new(heading).in_unit(unit)));
    for rotation in rotations {
        let found = |value: f64, decimals: usize| {
            if rotation.is_integrated() { Cell::fixed(value, decimals) } else { Cell::Missing }
        };
        let cells = vec![
            Cell::name(format!("{} → {}", rotation.from_hold + 1, rotation.to_hold + 1)),
            Cell::fixed(rotation.start_s, 2),
            Cell::fixed(rotation.end_s, 2),
            found(rotation.path_rad.to_degrees(), 0),
            found(rotation.peak_radps.to_degrees(), 0),
            found(rotation.error_before_rad.to_degrees(), 2),
            found(rotation.error_rad.to_degrees(), 3),
            found(rotation.studentised, 2),
        ];
        let reason = rotation.reason.unwrap_or(RotationReason::Unfit);
        table.row_used(cells, if rotation.used { None } else { Some(reason) });
    }
    table
}

pub(super) fn turn_table(calibration: &Calibration) -> Table {
    let columns = [
        ("turn", ""),
        ("start", "s"),
        ("end", "s"),
        ("made x, y, z", "°"),
        ("shown x, y, z", "°"),
        ("difference", "°"),
        ("of the angle", ""),
    ];
    let mut table = Table::new(columns.map(|(heading, unit)| Column::new(heading).in_unit(unit)));
    let checked = calibration.turns_check_the_gains();
    for (number, turn) in calibration.turns().iter().enumerate() {
        let axes = |angle: &nalgebra::Vector3<f64>| {
            angle.iter().map(|a| fixed(a.to_degrees(), 2)).collect::<Vec<_>>().join(", ")
        };
        let missed = (turn.measured_rad - turn.angle_rad).norm();
        let [difference, share] = match checked {
            true => [Cell::fixed(missed.to_degrees(), 3), Cell::percent(missed / turn.angle_rad.norm())],
            false => [Cell::Number("exact".into()), Cell::Missing],
        };
        table.row(vec![
            Cell::name((number + 1).to_string()),
            Cell::fixed(turn.start_s, 2),
            Cell::fixed(turn.end_s, 2),
            Cell::Number(axes(&turn.angle_rad)),
            Cell::Number(axes(&turn.measured_rad)),
            difference,
            share,
        ]);
    }
    table
}
