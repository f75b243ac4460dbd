//! Tests of real recordings of IMUs.

use super::{findings, units, used};
use crate::common::shared_data;
use calibrant::diagnostic::Check;
use calibrant::diagnostic::reader::ValuesMissing;
use calibrant::io::{FileFormat, ImuReadOptions, ImuUnit, read_imu_pair, read_imu_recording};
use calibrant::sensor::{ReadingUnit, SensorKind};

#[test]
fn the_pair_of_imu_tk_reads_whole() {
    let (Some(acc), Some(gyr)) =
        (shared_data("xsens-mti-static/xsens_acc.mat"), shared_data("xsens-mti-static/xsens_gyro.mat"))
    else {
        return;
    };
    let file = read_imu_pair(&acc, &gyr, &units(ImuUnit::Counts, ImuUnit::Counts)).expect("good");
    assert_eq!((file.format, file.rows), (FileFormat::ImuTk, 51_175));
    let (accelerometer, gyroscope) = (
        file.recording[SensorKind::Accelerometer].clone().expect("there"),
        file.recording[SensorKind::Gyroscope].clone().expect("there"),
    );
    assert_eq!((accelerometer.unit(), gyroscope.unit()), (ReadingUnit::Counts, ReadingUnit::Counts));
    assert_eq!(accelerometer.readings()[0].as_slice(), [33108.0, 33329.0, 36429.0]);
    assert_eq!(gyroscope.readings()[0].as_slice(), [32786.0, 32429.0, 32499.0]);
    assert_eq!(accelerometer.times_s(), gyroscope.times_s());
    assert_eq!(gyroscope.times_s().last(), Some(&511.718));
    let question = read_imu_pair(&acc, &gyr, &ImuReadOptions::default()).expect_err("no units").to_string();
    assert!(
        question.contains("the accelerometer's columns have no unit: magnitudes around 57100 suggest counts"),
        "{question}"
    );
}

#[test]
fn the_ferraris_session_of_imucal_asks_for_units_and_rate() {
    let Some(path) = shared_data("imucal-ferraris/example_ferraris_session.csv") else { return };
    let question = read_imu_recording(&path, &ImuReadOptions::default()).expect_err("asks").to_string();
    for word in [
        "the accelerometer's columns have no unit: magnitudes around 10.3",
        " suggest m/s²; the gyroscope's columns have no unit: magnitudes up to ",
        " suggest deg/s; the file has no sample times, and nothing in it says the sample rate",
        "say option `accelerometer_unit` m/s², mm/s², g, mg or counts (accelerometer_unit in [columns]); option `gyroscope_unit` rad/s, deg/s, mdps or counts (gyroscope_unit in [columns]); option `rate_hz`, or rate_hz in [columns]",
    ] {
        assert!(question.contains(word), "{word}\n{question}");
    }
    let options = ImuReadOptions {
        rate_hz: Some(102.4),
        ..units(ImuUnit::MetrePerSecondSquared, ImuUnit::DegreePerSecond)
    };
    let file = read_imu_recording(&path, &options).expect("good");
    assert_eq!(file.format, FileFormat::Imucal);
    let gyroscope = file.recording[SensorKind::Gyroscope].as_ref().expect("there");
    assert_eq!(gyroscope.unit(), ReadingUnit::RadianPerSecond);
    assert!((gyroscope.readings()[0].x - (-0.6103515625_f64).to_radians()).abs() < 1e-15);
    assert_eq!(gyroscope.times_s()[1024], 10.0);
    assert_eq!(gyroscope.len(), file.rows);
    assert_eq!(
        findings(&file)[0],
        "the file has no sample times: they are computed from the counter `n_samples` and 102.4 Hz (as given); its uncertainty is 5 % (option `rate_sd_ppm`, or rate_sd_ppm in [columns])"
    );
}

#[test]
fn every_sample_file_of_mt_manager_is_read_or_refused_with_the_reason() {
    let mt = |name: &str| shared_data(&format!("mt-manager/{name}"));
    let all = ["Acc_X", "Acc_Y", "Acc_Z", "Gyr_X", "Gyr_Y", "Gyr_Z"];
    let with_rate = ImuReadOptions { rate_hz: Some(100.0), ..ImuReadOptions::default() };
    if let Some(path) = mt("MT46_01-000_00B42D4D.txt") {
        let file = read_imu_recording(&path, &ImuReadOptions::default()).expect("good");
        assert_eq!(file.format, FileFormat::MtManager);
        assert_eq!(used(&file)[0], "PacketCounter");
        assert_eq!(used(&file)[1..], all);
        let gyroscope = file.recording[SensorKind::Gyroscope].as_ref().expect("there");
        assert_eq!((gyroscope.unit(), gyroscope.len()), (ReadingUnit::RadianPerSecond, file.rows));
        assert_eq!(gyroscope.readings()[0].as_slice(), [0.024471, 0.002012, 0.007768]);
        assert_eq!(gyroscope.times_s()[..3], [0.0, 0.01, 0.02]);
    }
    if let Some(path) = mt("MT2022_ACC_GYRO_ROT_ALL_TAB_NAN_00B42D4B.txt") {
        let question =
            read_imu_recording(&path, &ImuReadOptions::default()).expect_err("no rate").to_string();
        assert!(
            question.contains(
                "its sample times are missing, and nothing in it says the sample rate (say option `rate_hz`"
            ),
            "{question}"
        );
        let file = read_imu_recording(&path, &with_rate).expect("good");
        assert_eq!(used(&file)[1..], all);
        let missing: Vec<_> =
            file.findings.iter().filter(|finding| finding.code() == ValuesMissing::CODE).collect();
        assert_eq!(missing.len(), 1, "{:?}", file.findings);
        assert_eq!(missing[0].line(), Some(14));
        let accelerometer = file.recording[SensorKind::Accelerometer].as_ref().expect("there");
        assert_eq!(accelerometer.len() + 1, file.rows);
        assert_eq!(file.recording[SensorKind::Gyroscope].as_ref().expect("there").len(), file.rows);
    }
    if let Some(path) = mt("MT2022_ACC_GYRO_ROT_MAT_SEMICOLON_00B42D4B.txt") {
        let file = read_imu_recording(&path, &with_rate).expect("good");
        assert_eq!(used(&file)[1..], all);
        assert_eq!(
            file.recording[SensorKind::Accelerometer].as_ref().expect("there").readings()[0].z,
            9.922524
        );
    }
    if let Some(path) = mt("MT_012005D6-000_sit_to_stand-000_00B421ED.txt") {
        let reason =
            read_imu_recording(&path, &ImuReadOptions::default()).expect_err("no readings").to_string();
        assert!(
            reason.contains(
                ":6: the file holds orientation only (`Mat[1][1]`, `Mat[2][1]`, `Mat[3][1]` and 6 more): no reading of a sensor"
            ),
            "{reason}"
        );
    }
}
