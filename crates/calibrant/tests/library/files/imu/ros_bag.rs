//! Tests of ROS 2 bags, written with the crate `mcap`.

use super::findings;
use calibrant::diagnostic::Check;
use calibrant::diagnostic::reader::FileUnfinished;
use calibrant::io::{
    ColumnMapping, FileFormat, ImuFile, ImuReadOptions, parse_imu_recording, read_imu_recording,
};
use calibrant::sensor::SensorKind;
use mcap::records::MessageHeader;
use std::collections::BTreeMap;
use std::io::Cursor;

/// A message `sensor_msgs/msg/Imu` in little-endian CDR.
fn cdr(stamp_ns: u64, frame: &str, rate: [f64; 3], force: [f64; 3], absent: [bool; 2]) -> Vec<u8> {
    let mut bytes = Vec::new();
    bytes.extend(((stamp_ns / 1_000_000_000) as i32).to_le_bytes());
    bytes.extend(((stamp_ns % 1_000_000_000) as u32).to_le_bytes());
    bytes.extend((frame.len() as u32 + 1).to_le_bytes());
    bytes.extend(frame.bytes().chain([0]));
    while !bytes.len().is_multiple_of(8) {
        bytes.push(0);
    }
    let covariance = |absent: bool| [if absent { -1.0 } else { 0.0 }, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let numbers = [0.0, 0.0, 0.0, 1.0].into_iter().chain(covariance(true));
    let numbers = numbers.chain(rate).chain(covariance(absent[0])).chain(force).chain(covariance(absent[1]));
    numbers.for_each(|number: f64| bytes.extend(number.to_le_bytes()));
    [vec![0, 1, 0, 0], bytes].concat()
}

/// The first time stamp, ns.
const STAMP: u64 = 1_700_000_000_123_456_789;

pub(crate) fn message(k: u64) -> Vec<u8> {
    let x = k as f64;
    message_of(k, [0.1 * x, 0.2, -0.1], [0.3, 9.7, 0.1 * x])
}

/// Message `k` at 200 Hz with this rate and specific force.
pub(crate) fn message_of(k: u64, rate: [f64; 3], force: [f64; 3]) -> Vec<u8> {
    cdr(STAMP + 5_000_000 * k, "imu_link", rate, force, [false; 2])
}

/// A bag with these topics: name, type, encoding, messages.
pub(crate) fn bag(topics: &[(&str, &str, &str, Vec<Vec<u8>>)]) -> Vec<u8> {
    bag_with(mcap::WriteOptions::new().compression(None).profile("ros2"), topics)
}

/// A bag of one topic with these messages, each with its log time, in the order of the file.
pub(crate) fn logged_bag(schema: &str, messages: &[(u64, Vec<u8>)]) -> Vec<u8> {
    let options = mcap::WriteOptions::new().compression(None).chunk_size(Some(4096));
    let mut writer = mcap::Writer::with_options(Cursor::new(Vec::new()), options).expect("a writer");
    let schema = writer.add_schema(schema, "ros2msg", b"std_msgs/Header header").expect("a schema");
    let channel_id = writer.add_channel(schema, "/topic", "cdr", &BTreeMap::new()).expect("a channel");
    for (log_time, message) in messages {
        let header = MessageHeader { channel_id, sequence: 0, log_time: *log_time, publish_time: *log_time };
        writer.write_to_known_channel(&header, message).expect("written");
    }
    writer.finish().expect("finished");
    writer.into_inner().into_inner()
}

/// The places of 400 messages in a file that is not in their order: chunks that overlap, the last chunk first, two halves that interleave, each up to eight places off.
pub(crate) fn orders() -> [(&'static str, Vec<u64>); 4] {
    let mut overlapping: Vec<u64> = (0..400).collect();
    overlapping.chunks_exact_mut(100).for_each(|chunk| chunk[90..].rotate_left(4));
    let last_first = (0..8).rev().flat_map(|chunk| 50 * chunk..50 * (chunk + 1)).collect();
    let halves = (0..400).step_by(2).chain((1..400).step_by(2)).collect();
    let near = (0..400).map(|k| k / 8 * 8 + (3 * k) % 8).collect();
    [("overlapping", overlapping), ("last first", last_first), ("halves", halves), ("near", near)]
}

fn bag_with(options: mcap::WriteOptions, topics: &[(&str, &str, &str, Vec<Vec<u8>>)]) -> Vec<u8> {
    let mut writer = mcap::Writer::with_options(Cursor::new(Vec::new()), options).expect("a writer");
    for (topic, schema, encoding, messages) in topics {
        let schema = writer.add_schema(schema, "ros2msg", b"std_msgs/Header header").expect("a schema");
        let channel = writer.add_channel(schema, topic, encoding, &BTreeMap::new()).expect("a channel");
        for (k, message) in messages.iter().enumerate() {
            let time = 1000 * k as u64;
            let header =
                MessageHeader { channel_id: channel, sequence: k as u32, log_time: time, publish_time: time };
            writer.write_to_known_channel(&header, message).expect("written");
        }
    }
    writer.finish().expect("finished");
    writer.into_inner().into_inner()
}

/// The name of the message's type.
pub(crate) const IMU: &str = "sensor_msgs/msg/Imu";

fn one() -> Vec<u8> {
    bag(&[
        ("/chatter", "std_msgs/msg/String", "cdr", vec![vec![0, 1, 0, 0, 1, 0, 0, 0, 0]]),
        ("/imu/data_raw", IMU, "cdr", (0..5).map(message).collect()),
    ])
}

fn read(bytes: &[u8]) -> ImuFile {
    parse_imu_recording(bytes, &ImuReadOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(bytes: &[u8], options: &ImuReadOptions) -> String {
    parse_imu_recording(bytes, options).expect_err("refused").to_string()
}

/// The same bag with its one chunk compressed.
fn compressed(bytes: &[u8], name: &str, compress: impl Fn(&[u8]) -> Vec<u8>) -> Vec<u8> {
    let mut out = mcap::MAGIC.to_vec();
    let record = |out: &mut Vec<u8>, opcode: u8, body: &[u8]| {
        out.push(opcode);
        out.extend((body.len() as u64).to_le_bytes());
        out.extend(body);
    };
    for found in mcap::read::LinearReader::new(bytes).expect("a bag") {
        if let mcap::records::Record::Chunk { header, data } = found.expect("a record") {
            let packed = compress(&data);
            let mut body = Vec::new();
            body.extend(header.message_start_time.to_le_bytes());
            body.extend(header.message_end_time.to_le_bytes());
            body.extend(header.uncompressed_size.to_le_bytes());
            body.extend(header.uncompressed_crc.to_le_bytes());
            body.extend((name.len() as u32).to_le_bytes());
            body.extend(name.bytes());
            body.extend((packed.len() as u64).to_le_bytes());
            body.extend(packed);
            record(&mut out, 6, &body);
        }
    }
    record(&mut out, 15, &[0; 4]);
    record(&mut out, 2, &[0; 20]);
    out.extend(mcap::MAGIC);
    out
}

#[test]
fn a_bag_reads_its_imu() {
    let file = read(&one());
    assert_eq!((file.format, file.rows), (FileFormat::Mcap, 5));
    let (accelerometer, gyroscope) = (
        file.recording[SensorKind::Accelerometer].as_ref().expect("there"),
        file.recording[SensorKind::Gyroscope].as_ref().expect("there"),
    );
    assert_eq!(gyroscope.times_s(), [0.0, 0.005, 0.01, 0.015, 0.02]);
    assert_eq!(gyroscope.readings()[3].as_slice(), [0.1 * 3.0, 0.2, -0.1]);
    assert_eq!(accelerometer.readings()[4].as_slice(), [0.3, 9.7, 0.4]);
    assert_eq!(
        findings(&file)[0],
        "times are counted from the first sample, where `header.stamp` is 1700000000123456789 ns"
    );
    // from a file, whose bytes are no text
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("bag_0.mcap");
    std::fs::write(&path, one()).expect("written");
    assert_eq!(read_imu_recording(&path, &ImuReadOptions::default()).expect("good"), file);
}

#[test]
fn a_bag_compressed_with_zstd_reads_the_same() {
    let plain = one();
    let packed = compressed(&plain, "zstd", |data| zstd::bulk::compress(data, 1).expect("compressed"));
    assert_eq!(read(&packed).recording, read(&plain).recording);
    assert_eq!(
        refused(&compressed(&plain, "xz", <[u8]>::to_vec), &ImuReadOptions::default()),
        "the bag is compressed with xz, which is not read (write it again with zstd: `mcap compress --compression zstd`)"
    );
    let broken = compressed(&plain, "zstd", |data| data[..data.len() / 2].to_vec());
    assert!(
        refused(&broken, &ImuReadOptions::default()).starts_with("the MCAP container is damaged: "),
        "{}",
        refused(&broken, &ImuReadOptions::default())
    );
}

/// The warning about the end of a bag.
fn unfinished(file: &ImuFile) -> Option<String> {
    let found = file.findings.iter().find(|finding| finding.code() == FileUnfinished::CODE)?;
    assert!(found.is_warning());
    Some(found.to_string())
}

/// From a bag that is cut off anywhere, the reader takes all messages that end before the cut, and names the
/// cut.
#[test]
fn a_bag_that_was_cut_off_is_read_as_far_as_it_goes_with_a_warning() {
    let messages: Vec<Vec<u8>> = (0..5).map(message).collect();
    for chunks in [true, false] {
        let options = mcap::WriteOptions::new().compression(None).use_chunks(chunks);
        let whole = bag_with(options, &[("/imu/data_raw", IMU, "cdr", messages.clone())]);
        let end = |message: &Vec<u8>| {
            let start = whole.windows(message.len()).position(|piece| piece == message);
            start.expect("in the bag") + message.len()
        };
        let ends: Vec<usize> = messages.iter().map(end).collect();
        assert_eq!(unfinished(&read(&whole)), None);
        for length in 8..whole.len() {
            let there = ends.iter().filter(|end| **end <= length).count();
            match parse_imu_recording(&whole[..length], &ImuReadOptions::default()) {
                Ok(file) => {
                    assert!(there >= 2 && file.rows == there, "{length}: {} of {there}", file.rows);
                    let message = unfinished(&file).unwrap_or_else(|| panic!("{length}: nothing is said"));
                    let last = ["0.005", "0.01", "0.015", "0.02"][there - 2];
                    let read =
                        format!(": {there} messages were read, the last one {last} s after the first; ");
                    assert!(
                        message.contains(&format!("at byte {length}")) && message.contains(&read),
                        "{message}"
                    );
                }
                Err(error) => {
                    assert!(there < 2, "{length}: {error}");
                    let place = format!("the bag was cut off at byte {length}, within the ");
                    let between = format!("the bag was cut off: it ends at byte {length}, ");
                    let error = error.to_string();
                    assert!(error.contains(&place) || error.contains(&between), "{length}: {error}");
                }
            }
        }
    }
}

#[test]
fn what_a_bag_lacks_is_said() {
    let whole = one();
    let at = |opcode: u8, content: usize| {
        let head = [&[opcode][..], &(content as u64).to_le_bytes()].concat();
        whole.windows(9).position(|piece| piece == head).expect("in the bag")
    };
    let (data_end, footer) = (at(15, 4), at(2, 20));
    let chunk = whole.iter().skip(8 + 9).position(|byte| *byte == 6).expect("there") + 8 + 9;
    let message = |length: usize| unfinished(&read(&whole[..length])).expect("said").to_owned();
    let all = "5 messages were read, the last one 0.02 s after the first";
    let recover = "`mcap recover` makes a whole file of it";
    assert!(
        message(chunk + 2000).starts_with(&format!(
            "the bag was cut off at byte {}, within the chunk of messages that begins at byte {chunk}: ",
            chunk + 2000
        )),
        "{}",
        message(chunk + 2000)
    );
    assert_eq!(
        message(data_end),
        format!(
            "the bag was cut off: it ends at byte {data_end}, without an end of its container: {all}; what was recorded after them is not in the file; {recover}"
        )
    );
    assert_eq!(
        message(footer + 3),
        format!(
            "the bag was cut off: it ends at byte {}, without an end of its container: {all}; no message is missing, only the index is; {recover}",
            footer + 3
        )
    );
    assert_eq!(
        refused(&whole[..chunk + 100], &ImuReadOptions::default()),
        format!(
            "the bag was cut off at byte {}, within the chunk of messages that begins at byte {chunk}, before any message of an IMU (is it a whole copy? was the recorder stopped before it had written anything?)",
            chunk + 100
        )
    );
    // a file that was allocated at its final length
    let padded = [&whole[..data_end], &[0; 4096]].concat();
    assert!(unfinished(&read(&padded)).is_some());
}

#[test]
fn a_compressed_bag_that_was_cut_off_is_read_block_by_block() {
    let plain = bag(&[("/imu", IMU, "cdr", (0..2000).map(message).collect())]);
    let packed = compressed(&plain, "zstd", |data| zstd::bulk::compress(data, 1).expect("compressed"));
    let whole = read(&packed);
    assert_eq!((whole.rows, unfinished(&whole)), (2000, None));
    let mut rows = Vec::new();
    for twentieth in 1..20 {
        let length = packed.len() * twentieth / 20;
        match parse_imu_recording(&packed[..length], &ImuReadOptions::default()) {
            Ok(file) => {
                let message = unfinished(&file).expect("a warning");
                assert!(message.starts_with(&format!("the bag was cut off at byte {length}, ")), "{message}");
                let (part, all) = (
                    file.recording[SensorKind::Gyroscope].clone().expect("there"),
                    whole.recording[SensorKind::Gyroscope].as_ref(),
                );
                assert_eq!(part.readings(), &all.expect("there").readings()[..file.rows]);
                rows.push(file.rows);
            }
            Err(error) => {
                let message = error.to_string();
                assert!(message.starts_with(&format!("the bag was cut off at byte {length}, ")), "{message}");
            }
        }
    }
    assert!(rows.is_sorted() && rows.last().is_some_and(|last| (1000..2000).contains(last)), "{rows:?}");
}

#[test]
fn a_sensor_that_is_not_there_is_left_out() {
    let messages = |absent| {
        let message = |k: u64| cdr(STAMP + 5_000_000 * k, "", [0.1 * k as f64, 0.2, 0.1], [0.0; 3], absent);
        (0..3).map(message).collect::<Vec<_>>()
    };
    let file = read(&bag(&[("/imu", IMU, "cdr", messages([false, true]))]));
    assert!(
        file.recording[SensorKind::Accelerometer].is_none()
            && file.recording[SensorKind::Gyroscope].is_some()
    );
    let column = file.columns.iter().find(|column| column.name == "linear_acceleration.x").expect("there");
    assert_eq!(column.unused.as_deref(), Some("its covariance begins with −1: the IMU does not have it"));
    let neither = bag(&[("/imu", IMU, "cdr", messages([true, true]))]);
    assert!(
        refused(&neither, &ImuReadOptions::default())
            .starts_with("the file holds orientation only (`orientation`)")
    );
}

#[test]
fn bags_that_cannot_be_used_say_why() {
    let two = bag(&[
        ("/front/imu", IMU, "cdr", (0..3).map(message).collect()),
        ("/rear/imu", IMU, "cdr", (0..2).map(message).collect()),
    ]);
    let topic = |topic: &str| ImuReadOptions { topic: Some(topic.into()), ..ImuReadOptions::default() };
    assert_eq!(parse_imu_recording(&two, &topic("/rear/imu")).expect("good").rows, 2);
    let plain = ImuReadOptions::default();
    let flat = |k: u64| cdr(STAMP + 5_000_000 * k, "", [0.1, 0.2, 0.1], [0.0, 0.01, 0.02], [false; 2]);
    let names = ["angular_velocity.x", "angular_velocity.y", "angular_velocity.z"].map(str::to_owned);
    let mapped = ImuReadOptions {
        columns: ColumnMapping { gyroscope: Some(names), ..ColumnMapping::default() },
        ..plain.clone()
    };
    for (bytes, options, expected) in [
        (
            two.clone(),
            plain.clone(),
            "there is more than one IMU: /front/imu (3 messages), /rear/imu (2 messages) (say option `topic`, or topic in [columns])",
        ),
        (
            two,
            topic("/imu"),
            "there are no messages of sensor_msgs/msg/Imu on `/imu`; the topics of such messages: `/front/imu`, `/rear/imu` (names count letter by letter, the slash too)",
        ),
        (
            bag(&[("/chatter", "std_msgs/msg/String", "cdr", vec![])]),
            plain.clone(),
            "the bag has no messages of sensor_msgs/msg/Imu; its topics are `/chatter (std_msgs/msg/String)` (record the topic of the IMU)",
        ),
        (bag(&[]), plain.clone(), "the bag has no topics (record the topic of the IMU)"),
        (
            bag(&[("/imu", IMU, "json", vec![b"{}".to_vec()])]),
            plain.clone(),
            "messages of `/imu` are encoded as `json` (only CDR and the encoding of ROS 1 are read)",
        ),
        (
            bag(&[("/imu", IMU, "cdr", vec![message(0), message(1)[..100].to_vec()])]),
            plain.clone(),
            "message 2 of `/imu` cannot be read: it is too short (was it recorded as sensor_msgs/msg/Imu by ROS?)",
        ),
        (
            bag(&[("/imu", IMU, "cdr", vec![[vec![0, 7], message(0)[2..].to_vec()].concat()])]),
            plain.clone(),
            "message 1 of `/imu` cannot be read: its encapsulation is not plain CDR (was it recorded as sensor_msgs/msg/Imu by ROS?)",
        ),
        (
            bag(&[("/imu", IMU, "cdr", vec![message(0)])]),
            plain.clone(),
            "only 1 usable sample of the accelerometer in 1 row (a recording needs two samples at least)",
        ),
        (
            bag(&[("/imu", IMU, "cdr", (0..4).map(flat).collect())]),
            plain.clone(),
            "gravity has been removed from the accelerometer: its magnitude is 0.0224 m/s² half of the time or less (export the sensor's own readings; is it really an acceleration, in the unit that is stated?)",
        ),
        (
            one(),
            mapped,
            "[columns] names columns, but the messages of a bag or a log say what they hold (take time, accelerometer, gyroscope and temperature out of [columns]; topic and instance may stay)",
        ),
        (
            one(),
            ImuReadOptions { format: Some(FileFormat::Csv), ..plain.clone() },
            "the format was given as csv, but this is ROS 2 bag (MCAP) (leave option `format` away, and `format` in [columns]: the format is recognised by the content)",
        ),
    ] {
        assert_eq!(refused(&bytes, &options), expected);
    }
}

/// A text that states a length of 2.5 GiB: the container's crate would reserve them.
#[test]
fn a_text_longer_than_its_record_is_refused_without_taking_its_word() {
    // names and encodings of a schema and of a channel
    for text in [IMU, "ros2msg", "/imu/data_raw", "cdr"] {
        let bag = one();
        let needle = [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat();
        let places: Vec<usize> =
            (0..bag.len() - needle.len()).filter(|&k| bag[k..].starts_with(&needle)).collect();
        assert!(!places.is_empty(), "{text}");
        let mut broken = bag;
        broken[places[0]..places[0] + 4].copy_from_slice(&2_587_885_575_u32.to_le_bytes());
        let error = parse_imu_recording(&broken, &ImuReadOptions::default()).expect_err(text).to_string();
        assert!(error.contains("the MCAP container is damaged"), "{text}: {error}");
    }
}

/// A record that reaches beyond its chunk: the container's crate would subtract its length from the chunk's,
/// and panic or wrap around.
#[test]
fn a_record_longer_than_its_chunk_is_refused() {
    let plain = compressed(&one(), "", <[u8]>::to_vec);
    assert_eq!(read(&plain).recording, read(&one()).recording, "a chunk without compression");
    // the length of the chunk's records: behind its head, two times, size, checksum and the name of the compression
    let at = mcap::MAGIC.len() + 9 + 28 + 4;
    let length = u64::from_le_bytes(plain[at..at + 8].try_into().expect("eight bytes"));
    for less in [1, 5, 9, 20, 100] {
        let mut broken = plain.clone();
        broken[at..at + 8].copy_from_slice(&(length - less).to_le_bytes());
        let error = refused(&broken, &ImuReadOptions::default());
        assert!(error.starts_with("the MCAP container is damaged: "), "{less}: {error}");
    }
}

#[test]
fn messages_are_read_in_the_order_of_time_and_not_of_the_file() {
    let of = |order: &[u64], log_time: &dyn Fn(usize, u64) -> u64| {
        let logged = order.iter().enumerate().map(|(at, &k)| (log_time(at, k), message(k)));
        logged_bag(IMU, &logged.collect::<Vec<_>>())
    };
    let received = |_: usize, k: u64| STAMP + 5_000_000 * k + 100;
    let straight = read(&of(&(0..400).collect::<Vec<_>>(), &received));
    for (what, order) in orders() {
        let file = read(&of(&order, &received));
        assert_eq!(file.recording, straight.recording, "{what}");
        let said = findings(&file).join("; ");
        assert!(
            said.contains("come after a later one: they were sorted by their log time"),
            "{what}: {said}"
        );
        // a tool that wrote the bag again gave each message the time of its writing: the stamps are a clock, except where they may be those of two recordings
        let rewritten = of(&order, &|at, _| STAMP + 1000 * at as u64);
        let plain = ImuReadOptions::default();
        match (what, parse_imu_recording(&rewritten, &plain)) {
            ("halves", read) => {
                let message = read.expect_err("refused").to_string();
                assert!(message.starts_with("time goes backwards, from "), "{message}");
            }
            (_, read) => assert_eq!(read.expect("sorted").recording, straight.recording, "{what}"),
        }
    }
    // stamps that are no clock are no reason to take the messages as they come
    let senseless: Vec<_> = (0..400_u64).map(|k| (k, message(k * k * 7919 % 4001))).collect();
    let bytes = logged_bag(IMU, &senseless);
    let message = refused(&bytes, &ImuReadOptions { rate_hz: Some(200.0), ..ImuReadOptions::default() });
    assert!(message.starts_with("time goes backwards ") && !message.contains("rate_hz"), "{message}");
    // empty ones are
    let empty: Vec<_> =
        (0..400).map(|k| (k, cdr(0, "", [0.1 * k as f64, 0.2, 0.1], [0.0, 9.8, 0.1], [false; 2]))).collect();
    let rate = ImuReadOptions { rate_hz: Some(200.0), ..ImuReadOptions::default() };
    assert_eq!(parse_imu_recording(&logged_bag(IMU, &empty), &rate).expect("read").rows, 400);
}

#[test]
fn messages_that_are_compressed_one_by_one_read_the_same() {
    let zip = |k: u64| (5_000_000 * k, zstd::bulk::compress(&message(k), 1).expect("compressed"));
    let plain: Vec<_> = (0..5).map(|k| (5_000_000 * k, message(k))).collect();
    let packed: Vec<_> = (0..5).map(zip).collect();
    assert_eq!(read(&logged_bag(IMU, &packed)).recording, read(&logged_bag(IMU, &plain)).recording);
    let broken = vec![(0, zip(0).1[..20].to_vec())];
    let message = refused(&logged_bag(IMU, &broken), &ImuReadOptions::default());
    assert!(
        message.starts_with("message 1 of `/topic` cannot be read: it is compressed, and damaged"),
        "{message}"
    );
}

#[test]
fn what_follows_the_end_of_a_bag_is_said() {
    let two = [one(), one()].concat();
    let said = findings(&read(&two)).join("; ");
    assert!(
        said.contains(&format!(
            "a second bag follows the first in this file: its {} bytes are not read",
            one().len()
        )),
        "{said}"
    );
    let said = findings(&read(&[one(), vec![7; 1000]].concat())).join("; ");
    assert!(said.contains("1000 bytes follow the end of the bag: they are not read"), "{said}");
}
