//! Tests of duplicate recordings in disguise, and of honest repetitions that look alike.

use crate::common::{draw_imu, normal, xsens};
use crate::validation::bench::{bench, simulate};
use calibrant::estimate::{find_holds, noise_in_common, readings_in_common};
use calibrant::motion::Hold;
use calibrant::sensor::{ImuRecording, ReadingUnit, Recording, SensorKind, SensorParameters};
use calibrant::simulate::{HoldsSimulation, ImuSimulation, Purpose, Rng, simulate_holds, stream};
use nalgebra::Vector3;
use rayon::prelude::*;

/// Standard deviation of the noise of a sample, m/s².
const SD: f64 = 0.01;

/// A recording without noise: 20 poses of 2 s at 100 Hz, of a machine that repeats itself.
fn quiet() -> Recording {
    let setup = HoldsSimulation {
        poses: 20,
        hold_s: 2.0,
        turn_s: 1.0,
        rate_hz: 100.0,
        gravity_mps2: 9.81,
        between_holds_sd_mps2: 0.0,
    };
    let unit = ReadingUnit::MetrePerSecondSquared;
    let mut rng = stream(71, Purpose::Sensor, 0);
    simulate_holds(&SensorParameters::identity(), &Vector3::zeros(), unit, &setup, &mut rng).0
}

/// One of its recordings. `filter` is the share of the previous sample's noise that stays.
fn noisy(quiet: &Recording, filter: f64, rng: &mut Rng) -> Recording {
    let mut recording = quiet.clone();
    let mut noise = Vector3::zeros();
    for y in &mut recording.readings {
        noise = filter * noise + (1.0 - filter * filter).sqrt() * Vector3::from_fn(|_, _| SD * normal(rng));
        *y += noise;
    }
    recording
}

fn holds(recording: &Recording) -> Vec<Hold> {
    find_holds(recording, 1.0).expect("found")
}

fn rounded(mut recording: Recording, step: f64) -> Recording {
    recording.readings.iter_mut().for_each(|y| *y = y.map(|y| (y / step).round() * step));
    recording
}

fn chosen(recording: &Recording, every: &[usize]) -> Recording {
    Recording {
        times_s: every.iter().map(|&k| recording.times_s[k]).collect(),
        readings: every.iter().map(|&k| recording.readings[k]).collect(),
        ..recording.clone()
    }
}

#[test]
fn honest_repetitions_have_no_noise_in_common() {
    // a machine that makes the same movements at the same times, with the same hum, the same ringing after
    // each and the same warming up
    let still = quiet();
    let mut machine = still.clone();
    for (t, y) in machine.times_s.iter().zip(&mut machine.readings) {
        let into = t % 3.0;
        *y += Vector3::new(3.0, -2.0, 1.0) * SD * (41.0 * t).sin();
        *y += Vector3::new(1.0, 2.0, 0.0) * SD * (-8.0 * into).exp() * (150.0 * into).cos();
        *y += Vector3::repeat(1e-3 * t);
    }
    let pairs: Vec<(u64, &Recording, f64, f64)> = (0..200)
        .map(|number| {
            let base = if number % 2 == 0 { &still } else { &machine };
            // white noise and filtered noise, fine and coarse steps
            (number, base, [0.0, 0.8][number as usize / 2 % 2], [1e-6, 2.0][number as usize / 4 % 2])
        })
        .collect();
    let alarms: Vec<_> = pairs
        .into_par_iter()
        .filter_map(|(number, base, filter, step)| {
            let mut rng = stream(72, Purpose::Sensor, number);
            let mut record = || rounded(noisy(base, filter, &mut rng), step * SD);
            let (one, other) = (record(), record());
            let found = noise_in_common(&one, &holds(&one), &other);
            // intervals that contain the movements, too
            let whole =
                calibrant::estimate::holds_between(&one, &[(0.0, 30.0), (30.1, 60.0)]).expect("samples");
            found.or(noise_in_common(&one, &whole, &other)).map(|r| (number, r))
        })
        .collect();
    assert!(alarms.is_empty(), "{alarms:?}");
}

#[test]
fn the_same_recording_is_known_in_every_disguise() {
    let mut rng = stream(73, Purpose::Sensor, 0);
    for filter in [0.0, 0.8] {
        let one = noisy(&quiet(), filter, &mut rng);
        let n = one.len();
        let mut other_unit = one.clone();
        other_unit.readings.iter_mut().for_each(|y| *y /= 9.806_65);
        let mut later = rounded(one.clone(), 0.1 * SD);
        later.times_s.iter_mut().for_each(|t| *t += 1.7e9);
        let mut from_zero = rounded(chosen(&one, &(n / 3..n).collect::<Vec<_>>()), 0.1 * SD);
        let start = from_zero.times_s[0];
        from_zero.times_s.iter_mut().for_each(|t| *t -= start);
        let mut thin_from_zero = chosen(&one, &(n / 3..n).step_by(4).collect::<Vec<_>>());
        let start = thin_from_zero.times_s[0];
        thin_from_zero.times_s.iter_mut().for_each(|t| *t -= start);
        let mut slower = one.clone();
        slower.times_s = (0..4 * n / 5).map(|k| k as f64 / 80.0).collect();
        slower.readings = slower
            .times_s
            .iter()
            .map(|t| {
                let k = ((t * 100.0) as usize).min(n - 2);
                let part = t * 100.0 - k as f64;
                one.readings[k] * (1.0 - part) + one.readings[k + 1] * part
            })
            .collect();
        let mut pairs = chosen(&one, &(0..n / 2).map(|k| 2 * k).collect::<Vec<_>>());
        pairs.readings = one.readings.chunks_exact(2).map(|two| 0.5 * (two[0] + two[1])).collect();
        // differences of samples `apart` have the variance 2 (1 − filter^apart) σ²; rounding adds q²/6; less
        // the random error of 60 blocks
        let left = |step: f64, apart: i32| {
            let variance = 2.0 * (1.0 - filter.powi(apart));
            (variance / (variance + step * step / 6.0)).sqrt() - 0.05
        };
        let disguises = [
            ("itself", one.clone(), 0.999),
            ("rounded to a standard deviation", rounded(one.clone(), SD), left(1.0, 1)),
            ("rounded to three", rounded(one.clone(), 3.0 * SD), 0.36),
            ("in g", other_unit, 0.999),
            ("every second sample", chosen(&one, &(0..n).step_by(2).collect::<Vec<_>>()), 0.999),
            (
                "every fifth, rounded",
                rounded(chosen(&one, &(3..n).step_by(5).collect::<Vec<_>>()), SD),
                left(1.0, 5),
            ),
            ("with the clock of the day", later, 0.99),
            ("its end, from zero", from_zero, 0.99),
            ("every fourth of its end, from zero", thin_from_zero, 0.99),
            ("at another rate", slower, 0.95),
            ("means of two", pairs, 0.6),
        ];
        for (disguise, other, at_least) in disguises {
            for (one, other) in [(&one, &other), (&other, &one)] {
                let found = noise_in_common(one, &holds(&one.clone()), other);
                assert!(found.is_some_and(|r| r > at_least), "{disguise}: {found:?}");
            }
        }
    }
}

#[test]
fn the_halves_of_the_xsens_recording_are_two_and_its_every_second_sample_is_one() {
    let Some((recording, _)) = xsens() else { return };
    let one = recording.accelerometer.expect("there");
    let middle = one.len() / 2;
    let [first, second] = [0..middle, middle..one.len()].map(|part| chosen(&one, &part.collect::<Vec<_>>()));
    assert_eq!(noise_in_common(&first, &holds(&first), &second), None);
    assert_eq!(noise_in_common(&second, &holds(&second), &first), None);
    let every_second = chosen(&one, &(1..one.len()).step_by(2).collect::<Vec<_>>());
    for other in [every_second, rounded(one.clone(), 5.0)] {
        let found = noise_in_common(&one, &holds(&one), &other);
        assert!(found.is_some_and(|r| r > 0.8), "{found:?}");
    }
}

#[test]
fn honest_repetitions_have_no_readings_in_common() {
    let still = quiet();
    let shares: Vec<(u64, f64, Option<f64>)> = (0..200_u64)
        .into_par_iter()
        .map(|number| {
            let mut rng = stream(74, Purpose::Sensor, number);
            // from fine steps to noise of a fifth of one, and none that shows
            let step = [1e-6, 2.0, 5.0, 1e3][number as usize % 4];
            let filter = [0.0, 0.8][number as usize / 4 % 2];
            let mut record = || rounded(noisy(&still, filter, &mut rng), step * SD);
            let (one, other) = (record(), record());
            let intervals: Vec<(f64, f64)> =
                (0..20).map(|j| 3.0 * f64::from(j)).map(|t| (t + 0.05, t + 1.95)).collect();
            let holds = calibrant::estimate::holds_between(&one, &intervals).expect("samples");
            (number, step, readings_in_common(&one, &holds, &other))
        })
        .collect();
    let alarms: Vec<_> = shares.iter().filter(|(_, _, found)| found.is_some()).collect();
    assert!(alarms.is_empty(), "{alarms:?}");
    // a sensor with one value
    let mut constant = still.clone();
    constant.readings.iter_mut().for_each(|y| *y = Vector3::new(1.0, 2.0, 3.0));
    let intervals =
        calibrant::estimate::holds_between(&constant, &[(0.0, 30.0), (30.1, 60.0)]).expect("samples");
    assert_eq!(readings_in_common(&constant, &intervals, &constant), None);
}

#[test]
fn the_same_readings_are_known_in_any_order_and_at_any_time() {
    let mut rng = stream(75, Purpose::Sensor, 0);
    for step in [1e-6, 2.0, 5.0] {
        let one = rounded(noisy(&quiet(), 0.0, &mut rng), step * SD);
        let n = one.len();
        let mut reversed = one.clone();
        reversed.readings.reverse();
        let mut exchanged = one.clone();
        exchanged.readings.rotate_left(n / 2 + 3);
        let mut slower = one.clone();
        slower.times_s.iter_mut().for_each(|t| *t *= 1.1);
        let mut part_reversed = chosen(&one, &(n / 3..2 * n / 3).collect::<Vec<_>>());
        part_reversed.readings.reverse();
        for (disguise, other) in [
            ("reversed", reversed),
            ("halves exchanged", exchanged),
            ("another clock", slower),
            ("a part, reversed", part_reversed),
        ] {
            // a third of the few blocks that very coarse readings have once is too few to decide
            if step > 2.0 && other.len() < n {
                continue;
            }
            let share = if other.len() < n { 0.28 } else { 0.98 };
            for (one, other, share) in [(&one, &other, share), (&other, &one, 0.98)] {
                let found = readings_in_common(one, &holds(one), other);
                assert!(found.is_some_and(|found| found > share), "{disguise} {step}: {found:?}");
            }
        }
    }
}

/// A moving average over `window` samples; with `trailing` its times are those of the last one.
fn smoothed(recording: &Recording, window: usize, trailing: bool) -> Recording {
    let n = recording.len();
    let after = if trailing { 0 } else { window / 2 };
    let mean = |k: usize| {
        let of = &recording.readings[(k + after + 1).saturating_sub(window)..(k + after + 1).min(n)];
        of.iter().sum::<Vector3<f64>>() / of.len() as f64
    };
    Recording { readings: (0..n).map(mean).collect(), ..recording.clone() }
}

/// White and filtered noise, centred and trailing windows, thinned out after it, quantised.
#[test]
fn a_smoothed_recording_is_known() {
    for (number, filter) in [0.0, 0.8, 0.0, 0.8].into_iter().enumerate() {
        let one = noisy(&quiet(), filter, &mut stream(76, Purpose::Sensor, number as u64));
        let known = |copy: &Recording, disguise: &str| {
            for (one, other) in [(&one, copy), (copy, &one)] {
                let found = noise_in_common(one, &holds(one), other);
                println!("{filter} {disguise}: {found:?}");
                assert!(found.is_some_and(|r| r > 0.4), "{filter} {disguise}: {found:?}");
            }
        };
        for window in [3, 5, 10] {
            let centred = smoothed(&one, window, false);
            known(&centred, &format!("mean of {window}"));
            known(&smoothed(&one, window, true), &format!("mean of the last {window}"));
            known(&rounded(centred.clone(), 0.5 * SD), &format!("mean of {window}, rounded"));
            let every: Vec<usize> = (0..one.len()).step_by(window).collect();
            known(&chosen(&centred, &every), &format!("means of {window}"));
        }
        let mut low_pass = one.clone();
        for k in 1..one.len() {
            low_pass.readings[k] = 0.8 * low_pass.readings[k - 1] + 0.2 * one.readings[k];
        }
        known(&low_pass, "through a low-pass filter");
    }
}

/// A machine whose motion decays after each turn, and whose sensor creeps in each hold, as before; holds of
/// any length.
#[test]
fn what_a_machine_repeats_slowly_is_no_noise_in_common() {
    let still = quiet();
    for (amplitude, settling_s) in
        [(3.0, 0.05), (3.0, 0.2), (30.0, 0.2), (3.0, 0.7), (30.0, 0.7), (10.0, 3.0)]
    {
        let mut machine = still.clone();
        for (t, y) in machine.times_s.iter().zip(&mut machine.readings) {
            // another direction in each hold
            let direction = Vector3::new((t / 3.0).floor().sin(), (t / 3.0).floor().cos(), 1.0);
            *y += direction * amplitude * SD * (-(t % 3.0) / settling_s).exp();
            *y += Vector3::new(1.0, 0.0, -1.0) * SD * (4.4 * t).sin();
        }
        let alarms: Vec<_> = (0..100_u64)
            .into_par_iter()
            .filter_map(|number| {
                let mut rng = stream(77, Purpose::Sensor, number);
                let filter = [0.0, 0.8][number as usize % 2];
                let (one, other) = (noisy(&machine, filter, &mut rng), noisy(&machine, filter, &mut rng));
                let intervals: Vec<(f64, f64)> =
                    (0..20).map(|j| 3.0 * f64::from(j)).map(|t| (t + 0.05, t + 1.95)).collect();
                let holds = calibrant::estimate::holds_between(&one, &intervals).expect("samples");
                noise_in_common(&one, &holds, &other).map(|r| (number, r))
            })
            .collect();
        println!("{amplitude} {settling_s}: {}", alarms.len());
        assert!(alarms.is_empty(), "{amplitude} {settling_s}: {alarms:?}");
    }
}

/// Both sensors of an IMU, with scatter beside the noise and without.
#[test]
fn recordings_of_an_imu_have_no_noise_in_common_but_with_a_smoothed_copy() {
    let simulation = ImuSimulation::default();
    let bench = bench(&simulation);
    let found: Vec<[(Option<f64>, bool); 2]> = (0..200_u64)
        .into_par_iter()
        .map(|number| {
            let mut rng = stream(78, Purpose::Sensor, number);
            let truth = draw_imu(&mut rng);
            let size = [0.0, 0.3, 1.0, 3.0][number as usize % 4];
            let mut record = || simulate(&truth, &simulation, size, &mut rng);
            let (one, other) = (record(), record());
            let holds: Vec<Hold> =
                bench.calibrate(&one).hold_results().iter().map(|result| result.hold.clone()).collect();
            let window = [3, 5, 10][number as usize % 3];
            [SensorKind::Accelerometer, SensorKind::Gyroscope].map(|sensor_kind| {
                let of = |recording: &ImuRecording| recording.sensor(sensor_kind).expect("there").clone();
                let (one, other) = (of(&one), of(&other));
                let copy = noise_in_common(&one, &holds, &smoothed(&one, window, number % 2 == 1));
                (noise_in_common(&one, &holds, &other), copy.is_some_and(|r| r > 0.4))
            })
        })
        .collect();
    for k in 0..2 {
        assert!(found.iter().all(|pair| pair[k].0.is_none()));
        assert!(found.iter().all(|pair| pair[k].1));
    }
}
