//! Tests of the accelerometer alone, read from any file.

use calibrant::Error;
use calibrant::io::{ImuReadOptions, ImuUnit, ReadOptions, RecordingFile, read_accelerometer};
use calibrant::sensor::ReadingUnit;

/// The options of the plain reader.
const PLAIN: ReadOptions =
    ReadOptions { unit: None, expected_unit: ReadingUnit::MetrePerSecondSquared, axes: 3 };

fn read(text: &str, options: &ReadOptions, device: &ImuReadOptions) -> Result<RecordingFile, Error> {
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), text).expect("written");
    read_accelerometer(file.path(), options, device)
}

fn first(text: &str) -> Vec<f64> {
    let file =
        read(text, &PLAIN, &ImuReadOptions::default()).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(file.recording.unit, ReadingUnit::MetrePerSecondSquared);
    assert_eq!(file.recording.times_s, [0.0, 0.01], "{text}");
    file.recording.readings[0].as_slice().to_vec()
}

#[test]
fn every_dialect_gives_the_accelerometer_and_not_the_gyroscope() {
    for text in [
        "t_s,ax,ay,az\n0.00,1,2,9\n0.01,1,2,9.1\n",
        "0.00 1 2 9\n0.01 1 2 9.1\n",
        "# t_s,ax,ay,az\n0.00,1,2,9\n0.01,1,2,9.1\n",
        "t_s,gx_radps,gy_radps,gz_radps,ax,ay,az\n0.00,5,6,7,1,2,9\n0.01,5,6,8,1,2,9.1\n",
        "# t_s,gx_radps,gy_radps,gz_radps,ax_mps2,ay_mps2,az_mps2\n0.00,5,6,7,1,2,9\n0.01,5,6,8,1,2,9.1\n",
        "// Update Rate: 100.0Hz\nPacketCounter\tGyr_X\tGyr_Y\tGyr_Z\tAcc_X\tAcc_Y\tAcc_Z\n7\t5\t6\t7\t1\t2\t9\n8\t5\t6\t8\t1\t2\t9.1\n",
        "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n\
         0,5,6,7,1,2,9\n10000000,5,6,8,1,2,9.1\n",
    ] {
        assert_eq!(first(text), [1.0, 2.0, 9.0], "{text}");
    }
}

#[test]
fn what_the_user_says_of_the_file_counts() {
    let text = "n_samples,gyr_x,gyr_y,gyr_z,acc_x,acc_y,acc_z\n0,5,6,7,1,0,0\n1,5,6,8,0,1,0\n2,5,6,8,0,0,1\n";
    let question = read(text, &PLAIN, &ImuReadOptions::default()).expect_err("no rate, no unit").to_string();
    assert!(question.contains("--accelerometer-unit") && question.contains("--rate-hz"), "{question}");
    let device = ImuReadOptions {
        accelerometer_unit: Some(ImuUnit::StandardGravity),
        gyroscope_unit: Some(ImuUnit::DegreePerSecond),
        rate_hz: Some(100.0),
        ..ImuReadOptions::default()
    };
    let file = read(text, &PLAIN, &device).expect("good");
    assert_eq!(file.recording.readings[0].as_slice(), [9.80665, 0.0, 0.0]);
    let uniaxial = ReadOptions { axes: 1, ..PLAIN };
    let file = read(text, &uniaxial, &device).expect("good");
    assert_eq!((file.recording.axes, file.recording.readings[1].as_slice()), (1, &[0.0; 3][..]));
    let gyroscope = "t_s,gx_radps,gy_radps,gz_radps\n0.00,5,6,7\n0.01,5,6,8\n";
    let error = read(gyroscope, &PLAIN, &ImuReadOptions::default()).expect_err("none").to_string();
    assert!(error.contains("no accelerometer"), "{error}");
}
