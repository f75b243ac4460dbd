//! The temperature model in the C header: coefficients, and their use in the correction functions.

use super::arrays::vector3;
use super::c_constants::{HELP, number, numbers, vector};
use super::words::invalid;
use calibrant_core::sensor::{CalibratedImu, HIGHEST_ORDER, SensorKind, SensorThermal, Thermal};
use calibrant_recording::text::decoding::Checked;
use nalgebra::Vector3;
use std::fmt::Write;

/// The words before the range of temperature, in a comment of the header.
const RANGE: &str = " * temperatures of the calibration: ";
/// The name of the constant with the reference temperature.
const REFERENCE: &str = "calibrant_reference_c";

/// The lines of the head of the file.
pub(super) fn head(imu: &CalibratedImu) -> String {
    match imu.parameters.thermal.range_c {
        Some([low, high]) if imu.follows_temperature() => {
            format!("{RANGE}{low:?} to {high:?} degrees Celsius\n")
        }
        _ => String::new(),
    }
}

/// The reference temperature, before everything that needs it.
pub(super) fn reference(imu: &CalibratedImu) -> String {
    if imu.parameters.thermal.is_none() {
        return String::new();
    }
    format!(
        "\n/* Temperature at which biases and matrices are given, degrees Celsius. */\n\
         static const CALIBRANT_REAL {REFERENCE} = {:?};\n",
        imu.parameters.thermal.reference_c
    )
}

fn name(sensor_kind: SensorKind, part: &str, order: usize) -> String {
    let power = if order > 1 { order.to_string() } else { String::new() };
    format!("calibrant_{sensor_kind}_{part}_per_k{power}")
}

/// The coefficients of a sensor; empty where it does not follow temperature.
pub(super) fn coefficients(sensor_kind: SensorKind, terms: &SensorThermal, unit: &str) -> String {
    let mut out = String::new();
    if terms.is_none() {
        return out;
    }
    for (part, values, unit) in [("bias", &terms.bias, unit), ("scale", &terms.scale, "1")] {
        for (m, value) in values.iter().enumerate() {
            let power = if m > 0 { format!("^{}", m + 1) } else { String::new() };
            let _ = writeln!(out, "\n/* What 1 K does to its {part}, ({unit}) per K{power}. */");
            let _ = writeln!(
                out,
                "static const CALIBRANT_REAL {}[3] = {};",
                name(sensor_kind, part, m + 1),
                vector(value)
            );
        }
    }
    out
}

/// The correction function of a sensor that follows temperature. The temperature is its second argument.
pub(super) fn with_temperature(sensor_kind: SensorKind, function: &str) -> String {
    let change = format!(
        "    for (i = 0; i < 3; i++)\n        y[i] = (y[i] - tau * ({b1}[i] + tau * {b2}[i]))\n             / ((CALIBRANT_REAL)1 + tau * ({k1}[i] + tau * {k2}[i]));\n",
        b1 = name(sensor_kind, "bias", 1),
        b2 = name(sensor_kind, "bias", 2),
        k1 = name(sensor_kind, "scale", 1),
        k2 = name(sensor_kind, "scale", 2),
    );
    let result = match sensor_kind {
        SensorKind::Accelerometer => "    for (i = 0; i < 3; i++)\n        force[i] =",
        SensorKind::Gyroscope => "    for (i = 0; i < 3; i++)\n        rate[i] =",
    };
    function
        .replacen(
            "const CALIBRANT_REAL raw[3], ",
            "const CALIBRANT_REAL raw[3], CALIBRANT_REAL temperature_c, ",
            1,
        )
        .replacen(
            "    CALIBRANT_REAL y[3];\n",
            &format!(
                "    const CALIBRANT_REAL tau = temperature_c - {REFERENCE};\n    CALIBRANT_REAL y[3];\n"
            ),
            1,
        )
        .replacen(result, &format!("{change}{result}"), 1)
        .replacen(" of the ", ", at a temperature in degrees Celsius, of the ", 1)
}

/// The temperature model that a header contains.
pub(super) fn read(text: &str) -> Checked<Thermal> {
    let mut thermal = Thermal::none();
    let Some(reference_c) = number(text, REFERENCE)? else { return Ok(thermal) };
    thermal.reference_c = reference_c;
    thermal.range_c = text.lines().find_map(|line| {
        let (low, high) = line.strip_prefix(RANGE)?.strip_suffix(" degrees Celsius")?.split_once(" to ")?;
        Some([low.parse().ok()?, high.parse().ok()?])
    });
    for sensor_kind in SensorKind::ALL {
        let terms = &mut thermal[sensor_kind];
        for (part, values) in [("bias", &mut terms.bias), ("scale", &mut terms.scale)] {
            for order in 1..=HIGHEST_ORDER {
                let name = name(sensor_kind, part, order);
                values[order - 1] = match numbers(text, &name, 3)? {
                    Some(found) => vector3(&found, &name)?,
                    None => Vector3::zeros(),
                };
            }
        }
    }
    if thermal.is_none() {
        return Err(invalid(format!("`{REFERENCE}` is there, and no temperature term"), HELP));
    }
    Ok(thermal)
}
