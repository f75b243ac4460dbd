//! Tables of the sensor's parameters, of mount and clock, and of the budget.

use super::budget::{bars, shares};
use super::quantity::{expected, machine_unit, of_mount};
use crate::figure::source_in_words;
use crate::number_format::{short, significant};
use crate::sheet::{Cell, Column, Section, Shown, Table};
use calibrant_core::sensor::{ImuQuantity, SensorKind};
use calibrant_machine::estimate::{MachineCalibration, MachineQuantity, MachineSetup, Source};

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

/// The part of each source: as bars and in standard deviations on a page, in per cent on a terminal.
pub(super) fn budget<'a>(section: &mut Section<'a>, calibration: &'a MachineCalibration) {
    section.table(shares(&calibration.budget).shown(Shown::OnTerminal));
    section.drawn(|| bars(&calibration.budget, |quantity| unit_of(calibration, quantity)));
    let mut within = Section::default();
    within.table(deviations(calibration));
    within.paragraph("Each number is a standard deviation. Their squares add up to that of the sd.");
    section.folded("Table of the budget", within);
}

fn unit_of(calibration: &MachineCalibration, quantity: ImuQuantity) -> &'static str {
    machine_unit(calibration, MachineQuantity::Imu(quantity)).1
}

fn deviations(calibration: &MachineCalibration) -> Table {
    let mut columns = vec!["parameter".to_string(), "sd".into()];
    columns.extend(Source::ALL.map(source_in_words));
    columns.push("unit".into());
    let mut table = Table::new(columns);
    for row in &calibration.budget {
        let sd = |variance: f64| Cell::significant(variance.max(0.0).sqrt(), 2);
        let mut cells = vec![Cell::Name(row.quantity.name()), sd(row.variance)];
        cells.extend(row.parts.map(sd));
        cells.push(Cell::unit(unit_of(calibration, row.quantity)));
        table.row(cells);
    }
    table
}
