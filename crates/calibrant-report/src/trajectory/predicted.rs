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

/// Per parameter: sd of both trajectories, and their ratio.
pub(super) fn promised_table(
    before: (&str, &TrajectoryEvaluation),
    after: Option<(&str, &TrajectoryEvaluation)>,
) -> Table {
    let mut columns: Vec<Column> = vec!["parameter".into(), "unit".into(), format!("sd {}", before.0).into()];
    if let Some((name, _)) = after {
        columns.extend([format!("sd {name}").into(), "better by".into()]);
    }
    let mut table = Table::new(columns);
    let new = after.map(|(_, after)| sds(after));
    for (i, (quantity, old)) in before.1.quantities.iter().zip(sds(before.1)).enumerate() {
        let new = new.as_ref().map(|sd| sd[i]);
        let unit = unit(*quantity);
        let display = DisplayUnit::suited_to(unit, [old].into_iter().chain(new));
        let mut row = vec![Cell::Name(quantity.name()), display.cell(unit), Cell::sd(old, display.factor)];
        row.extend(
            new.into_iter().flat_map(|new| [Cell::sd(new, display.factor), Cell::Number(times(old / new))]),
        );
        table.row(row);
    }
    table
}
