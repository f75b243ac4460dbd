//! Tests of round trips: every convention keeps the correction, and calibrant JSON keeps everything.

use super::{COUNTS, SI, alone, file, imu, largest_difference, readings, there_and_back};
use crate::common::WORDS;
use calibrant::estimate::Comparison;
use calibrant::io::{
    CalibratedImuFile, CalibrationFile, ConventionOptions, ImuFormat, ImuNoise, Origin, RawUnits,
    parse_calibrated_imu, read_calibrated_imu, read_kalibr_noise, to_json, write_calibrated_imu,
};
use calibrant::nalgebra::Vector3;
use calibrant::sensor::{Gauge, ImuQuantity, ReadingUnit, SensorKind};
use proptest::prelude::*;

/// The formats that are read and take any true frame.
const OWN_FRAME: [ImuFormat; 5] =
    [ImuFormat::CalibrantJson, ImuFormat::Kalibr, ImuFormat::ImuTk, ImuFormat::Imucal, ImuFormat::CHeader];

#[test]
fn the_correction_of_a_thousand_readings_stays_through_every_convention() {
    for unit in [SI, COUNTS, [ReadingUnit::MetrePerSecondSquared, ReadingUnit::Counts]] {
        for g_sensitivity in [true, false] {
            let before = imu(unit, g_sensitivity);
            let readings = readings(&before, 1000, 1);
            for format in OWN_FRAME {
                if format == ImuFormat::ImuTk && g_sensitivity {
                    continue; // refused: see warnings
                }
                for after in there_and_back(&file(before.clone()), format) {
                    let difference = largest_difference(&before, &after.imu, &readings);
                    assert!(difference < 1e-12, "{} {unit:?}: {difference:e}", format.name());
                    for sensor_kind in SensorKind::ALL {
                        let kept = after.imu.unit(sensor_kind);
                        assert!(
                            kept.is_none() || kept == before.unit(sensor_kind),
                            "{} {sensor_kind}",
                            format.name()
                        );
                    }
                    let frame = after.imu.frame.replace("* /", "*/");
                    assert_eq!(frame.trim(), before.frame.trim(), "{}", format.name());
                }
            }
        }
    }
}

#[test]
fn a_chain_through_all_conventions_keeps_it_too() {
    let before = imu(COUNTS, true);
    let mut last = file(before.clone());
    for _ in 0..5 {
        for format in [ImuFormat::Kalibr, ImuFormat::Imucal, ImuFormat::CHeader, ImuFormat::CalibrantJson] {
            last = there_and_back(&last, format).remove(0);
        }
    }
    let difference = largest_difference(&before, &last.imu, &readings(&before, 1000, 2));
    assert!(difference < 1e-11, "{difference:e}");
}

#[test]
fn calibrant_json_keeps_everything_to_the_bit() {
    for gauge in [None, Some(Gauge::Lower), Some(Gauge::Upper), Some(Gauge::Symmetric)] {
        for unit in [SI, COUNTS] {
            let mut imu = imu(unit, true);
            if unit == SI {
                imu.counts_per_unit = [Some(1670.7), None].into();
            }
            if let Some(gauge) = gauge {
                imu = imu.in_gauge(gauge).expect("regular");
            }
            let noise = ImuNoise {
                accelerometer_density: Some(1e-3),
                update_rate_hz: Some(200.0),
                ..Default::default()
            };
            let file = CalibratedImuFile { noise: Some(noise), ..file(imu) };
            assert_eq!(there_and_back(&file, ImuFormat::CalibrantJson), [file]);
        }
    }
    for sensor_kind in SensorKind::ALL {
        let file = file(alone(&imu(SI, false), sensor_kind));
        assert_eq!(there_and_back(&file, ImuFormat::CalibrantJson), [file]);
    }
}

#[test]
fn the_json_says_what_it_means() {
    let file = file(imu(COUNTS, true).in_gauge(Gauge::Upper).expect("regular"));
    let text =
        &calibrant::io::calibrated_imu_texts(&file, ImuFormat::CalibrantJson).expect("everything")[0].1;
    for says in [
        "\"schema\": 2",
        "\"kind\": \"converted\"",
        "\"direction\": \"true to raw: y_a = S_a f + b_a",
        "\"frame\": \"fixed by the upper gauge of the accelerometer",
        "\"gauge\": \"upper\"",
        "\"reading_unit\": \"counts\"",
        "\"matrix_counts_per_mps2\"",
        "\"matrix_radps_per_count\"",
        "\"g_sensitivity_counts_per_mps2\"",
        "\"name\": \"gyroscope.matrix.xy\"",
        "\"name\": \"gyroscope.g_sensitivity.zz\"",
        "\"unit\": \"counts/(rad/s)\"",
        "\"sha256\": \"abab",
    ] {
        assert!(text.contains(says), "{says}: {text}");
    }
    // of every kind with a calibration, as of the kind that all had once
    let read = |text: &str| parse_calibrated_imu(text.as_bytes(), &ConventionOptions::default());
    for kind in ["calibration", "record"] {
        let text = text.replace("\"converted\"", &format!("\"{kind}\""));
        assert_eq!(read(&text).expect("readable").imu, file.imu, "{kind}");
    }
    let error = read(&text.replace("\"converted\"", "\"machine\"")).expect_err("no machine").to_string();
    assert!(error.contains("\"machine\", and it has no `machine`"), "{error}");
    let error = read(&text.replace("\"converted\"", "\"noise\"")).expect_err("no calibration").to_string();
    assert!(error.contains("the kind of this file is \"noise\", and that is no calibration"), "{error}");
}

#[test]
fn the_calibration_of_an_accelerometer_is_read_as_an_imu() {
    let calibration = crate::files::results::holds_in_counts();
    let text = to_json(&CalibrationFile::of(
        &calibration,
        &[],
        &Origin::of_inputs([crate::files::results::input()]),
        &WORDS,
    ));
    let file = parse_calibrated_imu(text.as_bytes(), &ConventionOptions::default()).expect("readable");
    assert_eq!(file.imu.parameters[SensorKind::Accelerometer], calibration.imu[SensorKind::Accelerometer]);
    assert_eq!(file.imu.covariance.as_ref(), Some(&calibration.covariance));
    assert_eq!(
        (file.imu.unit(SensorKind::Accelerometer), file.imu.unit(SensorKind::Gyroscope)),
        (Some(calibration.unit(SensorKind::Accelerometer)), None)
    );
    assert_eq!(file.inputs, [crate::files::results::input()]);
    assert!(file.imu.frame.contains("the accelerometer's gauge"), "{}", file.imu.frame);
    // and written again
    assert_eq!(there_and_back(&file, ImuFormat::CalibrantJson), std::slice::from_ref(&file));
    let turned = file.imu.in_gauge(Gauge::Lower).expect("regular");
    let overall = Comparison::of(&file.imu, &turned).overall.expect("covariances");
    assert!(overall.chi2 < 1e-12 && overall.degrees_of_freedom == 9, "{overall:?}");
}

#[test]
fn imu_tk_has_one_file_for_each_sensor_and_is_read_as_a_pair() {
    let directory = tempfile::tempdir().expect("a directory");
    let before = imu(COUNTS, false);
    let path = directory.path().join("xsens.calib");
    let written =
        write_calibrated_imu(&path, &file(before.clone()), ImuFormat::ImuTk).expect("no g-sensitivity");
    let names: Vec<_> =
        written.files.iter().map(|file| file.file_name().expect("a name").to_owned()).collect();
    assert_eq!(names, ["xsens_acc.calib", "xsens_gyro.calib"]);
    let after = read_calibrated_imu(&path, &ConventionOptions::default()).expect("the pair");
    assert!(
        after.imu.unit(SensorKind::Accelerometer).is_some()
            && after.imu.unit(SensorKind::Gyroscope).is_some()
    );
    assert!(largest_difference(&before, &after.imu, &readings(&before, 1000, 3)) < 1e-12);
    // one sensor keeps the name, and the name shows the sensor where the file does not
    let one = write_calibrated_imu(&path, &file(alone(&before, SensorKind::Gyroscope)), ImuFormat::ImuTk)
        .expect("one");
    assert_eq!(one.files, [path]);
    let plain = "1 0 0\n0 1 0\n0 0 1\n\n0.0002 0 0\n0 0.0002 0\n0 0 0.0002\n\n32777\n32459\n32511\n";
    let named = directory.path().join("test_imu_gyro.calib");
    std::fs::write(&named, plain).expect("written");
    let options = ConventionOptions { units: Some(RawUnits::Counts), ..Default::default() };
    let found = read_calibrated_imu(&named, &options).expect("imu_tk's own");
    assert_eq!(found.imu.unit(SensorKind::Gyroscope), Some(ReadingUnit::Counts));
    assert!((found.imu.parameters[SensorKind::Gyroscope].matrix[(1, 1)] - 5000.0).abs() < 1e-9);
}

#[test]
fn imu_tks_published_result_is_that_of_its_file() {
    // its accelerometer of the Xsens recording: gains in counts/(m/s²), T upper triangular
    let (gains, t) = ([414.458874, 412.010468, 414.648662], [-0.00335930, -0.00890639, -0.02133412]);
    let text = format!(
        "1 {} {}\n0 1 {}\n0 0 1\n\n{:e} 0 0\n0 {:e} 0\n0 0 {:e}\n\n33124.1826\n33275.1794\n32364.4156\n",
        t[0],
        t[1],
        t[2],
        1.0 / gains[0],
        1.0 / gains[1],
        1.0 / gains[2]
    );
    let options = ConventionOptions {
        units: Some(RawUnits::Counts),
        sensor_kind: Some(SensorKind::Accelerometer),
        ..Default::default()
    };
    let file = parse_calibrated_imu(text.as_bytes(), &options).expect("imu_tk's own");
    let s = file.imu.parameters[SensorKind::Accelerometer].matrix;
    assert!((s[(0, 0)] - gains[0]).abs() < 1e-9 && (s[(2, 2)] - gains[2]).abs() < 1e-9);
    assert!(
        (s[(0, 1)] - gains[0] * -t[0] * 1.0).abs() < 1e-6,
        "S = (T K)⁻¹ is in counts of x per m/s² of y: {s}"
    );
    assert_eq!(Gauge::of(&s), Some(Gauge::Upper));
}

#[test]
fn kalibrs_own_file_is_read() {
    let text = r"imu0:
  T_i_b:
  - [1.0, 0.0, 0.0, 0.0]
  - [0.0, 1.0, 0.0, 0.0]
  - [0.0, 0.0, 1.0, 0.0]
  - [0.0, 0.0, 0.0, 1.0]
  accelerometer_noise_density: 0.00668
  accelerometer_random_walk: 0.000917
  accelerometers:
    M:
    - [1.01, 0.0, 0.0]
    - [0.02, 1.02, 0.0]
    - [-0.03, 0.01, 1.03]
  gyroscope_noise_density: 0.00203
  gyroscope_random_walk: 0.000271
  gyroscopes:
    A:
    - [0.0003, 0.0001, 0.0002]
    - [-0.0002, -0.0003, -0.0001]
    - [-2.0e-06, 0.0004, 0.0015]
    C_gyro_i:
    - [0.8, -0.6, 0.0]
    - [0.6, 0.8, 0.0]
    - [0.0, 0.0, 1.0]
    M:
    - [0.5, 0.0, 0.0]
    - [0.1, 0.6, 0.0]
    - [0.0, 0.0, 0.7]
  model: scale-misalignment
  rostopic: /imu/data_raw
  time_offset: 0.0
  update_rate: 200.0
";
    let file = parse_calibrated_imu(text.as_bytes(), &ConventionOptions::default()).expect("Kalibr's");
    let p = &file.imu.parameters;
    assert_eq!(p[SensorKind::Accelerometer].matrix[(1, 0)], 0.02);
    assert!((p[SensorKind::Gyroscope].matrix[(0, 1)] + 0.3).abs() < 1e-15, "M_g C_gyro_i");
    assert!((p[SensorKind::Gyroscope].matrix[(1, 0)] - (0.08 + 0.36)).abs() < 1e-15);
    assert!((p.g_sensitivity[(0, 0)] - (0.8 * 3e-4 + 0.6 * 1e-4)).abs() < 1e-18, "A C_gyro_i");
    assert!(file.findings[0].message().contains("does not say biases"), "{:?}", file.findings);
    let noise = file.noise.clone().expect("there");
    assert_eq!((noise.accelerometer_density, noise.update_rate_hz), (Some(0.00668), Some(200.0)));
    let after = there_and_back(&file, ImuFormat::Kalibr).remove(0);
    assert_eq!(after.noise, file.noise);
    // biases that are not known stay unknown: on the way and through another format
    for format in [ImuFormat::Kalibr, ImuFormat::CalibrantJson] {
        let after = there_and_back(&file, format).remove(0).imu;
        assert!(SensorKind::ALL.into_iter().all(|sensor_kind| !after.has_bias(sensor_kind)), "{format:?}");
        assert_eq!(after.quantities.len(), 27, "{format:?}");
    }
    // the plain file that Kalibr reads has noise alone
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("imu.yaml");
    let plain = "#Accelerometers\naccelerometer_noise_density: 1.86e-03\naccelerometer_random_walk: 4.33e-04\n\
                 gyroscope_noise_density: 1.87e-04\ngyroscope_random_walk: 2.66e-05\nrostopic: /imu0\nupdate_rate: 200.0\n";
    std::fs::write(&path, plain).expect("written");
    assert_eq!(read_kalibr_noise(&path).expect("noise").gyroscope_density, Some(1.87e-4));
    let error =
        read_calibrated_imu(&path, &ConventionOptions::default()).expect_err("no calibration").to_string();
    assert!(error.contains("there is no calibration in it: model calibrated"), "{error}");
}

#[test]
fn biases_beside_the_matrix_are_read_and_unknown_numbers_are_refused() {
    let text = "model: scale-misalignment\naccelerometer_noise_density: 0.0\ngyroscope_noise_density: 2.0e-4\n\
                accelerometers:\n  M: [[1.01, 0, 0], [0, 1.02, 0], [0, 0, 1.03]]\n  b: [0.1151, -0.1288, 0.0829]\n\
                gyroscopes:\n  M: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n  b: [0.03, 0.01, -0.02]\n";
    let read = |text: &str| parse_calibrated_imu(text.as_bytes(), &ConventionOptions::default());
    let file = read(text).expect("as dedrunk-cli writes it");
    assert_eq!(file.imu.parameters[SensorKind::Accelerometer].bias, Vector3::new(0.1151, -0.1288, 0.0829));
    assert_eq!(file.imu.parameters[SensorKind::Gyroscope].bias, Vector3::new(0.03, 0.01, -0.02));
    assert!(SensorKind::ALL.into_iter().all(|sensor_kind| file.imu.has_bias(sensor_kind)));
    let written = calibrant::io::calibrated_imu_texts(&file, ImuFormat::Kalibr).expect("carried").remove(0).1;
    assert!(written.contains("    b: [0.1151, -0.1288, 0.0829]\n"), "as it was read: {written}");
    let [note] = &file.findings[..] else { panic!("{:?}", file.findings) };
    assert!(note.message().contains("does not say accelerometer_noise_density: 0"), "{note:?}");
    let noise = file.noise.expect("one density is stated");
    assert_eq!((noise.accelerometer_density, noise.gyroscope_density), (None, Some(2e-4)));
    for (before, after, says) in [
        ("  b: [0.1151", "  offset: [0.1151", "`accelerometers.offset` has numbers"),
        ("  b: [0.03", "  bias: [0.03", "`gyroscopes.bias` has numbers"),
        ("model: scale", "Tw: [[1.0]]\nmodel: scale", "`Tw` has numbers"),
        (
            "gyroscopes:",
            "calibrant: {accelerometer_bias: [0, 0, 0]}\ngyroscopes:",
            "two biases of one sensor",
        ),
        ("density: 0.0", "density: -1.0", "is not a positive number"),
    ] {
        let error = read(&text.replace(before, after)).expect_err(says).to_string();
        assert!(error.contains(says), "{error}");
    }
}

#[test]
fn imucals_units_are_converted() {
    let text = r#"{"acc_unit": "g", "gyr_unit": "deg/s", "from_acc_unit": "g", "from_gyr_unit": "rad/s", "comment": null,
      "K_a": [[2, 0, 0], [0, 2, 0], [0, 0, 2]], "R_a": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "b_a": [0.1, 0, 0],
      "K_g": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "R_g": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
      "K_ga": [[0.5, 0, 0], [0, 0, 0], [0, 0, 0]], "b_g": [0.2, 0, 0], "cal_type": "Turntable", "_format_version": "2.0.0"}"#;
    let imu = parse_calibrated_imu(text.as_bytes(), &ConventionOptions::default()).expect("imucal's").imu;
    let p = &imu.parameters;
    assert!((p[SensorKind::Accelerometer].matrix[(0, 0)] - 2.0).abs() < 1e-15, "g per g");
    assert!((p[SensorKind::Accelerometer].bias.x - 0.980665).abs() < 1e-15);
    assert!(
        (p[SensorKind::Gyroscope].matrix[(0, 0)] - 180.0 / std::f64::consts::PI).abs() < 1e-12,
        "rad/s per deg/s"
    );
    assert!((p[SensorKind::Gyroscope].bias.x - 0.2).abs() < 1e-15);
    assert!((p.g_sensitivity[(0, 0)] - 0.5 / 9.80665).abs() < 1e-15, "rad/s per g");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_right_handed_imu_goes_there_and_back(
        entries in prop::collection::vec(-0.4_f64..0.4, 33),
        gain in 1e-3_f64..1e4,
        zero in -1e5_f64..1e5,
        counts in any::<bool>(),
    ) {
        let mut before = imu(if counts { COUNTS } else { SI }, true);
        before.covariance = None;
        let identity = calibrant::sensor::ImuParameters::identity();
        before.parameters = identity;
        for (quantity, step) in ImuQuantity::full_list(true, true, true).into_iter().zip(&entries) {
            quantity.add_to(&mut before.parameters, step / 3.0);
        }
        for kind in SensorKind::ALL {
            let sensor = &mut before.parameters[kind];
            sensor.matrix *= gain;
            sensor.bias *= zero;
        }
        let readings = readings(&before, 20, 4);
        // the readings' own rounding after the correction
        let rounding = 1e-15 * (zero.abs() / gain + 100.0) * 30.0;
        for format in [ImuFormat::Kalibr, ImuFormat::Imucal, ImuFormat::CHeader, ImuFormat::CalibrantJson] {
            let after = there_and_back(&file(before.clone()), format).remove(0);
            let difference = largest_difference(&before, &after.imu, &readings);
            prop_assert!(difference < rounding.max(1e-12), "{} {difference:e}", format.name());
        }
        let gauge = before.in_gauge(Gauge::Upper).expect("right-handed");
        let (a, b) = (before.invariants(), gauge.invariants());
        for (a, b) in a.iter().zip(&b) {
            prop_assert!((a.value - b.value).abs() < 1e-9 * a.value.abs().max(1e-3), "{}", a.invariant.name());
        }
    }
}
