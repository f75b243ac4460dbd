//! The table of gains and angles between the axes of the sensors. No choice of the true frame changes them.

use crate::sheet::{Cell, Column, Section, Table};
use calibrant_core::estimate::Calibration;
use calibrant_core::sensor::{ImuQuantity, Invariant, InvariantValue, Quantity};
use std::f64::consts::FRAC_PI_2;

/// Angles between axes that should be at right angles, and between those that should be the same.
/// Nothing where the model has no such angles.
pub(super) fn axes(section: &mut Section<'_>, calibration: &Calibration) {
    let is_cross = |quantity: &ImuQuantity| {
        matches!(quantity, ImuQuantity::Of(_, Quantity::CrossAxis(..) | Quantity::Symmetric(..)))
    };
    if calibration.gyroscope.is_none() && !calibration.quantities.iter().any(is_cross) {
        return;
    }
    let mut table = Table::new([
        Column::new("angle between"),
        Column::new("angle ± sd").in_unit("°"),
        Column::new("misalignment").in_unit("mrad"),
    ]);
    for angle in calibration.calibrated().invariants() {
        let name = match angle.invariant {
            Invariant::Angle(sensor_kind, one, other) => format!("{sensor_kind} {one}, {other}"),
            Invariant::AngleBetween(a, g) if a == g => format!("{a} of both sensors"),
            _ => continue,
        };
        table.row(row(name, &angle));
    }
    section.subheading("Axes");
    section.table(table);
    section.explanation(
        "These do not depend on the choice of the true frame. Misalignment: the distance from a right angle, or from the same (or the opposite) \
         direction for axes of both sensors. An angle near zero has no sd of its own.",
    );
}

fn row(name: String, angle: &InvariantValue) -> Vec<Cell> {
    let right = (angle.value / FRAC_PI_2).round() * FRAC_PI_2;
    let shown = |value: f64, factor: f64, decimals: usize| match angle.sd {
        Some(sd) => Cell::estimate(factor * value, factor * sd),
        None => Cell::fixed(factor * value, decimals),
    };
    vec![Cell::Name(name), shown(angle.value, 1f64.to_degrees(), 3), shown(angle.value - right, 1e3, 2)]
}
