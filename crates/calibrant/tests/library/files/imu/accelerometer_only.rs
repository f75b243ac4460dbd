//! Tests of the accelerometer alone, read from any file.

use super::{read, refused};
use calibrant::diagnostic::Check;
use calibrant::diagnostic::reader::UnitUnexpected;
use calibrant::io::{ImuReadOptions, ImuUnit, TimeUnit};
use calibrant::sensor::{ReadingUnit, Recording};

fn options(axes: usize) -> ImuReadOptions {
    ImuReadOptions::accelerometer(axes, ReadingUnit::MetrePerSecondSquared)
}

fn recording(text: &str, options: &ImuReadOptions) -> Recording {
    let recording = read(text, options).recording;
    recording.accelerometer_alone().unwrap_or_else(|| panic!("{text}")).clone()
}

fn first(text: &str) -> Vec<f64> {
    let recording = recording(text, &options(3));
    assert_eq!(recording.unit(), ReadingUnit::MetrePerSecondSquared);
    assert_eq!(recording.times_s(), [0.0, 0.01], "{text}");
    recording.readings()[0].as_slice().to_vec()
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
    let question = refused(text, &options(3));
    assert!(
        question.contains("option `accelerometer_unit`") && question.contains("option `rate_hz`"),
        "{question}"
    );
    let device = ImuReadOptions {
        accelerometer_unit: Some(ImuUnit::StandardGravity),
        gyroscope_unit: Some(ImuUnit::DegreePerSecond),
        rate_hz: Some(100.0),
        ..options(3)
    };
    assert_eq!(recording(text, &device).readings()[0].as_slice(), [9.80665, 0.0, 0.0]);
    let uniaxial = recording(text, &options(1).or(device));
    assert_eq!((uniaxial.axes(), uniaxial.readings()[1].as_slice()), (1, &[0.0; 3][..]));
    let gyroscope = "t_s,gx_radps,gy_radps,gz_radps\n0.00,5,6,7\n0.01,5,6,8\n";
    let error = refused(gyroscope, &options(3));
    assert!(error.contains("no accelerometer"), "{error}");
}

#[test]
fn columns_of_other_names_are_read_once_their_units_are_known() {
    let text = "time,x,y,z,note\n0,1,2,9,a\n10,1,2,9.1,b\n";
    let question = refused(text, &options(3));
    assert!(
        question.contains("option `time_unit`") && question.contains("option `accelerometer_unit`"),
        "{question}"
    );
    let given = ImuReadOptions {
        time_unit: Some(TimeUnit::Millisecond),
        accelerometer_unit: Some(ImuUnit::MetrePerSecondSquared),
        ..options(3)
    };
    assert_eq!(recording(text, &given).times_s(), [0.0, 0.01]);
    // the unit is the experiment's only where the names are those of a plain text
    assert!(refused(&text.replace("time", "t_s"), &options(3)).contains("option `accelerometer_unit`"));
}

#[test]
fn a_comment_may_name_the_columns_of_a_plain_text() {
    let in_comment = |names: &str| {
        let text = format!("# comment\n# {names}\n0.00 0 0 1\n0.01 0 0 2\n");
        let recording = recording(&text, &options(3));
        (recording.times_s()[1], recording.readings()[0].z)
    };
    assert_eq!(in_comment("time ax ay az"), (0.01, 1.0), "seconds, as without a name");
    assert_eq!(in_comment("t_ms ax_g ay_g az_g"), (1e-5, 9.80665), "a unit that is stated counts");
}

#[test]
fn a_row_without_a_value_does_not_replace_the_next_of_its_time() {
    let text = "t_s,ax,ay,az\n0,1,2,3\n1,,9,9\n1,2,3,4\n2,3,4,5\n";
    assert_eq!(recording(text, &options(3)).readings()[1].as_slice(), [2.0, 3.0, 4.0]);
}

#[test]
fn times_of_a_plain_text_may_have_another_unit() {
    let text = "t_ms,ax,ay,az\n0,1,2,9\n10,1,2,9.1\n";
    assert_eq!(recording(text, &options(3)).times_s(), [0.0, 0.01]);
    let both = "t_s,timestamp_ms,ax,ay,az\n0,7,1,2,9\n0.01,8,1,2,9.1\n";
    assert_eq!(recording(both, &options(3)).times_s(), [0.0, 0.01]);
}

#[test]
fn a_unit_that_the_experiment_does_not_expect_is_a_finding() {
    let text = "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n\
                0,5,6,7,1,2,9\n10000000,5,6,8,1,2,9.1\n";
    let in_counts = ImuReadOptions::accelerometer(3, ReadingUnit::Counts);
    let codes: Vec<_> = read(text, &in_counts).findings.iter().map(|finding| finding.code()).collect();
    assert!(codes.contains(&UnitUnexpected::CODE), "{codes:?}");
}
