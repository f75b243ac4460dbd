//! Predicted standard deviations of trajectories.

use crate::design::times;
use crate::figure::DisplayUnit;
use crate::number_format::significant;
use crate::sheet::{Cell, Column, Table};
use calibrant_core::sensor::{Axis, ImuQuantity, Quantity, SensorKind};
use calibrant_machine_design::TrajectoryEvaluation;

/// Standard deviations of the symmetric parts of the matrices, `(m_ij + m_ji)/2`, which no turn of the mounting changes to first order.
fn symmetric(of: &TrajectoryEvaluation) -> Vec<(String, &'static str, f64)> {
    let place = |sensor: SensorKind, i: Axis, j: Axis| {
        let wanted = ImuQuantity::Of(sensor, Quantity::CrossAxis(i, j));
        of.quantities.iter().position(|quantity| *quantity == wanted)
    };
    let pairs = [(Axis::X, Axis::Y), (Axis::X, Axis::Z), (Axis::Y, Axis::Z)];
    let all = SensorKind::ALL.into_iter().flat_map(|sensor| pairs.map(|(i, j)| (sensor, i, j)));
    all.filter_map(|(sensor, i, j)| {
        let (a, b) = (place(sensor, i, j)?, place(sensor, j, i)?);
        let variance =
            of.covariance.as_ref().map_or(f64::INFINITY, |c| (c[(a, a)] + 2.0 * c[(a, b)] + c[(b, b)]) / 4.0);
        Some((format!("{sensor} symmetric {i}{j}"), unit(of.quantities[a]), variance.sqrt()))
    })
    .collect()
}

/// `1.24 times smaller`, or `1.07 times larger`.
pub(super) fn smaller(times: f64) -> String {
    match times >= 1.0 {
        true => format!("{} times smaller", significant(times, 3)),
        false => format!("{} times larger", significant(1.0 / times, 3)),
    }
}

/// Mean of ratios, by their logarithms; `None` of none.
pub(super) fn mean_ratio(ratios: &[f64]) -> Option<f64> {
    let sum: f64 = ratios.iter().map(|ratio| ratio.ln()).sum();
    (!ratios.is_empty()).then(|| (sum / ratios.len() as f64).exp())
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
    let each = |of: &TrajectoryEvaluation| -> Vec<(String, &'static str, f64)> {
        let single =
            of.quantities.iter().zip(of.sd()).map(|(quantity, sd)| (quantity.name(), unit(*quantity), sd));
        single.chain(symmetric(of)).collect()
    };
    let all: Vec<_> = [first].iter().chain(others).chain(best.as_ref()).map(|(_, of)| each(of)).collect();
    for (i, (name, unit, _)) in all[0].iter().enumerate() {
        let of_this: Vec<f64> = all.iter().map(|sds| sds[i].2).collect();
        let display = DisplayUnit::suited_to(unit, of_this.iter().copied());
        let mut row = vec![Cell::name(name), display.cell(unit)];
        row.extend(of_this.iter().map(|sd| Cell::sd(*sd, display.factor)));
        if best.is_some() {
            row.push(Cell::Number(times(of_this[0] / of_this[of_this.len() - 1])));
        }
        table.row(row);
    }
    table
}
