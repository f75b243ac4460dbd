//! Tables of the sensor's parameters, of mount and clock, and of the budget.

use super::quantity::{expected, machine_unit, of_mount};
use crate::number_format::{short, significant};
use crate::sheet::{Cell, Column, Table};
use calibrant_core::sensor::SensorKind;
use calibrant_machine::estimate::{MachineCalibration, MachineQuantity, MachineSetup};

/// From here on, correlated residuals are worth a mark.
const WIDENED: f64 = 1.05;

/// Did correlated residuals widen any sd?
pub(super) fn is_widened(calibration: &MachineCalibration) -> bool {
    calibration.inflation.iter().any(|factor| *factor > WIDENED)
}

/// By how much correlated residuals widened an sd.
fn widened(factor: f64) -> Cell {
    match factor > WIDENED {
        true => Cell::Number(format!("× {}", significant(factor, 2))),
        false => Cell::Missing,
    }
}

/// These columns, and that of [`widened`] where it says something.
fn with_widened(columns: &[Column], calibration: &MachineCalibration) -> Table {
    let further = is_widened(calibration).then(|| Column::on_page("sd widened"));
    Table::new(columns.iter().cloned().chain(further))
}

pub(super) fn sensor_table(calibration: &MachineCalibration, sensor: SensorKind) -> Table {
    let mut table = with_widened(&["parameter", "estimate ± sd", "unit"].map(Column::new), calibration);
    let sds = calibration.sd();
    for (k, quantity) in calibration.quantities.iter().enumerate() {
        let MachineQuantity::Imu(of) = quantity else { continue };
        if of.sensor_kind() != sensor {
            continue;
        }
        let (factor, unit) = machine_unit(calibration, *quantity);
        table.row(vec![
            Cell::Name(of.name()),
            Cell::estimate(factor * calibration.values[k], factor * sds[k]),
            Cell::unit(unit),
            widened(calibration.inflation[k]),
        ]);
    }
    table
}

/// Lever arm, mounting, delays, clock, tilt and gravity, beside what was known of them.
pub(super) fn mount_table(calibration: &MachineCalibration, setup: &MachineSetup) -> Table {
    let [quantity, found, expected_sd, unit] =
        ["quantity", "estimate ± sd", "expected ± prior sd", "unit"].map(Column::new);
    let columns = [quantity, found, expected_sd, unit, Column::on_page("sd / prior sd")];
    let mut table = with_widened(&columns, calibration);
    for quantity in of_mount(calibration) {
        let (factor, unit) = machine_unit(calibration, quantity);
        let before = factor * expected(setup, quantity);
        let name = Cell::Name(quantity.name(&calibration.joints));
        let Some(place) = calibration.position(quantity) else {
            let held = Cell::Number("held".into());
            table.row(vec![name, held, Cell::short(before), Cell::unit(unit), Cell::Missing, Cell::Missing]);
            continue;
        };
        let (value, sd) = (factor * calibration.values[place], factor * calibration.sd()[place]);
        let prior = factor * setup.prior_sd(quantity, calibration.noise.len());
        let [beforehand, share] = match prior.is_finite() {
            true => {
                let prior_sd = significant(prior, 3);
                let known = format!("{} ± {prior_sd}", short(before));
                [Cell::Number(known), Cell::percent(sd / prior)]
            }
            false => [Cell::Number("unknown".into()), Cell::Missing],
        };
        table.row(vec![
            name,
            Cell::estimate(value, sd),
            beforehand,
            Cell::unit(unit),
            share,
            widened(calibration.inflation[place]),
        ]);
    }
    table
}
