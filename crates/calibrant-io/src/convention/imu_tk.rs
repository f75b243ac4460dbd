//! imu_tk's `.calib`: reads and writes one sensor in 21 numbers, separated by white space. They are
//! misalignment `T` (3×3), scale `K` (3×3), bias `b` (3×1).
//!
//! The direction is raw → true: `s = T K (y − b)`. The results of imu_tk itself have the upper gauge for the
//! accelerometer (`T` upper triangular with unit diagonal). Their gyroscope has the accelerometer's frame.
//! The file itself takes any `T`, and ours has `T_ij = C_ij/C_jj`. The file names neither its sensor nor the
//! unit of its readings, so the user must give both. The reader of imu_tk stops after 21 numbers. Our files
//! go on with comment lines that give both, and are read back without questions. The file cannot carry the
//! covariance. Nor can it carry the g-sensitivity, without which the correction would be another.
//!
//! # References
//! `tedaldi2014`, `imu_tk`

use super::words::{invalid, singular, unit_named, written_by};
use super::{CalibratedImuFile, ConventionOptions, ImuFormat};
use calibrant_core::diagnostic::Phrase;
use calibrant_core::diagnostic::convention::FormatSupposed;
use calibrant_core::error::{InputError, Refusal, TaskOption};
use calibrant_core::sensor::{
    CalibratedImu, Correction, ImuParameters, ImuQuantity, ReadingUnit, SensorKind, SensorParameters,
};
use calibrant_recording::text::decoding::Checked;
use calibrant_recording::text::delimited::Lines;
use nalgebra::{Matrix3, Vector3};
use std::path::{Path, PathBuf};

/// Count of the numbers in a file.
const COUNT: usize = 21;
/// The remedy for a broken file.
const HELP: &str = "imu_tk's file has 9 numbers of the misalignment, 9 of the scale and 3 of the bias";

/// The pair of files for which a name stands where there is no file of that name.
pub(super) fn pair_instead_of(path: &Path) -> Option<[PathBuf; 2]> {
    if path.extension()? != "calib" || path.exists() {
        return None;
    }
    let pair = imu_tk_files(path);
    pair.iter().all(|path| path.exists()).then_some(pair)
}

/// `NAME_acc.calib` and `NAME_gyro.calib` for `NAME.calib`: how imu_tk's programs name their files.
pub(super) fn name_of(path: &Path, sensor_kind: SensorKind) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let ending = match sensor_kind {
        SensorKind::Accelerometer => "acc",
        SensorKind::Gyroscope => "gyro",
    };
    let extension =
        path.extension().map_or_else(String::new, |extension| format!(".{}", extension.to_string_lossy()));
    path.with_file_name(format!("{stem}_{ending}{extension}"))
}

/// The files for which `NAME.calib` may stand: `NAME_acc.calib` and `NAME_gyro.calib`.
#[must_use]
pub fn imu_tk_files(path: &Path) -> [PathBuf; 2] {
    SensorKind::ALL.map(|sensor_kind| name_of(path, sensor_kind))
}

/// The sensor that a file's name shows: `…_acc.calib`, `…_gyro.calib`.
pub(super) fn sensor_kind_of_name(path: &Path) -> Option<SensorKind> {
    let stem = path.file_stem()?.to_str()?.to_ascii_lowercase();
    let (accelerometer, gyroscope) = (stem.contains("acc"), stem.contains("gyr"));
    match (accelerometer, gyroscope) {
        (true, false) => Some(SensorKind::Accelerometer),
        (false, true) => Some(SensorKind::Gyroscope),
        _ => None,
    }
}

/// Both sensors of a pair of files.
pub(super) fn joined(accelerometer: CalibratedImuFile, gyroscope: CalibratedImuFile) -> CalibratedImuFile {
    let mut file = accelerometer;
    file.imu.parameters[SensorKind::Gyroscope] = gyroscope.imu.parameters[SensorKind::Gyroscope];
    file.imu.units[SensorKind::Gyroscope] = gyroscope.imu.unit(SensorKind::Gyroscope);
    file.imu.quantities = ImuQuantity::full_list(true, true, false);
    if gyroscope.imu.frame != file.imu.frame {
        let supposed = Phrase(file.imu.frame.clone());
        file.findings.push(FormatSupposed { what: "one true frame", supposed }.into());
    }
    file.findings.extend(
        gyroscope.findings.into_iter().filter(|finding| !file.findings.contains(finding)).collect::<Vec<_>>(),
    );
    file
}

pub(super) fn read(text: &str, options: &ConventionOptions) -> Checked<CalibratedImuFile> {
    let mut numbers = Vec::with_capacity(COUNT);
    let (mut sensor_kind, mut unit, mut frame) = (None, None, None);
    let mut last = 1;
    for line in Lines::of(text) {
        last = line.number;
        if let Some(comment) = line.text.trim().strip_prefix('#') {
            if let Some((key, value)) = comment.split_once(':') {
                match key.trim() {
                    "sensor" => {
                        sensor_kind =
                            SensorKind::ALL.into_iter().find(|sensor_kind| sensor_kind.name() == value.trim())
                    }
                    "readings in" => unit = Some(value.trim().to_owned()),
                    "frame" => frame = Some(value.trim().to_owned()),
                    _ => {}
                }
            }
            continue;
        }
        let mut from = 0;
        for word in line.text.split_ascii_whitespace() {
            let at = from + line.text[from..].find(word).unwrap_or(0);
            from = at + word.len();
            let reject = |message: String| {
                Err(Box::new(
                    InputError::new(Refusal::CalibrationInvalid, message, HELP)
                        .at_line(line.number)
                        .at_column(line.column(at)),
                ))
            };
            if numbers.len() == COUNT {
                return reject(format!("there is more than {COUNT} numbers: {word}"));
            }
            match word.parse::<f64>() {
                Ok(value) if value.is_finite() => numbers.push(value),
                _ => return reject(format!("not a number: {word}")),
            }
        }
    }
    if numbers.len() < COUNT {
        let message = format!("the file has {} of {COUNT} numbers", numbers.len());
        return Err(Box::new(InputError::new(Refusal::CalibrationInvalid, message, HELP).at_line(last)));
    }
    if let (Some(stated), Some(given)) = (sensor_kind, options.sensor_kind)
        && stated != given
    {
        return Err(invalid(
            format!("the file says that it is of the {stated}, and it was given as that of the {given}"),
            "are the two files exchanged, or is option `sensor` wrong?",
        ));
    }
    let Some(sensor_kind) = sensor_kind.or(options.sensor_kind) else {
        let message = "is this the accelerometer's or the gyroscope's? The file does not say";
        let help = "say option `sensor` accelerometer or option `sensor` gyroscope, or give the pair NAME_acc.calib and NAME_gyro.calib as NAME.calib";
        let error = InputError::new(Refusal::CalibrationInvalid, message, help);
        return Err(error.answered_by(TaskOption::Sensor, ["accelerometer", "gyroscope"]).into());
    };
    let stated = unit.as_deref().map(|stated| unit_named(stated, sensor_kind));
    let unit = match stated {
        Some(Some(unit)) => unit,
        Some(None) => {
            return Err(invalid("its unit of readings is not known", "m/s², rad/s or counts"));
        }
        None => match options.units {
            Some(units) => units.unit(sensor_kind),
            None => {
                let scale = numbers[9].abs();
                let [likely, option] = if scale < 0.1 {
                    ["counts", "counts"]
                } else {
                    [sensor_kind.stimulus_unit().symbol(), "si"]
                };
                let message = format!(
                    "in which unit are the readings of the {sensor_kind}? imu_tk's file does not say"
                );
                let help = format!(
                    "say option `unit` si or option `unit` counts; a scale of {scale} looks like {likely}: option `unit` {option}"
                );
                let error = InputError::new(Refusal::UnitUnknown, message, help);
                return Err(error.answered_by(TaskOption::Unit, ["si", "counts"]).into());
            }
        },
    };
    let matrix = |first: usize| Matrix3::from_row_slice(&numbers[first..first + 9]);
    let Some(inverse) = (matrix(0) * matrix(9)).try_inverse() else {
        return Err(singular(sensor_kind));
    };
    let sensor = SensorParameters::linear(Vector3::from_column_slice(&numbers[18..]), inverse);
    let mut parameters = ImuParameters::identity();
    let accelerometer = sensor_kind == SensorKind::Accelerometer;
    if accelerometer {
        parameters[SensorKind::Accelerometer] = sensor;
    } else {
        parameters[SensorKind::Gyroscope] = sensor;
    }
    let imu = CalibratedImu::new(
        parameters,
        [accelerometer.then_some(unit), (!accelerometer).then_some(unit)],
        ImuQuantity::full_list(accelerometer, !accelerometer, false),
        frame.unwrap_or_else(|| "imu_tk's: that of its accelerometer, z along its z axis".into()),
    );
    Ok(CalibratedImuFile::new(imu, ImuFormat::ImuTk))
}

pub(super) fn write(file: &CalibratedImuFile) -> Checked<Vec<(SensorKind, String)>> {
    let imu = &file.imu;
    let there =
        SensorKind::ALL.into_iter().filter_map(|sensor_kind| Some((sensor_kind, imu.unit(sensor_kind)?)));
    there.map(|(sensor_kind, unit)| Ok((sensor_kind, text(imu, sensor_kind, unit)?))).collect()
}

fn text(imu: &CalibratedImu, sensor_kind: SensorKind, unit: ReadingUnit) -> Checked<String> {
    let correction =
        Correction::of(imu.parameters.sensor(sensor_kind)).filter(|c| c.scale().iter().all(|&k| k != 0.0));
    let Some(correction) = correction else {
        return Err(invalid(
            format!(
                "the correction of the {sensor_kind} has a zero on its diagonal, and imu_tk's T has none"
            ),
            "turn the frame with option `gauge` upper",
        ));
    };
    // + 0.0: no negative zeros
    let row = |values: &[f64]| {
        values.iter().map(|value| format!("{:>24?}", value + 0.0)).collect::<Vec<_>>().join(" ") + "\n"
    };
    let matrix = |matrix: &Matrix3<f64>| {
        let rows = matrix.row_iter().map(|entries| row(&entries.iter().copied().collect::<Vec<_>>()));
        rows.collect::<String>() + "\n"
    };
    let bias: String = correction.bias.iter().map(|&value| row(&[value])).collect();
    Ok(format!(
        "{}{}{bias}\n# {}; raw to true: s = T K (y - b), above T, K and b\n# sensor: {sensor_kind}\n# readings in: {}\n# corrected in: {}\n# frame: {}\n",
        matrix(&correction.misalignment()),
        matrix(&Matrix3::from_diagonal(&correction.scale())),
        written_by(),
        unit.symbol(),
        sensor_kind.stimulus_unit().symbol(),
        imu.frame.replace(['\n', '\r'], " ").trim(),
    ))
}
