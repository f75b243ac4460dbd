//! Monte Carlo tests: a calibration delivers what it promises. Seeded, so that a failure is a change.
//!
//! Tolerances are those of the sample size. With n sensors a variance is known to √(2/n) relative, and a
//! coverage of 95 % to √(0.95·0.05/n). √n times the Kolmogorov–Smirnov distance of uniform p-values exceeds
//! 1.95 once in a thousand.

use crate::common::messages;
use crate::common::steady_holds;
use calibrant::design::{DesignProblem, DesignSettings, design};
use calibrant::estimate::{
    CalibrationProblem, CalibrationSettings, HoldsSetup, Recovered, Stimulus, calibrate,
};
use calibrant::information::criterion::{AOptimality, Criterion};
use calibrant::motion::{
    CommandedMotion, Gravity, InputNoise, JerkControlledMotion, KnownEnds, Limits, MotionClock, Trust,
};
use calibrant::sensor::{Gauge, Quantity, Sensor, SensorModel, SensorParameters};
use calibrant::simulate::{
    HoldsSimulation, Purpose, draw_sensor, initial_motion, perturb, simulate_holds, simulate_recording,
    stream,
};
use calibrant::study::{Study, StudyProblem, StudySettings, run_study};
use nalgebra::{DMatrix, DVector, Vector3};
use rayon::prelude::*;

/// Number of simulated sensors.
const SENSORS: usize = 3000;

/// √n times the largest distance between the empirical distribution and the uniform one.
fn kolmogorov(mut p: Vec<f64>) -> f64 {
    p.sort_by(f64::total_cmp);
    let n = p.len() as f64;
    let distance = p.iter().enumerate().fold(0.0_f64, |distance, (i, p)| {
        distance.max((p - i as f64 / n).abs()).max((p - (i as f64 + 1.0) / n).abs())
    });
    distance * n.sqrt()
}

/// 95 % coverage to five standard errors.
fn assert_coverage(name: &str, coverage: f64, n: usize) {
    let error = (0.95 * 0.05 / n as f64).sqrt();
    assert!((coverage - 0.95).abs() < 5.0 * error, "{name}: {coverage} covered");
}

fn study(
    model: SensorModel,
    trust: Trust,
    intervals: usize,
    interval_s: f64,
    rate_hz: f64,
    limit: f64,
) -> Study {
    let limits = Limits {
        acceleration_mps2: Some(Vector3::repeat(limit)),
        jerk_mps3: Some(Vector3::repeat(limit)),
        ..Limits::default()
    };
    let mut rng = stream(1, Purpose::Motion, 0);
    let motion = initial_motion(intervals, interval_s, 3, &limits, &mut rng).expect("valid");
    study_of(model, trust, motion, rate_hz, MotionClock::default())
}

fn study_of(
    model: SensorModel,
    trust: Trust,
    motion: JerkControlledMotion,
    rate_hz: f64,
    clock: MotionClock,
) -> Study {
    let sensor = Sensor { model, cross_axis_sd: Some(0.005), ..Sensor::memsic_mxd2020u() };
    let known_ends = if trust == Trust::Unknown { KnownEnds::Both } else { KnownEnds::Start };
    let command = CommandedMotion { motion, trust, known_ends, gravity: None, clock };
    let problem = StudyProblem { sensor: &sensor, command: &command, rate_hz, sensors: SENSORS };
    run_study(&problem, &StudySettings { seed: 20, ..StudySettings::default() }, &|_| ())
        .expect("identifiable")
}

/// The whole covariance, not only its diagonal: the empirical covariance of the errors, whitened by the predicted one, is the unit matrix.
fn assert_covariance(study: &Study) {
    let predicted = &study.single.calibration.covariance;
    let size = predicted.nrows();
    let whiten = predicted.clone().cholesky().expect("positive").l().try_inverse().expect("regular");
    let mut empirical = DMatrix::zeros(size, size);
    for outcome in &study.outcomes {
        let error = DVector::from_fn(size, |k, _| outcome.values[k] - outcome.truth[k]);
        let white = &whiten * error;
        empirical += &white * white.transpose() / study.outcomes.len() as f64;
    }
    // sensors differ a little in their true covariance (scale factors spread by 0.5 %): 0.02 on top of five standard errors
    let tolerance = 5.0 * (2.0 / study.outcomes.len() as f64).sqrt() + 0.02;
    let off = (empirical - DMatrix::identity(size, size)).amax();
    assert!(off < tolerance, "whitened covariance is off by {off}");
}

fn assert_honest(study: &Study) {
    assert!(study.outcomes.iter().all(|outcome| outcome.status == "converged"));
    for row in &study.summary {
        let ratio = row.realised_rms / row.predicted_sd;
        assert!((ratio - 1.0).abs() < 5.0 / (2.0 * SENSORS as f64).sqrt(), "{}: {ratio}", row.name);
        assert_coverage(&row.name, row.coverage_95, SENSORS);
    }
    assert_covariance(study);
    let p: Vec<f64> = study.outcomes.iter().filter_map(|outcome| outcome.p_value).collect();
    assert_eq!(p.len(), SENSORS);
    let distance = kolmogorov(p);
    assert!(distance < 1.95, "χ² p-values are not uniform: {distance}");
}

#[test]
fn known_motion_delivers_the_promised_covariance() {
    assert_honest(&study(SensorModel::ScaleBias, Trust::Known, 10, 1.0, 10.0, 30.0));
    assert_honest(&study(SensorModel::Full, Trust::Known, 10, 1.0, 10.0, 30.0));
}

#[test]
fn a_clock_that_is_not_exact_delivers_the_promised_covariance() {
    let clock = MotionClock { delay_s: 0.02, delay_sd_s: 0.5, rate_sd: 1e-4 };
    let limits = Limits { acceleration_mps2: Some(Vector3::repeat(10.0)), ..Limits::default() };
    let mut rng = stream(1, Purpose::Motion, 0);
    let motion = initial_motion(20, 0.5, 3, &limits, &mut rng).expect("valid");
    let noise = InputNoise { floor_mps3: 0.01, ratio: 0.01 };
    for (model, trust) in [
        (SensorModel::ScaleBias, Trust::Known),
        (SensorModel::Full, Trust::Known),
        (SensorModel::Full, Trust::Noisy(noise)),
    ] {
        assert_honest(&study_of(model, trust, motion.clone(), 20.0, clock));
    }
}

#[test]
fn unknown_motion_delivers_the_promised_covariance() {
    assert_honest(&study(SensorModel::ScaleBias, Trust::Unknown, 14, 5.0, 2.0, 30.0));
}

#[test]
fn noisy_motion_delivers_the_promised_covariance() {
    let noise = Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 });
    assert_honest(&study(SensorModel::ScaleBias, noise, 10, 1.0, 10.0, 20.0));
    assert_honest(&study(SensorModel::Full, noise, 10, 1.0, 10.0, 20.0));
}

/// The best motion of the thesis's chapter 4 within ±bound on x and u.
fn optimal_motion(trust: Trust, bound: f64) -> JerkControlledMotion {
    let sensor = Sensor::memsic_mxd2020u();
    let limits = Limits {
        intercept_mps2: Some(Vector3::repeat(bound)),
        jerk_mps3: Some(Vector3::repeat(bound)),
        ..Limits::default()
    };
    let problem = DesignProblem {
        sensor: &sensor,
        at: SensorParameters::identity(),
        intervals: 10,
        interval_s: 1.0,
        rate_hz: 10.0,
        trust,
        known_ends: KnownEnds::Start,
        gravity: None,
        clock: MotionClock::default(),
        limits: &limits,
        criterion: Criterion::A(AOptimality { scale: DVector::repeat(6, 1.0) }),
        prior: None,
    };
    let settings = DesignSettings { starts: 5, certificate: false, ..DesignSettings::default() };
    design(&problem, &settings, &|_| ()).expect("bounded").optimal.motion
}

#[test]
fn optimal_known_motion_delivers_the_promised_covariance() {
    let motion = optimal_motion(Trust::Known, 30.0);
    assert_honest(&study_of(SensorModel::ScaleBias, Trust::Known, motion, 10.0, MotionClock::default()));
}

#[test]
fn optimal_noisy_motion_delivers_the_promised_covariance() {
    let noise = Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 });
    let study =
        study_of(SensorModel::ScaleBias, noise, optimal_motion(noise, 20.0), 10.0, MotionClock::default());
    assert_honest(&study);
    // the joint estimate is biased by order N var(K)/K²: a few hundredths of a standard deviation
    for row in study.summary.iter().filter(|row| row.name.starts_with("scale.")) {
        let bias = study.motion.intervals() as f64 * row.predicted_sd.powi(2);
        let error = row.predicted_sd / (SENSORS as f64).sqrt();
        println!("{}: mean error {:.2e} ± {error:.1e}, order {bias:.1e}", row.name, row.mean_error);
        assert!(row.mean_error.abs() < 2.0 * bias + 5.0 * error, "{}: {}", row.name, row.mean_error);
    }
}

/// Share of white recordings that the whiteness test calls coloured at 5 %.
#[test]
fn the_whiteness_test_rarely_cries_wolf() {
    for (trust, intervals, interval_s, rate) in
        [(Trust::Known, 10, 1.0, 10.0), (Trust::Unknown, 14, 5.0, 2.0), (Trust::Unknown, 14, 5.0, 10.0)]
    {
        let alarms: usize = (0..500_u64)
            .into_par_iter()
            .map(|seed| {
                let case = crate::common::case::Case::new(
                    SensorModel::ScaleBias,
                    trust,
                    intervals,
                    interval_s,
                    rate,
                    seed,
                );
                let fit = case.calibrate().expect("identifiable").fit;
                fit.whiteness.iter().filter(|test| test.p_value < 0.05).count()
            })
            .sum();
        let share = alarms as f64 / 1500.0;
        println!("{trust:?} {rate} Hz: {share}");
        assert!(
            (0.02..0.09).contains(&share),
            "{trust:?} {rate} Hz: {share} of white recordings called coloured"
        );
    }
}

#[test]
fn static_holds_deliver_the_promised_covariance() {
    // with and without a disturbance of the holds beyond the noise within them
    for (between, g_sd, gauge) in
        [(0.0, 0.0, Gauge::Upper), (2e-3, 0.0, Gauge::Symmetric), (2e-3, 5e-3, Gauge::Lower)]
    {
        let recordings = 1000;
        let sensor = Sensor {
            noise_mps2: Some(Vector3::repeat(0.01)),
            cross_axis_sd: Some(0.005),
            ..Sensor { model: SensorModel::Full, ..Sensor::memsic_mxd2020u() }
        };
        let list = gauge.parameter_list(SensorModel::Full);
        let outcomes: Vec<(Vec<f64>, Vec<f64>, usize)> = (0..recordings as u64)
            .into_par_iter()
            .map(|index| {
                let mut rng = stream(5, Purpose::Sensor, index);
                let truth = gauge.apply(&draw_sensor(&sensor, &mut rng));
                let g_error = draw_sensor(
                    &Sensor { bias_sd_mps2: Some(Vector3::repeat(g_sd)), ..sensor.clone() },
                    &mut rng,
                );
                let simulation = HoldsSimulation {
                    poses: 24,
                    hold_s: 3.0,
                    turn_s: 1.0,
                    rate_hz: 50.0,
                    gravity_mps2: 9.81 + g_error.bias.x,
                    between_holds_sd_mps2: between,
                };
                let (recording, _) =
                    simulate_holds(&truth, &Vector3::repeat(0.01), sensor.unit, &simulation, &mut rng);
                let setup = HoldsSetup {
                    gravity: Gravity { magnitude_mps2: 9.81, sd_mps2: g_sd },
                    gauge,
                    ..steady_holds()
                };
                let problem = CalibrationProblem {
                    sensor: &sensor,
                    recording: &recording,
                    stimulus: Stimulus::Holds(&setup),
                };
                let calibration = calibrate(&problem, &CalibrationSettings::default()).expect("identifiable");
                let Recovered::Holds(holds) = &calibration.recovered else { panic!("holds") };
                let found = holds.holds.len();
                let errors = list
                    .quantities()
                    .iter()
                    .zip(&calibration.values)
                    .map(|(q, v)| v - Quantity::value(*q, &truth));
                (errors.collect(), calibration.sd(), found)
            })
            .collect();
        assert!(outcomes.iter().all(|(_, _, found)| *found == 24), "every hold is found, nothing else");
        for (k, name) in list.names().iter().enumerate() {
            let n = recordings as f64;
            let rms = (outcomes.iter().map(|(error, _, _)| error[k].powi(2)).sum::<f64>() / n).sqrt();
            let sd = (outcomes.iter().map(|(_, sd, _)| sd[k].powi(2)).sum::<f64>() / n).sqrt();
            println!("between {between} g {g_sd} {name}: {rms:.3e} {sd:.3e} {:.3}", rms / sd);
            // 15 degrees of freedom leave the scatter between holds uncertain by 18 % in each recording
            assert!((rms / sd - 1.0).abs() < 0.12, "{name}: rms {rms} against {sd}");
            let covered = outcomes.iter().filter(|(error, sd, _)| error[k].abs() < 1.96 * sd[k]).count();
            let coverage = covered as f64 / n;
            assert!((0.91..0.98).contains(&coverage), "{name}: {coverage} covered");
        }
    }
}

/// The joint estimate of motion and parameters has a bias that grows with the number of noisy intervals. The
/// warning states its size.
#[test]
fn the_bias_of_a_long_noisy_motion_is_foretold() {
    let noise = Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 });
    let foretold = |intervals| {
        let case = crate::common::case::Case::new(SensorModel::ScaleBias, noise, intervals, 1.0, 10.0, 3);
        let warnings = case.calibrate().expect("identifiable").warnings;
        messages(&warnings).iter().find(|warning| warning.contains("is biased by about")).map(|warning| {
            let words: Vec<&str> = warning.split_whitespace().collect();
            let at = words.iter().position(|word| *word == "about").expect("a number follows");
            words[at + 1].parse::<f64>().expect("a number")
        })
    };
    assert_eq!(foretold(10), None, "the thesis's example is hardly biased");
    let long = foretold(2000).expect("a long noisy motion is biased");
    let errors: Vec<[f64; 3]> = (0..100_u64)
        .into_par_iter()
        .map(|seed| {
            let case = crate::common::case::Case::new(SensorModel::ScaleBias, noise, 2000, 1.0, 10.0, 3);
            let mut rng = stream(77, Purpose::Sensor, seed);
            let happened = perturb(
                &case.command.motion,
                &InputNoise { floor_mps3: 0.01, ratio: 0.01 },
                3,
                KnownEnds::Start,
                &mut rng,
            )
            .expect("valid");
            let recording = simulate_recording(
                &case.truth,
                &Vector3::repeat(2e-4),
                case.sensor.unit,
                3,
                &happened,
                case.recording.times_s(),
                &mut rng,
            );
            let case = crate::common::case::Case { recording, ..case };
            let calibration = case.calibrate().expect("identifiable");
            let sd = calibration.sd();
            std::array::from_fn(|k| (calibration.values[3 + k] - case.truth.matrix[(k, k)]) / sd[3 + k])
        })
        .collect();
    let measured = (0..3)
        .map(|k| errors.iter().map(|error| error[k]).sum::<f64>() / errors.len() as f64)
        .fold(0.0_f64, |largest, mean| largest.max(mean.abs()));
    // a mean over 100 sensors is known to 0.1 standard deviations
    assert!((measured - long).abs() < 0.4, "measured {measured}, foretold {long}");
}
