//! Tests of broken calibrations of every format: refused with the reason, and the place where it is known.

use super::{COUNTS, SI, alone, file, imu};
use crate::common::WORDS;
use crate::files::results::{input, uniaxial};
use calibrant::io::{
    CalibrationFile, ConventionOptions, ImuFormat, Origin, RawUnits, calibrated_imu_texts,
    parse_calibrated_imu, read_calibrated_imu, to_json,
};
use calibrant::sensor::{Gauge, SensorKind};
use proptest::prelude::*;

fn text(format: ImuFormat) -> String {
    let imu = match format {
        ImuFormat::ImuTk => alone(&imu(COUNTS, false), SensorKind::Accelerometer),
        _ => imu(SI, true).in_gauge(Gauge::Lower).expect("regular"),
    };
    calibrated_imu_texts(&file(imu), format).expect("carried").remove(0).1
}

fn read_formats() -> Vec<ImuFormat> {
    ImuFormat::ALL.into_iter().filter(|format| format.is_read()).collect()
}

fn message_of(text: &str, options: &ConventionOptions) -> String {
    let error = parse_calibrated_imu(text.as_bytes(), options).expect_err("broken");
    assert!(error.is_invalid_experiment());
    let message = error.to_string();
    assert!(!message.contains("NaN"), "{message}");
    message
}

/// Each case: a text in a good file, its replacement, and the message.
fn check(format: ImuFormat, cases: &[(&str, &str, &str)]) {
    let good = text(format);
    for (from, to, says) in cases {
        assert!(good.contains(from), "{from}: {good}");
        let message = message_of(&good.replacen(from, to, 1), &ConventionOptions::default());
        assert!(message.contains(says), "{from} → {to}: {message}");
    }
}

#[test]
fn calibrant_json() {
    check(
        ImuFormat::CalibrantJson,
        &[
            ("\"schema\": 2", "\"schema\": 3", "schema 3 of a calibration is not known to this version"),
            ("\"schema\": 2,", "", "the field `schema` is missing"),
            ("\"schema\": 2,", "\"schema\": 2 \"x\",", "line 2, column 15: not valid JSON"),
            (
                "\"schema\": 2,",
                "\"schema\": 2, \"status\": \"stalled\",",
                "did not converge: its status is \"stalled\"",
            ),
            ("\"direction\"", "\"way\"", "the field `direction` is missing"),
            ("true to raw: y_a", "raw to true: y_a", "`direction` must be true to raw"),
            ("\"frame\"", "\"fame\"", "the field `frame` is missing"),
            (
                "\"gauge\": \"lower\"",
                "\"gauge\": \"upper\"",
                "`gauge` is \"upper\", but the matrix of the accelerometer has not this form",
            ),
            (
                "\"reading_unit\": \"m/s²\"",
                "\"reading_unit\": \"g\"",
                "`accelerometer.reading_unit` is \"g\" (write \"m/s²\" or \"counts\")",
            ),
            (
                "\"reading_unit\": \"m/s²\"",
                "\"reading_unit\": \"counts\"",
                "the field `accelerometer.bias_counts` is missing",
            ),
            ("\"bias_mps2\": [", "\"bias_mps2\": [0.0, ", "`accelerometer.bias_mps2` has 4 numbers, not 3"),
            (
                "\"bias_mps2\": [",
                "\"bias_mps2\": [1e30], \"x\": [",
                "this is the calibration of a sensor with one axis; an IMU has three",
            ),
            ("\"matrix\": [", "\"matrix\": [[1.0], ", "`accelerometer.matrix` is not 3 × 3"),
            ("\"matrix\": [", "\"matrix\": [null, ", "not a calibration of calibrant: invalid type: null"),
            (
                "accelerometer.bias.x",
                "accelerometer.bias.w",
                "\"accelerometer.bias.w\" is no parameter of this IMU",
            ),
            ("accelerometer.bias.x", "accelerometer.bias.y", "accelerometer.bias.y is"),
            (
                "\"unit\": \"m/s²\"",
                "\"unit\": \"counts\"",
                "accelerometer.bias.x is in counts, its sensor says m/s²",
            ),
            ("\"covariance\": [\n", "\"covariance\": [\n    [1.0],\n", "the covariance is not 30 × 30"),
            ("\"parameters\"", "\"params\"", "the field `parameters` is missing"),
        ],
    );
    let good = text(ImuFormat::CalibrantJson);
    let start = good.find("\"covariance\": [").expect("there");
    for (to, says) in [
        ("null", "entry (1, 1) of the covariance is not a number"),
        ("-1.0", "not positive definite"),
        ("0.0", "not positive definite"),
    ] {
        let (head, tail) = good.split_at(start);
        let comma = tail.find(',').expect("a row");
        let bracket = tail[..comma].rfind('[').expect("a row") + 1;
        let broken = format!("{head}{}{to}{}", &tail[..bracket], &tail[comma..]);
        let message = message_of(&broken, &ConventionOptions::default());
        assert!(message.contains(says), "{to}: {message}");
    }
    // one axis is no IMU
    let uniaxial = to_json(&CalibrationFile::of(&uniaxial(), &[], &Origin::of_inputs([input()]), &WORDS));
    let message = message_of(&uniaxial, &ConventionOptions::default());
    assert!(message.contains("a sensor with one axis; an IMU has three"), "{message}");
    // earlier versions wrote another schema
    let old = uniaxial.replacen("\"schema\": 2", "\"schema\": 1", 1);
    let message = message_of(&old, &ConventionOptions::default());
    assert!(message.contains("schema 1 of calibration.json is that of an earlier calibrant"), "{message}");
    assert!(message.contains("calibrate the recording again"), "{message}");
}

#[test]
fn kalibr() {
    check(
        ImuFormat::Kalibr,
        &[
            ("imu0:", "imu0: [", "not Kalibr's imu.yaml: "),
            ("imu0:", "imu1: 3\nimu0:", "the file has imu0 and imu1, and one is read"),
            ("imu0:", "cam0: 3\nimu0:", "there are other keys beside imu0"),
            (
                "  accelerometers:",
                "  accelerometer:",
                "there is no calibration in it: model scale-misalignment",
            ),
            (
                "    M:\n",
                "    N:\n",
                "`accelerometers.N` has numbers, and this program does not know what they mean",
            ),
            ("    M:\n", "    M:\n    - [1.0, 2.0, 3.0]\n", "`accelerometers.M` is not 3 × 3"),
            ("    M:\n    - [", "    M:\n    - [big, ", "not Kalibr's imu.yaml"),
            ("    M:\n    - [", "    M:\n    - [.nan, ", "non-finite float `.nan` rejected"),
            ("C_gyro_i:\n    - [", "C_gyro_i:\n    - [1", "`gyroscopes.C_gyro_i` is not a rotation"),
            ("T_i_b:\n", "T_i_b:\n  - [1.0]\n", "`T_i_b` is not 4 × 4"),
            ("T_i_b:\n  - [1.0", "T_i_b:\n  - [2.0", "`T_i_b` is not a rotation"),
            ("accelerometer_unit: m/s²", "accelerometer_unit: g", "`calibrant.accelerometer_unit` is \"g\""),
            ("    b: [", "    b: [0.0, ", "`accelerometers.b` has 4 numbers"),
            (
                "  calibrant: # for calibrant alone\n",
                "  calibrant:\n    gyroscope_bias: [1.0]\n",
                "`gyroscopes.b` and `calibrant.gyroscope_bias` are two biases",
            ),
            ("update_rate: ", "update_rate: -", "`update_rate` is not a positive number"),
        ],
    );
    let message = message_of("imu0:\n  accelerometers:\n    M: [1, 2\n", &ConventionOptions::default());
    assert!(message.starts_with("line "), "with its place: {message}");
}

#[test]
fn imu_tk() {
    check(
        ImuFormat::ImuTk,
        &[
            ("# sensor: accelerometer", "", "is this the accelerometer's or the gyroscope's?"),
            ("# readings in: counts", "", "in which unit are the readings of the accelerometer?"),
            ("# readings in: counts", "# readings in: g", "its unit of readings is not known"),
            ("33124.0", "33124.0 1.0", "line 11, column 17: there is more than 21 numbers: 32130.28"),
            ("33124.0", "", "the file has 20 of 21 numbers"),
            ("33124.0", "nan", "not a number: nan"),
            ("33124.0", "1e30", "a number of the accelerometer is not finite or beyond 1e12"),
            ("33124.0", "3,3", "line 9, column 18: not a number: 3,3"),
        ],
    );
    let asked = "1 0 0\n0 1 0\n0 0 1\n0.0024 0 0\n0 0.0024 0\n0 0 0.0024\n1\n2\n3\n";
    let sensor_kind = Some(SensorKind::Accelerometer);
    let message = message_of(asked, &ConventionOptions { sensor_kind, ..Default::default() });
    assert!(message.contains("a scale of 0.0024 looks like counts: option `unit` counts"), "{message}");
    let zero = asked.replace("0.0024", "0");
    let message = message_of(
        &zero,
        &ConventionOptions { sensor_kind, units: Some(RawUnits::Si), ..Default::default() },
    );
    assert!(message.contains("the matrix of the accelerometer is singular"), "{message}");
}

#[test]
fn imucal() {
    check(
        ImuFormat::Imucal,
        &[
            (
                "\"cal_type\": \"Ferraris\"",
                "\"cal_type\": \"Magic\"",
                "cal_type \"Magic\" is not known (Ferraris and Turntable are)",
            ),
            (
                "\"_format_version\": \"2.0.0\"",
                "\"_format_version\": \"3.0.0\"",
                "format version 3.0.0 is not known",
            ),
            (
                "\"from_acc_unit\": \"m/s^2\"",
                "\"from_acc_unit\": null",
                "in which unit are the readings of the accelerometer? `from_acc_unit` is null",
            ),
            (
                "\"from_gyr_unit\": \"deg/s\"",
                "\"from_gyr_unit\": \"rpm\"",
                "`from_gyr_unit` is \"rpm\", which is not known",
            ),
            (
                "\"acc_unit\": \"m/s^2\"",
                "\"acc_unit\": \"a.u.\"",
                "`acc_unit` is \"a.u.\", which is not known",
            ),
            ("\"gyr_unit\": \"deg/s\"", "\"gyr_unit\": null", "`gyr_unit` is missing"),
            ("\"K_a\": ", "\"K_x\": ", "`K_a` is missing"),
            ("\"b_g\": [", "\"b_g\": [0.0, ", "`b_g` has 4 numbers, not 3"),
            ("\"R_g\": [", "\"R_g\": [[1.0], ", "`R_g` is not 3 × 3"),
            ("\"b_a\": [", "\"b_a\": [\"x\", ", "not imucal's JSON: invalid type: string"),
            ("\"K_a\": [", "\"K_a\": 3, \"x\": [", "not imucal's JSON: invalid type: integer"),
        ],
    );
}

#[test]
fn c_header() {
    check(
        ImuFormat::CHeader,
        &[
            (
                "calibrant_accelerometer_bias[3] = {",
                "calibrant_accelerometer_bias[3] = { 1.0,",
                "has 4 numbers, not 3",
            ),
            (
                "calibrant_accelerometer_bias[3] = {",
                "calibrant_accelerometer_bias[3] = { x,",
                "`calibrant_accelerometer_bias`: not a number: x",
            ),
            (
                "calibrant_accelerometer_bias[3] =",
                "accelerometer_bias[3] =",
                "`calibrant_accelerometer_bias` is missing",
            ),
            (
                " * accelerometer: readings in",
                " * accelerometer:",
                "the comment with the unit of the accelerometer is missing",
            ),
            ("readings in m/s^2", "readings in g", "the unit of the accelerometer is \"g\""),
        ],
    );
    let message = message_of("#ifndef OTHER_H\n#define OTHER_H\n#endif\n", &ConventionOptions::default());
    assert!(message.contains("there is no `calibrant_accelerometer_matrix`"), "{message}");
}

#[test]
fn openvins() {
    check(
        ImuFormat::OpenVins,
        &[
            ("model: \"kalibr\"", "model: \"rpng\"", "its model is not `kalibr`"),
            ("  Tg:\n", "  Th:\n", "missing field `Tg`"),
            ("  Ta:\n    - [", "  Ta:\n    - [0.5, ", "`Ta` is not 3 × 3"),
            ("  R_IMUtoGYRO:\n    - [", "  R_IMUtoGYRO:\n    - [1", "`R_IMUtoGYRO` is not a rotation"),
            (", 0.0, 0.0]\n    - [-", ", 0.1, 0.0]\n    - [-", "lower triangular"),
        ],
    );
    let error = parse_calibrated_imu(
        b"x",
        &ConventionOptions { format: Some(ImuFormat::Px4), ..ConventionOptions::default() },
    );
    let message = error.expect_err("not read").to_string();
    assert!(message.contains("PX4's parameters is written and not read"), "{message}");
}

#[test]
fn what_is_no_calibration_is_not_recognised() {
    for (text, says) in [
        ("", "the file is empty"),
        ("\n\n", "the file is empty"),
        ("hello", "this is no calibration in a format that is known (name its format with option `from`"),
        ("t_s,ax,ay,az\n0,0,0,1\n", "this is no calibration in a format that is known"),
        ("{}", "the field `schema` is missing"),
        ("[]", "not a calibration of calibrant"),
        ("\u{0}\u{1}", "binary data"),
    ] {
        let message = message_of(text, &ConventionOptions::default());
        assert!(message.contains(says), "{text:?}: {message}");
    }
    let error = read_calibrated_imu(std::path::Path::new("no/such.calib"), &ConventionOptions::default());
    assert!(error.expect_err("absent").to_string().starts_with("no/such.calib: cannot read the calibration"));
}

#[test]
fn every_beginning_of_a_file_is_refused_or_whole_and_nothing_panics() {
    for format in read_formats() {
        let text = text(format);
        let ends: Vec<usize> = text.char_indices().map(|(at, _)| at).step_by(7).collect();
        for end in ends {
            for from in ImuFormat::ALL {
                let options = ConventionOptions {
                    format: Some(from),
                    units: Some(RawUnits::Si),
                    sensor_kind: Some(SensorKind::Gyroscope),
                };
                let _ = parse_calibrated_imu(&text.as_bytes()[..end], &options);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn changed_bytes_never_panic(at in 0usize..10_000, byte in 0u8..128, format in 0usize..6) {
        let mut bytes = text(read_formats()[format]).into_bytes();
        let at = at % bytes.len();
        bytes[at] = byte;
        if let Ok(file) = parse_calibrated_imu(&bytes, &ConventionOptions::default()) {
            prop_assert!(file.imu.parameters[SensorKind::Accelerometer].matrix.iter().all(|entry| entry.is_finite()));
        }
    }
}
