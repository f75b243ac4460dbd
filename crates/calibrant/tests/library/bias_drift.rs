//! A bias that drifts over the recording: it hides in no parameter, and costs little where it is not there.

use crate::common::hand::ByHand;
use crate::common::{draw_imu, normal, run_imu};
use crate::common::{steady_holds, steady_imu, unfeeling_gyroscope};
use calibrant::estimate::{
    Calibration, CalibrationProblem, CalibrationSettings, HoldsSetup, ImuSetup, Stimulus, calibrate,
};
use calibrant::sensor::{Gauge, ReadingUnit, Recording, Sensor, SensorKind, SensorModel, SensorParameters};
use calibrant::simulate::{Purpose, Rng, stream};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use rayon::prelude::*;

const RATE_HZ: f64 = 50.0;

/// Evenly spread directions, ordered along one axis.
fn directions(count: usize) -> Vec<Vector3<f64>> {
    let point = |k: usize| {
        let z = 1.0 - (2.0 * k as f64 + 1.0) / count as f64;
        let angle = 2.4 * k as f64;
        Vector3::new(angle.cos(), angle.sin(), 0.0) * (1.0 - z * z).sqrt() + Vector3::z() * z
    };
    (0..count).map(point).collect()
}

/// The recording of a sensor that is held in these directions, each with a scatter of its own, while its bias drifts.
fn record(
    sensor: &SensorParameters,
    directions: &[Vector3<f64>],
    drift: &Vector3<f64>,
    rng: &mut Rng,
) -> Recording {
    let mut forces = Vec::new();
    for (k, direction) in directions.iter().enumerate() {
        let scatter = Vector3::from_fn(|_, _| 1e-3 * normal(rng));
        forces.extend((0..150).map(|_| direction * 9.806_65 + scatter));
        if let Some(next) = directions.get(k + 1) {
            let turn = UnitQuaternion::rotation_between(direction, next).expect("not opposite");
            let shake = |x: f64| Vector3::new(2.0, 1.0, -1.5) * (25.0 * x).sin();
            let part = |x: f64| UnitQuaternion::identity().slerp(&turn, x) * direction * 9.806_65 + shake(x);
            forces.extend((0..60).map(|k| part((f64::from(k) + 0.5) / 60.0)));
        }
    }
    let count = forces.len() as f64;
    let mut reading = |(k, force): (usize, &Vector3<f64>)| {
        let noise = Vector3::from_fn(|_, _| 5e-3 * normal(rng));
        sensor.reading(force) + noise + drift * (k as f64 / count - 0.5)
    };
    let readings = forces.iter().enumerate().map(&mut reading).collect();
    let times_s = (0..forces.len()).map(|k| k as f64 / RATE_HZ).collect();
    Recording::new(times_s, readings, 3, ReadingUnit::MetrePerSecondSquared).expect("samples in order")
}

/// z of each parameter, and the calibration.
fn calibrated(number: u64, drift: &Vector3<f64>, in_order: bool, allowed: f64) -> (Vec<f64>, Calibration) {
    let mut rng = stream(95, Purpose::Sensor, number);
    let errors = |size: f64, rng: &mut Rng| Matrix3::from_fn(|_, _| size * normal(rng));
    let bias = Vector3::from_fn(|_, _| 0.1 * normal(&mut rng));
    let matrix = Matrix3::identity() + errors(0.01, &mut rng);
    let sensor = Gauge::Upper.apply(&SensorParameters { bias, matrix, ..SensorParameters::identity() });
    let mut order = directions(20);
    if !in_order {
        rand::seq::SliceRandom::shuffle(order.as_mut_slice(), &mut rng);
    }
    let recording = record(&sensor, &order, drift, &mut rng);
    let setup = HoldsSetup { bias_drift_sd_mps2: allowed, ..steady_holds() };
    let model = Sensor::triaxial(SensorModel::Full);
    let problem =
        CalibrationProblem { sensor: &model, recording: &recording, stimulus: Stimulus::Holds(&setup) };
    let found = calibrate(&problem, &CalibrationSettings::default()).expect("determined");
    let sd = found.sd();
    let of = |k: usize| {
        let truth = found.quantities[k]
            .value(&calibrant::sensor::ImuParameters::identity().with(SensorKind::Accelerometer, sensor));
        (found.values[k] - truth) / sd[k]
    };
    ((0..sd.len()).map(of).collect(), found)
}

/// The largest |z|, the mean of z², and the mean standard deviation of bias.z, of 60 sensors.
fn all(drift: Vector3<f64>, in_order: bool, allowed: f64) -> (f64, f64, f64) {
    let found: Vec<_> =
        (0..60).into_par_iter().map(|number| calibrated(number, &drift, in_order, allowed)).collect();
    let every = || found.iter().flat_map(|(z, _)| z);
    let largest = every().fold(0.0_f64, |most, z| most.max(z.abs()));
    let squares = every().map(|z| z * z).sum::<f64>() / every().count() as f64;
    let sd = found.iter().map(|(_, found)| found.sd()[2]).sum::<f64>() / 30.0;
    println!(
        "drift {:.3}, in order {in_order}, allowed {allowed}: largest {largest:.1}, z² {squares:.2}, sd {sd:.5}",
        drift.norm()
    );
    (largest, squares, sd)
}

#[test]
fn a_drift_hides_in_no_parameter() {
    let drift = Vector3::new(0.005, -0.01, 0.03);
    let (without, ..) = all(drift, true, 0.0);
    assert!(without > 15.0, "the holds in order are wrong by this many standard deviations: {without}");
    for in_order in [true, false] {
        let (largest, squares, _) = all(drift, in_order, 0.02);
        assert!(largest < 5.0 && squares < 1.5, "{in_order}: {largest} {squares}");
    }
}

#[test]
fn an_allowance_for_drift_costs_little_where_there_is_none() {
    let none = Vector3::zeros();
    let (_, squares_without, sd_without) = all(none, false, 0.0);
    let (_, squares, sd) = all(none, false, 0.02);
    assert!((0.6..1.4).contains(&squares) && squares_without < 1.4, "{squares} {squares_without}");
    assert!(sd < 1.4 * sd_without, "{sd} {sd_without}");
}

#[test]
fn the_result_states_the_drift() {
    let drift = Vector3::new(0.005, -0.01, 0.03);
    let (_, found) = calibrated(1, &drift, false, 0.02);
    let stated = found.holds().and_then(|holds| holds.drift.clone()).expect("allowed for");
    // from the middle of the first hold to that of the last
    for axis in 0..3 {
        let off = stated.value[axis] - drift[axis] * 0.965;
        assert!(off.abs() < 4.0 * stated.sd()[axis] && stated.sd()[axis] < 0.005, "{stated:?}");
    }
    assert!(calibrated(1, &drift, false, 0.0).1.holds().is_some_and(|holds| holds.drift.is_none()));
}

/// The accelerometer of a whole IMU drifts by 3 mg.
#[test]
fn the_parameters_of_an_imu_are_within_their_uncertainty_with_a_drift() {
    let squares = |allowed: f64, drift_mps2: f64| {
        let one = |number: u64| {
            let mut rng = stream(96, Purpose::Sensor, number);
            let imu = draw_imu(&mut rng);
            let mut recording = ByHand::default().record(&imu, &mut rng);
            let accelerometer = recording[SensorKind::Accelerometer].as_mut().expect("there");
            let count = accelerometer.len() as f64;
            for (k, reading) in accelerometer.readings_mut().iter_mut().enumerate() {
                *reading += Vector3::new(0.3, -0.5, 0.8) * (drift_mps2 * (k as f64 / count - 0.5));
            }
            let holds = HoldsSetup { bias_drift_sd_mps2: allowed, ..steady_holds() };
            let setup = ImuSetup { holds, ..steady_imu() };
            let unit = ReadingUnit::MetrePerSecondSquared;
            let found = run_imu(&recording, &unfeeling_gyroscope(), &setup, unit).expect("determined");
            let sd = found.sd();
            let z = |k: usize| (found.values[k] - found.quantities[k].value(&imu)) / sd[k];
            ((0..sd.len()).map(z).map(|z| z * z).sum::<f64>() / sd.len() as f64, sd[0])
        };
        let all: Vec<(f64, f64)> = (0..30).into_par_iter().map(one).collect();
        let mean = |of: fn(&(f64, f64)) -> f64| all.iter().map(of).sum::<f64>() / 30.0;
        println!(
            "IMU, drift {drift_mps2}, allowed {allowed}: z² {:.2}, sd {:.5}",
            mean(|a| a.0),
            mean(|a| a.1)
        );
        (mean(|all| all.0), mean(|all| all.1))
    };
    let (without, sd_without) = squares(0.0, 0.0);
    let (allowed, sd) = squares(0.02, 0.0);
    assert!(without < 1.3 && allowed < 1.4 && sd < 1.3 * sd_without, "{without} {allowed} {sd} {sd_without}");
    let (with_drift, sd) = squares(0.02, 0.03);
    assert!(with_drift < 1.5 && sd < 1.5 * sd_without, "{with_drift} {sd} {sd_without}");
}
