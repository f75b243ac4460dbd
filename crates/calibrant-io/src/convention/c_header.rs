//! Writes and reads a C header with the correction: constants with all their digits and a function for each
//! sensor (C99 and C++).
//!
//! The direction is raw → true: `f = C_a (y_a − b_a)`, `ω = C_g (y_g − b_g − G f)`. Comments of the header
//! give units and frame. The type of the numbers is the macro `CALIBRANT_REAL`. It is `double` unless it is
//! defined before (as `float` for small processors). The header cannot carry the covariance. Our own headers
//! are read back by the names of their constants. Where the calibration follows temperature, the functions
//! take the temperature as an argument.

use super::arrays::vector3;
use super::c_constants::{HELP, matrix, numbers, vector};
use super::words::{invalid, singular, written_by};
use super::{CalibratedImuFile, ImuFormat, c_nonlinearity, c_temperature};
use calibrant_core::sensor::{
    CalibratedImu, ImuCorrection, ImuParameters, ImuQuantity, ReadingUnit, SensorKind, SensorParameters,
};
use calibrant_recording::text::decoding::Checked;
use nalgebra::Matrix3;
use std::fmt::Write;

pub(super) fn write(file: &CalibratedImuFile) -> Checked<String> {
    // firmware has the counts of its sensor
    let imu = &file.imu.in_counts();
    let correction = ImuCorrection::of(imu).map_err(|error| invalid(error.to_string(), ""))?;
    let mut out = format!(
        "/* Correction of an IMU, raw to true; {}.\n *\n * frame: {}\n",
        written_by(),
        comment(&imu.frame)
    );
    for sensor_kind in SensorKind::ALL {
        if let Some(unit) = imu.unit(sensor_kind) {
            let si = sensor_kind.stimulus_unit().symbol();
            let _ = writeln!(
                out,
                " * {sensor_kind}: readings in {}, corrected in {}",
                ascii(unit.symbol()),
                ascii(si)
            );
        }
    }
    for input in &file.inputs {
        let _ = writeln!(out, " * recording: {} (SHA-256 {})", comment(&input.file), comment(&input.sha256));
    }
    out.push_str(
        " *\n * Define CALIBRANT_REAL as float before including this for single precision.\n */\n\
         #ifndef CALIBRANT_IMU_H\n#define CALIBRANT_IMU_H\n\n\
         #ifndef CALIBRANT_REAL\n#define CALIBRANT_REAL double\n#endif\n",
    );
    out.push_str(&c_temperature::reference(imu));
    for (sensor_kind, of) in
        [(SensorKind::Accelerometer, correction.accelerometer), (SensorKind::Gyroscope, correction.gyroscope)]
    {
        let (Some(of), Some(unit)) = (of, imu.unit(sensor_kind)) else { continue };
        let (unit, si) = (ascii(unit.symbol()), ascii(sensor_kind.stimulus_unit().symbol()));
        let _ = writeln!(out, "\n/* Bias of the {sensor_kind}, {unit}. */");
        let _ = writeln!(
            out,
            "static const CALIBRANT_REAL calibrant_{sensor_kind}_bias[3] = {};",
            vector(&of.bias)
        );
        let _ = writeln!(out, "\n/* Matrix of its correction, ({si}) per ({unit}). */");
        let _ = writeln!(
            out,
            "static const CALIBRANT_REAL calibrant_{sensor_kind}_matrix[3][3] = {};",
            matrix(&of.matrix)
        );
        let terms = imu.parameters.thermal.sensor(sensor_kind);
        out.push_str(&c_temperature::coefficients(sensor_kind, terms, &unit));
        let function = |at_reference: &str| match terms.is_none() {
            true => at_reference.to_owned(),
            false => c_temperature::with_temperature(sensor_kind, terms, at_reference),
        };
        match sensor_kind {
            SensorKind::Accelerometer => {
                let sensor = &imu.parameters[SensorKind::Accelerometer];
                out.push_str(&c_nonlinearity::coefficients(sensor));
                // temperature comes first
                out.push_str(&c_nonlinearity::straightened(
                    sensor,
                    &function(&in_unit(ACCELEROMETER, &unit)),
                ));
                let at = if terms.is_none() { "" } else { " at the reference temperature" };
                out.push_str(&c_nonlinearity::forward(sensor, &unit, at));
            }
            SensorKind::Gyroscope => {
                let _ = writeln!(out, "\n/* What it shows of specific force, ({unit}) per (m/s^2). */");
                let _ = writeln!(
                    out,
                    "static const CALIBRANT_REAL calibrant_gyroscope_g_sensitivity[3][3] = {};",
                    matrix(&correction.g_sensitivity)
                );
                out.push_str(&function(&in_unit(GYROSCOPE, &unit)));
            }
        }
    }
    out.push_str("\n#endif\n");
    Ok(out)
}

/// The correction function of the accelerometer.
const ACCELEROMETER: &str = "
/* Specific force (m/s^2) of a reading of the accelerometer. */
static inline void calibrant_correct_accelerometer(const CALIBRANT_REAL raw[3], CALIBRANT_REAL force[3])
{
    CALIBRANT_REAL y[3];
    int i;
    for (i = 0; i < 3; i++)
        y[i] = raw[i] - calibrant_accelerometer_bias[i];
    for (i = 0; i < 3; i++)
        force[i] = calibrant_accelerometer_matrix[i][0] * y[0] + calibrant_accelerometer_matrix[i][1] * y[1]
                 + calibrant_accelerometer_matrix[i][2] * y[2];
}
";

/// The correction function of the gyroscope.
const GYROSCOPE: &str = "
/* Angular rate (rad/s) of a reading of the gyroscope, at the corrected specific force (m/s^2; zeros where it is not known). */
static inline void calibrant_correct_gyroscope(const CALIBRANT_REAL raw[3], const CALIBRANT_REAL force[3],
                                               CALIBRANT_REAL rate[3])
{
    CALIBRANT_REAL y[3];
    int i;
    for (i = 0; i < 3; i++)
        y[i] = raw[i] - calibrant_gyroscope_bias[i]
             - (calibrant_gyroscope_g_sensitivity[i][0] * force[0] + calibrant_gyroscope_g_sensitivity[i][1] * force[1]
                + calibrant_gyroscope_g_sensitivity[i][2] * force[2]);
    for (i = 0; i < 3; i++)
        rate[i] = calibrant_gyroscope_matrix[i][0] * y[0] + calibrant_gyroscope_matrix[i][1] * y[1]
                + calibrant_gyroscope_matrix[i][2] * y[2];
}
";

/// A function whose comment says the unit of the reading that it takes.
fn in_unit(function: &str, unit: &str) -> String {
    function.replacen(" of a reading of the", &format!(" of a reading ({unit}) of the"), 1)
}

/// A unit in ASCII.
fn ascii(unit: &str) -> String {
    unit.replace('²', "^2")
}

/// A text that cannot end a comment.
fn comment(text: &str) -> String {
    text.replace("*/", "* /").replace(['\n', '\r'], " ")
}

pub(super) fn read(text: &str) -> Checked<CalibratedImuFile> {
    let mut parameters = ImuParameters::identity();
    let mut units = [None, None];
    for (sensor_kind, unit) in SensorKind::ALL.into_iter().zip(&mut units) {
        let Some(correction) = numbers(text, &format!("calibrant_{sensor_kind}_matrix"), 9)? else {
            continue;
        };
        let name = format!("calibrant_{sensor_kind}_bias");
        let bias = numbers(text, &name, 3)?.ok_or_else(|| invalid(format!("`{name}` is missing"), HELP))?;
        let Some(matrix) = Matrix3::from_row_slice(&correction).try_inverse() else {
            return Err(singular(sensor_kind));
        };
        let mut sensor = SensorParameters::linear(vector3(&bias, &name)?, matrix);
        *unit = Some(unit_of(text, sensor_kind)?);
        match sensor_kind {
            SensorKind::Accelerometer => {
                sensor.nonlinearity = c_nonlinearity::read(text)?;
                parameters[SensorKind::Accelerometer] = sensor;
            }
            SensorKind::Gyroscope => {
                parameters[SensorKind::Gyroscope] = sensor;
                if let Some(entries) = numbers(text, "calibrant_gyroscope_g_sensitivity", 9)? {
                    parameters.g_sensitivity = Matrix3::from_row_slice(&entries);
                }
            }
        }
    }
    if units == [None, None] {
        return Err(invalid(
            "there is no `calibrant_accelerometer_matrix` and no `calibrant_gyroscope_matrix` in it",
            HELP,
        ));
    }
    let g_sensitivity = parameters.g_sensitivity != Matrix3::zeros();
    parameters.thermal = c_temperature::read(text)?;
    let mut quantities = ImuQuantity::full_list(units[0].is_some(), units[1].is_some(), g_sensitivity);
    let all = ImuQuantity::all(units[0].is_some(), units[1].is_some()).into_iter();
    let terms: Vec<_> = all.filter(|of| !quantities.contains(of) && of.value(&parameters) != 0.0).collect();
    quantities.extend(terms);
    let frame = text.lines().find_map(|line| line.strip_prefix(" * frame: ")).unwrap_or("not said");
    let imu = CalibratedImu::new(parameters, units, quantities, frame.trim());
    Ok(CalibratedImuFile::new(imu, ImuFormat::CHeader))
}

fn unit_of(text: &str, sensor_kind: SensorKind) -> Checked<ReadingUnit> {
    let before = format!(" * {sensor_kind}: readings in ");
    let stated = text.lines().find_map(|line| line.strip_prefix(&before)?.split(',').next());
    let stated = stated
        .ok_or_else(|| invalid(format!("the comment with the unit of the {sensor_kind} is missing"), HELP))?;
    [sensor_kind.stimulus_unit(), ReadingUnit::Counts]
        .into_iter()
        .find(|unit| ascii(unit.symbol()) == stated.trim())
        .ok_or_else(|| invalid(format!("the unit of the {sensor_kind} is \"{}\"", stated.trim()), HELP))
}
