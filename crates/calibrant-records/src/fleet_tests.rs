//! Tests of the fleet: one frame and one temperature for all.

use super::tests::{imu, place, record};
use super::*;
use calibrant_core::sensor::{CalibratedImu, Gauge, ImuQuantity, SensorKind};
use nalgebra::DMatrix;

/// An IMU that follows temperature, about 25 °C, in a frame that is no gauge.
fn warm() -> CalibratedImu {
    let mut warm = imu(3);
    let terms = ImuQuantity::all_thermal(true, true);
    for (k, term) in terms.iter().enumerate() {
        let ImuQuantity::Thermal(_, of) = term else { continue };
        term.add_to(&mut warm.parameters, 1e-5 * (k as f64 % 7.0 - 3.0) / 20f64.powi(of.order as i32 - 1));
    }
    warm.parameters.thermal.reference_c = 25.0;
    warm.quantities.extend(terms);
    let size = warm.quantities.len();
    warm.covariance = Some(DMatrix::identity(size, size) * 1e-12);
    warm.shared = None;
    warm
}

fn fleet_of(imus: impl IntoIterator<Item = CalibratedImu>) -> Fleet {
    let (_directory, path) = place();
    let mut records = Records::open(&path).expect("made");
    for (k, imu) in imus.into_iter().enumerate() {
        // the first names are the last in the alphabet
        records.insert(&Record { imu, ..record(&format!("S{}", 9 - k), k) }).expect("inserted");
    }
    records.fleet().expect("read")
}

#[test]
fn one_sensor_in_every_gauge_and_at_every_temperature_is_the_same() {
    let gauges = [Gauge::Upper, Gauge::Lower, Gauge::Symmetric];
    let brought = |(k, gauge): (usize, &Gauge)| {
        let imu = warm().at_reference_temperature([20.0, 25.0, 35.0][k]).expect("positive gains");
        imu.in_gauge(*gauge).expect("right-handed")
    };
    let fleet = fleet_of(gauges.iter().enumerate().map(brought).chain([warm()]));
    assert_eq!((fleet.gauge, fleet.reference_c), (Some(Gauge::Upper), Some(20.0)), "as the first");
    assert_eq!(fleet.left_out, []);
    let first = warm().at_reference_temperature(20.0).and_then(|imu| imu.in_gauge(Gauge::Upper)).expect("so");
    for parameter in &fleet.parameters {
        let quantity = first.quantities.iter().find(|of| of.name() == parameter.name).expect("of the first");
        assert_eq!(parameter.values.sensors, 4, "{parameter:?}");
        assert!((parameter.values.mean - quantity.value(&first.parameters)).abs() < 1e-9, "{parameter:?}");
        assert!(parameter.values.sd < 1e-9, "{parameter:?}");
    }
    assert_eq!(fleet.parameters.len(), first.quantities.len());
}

#[test]
fn what_cannot_be_brought_into_the_frame_is_left_out_and_named() {
    let mut left_handed = imu(4);
    left_handed.parameters[SensorKind::Accelerometer].matrix.row_mut(1).neg_mut();
    let fleet = fleet_of([imu(1).in_gauge(Gauge::Lower).expect("right-handed"), imu(2), left_handed]);
    assert_eq!(fleet.gauge, Some(Gauge::Lower));
    assert_eq!(fleet.parameters[0].values.sensors, 2);
    let [out] = &fleet.left_out[..] else { panic!("{:?}", fleet.left_out) };
    assert_eq!((out.sensor.as_str(), out.id), ("S7", 3));
    assert!(out.reason.contains("left-handed"), "{}", out.reason);
}

#[test]
fn one_frame_of_another_kind_stays_and_two_become_a_gauge() {
    let same = fleet_of([imu(1), imu(2)]);
    assert_eq!((same.gauge, same.parameters.len()), (None, imu(1).quantities.len()));
    let bias = ["x", "y", "z"].map(|axis| format!("accelerometer.bias.{axis}"));
    let names: Vec<&String> = same.parameters.iter().map(|of| &of.name).take(3).collect();
    assert_eq!(names, bias.iter().collect::<Vec<_>>(), "in the order of the sensors");
    let other = CalibratedImu { frame: "the base of another robot".into(), ..imu(2) };
    assert_eq!(fleet_of([imu(1), other]).gauge, Some(Gauge::Lower));
}
