//! Tests of files in which each sensor has rows of its own, against an independent reading of the text.

use super::findings;
use calibrant::diagnostic::Check;
use calibrant::diagnostic::reader::{RowsRepeated, TimesRepeated};
use calibrant::io::{ImuFile, ImuReadOptions, parse_imu_recording};
use calibrant::sensor::{Recording, SensorKind};

/// The names of the columns.
const HEADER: &str = "t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps,temp_c\n";

fn read(rows: &[String]) -> ImuFile {
    let text = HEADER.to_owned() + &rows.concat();
    parse_imu_recording(text.as_bytes(), &ImuReadOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn accelerometer(t: f64) -> String {
    format!("{t},{},{},{},,,,\n", 0.01 * t, 0.2 - t * t, 9.8 + 0.01 * t)
}

fn gyroscope(t: f64) -> String {
    format!("{t},,,,{},{},{},\n", 0.1 * t, 0.3 - t, t * t)
}

/// The rows that have all cells of a sensor: times and readings as they stand in the text.
fn series(rows: &[String], sensor_kind: SensorKind) -> (Vec<f64>, Vec<[f64; 3]>) {
    let first = if sensor_kind == SensorKind::Accelerometer { 1 } else { 4 };
    let cells = rows.iter().map(|row| row.trim_end().split(',').collect::<Vec<_>>());
    let whole = cells.filter(|cells| cells[first..first + 3].iter().all(|cell| !cell.is_empty()));
    let number = |cell: &str| cell.parse::<f64>().expect("a number");
    whole.map(|cells| (number(cells[0]), [0, 1, 2].map(|axis| number(cells[first + axis])))).unzip()
}

fn assert_is(found: Option<&Recording>, expected: (Vec<f64>, Vec<[f64; 3]>), what: &str) {
    let found = found.expect("there");
    assert_eq!(found.times_s(), expected.0, "{what}");
    let readings: Vec<[f64; 3]> =
        found.readings().iter().map(|reading| [reading.x, reading.y, reading.z]).collect();
    assert_eq!(readings, expected.1, "{what}");
}

/// Rows in the order of these times.
fn by_time(mut rows: Vec<(f64, String)>) -> Vec<String> {
    rows.sort_by(|one, other| one.0.total_cmp(&other.0));
    rows.into_iter().map(|(_, row)| row).collect()
}

#[test]
fn each_sensor_has_its_own_series() {
    let tick = |k: usize, rate: f64| k as f64 / rate;
    let a =
        |rate: f64| (0..40).map(move |k| (tick(k, rate), accelerometer(tick(k, rate)))).collect::<Vec<_>>();
    let g = |rate: f64| (0..40).map(move |k| (tick(k, rate), gyroscope(tick(k, rate)))).collect::<Vec<_>>();
    let both = |t: f64| accelerometer(t).replace(",,,,\n", &gyroscope(t)[format!("{t},,,").len()..]);
    let late = |behind: f64| {
        let delivered = a(100.0).into_iter().map(|(t, row)| (t + behind, row));
        by_time(delivered.chain(g(100.0)).collect())
    };
    let thermometer = |k: usize| (tick(k, 20.0), format!("{},,,,,,,{}\n", tick(k, 20.0), 20 + k));
    for (what, rows) in [
        ("equal times", by_time([a(100.0), g(100.0)].concat())),
        ("times that are sometimes equal", by_time([a(100.0), g(250.0)].concat())),
        ("different times", by_time([g(100.0), a(99.0)].concat())),
        (
            "half the rate",
            (0..40)
                .map(|k| if k % 2 == 0 { both(tick(k, 50.0)) } else { gyroscope(tick(k, 50.0)) })
                .collect(),
        ),
        ("delivered late", late(0.035)),
        ("one after the other", late(1.0)),
        ("a thermometer too", by_time([a(100.0), g(100.0), (0..8).map(thermometer).collect()].concat())),
    ] {
        let file = read(&rows);
        for sensor_kind in SensorKind::ALL {
            assert_is(
                file.recording.sensor(sensor_kind),
                series(&rows, sensor_kind),
                &format!("{what}, {sensor_kind}"),
            );
        }
        let twice = |finding: &&calibrant::diagnostic::Diagnostic| {
            [RowsRepeated::CODE, TimesRepeated::CODE].contains(&finding.code())
        };
        assert_eq!(file.findings.iter().find(twice), None, "{what}");
        if what.starts_with("a thermometer") {
            let celsius = file.recording.temperature_c.as_ref().expect("there");
            // 20 °C and 20 K/s, up to the last of its rows
            let expected = |t: f64| 20.0 + 20.0 * t.min(0.35);
            let times = file.recording[SensorKind::Accelerometer].as_ref().expect("there").times_s();
            let is_near = |(t, found): (&f64, &f64)| (found - expected(*t)).abs() < 1e-9;
            assert!(times.iter().zip(celsius).all(is_near), "{celsius:?}");
        }
    }
}

#[test]
fn a_sensor_that_is_twice_at_a_time_is_a_duplicate_still() {
    let rows: Vec<String> =
        (0..9).flat_map(|k| [accelerometer(0.1 * f64::from(k)), gyroscope(0.1 * f64::from(k))]).collect();
    let good = read(&rows);
    let with = |at: usize, row: String| [&rows[..at], &[row], &rows[at..]].concat();
    let other = accelerometer(0.2).replace(",9.8", ",9.7");
    for (rows, says) in [
        (with(6, rows[4].clone()), "line 8: 1 row equal to the one before dropped"),
        (with(6, rows[5].clone()), "line 8: 1 row equal to the one before dropped"),
        (with(6, other.clone()), "line 8: 1 row with the time of the one before but another reading dropped"),
    ] {
        let file = read(&rows);
        assert_eq!(file.recording, good.recording);
        assert_eq!(findings(&file)[0], says);
    }
    // a row of both sensors, one of which is there already
    let mut rows = rows;
    rows[5] = other.replace(",,,,\n", &gyroscope(0.2)["0.2,,,".len()..]);
    let file = read(&rows);
    assert_eq!(file.recording, good.recording);
    let says = "line 7: accelerometer: 1 sample with the time of the one before dropped";
    assert!(findings(&file).contains(&says.to_owned()), "{:?}", findings(&file));
    // each sensor's time increases
    rows.push(accelerometer(0.75));
    let text = HEADER.to_owned() + &rows.concat();
    let error = parse_imu_recording(text.as_bytes(), &ImuReadOptions::default()).expect_err("backwards");
    assert!(error.to_string().contains("line 20: time goes backwards, from 0.8"), "{error}");
}
