//! Samples that are even, logged with the steps of a host's clock.

use crate::common::hand::ByHand;
use crate::common::{draw_imu, run_imu};
use crate::common::{steady_imu, unfeeling_gyroscope};
use calibrant::io::{ImuFile, ImuReadOptions, SampleTimes, read_imu_recording, write_imu_recording};
use calibrant::sensor::{ReadingUnit, SensorKind};
use calibrant::simulate::{Purpose, stream};
use rayon::prelude::*;

/// The rotation error, rad, and the mean of z² of the gyroscope, with these sample times.
fn calibrated(number: u64, tick_s: f64, times: Option<SampleTimes>) -> (f64, f64, ImuFile) {
    let mut rng = stream(93, Purpose::Sensor, number);
    let imu = draw_imu(&mut rng);
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("recording.csv");
    let setup = ByHand { host_tick_s: Some(tick_s), rate_hz: 99.7, ..ByHand::default() };
    write_imu_recording(&path, &setup.record(&imu, &mut rng)).expect("written");
    let file =
        read_imu_recording(&path, &ImuReadOptions { times, ..ImuReadOptions::default() }).expect("read");
    let (gyroscope, setup, unit) = (unfeeling_gyroscope(), steady_imu(), ReadingUnit::MetrePerSecondSquared);
    let found = run_imu(&file.recording, &gyroscope, &setup, unit).expect("determined");
    let sd = found.sd();
    let of_gyroscope = |k: &usize| found.quantities[*k].sensor_kind() == SensorKind::Gyroscope;
    let z = |k: usize| (found.values[k] - found.quantities[k].value(&imu)) / sd[k];
    let squares: Vec<f64> = (0..sd.len()).filter(of_gyroscope).map(|k| z(k).powi(2)).collect();
    (found.rotation_rms_rad(), squares.iter().sum::<f64>() / squares.len() as f64, file)
}

#[test]
fn even_samples_are_put_at_even_times() {
    let all = |times| -> Vec<(f64, f64, ImuFile)> {
        (0..30).into_par_iter().map(|number| calibrated(number, 0.005, times)).collect()
    };
    let mean = |all: &[(f64, f64, ImuFile)], of: fn(&(f64, f64, ImuFile)) -> f64| {
        all.iter().map(of).sum::<f64>() / all.len() as f64
    };
    let (by_data, as_logged) = (all(None), all(Some(SampleTimes::AsLogged)));
    let [even_rad, logged_rad] = [&by_data, &as_logged].map(|all| mean(all, |(rms, ..)| *rms).to_degrees());
    let squares = mean(&by_data, |(_, squares, _)| *squares);
    println!("rotation error {logged_rad:.3}° as logged, {even_rad:.3}° at even times; z² {squares:.2}");
    assert!(even_rad < 0.5 * logged_rad && squares < 1.3, "{even_rad} {logged_rad} {squares}");
    let said =
        |file: &ImuFile| file.findings.iter().any(|finding| finding.to_string().contains("steps of 5 ms"));
    assert!(by_data.iter().all(|(.., file)| said(file)) && !as_logged.iter().any(|(.., file)| said(file)));
}

#[test]
fn even_times_that_are_asked_for_need_samples_without_gaps() {
    let text = |gap_s: f64| {
        let line = |k: usize| {
            let t = k as f64 * 0.01 + if k > 150 { gap_s } else { 0.0 } + 0.003 * (k as f64).sin();
            format!("{t},0,{},9.8,0,0,{}\n", 0.01 * (k as f64).cos(), 0.02 * (k as f64).sin())
        };
        "t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps\n".to_owned()
            + &(0..300).map(line).collect::<String>()
    };
    let options = ImuReadOptions { times: Some(SampleTimes::Even), ..ImuReadOptions::default() };
    let file = calibrant::io::parse_imu_recording(text(0.0).as_bytes(), &options).expect("even enough");
    let times = file.recording[SensorKind::Gyroscope].clone().expect("there").times_s().to_vec();
    assert!(times.array_windows().all(|[one, next]| (next - one - 0.01).abs() < 1e-5));
    let refused = calibrant::io::parse_imu_recording(text(2.0).as_bytes(), &options).expect_err("a gap");
    assert!(refused.to_string().contains("the samples are not even: there is none from 1.49"), "{refused}");
}
