//! Tests of written results: there and back again, and the JSON field by field.

use crate::common::{WORDS, read_accelerometer};
use calibrant::Error;
use calibrant::diagnostic::Diagnostic;
use calibrant::diagnostic::datasheet::WeakerThanDatasheet;
use calibrant::error::Refusal;
use calibrant::estimate::{
    Calibration, CalibrationStatus, FitStatistics, HoldCalibration, HoldResult, Recovered, RecoveredClock,
    RecoveredMotion, Uncalibrated, Whiteness,
};
use calibrant::io::{
    CalibrationFile, Failure, Input, Origin, Summary, SummaryRow, Truth, read_motion, to_json,
    write_atomically, write_json, write_motion, write_recording, write_summary,
};
use calibrant::motion::{Gravity, Hold, JerkControlledMotion};
use calibrant::sensor::{
    Gauge, ImuParameters, PerSensor, ReadingUnit, Recording, Sensor, SensorKind, SensorModel,
    SensorParameters,
};
use nalgebra::{DMatrix, Matrix3, Vector3};
use serde_json::{Value, json};
use std::path::Path;

/// Numbers whose decimal form is long, tiny, huge or signed zero.
const AWKWARD: [f64; 6] = [0.1 + 0.2, -1e-308, 1.0 / 3.0, -0.0, 123_456_789.123_456_7, 5e-324];

#[test]
fn recordings_come_back_bit_for_bit() {
    let directory = tempfile::tempdir().expect("a directory");
    for (axes, unit) in [(3, ReadingUnit::Counts), (1, ReadingUnit::MetrePerSecondSquared)] {
        let reading = |k: usize| {
            let at = |i: usize| if i < axes { AWKWARD[(k + i) % 6] } else { 0.0 };
            Vector3::new(at(0), at(1), at(2))
        };
        let times_s = (0..100).map(|k| k as f64 * 0.1 - 3.0).collect();
        let readings = (0..100).map(reading).collect();
        let recording = Recording::new(times_s, readings, axes, unit).expect("samples in order");
        let path = directory.path().join("recording.csv");
        write_recording(&path, &recording).expect("written");
        let back = read_accelerometer(&path, axes, unit);
        assert_eq!(back, recording);
        let bits = |r: &Recording| {
            r.readings().iter().flat_map(|v| [v.x, v.y, v.z]).map(f64::to_bits).collect::<Vec<_>>()
        };
        assert_eq!(bits(&back), bits(&recording));
    }
}

#[test]
fn motions_come_back_bit_for_bit() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("deep/er/motion.csv");
    let nodes: Vec<_> = (0..6).map(|i| Vector3::new(AWKWARD[i], 0.0, AWKWARD[5 - i])).collect();
    let motion = JerkControlledMotion::uniform(1.0 / 3.0, nodes).expect("good");
    write_motion(&path, &motion, 3).expect("written");
    assert_eq!(read_motion(&path, 3).expect("read"), motion);
    let text = std::fs::read_to_string(&path).expect("read");
    assert!(text.starts_with("t_s,ax_mps2,ay_mps2,az_mps2\n0.0,0.30000000000000004,0.0,5e-324\n"), "{text}");
    // a sensor of one axis reads the first of them
    assert_eq!(
        read_motion(&path, 1).expect("read").acceleration_mps2()[2],
        Vector3::new(1.0 / 3.0, 0.0, 0.0)
    );
}

#[test]
fn what_cannot_be_written_says_why_and_leaves_nothing() {
    let directory = tempfile::tempdir().expect("a directory");
    let file = directory.path().join("file");
    std::fs::write(&file, "x").expect("written");
    let message = |path: &Path| {
        let error = write_atomically(path, |out| writeln!(out, "1")).expect_err("refused");
        assert!(matches!(&error, Error::Output { path: named, .. } if named == path));
        error.to_string()
    };
    assert!(message(directory.path()).ends_with("a directory of this name is in the way"));
    assert!(
        message(&file.join("below.json")).contains("cannot create directory"),
        "{}",
        message(&file.join("below.json"))
    );
    let failing = write_atomically(&file, |out| {
        writeln!(out, "half")?;
        Err(std::io::Error::other("disk full"))
    });
    assert!(failing.expect_err("refused").to_string().ends_with("file: disk full"));
    assert_eq!(std::fs::read_to_string(&file).expect("untouched"), "x");
    assert_eq!(
        std::fs::read_dir(directory.path()).expect("a directory").count(),
        1,
        "nothing is left beside it"
    );
}

#[cfg(unix)]
#[test]
fn links_are_followed_and_devices_stay_devices() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let directory = tempfile::tempdir().expect("a directory");
    let (target, link) = (directory.path().join("target"), directory.path().join("link"));
    std::fs::write(&target, "old").expect("written");
    symlink(&target, &link).expect("a link");
    write_atomically(&link, |out| write!(out, "new")).expect("written");
    assert_eq!(std::fs::read_to_string(&target).expect("read"), "new");
    assert!(link.symlink_metadata().expect("there").is_symlink());
    write_atomically("/dev/null".as_ref(), |out| write!(out, "gone")).expect("written");
    assert!(std::fs::metadata("/dev/null").expect("there").file_type().is_char_device());
}

pub(super) fn input() -> Input {
    Input { file: "a.csv".into(), sha256: "00ff".into(), samples: 7, rate_hz: 10.0 }
}

fn calibration(
    sensor: &Sensor,
    parameters: SensorParameters,
    recovered: Recovered,
    list: calibrant::sensor::ParameterList,
) -> Calibration {
    let described = list.describe_accelerometer(sensor, &SensorParameters::identity());
    let p = described.len();
    Calibration {
        status: CalibrationStatus::Converged,
        iterations: 3,
        gradient_norm: f64::NAN,
        values: list.quantities().iter().map(|quantity| quantity.value(&parameters)).collect(),
        quantities: list.of_accelerometer(),
        parameters: described,
        covariance: DMatrix::identity(p, p) * 0.25,
        budget: Vec::new(),
        prior_share: Vec::new(),
        gravity_slope: Vec::new(),
        datasheet_prior: true,
        imu: ImuParameters::identity().with(SensorKind::Accelerometer, parameters),
        units: PerSensor::only(SensorKind::Accelerometer, sensor.unit),
        counts_per_unit: PerSensor::default(),
        fit: FitStatistics {
            chi2: 5.5,
            degrees_of_freedom: 4,
            p_value: None,
            residual_rms: Some(Vector3::new(1.0, 2.0, 3.0)),
            assumed_noise: None,
            noise_estimate: Some(Vector3::new(4.0, 5.0, 6.0)),
            whiteness: vec![Whiteness { statistic: 1.0, lags: 2, p_value: 0.5 }],
        },
        recovered,
        gyroscope: None,
        soak: None,
        soak_prior: Vec::new(),
        changes: Vec::new(),
        warnings: vec![Diagnostic::from(WeakerThanDatasheet { parameters: vec!["a \"word\"".into()] })],
    }
}

/// A calibration of a sensor of one axis, on a motion of one interval.
pub(super) fn uniaxial() -> Calibration {
    let sensor = Sensor { axes: 1, ..Sensor::memsic_mxd2020u() };
    let nodes = vec![Vector3::zeros(), Vector3::new(2.0, 0.0, 0.0)];
    let motion = JerkControlledMotion::uniform(1.0, nodes).expect("good");
    let recovered = RecoveredMotion {
        motion,
        acceleration_sd_mps2: vec![Vector3::zeros(); 2],
        trust: "known",
        gravity: None,
        clock: RecoveredClock::default(),
        residuals: Vec::new(),
        first_sample: 0,
    };
    let mut parameters = SensorParameters::identity();
    parameters.bias.x = 0.5;
    parameters.matrix[(0, 0)] = 2.0;
    calibration(&sensor, parameters, Recovered::Motion(recovered), sensor.parameter_list())
}

#[test]
fn calibration_json_of_a_motion() {
    let text = to_json(&CalibrationFile::of(&uniaxial(), &[], &Origin::of_inputs([input()]), &WORDS));
    let json: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!((&json["schema"], &json["kind"]), (&json!(2), &json!("calibration")));
    assert_eq!(json["gradient_norm"], Value::Null, "NaN is null");
    let bias = json!({"name": "accelerometer.bias.x", "unit": "m/s²", "value": 0.5, "sd": 0.5, "nominal": 0.0, "spread_sd": 0.1});
    assert_eq!(json["parameters"][0], bias);
    assert_eq!(json["prior"], "datasheet");
    assert_eq!(json["covariance"], json!([[0.25, 0.0], [0.0, 0.25]]));
    assert_eq!(json["correlation"], json!([[1.0, 0.0], [0.0, 1.0]]));
    assert_eq!(json["fit"]["residual_rms_mps2"], json!([1.0]));
    assert_eq!(json["fit"]["noise_estimate_mps2"], json!([4.0]));
    assert!(json["fit"].get("assumed_noise_mps2").is_none());
    assert_eq!(json["fit"]["whiteness"], json!([{"axis": "x", "statistic": 1.0, "lags": 2, "p_value": 0.5}]));
    assert_eq!(json["motion"]["acceleration_mps2"], json!([[0.0], [2.0]]));
    assert_eq!(json["motion"]["jerk_mps3"], json!([[2.0]]));
    assert!(
        json["direction"].as_str().is_some_and(|direction| direction.starts_with("true to raw: y_a = S_a f"))
    );
    assert_eq!(json["frame"], "the axes of the commanded motion");
    assert_eq!(json["accelerometer"]["matrix"], json!([[2.0]]));
    assert_eq!(json["accelerometer"]["bias_mps2"], json!([0.5]));
    assert_eq!(json["accelerometer"]["correction"]["matrix"], json!([[0.5]]));
    assert_eq!(json["inputs"], json!([{"file": "a.csv", "sha256": "00ff", "samples": 7, "rate_hz": 10.0}]));
    for absent in ["gauge", "gyroscope", "holds", "still_gyroscope", "rotations", "turns", "validation"] {
        assert!(json.get(absent).is_none_or(Value::is_null), "{absent}");
    }
    assert!(text.contains("\"covariance\": [\n    [0.25, 0.0],\n    [0.0, 0.25]\n  ]"), "{text}");
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("calibration.json");
    write_json(&path, &CalibrationFile::of(&uniaxial(), &[], &Origin::of_inputs([input()]), &WORDS))
        .expect("written");
    assert_eq!(std::fs::read_to_string(path).expect("read"), text, "the same bytes each time");
}

/// A static calibration of a sensor with readings in counts, in the upper gauge.
pub(super) fn holds_in_counts() -> Calibration {
    let sensor = Sensor { unit: ReadingUnit::Counts, ..Sensor::triaxial(SensorModel::Full) };
    let hold = Hold {
        first: 0,
        end: 10,
        start_s: 0.0,
        end_s: 1.0,
        mean: Vector3::new(1.0, 2.0, 3.0),
        sd: Vector3::repeat(0.5),
    };
    let result = HoldResult {
        hold,
        force_mps2: Vector3::new(0.0, 0.0, 9.81),
        magnitude_residual_mps2: 0.001,
        magnitude_sd_mps2: 0.0,
        studentised_residual: f64::INFINITY,
        used: false,
        reason: None,
    };
    let holds = HoldCalibration {
        holds: vec![result],
        gravity: Gravity { magnitude_mps2: 9.81, sd_mps2: 0.0 },
        gauge: Gauge::Upper,
        between_holds_sd_mps2: 0.002,
        drift: None,
        recording_biases: None,
        between_holds_dominates: true,
        tilt: None,
        magnitude_residual_rms_mps2: 0.001,
        degrees_of_freedom: 3,
        condition_number: 50.0,
        detected: true,
        before: Uncalibrated {
            sensor: SensorParameters::identity(),
            source: "the readings as they are".into(),
        },
        temperatures_c: None,
        thermometer: None,
        change: None,
    };
    let parameters = SensorParameters {
        bias: Vector3::new(100.0, 200.0, 300.0),
        matrix: Matrix3::new(2.0, 1.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 8.0),
        ..SensorParameters::identity()
    };
    let list = Gauge::Upper.parameter_list(SensorModel::Full);
    calibration(&sensor, parameters, Recovered::Holds(holds), list)
}

#[test]
fn calibration_json_of_holds_in_counts() {
    let text = to_json(&CalibrationFile::of(&holds_in_counts(), &[], &Origin::of_inputs([input()]), &WORDS));
    let json: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(json["parameters"].as_array().map(Vec::len), Some(9));
    assert_eq!(json["holds"]["table"][0]["mean_counts"], json!([1.0, 2.0, 3.0]));
    assert_eq!(json["holds"]["table"][0]["used"], false);
    assert_eq!(json["holds"]["table"][0]["studentised_residual"], Value::Null);
    assert_eq!(json["gauge"], "upper");
    let accelerometer = &json["accelerometer"];
    assert_eq!(accelerometer["matrix_counts_per_mps2"][0], json!([2.0, 1.0, 0.0]));
    assert_eq!(accelerometer["correction"]["matrix_mps2_per_count"][0], json!([0.5, -0.125, 0.0]));
    assert!(json.get("motion").is_none());
}

#[test]
fn truth_and_summary() {
    let sensor = Sensor::memsic_mxd2020u();
    let text =
        to_json(&Truth::of_sensor(7, &sensor.parameter_list(), sensor.unit, &SensorParameters::identity()));
    let json: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(
        (&json["seed"], &json["parameters"][3]),
        (&json!(7), &json!({"name": "accelerometer.scale.x", "unit": "1", "value": 1.0}))
    );

    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("summary.csv");
    let good = uniaxial();
    let rows = [
        SummaryRow {
            file: "bad,name".into(),
            recording: "a/bad,name.csv".into(),
            outcome: Err(Failure { code: Refusal::RecordingShort, message: "no \"rows\"".into() }),
        },
        SummaryRow {
            file: "good".into(),
            recording: "a/good.csv".into(),
            outcome: Ok(Summary::of(&good, None)),
        },
    ];
    write_summary(&path, &rows).expect("written");
    let expected = "file,recording,verdict,codes,status,error,code,limits_failed,worst_sd_parameter,worst_sd_ratio,worst_sd_relative_to,warnings,chi2,degrees_of_freedom,p_value,accelerometer.bias.x_mps2,accelerometer.bias.x_sd_mps2,accelerometer.scale.x,accelerometer.scale.x_sd\n\
                    \"bad,name\",\"a/bad,name.csv\",none,,error,\"no \"\"rows\"\"\",recording-short,,,,,,,,,,,,\n\
                    good,a/good.csv,doubtful,weaker-than-datasheet,converged,,,,accelerometer.scale.x,100.0,datasheet,1,5.5,4,,0.5,0.5,2.0,0.5\n";
    let text = std::fs::read_to_string(path).expect("read");
    assert_eq!(text, expected);
}
