//! Kalibr's `imu.yaml`: reads and writes noise densities, and with the scale-misalignment model the
//! calibration.
//!
//! The direction is true → raw, as its estimator predicts readings (`IccSensors.py`, March 2024). It is
//! `y_a = M_a C_i_b f + b_a` and `y_g = M_g C_gyro_i C_i_b ω + A C_gyro_i C_i_b f + b_g`, with `f` and `ω` in
//! the body frame b. `M_a` and `M_g` are lower triangular, so the x axis of frame i lies along the
//! accelerometer's x axis. `C_i_b` is the rotation in `T_i_b`, the identity for a single IMU. So
//! `S_a = M_a C_i_b`, `S_g = M_g C_gyro_i C_i_b`, `Γ = A C_gyro_i C_i_b`. The file takes any `S`: its
//! triangular factor in `M`, the rotation in `C`.
//!
//! Readings are in m/s² and rad/s, `A` in (rad/s)/(m/s²). Kalibr estimates biases as curves in time and does
//! not write them. Our files have them as `b` beside `M`, as other programs do, which its readers ignore. In counts they
//! are under a key `calibrant`, with the unit. The file cannot carry the covariance. Numbers under a key that is not known are an error: they may be part of the model.
//!
//! # References
//! `rehder2016`, `kalibr`

use super::arrays::{matrix3, vector3};
use super::file::LARGEST;
use super::imu_noise::ImuNoise;
use super::kalibr_keys::refuse_unknown_numbers;
use super::words::{input_error, invalid, singular, unit_named, written_by};
use super::yaml::{self, UNDER_OWN_KEY, beside, line, matrix};
use super::{CalibratedImuFile, ConventionOptions, ImuFormat, RawUnits};
use calibrant_core::diagnostic::convention::{
    FormatLoses, FormatNeeds, FormatSupposed, FrameTurned, LeverArmIgnored,
};
use calibrant_core::diagnostic::{Diagnostic, Phrase};
use calibrant_core::error::{InputError, Refusal, Result};
use calibrant_core::sensor::{
    CalibratedImu, Gauge, ImuParameters, ImuQuantity, Quantity, ReadingUnit, SensorKind, SensorParameters,
};
use calibrant_recording::text::decoding::{self, Checked};
use nalgebra::{Matrix3, Vector3};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::collections::BTreeMap;
use std::path::Path;

/// The remedy for a broken file.
const HELP: &str = "give an imu.yaml as Kalibr writes it";
#[derive(Deserialize)]
struct Imu {
    model: Option<String>,
    #[serde(rename = "T_i_b")]
    t_i_b: Option<Vec<Vec<f64>>>,
    accelerometer_noise_density: Option<f64>,
    accelerometer_random_walk: Option<f64>,
    gyroscope_noise_density: Option<f64>,
    gyroscope_random_walk: Option<f64>,
    update_rate: Option<f64>,
    rostopic: Option<String>,
    accelerometers: Option<Accelerometers>,
    gyroscopes: Option<Gyroscopes>,
    calibrant: Option<Beside>,
}

#[derive(Deserialize)]
struct Accelerometers {
    #[serde(rename = "M")]
    m: Option<Vec<Vec<f64>>>,
    b: Option<Vec<f64>>,
    rx_i: Option<IgnoredAny>,
}

#[derive(Deserialize)]
struct Gyroscopes {
    #[serde(rename = "M")]
    m: Option<Vec<Vec<f64>>>,
    b: Option<Vec<f64>>,
    #[serde(rename = "A")]
    a: Option<Vec<Vec<f64>>>,
    #[serde(rename = "C_gyro_i")]
    c_gyro_i: Option<Vec<Vec<f64>>>,
}

/// Our own key.
#[derive(Deserialize)]
struct Beside {
    accelerometer_unit: Option<String>,
    accelerometer_bias: Option<Vec<f64>>,
    gyroscope_unit: Option<String>,
    gyroscope_bias: Option<Vec<f64>>,
    frame: Option<String>,
}

/// The one IMU of a file: its keys are at the top, or below `imu0`.
fn parse(text: &str) -> Checked<Imu> {
    let broken = |error: serde_saphyr::Error| {
        let error = error.without_snippet();
        let message = error.to_string();
        let mut input_error = InputError::new(
            Refusal::CalibrationInvalid,
            format!("not Kalibr's imu.yaml: {}", message.trim()),
            HELP,
        );
        if let Some(place) = error.location() {
            let message = message.split(" at line ").next().unwrap_or(&message).trim().to_owned();
            input_error.message = format!("not Kalibr's imu.yaml: {message}");
            let number = |n: u64| usize::try_from(n).unwrap_or(1).max(1);
            input_error = input_error.at_line(number(place.line())).at_column(number(place.column()));
        }
        Box::new(input_error)
    };
    let keys: BTreeMap<String, IgnoredAny> = serde_saphyr::from_str(text).map_err(broken)?;
    let is_imu = |key: &&String| {
        key.strip_prefix("imu").is_some_and(|n| !n.is_empty() && n.bytes().all(|byte| byte.is_ascii_digit()))
    };
    let imus: Vec<_> = keys.keys().filter(is_imu).collect();
    match imus.as_slice() {
        [] => serde_saphyr::from_str(text).map_err(broken),
        [one] => {
            if keys.len() > 1 {
                return Err(invalid(
                    format!("there are other keys beside {one}"),
                    "leave only the IMU in the file",
                ));
            }
            let mut imus: BTreeMap<String, Imu> = serde_saphyr::from_str(text).map_err(broken)?;
            imus.remove(*one).ok_or_else(|| invalid("the file is empty", HELP))
        }
        [one, other, ..] => Err(invalid(
            format!("the file has {one} and {other}, and one is read"),
            "leave the one that you mean in the file",
        )),
    }
}

impl Imu {
    fn noise(&self) -> Checked<Option<ImuNoise>> {
        let noise = ImuNoise {
            accelerometer_density: self.accelerometer_noise_density,
            accelerometer_random_walk: self.accelerometer_random_walk,
            gyroscope_density: self.gyroscope_noise_density,
            gyroscope_random_walk: self.gyroscope_random_walk,
            update_rate_hz: self.update_rate,
            rostopic: self.rostopic.clone(),
            ..ImuNoise::default()
        }
        .checked()?;
        Ok((noise != ImuNoise::default()).then_some(noise))
    }

    /// The noise beside a calibration. A zero stands where a program did not know it.
    fn noise_beside(&mut self, findings: &mut Vec<Diagnostic>) -> Checked<Option<ImuNoise>> {
        let fields = [
            ("accelerometer_noise_density", &mut self.accelerometer_noise_density),
            ("accelerometer_random_walk", &mut self.accelerometer_random_walk),
            ("gyroscope_noise_density", &mut self.gyroscope_noise_density),
            ("gyroscope_random_walk", &mut self.gyroscope_random_walk),
            ("update_rate", &mut self.update_rate),
        ];
        for (what, field) in fields {
            if field.take_if(|value| *value == 0.0).is_some() {
                let supposed = Phrase("0 in its place counts as not stated".into());
                findings.push(FormatSupposed { what, supposed }.into());
            }
        }
        self.noise()
    }

    /// The bias of a sensor that stands beside its matrix or under our own key, and where it stands.
    fn bias<'a>(
        sensor_kind: SensorKind,
        beside_matrix: Option<&'a Vec<f64>>,
        own: Option<&'a Vec<f64>>,
    ) -> Checked<Option<(&'a Vec<f64>, String)>> {
        let own_field = format!("calibrant.{sensor_kind}_bias");
        let field = format!("{sensor_kind}s.b");
        match (beside_matrix, own) {
            (Some(one), Some(other)) if one != other => Err(invalid(
                format!("`{field}` and `{own_field}` are two biases of one sensor"),
                "remove the wrong one",
            )),
            (Some(bias), _) => Ok(Some((bias, field))),
            (None, own) => Ok(own.map(|bias| (bias, own_field))),
        }
    }
}

/// Reads the noise densities of Kalibr's `imu.yaml`: the plain file that Kalibr reads, or one that it wrote.
///
/// # Errors
/// [`Error::Experiment`](calibrant_core::Error::Experiment) with the file: not readable, no YAML, no noise in it, a number that is not positive.
pub fn read_kalibr_noise(path: &Path) -> Result<ImuNoise> {
    decoding::parsed(path, (LARGEST, "the imu.yaml"), |bytes| {
        let noise = parse(decoding::as_text(bytes)?)?.noise()?;
        noise.ok_or_else(|| invalid("there are no noise densities in it", HELP))
    })
}

pub(super) fn read(text: &str, options: &ConventionOptions) -> Checked<CalibratedImuFile> {
    let mut imu = parse(text)?;
    let mut findings = Vec::new();
    let noise = imu.noise_beside(&mut findings)?;
    let Some(accelerometers) = &imu.accelerometers else {
        let model = imu.model.as_deref().unwrap_or("calibrated");
        return Err(invalid(
            format!("there is no calibration in it: model {model}, and no `accelerometers: M`"),
            "run Kalibr with --imu-models scale-misalignment",
        ));
    };
    refuse_unknown_numbers(text)?;
    let needed = |rows: &Option<Vec<Vec<f64>>>, field: &str| match rows {
        Some(rows) => matrix3(rows, field),
        None => Err(invalid(format!("`{field}` is missing"), HELP)),
    };
    let c_i_b = match &imu.t_i_b {
        None => Matrix3::identity(),
        Some(rows) => pose(rows, &mut findings)?,
    };
    let optional = |rows: &Option<Vec<Vec<f64>>>, field: &str, otherwise: Matrix3<f64>| match rows {
        Some(rows) => matrix3(rows, field),
        None => Ok(otherwise),
    };
    let m_a = needed(&accelerometers.m, "accelerometers.M")?;
    let beside = imu.calibrant.as_ref();
    let unit = |sensor_kind: SensorKind, stated: Option<&String>| unit_of(sensor_kind, stated, options.units);
    let stated_biases = [
        Imu::bias(
            SensorKind::Accelerometer,
            accelerometers.b.as_ref(),
            beside.and_then(|beside| beside.accelerometer_bias.as_ref()),
        )?,
        Imu::bias(
            SensorKind::Gyroscope,
            imu.gyroscopes.as_ref().and_then(|gyroscopes| gyroscopes.b.as_ref()),
            beside.and_then(|beside| beside.gyroscope_bias.as_ref()),
        )?,
    ];
    let bias = |stated: &Option<(&Vec<f64>, String)>| {
        stated.as_ref().map_or(Ok(Vector3::zeros()), |(bias, field)| vector3(bias, field))
    };
    let mut parameters = ImuParameters::identity();
    parameters[SensorKind::Accelerometer] = SensorParameters::linear(bias(&stated_biases[0])?, m_a * c_i_b);
    let accelerometer_unit =
        Some(unit(SensorKind::Accelerometer, beside.and_then(|beside| beside.accelerometer_unit.as_ref()))?);
    let gyroscope_unit = match &imu.gyroscopes {
        None => None,
        Some(gyroscopes) => {
            let c_gyro_i = optional(&gyroscopes.c_gyro_i, "gyroscopes.C_gyro_i", Matrix3::identity())?;
            rotation(&c_gyro_i, "gyroscopes.C_gyro_i")?;
            parameters[SensorKind::Gyroscope] = SensorParameters {
                bias: bias(&stated_biases[1])?,
                matrix: needed(&gyroscopes.m, "gyroscopes.M")? * c_gyro_i * c_i_b,
                ..SensorParameters::identity()
            };
            parameters.g_sensitivity =
                optional(&gyroscopes.a, "gyroscopes.A", Matrix3::zeros())? * c_gyro_i * c_i_b;
            Some(unit(SensorKind::Gyroscope, beside.and_then(|beside| beside.gyroscope_unit.as_ref()))?)
        }
    };
    if stated_biases[0].is_none() || gyroscope_unit.is_some() && stated_biases[1].is_none() {
        let supposed = Phrase("they are zero here, Kalibr estimates them as curves in time".into());
        findings.push(FormatSupposed { what: "biases", supposed }.into());
    }
    if accelerometers.rx_i.is_some() {
        let what = "the place of the accelerometer's axes (rx_i, ry_i, rz_i)";
        findings.push(LeverArmIgnored { what }.into());
    }
    let frame = beside.and_then(|beside| beside.frame.clone()).unwrap_or_else(|| {
        if c_i_b == Matrix3::identity() {
            "Kalibr's: x along the accelerometer's x axis, y in the plane of its x and y axes".into()
        } else {
            "Kalibr's body frame".into()
        }
    });
    let gyroscope = gyroscope_unit.is_some();
    let g_sensitivity = parameters.g_sensitivity != Matrix3::zeros();
    let mut quantities = ImuQuantity::full_list(true, gyroscope, g_sensitivity);
    quantities.retain(|quantity| match quantity {
        ImuQuantity::Of(sensor_kind, Quantity::Bias(_)) => stated_biases[*sensor_kind as usize].is_some(),
        _ => true,
    });
    let imu = CalibratedImu::new(parameters, [accelerometer_unit, gyroscope_unit], quantities, frame);
    Ok(CalibratedImuFile { noise, findings, ..CalibratedImuFile::new(imu, ImuFormat::Kalibr) })
}

fn unit_of(
    sensor_kind: SensorKind,
    stated: Option<&String>,
    given: Option<RawUnits>,
) -> Checked<ReadingUnit> {
    match stated {
        None => Ok(given.map_or(sensor_kind.stimulus_unit(), |units| units.unit(sensor_kind))),
        Some(stated) => unit_named(stated, sensor_kind).ok_or_else(|| {
            invalid(format!("`calibrant.{sensor_kind}_unit` is \"{stated}\""), "m/s², rad/s or counts")
        }),
    }
}

/// The rotation of `T_i_b`. Its translation is a lever arm, which the correction of a reading does not need.
fn pose(rows: &[Vec<f64>], findings: &mut Vec<Diagnostic>) -> Checked<Matrix3<f64>> {
    if rows.len() != 4 || rows.iter().any(|row| row.len() != 4) {
        return Err(invalid("`T_i_b` is not 4 × 4", HELP));
    }
    let c_i_b = Matrix3::from_fn(|row, column| rows[row][column]);
    rotation(&c_i_b, "T_i_b")?;
    if rows[..3].iter().any(|row| row[3] != 0.0) {
        findings.push(LeverArmIgnored { what: "the translation of T_i_b" }.into());
    }
    Ok(c_i_b)
}

fn rotation(c: &Matrix3<f64>, field: &str) -> Checked<()> {
    let is_one = (c * c.transpose() - Matrix3::identity()).amax() < 1e-6 && c.determinant() > 0.0;
    if is_one { Ok(()) } else { Err(invalid(format!("`{field}` is not a rotation"), HELP)) }
}

/// `L` and `Q` of `S = L Q`: lower triangular with positive diagonal, and a rotation.
pub(super) fn factors(s: &Matrix3<f64>, sensor_kind: SensorKind) -> Checked<(Matrix3<f64>, Matrix3<f64>)> {
    if s.determinant() < 0.0 {
        return Err(input_error(
            Refusal::ConversionImpossible,
            format!("the axes of the {sensor_kind} are left-handed, which Kalibr's model cannot say"),
            "one axis has the wrong sign: change the sign of its column in the recording and calibrate again",
        ));
    }
    if Gauge::Lower.is_form_of(s) && s.diagonal().min() > 0.0 {
        return Ok((*s, Matrix3::identity()));
    }
    let l = Gauge::Lower.apply(&SensorParameters::linear(Vector3::zeros(), *s)).matrix;
    let l = Matrix3::from_fn(|row, column| if column > row { 0.0 } else { l[(row, column)] });
    let q = l.try_inverse().map(|inverse| inverse * s);
    q.map(|q| (l, q)).ok_or_else(|| singular(sensor_kind))
}

pub(super) fn write(file: &CalibratedImuFile, warnings: &mut Vec<Diagnostic>) -> Checked<String> {
    let imu = &file.imu;
    if imu.unit(SensorKind::Accelerometer).is_none() {
        return Err(input_error(
            Refusal::ConversionImpossible,
            "Kalibr's imu.yaml has no place for a gyroscope alone: its frame is the accelerometer's",
            "choose another format",
        ));
    }
    let noise = file.noise.clone().unwrap_or_default();
    let (m_a, c_i_b) = factors(&imu.parameters[SensorKind::Accelerometer].matrix, SensorKind::Accelerometer)?;
    let mut out = format!("# {}: true to raw, y_a = M_a C_i_b f + b_a\nimu0:\n  T_i_b:\n", written_by());
    for row in 0..3 {
        let entries: Vec<f64> = c_i_b.row(row).iter().copied().chain([0.0]).collect();
        line(&mut out, "  - ", &entries);
    }
    line(&mut out, "  - ", &[0.0, 0.0, 0.0, 1.0]);
    let mut absent = yaml::noise(&mut out, &noise, "Kalibr");
    out.push_str("  accelerometers:\n");
    matrix(&mut out, ("    M", "    - "), &m_a);
    // counts stay under our own key: who reads `b` takes it in SI
    let is_plain =
        |sensor_kind| imu.has_bias(sensor_kind) && imu.unit(sensor_kind) != Some(ReadingUnit::Counts);
    let plain_bias = |out: &mut String, sensor_kind| {
        if is_plain(sensor_kind) {
            yaml::bias(out, "    b: ", imu, sensor_kind);
        }
    };
    plain_bias(&mut out, SensorKind::Accelerometer);
    if imu.unit(SensorKind::Gyroscope).is_some() {
        let (m_g, c_gyro_b) = factors(&imu.parameters[SensorKind::Gyroscope].matrix, SensorKind::Gyroscope)?;
        out.push_str("  gyroscopes:\n");
        matrix(&mut out, ("    A", "    - "), &(imu.parameters.g_sensitivity * c_gyro_b.transpose()));
        matrix(&mut out, ("    C_gyro_i", "    - "), &(c_gyro_b * c_i_b.transpose()));
        matrix(&mut out, ("    M", "    - "), &m_g);
        plain_bias(&mut out, SensorKind::Gyroscope);
    } else {
        absent.push("a gyroscope".into());
    }
    let has_counts =
        SensorKind::ALL.map(|sensor_kind| imu.unit(sensor_kind)).contains(&Some(ReadingUnit::Counts));
    beside(&mut out, imu, |sensor_kind| imu.has_bias(sensor_kind) && !is_plain(sensor_kind));
    out.push_str("  model: scale-misalignment\n  time_offset: 0.0\n");
    if c_i_b != Matrix3::identity() {
        warnings.push(FrameTurned { format: "Kalibr", angle_deg: None }.into());
    }
    let format = ImuFormat::Kalibr.title();
    let mut loses = |what, kept| warnings.push(FormatLoses { format, what, kept: Some(kept) }.into());
    if imu.parameters[SensorKind::Accelerometer].bias != Vector3::zeros()
        || imu.parameters[SensorKind::Gyroscope].bias != Vector3::zeros()
    {
        loses(
            "the biases",
            "as `b` beside `M`, of counts under the key `calibrant`, and Kalibr reads neither",
        );
    }
    if has_counts {
        loses("readings in counts", UNDER_OWN_KEY);
    }
    if !absent.is_empty() {
        warnings.push(FormatNeeds { format: "Kalibr", fields: absent, how: yaml::how() }.into());
    }
    Ok(out)
}
