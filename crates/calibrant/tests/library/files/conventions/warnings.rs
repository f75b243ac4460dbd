//! What a format cannot carry is said, and refused where the correction would be another.

use super::{COUNTS, SI, alone, file, imu};
use calibrant::io::{ImuFormat, calibrated_imu_texts, write_calibrated_imu};
use calibrant::sensor::{Gauge, Triad};

fn warnings(imu: calibrant::sensor::CalibratedImu, format: ImuFormat) -> String {
    let directory = tempfile::tempdir().expect("a directory");
    let written = write_calibrated_imu(&directory.path().join("out"), &file(imu), format);
    written.expect("written").warnings.join("\n")
}

fn refusal(imu: calibrant::sensor::CalibratedImu, format: ImuFormat) -> String {
    calibrated_imu_texts(&file(imu), format).expect_err("refused").to_string()
}

#[test]
fn what_is_lost_is_said() {
    assert_eq!(warnings(imu(SI, true), ImuFormat::CalibrantJson), "");
    for format in [ImuFormat::Kalibr, ImuFormat::Imucal, ImuFormat::CHeader] {
        let said = warnings(imu(SI, true), format);
        assert!(said.contains(&format!("{} has no place for the covariance", format.title())), "{said}");
    }
    let said = warnings(imu(COUNTS, true), ImuFormat::Kalibr);
    for says in [
        "the true frame is not Kalibr's: T_i_b holds the rotation",
        "no place for biases: they are under the key `calibrant`",
        "this calibration is of counts",
        "Kalibr needs accelerometer_noise_density, accelerometer_random_walk",
    ] {
        assert!(said.contains(says), "{says}: {said}");
    }
    let lower = imu(SI, true).in_gauge(Gauge::Lower).expect("regular");
    assert!(!warnings(lower, ImuFormat::Kalibr).contains("T_i_b"));
    let said = warnings(alone(&imu(SI, false), Triad::Accelerometer), ImuFormat::Kalibr);
    assert!(said.contains("want a gyroscope"), "{said}");
}

#[test]
fn what_would_change_the_correction_is_refused() {
    let said = refusal(imu(SI, true), ImuFormat::ImuTk);
    assert!(said.contains("no place for the gyroscope's g-sensitivity"), "{said}");
    assert!(said.contains("--drop-g-sensitivity"), "{said}");
    let said = refusal(alone(&imu(SI, false), Triad::Gyroscope), ImuFormat::Kalibr);
    assert!(said.contains("no place for a gyroscope alone"), "{said}");
    let said = refusal(alone(&imu(SI, false), Triad::Accelerometer), ImuFormat::Imucal);
    assert!(said.contains("wants both sensors, and there is no gyroscope"), "{said}");
    let mut left = imu(SI, true);
    left.parameters.accelerometer.matrix.row_mut(0).neg_mut();
    let said = refusal(left, ImuFormat::Kalibr);
    assert!(said.contains("the axes of the accelerometer are left-handed"), "{said}");
    let mut flat = imu(SI, true);
    flat.parameters.gyroscope.matrix.row_mut(1).fill(0.0);
    for format in ImuFormat::ALL {
        let said = refusal(flat.clone(), format);
        assert!(said.contains("the matrix of the gyroscope is singular"), "{said}");
    }
    let mut turned = alone(&imu(SI, false), Triad::Accelerometer);
    turned.parameters.accelerometer.matrix =
        nalgebra::Matrix3::new(0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    let said = refusal(turned, ImuFormat::ImuTk);
    assert!(said.contains("a zero on its diagonal"), "{said}");
}
