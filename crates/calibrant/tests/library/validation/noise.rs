//! Tests of validation on another recording with other noise: another range, bandwidth or filter of a sensor.

use crate::common::{draw_imu, normal};
use crate::validation::bench::{KINDS, bench, mean, share, simulate};
use calibrant::estimate::{Calibration, CovarianceVerdict, ErrorKind, Validation};
use calibrant::report::validation_sentences;
use calibrant::sensor::{ImuParameters, ImuRecording, Recording, SensorKind};
use calibrant::simulate::{ImuSimulation, Purpose, simulate_imu, stream};
use nalgebra::Vector3;
use rayon::prelude::*;

/// Factors on the noise of the calibration's recording.
#[derive(Debug, Clone, Copy)]
struct Times {
    accelerometer: f64,
    gyroscope: f64,
}

const fn times(accelerometer: f64, gyroscope: f64) -> Times {
    Times { accelerometer, gyroscope }
}

/// Calibrations, each validated on another recording with this factor on the noise. `tamper` changes the
/// calibration and the truth of the other recording.
fn tried(
    on: Times,
    scatter: f64,
    count: u64,
    tamper: impl Fn(&mut Calibration, &mut ImuParameters) + Sync,
) -> Vec<Validation> {
    let usual = ImuSimulation::default();
    let other = ImuSimulation {
        accelerometer_noise: on.accelerometer * usual.accelerometer_noise,
        gyroscope_noise: on.gyroscope * usual.gyroscope_noise,
        ..usual.clone()
    };
    let bench = bench(&usual);
    (0..count)
        .into_par_iter()
        .map(|number| {
            let mut rng = stream(41, Purpose::Sensor, number);
            let mut truth = draw_imu(&mut rng);
            let mut calibration = bench.calibrate(&simulate(&truth, &usual, scatter, &mut rng));
            tamper(&mut calibration, &mut truth);
            bench.validate(&calibration, &simulate(&truth, &other, scatter, &mut rng))
        })
        .collect()
}

fn moved(found: &[Validation]) -> f64 {
    mean(found.iter().map(|validation| f64::from(u8::from(validation.bias_shift.expect("there").moved))))
}

#[test]
#[ignore = "long: scripts/test-all runs it"]
fn other_noise_is_no_reason_to_distrust_an_honest_calibration() {
    let count = 200;
    // 4 standard deviations of a share of 200
    let room = |level: f64| 4.0 * (level / count as f64).sqrt();
    for (on, scatters) in [
        (times(1.0, 5.0), &[0.0, 1.0][..]),
        (times(5.0, 1.0), &[1.0]),
        (times(5.0, 5.0), &[0.3]),
        (times(1.0, 0.2), &[1.0]),
        (times(0.2, 0.2), &[1.0, 3.0]),
    ] {
        for &scatter in scatters {
            let found = tried(on, scatter, count, |_, _| ());
            for validation in &found {
                let ratio = |sensor_kind: SensorKind| {
                    validation
                        .noise
                        .iter()
                        .find(|noise| noise.sensor_kind == sensor_kind)
                        .expect("there")
                        .overall()
                };
                // 24 holds of 246 samples determine a standard deviation to 1 %, three axes to 0.5 %
                assert!((ratio(SensorKind::Accelerometer) / on.accelerometer - 1.0).abs() < 0.03);
                assert!((ratio(SensorKind::Gyroscope) / on.gyroscope - 1.0).abs() < 0.03);
            }
            assert!(moved(&found) < 0.01 + room(0.01), "{on:?} {scatter}: {}", moved(&found));
            for kind in KINDS {
                let of: Vec<_> = found.iter().filter_map(|validation| validation.of_kind(kind)).collect();
                let believed = share(&of, CovarianceVerdict::Believed);
                let below = |p: f64| mean(of.iter().map(|errors| f64::from(u8::from(errors.p_value < p))));
                let (few, half, most) = (below(0.05), below(0.5), below(0.95));
                println!(
                    "{on:?} {scatter} {kind:?}: believed {believed}, p < 0.05 {few}, 0.5 {half}, 0.95 {most}"
                );
                assert!(believed > 0.99 - room(0.01), "{on:?} {scatter} {kind:?}: {believed}");
                assert!(few < 0.05 + room(0.05), "{on:?} {scatter} {kind:?}: {few}");
            }
        }
    }
}

/// Where the scatter is no larger than the noise of the calibration, a few calibrations find none or too much
/// of it. A quieter recording shows it: their covariance is wrong.
#[test]
#[ignore = "long: scripts/test-all runs it"]
fn a_quieter_recording_shows_scatter_that_the_calibration_did_not_see() {
    for (on, scatter) in [(times(0.2, 1.0), 0.0), (times(0.2, 1.0), 0.3), (times(1.0, 0.2), 0.0)] {
        let found = tried(on, scatter, 200, |_, _| ());
        for kind in KINDS {
            let of: Vec<_> = found.iter().filter_map(|validation| validation.of_kind(kind)).collect();
            let believed = share(&of, CovarianceVerdict::Believed);
            let small = share(&of, CovarianceVerdict::TooSmall);
            println!("{on:?} {scatter} {kind:?}: believed {believed}, too small {small}");
            // with 15 degrees of freedom behind it, 12 % find a scatter that is off by a quarter and more.
            // Less 4 standard deviations of a share of 200
            assert!(
                believed > 0.88 - 4.0 * (0.12 * 0.88 / 200.0_f64).sqrt(),
                "{on:?} {scatter} {kind:?}: {believed}"
            );
        }
    }
}

#[test]
#[ignore = "long: scripts/test-all runs it"]
fn what_is_wrong_is_found_in_other_noise() {
    let count = 60;
    for on in [times(1.0, 5.0), times(5.0, 5.0), times(0.2, 0.2)] {
        for scatter in [0.0, 1.0] {
            let too_small = |found: &[Validation], kind: ErrorKind| {
                let of: Vec<_> = found.iter().filter_map(|found| found.of_kind(kind)).collect();
                share(&of, CovarianceVerdict::TooSmall)
            };
            let gains = tried(on, scatter, count, |calibration, _| {
                calibration.imu[SensorKind::Gyroscope].matrix *= 1.01
            });
            let scales = tried(on, scatter, count, |calibration, _| {
                calibration.imu[SensorKind::Accelerometer].matrix *= 1.01
            });
            let biases = tried(on, scatter, count, |calibration, truth| {
                // 5 standard deviations of the difference of two means of 24 holds, of 246 samples each
                let noise = 2e-3 * 2e-3 / 246.0 * (1.0 + on.gyroscope.powi(2));
                let between =
                    2.0 * calibration.gyroscope.as_ref().expect("an IMU").still.between_holds_sd.x.powi(2);
                truth[SensorKind::Gyroscope].bias.x += 5.0 * ((noise + between) / 24.0).sqrt();
            });
            let gain = too_small(&gains, ErrorKind::Rotation);
            let scale = too_small(&scales, ErrorKind::Magnitude);
            let bias = moved(&biases);
            println!("{on:?} {scatter}: gain {gain}, scale {scale}, bias {bias}");
            assert!(gain > 0.95 && scale > 0.95, "{on:?} {scatter}: {gain} {scale}");
            // χ² of three components, one of them off by 5, is beyond 11.3 in 95 %. Less the uncertainty of
            // the scatter, and 4 standard deviations of a share of 60
            assert!(bias > 0.78, "{on:?} {scatter}: {bias}");
        }
    }
}

/// A low-pass filter's noise does not average out as white noise does. Its contribution to the means counts
/// as scatter between holds, which grows with the noise.
#[test]
fn filtered_noise_is_scatter_that_goes_with_the_noise() {
    let quiet = ImuSimulation { gyroscope_noise: 0.0, ..ImuSimulation::default() };
    let bench = bench(&quiet);
    let found: Vec<Validation> = (0..200)
        .into_par_iter()
        .map(|number| {
            let mut rng = stream(42, Purpose::Sensor, number);
            let truth = draw_imu(&mut rng);
            let mut filtered = |sd: f64| {
                let mut recording = simulate_imu(&truth, &quiet, &mut rng);
                let mut noise = Vector3::zeros();
                for y in recording[SensorKind::Gyroscope].as_mut().expect("there").readings_mut() {
                    noise = 0.8 * noise + 0.6 * Vector3::from_fn(|_, _| sd * normal(&mut rng));
                    *y += noise;
                }
                recording
            };
            let (one, other) = (filtered(2e-3), filtered(1e-2));
            bench.validate(&bench.calibrate(&one), &other)
        })
        .collect();
    // the noise of the means beyond white noise is known to a share of itself only; before, 0 of the
    // rotations passed. Less 4 standard deviations of a share of 200
    for (kind, at_least) in KINDS.into_iter().zip([0.96, 0.78, 0.69]) {
        let of: Vec<_> = found.iter().filter_map(|validation| validation.of_kind(kind)).collect();
        let (believed, small) =
            (share(&of, CovarianceVerdict::Believed), share(&of, CovarianceVerdict::TooSmall));
        let factor = mean(of.iter().map(|errors| errors.factor));
        println!("{kind:?}: believed {believed}, too small {small}, factor {factor}");
        assert!(believed > at_least, "{kind:?}: {believed}");
        assert!(factor < 1.25, "{kind:?}: {factor}");
    }
}

#[test]
fn other_noise_is_said() {
    let found = tried(times(1.0, 5.0), 0.0, 1, |_, _| ());
    let sentences = validation_sentences(&found[0]);
    println!("{sentences:#?}");
    assert!(
        sentences[0].starts_with("The gyroscope's noise is 5.0 times that of the calibration's recording"),
        "{sentences:#?}"
    );
    let found = tried(times(1.0, 1.1), 0.0, 1, |_, _| ());
    assert!(!validation_sentences(&found[0])[0].contains("noise"));
}

/// The accelerometer's readings in steps of this number of standard deviations of their noise.
fn rounded(mut recording: ImuRecording, setup: &ImuSimulation, deviations: f64) -> ImuRecording {
    in_steps(
        recording[SensorKind::Accelerometer].as_mut().expect("there"),
        deviations * setup.accelerometer_noise,
    );
    recording
}

fn in_steps(recording: &mut Recording, step: f64) {
    recording.readings_mut().iter_mut().for_each(|y| *y = y.map(|y| (y / step).round() * step));
}

/// The effect of quantisation on a hold's mean is part of the prediction. A coarser range of the
/// accelerometer is no reason to call a covariance too small.
#[test]
fn an_accelerometer_with_coarser_steps_does_not_make_a_covariance_too_small() {
    let setup = ImuSimulation::default();
    let bench = bench(&setup);
    for (calibrated, tried) in [(0.1, 4.0), (0.1, 5.0), (4.0, 4.0), (6.0, 6.0)] {
        let found: Vec<Validation> = (0..40)
            .into_par_iter()
            .map(|number| {
                let mut rng = stream(43, Purpose::Sensor, number);
                let truth = draw_imu(&mut rng);
                let mut record = |steps| rounded(simulate(&truth, &setup, 0.0, &mut rng), &setup, steps);
                let calibration = bench.calibrate(&record(calibrated));
                bench.validate(&calibration, &record(tried))
            })
            .collect();
        let of: Vec<_> = found.iter().filter_map(|found| found.of_kind(ErrorKind::Magnitude)).collect();
        let too_small = share(&of, CovarianceVerdict::TooSmall);
        println!("steps of {calibrated} and {tried}: {too_small}");
        assert!(too_small <= 0.1, "steps of {calibrated} and {tried}: {too_small}");
    }
}

/// At rest all holds share the rounding error of a gyroscope: its bias has not moved.
#[test]
#[ignore = "long: scripts/test-all runs it"]
fn a_gyroscope_with_coarse_steps_in_the_other_recording_has_not_moved() {
    let setup = ImuSimulation::default();
    let bench = bench(&setup);
    let count = 200;
    for (steps, scatter) in [(2.5, 0.0), (3.0, 0.0), (4.0, 0.0), (4.0, 1.0), (6.0, 0.0)] {
        let step = steps * setup.gyroscope_noise;
        let found: Vec<[Validation; 2]> = (0..count)
            .into_par_iter()
            .map(|number| {
                let mut rng = stream(44, Purpose::Sensor, number);
                let truth = draw_imu(&mut rng);
                let calibration = bench.calibrate(&simulate(&truth, &setup, scatter, &mut rng));
                let mut tried = |moved: f64| {
                    let mut truth = truth;
                    truth[SensorKind::Gyroscope].bias.x += moved;
                    let mut other = simulate(&truth, &setup, scatter, &mut rng);
                    in_steps(other[SensorKind::Gyroscope].as_mut().expect("there"), step);
                    bench.validate(&calibration, &other)
                };
                [tried(0.0), tried(step)]
            })
            .collect();
        let [honest, off] = [0, 1].map(|k| found.iter().map(|pair| pair[k].clone()).collect::<Vec<_>>());
        let (alarms, seen) = (moved(&honest), moved(&off));
        println!("steps of {steps}, scatter {scatter}: {alarms} moved, {seen} of those off by a step");
        // at most 5 % of 200, and nearly all of the biases that are off, although half a step may be hidden
        assert!(alarms <= 0.05 && seen > 0.9, "steps of {steps}, scatter {scatter}: {alarms} {seen}");
        for kind in KINDS {
            let of: Vec<_> = honest.iter().filter_map(|found| found.of_kind(kind)).collect();
            let (believed, small) =
                (share(&of, CovarianceVerdict::Believed), share(&of, CovarianceVerdict::TooSmall));
            println!("  {kind:?}: believed {believed}, too small {small}");
            assert!(small <= 0.05, "steps of {steps}, scatter {scatter} {kind:?}: {small}");
        }
    }
}

/// Steps of the other recording that make its readings scatter more are reported with their size; noise of
/// the same size is noise.
#[test]
fn coarser_steps_are_no_noise() {
    let setup = ImuSimulation::default();
    let bench = bench(&setup);
    let mut rng = stream(49, Purpose::Sensor, 0);
    let truth = draw_imu(&mut rng);
    let fine = in_both(&mut simulate(&truth, &setup, 1.0, &mut rng), 0.1, &setup);
    let calibration = bench.calibrate(&fine);
    for steps in [4.0, 8.0, 20.0] {
        let coarse = in_both(&mut simulate(&truth, &setup, 1.0, &mut rng), steps, &setup);
        let validation = bench.validate(&calibration, &coarse);
        let sentences = validation_sentences(&validation);
        println!("{steps}: {sentences:#?}");
        for (noise, (sd, symbol)) in validation
            .noise
            .iter()
            .zip([(setup.accelerometer_noise, "m/s²"), (setup.gyroscope_noise, "rad/s")])
        {
            let found = noise.coarse.expect("coarse");
            assert!((found.step / (steps * sd) - 1.0).abs() < 1e-6, "{found:?}");
            let says = format!("The {}'s readings come in steps of ", noise.sensor_kind);
            let message = sentences.iter().find(|sentence| sentence.starts_with(&says));
            assert!(
                message.is_some_and(|message| message.contains(&format!(" {symbol} here, "))),
                "{sentences:#?}"
            );
        }
        assert!(sentences.iter().all(|sentence| !sentence.contains("'s noise is")), "{sentences:#?}");
    }
    let noisy = ImuSimulation {
        accelerometer_noise: 3.0 * setup.accelerometer_noise,
        gyroscope_noise: 3.0 * setup.gyroscope_noise,
        ..setup.clone()
    };
    let noisy = in_both(&mut simulate(&truth, &noisy, 1.0, &mut rng), 0.1, &setup);
    let validation = bench.validate(&calibration, &noisy);
    assert!(validation.noise.iter().all(|noise| noise.coarse.is_none() && noise.differs()));
    assert!(validation_sentences(&validation)[0].starts_with("The accelerometer's noise is 3.0 times"));
}

/// Both sensors in steps of this number of standard deviations of their noise.
fn in_both(recording: &mut ImuRecording, deviations: f64, setup: &ImuSimulation) -> ImuRecording {
    in_steps(
        recording[SensorKind::Accelerometer].as_mut().expect("there"),
        deviations * setup.accelerometer_noise,
    );
    in_steps(recording[SensorKind::Gyroscope].as_mut().expect("there"), deviations * setup.gyroscope_noise);
    recording.clone()
}
