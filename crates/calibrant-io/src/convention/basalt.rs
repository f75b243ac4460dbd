//! basalt's calibration (basalt-headers): writes the keys of the IMU, into a file of its own or into one that is there.
//!
//! The direction is raw → true, with the bias taken away after the matrix: `s = (1 + A) y − c`. So `A = C − 1`, `c = C b`. The `A` of the
//! accelerometer is lower triangular, that of the gyroscope full. The lists are `c`, then `A` column by column, without its zeros.
//!
//! The other keys of the object `value0` are the cameras'. An existing file keeps them byte by byte.

use super::file::CalibratedImuFile;
use super::imu_noise::ImuNoise;
use super::words::{invalid, singular};
use calibrant_core::diagnostic::convention::FormatNeeds;
use calibrant_core::diagnostic::{Diagnostic, Phrase};
use calibrant_core::sensor::SensorKind;
use calibrant_recording::text::decoding::Checked;
use nalgebra::Matrix3;
use serde_json::value::RawValue;
use std::collections::BTreeMap;
use std::ops::Range;

/// The remedy for a broken file.
const HELP: &str = "give a calibration of basalt: JSON with its keys below \"value0\"";

/// The keys of the IMU with their values.
fn entries(file: &CalibratedImuFile) -> Checked<Vec<(&'static str, String)>> {
    let mut entries = Vec::new();
    for (sensor_kind, _) in file.imu.units.present() {
        let sensor = file.imu.parameters.sensor(sensor_kind);
        let c = sensor.matrix.try_inverse().ok_or_else(|| singular(sensor_kind))?;
        let (a, bias) = (c - Matrix3::identity(), c * sensor.bias);
        let (key, places): (_, &[(usize, usize)]) = match sensor_kind {
            SensorKind::Accelerometer => {
                ("calib_accel_bias", &[(0, 0), (1, 0), (2, 0), (1, 1), (2, 1), (2, 2)])
            }
            SensorKind::Gyroscope => {
                ("calib_gyro_bias", &[(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1), (0, 2), (1, 2), (2, 2)])
            }
        };
        entries.push((key, list(bias.iter().copied().chain(places.iter().map(|&place| a[place])))));
    }
    let noise = file.noise.clone().unwrap_or_default();
    let three = |value: Option<f64>| value.map(|value| list([value; 3]));
    let ImuNoise { accelerometer_density, accelerometer_random_walk, .. } = noise;
    let known = [
        ("imu_update_rate", noise.update_rate_hz.map(|rate| format!("{rate:?}"))),
        ("accel_noise_std", three(accelerometer_density)),
        ("gyro_noise_std", three(noise.gyroscope_density)),
        ("accel_bias_std", three(accelerometer_random_walk)),
        ("gyro_bias_std", three(noise.gyroscope_random_walk)),
    ];
    entries.extend(known.into_iter().filter_map(|(key, value)| Some((key, value?))));
    Ok(entries)
}

fn list(values: impl IntoIterator<Item = f64>) -> String {
    let values: Vec<_> = values.into_iter().map(|value| format!("{:?}", value + 0.0)).collect();
    format!("[{}]", values.join(", "))
}

/// A file with the keys of the IMU alone.
pub(super) fn write(file: &CalibratedImuFile, warnings: &mut Vec<Diagnostic>) -> Checked<String> {
    let fields = vec!["the keys of the cameras".to_owned()];
    let how = Phrase("give the file that has them with option `into`".into());
    warnings.push(FormatNeeds { format: "basalt", fields, how }.into());
    let entries = entries(file)?;
    let lines: Vec<_> = entries.iter().map(|(key, value)| format!("        \"{key}\": {value}")).collect();
    Ok(format!("{{\n    \"value0\": {{\n{}\n    }}\n}}\n", lines.join(",\n")))
}

/// A file of basalt with the keys of the IMU replaced, or added where they are missing. All other bytes stay.
pub(super) fn edited(text: &str, file: &CalibratedImuFile) -> Checked<String> {
    let whole = object(text)?;
    let value = *whole.get("value0").ok_or_else(|| invalid("there is no \"value0\" in it", HELP))?;
    let below = object(value.get())?;
    let mut edits: Vec<(Range<usize>, String)> = Vec::new();
    let first = place(text, value).start + 1;
    for (key, new) in entries(file)? {
        edits.push(match below.get(key) {
            Some(old) => (place(text, old), new),
            None => (
                first..first,
                format!("\n        \"{key}\": {new}{}", if below.is_empty() { "" } else { "," }),
            ),
        });
    }
    edits.sort_by_key(|(range, _)| range.start);
    let mut out = text.to_owned();
    for (range, new) in edits.into_iter().rev() {
        out.replace_range(range, &new);
    }
    Ok(out)
}

fn object(text: &str) -> Checked<BTreeMap<String, &RawValue>> {
    serde_json::from_str(text).map_err(|error| invalid(format!("no calibration of basalt: {error}"), HELP))
}

/// Where a part of a text stands in it.
fn place(text: &str, part: &RawValue) -> Range<usize> {
    let start = part.get().as_ptr() as usize - text.as_ptr() as usize;
    start..start + part.get().len()
}
