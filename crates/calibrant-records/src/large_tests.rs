//! A hundred thousand calibrations in one database: rates, times and sizes, as COMPARE.md has them.

use super::tests::without_codes;
use super::*;
use calibrant_core::diagnostic::Usability;
use calibrant_core::sensor::{CalibratedImu, ImuParameters, ImuQuantity, Quantity, ReadingUnit, SensorKind};
use calibrant_io::{HashedFile, UtcTime};
use nalgebra::DMatrix;
use std::time::Instant;

/// Calibrations of 10 000 sensors, each of which is calibrated once a year for ten years.
const CALIBRATIONS: usize = 100_000;

/// A calibration number k of an IMU, or of an accelerometer, in the lower gauge.
fn record(k: usize, with_gyroscope: bool) -> Record {
    let mut state = k as u64;
    // SplitMix64
    let mut random = move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    };
    let (sensor, year) = (k % (CALIBRATIONS / 10), k / (CALIBRATIONS / 10));
    let above = |quantity: &ImuQuantity| matches!(quantity, ImuQuantity::Of(SensorKind::Accelerometer, Quantity::CrossAxis(row, column)) if row.index() < column.index());
    let quantities: Vec<_> =
        ImuQuantity::full_list(true, with_gyroscope, false).into_iter().filter(|of| !above(of)).collect();
    let recording: String = (0..4).map(|_| format!("{:016x}", random())).collect();
    let mut centred = || random() as f64 / u64::MAX as f64 - 0.5;
    let mut parameters = ImuParameters::identity();
    for quantity in &quantities {
        quantity.add_to(&mut parameters, 0.02 * centred());
    }
    let root =
        DMatrix::from_fn(
            quantities.len(),
            quantities.len(),
            |i, j| if i == j { 1e-3 } else { 2e-4 * centred() },
        );
    Record {
        sensor: format!("SN{sensor:06}"),
        recorded: UtcTime::parse(&format!("{}-05-{:02}T08:30:00", 2016 + year, 1 + sensor % 28)),
        station: Some(format!("L{}", sensor % 4)),
        program: "calibrant 1.0.0".into(),
        plan: "holds".into(),
        experiment: Some(HashedFile { file: "imu.toml".into(), sha256: "e5".repeat(32) }),
        motion_file: None,
        recordings: vec![HashedFile {
            file: format!("SN{sensor:06}_{}.csv", 2016 + year),
            sha256: recording,
        }],
        verdict: without_codes(match (sensor + 7 * year).is_multiple_of(100) {
            true => Usability::Bad,
            false => Usability::Ok,
        }),
        status: "converged".into(),
        imu: CalibratedImu {
            parameters,
            units: [
                Some(ReadingUnit::MetrePerSecondSquared),
                with_gyroscope.then_some(ReadingUnit::RadianPerSecond),
            ]
            .into(),
            counts_per_unit: Default::default(),
            quantities,
            covariance: Some(&root * root.transpose()),
            degrees_of_freedom: None,
            shared: None,
            frame: "that of the accelerometer".into(),
        },
    }
}

fn timed<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let begun = Instant::now();
    let done = work();
    println!("{what}: {:.1} ms", 1e3 * begun.elapsed().as_secs_f64());
    done
}

fn measure(with_gyroscope: bool) {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("records.db");
    let mut records = Records::open(&path).expect("made");
    println!("{} parameters", record(0, with_gyroscope).imu.quantities.len());
    let singles: Vec<Record> = (0..1000).map(|k| record(k, with_gyroscope)).collect();
    timed("1000 insertions, a transaction each", || {
        singles.iter().for_each(|one| assert!(!records.insert(one).expect("inserted").replaced))
    });
    let mut inserting = 0.0;
    for first in (1000..CALIBRATIONS).step_by(9000) {
        let more: Vec<Record> = (first..first + 9000).map(|k| record(k, with_gyroscope)).collect();
        let begun = Instant::now();
        assert_eq!(records.insert_all(more).expect("inserted"), 9000);
        inserting += begun.elapsed().as_secs_f64();
    }
    println!("99000 insertions, a thousand in a transaction: {:.1} ms", 1e3 * inserting);
    println!("file: {} bytes", path.metadata().expect("there").len());
    drop(records);
    let records = timed("open", || Records::open_existing(&path).expect("opened"));
    let history = timed("history of a sensor", || records.history("SN004711").expect("read"));
    assert_eq!((history.calibrations.len(), history.changes.len()), (10, 9));
    let of_sensor = RecordFilter { sensor: Some("SN000815".into()), ..RecordFilter::default() };
    assert_eq!(timed("list of a sensor", || records.list(&of_sensor).expect("read")).len(), 10);
    let bad = RecordFilter { verdict: Some(Usability::Bad), ..RecordFilter::default() };
    assert_eq!(timed("list of the bad", || records.list(&bad).expect("read")).len(), 1000);
    let mut count = 0;
    timed("all records, one by one", || {
        records.each(&RecordFilter::default(), |_| count += 1).expect("read")
    });
    assert_eq!(count, CALIBRATIONS);
    assert_eq!(timed("drift of all sensors", || records.drifts().expect("read")).len(), CALIBRATIONS / 10);
    assert_eq!(
        timed("fleet", || records.fleet().expect("read")).parameters[0].values.sensors,
        CALIBRATIONS / 10
    );
    for name in ["t.csv", "t.parquet"] {
        let table = directory.path().join(name);
        timed(name, || records.export(&table, &RecordFilter::default()).expect("written"));
        println!("{name}: {} bytes", table.metadata().expect("there").len());
    }
}

#[test]
#[ignore = "takes a minute: scripts/test-all"]
fn a_hundred_thousand_calibrations() {
    measure(false);
    measure(true);
}
