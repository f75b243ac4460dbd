//! Tests of the estimator against closed forms.

use crate::common::case::Case;
use crate::common::messages;
use calibrant::estimate::{
    CalibrationProblem, CalibrationSettings, CalibrationStatus, Recovered, Stimulus, calibrate,
};
use calibrant::motion::{
    CommandedMotion, InputNoise, JerkControlledMotion, KnownEnds, Limits, MotionClock, Trust,
};
use calibrant::sensor::{Recording, Sensor, SensorKind, SensorModel, SensorParameters};
use calibrant::simulate::{
    Purpose, draw_sensor, initial_motion, perturb, sample_times, simulate_recording, stream,
};
use nalgebra::{DMatrix, DVector, Vector3};

/// Relative difference of two vectors, in standard deviations of `sd`.
fn in_sd(one: &[f64], other: &[f64], sd: &[f64]) -> f64 {
    one.iter().zip(other).zip(sd).map(|((a, b), sd)| ((a - b) / sd).abs()).fold(0.0, f64::max)
}

/// Design matrix of the hat functions: sample k on nodes 0..=N.
fn hats(motion: &JerkControlledMotion, recording: &Recording) -> DMatrix<f64> {
    let mut hats = DMatrix::zeros(recording.len(), motion.intervals() + 1);
    for (k, &t) in recording.times_s().iter().enumerate() {
        let (i, lambda) = motion.locate(t);
        hats[(k, i)] = 1.0 - lambda;
        hats[(k, i + 1)] = lambda;
    }
    hats
}

#[test]
fn known_motion_equals_ordinary_least_squares() {
    for model in [SensorModel::ScaleBias, SensorModel::Full] {
        let case = Case::new(model, Trust::Known, 14, 5.0, 2.0, 3);
        let calibration = case.calibrate().expect("identifiable");
        for axis in 0..3 {
            let columns: &[usize] = if model == SensorModel::Full { &[0, 1, 2] } else { &[axis] };
            let m = case.recording.len();
            let mut x = DMatrix::from_element(m, 1 + columns.len(), 1.0);
            for (k, &t) in case.recording.times_s().iter().enumerate() {
                let a = case.command.motion.acceleration_at(t);
                for (c, &column) in columns.iter().enumerate() {
                    x[(k, 1 + c)] = a[column];
                }
            }
            let y = DVector::from_iterator(m, case.recording.readings().iter().map(|y| y[axis]));
            let normal = x.tr_mul(&x).try_inverse().expect("regular");
            let ols = x.clone().svd(true, true).solve(&y, 0.0).expect("solved");
            let sigma = 2e-4;
            assert!((ols[0] - calibration.imu[SensorKind::Accelerometer].bias[axis]).abs() < 1e-12);
            for (c, &column) in columns.iter().enumerate() {
                let difference =
                    ols[1 + c] - calibration.imu[SensorKind::Accelerometer].matrix[(axis, column)];
                assert!(difference.abs() < 1e-12, "{model:?} {axis}{column}: {difference}");
            }
            let sd = calibration.sd()[axis];
            assert!((sd / (normal[(0, 0)].sqrt() * sigma) - 1.0).abs() < 1e-12, "sd of the bias");
        }
        assert_eq!(calibration.status, CalibrationStatus::Converged);
        assert!(calibration.iterations <= 3, "{} iterations on a linear problem", calibration.iterations);
    }
}

#[test]
fn unknown_motion_equals_the_closed_form() {
    // nodes of K a + b by linear regression, then K and b from the two known ends
    for rate in [2.0, 10.0] {
        let case = Case::new(SensorModel::ScaleBias, Trust::Unknown, 14, 5.0, rate, 11);
        let calibration = case.calibrate().expect("identifiable");
        let x = hats(&case.command.motion, &case.recording);
        let normal = x.tr_mul(&x).try_inverse().expect("regular");
        let a = case.command.motion.acceleration_mps2();
        let last = a.len() - 1;
        let Recovered::Motion(recovered) = &calibration.recovered else { panic!("a motion") };
        for axis in 0..3 {
            let y = DVector::from_iterator(x.nrows(), case.recording.readings().iter().map(|y| y[axis]));
            let z = x.clone().svd(true, true).solve(&y, 0.0).expect("solved");
            let k = (z[last] - z[0]) / (a[last][axis] - a[0][axis]);
            let b = z[0] - k * a[0][axis];
            assert!((calibration.values[3 + axis] / k - 1.0).abs() < 1e-9, "K {axis}");
            assert!((calibration.values[axis] / b - 1.0).abs() < 1e-9, "b {axis}");
            for (i, a) in recovered.motion.acceleration_mps2().iter().enumerate() {
                assert!((a[axis] - (z[i] - b) / k).abs() < 1e-9 * 30.0, "node {i}");
            }
            let span = a[last][axis] - a[0][axis];
            let variance =
                (normal[(0, 0)] + normal[(last, last)] - 2.0 * normal[(0, last)]) * (2e-4 / span).powi(2);
            assert!(
                (calibration.covariance[(3 + axis, 3 + axis)] / variance - 1.0).abs() < 1e-9,
                "variance of K"
            );
        }
    }
}

#[test]
fn noisy_tends_to_known_as_the_noise_vanishes() {
    for model in [SensorModel::ScaleBias, SensorModel::Full] {
        let case = Case::new(model, Trust::Known, 14, 5.0, 2.0, 5);
        let known = case.calibrate().expect("identifiable");
        for (floor, tolerance) in [(1e-8, 1e-3), (1e-12, 1e-7), (0.0, 1e-9)] {
            let noisy =
                case.with_trust(Trust::Noisy(InputNoise { floor_mps3: floor, ratio: 0.0 }), KnownEnds::Start);
            let noisy = noisy.calibrate().expect("identifiable");
            assert_eq!(noisy.status, CalibrationStatus::Converged);
            assert!(in_sd(&noisy.values, &known.values, &known.sd()) < tolerance, "{model:?} {floor}");
            let difference = (&noisy.covariance - &known.covariance).amax() / known.covariance.amax();
            assert!(difference < tolerance, "{model:?} {floor}: {difference}");
        }
    }
}

#[test]
fn noisy_with_both_ends_tends_to_unknown_as_the_noise_grows() {
    let case = Case::new(SensorModel::ScaleBias, Trust::Unknown, 14, 5.0, 2.0, 5);
    let unknown = case.calibrate().expect("identifiable");
    for (floor, tolerance) in [(1e2, 1e-2), (1e5, 1e-6), (1e12, 1e-6)] {
        let noisy =
            case.with_trust(Trust::Noisy(InputNoise { floor_mps3: floor, ratio: 0.0 }), KnownEnds::Both);
        let noisy = noisy.calibrate().expect("identifiable");
        assert_eq!(noisy.status, CalibrationStatus::Converged);
        let difference = in_sd(&noisy.values, &unknown.values, &unknown.sd());
        assert!(difference < tolerance, "{floor}: {difference}");
        let difference = (&noisy.covariance - &unknown.covariance).amax() / unknown.covariance.amax();
        assert!(difference < tolerance, "{floor}: {difference}");
    }
}

#[test]
fn an_increment_without_noise_is_a_constraint() {
    // floor 0 and a jerk that vanishes on some intervals: these increments are known exactly
    let nodes = [0.0, 4.0, 4.0, -3.0, -3.0, -3.0, 6.0].map(|a| Vector3::new(a, -a, 0.5 * a)).to_vec();
    let motion = JerkControlledMotion::uniform(1.0, nodes).expect("valid");
    let noise = InputNoise { floor_mps3: 0.0, ratio: 0.01 };
    for model in [SensorModel::ScaleBias, SensorModel::Full] {
        for ends in [KnownEnds::Start, KnownEnds::Both] {
            let truth = SensorParameters::identity();
            let mut rng = stream(4, Purpose::Sensor, 0);
            let happened = perturb(&motion, &noise, 3, ends, &mut rng).expect("valid");
            let sensor = Sensor { model, ..Sensor::memsic_mxd2020u() };
            let times = sample_times(&motion, 20.0);
            let recording = simulate_recording(
                &truth,
                &Vector3::repeat(2e-4),
                sensor.unit,
                3,
                &happened,
                &times,
                &mut rng,
            );
            let command = CommandedMotion {
                motion: motion.clone(),
                trust: Trust::Noisy(noise),
                known_ends: ends,
                gravity: None,
                clock: MotionClock::default(),
            };
            let problem = CalibrationProblem {
                sensor: &sensor,
                recording: &recording,
                stimulus: Stimulus::Motion(&command),
            };
            let result = calibrate(&problem, &CalibrationSettings::default());
            if model == SensorModel::Full {
                // x, y and z are proportional here
                let error = result.expect_err("not identifiable");
                assert!(error.to_string().contains("depend on each other"), "{error}");
                continue;
            }
            let calibration = result.expect("identifiable");
            let Recovered::Motion(recovered) = &calibration.recovered else { panic!("a motion") };
            let a = recovered.motion.acceleration_mps2();
            assert!((a[2] - a[1]).amax() < 1e-15 && (a[5] - a[3]).amax() < 1e-15, "rigid increments");
            assert!(calibration.covariance.iter().all(|c| c.is_finite()));
            assert_eq!(calibration.status, CalibrationStatus::Converged);
        }
    }
}

#[test]
fn a_still_axis_is_named() {
    let mut nodes: Vec<_> =
        (0..11).map(|i| Vector3::new((i as f64).sin() * 9.0, 2.0, (i as f64).cos() * 9.0)).collect();
    nodes[10].x = 3.0;
    let motion = JerkControlledMotion::uniform(1.0, nodes).expect("valid");
    for (model, trust, expected) in [
        (
            SensorModel::ScaleBias,
            Trust::Known,
            "accelerometer.bias.y and accelerometer.scale.y cannot be separated: axis y does not move",
        ),
        (
            SensorModel::ScaleBias,
            Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 }),
            "accelerometer.bias.y and accelerometer.scale.y cannot be separated: axis y does not move",
        ),
        (SensorModel::ScaleBias, Trust::Unknown, "axis y has the same acceleration, 2 m/s², at both ends"),
        (
            SensorModel::Full,
            Trust::Known,
            "accelerometer.bias.z and accelerometer.matrix.zy cannot be separated: axis y does not move",
        ),
        (SensorModel::Full, Trust::Unknown, "only the two known ends speak of the sensor"),
    ] {
        let case = Case::with_motion(model, trust, motion.clone(), 10.0, 1);
        let error = case.calibrate().expect_err("axis y stands still");
        assert!(error.is_not_identifiable());
        assert!(error.to_string().contains(expected), "{model:?} {trust:?}: {error}");
    }
}

/// The last value of a computed sine is rounding, and no acceleration that differs from that of the start.
#[test]
fn a_sine_of_which_only_the_ends_are_known_is_not_calibrated() {
    for intervals in [20, 200, 2000] {
        let node = |i: usize| {
            let phase = std::f64::consts::TAU * i as f64 / intervals as f64;
            Vector3::new(9.0 * phase.sin(), 5.0 * (3.0 * phase).sin(), (7.0 * phase).sin())
        };
        let motion = JerkControlledMotion::uniform(1.0, (0..=intervals).map(node).collect()).expect("valid");
        let case = Case::with_motion(SensorModel::ScaleBias, Trust::Unknown, motion, 10.0, 1);
        let error = case.calibrate().expect_err("nothing tells the scale").to_string();
        for axis in ["x", "y", "z"] {
            let expected = format!("axis {axis} has the same acceleration, 0 m/s², at both ends");
            assert!(error.contains(&expected), "{intervals}: {error}");
        }
    }
}

#[test]
fn a_prior_determines_what_the_data_do_not() {
    let nodes: Vec<_> =
        (0..11).map(|i| Vector3::new((i as f64).sin() * 9.0, 2.0, (i as f64).cos() * 9.0)).collect();
    let case = Case::with_motion(
        SensorModel::ScaleBias,
        Trust::Known,
        JerkControlledMotion::uniform(1.0, nodes).expect("valid"),
        10.0,
        1,
    );
    let settings = CalibrationSettings { datasheet_prior: true, ..CalibrationSettings::default() };
    let calibration = calibrate(&case.problem(), &settings).expect("the prior helps");
    // the data fix b + 2 K, so along b = −2 K only the prior has information: 1/var(K) = 1/0.005² + 2²/0.1²
    let along = (1.0 / (0.005_f64.powi(-2) + 4.0 * 0.1_f64.powi(-2))).sqrt();
    assert!((calibration.sd()[4] / along - 1.0).abs() < 1e-3, "{} {along}", calibration.sd()[4]);
}

#[test]
fn counts_and_si_give_the_same_sensor() {
    let case = Case::new(
        SensorModel::ScaleBias,
        Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 }),
        10,
        1.0,
        10.0,
        2,
    );
    let si = case.calibrate().expect("identifiable");
    let (gain, offset) = (415.0, 33_000.0);
    for known_gain in [true, false] {
        let mut counts = case.clone();
        counts.sensor.unit = calibrant::sensor::ReadingUnit::Counts;
        counts.sensor.gain = known_gain.then(|| Vector3::repeat(gain));
        counts.sensor.offset = known_gain.then(|| Vector3::repeat(offset));
        counts.sensor.noise_counts = Some(Vector3::repeat(2e-4 * gain));
        counts.recording = case.recording.mapped(counts.sensor.unit, |y| y.map(|y| gain * y + offset));
        let raw = counts.calibrate().expect("identifiable");
        for axis in 0..3 {
            assert!(((raw.values[axis] - offset) / gain - si.values[axis]).abs() < 1e-6 * si.sd()[axis]);
            assert!((raw.values[3 + axis] / gain - si.values[3 + axis]).abs() < 1e-6 * si.sd()[3 + axis]);
            assert!((raw.sd()[3 + axis] / gain / si.sd()[3 + axis] - 1.0).abs() < 1e-6);
        }
    }
}

#[test]
fn gaps_are_named_where_nothing_is_known_of_the_motion() {
    let mut case = Case::new(SensorModel::ScaleBias, Trust::Unknown, 14, 5.0, 2.0, 11);
    case.recording = case.recording.only(|k| !(18.0..33.0).contains(&case.recording.times_s()[k]));
    let error = case.calibrate().expect_err("the motion from 20 to 30 s is free");
    assert!(error.is_not_identifiable());
    assert!(error.to_string().contains("the motion itself is not determined"), "{error}");
}

#[test]
fn limits_and_population_are_reproducible() {
    let draw = |index| draw_sensor(&Sensor::memsic_mxd2020u(), &mut stream(3, Purpose::Sensor, index));
    assert_eq!(draw(5), draw(5));
    assert_ne!(draw(5), draw(6));
    let motion = |seed| {
        initial_motion(10, 1.0, 3, &Limits::default(), &mut stream(seed, Purpose::Motion, 0)).expect("valid")
    };
    assert_eq!(motion(1), motion(1));
    assert_ne!(motion(1), motion(2));
}

#[test]
fn a_reversed_axis_is_estimated_and_pointed_out() {
    for trust in [Trust::Known, Trust::Unknown, Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 })] {
        let mut case = Case::new(SensorModel::ScaleBias, trust, 14, 5.0, 2.0, 11);
        case.recording.readings_mut().iter_mut().for_each(|y| y.y = -y.y);
        let calibration = case.calibrate().expect("identifiable");
        assert_eq!(calibration.status, CalibrationStatus::Converged, "{trust:?}");
        assert!(
            (calibration.values[4] + case.truth.matrix[(1, 1)]).abs() < 5.0 * calibration.sd()[4],
            "{trust:?}"
        );
        assert!(messages(&calibration.warnings).iter().any(|warning| warning.contains("axis y is negative")));
    }
}

#[test]
fn a_dead_sensor_is_not_calibrated() {
    for trust in [Trust::Known, Trust::Unknown, Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 })] {
        let mut case = Case::new(SensorModel::ScaleBias, trust, 14, 5.0, 2.0, 11);
        case.recording.readings_mut().iter_mut().for_each(|y| y.x = 0.0);
        let error = case.calibrate().expect_err("axis x is dead");
        assert!(error.is_not_identifiable(), "{trust:?}: {error}");
    }
}

#[test]
fn large_process_noise_converges() {
    for ratio in [0.1, 0.3] {
        for seed in 0..20 {
            let noise = InputNoise { floor_mps3: 0.01, ratio };
            let case = Case::new(SensorModel::ScaleBias, Trust::Noisy(noise), 10, 1.0, 10.0, seed);
            let calibration = case.calibrate().expect("identifiable");
            assert_eq!(calibration.status, CalibrationStatus::Converged, "ratio {ratio}, seed {seed}");
            for k in 0..3 {
                let off = (calibration.values[3 + k] - case.truth.matrix[(k, k)]) / calibration.sd()[3 + k];
                assert!(off.abs() < 6.0, "ratio {ratio}, seed {seed}: {off} sd");
            }
        }
    }
}

#[test]
fn a_long_recording_on_few_intervals_converges_to_rounding() {
    // the chain removes almost all information, so rounding is magnified: 7 iterations, not 50
    let noise = Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 });
    let case = Case::new(SensorModel::Full, noise, 14, 1.0, 7143.0, 1);
    let calibration = case.calibrate().expect("identifiable");
    assert_eq!(calibration.status, CalibrationStatus::Converged);
    assert!(calibration.iterations <= 12, "{} iterations", calibration.iterations);
}
