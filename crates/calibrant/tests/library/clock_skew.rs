//! Tests of sensors whose times are not of one clock: the warning names it, and other sensors get no such
//! warning.

use crate::common::draw_imu;
use crate::common::hand::ByHand;
use crate::common::{messages, retimed};
use crate::common::{steady_holds, steady_imu, unfeeling_gyroscope};
use calibrant::Error;
use calibrant::estimate::{
    Calibration, CalibrationSettings, CovarianceVerdict, ErrorKind, Gyroscope, HoldsSetup, ImuProblem,
    ImuSetup, calibrate_imu, cross_validate_imu,
};
use calibrant::sensor::{ImuParameters, ImuRecording, Recording, Sensor, SensorKind, SensorModel};
use calibrant::simulate::{ImuSimulation, Purpose, simulate_imu, stream};
use nalgebra::Vector3;
use rand::RngExt;
use rayon::prelude::*;

/// The words of the warning where the clocks differ.
const SAID: &str = "he gyroscope shows movements ";

fn run(recording: &ImuRecording) -> calibrant::Result<Calibration> {
    let accelerometer = Sensor::triaxial(SensorModel::Full);
    let (gyroscope, setup) = (unfeeling_gyroscope(), steady_imu());
    let problem =
        ImuProblem { accelerometer: &accelerometer, gyroscope: &gyroscope, recording, setup: &setup };
    calibrate_imu(&problem, &CalibrationSettings::default())
}

/// Every `step`-th sample, from one on.
fn every(recording: &Recording, step: usize, from: usize) -> Recording {
    recording.only(|k| k >= from && (k - from).is_multiple_of(step))
}

/// A recording at 400 Hz without some of the samples in each hold, so that these last from 2 to 4 s.
fn of_uneven_holds(recording: &Recording, number: u64) -> Recording {
    let kept = |k: &usize| {
        let (hold, place) = (k / 2400, k % 2400);
        // a hold is 1600 samples, a turn 800
        !(400..400 + (number as usize + hold) * 7919 % 800).contains(&place)
    };
    let readings: Vec<Vector3<f64>> =
        (0..recording.len()).filter(kept).map(|k| recording.readings()[k]).collect();
    let times_s = (0..readings.len()).map(|k| k as f64 / 400.0).collect();
    Recording::new(times_s, readings, 3, recording.unit()).expect("samples in order")
}

/// An IMU, and its recording at 400 Hz when it is turned on an arm whose components have this standard
/// deviation, m.
fn on_an_arm(number: u64, setup: &ImuSimulation, arm_sd_m: f64) -> (ImuParameters, ImuRecording) {
    let mut rng = stream(71, Purpose::Sensor, number);
    let imu = draw_imu(&mut rng);
    let mut both = simulate_imu(&imu, setup, &mut rng);
    let arm = Vector3::from_fn(|_, _| arm_sd_m * crate::common::normal(&mut rng));
    let rates = both[SensorKind::Gyroscope].clone().expect("of an IMU");
    let forces = both[SensorKind::Accelerometer].as_mut().expect("of an IMU");
    let rate = |k: usize| rates.readings()[k] - imu[SensorKind::Gyroscope].bias;
    for k in 4..rates.len() - 4 {
        let change = (rate(k + 4) - rate(k - 4)) * (400.0 / 8.0);
        forces.readings_mut()[k] += change.cross(&arm) + rate(k).cross(&rate(k).cross(&arm));
    }
    (imu, both)
}

/// The accelerometer at 50 to 200 Hz and the gyroscope at 80 to 400 Hz, whose time becomes `clock(t)`.
fn thinned(both: &ImuRecording, number: u64, clock: impl Fn(f64) -> f64) -> ImuRecording {
    let (Some(forces), Some(rates)) = (&both[SensorKind::Accelerometer], &both[SensorKind::Gyroscope]) else {
        unreachable!()
    };
    let steps = [[4, 1], [2, 5], [8, 2], [4, 4], [3, 3]][number as usize % 5];
    let (accelerometer, gyroscope) = (every(forces, steps[0], 1), every(rates, steps[1], 2));
    let gyroscope = retimed(&gyroscope, clock);
    ImuRecording { sensors: [Some(accelerometer), Some(gyroscope)].into(), temperature_c: None }
}

/// An IMU that is turned about a point some centimetres beside it; the time of the gyroscope becomes
/// `clock(t)`.
fn pair(number: u64, clock: impl Fn(f64) -> f64) -> (ImuParameters, ImuRecording) {
    let setup = ImuSimulation { rate_hz: 400.0, hold_s: 4.0, ..ImuSimulation::default() };
    let (imu, mut both) = on_an_arm(number, &setup, 0.03);
    for of in both.sensors.values_mut() {
        *of = of.as_ref().map(|of| of_uneven_holds(of, number));
    }
    (imu, thinned(&both, number, clock))
}

/// Quick turns on long arms, which accelerate as much as gravity.
fn quick(number: u64, clock: impl Fn(f64) -> f64) -> ImuRecording {
    let turn_s = [0.6, 0.8, 1.0][number as usize % 3];
    let setup = ImuSimulation { rate_hz: 400.0, hold_s: 2.5, turn_s, ..ImuSimulation::default() };
    thinned(&on_an_arm(number, &setup, 0.3).1, number, clock)
}

fn message(calibration: &Calibration) -> Option<String> {
    messages(&calibration.warnings).into_iter().find(|warning| warning.contains(SAID))
}

/// Standard deviation of the least certain gain of the gyroscope.
fn gain_sd(calibration: &Calibration) -> f64 {
    let sd = calibration.sd();
    let is_gain = |k: &usize| calibration.quantities[*k].name().starts_with("gyroscope.scale");
    (0..sd.len()).filter(is_gain).map(|k| sd[k]).fold(0.0, f64::max)
}

/// The number after a text.
fn number(text: &str, before: &str) -> f64 {
    let rest = text.split_once(before).unwrap_or_else(|| panic!("{before}: {text}")).1;
    let end = rest.find(|c: char| !"+-.0123456789".contains(c)).unwrap_or(rest.len());
    rest[..end].trim_end_matches('.').parse().unwrap_or_else(|_| panic!("{before}: {text}"))
}

#[test]
fn honest_pairs_are_not_accused() {
    let accused = |number: u64| {
        let calibration = run(&pair(number, |t| t).1).expect("determined");
        message(&calibration).map(|warning| format!("{number}: {warning}"))
    };
    let accused: Vec<String> = (0..60).into_par_iter().filter_map(accused).collect();
    assert!(accused.is_empty(), "{accused:?}");
}

#[test]
fn honest_pairs_that_are_turned_quickly_on_long_arms_are_not_accused() {
    let outcomes: Vec<Option<String>> = (0..100_u64)
        .into_par_iter()
        .filter_map(|number| {
            let calibration = run(&quick(number, |t| t)).ok()?;
            Some(message(&calibration).map(|warning| format!("{number}: {warning}")))
        })
        .collect();
    let accused: Vec<&String> = outcomes.iter().flatten().collect();
    assert!(accused.is_empty() && outcomes.len() >= 97, "{} {accused:?}", outcomes.len());
}

#[test]
fn clocks_of_different_rates_are_told_on_long_arms_and_make_folds_doubtful() {
    let count = 24_u64;
    let reported: Vec<f64> = (0..count)
        .into_par_iter()
        .filter_map(|number| {
            let rate = [1e-3, -1e-3][number as usize % 2];
            let clocks =
                run(&quick(number, |t| t * (1.0 + rate))).ok()?.gyroscope.as_ref().expect("an IMU").clocks?;
            Some((clocks.faster - rate) / clocks.sd)
        })
        .collect();
    assert!(reported.len() as u64 >= count - 2, "{reported:?}");
    assert!(reported.iter().all(|z| z.abs() < 4.5), "{reported:?}");

    let (accelerometer, gyroscope) = (Sensor::triaxial(SensorModel::Full), unfeeling_gyroscope());
    for (rate, expected) in [(0.0, None), (1e-3, Some("gains-of-clock"))] {
        let (_, recording) = pair(3, |t| t * (1.0 + rate));
        let setup = steady_imu();
        let problem = ImuProblem {
            accelerometer: &accelerometer,
            gyroscope: &gyroscope,
            recording: &recording,
            setup: &setup,
        };
        let settings = CalibrationSettings::default();
        let calibration = calibrate_imu(&problem, &settings).expect("determined");
        let folds = cross_validate_imu(&calibration, &problem, &settings, 5).expect("determined");
        for errors in &folds.kinds {
            let expected = expected.filter(|_| errors.kind == ErrorKind::Rotation);
            assert_eq!(
                errors.caveat.as_ref().map(|caveat| caveat.code().name()),
                expected,
                "{rate} {:?}",
                errors.kind
            );
            assert_eq!(errors.verdict == CovarianceVerdict::Doubtful, expected.is_some(), "{errors:#?}");
        }
    }
}

#[test]
fn the_xsens_pair_is_not_accused() {
    let Some((recording, gravity)) = crate::common::xsens() else { return };
    let setup = ImuSetup { holds: HoldsSetup { gravity, ..steady_holds() }, ..steady_imu() };
    let unit = calibrant::sensor::ReadingUnit::Counts;
    let gyroscope = Gyroscope { unit, ..unfeeling_gyroscope() };
    let accelerometer = Sensor { unit, gain: None, offset: None, ..Sensor::triaxial(SensorModel::Full) };
    let calibrate = |recording: &ImuRecording| {
        let problem =
            ImuProblem { accelerometer: &accelerometer, gyroscope: &gyroscope, recording, setup: &setup };
        calibrate_imu(&problem, &CalibrationSettings::default()).expect("determined")
    };
    assert_eq!(message(&calibrate(&recording)), None);
    // and it is so with a wrong clock
    let mut other = recording;
    let gyroscope = other[SensorKind::Gyroscope].as_mut().expect("there");
    *gyroscope = retimed(gyroscope, |t| 3.0 + (t - 3.0) * 1.0002);
    let calibration = calibrate(&other);
    let warning = message(&calibration).expect("told");
    let (growth, sd) = (number(&warning, "at different rates, by "), number(&warning, " ± "));
    assert!((growth - 0.02).abs() < 4.0 * sd && sd < 0.003, "{warning}");
}

#[test]
fn a_clock_that_goes_faster_is_told_with_its_rate_and_the_advice_repairs_the_gains() {
    (0..10_u64).into_par_iter().for_each(|k| {
        let rate = [3e-4, -3e-4, 1e-3, -5e-3, 5e-3][k as usize % 5];
        let (imu, mut recording) = pair(k, |t| 5.0 + (t - 5.0) * (1.0 + rate) + 0.02);
        let off = |calibration: &Calibration| {
            let gain = calibration.imu[SensorKind::Gyroscope].matrix.trace() / 3.0;
            gain / (imu[SensorKind::Gyroscope].matrix.trace() / 3.0) - 1.0
        };
        let calibration = run(&recording).expect("determined");
        let warning = message(&calibration).unwrap_or_else(|| panic!("{rate}: {:?}", calibration.warnings));
        let (growth, sd) = (number(&warning, "at different rates, by "), number(&warning, " ± "));
        assert!((growth - 100.0 * rate).abs() < 4.0 * sd, "{rate}: {warning}");
        assert!(warning.contains(if rate > 0.0 { "too large" } else { "too small" }), "{warning}");
        assert!(
            (off(&calibration) - rate).abs() < 4.0 * gain_sd(&calibration),
            "{rate}: {}",
            off(&calibration)
        );
        // as advised
        let factor = number(&warning, "first sample by ");
        let shift = match (warning.contains("and subtract "), warning.contains("and add ")) {
            (true, _) => -number(&warning, "and subtract "),
            (_, true) => number(&warning, "and add "),
            _ => 0.0,
        };
        let gyroscope = recording[SensorKind::Gyroscope].as_mut().expect("there");
        let first = gyroscope.times_s()[0];
        *gyroscope = retimed(gyroscope, |t| first + (t - first) * factor + shift);
        let repaired = run(&recording).expect("determined");
        assert_eq!(message(&repaired), None, "{rate}");
        assert!(
            off(&repaired).abs() < 4.0 * (0.01 * sd).hypot(gain_sd(&repaired)),
            "{rate}: {}",
            off(&repaired)
        );
    });
}

#[test]
fn a_latency_is_told_with_its_length() {
    (0..8_u64).into_par_iter().for_each(|k| {
        let lag = [0.06, -0.06, 0.3, -0.8][k as usize % 4];
        let calibration = run(&pair(k, |t| t + lag).1).expect("determined");
        let warning = message(&calibration).unwrap_or_else(|| panic!("{lag}: {:?}", calibration.warnings));
        let direction = if lag > 0.0 { "ms later" } else { "ms earlier" };
        assert!(warning.contains(direction), "{lag}: {warning}");
        let (reported, sd) = (number(&warning, SAID) / 1e3, number(&warning, "(± ") / 1e3);
        assert!((reported - lag.abs()).abs() < 4.0 * sd && sd < 0.01, "{lag}: {warning}");
        let advice = if lag > 0.0 { "correct it, subtract " } else { "correct it, add " };
        assert!((number(&warning, advice) - lag.abs()).abs() < 4.0 * sd, "{lag}: {warning}");
    });
}

#[test]
fn clocks_too_far_apart_for_a_fit_are_told_too() {
    (0..6_u64).into_par_iter().for_each(|k| {
        let lag = [4.0, -12.0][k as usize % 2];
        let outcome = run(&pair(k, |t| t + lag).1);
        let Err(error @ (Error::Recording(_) | Error::NotIdentifiable(_))) = outcome else {
            panic!("{lag}: determined")
        };
        let words = error.to_string();
        let reported = number(&words, "the gyroscope is about ");
        assert!((reported - lag.abs()).abs() < 0.3, "{lag}: {words}");
    });
}

/// The gyroscope is late by 12 ms. Knocks and a hand that pushes do not hide it.
#[test]
fn an_offset_is_in_the_result_with_its_uncertainty() {
    let one = |(number, knocks, rate_hz): (u64, bool, f64)| {
        let mut rng = stream(72, Purpose::Sensor, number);
        let imu = draw_imu(&mut rng);
        let late_s = rng.random_range(0.005..0.015);
        let late_s = (late_s * rate_hz * 16.0).round() / (rate_hz * 16.0);
        let setup = ByHand { gyroscope_late_s: late_s, knocks, filtered: true, rate_hz, ..ByHand::default() };
        let found = run(&setup.record(&imu, &mut rng)).expect("determined");
        let time = found.gyroscope.as_ref().expect("there").time_offset.expect("found");
        let gyroscope = (0..found.values.len())
            .filter(|&k| found.quantities[k].name().starts_with("gyroscope"))
            .map(|k| ((found.values[k] - found.quantities[k].value(&imu)) / found.sd()[k]).powi(2));
        let squares: f64 = gyroscope.clone().sum::<f64>() / gyroscope.count() as f64;
        ((time.offset_s - late_s) / time.sd_s, time.sd_s, squares)
    };
    for knocks in [false, true] {
        for rate_hz in [100.0, 200.0] {
            let found: Vec<(f64, f64, f64)> =
                (0..20).into_par_iter().map(|number| one((number, knocks, rate_hz))).collect();
            let count = found.len() as f64;
            let squares = found.iter().map(|(z, ..)| z * z).sum::<f64>() / count;
            let bias = found.iter().map(|(z, ..)| z).sum::<f64>() / count;
            let sd_s = found.iter().map(|(_, sd, _)| sd).sum::<f64>() / count;
            let parameters = found.iter().map(|(.., of)| of).sum::<f64>() / count;
            println!(
                "knocks {knocks}, {rate_hz} Hz: z² {squares:.2}, mean {bias:.2}, sd {:.2} ms; parameters {parameters:.2}",
                1e3 * sd_s
            );
            // z² of twenty is below 1.9 in 99 of 100 simulations
            assert!(squares < 1.9 && bias.abs() < 0.7 && parameters < 1.6, "{squares} {bias} {parameters}");
        }
    }
}
