//! Tables of the sensor's parameters, of mount and clock, and of the budget.

use super::quantity::{expected, machine_unit, of_mount};
use crate::figure::{budget_bars, source_in_words};
use crate::number_format;
use crate::table::{Cell, Table};
use calibrant_core::sensor::SensorKind;
use calibrant_machine::estimate::{MachineCalibration, MachineQuantity, MachineSetup, Source};

/// From here on, correlated residuals are worth a mark.
const WIDENED: f64 = 1.05;

/// Did correlated residuals widen any sd?
pub(super) fn is_widened(calibration: &MachineCalibration) -> bool {
    calibration.inflation.iter().any(|factor| *factor > WIDENED)
}

/// By how much correlated residuals widened an sd.
fn widened(factor: f64) -> Cell {
    Cell::Number(if factor > WIDENED {
        format!("× {}", number_format::significant(factor, 2))
    } else {
        "–".into()
    })
}

/// The parameters of one sensor.
pub(super) fn sensor_table(calibration: &MachineCalibration, sensor: SensorKind) -> String {
    let columns = ["parameter", "estimate ± sd", "unit", "sd widened"];
    let mut table = Table::new("", &columns[..if is_widened(calibration) { 4 } else { 3 }]);
    let sds = calibration.sd();
    for (k, quantity) in calibration.quantities.iter().enumerate() {
        let MachineQuantity::Imu(of) = quantity else { continue };
        if of.sensor_kind() != sensor {
            continue;
        }
        let (factor, unit) = machine_unit(calibration, *quantity);
        let mut cells = vec![
            Cell::Name(of.name()),
            Cell::Number(number_format::with_sd(factor * calibration.values[k], factor * sds[k])),
            Cell::Text(if unit == "1" { "–" } else { unit }.to_string()),
        ];
        cells.extend(is_widened(calibration).then(|| widened(calibration.inflation[k])));
        table.row(cells);
    }
    table.html()
}

/// Lever arm, mounting, delays, clock, tilt and gravity, beside what was known of them.
pub(super) fn mount_table(calibration: &MachineCalibration, setup: &MachineSetup) -> String {
    let columns = ["quantity", "estimate ± sd", "expected ± prior sd", "unit", "sd / prior sd", "sd widened"];
    let count = if is_widened(calibration) { 6 } else { 5 };
    let mut table = Table::new("", &columns[..count]);
    for quantity in of_mount(calibration) {
        let (factor, unit) = machine_unit(calibration, quantity);
        let before = factor * expected(setup, quantity);
        let name = Cell::Name(quantity.name(&calibration.joints));
        let Some(place) = calibration.position(quantity) else {
            let held = number_format::short(before);
            let none = || Cell::Number(number_format::UNKNOWN.into());
            let mut cells = vec![
                name,
                Cell::Number("held".into()),
                Cell::Number(held),
                Cell::Text(unit.into()),
                none(),
                none(),
            ];
            cells.truncate(count);
            table.row(cells);
            continue;
        };
        let (value, sd) = (factor * calibration.values[place], factor * calibration.sd()[place]);
        let prior = factor * setup.prior_sd(quantity, calibration.noise.len());
        let beforehand = match prior.is_finite() {
            true => format!("{} ± {}", number_format::short(before), number_format::significant(prior, 2)),
            false => "unknown".into(),
        };
        let share = if prior.is_finite() {
            number_format::percent(sd / prior)
        } else {
            number_format::UNKNOWN.into()
        };
        let mut cells = vec![
            name,
            Cell::Number(number_format::with_sd(value, sd)),
            Cell::Number(beforehand),
            Cell::Text(unit.into()),
            Cell::Number(share),
            widened(calibration.inflation[place]),
        ];
        cells.truncate(count);
        table.row(cells);
    }
    table.html()
}

/// The budget as bars, and as a table of the part of each source.
pub(super) fn budget(calibration: &MachineCalibration) -> String {
    let rows: Vec<(String, String, [f64; Source::ALL.len()])> = calibration
        .budget
        .iter()
        .map(|row| {
            let unit = machine_unit(calibration, MachineQuantity::Imu(row.quantity)).1;
            let sd = number_format::uncertainty(row.variance.sqrt());
            let sd = if unit == "1" { sd } else { format!("{sd} {unit}") };
            (row.quantity.name(), sd, row.parts.map(|part| part / row.variance))
        })
        .collect();
    let mut columns = vec!["parameter".to_string(), "sd".into()];
    columns.extend(Source::ALL.map(source_in_words));
    columns.push("unit".into());
    let mut table = Table::new("", &columns.iter().map(String::as_str).collect::<Vec<_>>());
    for row in &calibration.budget {
        let number = |variance: f64| {
            Cell::Number(match variance {
                none if none <= 0.0 => "0".into(),
                _ => number_format::significant(variance.sqrt(), 2),
            })
        };
        let unit = machine_unit(calibration, MachineQuantity::Imu(row.quantity)).1;
        let mut cells = vec![Cell::Name(row.quantity.name()), number(row.variance)];
        cells.extend(row.parts.map(number));
        cells.push(Cell::Text(if unit == "1" { "–" } else { unit }.to_string()));
        table.row(cells);
    }
    format!(
        "{}<details><summary>Table of the budget</summary>{}<p>Each number is a standard deviation. Their squares add up to that of the sd.</p></details>",
        budget_bars(&rows),
        table.html()
    )
}
