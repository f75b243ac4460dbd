//! Measures time, iterations and memory of one calibration against the number of intervals N and samples M:
//! `cargo run --release -p calibrant --features programs --example scaling`. Every size runs in a process of its own, so that its peak memory
//! is its own.
//!
//! The time is the median of several calibrations (the whole `calibrate()` call, one thread). Memory is the
//! peak of the resident set (`VmHWM`, Linux) less the resident set before the calibration. It is relative to
//! the size of its input: 32 bytes for each sample and each node.

use calibrant::estimate::{CalibrationProblem, CalibrationSettings, Stimulus, calibrate};
use calibrant::motion::{CommandedMotion, InputNoise, JerkControlledMotion, KnownEnds, MotionClock, Trust};
use calibrant::sensor::{Sensor, SensorModel};
use calibrant::simulate::{Purpose, draw_sensor, perturb, sample_times, simulate_recording, stream};
use nalgebra::Vector3;
use rand::RngExt;
use std::hint::black_box;
use std::process::Command;
use std::time::{Duration, Instant};

type Failure = Box<dyn std::error::Error>;

/// N and samples per interval: ten for each interval, then more and more samples in the thesis's 14
/// intervals.
const SIZES: [(usize, usize); 8] =
    [(100, 10), (1_000, 10), (10_000, 10), (100_000, 10), (14, 72), (14, 715), (14, 7_143), (14, 71_429)];

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [model, trust, intervals, per_interval] = arguments.as_slice() {
        return measure(model, trust, intervals.parse()?, per_interval.parse()?);
    }
    println!(
        "| model | trust | N | M | time, ms | time/(N+M), ns | iterations | status | gradient, sd | input, MB | peak growth, MB | growth/input |"
    );
    println!("|---|---|--:|--:|--:|--:|--:|---|--:|--:|--:|--:|");
    for (model, trust) in [
        ("scale-bias", "known"),
        ("scale-bias", "noisy"),
        ("scale-bias", "unknown"),
        ("full", "known"),
        ("full", "noisy"),
    ] {
        for (intervals, per_interval) in SIZES {
            let numbers = [intervals.to_string(), per_interval.to_string()];
            let status =
                Command::new(std::env::current_exe()?).args([model, trust]).args(&numbers).status()?;
            if !status.success() {
                return Err(format!("{model} {trust} {numbers:?}: {status}").into());
            }
        }
    }
    Ok(())
}

/// One size: simulates, calibrates, prints a row of the table.
fn measure(model: &str, trust: &str, intervals: usize, per_interval: usize) -> Result<(), Failure> {
    let (model_name, trust_name) = (model, trust);
    let model = if model == "full" { SensorModel::Full } else { SensorModel::ScaleBias };
    let trust = match trust {
        "known" => Trust::Known,
        "unknown" => Trust::Unknown,
        _ => Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 }),
    };
    let sensor = Sensor { model, cross_axis_sd: Some(0.01), ..Sensor::memsic_mxd2020u() };
    // independent nodes, so that the motion is as rich at every length
    let mut rng = stream(1, Purpose::Motion, 0);
    let mut node = || Vector3::from_fn(|_, _| rng.random_range(-20.0..20.0));
    let motion = JerkControlledMotion::uniform(1.0, (0..=intervals).map(|_| node()).collect())?;
    let mut rng = stream(1, Purpose::Sensor, 0);
    let truth = draw_sensor(&sensor, &mut rng);
    let happened = match trust {
        Trust::Noisy(noise) => perturb(&motion, &noise, 3, KnownEnds::Start, &mut rng)?,
        _ => motion.clone(),
    };
    let times = sample_times(&motion, per_interval as f64);
    let noise = sensor.noise_mps2.ok_or("the datasheet gives the noise")?;
    let recording = simulate_recording(&truth, &noise, sensor.unit, 3, &happened, &times, &mut rng);
    drop((happened, times));
    let known_ends = if trust == Trust::Unknown { KnownEnds::Both } else { KnownEnds::Start };
    let command = CommandedMotion { motion, trust, known_ends, gravity: None, clock: MotionClock::default() };
    let problem =
        CalibrationProblem { sensor: &sensor, recording: &recording, stimulus: Stimulus::Motion(&command) };

    let before = memory_kb("VmRSS:")?;
    let calibration = calibrate(&problem, &CalibrationSettings::default())?;
    let growth = memory_kb("VmHWM:")?.saturating_sub(before);

    // about a second in all, at least three calibrations
    let (mut seconds, begin) = (Vec::new(), Instant::now());
    while seconds.len() < 3 || (begin.elapsed() < Duration::from_secs(1) && seconds.len() < 1_000) {
        let start = Instant::now();
        black_box(calibrate(black_box(&problem), &CalibrationSettings::default())?);
        seconds.push(start.elapsed().as_secs_f64());
    }
    seconds.sort_unstable_by(f64::total_cmp);
    let median = seconds[seconds.len() / 2];
    let samples = recording.len();
    let input_kb = 32 * (samples + intervals + 1) / 1024;
    println!(
        "| {model_name} | {trust_name} | {intervals} | {samples} | {:.3} | {:.0} | {} | {} | {:.0e} | {:.2} | {:.2} | {:.1} |",
        median * 1e3,
        median * 1e9 / (intervals + samples) as f64,
        calibration.iterations,
        calibration.status.name(),
        calibration.gradient_norm,
        input_kb as f64 / 1024.0,
        growth as f64 / 1024.0,
        growth as f64 / input_kb as f64,
    );
    Ok(())
}

/// A line of `/proc/self/status`, in kB.
fn memory_kb(key: &str) -> Result<usize, Failure> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find(|line| line.starts_with(key)).ok_or("the system does not tell")?;
    Ok(line.split_whitespace().nth(1).ok_or("no number")?.parse()?)
}
