//! Tests of errors that calibrations at one place share: in the file, and in the drift.

use super::tests::{place, record};
use super::*;
use calibrant_core::sensor::{
    CalibratedImu, ImuParameters, ImuQuantity, Quantity, ReadingUnit, SensorKind, SharedErrors,
};
use calibrant_io::UtcTime;
use nalgebra::{DMatrix, DVector};

/// Sets the geometry of a machine, known so that gains are uncertain by this, beside 10 ppm of each parameter.
const OF_GEOMETRY: f64 = 3e-3;

/// An accelerometer with these gains, calibrated on a machine.
fn on_machine(gain: f64) -> CalibratedImu {
    let quantities = ImuQuantity::full_list(true, false, false);
    let is_scale =
        |of: &ImuQuantity| matches!(of, ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Scale(_)));
    let column: Vec<f64> = quantities.iter().map(|of| if is_scale(of) { OF_GEOMETRY } else { 0.0 }).collect();
    let (size, shared) = (quantities.len(), DVector::from_column_slice(&column));
    let mut parameters = ImuParameters::identity();
    parameters[SensorKind::Accelerometer].matrix *= gain;
    CalibratedImu {
        parameters,
        units: [Some(ReadingUnit::MetrePerSecondSquared), None].into(),
        counts_per_unit: Default::default(),
        quantities,
        covariance: Some(DMatrix::identity(size, size) * 1e-10 + &shared * shared.transpose()),
        degrees_of_freedom: None,
        shared: SharedErrors::of_source("geometry.wrist.x ± 0.0003".into(), &column),
        frame: "the flange".into(),
    }
}

/// The probabilities of the drift from one calibration to another 1.003 times as large, a year later.
fn p_values(stations: [Option<&str>; 2]) -> (f64, Option<f64>) {
    let (_directory, path) = place();
    let mut records = Records::open(&path).expect("made");
    for (k, station) in stations.into_iter().enumerate() {
        let mut of = record("A", k);
        of.imu = on_machine([1.0, 1.003][k]);
        of.station = station.map(str::to_owned);
        of.recorded = UtcTime::parse(["2025-05-01", "2026-05-01"][k]);
        records.insert(&of).expect("inserted");
    }
    let drifts = records.drifts().expect("read");
    (drifts[0].p_value().expect("a change"), drifts[0].p_value_at_one_place)
}

#[test]
fn the_geometry_of_a_machine_hides_no_change_at_its_station() {
    let (at_one, _) = p_values([Some("L1"), Some("L1")]);
    assert!(at_one < 1e-12, "{at_one}");
    // two machines differ by as much
    let (at_two, _) = p_values([Some("L1"), Some("L2")]);
    assert!(at_two > 0.1, "{at_two}");
    let (unknown, if_one) = p_values([None, None]);
    assert!(unknown > 0.1 && if_one.is_some_and(|p| p < 1e-12), "{unknown} {if_one:?}");
}

#[test]
fn records_of_the_schema_before_are_read_and_brought_to_this_one() {
    let (_directory, path) = place();
    let mut records = Records::open(&path).expect("made");
    let mut old = record("A", 1);
    old.imu.shared = None;
    records.insert(&old).expect("inserted");
    records
        .connection
        .execute_batch("DROP TABLE shared_errors; PRAGMA user_version = 3")
        .expect("as the version before made it");
    drop(records);
    let all = RecordFilter::default();
    let only_read = Records::open_existing(&path).expect("read").list(&all).expect("read");
    assert_eq!(only_read[0].record, old);
    let mut records = Records::open(&path).expect("upgraded");
    let new = record("A", 2);
    records.insert(&new).expect("inserted");
    let kept: Vec<Record> = records.list(&all).expect("read").into_iter().map(|of| of.record).collect();
    assert_eq!(kept, [old, new]);
}
