//! What an error asks for is given to the letter, by a program, until the recording is read: its readings are then right.

use super::ros_bag::{IMU, bag, message_of};
use calibrant::error::{Answer, Error, InputError, TaskOption};
use calibrant::io::{FileFormat, ImuReadOptions, ImuUnit, TimeUnit, parse_imu_recording, read_columns};
use calibrant::sensor::SensorKind::{Accelerometer, Gyroscope};
use std::f64::consts::PI;

/// What the user knows.
#[derive(Clone, Copy)]
struct Known {
    accelerometer_unit: &'static str,
    gyroscope_unit: &'static str,
    time_unit: &'static str,
    rate_hz: f64,
    instance: &'static str,
    topic: &'static str,
    format: &'static str,
}

const KNOWN: Known = Known {
    accelerometer_unit: "m/s2",
    gyroscope_unit: "rad/s",
    time_unit: "s",
    rate_hz: 100.0,
    instance: "1",
    topic: "/right",
    format: "mt-manager",
};

/// Time in s, specific force in m/s², rate in rad/s of sample `k` at 100 Hz.
fn truth(k: u32) -> (f64, [f64; 3], [f64; 3]) {
    let (t, phase) = (0.01 * f64::from(k), 0.05 * f64::from(k));
    (t, [0.4 * phase.sin(), 9.7 * phase.cos(), 1.5], [0.1 * phase.cos(), -0.2, 0.3 * phase.sin()])
}

const SAMPLES: u32 = 200;

/// A text with this header, and a row for each sample.
fn text(header: &str, row: impl Fn(u32, f64, [f64; 3], [f64; 3]) -> String) -> Vec<u8> {
    let rows = (0..SAMPLES).map(|k| {
        let (t, force, rate) = truth(k);
        row(k, t, force, rate) + "\n"
    });
    let header = if header.is_empty() { String::new() } else { format!("{header}\n") };
    (header + &rows.collect::<String>()).into_bytes()
}

/// Numbers with commas, multiplied.
fn list(values: [f64; 3], factor: f64) -> String {
    values.map(|value| format!("{:.9}", value * factor)).join(",")
}

fn given(options: ImuReadOptions, answer: &Answer, known: Known) -> ImuReadOptions {
    let of_list = |value: &str| {
        let said = answer.values.iter().any(|one| one == value);
        assert!(said || answer.values.is_empty(), "{} has no {value}: {:?}", answer.option, answer.values);
        value.to_owned()
    };
    let unit = |value: &str| {
        let said = answer.values.iter().find(|one| ImuUnit::parse(one) == ImuUnit::parse(value));
        ImuUnit::parse(said.unwrap_or_else(|| panic!("no {value} in {:?}", answer.values)))
    };
    match answer.option {
        TaskOption::AccelerometerUnit => {
            ImuReadOptions { accelerometer_unit: unit(known.accelerometer_unit), ..options }
        }
        TaskOption::GyroscopeUnit => ImuReadOptions { gyroscope_unit: unit(known.gyroscope_unit), ..options },
        TaskOption::TimeUnit => {
            ImuReadOptions { time_unit: TimeUnit::parse(&of_list(known.time_unit)), ..options }
        }
        TaskOption::RateHz => ImuReadOptions { rate_hz: Some(known.rate_hz), ..options },
        TaskOption::Instance => ImuReadOptions { instance: Some(of_list(known.instance)), ..options },
        TaskOption::Topic => ImuReadOptions { topic: Some(of_list(known.topic)), ..options },
        TaskOption::Format => ImuReadOptions { format: FileFormat::parse(&of_list(known.format)), ..options },
        TaskOption::Columns => {
            let (_, name) = answer.more.split_once("time = \"").expect("the name of a column");
            let name = name.split('"').next().unwrap_or_default();
            in_file(&format!("time = \"{name}\"\ntime_unit = \"{}\"", known.time_unit)).or(options)
        }
        other => panic!("{other} is asked for"),
    }
}

/// The options of a file with these lines in `[columns]`.
fn in_file(lines: &str) -> ImuReadOptions {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("columns.toml");
    std::fs::write(&path, format!("[columns]\n{lines}\n")).expect("written");
    read_columns(&path).unwrap_or_else(|error| panic!("{error}\n{lines}"))
}

/// The lines that a remedy in words has behind `such as`.
fn lines_of(help: &str) -> String {
    let (_, keys) = help.split_once("a line each, such as ").unwrap_or_else(|| panic!("no answer: {help}"));
    let mut lines = String::new();
    for part in keys.split(", ") {
        // a comma within a list, or one behind a key
        let is_key = part
            .split_once(" = ")
            .is_some_and(|(key, _)| key.bytes().all(|c| c == b'_' || c.is_ascii_lowercase()));
        lines += if is_key { "\n" } else { ", " };
        lines += part;
    }
    lines
}

fn followed(name: &str, bytes: &[u8], known: Known) -> usize {
    let mut options = ImuReadOptions::default();
    for asked in 0..5 {
        let error = match parse_imu_recording(bytes, &options) {
            Err(Error::Recording(error)) => error,
            Err(error) => panic!("{name}: {error}"),
            Ok(file) => {
                let force = file.recording.sensor(Accelerometer).expect("there");
                let rate = file.recording.sensor(Gyroscope).expect("there");
                assert_eq!((force.len(), rate.len()), (SAMPLES as usize, SAMPLES as usize), "{name}");
                for k in 0..SAMPLES {
                    let (t, [fx, fy, fz], [wx, wy, wz]) = truth(k);
                    let (force_k, rate_k) = (force.readings()[k as usize], rate.readings()[k as usize]);
                    let far = (force_k - nalgebra::Vector3::new(fx, fy, fz))
                        .amax()
                        .max((rate_k - nalgebra::Vector3::new(wx, wy, wz)).amax());
                    assert!(far < 1e-6, "{name}: sample {k} is {far:e} off");
                    let elapsed = force.times_s()[k as usize] - force.times_s()[0];
                    assert!((elapsed - t).abs() < 1e-6, "{name}: sample {k} at {elapsed} s");
                }
                return asked;
            }
        };
        let InputError { answers, help, .. } = *error;
        options = match answers.is_empty() {
            true => in_file(&lines_of(&help)).or(options),
            false => answers.iter().fold(options, |options, answer| given(options, answer, known)),
        };
    }
    panic!("{name}: asked without end")
}

#[test]
fn what_an_error_asks_for_leads_to_the_right_readings() {
    const SI: &str = "ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps";
    let si = |force, rate| format!("{},{}", list(force, 1.0), list(rate, 1.0));
    let (g, deg) = (1.0 / 9.806_65, 180.0 / PI);
    let in_g = Known { accelerometer_unit: "g", gyroscope_unit: "deg/s", ..KNOWN };
    let stamped = |k: u32, of: f64| {
        let (_, force, rate) = truth(k);
        message_of(2 * u64::from(k), rate, force.map(|value| value * of))
    };
    let topics = [("/left", 0.5), ("/right", 1.0)]
        .map(|(name, of)| (name, IMU, "cdr", (0..SAMPLES).map(|k| stamped(k, of)).collect::<Vec<_>>()));
    let cases: Vec<(&str, Vec<u8>, Known)> = vec![
        (
            "units",
            text("t_s,ax,ay,az,gx,gy,gz", |_, t, f, w| format!("{t:.4},{},{}", list(f, g), list(w, deg))),
            in_g,
        ),
        (
            "small units",
            text("t_s,ax,ay,az,gx,gy,gz", |_, t, f, w| {
                format!("{t:.4},{},{}", list(f, 1e3 * g), list(w, 1e3 * deg))
            }),
            Known { accelerometer_unit: "mg", gyroscope_unit: "mdps", ..KNOWN },
        ),
        (
            "time",
            text(&format!("time,{SI}"), |_, t, f, w| format!("{:.1},{}", 1e3 * t, si(f, w))),
            Known { time_unit: "ms", ..KNOWN },
        ),
        (
            "time and units",
            text("time,ax,ay,az,gx,gy,gz", |k, _, f, w| {
                format!("{},{},{}", 10_000 * k, list(f, g), list(w, deg))
            }),
            Known { time_unit: "us", ..in_g },
        ),
        ("no clock", text(SI, |_, _, f, w| si(f, w)), KNOWN),
        (
            "no clock, no units",
            text("ax,ay,az,gx,gy,gz", |_, _, f, w| format!("{},{}", list(f, g), list(w, deg))),
            in_g,
        ),
        (
            "a column that may be the clock",
            text(&format!("beat,{SI}"), |k, _, f, w| format!("{},{}", 10 * k, si(f, w))),
            Known { time_unit: "ms", ..KNOWN },
        ),
        (
            "two sensors",
            text(&format!("t_s,imu,{SI}"), |_, t, f, w| {
                format!("{t:.4},0,{}\n{t:.4},1,{}", si(w, f), si(f, w))
            }),
            KNOWN,
        ),
        (
            "MT Manager or DOT",
            text("PacketCounter,SampleTimeFine,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z", |k, _, f, w| {
                format!("{k},{},{}", 100 * k, si(f, w))
            }),
            KNOWN,
        ),
        (
            "imucal",
            text("n_samples,gyr_x,gyr_y,gyr_z,acc_x,acc_y,acc_z", |k, _, f, w| {
                format!("{k},{},{}", list(w, deg), list(f, g))
            }),
            in_g,
        ),
        ("no header", text("", |_, t, f, w| format!("{t:.4},{}", si(f, w))), KNOWN),
        ("no header, g", text("", |_, t, f, w| format!("{t:.4},{},{}", list(f, g), list(w, 1.0))), KNOWN),
        (
            "no header, rows of one sensor each",
            text("", |_, t, f, w| format!("ACC,{t:.4},{}\nGYR,{t:.4},{}", list(f, 1.0), list(w, 1.0))),
            KNOWN,
        ),
        ("two topics", bag(&topics), KNOWN),
    ];
    let asked: usize = cases
        .iter()
        .map(|(name, bytes, known)| {
            let asked = followed(name, bytes, *known);
            assert!(asked > 0, "{name}: nothing was asked");
            asked
        })
        .sum();
    assert!(asked >= cases.len());
}

#[test]
fn the_time_may_be_of_two_columns_that_are_named() {
    for (unit, factor) in [("ns", 1e9), ("us", 1e6), ("ms", 1e3)] {
        let bytes = text("s_part,x_part,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps", |k, _, f, w| {
            let rest = (factor * f64::from(k % 100) / 100.0).round();
            format!("{},{rest},{},{}", 1_700_000_000 + k / 100, list(f, 1.0), list(w, 1.0))
        });
        let options = in_file("time = [\"s_part\", \"x_part\"]");
        let file = parse_imu_recording(&bytes, &options).unwrap_or_else(|error| panic!("{unit}: {error}"));
        let times = file.recording.sensor(Accelerometer).expect("there").times_s().to_vec();
        assert!((times[150] - times[0] - 1.5).abs() < 1e-9, "{unit}: {}", times[150]);
    }
    let missing = in_file("time = [\"s_part\", \"none\"]");
    let bytes =
        text("s_part,x_part,ax_mps2,ay_mps2,az_mps2", |k, _, f, _| format!("{k},{k},{}", list(f, 1.0)));
    assert!(
        parse_imu_recording(&bytes, &missing)
            .expect_err("missing")
            .to_string()
            .contains("[columns] names `none`")
    );
}

#[test]
fn the_clock_of_the_samples_comes_before_that_of_the_messages() {
    const SI: &str = "ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps";
    for (header, unit) in
        [("TimeUS,SampleUS", None), ("timestamp,timestamp_sample", Some(TimeUnit::Microsecond))]
    {
        let bytes = text(&format!("{header},{SI}"), |k, _, f, w| {
            format!("{},{},{},{}", 10_000 * k + k * 37 % 900, 10_000 * k, list(f, 1.0), list(w, 1.0))
        });
        let options = ImuReadOptions { time_unit: unit, ..ImuReadOptions::default() };
        let file = parse_imu_recording(&bytes, &options).unwrap_or_else(|error| panic!("{header}: {error}"));
        let times = file.recording.sensor(Gyroscope).expect("there").times_s().to_vec();
        assert!(times.windows(2).all(|pair| (pair[1] - pair[0] - 0.01).abs() < 1e-9), "{header}");
    }
    let elapsed = text(&format!("seconds_elapsed,{SI}"), |_, t, f, w| {
        format!("{t:.4},{},{}", list(f, 1.0), list(w, 1.0))
    });
    assert_eq!(
        parse_imu_recording(&elapsed, &ImuReadOptions::default()).expect("a clock").rows,
        SAMPLES as usize
    );
}

#[test]
fn other_binary_logs_are_refused_with_the_program_that_converts_them() {
    let refused = |bytes: &[u8]| {
        parse_imu_recording(bytes, &ImuReadOptions::default()).expect_err("refused").to_string()
    };
    assert!(
        refused(b"H Product:Blackbox flight data recorder by Nicholas Sherlock\nH Data version:2\nI\0\0")
            .contains("`blackbox_decode FILE`")
    );
    assert!(refused(&[&[2, 0x50, 12, 0][..], &[0; 600]].concat()).contains("ezc3d.c3d('FILE')"));
}
