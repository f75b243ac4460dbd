//! Tests of `study.json`, field by field.

use super::results::uniaxial;
use calibrant::design::{SurfaceSettings, TraceSurface};
use calibrant::diagnostic::Phrase;
use calibrant::diagnostic::design::MotionNotDesigned;
use calibrant::io::{StudyFile, to_json, write_json};
use calibrant::motion::JerkControlledMotion;
use calibrant::sensor::{ReadingUnit, Recording, Sensor, SensorParameters};
use calibrant::study::{ParameterSummary, SensorOutcome, SingleCase, Studies, Study};
use nalgebra::Vector3;
use serde_json::{Value, json};

fn studies() -> Studies {
    let sensor = Sensor { axes: 1, ..Sensor::memsic_mxd2020u() };
    let nodes = vec![Vector3::zeros(), Vector3::new(2.0, 0.0, 0.0)];
    let motion = JerkControlledMotion::uniform(1.0, nodes).expect("good");
    let case = SingleCase {
        truth: SensorParameters::identity(),
        true_motion: motion.clone(),
        recording: Recording::new(
            vec![0.0, 0.5, 1.0],
            vec![Vector3::zeros(); 3],
            1,
            ReadingUnit::MetrePerSecondSquared,
        )
        .expect("samples in order"),
        calibration: uniaxial(),
    };
    let study = Study {
        parameters: sensor.parameter_list().describe(&sensor, &SensorParameters::identity()),
        sensor,
        trust: "known",
        seed: 5,
        rate_hz: 2.0,
        motion,
        outcomes: vec![SensorOutcome {
            truth: vec![0.1, 1.0],
            values: vec![0.2, f64::NAN],
            sd: vec![0.3, 0.4],
            p_value: None,
            status: "converged",
        }],
        summary: vec![ParameterSummary {
            name: "bias.x".into(),
            unit: "m/s²",
            predicted_sd: 1.0,
            realised_rms: 2.0,
            mean_error: 3.0,
            coverage_95: 0.5,
        }],
        single: case.clone(),
        fine: case,
    };
    let surface = TraceSurface {
        settings: SurfaceSettings {
            jerk_mps3: 0.5,
            points: 2,
            start_mps2: 0.1,
            interval_s: 1.0,
            rate_hz: 10.0,
        },
        jerk_mps3: vec![-0.5, 0.5],
        log10_trace: vec![vec![None, Some(-2.0)], vec![Some(-3.0), None]],
    };
    Studies {
        calibration: Some(study),
        surface: Some(surface),
        notes: vec![MotionNotDesigned { is_noisy: false, why: Phrase("for a reason".into()) }.into()],
        ..Studies::default()
    }
}

#[test]
fn every_field_arrives_and_the_bytes_are_the_same_each_time() {
    let text = to_json(&StudyFile { studies: &studies() });
    let whole: Value = serde_json::from_str(&text).expect("JSON");
    let json = &whole["calibration"];
    assert_eq!((&whole["schema"], &json["seed"], &json["trust"]), (&json!(2), &json!(5), &json!("known")));
    let parameter = json!({"name": "scale.x", "unit": "1", "nominal": 1.0, "spread_sd": 0.005});
    assert_eq!(json["parameters"][1], parameter);
    let sensor = json!({
        "status": "converged", "p_value": null, "truth": [0.1, 1.0], "value": [0.2, null], "sd": [0.3, 0.4]
    });
    assert_eq!(json["sensors"], json!([sensor]));
    assert_eq!(json["summary"][0]["coverage_95"], 0.5);
    assert_eq!(json["motion"]["velocity_mps"], json!([[0.0], [1.0]]));
    let single = &json["single"];
    assert_eq!((&single["samples"], &single["rate_hz"]), (&json!(3), &json!(2.0)));
    assert_eq!(single["truth"], json!([0.0, 1.0]));
    let parameter = &single["calibration"]["parameters"][0];
    assert_eq!((&parameter["value"], &parameter["sd"]), (&json!(0.5), &json!(0.5)));
    assert_eq!(single["calibration"]["motion"]["acceleration_sd_mps2"], json!([[0.0], [0.0]]));

    let surface = json!({
        "start_acceleration_mps2": 0.1, "interval_s": 1.0, "rate_hz": 10.0, "jerk_mps3": [-0.5, 0.5],
        "log10_trace": [[null, -2.0], [-3.0, null]]
    });
    assert_eq!(whole["surface"], surface);
    assert_eq!((&whole["design"], &whole["noisy"]), (&Value::Null, &Value::Null));
    assert_eq!(whole["notes"][0]["message"], json!("no motion was designed: for a reason"));

    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("study.json");
    write_json(&path, &StudyFile { studies: &studies() }).expect("written");
    assert_eq!(std::fs::read_to_string(path).expect("read"), text);
}
