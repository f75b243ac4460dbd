//! Writes seeded calibration problems with calibrant's answers and times as JSON:
//! `cargo run --release -p calibrant --features programs --example peer_estimate -- FILE`. Other programs solve the same problems in another
//! way. `peers/casadi/estimate.py` is one of them; `scripts/peers` runs both.
//!
//! The problems have every trust and model at N = 14 intervals of 5 s, sampled at 2 Hz (M = 141). That is the
//! size of the thesis's experiments. Beside them are motions with intervals of exactly known increment (σ_u =
//! 0). Times are of the whole `calibrate()` call on one thread.

#[allow(unreachable_pub)]
#[path = "../tests/library/common/mod.rs"]
mod common;

use calibrant::estimate::{Calibration, Recovered};
use calibrant::motion::{InputNoise, JerkControlledMotion, KnownEnds, MotionGravity, Trust};
use calibrant::sensor::SensorModel;
use common::case::Case;
use nalgebra::{DMatrix, Vector3};
use serde_json::{Value, json};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Number of intervals of the motions.
const INTERVALS: usize = 14;
/// Duration of an interval, s.
const INTERVAL_S: f64 = 5.0;
/// Sample rate, Hz.
const RATE_HZ: f64 = 2.0;
/// Number of problems of each kind.
const SEEDS: u64 = 5;
/// Number of calibrations before the timed ones.
const WARM_UP: usize = 100;
/// Number of timed calibrations.
const REPETITIONS: usize = 400;
/// Process noise of noisy motions.
const NOISE: InputNoise = InputNoise { floor_mps3: 0.01, ratio: 0.01 };
/// No floor: an interval with zero commanded jerk has exactly zero jerk.
const RATIO_ONLY: InputNoise = InputNoise { floor_mps3: 0.0, ratio: 0.01 };

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("usage: peer_estimate FILE")?;
    let mut cases = Vec::new();
    for (model, model_name) in [(SensorModel::ScaleBias, "scale-bias"), (SensorModel::Full, "full")] {
        for trust in [Trust::Known, Trust::Noisy(NOISE), Trust::Unknown] {
            for seed in 1..=SEEDS {
                let case = Case::new(model, trust, INTERVALS, INTERVAL_S, RATE_HZ, seed);
                cases.push(record(trust.name(), model_name, seed, &case)?);
            }
        }
        for seed in 1..=2 {
            let case =
                Case::with_motion(model, Trust::Noisy(RATIO_ONLY), with_plateaus(seed)?, RATE_HZ, seed);
            cases.push(record("noisy, plateaus", model_name, seed, &case)?);
            // both ends known: the commanded end is then the true end of the motion
            let mut both = Case::with_motion(model, Trust::Known, with_plateaus(seed)?, RATE_HZ, seed);
            both.command.trust = Trust::Noisy(RATIO_ONLY);
            both.command.known_ends = KnownEnds::Both;
            cases.push(record("noisy, both ends", model_name, seed, &both)?);
        }
    }
    // with gravity on every axis, whose tilt is a nuisance
    for (model, trust) in [
        (SensorModel::ScaleBias, Trust::Known),
        (SensorModel::ScaleBias, Trust::Noisy(NOISE)),
        (SensorModel::ScaleBias, Trust::Unknown),
        (SensorModel::Full, Trust::Known),
        (SensorModel::Full, Trust::Noisy(NOISE)),
    ] {
        let mut case = Case::new(model, trust, INTERVALS, INTERVAL_S, RATE_HZ, 1);
        let gravity = MotionGravity::of_force(Vector3::new(3.0, -4.0, 8.4));
        let tilted = gravity.force_mps2 + Vector3::new(0.05, 0.06, 0.01);
        let constant = case.truth.matrix * tilted;
        case.recording.readings_mut().iter_mut().for_each(|y| *y += constant);
        case.command.gravity = Some(gravity);
        let model_name = if model == SensorModel::Full { "full" } else { "scale-bias" };
        cases.push(record(&format!("{}, gravity", trust.name()), model_name, 1, &case)?);
    }
    let document = json!({
        "calibrant": env!("CARGO_PKG_VERSION"),
        "repetitions": REPETITIONS,
        "cases": cases,
    });
    std::fs::write(&file, serde_json::to_string(&document)?)?;
    Ok(())
}

/// A motion that stands still twice: nodes 4 = 5 on every axis, and 9 = 10 = 11 on x.
fn with_plateaus(seed: u64) -> calibrant::Result<JerkControlledMotion> {
    let case = Case::new(SensorModel::ScaleBias, Trust::Known, INTERVALS, INTERVAL_S, RATE_HZ, seed);
    let mut nodes = case.command.motion.acceleration_mps2().to_vec();
    nodes[5] = nodes[4];
    nodes[10].x = nodes[9].x;
    nodes[11].x = nodes[9].x;
    JerkControlledMotion::uniform(INTERVAL_S, nodes)
}

/// The problem, and the answer of calibrant.
fn record(trust: &str, model: &str, seed: u64, case: &Case) -> Result<Value, Box<dyn std::error::Error>> {
    let motion = &case.command.motion;
    let jerk_sd: Option<Vec<Vector3<f64>>> = match case.command.trust {
        Trust::Known => Some(vec![Vector3::zeros(); motion.intervals()]),
        Trust::Noisy(noise) => Some(motion.jerk_mps3().iter().map(|u| noise.sd(u)).collect()),
        Trust::Unknown => None,
    };
    let answer = match case.calibrate() {
        Ok(calibration) => answer(&calibration)?,
        Err(error) if error.is_not_identifiable() => {
            let text = error.to_string();
            json!({ "not_identifiable": text, "names_parameters": names_all_parameters(case, &text) })
        }
        Err(error) => return Err(error.into()),
    };
    let times = wall_times(case);
    let percentile = |percent: usize| times[(times.len() - 1) * percent / 100].as_secs_f64();
    Ok(json!({
        "trust": trust,
        "model": model,
        "seed": seed,
        "start_known": true,
        "end_known": case.command.known_ends == KnownEnds::Both,
        "sample_times_s": case.recording.times_s(),
        "readings_mps2": rows(case.recording.readings()),
        "node_times_s": motion.times_s(),
        "commanded_mps2": rows(motion.acceleration_mps2()),
        "gravity": case.command.gravity.map(|gravity| json!({
            "force_mps2": gravity.force_mps2.as_slice(),
            "offset_covariance": rows(&gravity.offset_covariance().column_iter().map(Into::into).collect::<Vec<_>>()),
        })),
        "noise_mps2": case.sensor.noise_mps2.map(|noise| noise.as_slice().to_vec()),
        "jerk_sd_mps3": jerk_sd.map(|sd| rows(&sd)),
        "parameters": case.sensor.parameter_list().names(),
        "nominal": nominal(case),
        "answer": answer,
        "wall_s": { "median": percentile(50), "fastest": percentile(0), "p95": percentile(95) },
    }))
}

fn answer(calibration: &Calibration) -> Result<Value, &'static str> {
    let Recovered::Motion(recovered) = &calibration.recovered else { return Err("a motion was expected") };
    Ok(json!({
        "status": calibration.status.name(),
        "values": calibration.values,
        "covariance": matrix(&calibration.covariance),
        "motion_mps2": rows(recovered.motion.acceleration_mps2()),
        "chi2": calibration.fit.chi2,
        "iterations": calibration.iterations,
        "gradient_norm": calibration.gradient_norm,
    }))
}

fn nominal(case: &Case) -> Option<Vec<f64>> {
    let nominal = case.sensor.nominal()?;
    Some(case.sensor.parameter_list().quantities().iter().map(|quantity| quantity.value(&nominal)).collect())
}

fn names_all_parameters(case: &Case, text: &str) -> bool {
    case.sensor.parameter_list().names().iter().all(|name| text.contains(name))
}

/// Durations of whole calibrations, ascending.
fn wall_times(case: &Case) -> Vec<Duration> {
    let mut times = Vec::with_capacity(REPETITIONS);
    for repetition in 0..WARM_UP + REPETITIONS {
        let start = Instant::now();
        let _ = black_box(black_box(case).calibrate());
        let time = start.elapsed();
        if repetition >= WARM_UP {
            times.push(time);
        }
    }
    times.sort_unstable();
    times
}

fn rows(vectors: &[Vector3<f64>]) -> Vec<[f64; 3]> {
    vectors.iter().map(|v| [v.x, v.y, v.z]).collect()
}

fn matrix(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}
