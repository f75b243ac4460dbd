//! The table of the parameters of one sensor, also in units of the stimulus.

use crate::number_format::{percent, significant, with_sd};
use crate::sheet::{Cell, Column, Digits, Table};
use calibrant_core::estimate::Calibration;
use calibrant_core::sensor::{
    ImuParameters, ImuQuantity, Quantity, ReadingUnit, SensorKind, SensorParameters, ThermalPart,
};

/// Standard gravity, m/s²: 1 g.
const STANDARD_GRAVITY: f64 = 9.806_65;

/// Name, estimate and sd of the parameters of one sensor.
pub(super) fn estimate_table(calibration: &Calibration, sensor_kind: SensorKind) -> Table {
    let mut table = Table::new(ESTIMATE);
    for k in calibration.places_of(sensor_kind) {
        table.row(estimate(calibration, k).into());
    }
    table
}

const ESTIMATE: [&str; 3] = ["parameter", "estimate ± sd", "unit"];

fn estimate(calibration: &Calibration, k: usize) -> [Cell; 3] {
    let parameter = &calibration.parameters[k];
    [
        Cell::name(&*parameter.name),
        Cell::estimate(calibration.values[k], calibration.sd()[k]),
        Cell::unit(parameter.unit),
    ]
}

/// Name, estimate and sd, unit, and value over the gain. Also the datasheet's
/// values, the share of the prior, and truth and error, where there are some.
pub(crate) fn parameter_table(
    calibration: &Calibration,
    sensor_kind: SensorKind,
    truth: Option<&SensorParameters>,
) -> Table {
    let places = calibration.places_of(sensor_kind);
    let parameters = || places.iter().map(|&k| &calibration.parameters[k]);
    let with_nominal = parameters().any(|parameter| parameter.nominal.is_some());
    let with_spread = parameters().any(|parameter| parameter.spread.is_some());
    let with_prior = places.iter().any(|&k| calibration.known_beforehand(k).is_some());
    let over_gain = "the parameter divided by the gain of its axis. This gives its size in m/s² or rad/s, or as a share of the stimulus";
    let prior = "the share of the information that comes from the prior and not from the data";
    let mut columns: Vec<Column> = ESTIMATE.map(Column::new).into();
    columns.push(Column::new("over the gain").noted(over_gain));
    let optional = [
        (with_nominal, vec![Column::new("nominal")]),
        (with_spread, vec![Column::new("datasheet spread"), Column::on_page("sd / spread")]),
        (with_prior, vec![Column::new("from prior").noted(prior)]),
        (truth.is_some(), vec![Column::on_page("truth"), Column::on_page("error / sd")]),
    ];
    columns.extend(optional.into_iter().filter(|(there, _)| *there).flat_map(|(_, columns)| columns));
    let mut table = Table::new(columns);
    let sds = calibration.sd();
    let short = |value: Option<f64>| value.map_or(Cell::Missing, Cell::short);
    for &k in &places {
        let (quantity, parameter) = (calibration.quantities[k], &calibration.parameters[k]);
        let (value, sd) = (calibration.values[k], sds[k]);
        let mut row: Vec<Cell> = estimate(calibration, k).into();
        row.push(Cell::Number(over_the_gain(calibration, quantity, sd)));
        if with_nominal {
            row.push(short(parameter.nominal));
        }
        if with_spread {
            let spread = parameter.spread.filter(|spread| *spread > 0.0);
            row.push(short(spread));
            row.push(spread.map_or(Cell::Missing, |spread| Cell::percent(sd / spread)));
        }
        if with_prior {
            let share = calibration.known_beforehand(k);
            row.push(share.map_or(Cell::Missing, |share| Cell::Mark(percent(share))));
        }
        if let Some(truth) = truth {
            let truth = match quantity {
                ImuQuantity::Of(SensorKind::Accelerometer, of) => Some(of.value(truth)),
                _ => None,
            };
            let rounded = |value: f64| Cell::Value { value, digits: Digits::RoundedTo(sd) };
            row.push(truth.map_or(Cell::Missing, rounded));
            row.push(truth.map_or(Cell::Missing, |truth| Cell::fixed((value - truth) / sd, 2)));
        }
        table.row(row);
    }
    table
}

/// A parameter over the gain of its axis, with the sd of this ratio. A bias is then in the unit of the stimulus, a
/// scale factor is its deviation from 1, and an off-diagonal entry is a share. For readings in counts, biases
/// and scale factors show only their sd over the gain, since the value has no meaning in SI.
fn over_the_gain(calibration: &Calibration, quantity: ImuQuantity, sd: f64) -> String {
    let sensor_kind = quantity.sensor_kind();
    let counts = calibration.unit(sensor_kind) == ReadingUnit::Counts;
    let (axis, unit, per) = match quantity {
        ImuQuantity::GSensitivity(row, _) => (row, "(rad/s)/(m/s²)", ""),
        ImuQuantity::Thermal(_, term) => {
            let per = term.per();
            match term.part {
                ThermalPart::Bias => (term.axis, sensor_kind.stimulus_unit().symbol(), per),
                ThermalPart::Scale => {
                    let value = term.value(calibration.imu.thermal.sensor(sensor_kind));
                    return in_display_unit("1", per, Some(value), sd);
                }
            }
        }
        ImuQuantity::Of(_, Quantity::Bias(axis)) => (axis, sensor_kind.stimulus_unit().symbol(), ""),
        ImuQuantity::Of(_, Quantity::Scale(_)) if !counts => {
            return in_display_unit("1", "", Some(quantity.value(&calibration.imu) - 1.0), sd);
        }
        ImuQuantity::Of(_, Quantity::Scale(axis)) => (axis, "1", ""),
        ImuQuantity::Of(_, Quantity::CrossAxis(row, _) | Quantity::Symmetric(row, _)) => (row, "1", ""),
        // of the stimulus, whatever the unit of the readings
        ImuQuantity::Of(_, Quantity::Nonlinear(term, _)) => {
            return in_display_unit(term.unit(), "", Some(quantity.value(&calibration.imu)), sd);
        }
    };
    let gain = |imu: &ImuParameters| imu.sensor(sensor_kind).matrix.row(axis.index()).norm();
    if counts && matches!(quantity, ImuQuantity::Of(_, Quantity::Bias(_) | Quantity::Scale(_))) {
        return in_display_unit(unit, per, None, sd / gain(&calibration.imu));
    }
    let (value, sd) = calibration.propagated(|imu| quantity.value(imu) / gain(imu));
    in_display_unit(unit, per, Some(value), sd)
}

/// A value with its sd, `per` something; the sd alone without a value. The unit follows from the kind of quantity
/// alone, so that a column has one unit.
fn in_display_unit(unit: &'static str, per: &str, value: Option<f64>, sd: f64) -> String {
    let (factor, symbol) = match unit {
        "(rad/s)/(m/s²)" => (STANDARD_GRAVITY.to_degrees(), "(°/s)/g"),
        "1" if per.is_empty() => (100.0, "%"),
        "1" => (1e6, "ppm"),
        _ => (1.0, unit),
    };
    match value {
        Some(value) => format!("{} {symbol}{per}", with_sd(factor * value, factor * sd)),
        None => format!("± {} {symbol}{per}", significant(factor * sd, 2)),
    }
}
