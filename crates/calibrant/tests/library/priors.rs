//! A prior only adds information: no standard deviation grows by it, a weak one changes nothing, and what the data leave open follows it.

use crate::common::{draw_feeling_imu, run_imu};
use crate::common::{steady_holds, steady_imu};
use calibrant::estimate::{
    Calibration, CalibrationProblem, CalibrationSettings, Gyroscope, HoldsSetup, ImuSetup, KnownTerm,
    Stimulus, calibrate,
};
use calibrant::motion::Gravity;
use calibrant::sensor::{
    Gauge, Parameter, ReadingUnit, Recording, Sensor, SensorKind, SensorModel, SensorParameters,
};
use calibrant::simulate::{HoldsSimulation, ImuSimulation, Purpose, simulate_holds, simulate_imu, stream};
use nalgebra::Vector3;
use rand_distr::{Distribution, StandardNormal};

/// A datasheet whose spreads are larger by a factor.
fn sensor(factor: f64) -> Sensor {
    Sensor {
        noise_mps2: Some(Vector3::repeat(0.01)),
        bias_sd_mps2: Some(Vector3::repeat(0.1 * factor)),
        scale_sd: Some(Vector3::repeat(0.005 * factor)),
        cross_axis_sd: Some(0.01 * factor),
        ..Sensor::triaxial(SensorModel::Full)
    }
}

/// A sensor whose parameters, in the gauge, are drawn as the datasheet says.
fn truth(seed: u64) -> SensorParameters {
    let (sensor, mut rng) = (sensor(1.0), stream(seed, Purpose::Sensor, 0));
    let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
    let (list, mut truth) = (Gauge::Upper.parameter_list(SensorModel::Full), SensorParameters::identity());
    for (quantity, parameter) in
        list.quantities().iter().zip(list.describe(&sensor, &SensorParameters::identity()))
    {
        quantity.add_to(&mut truth, parameter.spread.expect("a spread") * normal());
    }
    truth
}

fn in_poses(poses: usize, seed: u64) -> Recording {
    let simulation = HoldsSimulation {
        poses,
        hold_s: 3.0,
        turn_s: 1.0,
        rate_hz: 100.0,
        gravity_mps2: 9.80665,
        between_holds_sd_mps2: if seed.is_multiple_of(2) { 1e-3 } else { 0.0 },
    };
    let unit = ReadingUnit::MetrePerSecondSquared;
    let mut rng = stream(seed, Purpose::Sensor, 1);
    simulate_holds(&truth(seed), &Vector3::repeat(0.01), unit, &simulation, &mut rng).0
}

/// Holds with gravity in the plane of y and z alone, all around.
fn about_x(poses: usize, seed: u64) -> (Recording, Vec<(f64, f64)>) {
    at_angles((0..poses).map(|pose| 2.4 * pose as f64), seed)
}

/// Holds with gravity in the plane of y and z, at angles from z.
fn at_angles(angles_rad: impl Iterator<Item = f64>, seed: u64) -> (Recording, Vec<(f64, f64)>) {
    let (truth, mut rng) = (truth(seed), stream(seed, Purpose::Sensor, 2));
    let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
    let (mut times_s, mut readings) = (Vec::new(), Vec::new());
    let mut intervals = Vec::new();
    for angle_rad in angles_rad {
        let (sin, cos) = angle_rad.sin_cos();
        let force = Vector3::new(0.0, sin, cos) * 9.80665;
        let start = times_s.len();
        for _ in 0..300 {
            times_s.push(times_s.len() as f64 / 100.0);
            readings.push(truth.reading(&force) + Vector3::from_fn(|_, _| 0.01 * normal()));
        }
        intervals.push((times_s[start], times_s[times_s.len() - 1]));
    }
    let unit = ReadingUnit::MetrePerSecondSquared;
    (Recording::new(times_s, readings, 3, unit).expect("samples in order"), intervals)
}

fn run(
    sensor: &Sensor,
    recording: &Recording,
    setup: &HoldsSetup,
    datasheet_prior: bool,
) -> calibrant::Result<Calibration> {
    let problem = CalibrationProblem { sensor, recording, stimulus: Stimulus::Holds(setup) };
    calibrate(&problem, &CalibrationSettings { datasheet_prior, ..CalibrationSettings::default() })
}

#[test]
fn a_prior_makes_no_holds_worse() {
    for seed in 0..12 {
        let recording = in_poses(10 + 2 * seed as usize, seed);
        let setup = steady_holds();
        let without = run(&sensor(1.0), &recording, &setup, false).expect("identifiable");
        let with = run(&sensor(1.0), &recording, &setup, true).expect("identifiable");
        for (k, (with, without)) in with.sd().into_iter().zip(without.sd()).enumerate() {
            assert!(with <= without * (1.0 + 1e-6), "{seed}, {k}: {with} with the prior, {without} without");
        }
        let rms = [&with, &without]
            .map(|calibration| calibration.holds().expect("held").magnitude_residual_rms_mps2);
        assert!(rms[0] < 1.05 * rms[1], "{seed}: |f| - g {rms:?}");
        let weak = run(&sensor(1e5), &recording, &setup, true).expect("identifiable");
        for k in 0..9 {
            let off = (weak.values[k] - without.values[k]) / without.sd()[k];
            assert!(off.abs() < 1e-4, "{seed}, {k}: a weak prior moves it by {off} sd");
            assert!((weak.sd()[k] / without.sd()[k] - 1.0).abs() < 1e-4, "{seed}, {k}");
        }
    }
}

#[test]
fn a_prior_gives_what_holds_about_one_axis_leave_open() {
    let mut squares = vec![0.0; 9];
    const RECORDINGS: u64 = 100;
    for seed in 0..RECORDINGS {
        let (recording, intervals) = about_x(14, seed);
        let setup = HoldsSetup { intervals_s: Some(intervals), ..steady_holds() };
        assert!(run(&sensor(1.0), &recording, &setup, false).is_err(), "nothing points along x");
        let with = run(&sensor(1.0), &recording, &setup, true).expect("the datasheet says the rest");
        let truth = truth(seed);
        let list = setup.gauge.parameter_list(SensorModel::Full);
        for (k, (quantity, sd)) in list.quantities().iter().zip(with.sd()).enumerate() {
            squares[k] += ((with.values[k] - quantity.value(&truth)) / sd).powi(2) / RECORDINGS as f64;
        }
        let scale_x =
            with.parameters.iter().position(|parameter| parameter.name.ends_with("scale.x")).expect("x");
        assert!((with.sd()[scale_x] / 0.005 - 1.0).abs() < 0.02, "{seed}: {}", with.sd()[scale_x]);
        assert!(with.holds().expect("held").magnitude_residual_rms_mps2 < 5e-3);
    }
    // the bias of x times a cross-axis term looks like a bias of y: its standard deviation is linearised, and too large
    assert!(squares.iter().all(|z2| *z2 < 1.5), "z² of each parameter: {squares:.2?}");
    assert!(squares[3] > 0.6, "scale.x is as the datasheet says: {squares:.2?}");
}

/// The covariance has gravity's share by the slope of the estimates: against fits with another gravity. A gain that the prior tells does not follow it,
/// and where holds tell no more than a sum of bias and gain, both follow it as the prior divides them.
#[test]
fn estimates_with_a_prior_follow_gravity_by_the_slope_that_is_stated() {
    let around = at_angles((0..14).map(|pose| 2.4 * f64::from(pose)), 3);
    let upright = at_angles((0..14).map(|pose| 0.02 * (2.4 * f64::from(pose)).sin()), 3);
    for (name, (recording, intervals)) in [("around", around), ("upright", upright)] {
        let at = |magnitude_mps2: f64| {
            let gravity = Gravity { magnitude_mps2, sd_mps2: 0.02 };
            let setup = HoldsSetup { intervals_s: Some(intervals.clone()), gravity, ..steady_holds() };
            run(&sensor(1.0), &recording, &setup, true).expect("the datasheet says the rest")
        };
        let (now, step) = (at(9.80665), 1e-3);
        let (low, high) = (at(9.80665 - step), at(9.80665 + step));
        for (k, parameter) in now.parameters.iter().enumerate() {
            let expected = (high.values[k] - low.values[k]) / (2.0 * step);
            let stated = now.gravity_slope[k];
            // one percent of the slope of a gain, and of a bias, by itself
            let whole = if parameter.name.contains("bias") { 1.0 } else { 1.0 / 9.80665 };
            assert!(
                (stated - expected).abs() < 0.01 * whole,
                "{name} {}: {stated} {expected}",
                parameter.name
            );
        }
        let slope_of = |end: &str| {
            let named = |parameter: &Parameter| parameter.name.ends_with(end);
            now.gravity_slope[now.parameters.iter().position(named).expect(end)]
        };
        assert!(slope_of("scale.x").abs() < 1e-3, "{name}: the prior tells it");
        if name == "upright" {
            assert!(slope_of("bias.z").abs() > 0.5, "a bias of 0.1 m/s² is likelier than a gain of 0.5 %");
        }
        // what is shared at one place is what the covariance has
        let shared = now.calibrated().shared.expect("uncertain");
        let off = now.gravity_slope.iter().zip(shared.root.iter()).map(|(slope, error)| slope * 0.02 - error);
        assert!(off.map(f64::abs).fold(0.0, f64::max) < 1e-15, "{name}");
    }
}

/// What is known of every gyroscope of this kind: each quantity with the spread of the population, times a factor.
fn population(
    calibration: &Calibration,
    truth: &calibrant::sensor::ImuParameters,
    factor: f64,
) -> Vec<KnownTerm> {
    let of_gyroscope =
        calibration.quantities.iter().filter(|quantity| quantity.sensor_kind() == SensorKind::Gyroscope);
    let known = |quantity: &calibrant::sensor::ImuQuantity| {
        let name = quantity.name();
        let nominal = if name.contains("scale") { 1.0 } else { 0.0 };
        let spread = if name.contains("bias") {
            0.02
        } else if name.contains("g_sensitivity") {
            2e-4
        } else {
            0.01
        };
        assert!((quantity.value(truth) - nominal).abs() < 6.0 * spread, "{name}");
        KnownTerm { quantity: *quantity, value: nominal, sd: Some(factor * spread) }
    };
    of_gyroscope.map(known).collect()
}

#[test]
fn a_prior_makes_no_imu_worse() {
    let unit = ReadingUnit::MetrePerSecondSquared;
    let gyroscope = Gyroscope { g_sensitivity: true, ..Gyroscope::default() };
    for seed in 0..8 {
        let mut rng = stream(seed, Purpose::Sensor, 3);
        let truth = draw_feeling_imu(&mut rng);
        let simulation = ImuSimulation { poses: 12 + seed as usize, ..ImuSimulation::default() };
        let recording = simulate_imu(&truth, &simulation, &mut rng);
        let run = |known: Vec<KnownTerm>| {
            let setup = ImuSetup { known, latitude_deg: Some(48.1), ..steady_imu() };
            run_imu(&recording, &gyroscope, &setup, unit).expect("determined")
        };
        let without = run(Vec::new());
        let [with, weak] = [1.0, 1e4].map(|factor| run(population(&without, &truth, factor)));
        for (k, quantity) in without.quantities.iter().enumerate() {
            let [sd, sd_with, sd_weak] = [&without, &with, &weak].map(|calibration| calibration.sd()[k]);
            let name = quantity.name();
            assert!(sd_with <= sd * (1.0 + 1e-4), "{seed}, {name}: {sd_with} with the prior, {sd} without");
            let off = (weak.values[k] - without.values[k]) / sd;
            assert!(
                off.abs() < 1e-3 && (sd_weak / sd - 1.0).abs() < 1e-3,
                "{seed}, {name}: {off}, {sd_weak} {sd}"
            );
        }
    }
}
