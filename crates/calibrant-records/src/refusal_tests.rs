//! Tests of what the records refuse, and of what is removed from them.

use super::database::check_writable;
use super::tests::{place, record};
use super::*;
use calibrant_core::error::{Error, Refusal};
use calibrant_io::HashedFile;
use rusqlite::{Connection, OpenFlags};

#[test]
fn a_recording_of_one_sensor_is_not_that_of_another() {
    let (_directory, path) = place();
    let mut records = Records::open(&path).expect("made");
    records.insert_all([record("A", 1), record("A", 2)]).expect("inserted");
    let copy = Record { sensor: "B".into(), ..record("A", 2) };
    let by_others = Record { program: "calibrant 2.0.0".into(), experiment: None, ..copy.clone() };
    for repeated in [&copy, &by_others] {
        let refused = records.insert(repeated).expect_err("refused");
        assert!(refused.code() == Refusal::RecordingRepeated && refused.is_invalid_recording(), "{refused}");
        let says = " as calibration 2 of sensor \"A\": is it of that sensor or of \"B\"?";
        assert!(refused.to_string().contains(says), "{refused}");
        assert!(refused.to_string().contains("remove calibration 2 with `calibrant records remove`"));
        let before = records.refuse_repeated("B", &repeated.recordings).expect_err("refused");
        assert_eq!(before.to_string(), refused.to_string());
    }
    // nothing of the call is added
    let error = records.insert_all([record("C", 7), copy.clone()]).expect_err("refused");
    assert_eq!((error.code(), records.count().expect("read")), (Refusal::RecordingRepeated, 2));
    // one of the two files alone is another recording
    let mut half = copy.clone();
    half.recordings[1] = HashedFile { file: "h.csv".into(), sha256: "h".into() };
    records.refuse_repeated("B", &half.recordings).expect("another recording");
    records.refuse_repeated("A", &copy.recordings).expect("of that sensor");
    // the earlier name was wrong
    records.remove(&[2]).expect("removed");
    assert!(!records.insert(&copy).expect("inserted").replaced);
}

#[test]
fn calibrations_are_removed_together_or_not_at_all() {
    let (_directory, path) = place();
    let mut records = Records::open(&path).expect("made");
    records.insert_all((0..5).map(|k| record("A", k))).expect("inserted");
    let error = records.remove(&[2, 99, 3]).expect_err("unknown");
    assert_eq!(error.code(), Refusal::ValueInvalid);
    assert!(error.to_string().contains("there is no calibration 99"), "{error}");
    assert_eq!(records.count().expect("read"), 5);
    records.remove(&[2, 4, 2]).expect("removed");
    let ids: Vec<i64> =
        records.list(&RecordFilter::default()).expect("read").iter().map(|kept| kept.id).collect();
    assert_eq!(ids, [1, 3, 5]);
    let parameters: i64 = records
        .connection
        .query_row("SELECT count(DISTINCT calibration) FROM parameters", [], |row| row.get(0))
        .expect("read");
    assert_eq!(parameters, 3, "their parameters went with them");
    records.remove(&[5]).expect("removed");
    assert_eq!(records.insert(&record("A", 9)).expect("inserted").id, 6, "a number is not given again");
}

#[test]
fn an_empty_file_has_no_records_and_stays_empty() {
    let (directory, _) = place();
    let path = directory.path().join("empty.db");
    std::fs::write(&path, "").expect("written");
    let error = Records::open_existing(&path).expect_err("empty");
    assert_eq!(error.code(), Refusal::FormatUnknown);
    assert!(error.to_string().contains("this file is empty"), "{error}");
    assert_eq!(std::fs::read(&path).expect("there"), b"");
    // nor does a writer make a database of it
    assert_eq!(Records::open(&path).expect_err("empty").code(), Refusal::FormatUnknown);
    assert_eq!(std::fs::read(&path).expect("there"), b"");
}

#[test]
fn a_database_that_is_opened_to_be_read_is_not_writable() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("records.db");
    drop(Records::open(&path).expect("made"));
    let read_only = Connection::open_with_flags(&path, OpenFlags::SQLITE_OPEN_READ_ONLY);
    let error = check_writable(&mut read_only.expect("opened"), &path).expect_err("read-only");
    assert!(error.to_string().ends_with("the file is read-only"), "{error}");
    let queries_only = Connection::open(&path).expect("opened");
    queries_only.pragma_update(None, "query_only", true).expect("set");
    let error = check_writable(&mut { queries_only }, &path).expect_err("no writing");
    assert!(matches!(error, Error::Output { .. }), "{error}");
}

/// Permissions do not bind root. The longest name that a file may have leaves no room for the ending of a journal.
#[test]
fn a_database_beside_which_no_journal_can_stand_is_refused_before_the_work() {
    let directory = tempfile::tempdir().expect("a directory");
    let short = directory.path().join("records.db");
    drop(Records::open(&short).expect("made"));
    let long = directory.path().join("r".repeat(252) + ".db");
    std::fs::rename(&short, &long).expect("renamed");
    assert_eq!(Records::open_existing(&long).expect("can be read").count().expect("read"), 0);
    let before = std::fs::read(&long).expect("there");
    let error = Records::open(&long).expect_err("no journal");
    assert!(error.to_string().ends_with("no journal can be made beside it"), "{error}");
    assert_eq!(std::fs::read(&long).expect("there"), before);
}

#[test]
fn views_and_triggers_of_a_file_are_not_used() {
    let (_directory, path) = place();
    let mut records = Records::open(&path).expect("made");
    records.insert(&record("A", 1)).expect("inserted");
    drop(records);
    let endless =
        "WITH RECURSIVE n (i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT c.* FROM calibrations c, n";
    let hostile = Connection::open(&path).expect("opened");
    hostile.execute_batch(&format!("DROP VIEW latest; CREATE VIEW latest AS {endless};")).expect("made");
    let nothing = "CREATE TRIGGER t BEFORE INSERT ON calibrations BEGIN SELECT raise(IGNORE); END";
    hostile.execute_batch(nothing).expect("made");
    let mut records = Records::open(&path).expect("opened");
    records.insert(&record("A", 2)).expect("inserted");
    let latest = RecordFilter { latest: true, ..RecordFilter::default() };
    assert_eq!(records.list(&latest).expect("read").len(), 2);
    drop(records);
    hostile
        .execute_batch(&format!("DROP TABLE parameters; CREATE VIEW parameters AS {endless}"))
        .expect("made");
    let error = Records::open(&path).expect_err("refused");
    assert_eq!(error.code(), Refusal::FileDamaged, "{error}");
}
