//! Tests of times of packets in the place of times of samples.

use super::{findings, read, refused};
use calibrant::io::{ImuReadOptions, SampleTimes, parse_imu_recording};
use calibrant::sensor::SensorKind;

/// Sample rate, Hz.
const RATE_HZ: f64 = 100.0;
/// Number of rows.
const ROWS: usize = 2000;

/// A recording of both sensors whose row k has this time, s.
fn file(time: impl Fn(usize) -> f64) -> String {
    let row = |k: usize| {
        let wave = (0.1 * k as f64).sin();
        format!("{:.6},{:.5},0.1,9.81,{:.5},0.01,0.02\n", time(k), 0.3 * wave, 0.1 * wave)
    };
    let rows: String = (0..ROWS).map(row).collect();
    format!("time_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps\n{rows}")
}

fn given() -> ImuReadOptions {
    ImuReadOptions { rate_hz: Some(RATE_HZ), ..ImuReadOptions::default() }
}

#[test]
fn times_of_packets_are_asked_about_and_a_given_rate_takes_their_place() {
    let even = |k: usize| k as f64 / RATE_HZ;
    let packets_of = |k: usize, size: usize| even(k / size * size);
    for (name, text, word) in [
        (
            "coarse",
            file(|k| (even(k) / 0.04).floor() * 0.04),
            "1500 of 2000 samples have the time of the one before",
        ),
        (
            "seldom",
            file(|k| packets_of(k, if k % 40 < 10 { 2 } else { 1 })),
            "have the time of the one before",
        ),
        ("packets", file(|k| packets_of(k, 5) + 1e-4 * (k % 5) as f64), "the samples come in packets"),
        ("two", file(|k| packets_of(k, 3) + 1e-3 * (k % 3) as f64), "the samples come in packets"),
    ] {
        // few packets of two samples are near enough to even samples
        let times = (name == "seldom").then_some(SampleTimes::AsLogged);
        assert_eq!(times.is_some(), parse_imu_recording(text.as_bytes(), &ImuReadOptions::default()).is_ok());
        let question = refused(&text, &ImuReadOptions { times, ..ImuReadOptions::default() });
        assert!(
            question.contains(word)
                && question.contains("option `rate_hz`")
                && question.contains("(about 100"),
            "{name}: {question}"
        );
        let read = read(&text, &ImuReadOptions { times, ..given() });
        let gyroscope = read.recording[SensorKind::Gyroscope].as_ref().expect("there");
        assert_eq!((gyroscope.len(), gyroscope.times_s()[1500]), (ROWS, 15.0), "{name}");
        assert!(
            findings(&read)
                .iter()
                .any(|message| message.contains("each row is taken as one sample at 100 Hz (as given)")),
            "{name}"
        );
        assert!(
            !findings(&read)
                .iter()
                .any(|message| message.contains("not used") || message.contains("dropped")),
            "{name}: {:?}",
            findings(&read)
        );
    }
}

#[test]
fn pauses_jitter_lost_and_repeated_rows_are_no_packets() {
    let even = |k: usize| k as f64 / RATE_HZ;
    let lost = |k: usize| even(k) + (0..k).filter(|j| j * j % 17 == 4).count() as f64 / RATE_HZ;
    for (name, text) in [
        ("pauses", file(|k| even(k) + 10.0 * (k / 200) as f64)),
        ("jitter", file(|k| even(k) + 0.004 * (k as f64).sin())),
        ("lost", file(lost)),
        ("few", file(|k| even(k) - if k % 25 == 0 && k > 0 { 1.0 / RATE_HZ } else { 0.0 })),
    ] {
        let read = read(&text, &given());
        // where samples are lost, the times show another rate
        let said = if name == "lost" { "the times are used" } else { "the rate that was given is not used" };
        assert!(findings(&read).iter().any(|message| message.contains(said)), "{name}");
    }
}
