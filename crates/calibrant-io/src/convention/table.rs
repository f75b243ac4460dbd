//! A calibration over temperature as a table: biases and gains every few kelvin with their standard deviations, as CSV or as arrays of a C header. Between the rows they
//! are linear.

use super::c_constants::vector;
use super::words::written_by;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::number_format::plain;
use calibrant_core::sensor::{
    Axis, CalibratedImu, ImuParameters, ImuQuantity, Quantity, SensorKind, ThermalPart,
};
use calibrant_recording::files::atomic_output::write_text;
use nalgebra::{DVector, Vector3};
use std::fmt::Write;
use std::path::Path;

/// Most rows.
const MOST_ROWS: f64 = 10_000.0;
/// Steps between two rows in which the error of a line is examined.
const BETWEEN: usize = 20;

/// What the lines between the rows err by, at most, beside the polynomials: of the bias of each sensor in its reading's unit, and of its gains, relative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TableError {
    /// The sensor.
    pub sensor_kind: SensorKind,
    /// Of its biases.
    pub bias: f64,
    /// Of its gains, as a share.
    pub scale: f64,
}

/// One sensor at the temperature of a row.
struct Row {
    bias: Vector3<f64>,
    bias_sd: Vector3<f64>,
    /// Gain over that at the reference.
    factor: Vector3<f64>,
    factor_sd: Vector3<f64>,
}

/// Writes biases and gains every `step_k` over the range of the calibration: arrays of a C header where the name ends in `.h`, otherwise CSV. Returns what linear
/// interpolation errs by.
///
/// # Errors
/// [`Error::Experiment`] where nothing follows temperature, where the range is not known, or where there would be more than 10 000 rows; [`Error::Output`] where it cannot be written.
pub fn write_temperature_table(path: &Path, imu: &CalibratedImu, step_k: f64) -> Result<Vec<TableError>> {
    let refused = |message: &str, help: &str| {
        Error::experiment(InputError::new(Refusal::CalibrationUnsuited, message, help))
    };
    let range = imu.parameters.thermal.range_c.filter(|_| imu.follows_temperature());
    let [low, high] = range.ok_or_else(|| {
        refused("this calibration does not follow temperature, or has no range", "leave the table away")
    })?;
    let steps = ((high - low) / step_k - 1e-9).ceil().max(1.0);
    if steps > MOST_ROWS {
        return Err(refused("the table would have more than 10000 rows", "take larger steps"));
    }
    let temperatures: Vec<f64> = (0..=steps as usize).map(|k| (low + k as f64 * step_k).min(high)).collect();
    let kinds: Vec<SensorKind> = imu.units.present().map(|(kind, _)| kind).collect();
    let rows = kinds
        .iter()
        .map(|kind| temperatures.iter().map(|celsius| row(imu, *kind, *celsius)).collect::<Result<Vec<_>>>())
        .collect::<Result<Vec<_>>>()?;
    let errors: Vec<TableError> =
        kinds.iter().map(|kind| of_lines(&imu.parameters, *kind, &temperatures)).collect();
    let is_header = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("h"));
    let text = match is_header {
        true => header(imu, &kinds, &temperatures, &rows, &errors),
        false => csv(imu, &kinds, &temperatures, &rows, &errors),
    };
    write_text(path, &text)?;
    Ok(errors)
}

fn row(imu: &CalibratedImu, kind: SensorKind, celsius: f64) -> Result<Row> {
    let at = imu.at(celsius)?;
    let thermal = &imu.parameters.thermal;
    let bias_sd = Axis::ALL.map(|axis| {
        let bias = ImuQuantity::Of(kind, Quantity::Bias(axis));
        let place = at.quantities.iter().position(|quantity| *quantity == bias);
        place.zip(at.covariance.as_ref()).map_or(0.0, |(k, sigma)| sigma[(k, k)]).max(0.0).sqrt()
    });
    Ok(Row {
        bias: at.parameters.sensor(kind).bias,
        bias_sd: bias_sd.into(),
        factor: thermal.sensor(kind).gain_factor(thermal.tau_k(celsius)),
        factor_sd: Axis::ALL.map(|axis| factor_sd(imu, kind, axis, thermal.tau_k(celsius))).into(),
    })
}

/// Standard deviation of the gain of an axis over that at the reference: of its terms of temperature alone.
fn factor_sd(imu: &CalibratedImu, kind: SensorKind, axis: Axis, tau_k: f64) -> f64 {
    let Some(sigma) = &imu.covariance else { return 0.0 };
    let power = |quantity: &ImuQuantity| match quantity {
        ImuQuantity::Thermal(of, term)
            if *of == kind && term.part == ThermalPart::Scale && term.axis == axis =>
        {
            term.power(tau_k)
        }
        _ => 0.0,
    };
    let row = DVector::from_iterator(imu.quantities.len(), imu.quantities.iter().map(power));
    row.dot(&(sigma * &row)).max(0.0).sqrt()
}

/// What lines between the rows err by.
fn of_lines(parameters: &ImuParameters, kind: SensorKind, temperatures: &[f64]) -> TableError {
    let thermal = &parameters.thermal;
    let at = |celsius: f64| {
        let (terms, tau_k) = (thermal.sensor(kind), thermal.tau_k(celsius));
        (terms.bias_change(tau_k), terms.gain_factor(tau_k))
    };
    let mut error = TableError { sensor_kind: kind, bias: 0.0, scale: 0.0 };
    for pair in temperatures.windows(2) {
        let (from, to) = (at(pair[0]), at(pair[1]));
        for k in 1..BETWEEN {
            let share = k as f64 / BETWEEN as f64;
            let here = at(pair[0] + share * (pair[1] - pair[0]));
            error.bias = error.bias.max((from.0.lerp(&to.0, share) - here.0).amax());
            error.scale = error.scale.max((from.1.lerp(&to.1, share) - here.1).amax());
        }
    }
    error
}

fn stated(imu: &CalibratedImu, errors: &[TableError]) -> Vec<String> {
    let of = |error: &TableError| {
        let unit = imu.unit(error.sensor_kind).map_or("", |unit| unit.symbol());
        format!(
            "{}: lines between the rows err by up to {} {unit} of the bias and {} of the gain",
            error.sensor_kind,
            plain(error.bias, 2),
            plain(error.scale, 2)
        )
    };
    errors.iter().map(of).collect()
}

fn csv(
    imu: &CalibratedImu,
    kinds: &[SensorKind],
    temperatures: &[f64],
    rows: &[Vec<Row>],
    errors: &[TableError],
) -> String {
    let mut out = format!("# {}\n", written_by());
    for line in stated(imu, errors) {
        let _ = writeln!(out, "# {line}");
    }
    out.push_str("temperature_c");
    for kind in kinds {
        let unit = imu.unit(*kind).map_or("", |unit| unit.suffix());
        for (what, ending) in [("bias", format!("_{unit}")), ("gain_factor", String::new())] {
            for (sd, axis) in ["", "_sd"].into_iter().flat_map(|sd| ["x", "y", "z"].map(|axis| (sd, axis))) {
                let _ = write!(out, ",{kind}.{what}.{axis}{sd}{ending}");
            }
        }
    }
    out.push('\n');
    for (k, celsius) in temperatures.iter().enumerate() {
        let _ = write!(out, "{celsius:?}");
        for of_sensor in rows {
            let row = &of_sensor[k];
            for value in [row.bias, row.bias_sd, row.factor, row.factor_sd].iter().flat_map(|of| of.iter()) {
                let _ = write!(out, ",{value:?}");
            }
        }
        out.push('\n');
    }
    out
}

fn header(
    imu: &CalibratedImu,
    kinds: &[SensorKind],
    temperatures: &[f64],
    rows: &[Vec<Row>],
    errors: &[TableError],
) -> String {
    let count = temperatures.len();
    let mut out = format!("/* Biases and gains of an IMU over temperature; {}.\n *\n", written_by());
    for line in stated(imu, errors) {
        let _ = writeln!(out, " * {}", line.replace('²', "^2"));
    }
    let _ = write!(
        out,
        " *\n * A reading y becomes (y - bias) / gain of its axis at the temperature: gains are over those at {:?} degrees Celsius.\n * The matrix of the C header, which is of that temperature, then corrects it.\n */\n\
         #ifndef CALIBRANT_TABLE_H\n#define CALIBRANT_TABLE_H\n\n#ifndef CALIBRANT_REAL\n#define CALIBRANT_REAL double\n#endif\n\n\
         #define CALIBRANT_TABLE_ROWS {count}\n\n/* Temperatures of the rows, degrees Celsius. */\n\
         static const CALIBRANT_REAL calibrant_table_c[CALIBRANT_TABLE_ROWS] = {{{}}};\n",
        imu.parameters.thermal.reference_c,
        temperatures.iter().map(|celsius| format!("{celsius:?}")).collect::<Vec<_>>().join(", ")
    );
    for (kind, of_sensor) in kinds.iter().zip(rows) {
        for (what, of) in [("bias", (|row| row.bias) as fn(&Row) -> Vector3<f64>), ("gain", |row| row.factor)]
        {
            let lines: Vec<String> =
                of_sensor.iter().map(|row| format!("    {},\n", vector(&of(row)))).collect();
            let _ = write!(
                out,
                "\nstatic const CALIBRANT_REAL calibrant_table_{kind}_{what}[CALIBRANT_TABLE_ROWS][3] = {{\n{}}};\n",
                lines.concat()
            );
        }
    }
    out.push_str(LOOK_UP);
    out.push_str("\n#endif\n");
    out
}

/// The look-up: linear between the rows, the nearest one outside.
const LOOK_UP: &str = "
/* The value of each axis at a temperature: linear between the rows, the first or the last row outside. */
static inline void calibrant_table_at(const CALIBRANT_REAL table[CALIBRANT_TABLE_ROWS][3], CALIBRANT_REAL temperature_c,
                                      CALIBRANT_REAL value[3])
{
    CALIBRANT_REAL share = 0;
    int row = 0, i;
    while (row < CALIBRANT_TABLE_ROWS - 2 && temperature_c > calibrant_table_c[row + 1])
        row++;
    share = (temperature_c - calibrant_table_c[row]) / (calibrant_table_c[row + 1] - calibrant_table_c[row]);
    if (share < 0)
        share = 0;
    if (share > 1)
        share = 1;
    for (i = 0; i < 3; i++)
        value[i] = table[row][i] + share * (table[row + 1][i] - table[row][i]);
}
";
