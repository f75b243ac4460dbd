//! Tests of terms that bend the accelerometer's response in every convention.

use super::c_header::largest_difference_in_c;
use super::{COUNTS, SI, file, imu, largest_difference, readings, there_and_back};
use calibrant::diagnostic::Check;
use calibrant::diagnostic::convention::ResponseStraightened;
use calibrant::io::{ImuFormat, write_calibrated_imu};
use calibrant::sensor::{CalibratedImu, ImuQuantity, NonlinearTerm, Quantity, ReadingUnit, SensorKind};
use nalgebra::{DMatrix, Vector3};

/// An IMU with all terms.
pub(super) fn bent(mut imu: CalibratedImu) -> CalibratedImu {
    let bends = &mut imu.parameters[SensorKind::Accelerometer].nonlinearity;
    *bends.of_mut(NonlinearTerm::SecondOrder) = Vector3::new(2e-4, -5e-4, 1e-4);
    *bends.of_mut(NonlinearTerm::GainBySign) = Vector3::new(0.01, 0.003, -0.02);
    let is_term = |of: &ImuQuantity| matches!(of, ImuQuantity::Of(_, Quantity::Nonlinear(..)));
    imu.quantities.extend(ImuQuantity::all(true, true).into_iter().filter(is_term));
    let (old, n) = (imu.covariance.expect("there"), imu.quantities.len());
    let first = old.nrows();
    let entry = |i: usize, j: usize| if i == j { 1e-9 * (1 + i) as f64 } else { 0.0 };
    imu.covariance =
        Some(DMatrix::from_fn(n, n, |i, j| if i < first && j < first { old[(i, j)] } else { entry(i, j) }));
    imu
}

#[test]
fn calibrant_json_keeps_the_terms_to_the_bit() {
    for unit in [SI, COUNTS] {
        let before = file(bent(imu(unit, true)));
        assert_eq!(there_and_back(&before, ImuFormat::CalibrantJson), [before]);
    }
}

#[test]
fn a_c_header_keeps_them_and_corrects_as_we_do() {
    let before = bent(imu(COUNTS, true));
    let back = there_and_back(&file(before.clone()), ImuFormat::CHeader).remove(0).imu;
    assert_eq!(
        back.parameters[SensorKind::Accelerometer].nonlinearity,
        before.parameters[SensorKind::Accelerometer].nonlinearity
    );
    assert!(largest_difference(&before, &back, &readings(&before, 1000, 3)) < 1e-11);
    if let Some(difference) = largest_difference_in_c(&before, &[]) {
        assert!(difference < 1e-12, "{difference:e}");
    }
    // the reading of a corrected reading is the reading, of 33 000 counts
    if let Some(difference) = largest_difference_in_c(&before, &["-DFORWARD"]) {
        assert!(difference < 1e-9, "{difference:e}");
    }
}

#[test]
fn formats_without_a_place_for_them_say_the_largest_error() {
    let directory = tempfile::tempdir().expect("a directory");
    let imu = bent(imu([ReadingUnit::MetrePerSecondSquared, ReadingUnit::RadianPerSecond], false));
    for format in [ImuFormat::Kalibr, ImuFormat::ImuTk, ImuFormat::Imucal] {
        let path = directory.path().join(format!("imu.{}", format.name()));
        let written = write_calibrated_imu(&path, &file(imu.clone()), format).expect("written");
        let said = written.warnings.iter().find(|of| of.code() == ResponseStraightened::CODE).expect("said");
        let largest_mps2 = said.number("largest_mps2").expect("a number");
        // axis z, at +1 g: 1e-4 g² − 0.01 g; at −1 g the same
        let g = 9.806_65;
        assert!((largest_mps2 - (0.01 * g - 1e-4 * g * g)).abs() < 1e-9, "{format:?} {largest_mps2}");
    }
}
