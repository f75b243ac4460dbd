//! What other programs make of a reading with the file that is written for them: their formulas, from their code.

use calibrant::io::{CalibratedImuFile, ImuFormat, calibrated_imu_texts};
use nalgebra::{Matrix3, Vector3};
use serde_json::Value;
use std::collections::BTreeMap;

/// Corrects readings of both sensors at a temperature.
pub(super) fn corrected(
    file: &CalibratedImuFile,
    format: ImuFormat,
) -> impl Fn(&[Vector3<f64>; 2], f64) -> [Vector3<f64>; 2] + use<> {
    let text = calibrated_imu_texts(file, format).expect("carried").remove(0).1;
    let json: Value = serde_json::from_str(&text).unwrap_or_default();
    let parameters = parameters(&text);
    move |raw, celsius| match format {
        ImuFormat::OpenVins => openvins(&text, raw),
        ImuFormat::ImuFusion => imufusion(&text, raw),
        ImuFormat::Basalt => basalt(&json, raw),
        ImuFormat::LibRealSense => librealsense(&json, raw),
        ImuFormat::Px4 => px4(&parameters, raw, celsius),
        ImuFormat::ArduPilot => ardupilot(&parameters, raw, celsius),
        other => panic!("{} has tests of its own", other.name()),
    }
}

/// The first numbers behind a word in a text.
fn numbers<const N: usize>(text: &str, after: &str) -> [f64; N] {
    let (_, text) = text.split_once(after).unwrap_or_else(|| panic!("{after}: {text}"));
    let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || "+-.".contains(c)));
    let mut found = words.filter_map(|word| word.parse::<f64>().ok());
    std::array::from_fn(|_| found.next().expect("a number"))
}

/// `VioManagerOptions.h`, `Propagator.cpp`: of the inverses, one triangle is kept.
fn openvins(text: &str, raw: &[Vector3<f64>; 2]) -> [Vector3<f64>; 2] {
    let matrix = |name: &str| Matrix3::from_row_slice(&numbers::<9>(text, &format!("  {name}:\n")));
    let kept = |name: &str| matrix(name).try_inverse().expect("regular").lower_triangle();
    let bias = |name: &str| Vector3::from(numbers::<3>(text, &format!("# {name}:")));
    let a = matrix("R_IMUtoACC").transpose() * kept("Ta") * (raw[0] - bias("init_dyn_bias_a"));
    let rate = raw[1] - bias("init_dyn_bias_g") - matrix("Tg") * a;
    [a, matrix("R_IMUtoGYRO").transpose() * kept("Tw") * rate]
}

/// `FusionCalibration.h`.
fn imufusion(text: &str, raw: &[Vector3<f64>; 2]) -> [Vector3<f64>; 2] {
    ["accelerometer", "gyroscope"].map(|sensor| {
        let raw = raw[usize::from(sensor == "gyroscope")];
        let misalignment = numbers::<9>(text, &format!("\n{sensor}_misalignment = "));
        let [sensitivity, offset] = ["sensitivity", "offset"]
            .map(|name| Vector3::from(numbers::<3>(text, &format!("\n{sensor}_{name} = "))));
        Matrix3::from_row_slice(&misalignment) * (raw - offset).component_mul(&sensitivity)
    })
}

/// A list of JSON.
fn list(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|entry| entry.as_f64().expect("a number")).collect()
}

/// `calib_bias.hpp`.
fn basalt(json: &Value, raw: &[Vector3<f64>; 2]) -> [Vector3<f64>; 2] {
    let value = &json["value0"];
    let [a, g] = ["calib_accel_bias", "calib_gyro_bias"].map(|key| list(&value[key]));
    let scale_a = Matrix3::new(a[3], 0.0, 0.0, a[4], a[6], 0.0, a[5], a[7], a[8]);
    let scale_g = Matrix3::from_column_slice(&g[3..12]);
    [
        raw[0] + scale_a * raw[0] - Vector3::from_column_slice(&a[..3]),
        raw[1] + scale_g * raw[1] - Vector3::from_column_slice(&g[..3]),
    ]
}

/// `rs-imu-calibration.py`: `np.dot(m, X[:3]) - X[3]` for a row `m`.
fn librealsense(json: &Value, raw: &[Vector3<f64>; 2]) -> [Vector3<f64>; 2] {
    let imu = &json["imus"][0];
    [("accelerometer", raw[0]), ("gyroscope", raw[1])].map(|(sensor, raw)| {
        let x = Matrix3::from_row_slice(&list(&imu[sensor]["scale_and_alignment"]));
        (raw.transpose() * x).transpose() - Vector3::from_vec(list(&imu[sensor]["bias"]))
    })
}

/// `accel_calib.cpp` of imu_calib: the accelerometer alone.
pub(super) fn imu_calib(text: &str, raw: &Vector3<f64>) -> Vector3<f64> {
    Matrix3::from_row_slice(&numbers::<9>(text, "SM:")) * raw - Vector3::from(numbers::<3>(text, "\nbias:"))
}

/// The parameters of a file, of 32 bits: a name, and the value behind it.
fn parameters(text: &str) -> BTreeMap<String, f64> {
    let pairs = text.lines().filter_map(|line| {
        let words: Vec<&str> = line.split(['\t', ',']).collect();
        let at = words.iter().position(|word| word.contains('_'))?;
        Some((words[at].to_owned(), f64::from(words.get(at + 1)?.parse::<f32>().ok()?)))
    });
    pairs.collect()
}

/// A parameter; zero where it is not in the file.
fn value(parameters: &BTreeMap<String, f64>, name: &str) -> f64 {
    parameters.get(name).copied().unwrap_or_default()
}

/// `Accelerometer.hpp`, `Gyroscope.hpp`, `TemperatureCompensation.cpp`.
fn px4(parameters: &BTreeMap<String, f64>, raw: &[Vector3<f64>; 2], celsius: f64) -> [Vector3<f64>; 2] {
    let value = |name: &str| value(parameters, name);
    let offset = |sensor: &str, letter: &str, axis: usize| {
        let of = |name: &str| value(&format!("TC_{letter}0_{name}"));
        let delta = celsius.clamp(of("TMIN"), of("TMAX").max(of("TMIN"))) - of("TREF");
        let power = |power: i32| of(&format!("X{power}_{axis}")) * delta.powi(power);
        let thermal = (0..=3).map(power).sum::<f64>() * value(&format!("TC_{letter}_ENABLE"));
        thermal + value(&format!("CAL_{sensor}0_{}OFF", ["X", "Y", "Z"][axis]))
    };
    let scale = |axis: usize| value(&format!("CAL_ACC0_{}SCALE", ["X", "Y", "Z"][axis]));
    [
        Vector3::from_fn(|axis, _| (raw[0][axis] - offset("ACC", "A", axis)) * scale(axis)),
        Vector3::from_fn(|axis, _| raw[1][axis] - offset("GYRO", "G", axis)),
    ]
}

/// `AP_InertialSensor_tempcal.cpp`, `AP_InertialSensor_Backend.cpp`.
fn ardupilot(parameters: &BTreeMap<String, f64>, raw: &[Vector3<f64>; 2], celsius: f64) -> [Vector3<f64>; 2] {
    let value = |name: &str| value(parameters, name);
    let bias = |sensor: &str, axis: &str| {
        let polynomial = |celsius: f64| {
            let (low, high) = (value("INS_TCAL1_TMIN"), value("INS_TCAL1_TMAX"));
            let delta = celsius.clamp(low, high) - 35.0;
            let power = |m: i32| value(&format!("INS_TCAL1_{sensor}{m}_{axis}")) * delta.powi(m);
            1e-6 * (1..=3).map(power).sum::<f64>() * value("INS_TCAL1_ENABLE")
        };
        let then = polynomial(value(&format!("INS_{sensor}1_CALTEMP")));
        polynomial(celsius) - then + value(&format!("INS_{sensor}OFFS_{axis}"))
    };
    let axes = ["X", "Y", "Z"];
    let scale = |axis: usize| value(&format!("INS_ACCSCAL_{}", axes[axis]));
    [
        Vector3::from_fn(|axis, _| (raw[0][axis] - bias("ACC", axes[axis])) * scale(axis)),
        Vector3::from_fn(|axis, _| raw[1][axis] - bias("GYR", axes[axis])),
    ]
}
