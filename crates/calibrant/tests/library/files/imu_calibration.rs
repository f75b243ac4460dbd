//! Tests of `calibration.json` of a whole IMU: its content, and that it is read back.

use self::imus::{DISTURBED, imu_case};
use super::results::input;
use crate::common::WORDS;
use calibrant::estimate::CalibrationStatus;
use calibrant::io::{
    CalibrationFile, ConventionOptions, ImuFormat, Input, Origin, calibrated_imu_texts, parse_calibrated_imu,
    read_calibrated_imu, to_json, write_json,
};
use calibrant::sensor::{Axis, ImuQuantity, Quantity, SensorKind};
use calibrant::{estimate, motion, sensor};
use serde_json::Value;

#[path = "../../../../calibrant-report/src/tests/imu_pages/imus.rs"]
mod imus;

#[test]
fn it_is_read_as_a_calibrated_imu_to_the_bit() {
    let case = imu_case(14, 1);
    let calibration = case.calibration;
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("calibration.json");
    let samples = case.recording[SensorKind::Gyroscope].clone().map_or(0, |recording| recording.len());
    let inputs = [input(), Input { file: "gyroscope.csv".into(), samples, ..input() }];
    write_json(&path, &CalibrationFile::of(&calibration, &[], &Origin::of_inputs(inputs.clone()), &WORDS))
        .expect("written");
    let back = read_calibrated_imu(&path, &ConventionOptions::default()).expect("read");
    assert_eq!(back.imu, calibration.calibrated());
    assert_eq!(back.inputs, inputs);
    assert_eq!(back.format, ImuFormat::CalibrantJson);
    assert!(back.findings.is_empty() && back.noise.is_none());
    let text = std::fs::read_to_string(&path).expect("read");
    assert_eq!(
        text,
        to_json(&CalibrationFile::of(&calibration, &[], &Origin::of_inputs(inputs.clone()), &WORDS)),
        "the same bytes"
    );
    // and converts to the other formats
    calibrated_imu_texts(&back, ImuFormat::Kalibr).expect("convertible");
}

#[test]
fn it_says_everything_that_is_needed_to_judge_it() {
    let calibration = imu_case(14, 1).calibration;
    let json: Value = serde_json::from_str(&to_json(&CalibrationFile::of(
        &calibration,
        &[],
        &Origin::of_inputs([input()]),
        &WORDS,
    )))
    .expect("JSON");
    assert_eq!((&json["schema"], &json["status"]), (&2.into(), &"converged".into()));
    let number = |value: &Value| value.as_f64().expect("a number");

    let parameters = json["parameters"].as_array().expect("a list");
    assert_eq!(parameters.len(), calibration.quantities.len());
    let last = parameters.iter().find(|p| p["name"] == "gyroscope.g_sensitivity.xx").expect("there");
    assert!((0.05..0.95).contains(&number(&last["prior_share"])), "{last}");
    assert_eq!(number(&parameters[0]["prior_share"]), 0.0);
    assert_eq!(number(&json["correlation"][3][3]), 1.0);
    assert_eq!(json["fit"]["degrees_of_freedom"], calibration.fit.degrees_of_freedom);

    let holds = &json["holds"];
    assert_eq!(holds["gauge"], "upper");
    assert!(holds.get("latitude_deg").is_none(), "not known");
    let mut placed = calibration.clone();
    placed.gyroscope.as_mut().expect("an IMU").latitude_deg = Some(-33.9);
    let placed: Value = serde_json::from_str(&to_json(&CalibrationFile::of(
        &placed,
        &[],
        &Origin::of_inputs([input()]),
        &WORDS,
    )))
    .expect("JSON");
    assert_eq!(placed["holds"]["latitude_deg"], -33.9);
    assert_eq!(holds["table"].as_array().expect("a list").len(), 14);
    assert!(number(&holds["table"][0]["mean_counts"][0]) > 3e4);
    let noise = number(&json["still_gyroscope"]["noise_per_sample_counts"][1]);
    assert!((noise / 20.0 - 1.0).abs() < 0.1, "{noise}");
    assert_eq!(json["still_gyroscope"]["noise_source"], "scatter within holds");
    assert_eq!(json["still_gyroscope"]["between_holds_sd_counts"].as_array().expect("a list").len(), 3);

    let rotations = &json["rotations"];
    assert_eq!(rotations["used"], 12);
    assert!(number(&rotations["error_rms_rad"]) < 0.1 * number(&rotations["error_before_rms_rad"]));
    let knocked = &rotations["table"][DISTURBED];
    assert_eq!((&knocked["from_hold_index"], &knocked["used"]), (&DISTURBED.into(), &false.into()));
    assert!(number(&knocked["error_rad"]) > 0.01 && number(&knocked["studentised"]) > 3.0);
    assert!(knocked["reason"].as_str().expect("why").contains("misses gravity"));
    let warnings: Vec<_> =
        json["warnings"].as_array().expect("a list").iter().map(Value::to_string).collect();
    assert!(warnings.iter().any(|warning| warning.contains("hold 6 to hold 7")), "{warnings:#?}");

    let turn = &json["turns"][0];
    let tau = std::f64::consts::TAU;
    assert!((number(&turn["angle_rad"][2]) - tau).abs() < 1e-12);
    assert!((number(&turn["measured_rad"][2]) - tau).abs() < 0.02, "{turn}");
}

#[test]
fn it_says_what_the_true_frame_is() {
    let mut calibration = imu_case(14, 1).calibration;
    let frame = calibration.calibrated().frame;
    assert_eq!(
        frame,
        "fixed by the accelerometer's gauge: its matrix is upper triangular with a positive diagonal"
    );
    calibration.quantities[8] =
        ImuQuantity::Of(SensorKind::Accelerometer, Quantity::CrossAxis(Axis::Y, Axis::X));
    assert_eq!(calibration.calibrated().frame, "that of the known directions of the holds");
}

#[test]
fn what_was_not_integrated_is_null_and_what_did_not_converge_is_not_read() {
    let mut calibration = imu_case(14, 1).calibration;
    calibration.status = CalibrationStatus::Stalled;
    for rotation in &mut calibration.gyroscope.as_mut().expect("an IMU").rotations {
        (rotation.used, rotation.path_rad) = (false, 0.0);
    }
    let text = to_json(&CalibrationFile::of(&calibration, &[], &Origin::of_inputs([input()]), &WORDS));
    let json: Value = serde_json::from_str(&text).expect("JSON");
    assert!(
        json["rotations"]["error_rms_rad"].is_null() && json["rotations"]["table"][0]["error_rad"].is_null()
    );
    let error = parse_calibrated_imu(text.as_bytes(), &ConventionOptions::default()).expect_err("refused");
    assert!(error.to_string().contains("did not converge"), "{error}");
}
