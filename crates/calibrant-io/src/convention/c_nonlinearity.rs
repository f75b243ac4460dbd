//! Terms that bend the accelerometer's response, in the C header: coefficients, the straightening in the correction, and the reading of a force.

use super::arrays::vector3;
use super::c_constants::{matrix, numbers, vector};
use calibrant_core::sensor::{NonlinearTerm, Nonlinearity, SensorParameters};
use calibrant_recording::text::decoding::Checked;
use std::fmt::Write;

/// Steps of Newton's method in C: each squares an error of a few per cent.
const STEPS: usize = 4;

fn name(term: NonlinearTerm) -> String {
    format!("calibrant_accelerometer_{}", term.name())
}

/// The sum of the terms, of the variable `u` of axis `i`.
fn sum(of: usize) -> String {
    let one = |term: NonlinearTerm| format!("{}[i] * ({})", name(term), term.in_c()[of]);
    NonlinearTerm::ALL.map(one).join(" + ")
}

/// The constants; empty where the response is linear.
pub(super) fn coefficients(sensor: &SensorParameters) -> String {
    let mut out = String::new();
    if sensor.nonlinearity.is_none() {
        return out;
    }
    let _ =
        writeln!(out, "\n/* Gain of each axis: the norm of its row of the inverse of the matrix above. */");
    let _ = writeln!(
        out,
        "static const CALIBRANT_REAL calibrant_accelerometer_gain[3] = {};",
        vector(&sensor.gains())
    );
    for term in NonlinearTerm::ALL {
        let (unit, values) = (term.unit().replace('²', "^2"), vector(sensor.nonlinearity.of(term)));
        let _ = writeln!(
            out,
            "\n/* Coefficient of {} of the force u along each axis, {unit}. */",
            term.in_c()[0]
        );
        let _ = writeln!(out, "static const CALIBRANT_REAL {}[3] = {values};", name(term));
    }
    out
}

/// The correction function with the straightening before its last step.
pub(super) fn straightened(sensor: &SensorParameters, function: &str) -> String {
    if sensor.nonlinearity.is_none() {
        return function.to_owned();
    }
    let result = "    for (i = 0; i < 3; i++)\n        force[i] =";
    let straighten = format!(
        "    for (i = 0; i < 3; i++) {{\n        const CALIBRANT_REAL v = y[i] / calibrant_accelerometer_gain[i];\n        CALIBRANT_REAL u = v;\n        int k;\n        for (k = 0; k < {STEPS}; k++)\n            u -= (u + {} - v)\n                 / (1 + {});\n        y[i] = calibrant_accelerometer_gain[i] * u;\n    }}\n",
        sum(0),
        sum(1)
    );
    function.replacen(result, &format!("{straighten}{result}"), 1)
}

/// The function that gives the reading of a force; empty where the response is linear. `at`: ` at …`, where it is of one temperature only.
pub(super) fn forward(sensor: &SensorParameters, unit: &str, at: &str) -> String {
    if sensor.nonlinearity.is_none() {
        return String::new();
    }
    format!(
        "\n/* Its response before it is bent, ({unit}) per (m/s^2). */\nstatic const CALIBRANT_REAL calibrant_accelerometer_response[3][3] = {};\n
/* Reading ({unit}) of the accelerometer of a specific force (m/s^2): the inverse of its correction{at}. */
static inline void calibrant_read_accelerometer(const CALIBRANT_REAL force[3], CALIBRANT_REAL raw[3])
{{
    int i;
    for (i = 0; i < 3; i++) {{
        const CALIBRANT_REAL u = (calibrant_accelerometer_response[i][0] * force[0]
                                  + calibrant_accelerometer_response[i][1] * force[1]
                                  + calibrant_accelerometer_response[i][2] * force[2]) / calibrant_accelerometer_gain[i];
        raw[i] = calibrant_accelerometer_bias[i] + calibrant_accelerometer_gain[i] * (u + {});
    }}
}}
",
        matrix(&sensor.matrix),
        sum(0)
    )
}

/// The terms that a header contains.
pub(super) fn read(text: &str) -> Checked<Nonlinearity> {
    let mut nonlinearity = Nonlinearity::default();
    for term in NonlinearTerm::ALL {
        let name = name(term);
        if let Some(found) = numbers(text, &name, 3)? {
            *nonlinearity.of_mut(term) = vector3(&found, &name)?;
        }
    }
    Ok(nonlinearity)
}
