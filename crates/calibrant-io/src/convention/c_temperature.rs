//! The temperature model in the C header: coefficients, and their use in the correction functions.

use super::arrays::vector3;
use super::c_constants::{HELP, number, numbers, pair, vector};
use super::words::invalid;
use calibrant_core::sensor::{
    CalibratedImu, HIGHEST_ORDER, PER_K, SensorKind, SensorThermal, Thermal, ThermalPart,
};
use calibrant_recording::text::decoding::Checked;
use nalgebra::Vector3;
use std::fmt::Write;

/// The name of the constant with the lowest and the highest temperature of the calibration.
const RANGE: &str = "calibrant_range_c";
/// The name of the constant with the reference temperature.
const REFERENCE: &str = "calibrant_reference_c";

/// The reference temperature and the difference from it, before everything that needs it.
pub(super) fn reference(imu: &CalibratedImu) -> String {
    let thermal = &imu.parameters.thermal;
    if thermal.is_none() {
        return String::new();
    }
    let mut out = format!(
        "\n/* Temperature at which biases and matrices are given, degrees Celsius. */\n\
         static const CALIBRANT_REAL {REFERENCE} = {:?};\n",
        thermal.reference_c
    );
    let mut clamp = String::new();
    if let Some([low, high]) = thermal.range_c {
        let _ = write!(
            out,
            "\n/* Lowest and highest temperature of the calibration, degrees Celsius. Beyond them the correction is that of the\n   \
             nearer one: polynomials go astray there. Define CALIBRANT_EXTRAPOLATE for the polynomials themselves. */\n\
             static const CALIBRANT_REAL {RANGE}[2] = {{{low:?}, {high:?}}};\n"
        );
        clamp = format!(
            "#ifndef CALIBRANT_EXTRAPOLATE\n    if (temperature_c < {RANGE}[0])\n        temperature_c = {RANGE}[0];\n    \
             if (temperature_c > {RANGE}[1])\n        temperature_c = {RANGE}[1];\n#endif\n"
        );
    }
    let _ = write!(
        out,
        "\n/* Temperature above the reference, K. */\n\
         static inline CALIBRANT_REAL calibrant_tau(CALIBRANT_REAL temperature_c)\n{{\n{clamp}    return temperature_c - {REFERENCE};\n}}\n"
    );
    out
}

fn name(sensor_kind: SensorKind, part: &str, order: usize) -> String {
    format!("calibrant_{sensor_kind}_{part}_{}", PER_K[order - 1])
}

/// The coefficients of a sensor; empty where it does not follow temperature.
pub(super) fn coefficients(sensor_kind: SensorKind, terms: &SensorThermal, unit: &str) -> String {
    let mut out = String::new();
    if terms.is_none() {
        return out;
    }
    for (part, highest, values, unit) in [
        ("bias", terms.order(ThermalPart::Bias), &terms.bias, unit),
        ("scale", terms.order(ThermalPart::Scale), &terms.scale, "1"),
    ] {
        for (m, value) in values.iter().take(highest).enumerate() {
            let power = if m > 0 { format!("^{}", m + 1) } else { String::new() };
            let _ = writeln!(out, "\n/* Coefficient of tau{power} of its {part}, ({unit}) per K{power}. */");
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
pub(super) fn with_temperature(sensor_kind: SensorKind, terms: &SensorThermal, function: &str) -> String {
    // Horner's scheme: tau * (b1 + tau * (b2 + tau * b3))
    let polynomial = |part: &str, highest: usize| {
        let name = |order| format!("{}[i]", name(sensor_kind, part, order));
        let inner = (1..highest)
            .rev()
            .fold(name(highest), |inner, order| format!("({} + tau * {inner})", name(order)));
        format!("tau * {inner}")
    };
    let mut change = "    for (i = 0; i < 3; i++)\n        y[i] = ".to_owned();
    change += &match terms.order(ThermalPart::Bias) {
        0 => "y[i]".to_owned(),
        highest => format!("(y[i] - {})", polynomial("bias", highest)),
    };
    if let highest @ 1.. = terms.order(ThermalPart::Scale) {
        change += &format!("\n             / ((CALIBRANT_REAL)1 + {})", polynomial("scale", highest));
    }
    change += ";\n";
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
            "    const CALIBRANT_REAL tau = calibrant_tau(temperature_c);\n    CALIBRANT_REAL y[3];\n",
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
    thermal.range_c = pair(text, RANGE)?;
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
