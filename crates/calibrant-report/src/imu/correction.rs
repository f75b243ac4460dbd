//! The corrections of both sensors, to read and to copy.

use crate::html::escape;
use crate::number_format;
use crate::parameters::{gauge_in_words, matrix, rows};
use calibrant_core::estimate::ImuCalibration;
use calibrant_core::sensor::{Correction, ReadingUnit};
use nalgebra::{Matrix3, Vector3};

/// Formulas, matrices, and the same as text.
pub(super) fn correction(calibration: &ImuCalibration) -> String {
    let imu = &calibration.imu;
    let (Some(accelerometer), Some(gyroscope)) =
        (Correction::of(&imu.accelerometer), Correction::of(&imu.gyroscope))
    else {
        return "<p>A matrix has no inverse: there is no correction.</p>".to_string();
    };
    let unit = |unit: ReadingUnit, stimulus: &str| match unit {
        ReadingUnit::Counts => format!(" ({stimulus} per count)"),
        _ => String::new(),
    };
    let (a, g) = (calibration.accelerometer_unit, calibration.gyroscope_unit);
    let column = |v: &Vector3<f64>| v.iter().map(|&b| vec![number_format::significant(b, 8)]).collect();
    let felt = imu.g_sensitivity != Matrix3::zeros();
    let mut parts = vec![
        matrix(&format!("C_a{}", unit(a, "m/s²")), rows(&accelerometer.matrix)),
        matrix(&format!("b_a ({})", a.symbol()), column(&accelerometer.bias)),
        matrix(&format!("C_g{}", unit(g, "rad/s")), rows(&gyroscope.matrix)),
        matrix(&format!("b_g ({})", g.symbol()), column(&gyroscope.bias)),
    ];
    let mut formula = "f = C_a (y_a − b_a),  ω = C_g (y_g − b_g)";
    if felt {
        parts.push(matrix(&format!("Γ ({} per m/s²)", g.symbol()), rows(&imu.g_sensitivity)));
        formula = "f = C_a (y_a − b_a),  ω = C_g (y_g − b_g − Γ f)";
    }
    let thermal = &imu.thermal;
    let warm = if thermal.is_none() {
        String::new()
    } else {
        format!(
            "<p>This is the correction at T₀ = {} °C. At another temperature T, replace b by b(T) and C by C(T) = C diag(1/(1 + k₁ τ + k₂ τ²)), with τ = T − T₀, b(T) = b + b₁ τ + b₂ τ² \
             and the coefficients above; <code>calibrant apply</code> and the C header of <code>calibrant convert</code> do so.</p>",
            number_format::significant(thermal.reference_c, 3)
        )
    };
    let frame = if calibration.frame_is_known() {
        "The true frame is that of the known directions of the holds."
    } else {
        gauge_in_words(calibration.holds.gauge.name())
    };
    let words = format!(
        "f in m/s², ω in rad/s, both in the true frame. {frame} “Sensor” is the accelerometer; the gyroscope is given in the same frame, so its misalignment to \
         the accelerometer is in C_g. Digits beyond those that are known are given so that rounding adds nothing."
    );
    format!(
        "<p class=\"formula\">{}</p><div class=\"matrices\">{}</div><p>{}</p>{warm}\
         <details><summary>As text, to copy into a program</summary><pre>{}</pre></details>",
        escape(formula),
        parts.concat(),
        escape(&words),
        escape(&to_copy(&accelerometer, &gyroscope, felt.then_some(&imu.g_sensitivity)))
    )
}

/// Nested lists in brackets with plain minus signs, as Python and many others read them.
fn to_copy(accelerometer: &Correction, gyroscope: &Correction, felt: Option<&Matrix3<f64>>) -> String {
    let list = |values: &mut dyn Iterator<Item = f64>| {
        let values: Vec<String> = values.map(|value| format!("{value:.9e}")).collect();
        format!("[{}]", values.join(", "))
    };
    let matrix = |name: &str, matrix: &Matrix3<f64>| {
        let rows: Vec<String> = matrix.row_iter().map(|row| list(&mut row.iter().copied())).collect();
        let indent = format!(",\n{}", " ".repeat(name.len() + 4));
        format!("{name} = [{}]\n", rows.join(&indent))
    };
    let vector =
        |name: &str, vector: &Vector3<f64>| format!("{name} = {}\n", list(&mut vector.iter().copied()));
    let mut text = matrix("C_a", &accelerometer.matrix)
        + &vector("b_a", &accelerometer.bias)
        + &matrix("C_g", &gyroscope.matrix)
        + &vector("b_g", &gyroscope.bias);
    if let Some(felt) = felt {
        text += &matrix("G", felt);
    }
    text
}
