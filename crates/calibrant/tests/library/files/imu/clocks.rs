//! Tests of the clocks of loggers: their names, their texts, their ends, and what is no clock.

use super::{findings, read, refused, used};
use calibrant::io::{ColumnMapping, ImuReadOptions, TimeUnit};
use calibrant::sensor::SensorKind;

/// Readings of both sensors.
const READINGS: &str = "ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps";
/// Rows of a file.
const ROWS: usize = 300;

/// A file whose first columns have these names, and these fields in row k.
fn file(names: &str, fields: impl Fn(usize) -> String) -> String {
    let row = |k: usize| {
        let wave = (0.1 * k as f64).sin();
        format!("{},{:.5},0.1,9.81,{:.5},0.01,0.02\n", fields(k), 0.3 * wave, 0.1 * wave)
    };
    format!("{names},{READINGS}\n{}", (0..ROWS).map(row).collect::<String>())
}

/// Time of the last row less that of the first, s.
fn duration_s(text: &str, options: &ImuReadOptions) -> f64 {
    let read = read(text, options);
    let times_s = read.recording[SensorKind::Gyroscope].as_ref().expect("there").times_s().to_vec();
    assert_eq!(times_s.len(), ROWS, "{:?}", findings(&read));
    times_s[ROWS - 1] - times_s[0]
}

#[test]
fn clocks_of_loggers_are_read_by_name_and_by_text() {
    let ms = |k: usize| 11 * k; // a loop of 11 ms, whatever rate was asked for
    let of_day = |k: usize| {
        let ms = 86_399_000 + ms(k); // over midnight
        let (s, ms) = (ms / 1000 % 86_400, ms % 1000);
        format!("{:02}:{:02}:{:02}.{ms:03}", s / 3600, s / 60 % 60, s % 60)
    };
    let expected = 1e-3 * ms(ROWS - 1) as f64;
    for (name, text) in [
        ("millis", file("millis", |k| ms(k).to_string())),
        ("ms", file("ms", |k| ms(k).to_string())),
        ("TimeUS", file("TimeUS,T", |k| format!("{},{}", 1000 * ms(k) + 65_000_000, 38 + k / 100))),
        (
            "day",
            file("rtcDate,rtcTime", |k| {
                format!("03/0{}/2024,{}", 5 + (ms(k) + 86_399_000) / 86_400_000, of_day(k))
            }),
        ),
        (
            "ISO",
            file("timestamp", |k| {
                format!("2024-03-0{}T{}Z", 5 + (ms(k) + 86_399_000) / 86_400_000, of_day(k))
            }),
        ),
        (
            "unnamed",
            file("x", |k| format!("2024-03-0{} {}", 5 + (ms(k) + 86_399_000) / 86_400_000, of_day(k))),
        ),
        // a counter of 32 bits, signed and unsigned, that begins anew
        ("micros", file("micros", |k| ((4_294_000_000 + 1000 * ms(k)) % 4_294_967_296).to_string())),
        ("signed", file("micros", |k| ((2_147_000_000 + 1000 * ms(k) as i64) as u32 as i32).to_string())),
    ] {
        assert!((duration_s(&text, &ImuReadOptions::default()) - expected).abs() < 1e-6, "{name}");
        // a rate that was typed contradicts them aloud
        let typed = ImuReadOptions { rate_hz: Some(100.0), ..ImuReadOptions::default() };
        assert!((duration_s(&text, &typed) - expected).abs() < 1e-6, "{name}");
        let said = findings(&read(&text, &typed));
        assert!(
            said.iter().any(|said| said.contains("given as 100 Hz") && said.contains("90.9091 Hz")),
            "{said:?}"
        );
    }
}

#[test]
fn what_is_no_clock_is_not_taken_for_one() {
    let warm = file("T", |k| format!("{:.1}", 24.8 + 0.1 * (k as f64 * 1.7).sin()));
    let question = refused(&warm, &ImuReadOptions::default());
    assert!(question.contains("`T` is no clock") && question.contains("option `rate_hz`"), "{question}");
    let given = ImuReadOptions { rate_hz: Some(100.0), ..ImuReadOptions::default() };
    assert!((duration_s(&warm, &given) - 2.99).abs() < 1e-9);
    // a counter that begins anew goes on within a second; files that were put together do not
    let twice = file("micros", |k| (11_000 * (k % 150)).to_string());
    assert!(refused(&twice, &ImuReadOptions::default()).contains("time goes backwards"));
}

#[test]
fn a_column_that_may_be_a_clock_is_named_before_a_rate_is_asked_for() {
    let text = file("ticks_1024", |k| (11 * k).to_string());
    let question = refused(&text, &ImuReadOptions::default());
    assert!(question.contains("`ticks_1024` may be") && !question.contains("option `rate_hz`"), "{question}");
    let columns = ColumnMapping { time: Some("ticks_1024".into()), ..ColumnMapping::default() };
    let as_said =
        ImuReadOptions { columns, time_unit: Some(TimeUnit::Millisecond), ..ImuReadOptions::default() };
    assert!((duration_s(&text, &as_said) - 3.289).abs() < 1e-9);
}

#[test]
fn the_rate_of_a_comment_is_as_uncertain_as_one_that_is_typed() {
    let text = format!(
        "# Config: data_rate = 98.5 Hz, filter = 42 Hz, acc_range = 4 g\n{}",
        file("count", |k| k.to_string())
    );
    let read = read(&text, &ImuReadOptions::default());
    assert_eq!(read.rate_sd_ppm, Some(50_000.0));
    assert!((duration_s(&text, &ImuReadOptions::default()) - 299.0 / 98.5).abs() < 1e-9);
}

#[test]
fn two_sensors_in_the_rows_of_a_file_are_never_one() {
    let names = format!("TimeUS,I,{READINGS}");
    let row = |k: usize| {
        let (k, sensor) = (k / 2, k % 2);
        format!("{},{sensor},{}.{k:03},0.1,9.81,0.1{k:03},0.01,0.02\n", 10_000 * k, sensor)
    };
    let rows: String = (0..2 * ROWS).map(row).collect();
    for named in ["I", "imu_index"] {
        let text = format!("{}\n{rows}", names.replace(",I,", &format!(",{named},")));
        for rate_hz in [None, Some(200.0)] {
            let question = refused(&text, &ImuReadOptions { rate_hz, ..ImuReadOptions::default() });
            assert!(
                question.contains(&format!("column `{named}` numbers them, 0, 1"))
                    && question.contains("option `instance` 0 or 1"),
                "{question}"
            );
        }
        let one = ImuReadOptions { instance: Some("1".into()), ..ImuReadOptions::default() };
        let file = read(&text, &one);
        let readings = file.recording[SensorKind::Accelerometer].as_ref().expect("there").readings();
        assert_eq!(readings.len(), ROWS);
        assert!(readings.iter().all(|reading| reading.x >= 1.0));
        assert!(!used(&file).contains(&named));
        let other = ImuReadOptions { instance: Some("2".into()), ..ImuReadOptions::default() };
        assert!(refused(&text, &other).contains("option `instance` 0 or 1"));
    }
    let none = ImuReadOptions { instance: Some("1".into()), ..ImuReadOptions::default() };
    assert!(
        refused(&file("t_s", |k| format!("{}", 0.01 * k as f64)), &none)
            .contains("no column of the file numbers sensors")
    );
}
