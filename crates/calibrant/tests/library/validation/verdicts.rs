//! Tests that a verdict agrees with the numbers beside it, and that folds judge what the fit used.

use crate::common::draw_imu;
use crate::validation::bench::{KINDS, bench, intervals, simulate};
use calibrant::estimate::{CovarianceVerdict, ErrorKind, ValidatedErrors};
use calibrant::report::validation_sentences;
use calibrant::sensor::{Recording, SensorKind};
use calibrant::simulate::{ImuSimulation, Purpose, simulate_imu, stream};
use rayon::prelude::*;

/// Few holds, and another recording with four times the scatter. "8.7 mm/s² rms, predicted 3.9: consistent" and "3.1 of 3.6: 1.7 times too small" were said
/// of such recordings, since χ² weighs errors otherwise than a root mean square.
#[test]
fn a_verdict_agrees_with_its_numbers() {
    let found: Vec<ValidatedErrors> = (0..40)
        .into_par_iter()
        .flat_map_iter(|number| {
            let poses = 16 + 2 * (number % 4) as usize;
            let simulation = ImuSimulation { poses, ..ImuSimulation::default() };
            let bench = bench(&simulation);
            let mut rng = stream(41, Purpose::Sensor, number);
            let truth = draw_imu(&mut rng);
            let recording = simulate(&truth, &simulation, 1.0, &mut rng);
            let other = simulate(&truth, &simulation, 4.0, &mut rng);
            let calibration = bench.calibrate(&recording);
            let (on_another, folds) =
                (bench.validate(&calibration, &other), bench.fold(&calibration, &recording, 5));
            on_another.kinds.into_iter().chain(folds.kinds)
        })
        .collect();
    let mut verdicts = [0; 4];
    for errors in &found {
        let (ratio, (low, high)) = (errors.rms / errors.predicted_rms, errors.factor_interval);
        assert!((ratio / errors.factor - 1.0).abs() < 1e-12 && low < ratio && ratio < high, "{errors:?}");
        let by_parameters = errors.parameters.is_some_and(|part| part.factor_interval.0 > 1.0);
        let (agrees, verdict) = match errors.verdict {
            CovarianceVerdict::Believed | CovarianceVerdict::Doubtful => ((0.5..2.0).contains(&ratio), 0),
            CovarianceVerdict::TooSmall => (low > 1.0 && ratio > 1.25 || by_parameters, 1),
            CovarianceVerdict::LargerThanNeeded => (high < 1.0 && ratio < 0.8, 2),
            CovarianceVerdict::TooFew => (low < 1.0 && high > 1.0, 3),
        };
        assert!(agrees, "{} at {ratio} ({low} to {high})", errors.verdict.name());
        verdicts[verdict] += 1;
    }
    println!("consistent, too small, too large, too few: {verdicts:?}");
    assert!(verdicts[0] > 40 && verdicts[1] > 20 && verdicts[3] > 4, "{verdicts:?}");
}

/// A recording, and the same turns once more: 24 holds of 12 orientations at most.
#[test]
fn poses_that_repeat_are_counted_and_share_their_scatter() {
    let short = ImuSimulation { poses: 12, ..ImuSimulation::default() };
    let bench_of_24 = bench(&ImuSimulation::default());
    let mut rng = stream(42, Purpose::Sensor, 0);
    let truth = draw_imu(&mut rng);
    let calibration = bench_of_24.calibrate(&simulate(&truth, &ImuSimulation::default(), 1.0, &mut rng));
    let once = simulate_imu(&truth, &short, &mut rng);
    let mut twice = once.clone();
    let period_s = 12.0 * (short.hold_s + short.turn_s);
    for recording in twice.sensors.values_mut().flatten() {
        let again = recording.times_s().iter().map(|t| t + period_s);
        let times_s = recording.times_s().iter().copied().chain(again).collect();
        let readings = recording.readings().repeat(2);
        *recording = Recording::new(times_s, readings, 3, recording.unit()).expect("samples in order");
    }
    let (of_once, of_twice) =
        (bench(&short).validate(&calibration, &once), bench_of_24.validate(&calibration, &twice));
    for kind in [ErrorKind::Magnitude, ErrorKind::Rate] {
        let [once, twice] = [&of_once, &of_twice].map(|validation| validation.of_kind(kind).expect("holds"));
        assert_eq!((twice.counted(), twice.distinct), (24, once.distinct), "{kind:?}");
        let width = |errors: &ValidatedErrors| errors.factor_interval.1 / errors.factor_interval.0;
        // independent errors would make the logarithm of the interval narrower by √2
        assert!(width(twice).ln() > 0.85 * width(once).ln(), "{kind:?}: {} {}", width(twice), width(once));
    }
    let said = validation_sentences(&of_twice).join("\n");
    let distinct = of_once.of_kind(ErrorKind::Magnitude).expect("holds").distinct;
    let expected = format!("In 24 unused holds, {distinct} of them distinct, the gravity residual is");
    assert!(distinct <= 12 && said.contains(&expected), "{said}");
}

/// In six holds the table turns about the vertical, which the accelerometer does not see. The fit did not use the gyroscope there, nor do the folds: they
/// counted these holds, and called the standard deviations too small.
#[test]
fn folds_judge_what_the_fit_used() {
    let simulation = ImuSimulation { poses: 30, ..ImuSimulation::default() };
    let bench = bench(&simulation);
    let mut rng = stream(43, Purpose::Sensor, 0);
    let truth = draw_imu(&mut rng);
    let mut recording = simulate(&truth, &simulation, 1.0, &mut rng);
    let turning = [3, 8, 12, 17, 21, 26];
    let vertical: Vec<_> = bench
        .calibrate(&recording)
        .hold_results()
        .iter()
        .map(|result| result.force_mps2.normalize())
        .collect();
    let gain = truth[SensorKind::Gyroscope].matrix;
    let gyroscope = recording[SensorKind::Gyroscope].as_mut().expect("there");
    for (hold, (start_s, end_s)) in intervals(&simulation).into_iter().enumerate() {
        if turning.contains(&hold) {
            let pairs = gyroscope.samples_mut();
            pairs
                .filter(|(t, _)| (start_s..end_s).contains(*t))
                .for_each(|(_, y)| *y += gain * vertical[hold] * 0.1);
        }
    }
    let calibration = bench.calibrate(&recording);
    let of_gyroscope = calibration.gyroscope.as_ref().expect("an IMU");
    assert_eq!(of_gyroscope.still.turning_holds, turning);
    let validation = bench.fold(&calibration, &recording, 5);
    let rates = validation.of_kind(ErrorKind::Rate).expect("holds");
    assert_eq!(rates.errors.len(), 24);
    assert!(rates.errors.iter().all(|error| !turning.contains(&error.hold)));
    let left_out = of_gyroscope.rotations.iter().filter(|rotation| !rotation.used);
    for rotation in left_out {
        let rotations = &validation.of_kind(ErrorKind::Rotation).expect("rotations").errors;
        assert!(rotations.iter().all(|error| error.hold != rotation.to_hold), "{rotation:?}");
    }
    for kind in KINDS {
        let errors = validation.of_kind(kind).expect("there");
        assert_ne!(errors.verdict, CovarianceVerdict::TooSmall, "{kind:?}: {}", errors.factor);
    }
}
