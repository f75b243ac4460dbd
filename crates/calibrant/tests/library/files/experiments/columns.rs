//! Cases of broken `[columns]`, with their messages.

use super::{Case, HOLDS, MOTION};
use calibrant::io::{ColumnMapping, Experiment, FileFormat, ImuReadOptions, ImuUnit, SampleTimes, TimeUnit};

/// The broken `[columns]`.
pub(super) const CASES: &[Case] = &[
    (
        "gauge = \"upper\"",
        "gauge = \"upper\"⏎[columns]⏎accelerometr = [\"a\", \"b\", \"c\"]",
        r#"line 13, column 1: `columns.accelerometr`: unknown key (did you mean `accelerometer`?)"#,
    ),
    (
        "gauge = \"upper\"",
        "gauge = \"upper\"⏎[columns]⏎accelerometer = [\"a\", \"b\"]",
        r#"line 13, column 17: `columns.accelerometer`: 2 columns for 3 axes (the columns of x, y and z: ["acc_x", "acc_y", "acc_z"])"#,
    ),
    (
        "gauge = \"upper\"",
        "gauge = \"upper\"⏎[columns]⏎accelerometer = \"a\"",
        r#"line 13, column 17: `columns.accelerometer`: an array is needed here, not a string (the columns of x, y and z: ["acc_x", "acc_y", "acc_z"])"#,
    ),
    (
        "gauge = \"upper\"",
        "gauge = \"upper\"⏎[columns]⏎gyroscope = [\"a\", \"b\", 3]",
        r#"line 13, column 24: `columns.gyroscope[2]`: a string is needed here, not a whole number (the name as it is in the file, in quotes; without a header, its number from "1")"#,
    ),
    (
        "gauge = \"upper\"",
        "gauge = \"upper\"⏎[columns]⏎gyroscope = [\"a\", \"b\", \"a\"]",
        r#"line 13, column 13: `columns.gyroscope`: the column `a` is named twice (each column holds one thing)"#,
    ),
    (
        "gauge = \"upper\"",
        "gauge = \"upper\"⏎[columns]⏎time = \"T\"⏎temperature = \"T\"",
        r#"line 14, column 15: `columns.temperature`: the column `T` is named twice (each column holds one thing)"#,
    ),
    (
        "gauge = \"upper\"",
        "gauge = \"upper\"⏎[columns]⏎time = \"\"",
        r#"line 13, column 8: `columns.time`: this name is empty (the name as it is in the file, in quotes; without a header, its number from "1")"#,
    ),
    (
        "gauge = \"upper\"",
        "gauge = \"upper\"⏎[columns]⏎time_unit = \"minutes\"",
        r#"line 13, column 13: `columns.time_unit`: "minutes" is not known here (one of "s", "ms", "0.1 ms", "us", "µs", "ns", "samples")"#,
    ),
    (
        "gauge = \"upper\"",
        "gauge = \"upper\"⏎[columns]⏎accelerometer_unit = \"deg/s\"",
        r#"line 13, column 22: `columns.accelerometer_unit`: "deg/s" is not known here (one of "m/s²", "mm/s²", "g", "mg", "counts"; or counts of a sensitivity: "16384 LSB/g", "8.75 mdps/LSB")"#,
    ),
    (
        "gauge = \"upper\"",
        "gauge = \"upper\"⏎[columns]⏎gyroscope_unit = \"rpm\"",
        r#"line 13, column 18: `columns.gyroscope_unit`: "rpm" is not known here (one of "rad/s", "deg/s", "mdps", "counts"; or counts of a sensitivity: "16384 LSB/g", "8.75 mdps/LSB")"#,
    ),
    (
        "gauge = \"upper\"",
        "gauge = \"upper\"⏎[columns]⏎rate_hz = 0",
        r#"line 13, column 11: `columns.rate_hz`: 0.0 is out of range (a number from 1e-6 Hz, at most 1e9 Hz)"#,
    ),
    (
        "gauge = \"upper\"",
        "gauge = \"upper\"⏎[columns]⏎format = \"mtmanager\"",
        r#"line 13, column 10: `columns.format`: "mtmanager" is not known here (did you mean "mt-manager"? one of "mt-manager", "movella-dot", "euroc", "imu-tk", "imucal", "csv", "mcap", "db3", "rosbag", "parquet", "ulog", "dataflash")"#,
    ),
];

#[test]
fn what_it_says_arrives() {
    let none = Experiment::parse(MOTION, None).expect("good").columns;
    assert_eq!(none, ImuReadOptions::default());
    let text = HOLDS.to_owned()
        + r#"
[columns]
format = "csv"
time = "timestamp"
time_unit = "ms"
rate_hz = 102.4
rate_sd_ppm = 50
times = "as-logged"
accelerometer = ["acc_x", "acc_y", "acc_z"]
accelerometer_unit = "g"
gyroscope = ["gyr_x", "gyr_y", "gyr_z"]
gyroscope_unit = "dps"
temperature = "T"
instance = "0"
topic = "/imu"
"#;
    let names = |of: &str| ["x", "y", "z"].map(|axis| format!("{of}_{axis}"));
    let expected = ImuReadOptions {
        format: Some(FileFormat::Csv),
        columns: ColumnMapping {
            time: Some("timestamp".into()),
            rest_of_second: None,
            accelerometer: Some(names("acc")),
            gyroscope: Some(names("gyr")),
            temperature: Some("T".into()),
        },
        time_unit: Some(TimeUnit::Millisecond),
        accelerometer_unit: Some(ImuUnit::StandardGravity),
        gyroscope_unit: Some(ImuUnit::DegreePerSecond),
        rate_hz: Some(102.4),
        rate_sd_ppm: Some(50.0),
        times: Some(SampleTimes::AsLogged),
        instance: Some("0".into()),
        topic: Some("/imu".into()),
        rows_are_holds: false,
        counts_unless_stated: [false; 2],
        accelerometer_only: None,
        budget: None,
    };
    assert_eq!(Experiment::parse(&text, None).expect("good").columns, expected);
}
