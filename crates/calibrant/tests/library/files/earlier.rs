//! Tests of `calibration.json` of an earlier calibration: there and back again, and every fault of the file.

use crate::common::WORDS;
use crate::files::results::{input, uniaxial};
use calibrant::io::{CalibrationFile, Origin, parse_calibration, read_calibration, to_json};
use calibrant::sensor::{ParameterList, ReadingUnit, SensorModel};

/// A good file of one axis.
const GOOD: &str = r#"{ "schema": 2, "status": "converged", "direction": "true to raw", "frame": "its own",
  "accelerometer": { "reading_unit": "m/s²", "bias_mps2": [0.1], "matrix": [[1.01]] },
  "parameters": [{ "name": "accelerometer.bias.x", "unit": "m/s²", "value": 0.1, "sd": 0.02 },
                 { "name": "accelerometer.scale.x", "unit": "1", "value": 1.01, "sd": 0.001 }],
  "covariance": [[4e-4, 1e-6], [1e-6, 1e-6]] }"#;

/// The message about GOOD with one replacement.
fn message(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    parse_calibration(GOOD.replacen(from, to, 1).as_bytes()).expect_err("broken").to_string()
}

#[test]
fn what_is_broken_below_is_good_before() {
    let found = parse_calibration(GOOD.as_bytes()).expect("good");
    assert_eq!(found.values, [0.1, 1.01]);
    assert!(!found.has_datasheet_prior);
    let product = found.information() * &found.covariance;
    assert!((product - nalgebra::DMatrix::identity(2, 2)).amax() < 1e-12);
    let sensor = found
        .sensor_of(&ParameterList::new(1, SensorModel::ScaleBias), ReadingUnit::MetrePerSecondSquared)
        .expect("the same parameters");
    assert_eq!((sensor.bias.x, sensor.matrix[(0, 0)], sensor.matrix[(1, 1)]), (0.1, 1.01, 1.0));
}

#[test]
fn broken_calibrations_are_refused_with_their_reason() {
    for (from, to, says) in [
        ("{ \"schema\"", "hello { \"schema\"", "line 1, column 1: not valid JSON: expected value"),
        ("[1e-6, 1e-6]] }", "[1e-6, 1e-6]]", "line 5, column"),
        ("\"schema\": 2", "\"schema\": 3", "schema 3 of a calibration is not known to this version"),
        ("\"schema\": 2", "\"schema\": 1", "schema 1 of calibration.json is that of an earlier calibrant"),
        ("\"schema\": 2", "\"schema\": \"one\"", "schema \"one\" of a calibration"),
        ("\"schema\": 2, ", "", "the field `schema` is missing"),
        ("converged", "stalled", "this calibration did not converge: its status is \"stalled\""),
        ("\"covariance\"", "\"covar\"", "the field `covariance` is missing"),
        ("\"parameters\"", "\"params\"", "the field `parameters` is missing"),
        ("\"unit\": \"1\", ", "", "the field `parameters[1].unit` is missing"),
        ("\"value\": 1.01", "\"value\": null", "the field `parameters[1].value` is missing"),
        (
            "\"value\": 1.01",
            "\"value\": \"1.01\"",
            "not a calibration of calibrant: invalid type: string \"1.01\", expected f64",
        ),
        ("[[4e-4, 1e-6], ", "[[4e-4], ", "the covariance is not 2 × 2, one row for each parameter"),
        ("[[4e-4, 1e-6], ", "[", "the covariance is not 2 × 2"),
        ("[[4e-4, ", "[[null, ", "entry (1, 1) of the covariance is not a number"),
        (
            "[[4e-4, 1e-6]",
            "[[4e-4, 2e-6]",
            "the covariance is not symmetric: entries (2, 1) and (1, 2) differ",
        ),
        ("[[4e-4, 1e-6], [1e-6", "[[4e-4, 1e-4], [1e-4", "the covariance is not positive definite"),
        ("[[4e-4", "[[-4e-4", "the covariance is not positive definite"),
        ("[[4e-4", "[[1e999", "number out of range"),
    ] {
        let found = message(from, to);
        assert!(found.contains(says), "{to}: {found}");
        assert!(!found.contains("NaN"), "{found}");
    }
    assert!(parse_calibration(b"").expect_err("empty").to_string().contains("not valid JSON"));
    assert!(parse_calibration(b"\x00\x01").expect_err("binary").to_string().contains("binary data"));
    assert!(
        parse_calibration(b"[]").expect_err("a list").to_string().contains("not a calibration of calibrant")
    );
    let of_gyroscope = GOOD
        .replace("accelerometer", "gyroscope")
        .replace("m/s²", "rad/s")
        .replace("bias_mps2", "bias_radps");
    let error = parse_calibration(of_gyroscope.as_bytes()).expect_err("no accelerometer");
    assert!(error.to_string().contains("it has no parameters of an accelerometer"), "{error}");
}

#[test]
fn another_sensor_is_refused() {
    let found = parse_calibration(GOOD.as_bytes()).expect("good");
    let message = |axes, unit| {
        let list = ParameterList::new(axes, SensorModel::ScaleBias);
        found.sensor_of(&list, unit).expect_err("another sensor").to_string()
    };
    assert!(
        message(3, ReadingUnit::MetrePerSecondSquared)
            .contains("its parameters are bias.x, scale.x, those of the experiment bias.x, bias.y")
    );
    assert!(message(1, ReadingUnit::Counts).contains("bias.x is in m/s² here, in the experiment in counts"));
    let flat = GOOD.replace("1.01", "0.0");
    let error = parse_calibration(flat.as_bytes()).expect_err("reports nothing");
    assert!(error.to_string().contains("the matrix of the accelerometer is singular"), "{error}");
}

#[test]
fn every_beginning_of_a_file_is_refused_without_panic() {
    for length in 0..GOOD.len() {
        assert!(parse_calibration(&GOOD.as_bytes()[..length]).is_err(), "{length}");
    }
}

#[test]
fn a_file_that_is_written_is_read_back() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("calibration.json");
    let calibration = uniaxial();
    std::fs::write(
        &path,
        to_json(&CalibrationFile::of(&calibration, &[], &Origin::of_inputs([input()]), &WORDS)),
    )
    .expect("written");
    let found = read_calibration(&path).expect("read");
    assert_eq!(found.values, calibration.values);
    assert_eq!(found.covariance, calibration.covariance);
    assert_eq!(found.file.as_deref(), Some(path.as_path()));
    assert_eq!(found.parameters[1], ("scale.x".to_owned(), "1".to_owned()));
}
