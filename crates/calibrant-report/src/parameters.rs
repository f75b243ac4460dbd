//! The table of an accelerometer's parameters, with their nominal values, and the correction that they make.

use super::table::{Cell, Table};
use super::{html, number_format};
use calibrant_core::estimate::{Calibration, Recovered};
use calibrant_core::sensor::{Axis, Correction, Quantity, ReadingUnit, Recording, SensorParameters};
use nalgebra::Matrix3;

/// Name, unit, estimate and sd, nominal value, spread; truth and error where the truth is known.
pub(super) fn parameter_table(calibration: &Calibration, truth: Option<&SensorParameters>) -> String {
    let with_spread = calibration.parameters.iter().any(|parameter| parameter.spread.is_some());
    let mut columns = vec!["parameter", "unit", "estimate ± sd", "nominal"];
    if with_spread {
        columns.extend(["datasheet spread", "sd / spread"]);
    }
    if truth.is_some() {
        columns.extend(["truth", "error / sd"]);
    }
    let mut table = Table::new("", &columns);
    for ((parameter, &value), sd) in
        calibration.parameters.iter().zip(&calibration.values).zip(calibration.sd())
    {
        let unit = if parameter.unit == "1" { "–" } else { parameter.unit };
        let mut row = vec![
            Cell::Name(parameter.name.clone()),
            Cell::Text(unit.to_string()),
            Cell::Number(number_format::with_sd(value, sd)),
            Cell::Number(parameter.nominal.map_or(number_format::UNKNOWN.to_string(), number_format::short)),
        ];
        if with_spread {
            let spread = parameter.spread.filter(|spread| *spread > 0.0);
            row.push(Cell::Number(spread.map_or(number_format::UNKNOWN.to_string(), number_format::short)));
            row.push(Cell::Number(
                spread.map_or(number_format::UNKNOWN.to_string(), |s| number_format::percent(sd / s)),
            ));
        }
        if let Some(truth) = truth {
            let truth = quantity(&parameter.name).map(|quantity| quantity.value(truth));
            row.push(Cell::Number(
                truth.map_or(number_format::UNKNOWN.to_string(), |t| number_format::rounded_to(t, sd)),
            ));
            row.push(Cell::Number(
                truth.map_or(number_format::UNKNOWN.to_string(), |t| {
                    number_format::fixed((value - t) / sd, 2)
                }),
            ));
        }
        table.row(row);
    }
    table.html()
}

/// The quantity of this name.
fn quantity(name: &str) -> Option<Quantity> {
    let axes = Axis::ALL;
    let pairs = axes.iter().flat_map(|&row| axes.iter().map(move |&column| Quantity::CrossAxis(row, column)));
    let single = axes.iter().flat_map(|&axis| [Quantity::Bias(axis), Quantity::Scale(axis)]);
    single.chain(pairs).find(|quantity| quantity.name() == name)
}

/// The correction raw → true, ready for use.
pub(super) fn correction(calibration: &Calibration, recording: &Recording) -> String {
    let unit = calibration.unit.symbol();
    let slope = if calibration.unit == ReadingUnit::Counts { " (m/s² per count)" } else { "" };
    if recording.axes == 1 {
        let (scale, bias) = (calibration.sensor.matrix[(0, 0)], calibration.sensor.bias.x);
        return format!(
            "<p class=\"formula\">s = (y − {}) / {}</p><p>y in {}, s in m/s².</p>",
            number_format::significant(bias, 7),
            number_format::significant(scale, 7),
            html::escape(unit)
        );
    }
    let Some(correction) = Correction::of(&calibration.sensor) else {
        return "<p>The matrix has no inverse: there is no correction.</p>".to_string();
    };
    let bias = correction.bias.iter().map(|&b| vec![number_format::significant(b, 8)]).collect();
    let mut parts =
        vec![matrix(&format!("C{slope}"), rows(&correction.matrix)), matrix(&format!("b ({unit})"), bias)];
    let mut words = "Seven digits are given so that rounding adds nothing; how many of them are known, the table above says.".to_string();
    if let Recovered::Holds(holds) = &calibration.recovered {
        let gains = correction.scale().iter().map(|k| vec![number_format::significant(1.0 / k, 8)]).collect();
        let gain_unit = if calibration.unit == ReadingUnit::Counts { " (counts per m/s²)" } else { "" };
        parts.push(matrix(&format!("gains 1/K{gain_unit}"), gains));
        parts.push(matrix("T", unit_diagonal(&correction.misalignment())));
        words.push_str(
            " K and T are the same correction as imu_tk writes it, s = T K (y − b), with K diagonal and T of unit diagonal.",
        );
        words.push(' ');
        words.push_str(gauge_in_words(holds.gauge.name()));
    }
    format!(
        "<p class=\"formula\">s = C (y − b)</p><div class=\"matrices\">{}</div><p>{}</p>",
        parts.concat(),
        html::escape(&words)
    )
}

/// What a gauge fixes.
pub(super) fn gauge_in_words(gauge: &str) -> &'static str {
    match gauge {
        "lower" => {
            "Gravity alone does not fix the true frame. Gauge lower (as Kalibr): S and C are lower triangular, the true x axis \
             lies along the sensor's x axis and the true y axis in its x–y plane."
        }
        "upper" => {
            "Gravity alone does not fix the true frame. Gauge upper (as imu_tk): S and C are upper triangular, the true z axis \
             lies along the sensor's z axis and the true y axis in its y–z plane."
        }
        _ => {
            "Gravity alone does not fix the true frame. Gauge symmetric: S and C are symmetric, the true frame follows the three \
             sensor axes as closely as possible together."
        }
    }
}

/// A matrix as text, row by row.
pub(super) fn rows(matrix: &Matrix3<f64>) -> Vec<Vec<String>> {
    let largest = matrix.amax();
    let text = |value: f64| {
        if value.abs() < 1e-14 * largest { "0".to_string() } else { number_format::significant(value, 7) }
    };
    (0..3).map(|row| (0..3).map(|column| text(matrix[(row, column)])).collect()).collect()
}

fn unit_diagonal(matrix: &Matrix3<f64>) -> Vec<Vec<String>> {
    let text = |row: usize, column: usize| match matrix[(row, column)] {
        _ if row == column => "1".to_string(),
        value if value.abs() < 1e-14 => "0".to_string(),
        value => number_format::fixed(value, 8),
    };
    (0..3).map(|row| (0..3).map(|column| text(row, column)).collect()).collect()
}

/// A named matrix as HTML.
pub(super) fn matrix(name: &str, rows: Vec<Vec<String>>) -> String {
    let body: String = rows
        .iter()
        .map(|row| {
            format!("<tr>{}</tr>", row.iter().map(|cell| format!("<td>{cell}</td>")).collect::<String>())
        })
        .collect();
    format!("<div class=\"matrix\"><p>{}</p><table><tbody>{body}</tbody></table></div>", html::escape(name))
}
