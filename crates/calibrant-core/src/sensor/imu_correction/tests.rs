//! Tests of the correction on readings whose truth is known.

use super::*;
use crate::sensor::ReadingUnit;
use crate::sensor::gauge_change::tests::imu;
use crate::sensor::reference_temperature::tests::warm;

fn readings(imu: &CalibratedImu) -> (Vector3<f64>, Vector3<f64>) {
    let (force, rate) = (Vector3::new(1.0, -5.0, 8.0), Vector3::new(0.4, -1.2, 0.3));
    let gyroscope =
        imu.parameters[SensorKind::Gyroscope].reading(&rate) + imu.parameters.g_sensitivity * force;
    (imu.parameters[SensorKind::Accelerometer].reading(&force), gyroscope)
}

#[test]
fn the_correction_undoes_the_readings() {
    let imu = imu();
    let (y_a, y_g) = readings(&imu);
    let correction = ImuCorrection::of(&imu).expect("regular");
    let force = correction.force(&y_a).expect("there");
    assert!((force - Vector3::new(1.0, -5.0, 8.0)).amax() < 1e-11);
    assert!((correction.rate(&y_g, &force).expect("there") - Vector3::new(0.4, -1.2, 0.3)).amax() < 1e-11);
}

#[test]
fn its_uncertainty_is_that_of_differences() {
    is_that_of_differences(&imu(), 25.0);
}

#[test]
fn its_uncertainty_is_that_of_differences_at_other_temperatures_too() {
    for temperature in [12.0, 25.0, 41.0] {
        is_that_of_differences(&warm(), temperature);
    }
}

#[test]
fn its_uncertainty_is_that_of_differences_where_the_response_is_bent() {
    let mut bent = warm();
    *bent.parameters[SensorKind::Accelerometer].nonlinearity.of_mut(NonlinearTerm::SecondOrder) =
        Vector3::new(2e-3, -1e-3, 5e-4);
    *bent.parameters[SensorKind::Accelerometer].nonlinearity.of_mut(NonlinearTerm::GainBySign) =
        Vector3::new(0.01, 0.02, -0.03);
    let is_term = |of: &ImuQuantity| matches!(of, ImuQuantity::Of(_, Quantity::Nonlinear(..)));
    bent.quantities.extend(ImuQuantity::all(true, true).into_iter().filter(is_term));
    let old = bent.covariance.take().expect("there");
    let (first, n) = (old.nrows(), bent.quantities.len());
    bent.covariance = Some(nalgebra::DMatrix::from_fn(n, n, |i, j| match i.max(j) < first {
        true => old[(i, j)],
        false if i == j => 1e-8 * (1 + i) as f64,
        false => 0.0,
    }));
    for temperature in [25.0, 41.0] {
        is_that_of_differences(&bent, temperature);
    }
}

fn is_that_of_differences(imu: &CalibratedImu, temperature_c: f64) {
    let (y_a, y_g) = readings(imu);
    let corrected = |imu: &CalibratedImu| {
        let correction = ImuCorrection::of(imu).and_then(|of| of.at(temperature_c)).expect("regular");
        let force = correction.force(&y_a).expect("there");
        (force, correction.rate(&y_g, &force).expect("there"))
    };
    let columns: Vec<_> = imu
        .quantities
        .iter()
        .map(|&quantity| {
            let moved = |step: f64| {
                let mut moved = imu.clone();
                quantity.add_to(&mut moved.parameters, step);
                corrected(&moved)
            };
            let h = match quantity {
                ImuQuantity::Thermal(_, term) => 1e-6 / 10f64.powi(term.order as i32 - 1),
                ImuQuantity::Of(_, Quantity::Nonlinear(..)) => 1e-6,
                _ => 1e-3,
            };
            let (up, down) = (moved(h), moved(-h));
            ((up.0 - down.0) / (2.0 * h), (up.1 - down.1) / (2.0 * h))
        })
        .collect();
    let sigma = imu.covariance.as_ref().expect("there");
    let sd = |of: &dyn Fn(usize) -> f64| {
        let row = nalgebra::DVector::from_fn(columns.len(), |k, _| of(k));
        row.dot(&(sigma * &row)).sqrt()
    };
    let correction = ImuCorrection::of(imu).and_then(|of| of.at(temperature_c)).expect("regular");
    let (force, rate) = corrected(imu);
    for axis in 0..3 {
        let expected = (sd(&|k| columns[k].0[axis]), sd(&|k| columns[k].1[axis]));
        let found = (
            correction.force_sd(&force).expect("known")[axis],
            correction.rate_sd(&rate, &force).expect("known")[axis],
        );
        assert!((found.0 / expected.0 - 1.0).abs() < 1e-5, "{found:?} {expected:?}");
        assert!((found.1 / expected.1 - 1.0).abs() < 1e-5, "{found:?} {expected:?}");
    }
}

#[test]
fn the_force_is_interpolated_at_the_gyroscopes_times() {
    let imu = imu();
    let (y_a, y_g) = readings(&imu);
    let sensor_kind = |times_s: Vec<f64>, reading| Recording {
        readings: vec![reading; times_s.len()],
        times_s,
        axes: 3,
        unit: ReadingUnit::Counts,
    };
    let mut recording = ImuRecording {
        sensors: [
            Some(sensor_kind(vec![0.0, 1.0, 2.0], y_a)),
            Some(sensor_kind(vec![-1.0, 0.5, 1.0, 7.0], y_g)),
        ]
        .into(),
        temperature_c: None,
    };
    let correction = ImuCorrection::of(&imu).expect("regular");
    let found = correction.apply(&recording).expect("both there").gyroscope.expect("there");
    assert_eq!(found.values.len(), 4);
    assert!(found.values.iter().all(|rate| (rate - Vector3::new(0.4, -1.2, 0.3)).amax() < 1e-10));
    assert_eq!(found.sd.expect("known").len(), 4);
    recording[SensorKind::Accelerometer] = None;
    let error = correction.apply(&recording).expect_err("g-sensitivity").to_string();
    assert!(error.contains("has no accelerometer"), "{error}");
    let of_si = CalibratedImu {
        units: [imu.units[SensorKind::Accelerometer], Some(ReadingUnit::RadianPerSecond)].into(),
        ..imu
    };
    let of_si = ImuCorrection::of(&of_si).expect("regular");
    let error = of_si.apply(&recording).expect_err("another unit");
    assert!(error.is_invalid_recording() && error.to_string().contains("in counts, the calibration is of"));
}
