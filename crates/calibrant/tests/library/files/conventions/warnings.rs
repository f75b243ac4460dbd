//! Tests of warnings about what a format cannot carry, and refusals where the correction would be another.

use super::{COUNTS, SI, alone, file, imu};
use calibrant::diagnostic::Diagnostic;
use calibrant::io::{ImuFormat, calibrated_imu_texts, write_calibrated_imu};
use calibrant::sensor::{Gauge, SensorKind};

fn warnings(imu: calibrant::sensor::CalibratedImu, format: ImuFormat) -> String {
    let directory = tempfile::tempdir().expect("a directory");
    let written = write_calibrated_imu(&directory.path().join("out"), &file(imu), format);
    let warnings = written.expect("written").warnings;
    warnings.iter().map(Diagnostic::message).collect::<Vec<_>>().join("\n")
}

fn refusal(imu: calibrant::sensor::CalibratedImu, format: ImuFormat) -> String {
    calibrated_imu_texts(&file(imu), format).expect_err("refused").to_string()
}

#[test]
fn what_is_lost_is_said() {
    assert_eq!(warnings(imu(SI, true), ImuFormat::CalibrantJson), "");
    for format in [ImuFormat::Kalibr, ImuFormat::Imucal, ImuFormat::CHeader] {
        let message = warnings(imu(SI, true), format);
        assert!(
            message.contains(&format!("{} has no place for the covariance", format.title())),
            "{message}"
        );
    }
    let message = warnings(imu(COUNTS, true), ImuFormat::Kalibr);
    for says in [
        "the true frame is not Kalibr's: T_i_b holds the rotation",
        "no place for the biases, kept as `b` beside `M`, of counts under the key `calibrant`",
        "no place for readings in counts",
        "Kalibr needs accelerometer_noise_density, accelerometer_random_walk",
    ] {
        assert!(message.contains(says), "{says}: {message}");
    }
    let lower = imu(SI, true).in_gauge(Gauge::Lower).expect("regular");
    assert!(!warnings(lower, ImuFormat::Kalibr).contains("T_i_b"));
    let message = warnings(alone(&imu(SI, false), SensorKind::Accelerometer), ImuFormat::Kalibr);
    assert!(message.contains(", a gyroscope as well"), "{message}");
}

#[test]
fn what_would_change_the_correction_is_refused() {
    let message = refusal(imu(SI, true), ImuFormat::ImuTk);
    assert!(message.contains("no place for the gyroscope's g-sensitivity"), "{message}");
    assert!(message.contains("option `drop` g-sensitivity"), "{message}");
    let message = refusal(alone(&imu(SI, false), SensorKind::Gyroscope), ImuFormat::Kalibr);
    assert!(message.contains("no place for a gyroscope alone"), "{message}");
    let message = refusal(alone(&imu(SI, false), SensorKind::Accelerometer), ImuFormat::Imucal);
    assert!(message.contains("wants both sensors, and there is no gyroscope"), "{message}");
    let mut left = imu(SI, true);
    left.parameters[SensorKind::Accelerometer].matrix.row_mut(0).neg_mut();
    let message = refusal(left, ImuFormat::Kalibr);
    assert!(message.contains("the axes of the accelerometer are left-handed"), "{message}");
    let mut flat = imu(SI, true);
    flat.parameters[SensorKind::Gyroscope].matrix.row_mut(1).fill(0.0);
    for format in ImuFormat::ALL {
        let message = refusal(flat.clone(), format);
        assert!(message.contains("the matrix of the gyroscope is singular"), "{message}");
    }
    let mut turned = alone(&imu(SI, false), SensorKind::Accelerometer);
    turned.parameters[SensorKind::Accelerometer].matrix =
        nalgebra::Matrix3::new(0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    let message = refusal(turned, ImuFormat::ImuTk);
    assert!(message.contains("a zero on its diagonal"), "{message}");
}
