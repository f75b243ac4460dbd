//! The corrections raw → true of the sensors, to read and to copy.

use crate::html::escape;
use crate::number_format::significant;
use calibrant_core::estimate::Calibration;
use calibrant_core::sensor::{Correction, ReadingUnit, SensorKind};
use nalgebra::{Matrix3, Vector3};

/// Formulas and matrices, also as text.
pub(super) fn correction(calibration: &Calibration) -> String {
    let imu = &calibration.imu;
    if calibration.axes() == 1 {
        return of_one_axis(calibration);
    }
    let corrections: Option<Vec<_>> = calibration
        .sensor_kinds()
        .into_iter()
        .map(|sensor_kind| Some((sensor_kind, Correction::of(imu.sensor(sensor_kind))?)))
        .collect();
    let Some(corrections) = corrections else {
        return "<p>A matrix has no inverse: there is no correction.</p>".to_string();
    };
    let column = |v: &Vector3<f64>| v.iter().map(|&b| vec![significant(b, 8)]).collect();
    let mut parts = Vec::new();
    for (sensor_kind, correction) in &corrections {
        let (unit, of) = (calibration.unit(*sensor_kind), letter(*sensor_kind));
        let slope = match unit {
            ReadingUnit::Counts => format!(" ({} per count)", sensor_kind.stimulus_unit().symbol()),
            _ => String::new(),
        };
        parts.push(matrix(&format!("C_{of}{slope}"), rows(&correction.matrix)));
        parts.push(matrix(&format!("b_{of} ({})", unit.symbol()), column(&correction.bias)));
    }
    let felt = (imu.g_sensitivity != Matrix3::zeros()).then_some(&imu.g_sensitivity);
    if let Some(felt) = felt {
        let unit = calibration.unit(SensorKind::Gyroscope).symbol();
        parts.push(matrix(&format!("Γ ({unit} per m/s²)"), rows(felt)));
    }
    let (formula, words) = match (&calibration.gyroscope, felt) {
        (None, _) => ("f = C_a (y_a − b_a)", "f in m/s², in the true frame."),
        (Some(_), None) => ("f = C_a (y_a − b_a),  ω = C_g (y_g − b_g)", BOTH),
        (Some(_), Some(_)) => ("f = C_a (y_a − b_a),  ω = C_g (y_g − b_g − Γ f)", BOTH),
    };
    let words = format!(
        "{words} {} The extra digits keep rounding from adding an error.",
        frame_in_words(calibration)
    );
    format!(
        "<p class=\"formula\">{}</p><div class=\"matrices\">{}</div><p>{}</p>{}\
         <details><summary>As text, to copy into a program</summary><pre>{}</pre></details>",
        escape(formula),
        parts.concat(),
        escape(&words),
        at_other_temperatures(calibration),
        escape(&to_copy(&corrections, felt))
    )
}

/// The frame and the units of the corrections of two sensors.
const BOTH: &str = "f in m/s², ω in rad/s, both in the true frame. The gyroscope is given in the frame of the accelerometer, so its misalignment to it is in C_g.";

fn letter(sensor_kind: SensorKind) -> char {
    match sensor_kind {
        SensorKind::Accelerometer => 'a',
        SensorKind::Gyroscope => 'g',
    }
}

fn of_one_axis(calibration: &Calibration) -> String {
    let sensor = &calibration.imu[SensorKind::Accelerometer];
    format!(
        "<p class=\"formula\">f = (y − {}) / {}</p><p>y in {}, f in m/s².</p>",
        significant(sensor.bias.x, 7),
        significant(sensor.matrix[(0, 0)], 7),
        escape(calibration.unit(SensorKind::Accelerometer).symbol())
    )
}

fn at_other_temperatures(calibration: &Calibration) -> String {
    let thermal = &calibration.imu.thermal;
    if thermal.is_none() {
        return String::new();
    }
    format!(
        "<p>This is the correction at T₀ = {} °C. At another temperature T, replace b by b(T) and C by C(T) = C diag(1/(1 + k₁ τ + k₂ τ²)), with τ = T − T₀, b(T) = b + b₁ τ + b₂ τ² \
         and the coefficients above; <code>calibrant apply</code> and the C header of <code>calibrant convert</code> do so.</p>",
        significant(thermal.reference_c, 3)
    )
}

/// The convention that fixes the true frame.
fn frame_in_words(calibration: &Calibration) -> &'static str {
    let gauge = match calibration.holds() {
        None => return "The true frame is that of the commanded motion.",
        Some(_) if calibration.frame_is_known() => {
            return "The true frame is that of the known directions of the holds.";
        }
        Some(holds) => holds.gauge.name(),
    };
    match gauge {
        "lower" => {
            "Gravity alone does not fix the true frame. Gauge lower (as Kalibr): S and C are lower triangular. The true x axis \
             lies along the sensor's x axis, and the true y axis in its x–y plane."
        }
        "upper" => {
            "Gravity alone does not fix the true frame. Gauge upper (as imu_tk): S and C are upper triangular. The true z axis \
             lies along the sensor's z axis, and the true y axis in its y–z plane."
        }
        _ => {
            "Gravity alone does not fix the true frame. Gauge symmetric: S and C are symmetric, and the true frame is as close as possible to all three \
             sensor axes."
        }
    }
}

fn rows(matrix: &Matrix3<f64>) -> Vec<Vec<String>> {
    let largest = matrix.amax();
    let text = |value: f64| {
        if value.abs() < 1e-14 * largest { "0".to_string() } else { significant(value, 7) }
    };
    (0..3).map(|row| (0..3).map(|column| text(matrix[(row, column)])).collect()).collect()
}

fn matrix(name: &str, rows: Vec<Vec<String>>) -> String {
    let row = |cells: &Vec<String>| {
        format!("<tr>{}</tr>", cells.iter().map(|cell| format!("<td>{cell}</td>")).collect::<String>())
    };
    let body: String = rows.iter().map(row).collect();
    format!("<div class=\"matrix\"><p>{}</p><table><tbody>{body}</tbody></table></div>", escape(name))
}

/// Nested lists in brackets with plain minus signs, as Python and many others read them.
fn to_copy(corrections: &[(SensorKind, Correction)], felt: Option<&Matrix3<f64>>) -> String {
    let list = |values: &mut dyn Iterator<Item = f64>| {
        let values: Vec<String> = values.map(|value| format!("{value:.9e}")).collect();
        format!("[{}]", values.join(", "))
    };
    let matrix = |name: &str, matrix: &Matrix3<f64>| {
        let rows: Vec<String> = matrix.row_iter().map(|row| list(&mut row.iter().copied())).collect();
        let indent = format!(",\n{}", " ".repeat(name.len() + 4));
        format!("{name} = [{}]\n", rows.join(&indent))
    };
    let mut text = String::new();
    for (sensor_kind, correction) in corrections {
        let of = letter(*sensor_kind);
        text += &matrix(&format!("C_{of}"), &correction.matrix);
        text += &format!("b_{of} = {}\n", list(&mut correction.bias.iter().copied()));
    }
    if let Some(felt) = felt {
        text += &matrix("G", felt);
    }
    text
}
