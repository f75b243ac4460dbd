//! Tests of the database: what it keeps, what it refuses, and what remains of an interrupted writer.

use super::*;
use calibrant_core::diagnostic::Usability;
use calibrant_core::error::Refusal;
use calibrant_core::sensor::{
    CalibratedImu, CovarianceDegrees, ImuParameters, ImuQuantity, Quantity, ReadingUnit, SensorKind,
    SharedErrors,
};
use calibrant_io::{HashedFile, UtcTime};
use nalgebra::DMatrix;
use rusqlite::Connection;
use std::path::{Path, PathBuf};

/// A calibration of an IMU: each number has its own bits.
pub(super) fn imu(k: usize) -> CalibratedImu {
    let mut parameters = ImuParameters::identity();
    let quantities = ImuQuantity::full_list(true, true, true);
    for (i, quantity) in quantities.iter().enumerate() {
        quantity.add_to(&mut parameters, 1e-3 * ((7 * i + 3 * k) % 11) as f64 / 3.0);
    }
    let root = DMatrix::from_fn(quantities.len(), quantities.len(), |i, j| 1e-4 / (1 + i + 2 * j + k) as f64);
    CalibratedImu {
        parameters,
        units: [Some(ReadingUnit::MetrePerSecondSquared), Some(ReadingUnit::Counts)].into(),
        counts_per_unit: Default::default(),
        quantities,
        covariance: Some(&root * root.transpose()),
        degrees_of_freedom: Some(CovarianceDegrees {
            accelerometer: 21.0,
            gyroscope_at_rest: f64::INFINITY,
            gyroscope_matrix: 7.0,
        }),
        shared: Some(SharedErrors {
            sources: vec!["gravity 9.80665 ± 0.019 m/s²".into(), "zero.wrist ± 0.001".into()],
            root: DMatrix::from_fn(33, 2, |i, j| 1e-5 / (1 + i + 5 * j + k) as f64),
        }),
        frame: "the base of the robot".into(),
    }
}

pub(super) fn record(sensor: &str, k: usize) -> Record {
    Record {
        sensor: sensor.into(),
        recorded: UtcTime::parse(&format!("2026-05-{:02}", 1 + k % 28)),
        station: Some("L1".into()),
        program: "calibrant 1.0.0".into(),
        plan: "holds".into(),
        experiment: Some(HashedFile { file: "imu.toml".into(), sha256: "e".into() }),
        motion_file: Some(HashedFile { file: "log.csv".into(), sha256: "m".into() }),
        recordings: ["a", "g"]
            .map(|name| HashedFile { file: format!("{name}, {k}.csv"), sha256: format!("{sensor}{name}{k}") })
            .into(),
        verdict: KeptVerdict {
            usability: Usability::Doubtful,
            codes: vec!["coarse-steps".into(), "sampling-gap".into()],
        },
        status: "converged".into(),
        imu: imu(k),
    }
}

pub(super) fn without_codes(usability: Usability) -> KeptVerdict {
    KeptVerdict { usability, codes: Vec::new() }
}

pub(super) fn place() -> (tempfile::TempDir, PathBuf) {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("new/records.db");
    (directory, path)
}

fn refused(path: &Path) -> (Refusal, String) {
    let error = Records::open(path).expect_err("refused");
    (error.code(), error.to_string())
}

#[test]
fn a_record_comes_back_to_the_last_bit() {
    let (_directory, path) = place();
    let mut records = Records::open(&path).expect("made");
    let mut symmetric = record("S", 3);
    // the off-diagonal entries of the accelerometer in pairs
    let of_accelerometer = |quantity: &ImuQuantity| {
        matches!(quantity, ImuQuantity::Of(SensorKind::Accelerometer, Quantity::CrossAxis(..)))
    };
    symmetric.imu.quantities.retain(|quantity| !of_accelerometer(quantity));
    let size = symmetric.imu.quantities.len();
    symmetric.imu.covariance = symmetric.imu.covariance.map(|sigma| sigma.view((0, 0), (size, size)).into());
    symmetric.imu.shared = None;
    let mut warm = record("T", 4);
    warm.imu.quantities.extend(ImuQuantity::all_thermal(true, false));
    let size = warm.imu.quantities.len();
    warm.imu.parameters.thermal[SensorKind::Accelerometer].bias[0].x = 1.0 / 3.0;
    (warm.imu.parameters.thermal.reference_c, warm.imu.parameters.thermal.range_c) =
        (31.7, Some([-10.1, 60.3]));
    warm.imu.covariance = Some(DMatrix::identity(size, size) * 0.1);
    warm.imu.shared = None;
    let bare = Record {
        recorded: None,
        station: None,
        experiment: None,
        motion_file: None,
        verdict: without_codes(Usability::Doubtful),
        imu: CalibratedImu { covariance: None, degrees_of_freedom: None, shared: None, ..imu(5) },
        ..record("U", 5)
    };
    for (k, expected) in [record("A", 1), record("A", 2), symmetric, warm, bare].into_iter().enumerate() {
        let inserted = records.insert(&expected).expect("inserted");
        assert_eq!(inserted, Inserted { id: k as i64 + 1, replaced: false });
        let kept = records.get(inserted.id).expect("read").expect("there");
        assert_eq!(kept.record, expected);
    }
    assert_eq!(records.get(99).expect("read"), None);
    let models: i64 =
        records.connection.query_row("SELECT count(*) FROM models", [], |row| row.get(0)).expect("read");
    assert_eq!(models, 3, "equal models are one; so are those with and without a covariance");
}

#[test]
fn one_recording_by_one_experiment_motion_and_program_is_there_once() {
    let (_directory, path) = place();
    let mut records = Records::open(&path).expect("made");
    records.insert_all((0..2500).map(|k| record("A", k))).expect("inserted");
    let again =
        Record { station: None, verdict: without_codes(Usability::Ok), imu: imu(9), ..record("A", 7) };
    let replaced = records.insert(&again).expect("inserted");
    assert_eq!(replaced, Inserted { id: 8, replaced: true });
    assert_eq!(records.count().expect("read"), 2500);
    assert_eq!(records.get(8).expect("read").expect("there").record, again);
    let newer = Record { program: "calibrant 1.1.0".into(), ..again.clone() };
    assert_eq!(records.insert(&newer).expect("inserted"), Inserted { id: 2501, replaced: false });
    let motion_file = Some(HashedFile { file: "log.csv".into(), sha256: "n".into() });
    let by_another_motion = Record { motion_file, ..again.clone() };
    let inserted = records.insert(&by_another_motion).expect("inserted");
    assert_eq!(inserted, Inserted { id: 2502, replaced: false });
    assert_eq!(records.get(8).expect("read").expect("there").record, again);
    let all = |latest| {
        let list = records.list(&RecordFilter { latest, ..Default::default() }).expect("read");
        list.into_iter().map(|kept| kept.id).collect::<Vec<_>>()
    };
    assert_eq!(all(false).len(), 2502);
    let latest = all(true);
    assert!(latest.len() == 2500 && latest.contains(&2502), "the three are of one recording");
    assert_eq!(records.insert_all((0..2500).map(|k| record("A", k))).expect("inserted"), 0);
}

#[test]
fn records_are_found_by_sensor_station_and_verdict_in_order_of_their_dates() {
    let (_directory, path) = place();
    let mut records = Records::open(&path).expect("made");
    let undated = Record { recorded: None, ..record("A", 40) };
    let bad = Record { verdict: without_codes(Usability::Bad), station: None, ..record("B", 3) };
    records.insert_all([record("A", 5), undated, record("A", 2), bad]).expect("inserted");
    let ids = |filter: RecordFilter| -> Vec<i64> {
        records.list(&filter).expect("read").iter().map(|kept| kept.id).collect()
    };
    assert_eq!(ids(RecordFilter::default()), [2, 3, 1, 4]);
    assert_eq!(ids(RecordFilter { sensor: Some("A".into()), latest: true, ..Default::default() }), [2, 3, 1]);
    assert_eq!(ids(RecordFilter { verdict: Some(Usability::Bad), ..Default::default() }), [4]);
    assert_eq!(ids(RecordFilter { station: Some("L1' OR 1".into()), ..Default::default() }), [0; 0]);
    assert_eq!(
        ids(RecordFilter { station: Some("L1".into()), sensor: Some("B".into()), ..Default::default() }),
        [0; 0]
    );
}

#[test]
fn what_is_not_ours_is_refused_and_stays_as_it_is() {
    let (directory, path) = place();
    let other = directory.path().join("other.db");
    Connection::open(&other).expect("made").execute_batch("CREATE TABLE t (x)").expect("made");
    let text = directory.path().join("notes.csv");
    std::fs::write(&text, "t,x\n").expect("written");
    for (file, says) in [(&other, "SQLite database of another program"), (&text, "is no database of records")]
    {
        let before = std::fs::read(file).expect("there");
        let (code, message) = refused(file);
        assert!(code == Refusal::FormatUnknown && message.contains(says), "{message}");
        assert_eq!(std::fs::read(file).expect("there"), before);
    }
    let missing = Records::open_existing(&path).expect_err("missing");
    assert_eq!(missing.code(), Refusal::FileUnreadable);
    assert!(!path.exists(), "a question makes no database");
    assert_eq!(refused(directory.path()).0, Refusal::FileUnreadable, "a directory");
}

#[test]
fn another_schema_is_refused_and_says_so() {
    let (_directory, path) = place();
    let records = Records::open(&path).expect("made");
    records.connection.pragma_update(None, "user_version", 7).expect("written");
    drop(records);
    let (code, message) = refused(&path);
    assert_eq!(code, Refusal::FormatUnsupported);
    assert!(message.contains("version 7 of the schema, and this calibrant reads version 4"), "{message}");
    // versions 0 to 2 of our own file were never released
    for version in [0, 1] {
        let opened = Connection::open(&path);
        opened.and_then(|it| it.pragma_update(None, "user_version", version)).expect("written");
        let (code, message) = refused(&path);
        assert_eq!(code, Refusal::FormatUnsupported);
        assert!(message.contains(&format!("have version {version} of the schema")), "{message}");
    }
}

#[test]
fn damage_is_an_error() {
    let (_directory, path) = place();
    let mut records = Records::open(&path).expect("made");
    records.insert_all((0..50).map(|k| record("A", k))).expect("inserted");
    for harm in [
        "UPDATE calibrations SET covariance = x'00' WHERE id = 7",
        "DELETE FROM parameters WHERE calibration = 7 AND place = 3",
        "UPDATE models SET text = '{}'",
        "UPDATE calibrations SET degrees = x'0011223344556677' WHERE id = 7",
        // values that a record could have
        "UPDATE parameters SET value = value + 1e-9 WHERE calibration = 7 AND place = 3",
        "UPDATE parameters SET sd = -sd WHERE calibration = 7 AND place = 3",
        "UPDATE calibrations SET covariance = zeroblob(length(covariance)) WHERE id = 7",
        "UPDATE calibrations SET recorded = '2020-01-01' WHERE id = 7",
        "UPDATE shared_errors SET sources = replace(sources, 'wrist', 'elbow') WHERE calibration = 7",
        "DELETE FROM shared_errors WHERE calibration = 7",
        "UPDATE models SET text = replace(text, 'robot', 'rabot')",
    ] {
        let transaction = records.connection.transaction().expect("begun");
        transaction.execute(harm, []).expect("done");
        transaction.commit().expect("done");
        let error = records.get(7).expect_err(harm);
        assert_eq!(error.code(), Refusal::FileDamaged, "{harm}: {error}");
        records.insert(&record("A", 6)).expect("written again");
    }
    drop(records);
    let mut bytes = std::fs::read(&path).expect("there");
    for byte in &mut bytes[16_384..] {
        *byte = 0x5a;
    }
    std::fs::write(&path, bytes).expect("written");
    let error =
        Records::open(&path).and_then(|records| records.list(&RecordFilter::default())).expect_err("damaged");
    assert_eq!(error.code(), Refusal::FileDamaged, "{error}");
}

#[test]
fn writers_at_once_lose_nothing() {
    let (_directory, path) = place();
    std::thread::scope(|scope| {
        for writer in ["A", "B", "C", "D"] {
            let path = &path;
            scope.spawn(move || {
                // they also make the database at once
                let mut records = Records::open(path).expect("opened");
                for k in 0..50 {
                    records.insert(&record(writer, k)).expect("inserted");
                }
            });
        }
    });
    let records = Records::open_existing(&path).expect("opened");
    assert_eq!(records.list(&RecordFilter::default()).expect("whole").len(), 200);
}

#[test]
fn a_writer_that_ends_within_a_transaction_leaves_what_it_finished() {
    let (_directory, path) = place();
    let mut records = Records::open(&path).expect("made");
    records.insert_all((0..20).map(|k| record("A", k))).expect("inserted");
    // its pages and journal, as they are on the disk in the middle of a transaction that has spilled
    records.connection.execute_batch("PRAGMA cache_size = 1; BEGIN IMMEDIATE; UPDATE calibrations SET sensor = 'X' || sensor; DELETE FROM parameters").expect("begun");
    let journal = |path: &Path| PathBuf::from(format!("{}-journal", path.display()));
    let copy = path.with_file_name("copy.db");
    std::fs::copy(&path, &copy).expect("copied");
    std::fs::copy(journal(&path), journal(&copy)).expect("copied");
    assert_ne!(std::fs::read(&copy).expect("read"), Vec::<u8>::new());
    let restored = Records::open_existing(&copy).expect("opened");
    let kept = restored.list(&RecordFilter::default()).expect("whole");
    assert_eq!(
        kept.iter().map(|kept| &kept.record).collect::<Vec<_>>(),
        (0..20).map(|k| record("A", k)).collect::<Vec<_>>().iter().collect::<Vec<_>>()
    );
    assert!(!journal(&copy).exists());
}

#[test]
fn a_table_has_a_row_for_each_calibration_and_reads_back_to_the_last_bit() {
    let (directory, path) = place();
    let mut records = Records::open(&path).expect("made");
    let mut counts = record("=B", 2);
    counts.imu.units[SensorKind::Accelerometer] = Some(ReadingUnit::Counts);
    let bare = Record { recorded: None, imu: CalibratedImu { covariance: None, ..imu(1) }, ..record("A", 1) };
    records.insert_all([bare, counts]).expect("inserted");
    let table = directory.path().join("t.csv");
    assert_eq!(records.export(&table, &RecordFilter::default()).expect("written"), 2);
    let text = std::fs::read_to_string(&table).expect("read");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().expect("a header").clone();
    let rows: Vec<csv::StringRecord> = reader.records().map(|row| row.expect("whole")).collect();
    let field = |row: usize, name: &str| {
        let place = header.iter().position(|found| found == name).unwrap_or_else(|| panic!("{name}"));
        rows[row][place].to_owned()
    };
    // by the order of the sensors' names
    let (b, a) = (0, 1);
    assert_eq!(
        (field(a, "sensor"), field(b, "sensor")),
        ("A".into(), "'=B".into()),
        "no formula for a spreadsheet"
    );
    assert_eq!((field(a, "recorded"), field(b, "recorded")), (String::new(), "2026-05-03".into()));
    assert_eq!(field(a, "recording"), "a, 1.csv, g, 1.csv");
    // a quantity in two units has a column for each
    let value = imu(1).parameters[SensorKind::Accelerometer].bias.y;
    assert_eq!(field(a, "accelerometer.bias.y_mps2").parse(), Ok(value));
    assert_eq!(field(b, "accelerometer.bias.y_mps2"), "");
    assert_ne!(field(b, "accelerometer.bias.y_counts"), "");
    assert_eq!(field(a, "gyroscope.scale.x_sd_counts_per_radps"), "", "no covariance");
    let sd = imu(2).covariance.expect("there")[(1, 1)].sqrt();
    assert_eq!(field(b, "accelerometer.bias.y_sd_counts").parse(), Ok(sd));

    #[cfg(feature = "parquet")]
    {
        use parquet::file::reader::{FileReader, SerializedFileReader};
        use parquet::record::Field;
        let table = directory.path().join("t.parquet");
        records.export(&table, &RecordFilter::default()).expect("written");
        let file = SerializedFileReader::new(std::fs::File::open(&table).expect("there")).expect("Parquet");
        let mut found = 0;
        for (row, read) in file.get_row_iter(None).expect("rows").enumerate() {
            for (name, value) in read.expect("a row").get_column_iter() {
                let text = field(row, name);
                match value {
                    Field::Null => assert_eq!(text, ""),
                    Field::Double(number) => assert_eq!(text.parse(), Ok(*number), "{name}"),
                    Field::Long(id) => assert_eq!(text.parse(), Ok(*id)),
                    Field::Str(read) => assert_eq!(text.trim_start_matches('\''), read),
                    other => panic!("{name}: {other:?}"),
                }
                found += 1;
            }
        }
        assert_eq!(found, 2 * header.len());
    }
}
