//! Knocks where a sensor is set down are real motion: nothing is cut out, and the uncertainty holds.

use crate::common::hand::ByHand;
use crate::common::{draw_imu, run_imu};
use crate::common::{steady_imu, unfeeling_gyroscope};
use calibrant::estimate::Calibration;
use calibrant::sensor::{ImuParameters, ReadingUnit, SensorKind};
use calibrant::simulate::{Purpose, stream};
use rand::RngExt;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Recordings of each kind.
const RECORDINGS: u64 = 30;

/// Simulates and calibrates a number of IMUs.
fn calibrated(setup: &ByHand, count: u64) -> Vec<(ImuParameters, Calibration)> {
    let one = |number: u64| {
        let mut rng = stream(91, Purpose::Sensor, number);
        let imu = draw_imu(&mut rng);
        let recording = setup.record(&imu, &mut rng);
        let (gyroscope, setup) = (unfeeling_gyroscope(), steady_imu());
        let found = run_imu(&recording, &gyroscope, &setup, ReadingUnit::MetrePerSecondSquared);
        (imu, found.expect("determined"))
    };
    (0..count).into_par_iter().map(one).collect()
}

/// Mean of z² over the quantities of a sensor, and the share of them within 1.96 standard deviations.
fn coverage(found: &[(ImuParameters, Calibration)], sensor_kind: SensorKind) -> (f64, f64) {
    let (mut squares, mut within, mut count) = (0.0, 0.0, 0.0);
    for (imu, calibration) in found {
        for (k, quantity) in calibration.quantities.iter().enumerate() {
            if quantity.sensor_kind() == sensor_kind {
                let z = (calibration.values[k] - quantity.value(imu)) / calibration.sd()[k];
                squares += z * z;
                within += f64::from(u8::from(z.abs() < 1.96));
                count += 1.0;
            }
        }
    }
    (squares / count, within / count)
}

/// Number of warnings of each code.
fn warned(found: &[(ImuParameters, Calibration)]) -> BTreeMap<&'static str, usize> {
    let mut codes = BTreeMap::new();
    for warning in found.iter().flat_map(|(_, calibration)| &calibration.warnings) {
        *codes.entry(warning.code().name()).or_insert(0) += 1;
    }
    codes
}

fn check_knocks(setup: &ByHand, most_left_out: usize) {
    let found = calibrated(setup, RECORDINGS);
    let (squares, within) = coverage(&found, SensorKind::Gyroscope);
    let codes = warned(&found);
    let left_out = codes.get("rotation-left-out").copied().unwrap_or(0);
    println!("{} Hz, filtered {}: {squares:.2}, {within:.3}; {codes:?}", setup.rate_hz, setup.filtered);
    assert!(within > 0.9 && squares < 1.4, "{squares} {within}");
    assert!(left_out <= most_left_out, "{codes:?}");
    assert!(codes.get("spikes").copied().unwrap_or(0) <= 1, "{codes:?}");
    assert!(coverage(&found, SensorKind::Accelerometer).1 > 0.93);
}

#[test]
fn knocks_that_are_filtered_are_kept_and_the_uncertainty_holds() {
    for rate_hz in [100.0, 200.0] {
        check_knocks(&ByHand { knocks: true, filtered: true, rate_hz, ..ByHand::default() }, 2);
    }
}

#[test]
fn knocks_without_a_filter_are_kept_and_the_uncertainty_holds() {
    check_knocks(&ByHand { knocks: true, rate_hz: 200.0, ..ByHand::default() }, 2);
    // one in fifty falls between two samples, so that neither sensor shows it
    check_knocks(&ByHand { knocks: true, ..ByHand::default() }, 23 * RECORDINGS as usize / 50);
}

/// One sample in 2000 of the gyroscope has a wrong bit.
#[test]
fn spikes_beside_knocks_are_found() {
    let (mut added, mut found, mut other) = (0, 0, 0);
    for number in 0..20 {
        let mut rng = stream(92, Purpose::Sensor, number);
        let imu = draw_imu(&mut rng);
        let setup = ByHand { knocks: true, filtered: true, rate_hz: 200.0, ..ByHand::default() };
        let mut recording = setup.record(&imu, &mut rng);
        let gyroscope = recording[SensorKind::Gyroscope].as_mut().expect("recorded");
        let mut wrong = Vec::new();
        for (k, reading) in gyroscope.readings_mut().iter_mut().enumerate() {
            if rng.random::<f64>() < 1.0 / 2000.0 {
                reading.y += 2.0;
                wrong.push(k);
            }
        }
        let (_, outliers) = recording.without_spikes();
        let samples: Vec<usize> = outliers.into_iter().flat_map(|(_, spikes)| spikes.samples).collect();
        added += wrong.len();
        found += wrong.iter().filter(|k| samples.contains(k)).count();
        other += samples.iter().filter(|k| !wrong.contains(k)).count();
    }
    assert!(added > 150 && found * 10 > added * 9 && other <= 2, "{found} of {added}, {other} others");
}

/// Turns begin gently, and holds turn slowly: the uncertainty holds for good sensors, too.
#[test]
fn sensors_of_low_noise_that_turn_slowly_in_holds_have_honest_uncertainties() {
    for turn_in_hold_radps in [0.0, 1e-3, 3e-3] {
        let (accelerometer_noise, gyroscope_noise) = (2e-3, 2e-4);
        let low = ByHand { rate_hz: 200.0, accelerometer_noise, gyroscope_noise, ..ByHand::default() };
        let found = calibrated(&ByHand { turn_in_hold_radps, ..low }, RECORDINGS);
        for sensor_kind in SensorKind::ALL {
            let (squares, within) = coverage(&found, sensor_kind);
            println!("{turn_in_hold_radps} rad/s, {sensor_kind}: {squares:.2}, {within:.3}");
            assert!(squares < 1.25 && within > 0.92, "{sensor_kind}: {squares} {within}");
        }
    }
}
