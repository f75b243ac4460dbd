//! Tests of the formats that other programs take: an independent reader of each file corrects as we do.

mod readers;

use super::{COUNTS, SI, file, imu, largest_difference, readings};
use calibrant::Conversion;
use calibrant::diagnostic::Diagnostic;
use calibrant::io::{
    ConventionOptions, ImuFormat, calibrated_imu_texts, edit_calibrated_imu, parse_calibrated_imu,
    read_calibrated_imu, write_calibrated_imu,
};
use calibrant::sensor::{CalibratedImu, Gauge, ImuCorrection, ImuPart, ImuQuantity, SensorKind};
use nalgebra::{Matrix3, Rotation3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use readers::{corrected, imu_calib};

/// The range of temperatures of the random calibrations, °C.
const RANGE_C: [f64; 2] = [-10.0, 60.0];

/// A random IMU in SI units, without a covariance: 3 % of everything, and terms of temperature.
fn random(rng: &mut ChaCha8Rng) -> CalibratedImu {
    let mut random = |size: f64| rng.random_range(-size..size);
    let mut imu = CalibratedImu { covariance: None, ..imu(SI, true) };
    let p = &mut imu.parameters;
    for (kind, bias) in [(SensorKind::Accelerometer, 0.5), (SensorKind::Gyroscope, 0.05)] {
        p[kind].matrix = Matrix3::identity() + Matrix3::from_fn(|_, _| random(0.03));
        p[kind].bias = Vector3::from_fn(|_, _| random(bias));
        for (order, size) in [(0, 0.01), (1, 1e-4), (2, 1e-6)] {
            p.thermal[kind].bias[order] = Vector3::from_fn(|_, _| random(bias * size));
            p.thermal[kind].scale[order] = Vector3::from_fn(|_, _| random(0.01 * size));
        }
    }
    p.g_sensitivity = Matrix3::from_fn(|_, _| random(2e-4));
    p.thermal.reference_c = 25.0 + random(10.0);
    p.thermal.range_c = Some(RANGE_C);
    imu.quantities.extend(ImuQuantity::all_thermal(true, true));
    imu
}

/// 200 of them.
fn calibrations() -> impl Iterator<Item = CalibratedImu> {
    let mut rng = ChaCha8Rng::seed_from_u64(50);
    (0..200).map(move |_| random(&mut rng))
}

fn cold(imu: &CalibratedImu) -> CalibratedImu {
    imu.at(imu.parameters.thermal.reference_c).expect("positive gains")
}

/// Fails where the reader of a format and our own correction differ by more than this share.
fn same(imu: &CalibratedImu, format: ImuFormat, celsius: [f64; 2], share: f64, seed: u64) {
    let [here, counted] = celsius;
    let theirs = corrected(&file(imu.clone()), format);
    let ours = ImuCorrection::of(imu).and_then(|of| of.at(counted)).expect("regular");
    for raw in readings(&cold(imu), 50, seed) {
        let force = ours.force(&raw[0]).expect("there");
        let expected = [force, ours.rate(&raw[1], &force).expect("there")];
        for (found, expected) in theirs(&raw, here).iter().zip(expected) {
            let error = (found - expected).norm();
            assert!(error <= share * expected.norm(), "{} at {here} °C: {error:e}", format.name());
        }
    }
}

#[test]
fn whole_matrices_correct_as_we_do() {
    let mut rng = ChaCha8Rng::seed_from_u64(51);
    for (seed, imu) in calibrations().enumerate() {
        let mut imu = cold(&imu);
        // any true frame
        let turn = Rotation3::from_euler_angles(rng.random(), rng.random(), rng.random()).into_inner();
        imu.parameters[SensorKind::Accelerometer].matrix *= turn;
        imu.parameters[SensorKind::Gyroscope].matrix *= turn;
        imu.parameters.g_sensitivity *= turn;
        let lower = imu.in_gauge(Gauge::Lower).expect("regular");
        let seed = seed as u64;
        same(&lower, ImuFormat::OpenVins, [25.0; 2], 1e-12, seed);
        let warnings = |format| {
            let directory = tempfile::tempdir().expect("a directory");
            let written = write_calibrated_imu(&directory.path().join("out"), &file(imu.clone()), format);
            let written = written.expect("written");
            written.warnings.iter().map(Diagnostic::message).collect::<String>() + &written.frame
        };
        if seed == 0 {
            let said = warnings(ImuFormat::OpenVins);
            assert!(said.contains("the true frame is turned by ") && said.contains("lower gauge"), "{said}");
        }
        // a file in another frame is turned on the way
        let texts = [&imu, &lower].map(|imu| calibrated_imu_texts(&file(imu.clone()), ImuFormat::OpenVins));
        let [one, other] = texts.map(|texts| texts.expect("carried").remove(0).1);
        assert_eq!(one, other);
        assert!(
            one.starts_with("%YAML:1.0\n") && !one.contains("\n  - "),
            "OpenCV stops at lists as deep as their key"
        );
        let back = parse_calibrated_imu(one.as_bytes(), &ConventionOptions::default()).expect("read").imu;
        assert!(largest_difference(&back, &lower, &readings(&lower, 50, seed)) < 1e-12);
        let [imu, lower] = [imu, lower].map(|imu| imu.without(ImuPart::GSensitivity));
        same(&lower, ImuFormat::Basalt, [25.0; 2], 1e-12, seed);
        same(&imu, ImuFormat::ImuFusion, [25.0; 2], 1e-12, seed);
        same(&imu, ImuFormat::LibRealSense, [25.0; 2], 1e-12, seed);
    }
}

#[test]
fn an_accelerometer_alone_is_for_imu_calib() {
    for imu in calibrations() {
        let imu = cold(&imu);
        let text = |imu: CalibratedImu| calibrated_imu_texts(&file(imu), ImuFormat::ImuCalib);
        let refused = text(imu.clone()).expect_err("a gyroscope").to_string();
        assert!(refused.contains("option `sensor` accelerometer"), "{refused}");
        let alone = imu.only(SensorKind::Accelerometer);
        let text = text(alone.clone()).expect("carried").remove(0).1;
        let ours = ImuCorrection::of(&alone).and_then(|of| of.at(25.0)).expect("regular");
        for raw in readings(&imu, 10, 7) {
            let (found, expected) = (imu_calib(&text, &raw[0]), ours.force(&raw[0]).expect("there"));
            assert!((found - expected).norm() <= 1e-12 * expected.norm(), "{found} {expected}");
        }
    }
}

const AUTOPILOTS: [ImuFormat; 2] = [ImuFormat::Px4, ImuFormat::ArduPilot];

#[test]
fn autopilots_correct_as_we_do_below_in_and_above_the_temperatures() {
    for (seed, imu) in calibrations().enumerate() {
        let plain = ImuPart::ALL.into_iter().fold(imu, |imu, part| imu.without(part));
        for format in AUTOPILOTS {
            for celsius in [-40.0, -10.0, 17.5, 35.0, 60.0, 85.0_f64] {
                let counted = celsius.clamp(RANGE_C[0], RANGE_C[1]);
                same(&plain, format, [celsius, counted], 1e-6, seed as u64);
            }
            same(&cold(&plain), format, [85.0, 25.0], 1e-6, seed as u64);
        }
    }
}

/// Of an order that they do not have, the nearest polynomial is written, and the stated error bounds what a reader errs by.
#[test]
fn a_higher_order_is_projected_with_its_largest_error() {
    for imu in calibrations().take(20) {
        let mut plain = ImuPart::ALL.into_iter().fold(imu, |imu, part| imu.without(part));
        for (kind, size) in [(SensorKind::Accelerometer, 1e-8), (SensorKind::Gyroscope, 1e-9)] {
            plain.parameters.thermal[kind].bias[3] = Vector3::new(size, -size, 0.0);
            plain.parameters.thermal[kind].bias[4] = Vector3::new(0.0, 0.02 * size, -0.01 * size);
        }
        let directory = tempfile::tempdir().expect("a directory");
        for format in AUTOPILOTS {
            let written = write_calibrated_imu(&directory.path().join("out"), &file(plain.clone()), format);
            let warnings = written.expect("written").warnings;
            let said =
                warnings.iter().find(|found| found.code().name() == "polynomial-shortened").expect("said");
            let stated = |kind: &str| -> f64 {
                let message = said.message();
                let after = message.split_once(&format!("the {kind} by up to ")).expect("stated").1;
                after.split(' ').next().and_then(|number| number.parse().ok()).expect("a number")
            };
            let theirs = corrected(&file(plain.clone()), format);
            let mut largest = [0.0_f64; 2];
            for celsius in (-10..=60).map(f64::from) {
                let ours = ImuCorrection::of(&plain).and_then(|of| of.at(celsius)).expect("regular");
                let raw = &readings(&cold(&plain), 1, 3)[0];
                let force = ours.force(&raw[0]).expect("there");
                let expected = [force, ours.rate(&raw[1], &force).expect("there")];
                for ((found, expected), largest) in
                    theirs(raw, celsius).iter().zip(expected).zip(&mut largest)
                {
                    *largest = largest.max((found - expected).amax());
                }
            }
            for (kind, found) in ["accelerometer", "gyroscope"].into_iter().zip(largest) {
                let stated = stated(kind);
                assert!(found <= 1.01 * stated + 3e-6 && stated <= 2.0 * found, "{kind}: {found} {stated}");
            }
        }
    }
}

/// The stated error bounds what a reader errs by, and is at most twice that.
#[test]
fn the_error_without_the_parts_is_as_stated() {
    let mut rng = ChaCha8Rng::seed_from_u64(52);
    let mut direction = move || {
        let vector = Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0_f64));
        if vector.norm() > 0.1 { vector.normalize() } else { Vector3::x() }
    };
    for imu in calibrations() {
        let lower = cold(&imu).in_gauge(Gauge::Lower).expect("regular");
        let kinds = [ImuFormat::Px4, ImuFormat::ArduPilot, ImuFormat::Basalt, ImuFormat::LibRealSense];
        for format in kinds {
            let whole = if AUTOPILOTS.contains(&format) { &imu } else { &lower };
            let drop =
                if AUTOPILOTS.contains(&format) { &ImuPart::ALL[..] } else { &[ImuPart::GSensitivity] };
            let refused =
                calibrated_imu_texts(&file(whole.clone()), format).expect_err("refused").to_string();
            let names: Vec<_> = drop.iter().map(|part| part.name()).collect();
            assert!(refused.contains(&format!("option `drop` {}", names.join(","))), "{refused}");
            let mut changed = file(whole.clone());
            let conversion = Conversion { drop: drop.to_vec(), ..Conversion::default() };
            let notes = conversion.change(&mut changed).expect("possible");
            let stated = |sensor: &str| {
                let note = notes.iter().find(|note| note.message().starts_with(sensor));
                note.map_or(0.0, |note| note.number("largest_error").expect("stated"))
            };
            let theirs = corrected(&changed, format);
            let mut largest = [0.0_f64; 2];
            for sample in 0..50 {
                let celsius = RANGE_C[sample % 2];
                let (force, rate) = (9.80665 * direction(), 100f64.to_radians() * direction());
                let p = whole.parameters.at(celsius);
                let raw = [
                    p[SensorKind::Accelerometer].reading(&force),
                    p[SensorKind::Gyroscope].reading(&rate) + p.g_sensitivity * force,
                ];
                for ((found, truth), largest) in
                    theirs(&raw, celsius).iter().zip([force, rate]).zip(&mut largest)
                {
                    *largest = largest.max((found - truth).amax());
                }
            }
            for (sensor, found) in ["accelerometer", "gyroscope"].into_iter().zip(largest) {
                let stated = stated(sensor);
                assert!(found <= stated + 3e-6, "{} {sensor}: {found} {stated}", format.name());
                assert!(stated <= 2.0 * found.max(1e-9), "{} {sensor}: {found} {stated}", format.name());
            }
        }
    }
}

#[test]
fn what_a_target_cannot_take_is_refused() {
    let refusal = |imu: &CalibratedImu, format| {
        calibrated_imu_texts(&file(imu.clone()), format).expect_err("refused").to_string()
    };
    let counts = imu(COUNTS, false);
    let warm = calibrations().next().expect("one").without(ImuPart::GSensitivity);
    for format in ImuFormat::ALL.into_iter().skip(5) {
        if format != ImuFormat::ImuFusion {
            let message = refusal(&counts, format);
            assert!(message.contains("those of the accelerometer are counts"), "{message}");
        }
        if !AUTOPILOTS.contains(&format) {
            let message = refusal(&warm, format);
            assert!(
                message.contains("the accelerometer by up to") && message.contains("from -10 to 60 °C"),
                "{message}"
            );
        }
    }
    let mut plain = ImuPart::ALL.into_iter().fold(warm, |imu, part| imu.without(part));
    plain.parameters.thermal.range_c = Some([20.0, 29.0]);
    assert!(refusal(&plain, ImuFormat::ArduPilot).contains("at least 10 K apart"));
    plain.parameters.thermal.range_c = None;
    assert!(refusal(&plain, ImuFormat::Px4).contains("wants the range of temperatures"));
    let mut strong = cold(&plain);
    strong.parameters[SensorKind::Accelerometer].matrix *= 1.3;
    assert!(refusal(&strong, ImuFormat::ArduPilot).contains("gains of the accelerometer from 0.8 to 1.2"));
    let alone = plain.only(SensorKind::Accelerometer);
    assert!(refusal(&cold(&alone), ImuFormat::OpenVins).contains("there is no gyroscope"));
}

#[test]
fn a_file_of_basalt_keeps_all_other_bytes() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("calibration.json");
    let imu = cold(&calibrations().next().expect("one")).without(ImuPart::GSensitivity);
    let (before, after) = (
        "{\n  \"value0\": {\"T_imu_cam\": [ {\"px\": 1e-3,\n\"x\": [\"}]\"]}],\n \"calib_accel_bias\":",
        ",\n\"cam_time_offset_ns\" : 0 }\n} \n",
    );
    std::fs::write(&path, format!("{before}  [0, 0, 0, 0, 0, 0, 0, 0, 0]{after}")).expect("written");
    let written = edit_calibrated_imu(&path, &file(imu.clone())).expect("edited");
    assert_eq!(written.files, std::slice::from_ref(&path));
    let text = std::fs::read_to_string(&path).expect("there");
    let own = calibrated_imu_texts(&file(imu.in_gauge(Gauge::Lower).expect("regular")), ImuFormat::Basalt);
    let own: serde_json::Value = serde_json::from_str(&own.expect("carried")[0].1).expect("JSON");
    let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    for key in ["calib_accel_bias", "calib_gyro_bias", "imu_update_rate"] {
        assert_eq!(value["value0"][key], own["value0"][key], "{key}");
    }
    // without the keys that were added, and the list that was replaced
    let (head, rest) = text.split_once("{\n        \"calib_gyro_bias\"").expect("added first");
    let (_, rest) = rest.split_once("\"T_imu_cam\"").expect("kept");
    let (kept, rest) = rest.split_once("  [").expect("replaced");
    let (_, tail) = rest.split_once(']').expect("the end of the list");
    assert_eq!(format!("{head}{{\"T_imu_cam\"{kept}"), before);
    assert_eq!(tail, after);
    std::fs::write(&path, "{\"value1\": {}}").expect("written");
    let error = edit_calibrated_imu(&path, &file(imu)).expect_err("no basalt").to_string();
    assert!(error.contains("there is no \"value0\" in it"), "{error}");
}

#[test]
fn rate_and_topic_are_written_where_they_are_known() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("imu.yaml");
    for format in [ImuFormat::Kalibr, ImuFormat::OpenVins] {
        let mut given = file(imu(SI, true));
        let written = write_calibrated_imu(&path, &given, format).expect("written");
        let said = written.warnings.iter().map(Diagnostic::message).collect::<String>();
        assert!(
            said.contains("rostopic (/imu0 stands in its place)") && !said.contains("update_rate as"),
            "{said}"
        );
        let text = std::fs::read_to_string(&path).expect("there");
        assert!(
            text.contains("  rostopic: /imu0 # a placeholder\n  update_rate: 100.0\n")
                || text.contains("  update_rate: 100.0\n  rostopic: /imu0"),
            "{text}"
        );
        let conversion = Conversion {
            rostopic: Some("/imu/raw".into()),
            update_rate_hz: Some(400.0),
            ..Conversion::default()
        };
        conversion.change(&mut given).expect("possible");
        write_calibrated_imu(&path, &given, format).expect("written");
        let noise =
            read_calibrated_imu(&path, &ConventionOptions::default()).expect("read").noise.expect("there");
        assert_eq!((noise.rostopic.as_deref(), noise.update_rate_hz), (Some("/imu/raw"), Some(400.0)));
    }
}
