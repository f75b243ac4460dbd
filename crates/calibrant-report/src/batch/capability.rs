//! How each parameter scatters over the sensors, as a table: the numbers of the charts, and the capability where there are limits.

use super::control::Control;
use super::sensors::Batch;
use crate::number_format::{short, with_sd};
use crate::sheet::{Cell, Column, Table};

/// A row for each parameter that enough sensors have.
pub(super) fn capability(batch: &Batch) -> Table {
    let has_limits = batch.parameters.iter().any(|of| of.accepted.is_some());
    let mut columns: Vec<Column> = vec![
        "parameter".into(),
        "unit".into(),
        "mean".into(),
        "control limits".into(),
        Column::new("beyond").noted(
            "the sensors beyond the control limits, of those that give them; chance alone puts 0.27 % there",
        ),
    ];
    if has_limits {
        columns.push("acceptance limits".into());
        columns.push(Column::new("Cpk").noted(
            "the distance from the mean to the nearer acceptance limit, in half widths of the control limits, ± its standard deviation (ISO 22514-2). \
             Good: 1.33 or more",
        ));
    }
    let mut table = Table::new(columns).on_page();
    for (place, parameter) in batch.parameters.iter().enumerate() {
        let Some(control) = Control::of(batch, place) else { continue };
        let digits = |value: f64| with_digits(value, control.half_width);
        let range = |[low, high]: [f64; 2]| Cell::Number(format!("{} to {}", digits(low), digits(high)));
        let beyond = control.beyond(batch, place).len();
        let mut cells = vec![
            Cell::name(parameter.name.as_str()),
            Cell::unit(parameter.unit),
            Cell::Number(digits(control.mean)),
            range(control.ends()),
            Cell::Number(format!("{beyond} of {}", control.sensors)),
        ];
        if has_limits {
            let limits = parameter.accepted;
            cells.push(limits.map_or(Cell::Missing, |(low, high)| {
                Cell::Number(format!("{} to {}", short(low), short(high)))
            }));
            cells.push(limits.map_or(Cell::Missing, |limits| {
                let (index, sd) = control.capability(limits);
                if index.is_finite() { Cell::Number(with_sd(index, sd)) } else { Cell::Missing }
            }));
        }
        table.row(cells);
    }
    table
}

/// A value with three digits of the half width of its limits.
fn with_digits(value: f64, half_width: f64) -> String {
    let decimals = 2 - half_width.log10().floor() as i32;
    crate::number_format::fixed(value, decimals.clamp(0, 12) as usize)
}
