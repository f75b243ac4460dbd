//! Tests of databases that have an older version of the schema.

use super::tests::{place, record};
use super::*;
use std::path::Path;

/// A database of version 1 with these records. Version 1 does not know their motion.
fn write_version_1(path: &Path, records: impl IntoIterator<Item = Record>) {
    let newer = path.with_extension("newer");
    Records::open(&newer).expect("made").insert_all(records).expect("inserted");
    let old = schema::of_version(path, 1).expect("made");
    old.execute("ATTACH ? AS newer", [newer.to_str()]).expect("attached");
    old.execute_batch(
        "INSERT INTO models SELECT * FROM newer.models;
         INSERT INTO names SELECT * FROM newer.names;
         INSERT INTO calibrations
             SELECT id, sensor, recorded, inserted, station, program, plan, experiment, experiment_sha256, recording, recording_sha256,
                 verdict, codes, status, model, reference_c, least_c, greatest_c, degrees, covariance FROM newer.calibrations;
         INSERT INTO parameters SELECT * FROM newer.parameters;",
    )
    .expect("copied");
    let version: i32 = old.pragma_query_value(None, "user_version", |row| row.get(0)).expect("there");
    assert_eq!(version, 1);
}

#[test]
fn version_1_becomes_version_2_and_loses_nothing() {
    let (directory, _) = place();
    let path = directory.path().join("old.db");
    let bare = Record { motion_file: None, ..record("B", 3) };
    write_version_1(&path, (0..30).map(|k| record("A", k)).chain([bare.clone()]));
    let mut records = Records::open_existing(&path).expect("brought up to date");
    let version = |name: &str| {
        records.connection.pragma_query_value(None, name, |row| row.get::<_, i32>(0)).expect("there")
    };
    assert_eq!((version("user_version"), version("foreign_keys")), (2, 1));
    for k in 0..30 {
        let kept = records.get(k + 1).expect("read").expect("there");
        assert_eq!(kept.record, Record { motion_file: None, ..record("A", k as usize) });
    }
    assert_eq!(records.get(31).expect("read").expect("there").record, bare);
    // views, index and foreign keys are those of a new database
    let objects = |records: &Records| {
        let query = "SELECT type || ' ' || name || ' ' || tbl_name FROM sqlite_schema ORDER BY 1";
        let mut statement = records.connection.prepare(query).expect("a query");
        let rows = statement.query_map([], |row| row.get::<_, String>(0)).expect("rows");
        rows.collect::<Result<Vec<_>, _>>().expect("names")
    };
    let new = Records::open(&directory.path().join("new.db")).expect("made");
    assert_eq!(objects(&records), objects(&new));
    let broken: i64 = records
        .connection
        .query_row("SELECT count(*) FROM pragma_foreign_key_check", [], |row| row.get(0))
        .expect("checked");
    assert_eq!(broken, 0);
    // the same again replaces, with its parameters; by a motion that is known, it is another calibration
    assert!(records.insert(&bare).expect("inserted").replaced);
    assert!(!records.insert(&record("A", 7)).expect("inserted").replaced);
    assert_eq!(records.count().expect("read"), 32);
    assert_eq!(records.list(&RecordFilter { latest: true, ..Default::default() }).expect("whole").len(), 31);
}

#[test]
fn readers_and_writers_that_open_an_older_version_at_once_lose_nothing() {
    let (directory, _) = place();
    let path = directory.path().join("old.db");
    write_version_1(&path, (0..50).map(|k| record("A", k)));
    std::thread::scope(|scope| {
        for reader in 0..8 {
            let path = &path;
            scope.spawn(move || {
                if reader % 2 == 0 {
                    let records = Records::open_existing(path).expect("opened");
                    assert!(records.list(&RecordFilter::default()).expect("whole").len() >= 50);
                } else {
                    let new = record(&format!("B{reader}"), reader);
                    Records::open(path).expect("opened").insert(&new).expect("inserted");
                }
            });
        }
    });
    let records = Records::open_existing(&path).expect("opened");
    assert_eq!(records.list(&RecordFilter::default()).expect("whole").len(), 54);
}
