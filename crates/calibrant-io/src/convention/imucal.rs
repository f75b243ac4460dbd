//! imucal's JSON: reads and writes the fields of its `FerrarisCalibrationInfo` and
//! `TurntableCalibrationInfo`, format version 2.0.0.
//!
//! The direction of its fields is true → raw, `y_a = K_a R_a f + b_a` and `y_g = K_g R_g ω + K_ga f + b_g`.
//! It applies `f = R_a⁻¹ K_a⁻¹ (y_a − b_a)` and `ω = R_g⁻¹ K_g⁻¹ (y_g − K_ga f − b_g)`. `K` is diagonal with
//! the lengths of the rows of `S`, so the rows of `R` have length 1. The file takes any true frame; imucal's
//! own is that of the six faces. Units have names: `from_acc_unit`, `from_gyr_unit` of the readings,
//! `acc_unit`, `gyr_unit` of the corrected ones. Our files have rates in deg/s as imucal's do, and readings
//! too unless they are counts (`a.u.`). The file cannot carry the covariance, or one sensor without the
//! other.
//!
//! # References
//! `ferraris1995`, `imucal`

use super::arrays::{matrix3, rows, vector3};
use super::words::{input_error, invalid, written_by};
use super::{CalibratedImuFile, ConventionOptions, ImuFormat, RawUnits};
use crate::results::json;
use calibrant_core::diagnostic::Phrase;
use calibrant_core::diagnostic::convention::FormatSupposed;
use calibrant_core::error::{InputError, Refusal, TaskOption};
use calibrant_core::sensor::{
    CalibratedImu, ImuParameters, ImuQuantity, ReadingUnit, SensorKind, SensorParameters, Thermal,
};
use calibrant_recording::text::decoding::Checked;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// Standard gravity, m/s²: the unit g.
const G: f64 = 9.80665;
/// One degree, rad.
const DEGREE: f64 = std::f64::consts::PI / 180.0;
/// The remedy for a broken file.
const HELP: &str = "give the JSON of imucal's to_json_file";

#[derive(Serialize, Deserialize)]
#[allow(non_snake_case)] // imucal's names
struct ImucalFile {
    acc_unit: Option<String>,
    #[serde(alias = "gyro_unit")]
    gyr_unit: Option<String>,
    from_acc_unit: Option<String>,
    from_gyr_unit: Option<String>,
    comment: Option<String>,
    K_a: Option<Vec<Vec<f64>>>,
    R_a: Option<Vec<Vec<f64>>>,
    b_a: Option<Vec<f64>>,
    K_g: Option<Vec<Vec<f64>>>,
    R_g: Option<Vec<Vec<f64>>>,
    K_ga: Option<Vec<Vec<f64>>>,
    b_g: Option<Vec<f64>>,
    cal_type: Option<String>,
    #[serde(rename = "_format_version")]
    format_version: Option<String>,
}

/// The SI value of a unit; `None` for counts.
fn factor(unit: &str, sensor_kind: SensorKind) -> Option<Option<f64>> {
    match (sensor_kind, unit.trim()) {
        (_, "a.u." | "counts" | "raw" | "LSB") => Some(None),
        (SensorKind::Accelerometer, "m/s^2" | "m/s²" | "m/s**2" | "m/s2") => Some(Some(1.0)),
        (SensorKind::Accelerometer, "g") => Some(Some(G)),
        (SensorKind::Gyroscope, "rad/s") => Some(Some(1.0)),
        (SensorKind::Gyroscope, "deg/s" | "dps" | "°/s") => Some(Some(DEGREE)),
        _ => None,
    }
}

/// The unit of the readings, and the size of the file's unit in it (1 for counts).
fn unit_of_readings(
    stated: Option<&String>,
    field: &str,
    sensor_kind: SensorKind,
    given: Option<RawUnits>,
) -> Checked<(ReadingUnit, f64)> {
    let Some(stated) = stated else {
        let Some(given) = given else {
            let message = format!("in which unit are the readings of the {sensor_kind}? `{field}` is null");
            let help = "say option `unit` si or option `unit` counts";
            let error = InputError::new(Refusal::UnitUnknown, message, help);
            return Err(error.answered_by(TaskOption::Unit, ["si", "counts"]).into());
        };
        return Ok((given.unit(sensor_kind), 1.0));
    };
    match factor(stated, sensor_kind) {
        Some(Some(factor)) => Ok((sensor_kind.stimulus_unit(), factor)),
        Some(None) => Ok((ReadingUnit::Counts, 1.0)),
        None => Err(invalid(
            format!("`{field}` is \"{stated}\", which is not known"),
            "known are m/s^2, g, deg/s, rad/s and a.u. for counts",
        )),
    }
}

pub(super) fn read(text: &str, options: &ConventionOptions) -> Checked<CalibratedImuFile> {
    let fields: ImucalFile =
        serde_json::from_str(text).map_err(|error| json::broken(&error, "imucal's JSON", HELP))?;
    match fields.cal_type.as_deref() {
        Some("Ferraris" | "Turntable") => (),
        Some(other) => {
            return Err(invalid(format!("cal_type \"{other}\" is not known"), "Ferraris and Turntable are"));
        }
        None => return Err(invalid("`cal_type` is missing", HELP)),
    }
    let mut findings = Vec::new();
    match fields.format_version.as_deref() {
        Some("2.0.0") => (),
        Some(other) => {
            return Err(invalid(
                format!("format version {other} is not known"),
                "2.0.0 is, and files without one",
            ));
        }
        None => {
            let supposed = Phrase("it is of imucal before 2.0, and those that are given count".into());
            findings.push(FormatSupposed { what: "the units of its readings", supposed }.into())
        }
    }
    let matrix = |rows: &Option<Vec<Vec<f64>>>, name: &str| match rows {
        Some(rows) => matrix3(rows, name),
        None => Err(invalid(format!("`{name}` is missing"), HELP)),
    };
    let vector = |values: &Option<Vec<f64>>, name: &str| match values {
        Some(values) => vector3(values, name),
        None => Err(invalid(format!("`{name}` is missing"), HELP)),
    };
    let corrected = |stated: &Option<String>, name: &str, sensor_kind: SensorKind| match stated {
        None => Err(invalid(format!("`{name}` is missing"), HELP)),
        Some(stated) => factor(stated, sensor_kind).flatten().ok_or_else(|| {
            invalid(
                format!("`{name}` is \"{stated}\", which is not known"),
                "known are m/s^2, g, deg/s and rad/s",
            )
        }),
    };
    let (acc_unit, acc) = unit_of_readings(
        fields.from_acc_unit.as_ref(),
        "from_acc_unit",
        SensorKind::Accelerometer,
        options.units,
    )?;
    let (gyr_unit, gyr) = unit_of_readings(
        fields.from_gyr_unit.as_ref(),
        "from_gyr_unit",
        SensorKind::Gyroscope,
        options.units,
    )?;
    let force = corrected(&fields.acc_unit, "acc_unit", SensorKind::Accelerometer)?;
    let rate = corrected(&fields.gyr_unit, "gyr_unit", SensorKind::Gyroscope)?;
    let parameters = ImuParameters {
        sensors: [
            SensorParameters {
                bias: vector(&fields.b_a, "b_a")? * acc,
                matrix: matrix(&fields.K_a, "K_a")? * matrix(&fields.R_a, "R_a")? * (acc / force),
                ..SensorParameters::identity()
            },
            SensorParameters {
                bias: vector(&fields.b_g, "b_g")? * gyr,
                matrix: matrix(&fields.K_g, "K_g")? * matrix(&fields.R_g, "R_g")? * (gyr / rate),
                ..SensorParameters::identity()
            },
        ]
        .into(),
        g_sensitivity: matrix(&fields.K_ga, "K_ga")? * (gyr / force),
        thermal: Thermal::none(),
    };
    let frame =
        fields.comment.as_deref().and_then(|comment| comment.split_once("frame: ")).map(|(_, frame)| frame);
    let imu = CalibratedImu::new(
        parameters,
        [Some(acc_unit), Some(gyr_unit)],
        ImuQuantity::full_list(true, true, true),
        frame.unwrap_or("imucal's: that of the faces on which the device was put"),
    );
    Ok(CalibratedImuFile { findings, ..CalibratedImuFile::new(imu, ImuFormat::Imucal) })
}

/// `K` and `R` of `S = K R`: the lengths of the rows, and rows of length 1.
fn factors(s: &Matrix3<f64>) -> (Matrix3<f64>, Matrix3<f64>) {
    let lengths = Vector3::from_fn(|row, _| s.row(row).norm());
    (Matrix3::from_diagonal(&lengths), Matrix3::from_fn(|row, column| s[(row, column)] / lengths[row]))
}

pub(super) fn write(file: &CalibratedImuFile) -> Checked<String> {
    let imu = &file.imu;
    let (Some(acc_unit), Some(gyr_unit)) =
        (imu.unit(SensorKind::Accelerometer), imu.unit(SensorKind::Gyroscope))
    else {
        let absent = if imu.unit(SensorKind::Accelerometer).is_some() {
            SensorKind::Gyroscope
        } else {
            SensorKind::Accelerometer
        };
        return Err(input_error(
            Refusal::ConversionImpossible,
            format!("imucal's JSON wants both sensors, and there is no {absent}"),
            "choose another format",
        ));
    };
    let counts = |unit: ReadingUnit| unit == ReadingUnit::Counts;
    // one unit of the file's readings in ours; its rates are in deg/s
    let gyr = if counts(gyr_unit) { 1.0 } else { DEGREE };
    let (k_a, r_a) = factors(&imu.parameters[SensorKind::Accelerometer].matrix);
    let (k_g, r_g) = factors(&(imu.parameters[SensorKind::Gyroscope].matrix * (DEGREE / gyr)));
    let vector = |v: &Vector3<f64>| Some(v.iter().copied().collect());
    let fields = ImucalFile {
        acc_unit: Some("m/s^2".into()),
        gyr_unit: Some("deg/s".into()),
        from_acc_unit: Some(if counts(acc_unit) { "a.u." } else { "m/s^2" }.into()),
        from_gyr_unit: Some(if counts(gyr_unit) { "a.u." } else { "deg/s" }.into()),
        comment: Some(format!("{}; frame: {}", written_by(), imu.frame)),
        K_a: Some(rows(&k_a)),
        R_a: Some(rows(&r_a)),
        b_a: vector(&imu.parameters[SensorKind::Accelerometer].bias),
        K_g: Some(rows(&k_g)),
        R_g: Some(rows(&r_g)),
        K_ga: Some(rows(&(imu.parameters.g_sensitivity / gyr))),
        b_g: vector(&(imu.parameters[SensorKind::Gyroscope].bias / gyr)),
        cal_type: Some("Ferraris".into()),
        format_version: Some("2.0.0".into()),
    };
    Ok(json::to_json(&fields))
}
