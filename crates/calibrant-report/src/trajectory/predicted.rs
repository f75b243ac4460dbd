//! Predicted standard deviations of trajectories.

use crate::design::times;
use crate::figure::DisplayUnit;
use crate::sheet::{Cell, Column, Table};
use calibrant_core::sensor::ImuQuantity;
use calibrant_machine_design::TrajectoryEvaluation;

/// Standard deviations of the parameters; infinite where they are not determined.
fn sds(of: &TrajectoryEvaluation) -> Vec<f64> {
    match &of.covariance {
        Some(covariance) => covariance.diagonal().iter().map(|variance| variance.sqrt()).collect(),
        None => vec![f64::INFINITY; of.quantities.len()],
    }
}

/// The unit of a parameter whose readings are in SI units.
pub(super) fn unit(quantity: ImuQuantity) -> &'static str {
    quantity.unit(quantity.sensor_kind().stimulus_unit())
}

/// Per parameter: sd of each trajectory, and how many times smaller that of the last is than that of the first.
pub(super) fn promised_table(
    first: (&str, &TrajectoryEvaluation),
    others: &[(&str, &TrajectoryEvaluation)],
    best: Option<(&str, &TrajectoryEvaluation)>,
) -> Table {
    let mut columns: Vec<Column> = vec!["parameter".into(), "unit".into(), format!("sd {}", first.0).into()];
    columns.extend(others.iter().map(|(name, _)| Column::on_page(format!("sd {name}"))));
    if let Some((name, _)) = best {
        columns.extend([format!("sd {name}").into(), "better by".into()]);
    }
    let mut table = Table::new(columns);
    let all: Vec<Vec<f64>> =
        [first].iter().chain(others).chain(best.as_ref()).map(|(_, of)| sds(of)).collect();
    for (i, quantity) in first.1.quantities.iter().enumerate() {
        let of_this: Vec<f64> = all.iter().map(|sds| sds[i]).collect();
        let unit = unit(*quantity);
        let display = DisplayUnit::suited_to(unit, of_this.iter().copied());
        let mut row = vec![Cell::Name(quantity.name()), display.cell(unit)];
        row.extend(of_this.iter().map(|sd| Cell::sd(*sd, display.factor)));
        if best.is_some() {
            row.push(Cell::Number(times(of_this[0] / of_this[of_this.len() - 1])));
        }
        table.row(row);
    }
    table
}
