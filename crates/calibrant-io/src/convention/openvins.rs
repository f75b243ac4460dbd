//! OpenVINS' `kalibr_imu_chain.yaml`, model `kalibr`: reads and writes the intrinsics of an IMU.
//!
//! The direction is true → raw: `a = Ta⁻¹ (y_a − b_a)`, `ω = R_IMUtoGYROᵀ Tw⁻¹ (y_g − b_g − Tg a)`. So `S_a = Ta`,
//! `S_g = Tw R_IMUtoGYRO`, `Γ = Tg`. The frame is the accelerometer's: `Ta` and `Tw` are lower triangular. OpenVINS inverts them and keeps
//! that triangle of the inverse without a word, so the zeros are exact, and a file with other numbers there is not read. `Tg` takes the
//! force in the IMU's frame; Kalibr's `A` takes it in the gyroscope's.
//!
//! Biases are states of the filter. Their first guesses are keys of another file, `estimator_config.yaml`, and stand in comments. Our own
//! key `calibrant` has them, too. The file is read by OpenCV, which wants its first line, and lists deeper than their keys.

use super::arrays::{Rows, matrix3, vector3};
use super::file::CalibratedImuFile;
use super::format::ImuFormat;
use super::imu_noise::ImuNoise;
use super::kalibr::factors;
use super::words::{input_error, invalid, unit_named, written_by};
use super::yaml::{self, UNDER_OWN_KEY, beside, line, matrix, number, put};
use calibrant_core::diagnostic::convention::{FormatLoses, FormatNeeds, FormatSupposed};
use calibrant_core::diagnostic::{Diagnostic, Phrase};
use calibrant_core::error::Refusal;
use calibrant_core::sensor::{
    CalibratedImu, Gauge, ImuParameters, ImuQuantity, Quantity, SensorKind, SensorParameters,
};
use calibrant_recording::text::decoding::Checked;
use nalgebra::{Matrix3, Vector3};
use serde::Deserialize;
use std::collections::BTreeMap;

/// The remedy for a broken file.
const HELP: &str = "give a kalibr_imu_chain.yaml as OpenVINS reads it, with the model `kalibr`";

/// A row begins so: deeper than its key, as OpenCV wants it.
const ROW: &str = "    - ";

pub(super) fn write(file: &CalibratedImuFile, warnings: &mut Vec<Diagnostic>) -> Checked<String> {
    let imu = &file.imu;
    let p = &imu.parameters;
    if let Some(absent) = SensorKind::ALL.into_iter().find(|kind| imu.unit(*kind).is_none()) {
        let message = format!("OpenVINS wants both sensors, and there is no {absent}");
        return Err(input_error(Refusal::ConversionImpossible, message, "choose another format"));
    }
    let (t_w, r_imu_to_gyro) = factors(&p[SensorKind::Gyroscope].matrix, SensorKind::Gyroscope)?;
    let mut out = format!("%YAML:1.0\n# {}: true to raw, y_a = Ta a + b_a\nimu0:\n  T_i_b:\n", written_by());
    for row in 0..4 {
        line(&mut out, ROW, &[0, 1, 2, 3].map(|column| f64::from(u8::from(row == column))));
    }
    let absent = yaml::noise(&mut out, &file.noise.clone().unwrap_or_default(), "OpenVINS");
    out.push_str("  time_offset: 0.0\n  model: \"kalibr\"\n");
    matrix(&mut out, ("  Tw", ROW), &t_w);
    matrix(&mut out, ("  R_IMUtoGYRO", ROW), &r_imu_to_gyro);
    matrix(&mut out, ("  Ta", ROW), &p[SensorKind::Accelerometer].matrix);
    matrix(&mut out, ("  R_IMUtoACC", ROW), &Matrix3::identity());
    matrix(&mut out, ("  Tg", ROW), &p.g_sensitivity);
    beside(&mut out, imu, |sensor_kind| imu.has_bias(sensor_kind));
    out.push_str("# OpenVINS estimates the biases. Its first guesses are keys of estimator_config.yaml:\n");
    for (key, kind) in
        [("init_dyn_bias_a", SensorKind::Accelerometer), ("init_dyn_bias_g", SensorKind::Gyroscope)]
    {
        let bias: Vec<_> = p[kind].bias.iter().map(|&value| number(value)).collect();
        put(&mut out, format_args!("# {key}: [{}]\n", bias.join(", ")));
    }
    let format = ImuFormat::OpenVins.title();
    warnings.push(FormatLoses { format, what: "the biases", kept: Some(UNDER_OWN_KEY) }.into());
    if !absent.is_empty() {
        warnings.push(FormatNeeds { format: "OpenVINS", fields: absent, how: yaml::how() }.into());
    }
    Ok(out)
}

#[derive(Deserialize)]
struct Chain {
    imu0: Imu,
}

#[derive(Deserialize)]
#[allow(non_snake_case, reason = "names of the file")]
struct Imu {
    model: String,
    Tw: Rows,
    Ta: Rows,
    R_IMUtoACC: Rows,
    R_IMUtoGYRO: Rows,
    Tg: Rows,
    accelerometer_noise_density: Option<f64>,
    accelerometer_random_walk: Option<f64>,
    gyroscope_noise_density: Option<f64>,
    gyroscope_random_walk: Option<f64>,
    update_rate: Option<f64>,
    rostopic: Option<String>,
    #[serde(default)]
    calibrant: BTreeMap<String, serde_json::Value>,
}

pub(super) fn read(text: &str) -> Checked<CalibratedImuFile> {
    let text = text.trim_start().strip_prefix("%YAML:1.0").unwrap_or(text);
    let Chain { imu0: imu } = serde_saphyr::from_str(text)
        .map_err(|error| invalid(format!("not OpenVINS' IMU: {}", error.without_snippet()), HELP))?;
    let read = |rows: &Rows, name: &str| matrix3(rows, name);
    let (t_a, t_w) = (read(&imu.Ta, "Ta")?, read(&imu.Tw, "Tw")?);
    let rotation = read(&imu.R_IMUtoGYRO, "R_IMUtoGYRO")?;
    let is_lower = |name: &str, matrix: &Matrix3<f64>| match Gauge::Lower.is_form_of(matrix) {
        true => Ok(()),
        false => Err(invalid(
            format!("`{name}` is not lower triangular: OpenVINS would use a part of its inverse only"),
            HELP,
        )),
    };
    if imu.model == "rpng" || read(&imu.R_IMUtoACC, "R_IMUtoACC")? != Matrix3::identity() {
        return Err(invalid("its model is not `kalibr`, the one that is read", HELP));
    }
    is_lower("Ta", &t_a)?;
    is_lower("Tw", &t_w)?;
    if (rotation * rotation.transpose() - Matrix3::identity()).amax() > 1e-6 || rotation.determinant() < 0.0 {
        return Err(invalid("`R_IMUtoGYRO` is not a rotation", HELP));
    }
    let mut parameters = ImuParameters::identity();
    let mut units = [None; 2];
    let mut has_bias = [false; 2];
    for (kind, matrix) in [(SensorKind::Accelerometer, t_a), (SensorKind::Gyroscope, t_w * rotation)] {
        let own = |key: &str| imu.calibrant.get(&format!("{kind}_{key}"));
        let stated: Option<Vec<f64>> = own("bias").and_then(|bias| serde_json::from_value(bias.clone()).ok());
        has_bias[kind as usize] = stated.is_some();
        let bias =
            stated.map_or(Ok(Vector3::zeros()), |bias| vector3(&bias, &format!("calibrant.{kind}_bias")))?;
        parameters[kind] = SensorParameters::linear(bias, matrix);
        let unit = own("unit").and_then(|unit| unit_named(unit.as_str()?, kind));
        units[kind as usize] = Some(unit.unwrap_or(kind.stimulus_unit()));
    }
    parameters.g_sensitivity = read(&imu.Tg, "Tg")?;
    let mut quantities = ImuQuantity::full_list(true, true, parameters.g_sensitivity != Matrix3::zeros());
    quantities.retain(|quantity| match quantity {
        ImuQuantity::Of(kind, Quantity::Bias(_)) => has_bias[*kind as usize],
        _ => true,
    });
    let mut findings = Vec::new();
    if has_bias != [true; 2] {
        let supposed = Phrase("they are zero here, OpenVINS estimates them".into());
        findings.push(FormatSupposed { what: "biases", supposed }.into());
    }
    let frame = imu.calibrant.get("frame").and_then(|frame| frame.as_str());
    let frame =
        frame.unwrap_or("OpenVINS': x along the accelerometer's x axis, y in the plane of its x and y axes");
    let noise = ImuNoise {
        accelerometer_density: imu.accelerometer_noise_density,
        accelerometer_random_walk: imu.accelerometer_random_walk,
        gyroscope_density: imu.gyroscope_noise_density,
        gyroscope_random_walk: imu.gyroscope_random_walk,
        update_rate_hz: imu.update_rate,
        rostopic: imu.rostopic,
        ..ImuNoise::default()
    };
    let noise = Some(noise.checked()?);
    let imu = CalibratedImu::new(parameters, units, quantities, frame);
    Ok(CalibratedImuFile { noise, findings, ..CalibratedImuFile::new(imu, ImuFormat::OpenVins) })
}
