//! Tests that a log of poses which interpolates a slower stream is recognised, and others are not.

use crate::common::{normal, shared_data};
use calibrant::io::{ReferenceLogOptions, read_reference_log};
use calibrant::machine::log::{PoseLog, RecoveredStream, recover_interpolated};
use nalgebra::{UnitQuaternion, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Where a body is that is moved by hand, and how it is turned.
fn pose(t: f64) -> (Vector3<f64>, UnitQuaternion<f64>) {
    let position = Vector3::new(
        0.2 * (2.1 * t).sin() + 0.05 * (9.0 * t + 1.0).sin(),
        0.3 * (1.3 * t + 0.5).cos() + 0.02 * (13.0 * t).sin(),
        0.1 * (3.7 * t).sin() + 1.2,
    );
    let turn = Vector3::new(1.5 * (1.1 * t).sin(), (2.3 * t).cos(), 0.8 * (1.7 * t + 2.0).sin());
    (position, UnitQuaternion::from_scaled_axis(turn))
}

/// As a file has it, with seven decimals.
fn rounded(value: f64) -> f64 {
    (value * 1e7).round() / 1e7
}

fn rounded_turn(turn: UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(turn.into_inner().coords.map(rounded).into())
}

/// A log at these times of a motion that is linear between the samples of a stream.
fn interpolated(samples: usize, rate_hz: f64, first_s: f64, period_s: f64, noise_m: f64) -> PoseLog {
    let mut random = ChaCha8Rng::seed_from_u64(20);
    let length = ((samples as f64 / rate_hz + 0.2) / period_s) as usize + 4;
    let stream: Vec<_> = (0..length)
        .map(|knot| {
            let (position, turn) = pose(first_s + knot as f64 * period_s);
            (position + noise_m * Vector3::from_fn(|_, _| normal(&mut random)), turn)
        })
        .collect();
    let at = |t: f64| {
        let place = (t - first_s) / period_s;
        let (knot, weight) = (place.floor() as usize, place - place.floor());
        let ((p, q), (next_p, next_q)) = (stream[knot], stream[knot + 1]);
        ((p * (1.0 - weight) + next_p * weight).map(rounded), rounded_turn(q.nlerp(&next_q, weight)))
    };
    log((0..samples).map(|k| 0.5 + k as f64 / rate_hz).collect(), at)
}

fn log(times_s: Vec<f64>, at: impl Fn(f64) -> (Vector3<f64>, UnitQuaternion<f64>)) -> PoseLog {
    let (positions_m, world_from_body) =
        times_s.iter().map(|t| at(*t)).map(|(p, q)| (Some(p), Some(q))).unzip();
    PoseLog { times_s, positions_m, world_from_body }
}

/// Root mean square distance, m, and angle, rad, from a stream, and the number of its samples that are there.
fn off(
    stream: &RecoveredStream,
    truth: impl Fn(f64) -> Option<(Vector3<f64>, UnitQuaternion<f64>)>,
) -> (f64, f64, usize) {
    let (mut metres, mut radians, mut there) = (0.0, 0.0, 0);
    for (k, t) in stream.log.times_s.iter().enumerate() {
        let (Some(position), Some(turn), Some((p, q))) =
            (stream.log.positions_m[k], stream.log.world_from_body[k], truth(*t))
        else {
            continue;
        };
        metres += (position - p).norm_squared();
        radians += turn.angle_to(&q).powi(2);
        there += 1;
    }
    ((metres / there as f64).sqrt(), (radians / there as f64).sqrt(), there)
}

#[test]
fn streams_of_many_rates_are_recovered() {
    let mut wrong = Vec::new();
    for ratio in [1.5, 1.7, 2.0, 2.05, 2.381, 2.5, 3.0, 3.37, 4.0, 7.3, 10.0, 23.7, 50.0] {
        for (drift, phase) in [(0.0, 0.0), (130e-6, 0.31), (-2e-3, 0.77)] {
            let period_s = ratio / 285.714 * (1.0 - drift);
            let first_s = 0.4 - phase * period_s;
            let Some(stream) = recover_interpolated(&interpolated(6000, 285.714, first_s, period_s, 0.0))
            else {
                wrong.push(format!("{ratio} {drift} {phase}: not found"));
                continue;
            };
            let period_off = stream.period_s / period_s - 1.0;
            let place = (stream.first_s - first_s) / period_s;
            let phase_off_s = (place - place.round()) * period_s;
            let (metres, radians, there) = off(&stream, |t| Some(pose(t)));
            let said = format!(
                "{ratio} {drift} {phase}: period {period_off:.1e} sd {:.1e}, phase {phase_off_s:.1e} s, {metres:.1e} m, {radians:.1e} rad, rms {:.1e} m {:.1e} rad, {there} of {}",
                stream.period_sd_s / period_s,
                stream.rms_m,
                stream.rms_rad.expect("turned"),
                stream.log.times_s.len()
            );
            let is_good = period_off.abs() < 1e-6
                && period_off.abs() < 3e-7 + 5.0 * stream.period_sd_s / period_s
                && phase_off_s.abs() < 5e-6
                && metres < 1e-7
                && (ratio > 10.0 || radians < 1e-5)
                && stream.rms_m < 1e-7
                && there + 1 >= (6000.0 / 285.714 / period_s) as usize;
            if !is_good {
                wrong.push(said);
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn noise_of_the_stream_is_no_noise_of_the_log() {
    let stream = recover_interpolated(&interpolated(6000, 285.714, 0.4, 1.0 / 120.0, 1e-3)).expect("found");
    assert!(stream.rms_m < 1e-7 && (stream.period_s * 120.0 - 1.0).abs() < 1e-8);
    let (nominal_hz, faster) = stream.clock().expect("a whole number of hertz");
    assert!(nominal_hz == 120.0 && faster.abs() < 1e-8);
}

#[test]
fn gaps_of_the_stream_stay_gaps() {
    let mut log = interpolated(6000, 285.714, 0.4, 1.0 / 120.0, 0.0);
    log.positions_m[1000..1300].fill(None);
    log.world_from_body[..2000].fill(None);
    let stream = recover_interpolated(&log).expect("found");
    let of = |from_s: f64, to_s: f64| {
        let times = stream.log.times_s.iter().enumerate();
        let inside: Vec<usize> = times.filter(|(_, t)| (from_s..to_s).contains(*t)).map(|(k, _)| k).collect();
        let seen = |k: &&usize| stream.log.positions_m[**k].is_some();
        let turned = |k: &&usize| stream.log.world_from_body[**k].is_some();
        (inside.len(), inside.iter().filter(seen).count(), inside.iter().filter(turned).count())
    };
    assert_eq!(of(4.02, 5.03), (121, 0, 0));
    assert_eq!(of(5.06, 7.48), (290, 290, 0));
    assert_eq!(of(7.53, 21.4), (1664, 1664, 1664));
    let (metres, radians, _) = off(&stream, |t| Some(pose(t)));
    assert!(metres < 1e-6 && radians < 1e-5, "{metres} {radians}");
}

#[test]
fn other_logs_are_not_taken_for_interpolated() {
    let even = |rate_hz: f64, samples: usize| (0..samples).map(|k| k as f64 / rate_hz).collect::<Vec<f64>>();
    let mut random = ChaCha8Rng::seed_from_u64(21);
    let mut noise = |sd: f64, samples: usize| -> Vec<Vector3<f64>> {
        (0..samples).map(|_| sd * Vector3::from_fn(|_, _| normal(&mut random))).collect()
    };
    let mut logs = Vec::new();
    for rate_hz in [30.0, 100.0, 120.0, 285.714, 500.0, 1000.0] {
        let smooth = log(even(rate_hz, 4000), |t| (pose(t).0.map(rounded), pose(t).1));
        let mut noisy = smooth.clone();
        let of_tracker = noise(1e-4, 4000);
        noisy
            .positions_m
            .iter_mut()
            .zip(&of_tracker)
            .for_each(|(position, noise)| *position = position.map(|p| p + noise));
        // noise of two samples is as much as the next
        let mut coloured = smooth.clone();
        for (k, position) in coloured.positions_m.iter_mut().enumerate() {
            let noise = of_tracker[k.saturating_sub(8)..=k].iter().sum::<Vector3<f64>>() / 3.0;
            *position = position.map(|p| (p + noise).map(rounded));
        }
        for share in [0.05, 0.1, 0.13, 0.17, 0.21, 0.24, 0.27, 0.31, 0.36, 0.4, 0.45] {
            let vibrating = log(even(rate_hz, 4000), |t| {
                let vibration = 2e-4 * (t * share * rate_hz * std::f64::consts::TAU).sin();
                ((pose(t).0 + Vector3::repeat(vibration)).map(rounded), pose(t).1)
            });
            logs.push(("vibrating", rate_hz, vibrating));
        }
        let rest = log(even(rate_hz, 4000), |_| (Vector3::new(0.1, 0.2, 0.3), UnitQuaternion::identity()));
        let mut resting = rest.clone();
        resting
            .positions_m
            .iter_mut()
            .zip(&of_tracker)
            .for_each(|(position, noise)| *position = position.map(|p| (p + noise).map(rounded)));
        // each pose of a slower stream several times
        let held = log(even(rate_hz, 4000), |t| (pose((t * 40.0).floor() / 40.0).0.map(rounded), pose(t).1));
        let names = ["smooth", "noisy", "coloured", "rest", "resting", "held"];
        logs.extend(
            names
                .into_iter()
                .zip([smooth, noisy, coloured, rest, resting, held])
                .map(|(name, log)| (name, rate_hz, log)),
        );
    }
    // corners that are real: at uneven times
    let knots: Vec<f64> = (0..400).map(|k| 0.02 * k as f64 + 0.006 * (k as f64 * 2.3).sin()).collect();
    let uneven = log(even(285.714, 2000), |t| {
        let next = knots.partition_point(|knot| *knot <= t).clamp(1, knots.len() - 1);
        let weight = (t - knots[next - 1]) / (knots[next] - knots[next - 1]);
        ((pose(knots[next - 1]).0 * (1.0 - weight) + pose(knots[next]).0 * weight).map(rounded), pose(t).1)
    });
    logs.push(("uneven", 285.714, uneven));
    let short = interpolated(150, 285.714, 0.4, 1.0 / 120.0, 0.0);
    logs.push(("short", 285.714, short));
    let found: Vec<String> = logs
        .iter()
        .filter_map(|(name, rate_hz, log)| {
            let stream = recover_interpolated(log)?;
            Some(format!("{name} at {rate_hz} Hz: {} Hz, rms {}", stream.rate_hz(), stream.rms_m))
        })
        .collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn the_stream_behind_the_references_of_broad_is_recovered() {
    for trial in ["broad_21_undisturbed_fast_combined", "broad_03_undisturbed_slow_rotation_C"] {
        let read = |name: &str| {
            let path = shared_data(&format!("broad-mocap/{trial}/{name}.csv"))?;
            let file = read_reference_log(&path, &ReferenceLogOptions::default()).expect("read");
            Some(file.poses().expect("poses").clone())
        };
        let (Some(published), Some(independent)) =
            (read("ref_285hz_as_published"), read("ref_120hz_recovered"))
        else {
            return;
        };
        let stream = recover_interpolated(&published).expect("found");
        let (nominal_hz, faster) = stream.clock().expect("a nominal rate");
        let times = &independent.times_s;
        let period_s = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
        let place = (times[0] - stream.first_s) / stream.period_s;
        let phase_off_s = (place - place.round()) * stream.period_s;
        let nearest = |t: f64| {
            let k = ((t - times[0]) / period_s).round();
            let k = (k >= 0.0).then_some(k as usize).filter(|k| *k < times.len())?;
            Some((independent.positions_m[k]?, independent.world_from_body[k]?))
        };
        let (metres, radians, there) = off(&stream, nearest);
        let said = format!(
            "{trial}: {:.3} ppm fast, period off {:.2e}, phase off {phase_off_s:.1e} s, rms {:.1e} m, off {metres:.1e} m {radians:.1e} rad, {there} samples",
            faster * 1e6,
            stream.period_s / period_s - 1.0,
            stream.rms_m
        );
        assert!(nominal_hz == 120.0 && (120e-6..140e-6).contains(&faster), "{said}");
        assert!((stream.period_s / period_s - 1.0).abs() < 1e-6 && phase_off_s.abs() < 1e-4, "{said}");
        // the published values have seven decimals of metres
        assert!(stream.rms_m < 5e-8 && stream.rms_rad.is_some_and(|rms| rms < 2e-8), "{said}");
        assert!(metres < 2e-5 && radians < 1e-4 && there > 21_000, "{said}");
    }
}
