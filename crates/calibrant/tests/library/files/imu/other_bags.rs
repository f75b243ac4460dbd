//! Tests of bags that are no MCAP: ROS 2's SQLite databases, written with rusqlite, and ROS 1's bags, with a writer of their own.

use super::findings;
use super::ros_bag::{IMU, bag, message};
use calibrant::diagnostic::Check;
use calibrant::diagnostic::reader::LogPassedOver;
use calibrant::io::{
    FileFormat, ImuFile, ImuReadOptions, ReferenceFormat, ReferenceLogOptions, parse_imu_recording,
    parse_reference_log,
};
use rusqlite::{Connection, params};
use std::io::Write;

fn read(bytes: &[u8]) -> ImuFile {
    parse_imu_recording(bytes, &ImuReadOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(bytes: &[u8]) -> String {
    parse_imu_recording(bytes, &ImuReadOptions::default()).expect_err("refused").to_string()
}

/// A bag in an SQLite database with pages of this size: topics with type and messages.
pub(crate) fn db3(page_size: usize, topics: &[(&str, &str, Vec<Vec<u8>>)]) -> Vec<u8> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("bag_0.db3");
    let mut database = Connection::open(&path).expect("a database");
    let made = format!(
        "PRAGMA page_size = {page_size};
         CREATE TABLE schema(schema_version INTEGER PRIMARY KEY,ros_distro TEXT NOT NULL);
         CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,serialization_format TEXT NOT NULL,offered_qos_profiles TEXT NOT NULL);
         CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp INTEGER NOT NULL, data BLOB NOT NULL);
         CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
    );
    database.execute_batch(&made).expect("made");
    let all = database.transaction().expect("begun");
    for (k, (name, kind, messages)) in topics.iter().enumerate() {
        let topic = 3 + k as i64;
        let values = params![topic, name, kind, "cdr", "x".repeat(700)];
        all.execute("INSERT INTO topics VALUES (?, ?, ?, ?, ?)", values).expect("added");
        for (time, data) in messages.iter().enumerate() {
            let values = params![topic, 1_700_000_000_000_000_000 + 1000 * time as i64, data];
            all.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)", values)
                .expect("added");
        }
    }
    all.commit().expect("written");
    drop(database);
    std::fs::read(&path).expect("there")
}

#[test]
fn a_database_has_the_messages_that_mcap_has() {
    let messages: Vec<Vec<u8>> = (0..400).map(message).collect();
    let chatter = || ("/chatter", "std_msgs/msg/String", vec![vec![0, 1, 0, 0, 1, 0, 0, 0, 0]; 3]);
    let expected = read(&bag(&[("/imu", IMU, "cdr", messages.clone())]));
    for page_size in [512, 4096, 65_536] {
        let file = read(&db3(page_size, &[chatter(), ("/imu", IMU, messages.clone())]));
        assert_eq!((file.format, file.rows), (FileFormat::Db3, 400));
        assert_eq!(
            (&file.recording, &file.findings),
            (&expected.recording, &expected.findings),
            "{page_size}"
        );
    }
    // as rosbag2 compresses messages
    let packed = messages.iter().map(|one| zstd::bulk::compress(one, 1).expect("compressed")).collect();
    assert_eq!(read(&db3(4096, &[("/imu", IMU, packed)])).recording, expected.recording);
    let two = db3(4096, &[("/a", IMU, messages.clone()), ("/b", IMU, messages)]);
    assert!(refused(&two).contains("/a (400 messages), /b (400 messages)"));
}

#[test]
fn a_database_that_is_no_bag_is_refused_by_its_tables() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("log.db3");
    let database = Connection::open(&path).expect("a database");
    database.execute_batch("CREATE TABLE imu(t REAL, ax REAL); CREATE TABLE other(x);").expect("made");
    drop(database);
    let said = refused(&std::fs::read(&path).expect("there"));
    assert!(
        said.contains("no bag of ROS 2: its tables are imu, other")
            && said.contains("sqlite3 -header -csv FILE"),
        "{said}"
    );
    assert!(refused(b"SQLite format 3\0").contains("the SQLite database is damaged: it ends too early"));
}

#[test]
fn a_database_whose_messages_are_beside_it_is_refused() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("bag.db3");
    std::fs::write(&path, db3(4096, &[("/imu", "sensor_msgs/msg/Imu", (0..3).map(message).collect())]))
        .expect("written");
    let read = || calibrant::io::read_imu_recording(&path, &ImuReadOptions::default());
    assert!(read().is_ok());
    let log = directory.path().join("bag.db3-wal");
    std::fs::write(&log, "").expect("written");
    assert!(read().is_ok(), "an empty log holds nothing");
    std::fs::write(&log, "rows").expect("written");
    let error = read().expect_err("rows beside it").to_string();
    assert!(error.contains("bag.db3-wal") && error.contains("wal_checkpoint"), "{error}");
}

#[test]
fn a_damaged_database_is_refused_and_never_followed_in_circles() {
    let whole = db3(512, &[("/imu", IMU, (0..20).map(message).collect())]);
    for length in (0..whole.len()).step_by(97) {
        let _ = parse_imu_recording(&whole[..length], &ImuReadOptions::default());
    }
    for at in (16..whole.len()).step_by(13) {
        for value in [0, 1, 5, 13, 255] {
            let mut broken = whole.clone();
            broken[at] = value;
            let _ = parse_imu_recording(&broken, &ImuReadOptions::default());
        }
    }
}

/// A record of a ROS 1 bag.
fn record(head: &[(&str, &[u8])], data: &[u8]) -> Vec<u8> {
    let fields: Vec<u8> = head
        .iter()
        .flat_map(|(name, value)| {
            let field = [name.as_bytes(), b"=", value].concat();
            [&(field.len() as u32).to_le_bytes()[..], &field].concat()
        })
        .collect();
    let length = |bytes: &[u8]| (bytes.len() as u32).to_le_bytes();
    [&length(&fields)[..], &fields, &length(data), data].concat()
}

fn connection(number: u32, topic: &str, kind: &str) -> Vec<u8> {
    let data = record(&[("topic", topic.as_bytes()), ("type", kind.as_bytes()), ("md5sum", b"*")], b"");
    let fields = &data[4..data.len() - 4];
    record(&[("op", &[7]), ("conn", &number.to_le_bytes()), ("topic", topic.as_bytes())], fields)
}

fn logged(number: u32, time_ns: u64, message: &[u8]) -> Vec<u8> {
    let [s, ns] = [time_ns / 1_000_000_000, time_ns % 1_000_000_000].map(|part| (part as u32).to_le_bytes());
    record(&[("op", &[2]), ("conn", &number.to_le_bytes()), ("time", &[s, ns].concat())], message)
}

/// A bag of these records in two chunks.
fn ros1(compression: &str, records: &[Vec<u8>]) -> Vec<u8> {
    let mut bag = b"#ROSBAG V2.0\n".to_vec();
    bag.extend(record(&[("op", &[3]), ("chunk_count", &2_u32.to_le_bytes())], &[b' '; 4000]));
    for part in records.chunks(records.len().div_ceil(2)) {
        let records = part.concat();
        let packed = match compression {
            "lz4" => {
                let mut encoder = lz4_flex::frame::FrameEncoder::new(Vec::new());
                encoder.write_all(&records).expect("packed");
                encoder.finish().expect("packed")
            }
            _ => records.clone(),
        };
        let size = (records.len() as u32).to_le_bytes();
        bag.extend(record(
            &[("op", &[5]), ("compression", compression.as_bytes()), ("size", &size)],
            &packed,
        ));
        bag.extend(record(&[("op", &[4]), ("conn", &[0; 4])], &[0; 12]));
    }
    bag
}

/// A header of ROS 1, with its number.
fn header(k: u64) -> Vec<u8> {
    let time_ns = 1_700_000_000_123_456_789 + 5_000_000 * k;
    let [s, ns] = [time_ns / 1_000_000_000, time_ns % 1_000_000_000].map(|part| part as u32);
    [&[k as u32, s, ns, 8].map(u32::to_le_bytes).concat()[..], b"imu_link"].concat()
}

fn numbers(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// Message `k` as [`message`] has it, in the encoding of ROS 1.
fn ros1_message(k: u64) -> Vec<u8> {
    let x = k as f64;
    let none = [0.0; 9];
    let parts = [&[0.0, 0.0, 0.0, 1.0][..], &none, &[0.1 * x, 0.2, -0.1], &none, &[0.3, 9.7, 0.1 * x], &none];
    [header(k), numbers(&parts.concat())].concat()
}

#[test]
fn a_bag_of_ros_1_has_the_messages_that_mcap_has() {
    let expected = read(&bag(&[("/imu", IMU, "cdr", (0..50).map(message).collect())]));
    let mut records =
        vec![connection(0, "/imu", "sensor_msgs/Imu"), connection(1, "/chatter", "std_msgs/String")];
    records.extend((0..50).map(|k| logged(0, 1_700_000_000_000_000_000 + k, &ros1_message(k))));
    for compression in ["none", "lz4"] {
        let bytes = ros1(compression, &records);
        let file = read(&bytes);
        assert_eq!(file.format, FileFormat::Rosbag);
        assert_eq!((&file.recording, &file.findings), (&expected.recording, &expected.findings));
        // a recorder that was killed: the records that are whole are read, and what is lost is said
        let cut = read(&bytes[..bytes.len() - 60]);
        assert!(
            cut.rows < 50 && cut.findings.iter().any(|found| found.code() == LogPassedOver::CODE),
            "{:?}",
            findings(&cut)
        );
        for length in (0..bytes.len()).step_by(101) {
            let _ = parse_imu_recording(&bytes[..length], &ImuReadOptions::default());
        }
    }
    let said = refused(&ros1("bz2", &records));
    assert!(said.contains("compressed with bz2") && said.contains("rosbag decompress FILE.bag"), "{said}");
    assert!(refused(&ros1("none", &records[1..])).contains("/chatter (std_msgs/String)"));
    let of_mcap = bag(&[("/imu", "sensor_msgs/Imu", "ros1", (0..50).map(ros1_message).collect())]);
    assert_eq!(
        read(&of_mcap).recording,
        expected.recording,
        "a bag that was converted to MCAP keeps the encoding"
    );
    assert!(refused(b"#ROSBAG V2.0\n").contains("it ends before any message"));
}

#[test]
fn logs_of_joints_are_read_of_all_bags() {
    let joints = |k: u64| {
        let names =
            [&2_u32.to_le_bytes()[..], &1_u32.to_le_bytes(), b"a", &1_u32.to_le_bytes(), b"b"].concat();
        let positions = [&2_u32.to_le_bytes()[..], &numbers(&[0.1 * k as f64, -0.5])].concat();
        [header(k), names, positions, vec![0; 8]].concat()
    };
    let mut records = vec![connection(4, "/joint_states", "sensor_msgs/JointState")];
    records.extend((0..9).map(|k| logged(4, k, &joints(k))));
    let file = parse_reference_log(&ros1("none", &records), &ReferenceLogOptions::default()).expect("a log");
    assert_eq!(file.format, ReferenceFormat::Rosbag);
    let log = file.joints().expect("joints");
    assert_eq!((log.names.join(" "), log.row(3)), ("a b".to_owned(), &[0.1 * 3.0, -0.5][..]));
}
