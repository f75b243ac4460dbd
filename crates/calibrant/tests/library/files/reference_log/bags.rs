//! Tests of bags with a motion in them.

use super::findings;
use crate::files::imu::ros_bag::{IMU, bag, logged_bag, message, message_of, orders};
use calibrant::io::{
    Experiment, ImuReadOptions, ReferenceFormat, ReferenceLogFile, ReferenceLogOptions, parse_imu_recording,
    parse_reference_log, preset,
};
use calibrant::sensor::SensorKind;
use calibrant::session::{Calibrated, Session, SessionOptions, Source};
use nalgebra::Vector3;

const JOINTS: &str = "sensor_msgs/msg/JointState";
const POSE: &str = "geometry_msgs/msg/PoseStamped";
const TRANSFORM: &str = "geometry_msgs/msg/TransformStamped";
const ODOMETRY: &str = "nav_msgs/msg/Odometry";
const TF: &str = "tf2_msgs/msg/TFMessage";

/// The first time stamp, ns: that of the IMU's messages, and 1 ms.
const STAMP: u64 = 1_700_000_000_124_456_789;

/// The fields of a message in CDR.
struct Cdr {
    bytes: Vec<u8>,
    big: bool,
}

impl Cdr {
    fn new(big: bool) -> Self {
        Self { bytes: Vec::new(), big }
    }

    fn put<const N: usize>(mut self, little: [u8; N]) -> Self {
        while !self.bytes.len().is_multiple_of(N) {
            self.bytes.push(0);
        }
        let mut bytes = little;
        if self.big {
            bytes.reverse();
        }
        self.bytes.extend(bytes);
        self
    }

    fn length(self, length: usize) -> Self {
        self.put((length as u32).to_le_bytes())
    }

    fn text(self, text: &str) -> Self {
        let mut cdr = self.length(text.len() + 1);
        cdr.bytes.extend(text.bytes().chain([0]));
        cdr
    }

    fn numbers(self, numbers: &[f64]) -> Self {
        numbers.iter().fold(self, |cdr, number| cdr.put(number.to_le_bytes()))
    }

    fn list(self, numbers: &[f64]) -> Self {
        self.length(numbers.len()).numbers(numbers)
    }

    fn header(self, k: u64, frame: &str) -> Self {
        let stamp = STAMP + 10_000_000 * k;
        let cdr = self.put(((stamp / 1_000_000_000) as u32).to_le_bytes());
        cdr.put(((stamp % 1_000_000_000) as u32).to_le_bytes()).text(frame)
    }

    fn done(self) -> Vec<u8> {
        [vec![0, u8::from(!self.big), 0, 0], self.bytes].concat()
    }
}

fn joint_state(k: u64, names: &[&str], positions: &[f64], velocities: &[f64]) -> Vec<u8> {
    let cdr = Cdr::new(k % 2 == 1).header(k, "").length(names.len());
    let cdr = names.iter().fold(cdr, |cdr, name| cdr.text(name));
    cdr.list(positions).list(velocities).list(&[]).done()
}

/// Position and quaternion, w last.
fn values(k: u64) -> [f64; 7] {
    [0.1 * k as f64, 0.2, 0.3, 0.6, 0.0, 0.0, 0.8]
}

fn pose(k: u64) -> Vec<u8> {
    Cdr::new(false).header(k, "world").numbers(&values(k)).done()
}

fn transform(k: u64) -> Vec<u8> {
    Cdr::new(false).header(k, "world").text("tool").numbers(&values(k)).done()
}

fn odometry(k: u64) -> Vec<u8> {
    Cdr::new(false).header(k, "world").text("base").numbers(&values(k)).numbers(&[0.0; 36 + 6 + 36]).done()
}

fn tf(k: u64, frames: &[&str]) -> Vec<u8> {
    let one = |cdr: Cdr, frame: &&str| cdr.header(k, "world").text(frame).numbers(&values(k));
    frames.iter().fold(Cdr::new(false).length(frames.len()), one).done()
}

fn read(bytes: &[u8], topic: Option<&str>) -> ReferenceLogFile {
    parse_reference_log(bytes, &options(topic)).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(bytes: &[u8], topic: Option<&str>) -> String {
    parse_reference_log(bytes, &options(topic)).expect_err("refused").to_string()
}

fn options(topic: Option<&str>) -> ReferenceLogOptions {
    ReferenceLogOptions { topic: topic.map(ToOwned::to_owned), ..ReferenceLogOptions::default() }
}

#[test]
fn the_joints_and_the_imu_of_one_bag_are_on_one_clock() {
    let states = (0..5).map(|k| joint_state(k, &["b", "a"], &[0.1 * k as f64, 2.0], &[3.0, 4.0])).collect();
    let bytes =
        bag(&[("/imu", IMU, "cdr", (0..5).map(message).collect()), ("/joint_states", JOINTS, "cdr", states)]);
    let mut file = read(&bytes, None);
    assert_eq!((file.format, file.rows), (ReferenceFormat::Mcap, 5));
    let log = file.joints().expect("joints");
    assert_eq!((log.names.join(" "), log.row(3)), ("b a".to_owned(), [0.1 * 3.0, 2.0].as_slice()));
    assert_eq!(log.velocities.as_ref().expect("velocities")[..2], [3.0, 4.0]);
    assert_eq!(log.times_s, [0.0, 0.01, 0.02, 0.03, 0.04]);
    let imu = parse_imu_recording(&bytes, &ImuReadOptions::default()).expect("its IMU");
    file.put_on_clock_of(imu.counted_from_ns);
    assert!((file.log.times_s()[0] - 0.001).abs() < 1e-12, "the log begins 1 ms later");
}

/// A gantry with an accelerometer that reads 0.1 m/s² too much along x. Its log begins 1 ms after the recording, by its time stamps.
#[test]
fn a_bag_with_joints_and_an_imu_needs_no_further_log() {
    let sines = |t: f64| [0.0, 1.0, 2.0].map(|j| (0.1 * ((4.0 + j) * t).sin(), -(4.0_f64 + j).powi(2)));
    // neither is free of noise: a reading in a step of its own
    let rough = |k: u64, step: f64| step * ((k * 7919 % 101) as f64 / 101.0 - 0.5);
    let states = (0..2000).map(|k| {
        let positions = sines(0.001 + 0.01 * k as f64).map(|(q, _)| q + rough(k, 1e-5));
        joint_state(k, &["x", "y", "z"], &positions, &[])
    });
    let messages = (0..3900).map(|k| {
        let [x, y, z] = sines(0.005 * k as f64).map(|(q, w)| q * w + rough(k, 1e-2));
        message_of(k, [0.0; 3], [x + 0.1, y, z + 9.80665])
    });
    let topics =
        [("/imu", IMU, "cdr", messages.collect()), ("/joint_states", JOINTS, "cdr", states.collect())];
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("both.mcap");
    std::fs::write(&path, bag(&topics)).expect("written");

    let experiment = Experiment::parse(preset("gantry").expect("known"), None).expect("valid");
    let options = SessionOptions { report: false, ..SessionOptions::default() };
    let session = Session::with(experiment.clone(), options).expect("prepared");
    let outcome = session.calibrate(&Source::from_file(&path)).expect("calibrated");
    let Calibrated::OnMachine(machine) = &outcome.calibrated else { panic!("on a machine") };
    let calibration = &machine.calibration;
    let (bias, delay_s) = (
        calibration.parameters.imu[SensorKind::Accelerometer].bias.x,
        calibration.parameters.delays_s[SensorKind::Accelerometer],
    );
    assert!((bias - 0.1).abs() < 0.03, "{bias}");
    assert!(delay_s.abs() < 1e-4, "the time stamps are of one clock: {delay_s}");
    assert_eq!((machine.log.file.as_str(), machine.log.format), ("both.mcap", "mcap"));
}

#[test]
fn messages_may_hold_some_of_the_joints() {
    let state = |k: u64| match k % 2 {
        0 => joint_state(k, &["a", "b"], &[1.0, 2.0], &[]),
        _ => joint_state(k, &["finger", "a"], &[9.0, k as f64], &[0.5, 0.25]),
    };
    let file = read(&bag(&[("/joint_states", JOINTS, "cdr", (0..6).map(state).collect())]), None);
    let log = file.joints().expect("joints");
    assert_eq!(log.names, ["a", "b", "finger"]);
    assert!(log.row(0)[2].is_nan() && log.row(1)[1].is_nan());
    assert_eq!((log.row(1)[0], log.row(1)[2]), (1.0, 9.0));
    assert_eq!(log.velocities.as_ref().expect("some")[3], 0.25);
}

#[test]
fn poses_of_each_type_are_read() {
    let messages = |message: fn(u64) -> Vec<u8>| (0..4).map(message).collect::<Vec<_>>();
    for (schema, messages) in [
        (POSE, messages(pose)),
        ("geometry_msgs/msg/dds_/PoseStamped_", messages(pose)),
        (TRANSFORM, messages(transform)),
        (ODOMETRY, messages(odometry)),
        (TF, messages(|k| tf(k, &["tool"]))),
    ] {
        let file = read(&bag(&[("/a", schema, "cdr", messages)]), None);
        let log = file.poses().unwrap_or_else(|| panic!("{schema}"));
        assert_eq!(
            (log.times_s.len(), log.positions_m[3]),
            (4, Some(Vector3::new(0.1 * 3.0, 0.2, 0.3))),
            "{schema}"
        );
        let orientation = log.world_from_body[3].expect("seen");
        assert!((orientation.w - 0.8).abs() < 1e-12 && (orientation.i - 0.6).abs() < 1e-12, "{schema}");
        assert!(
            findings(&file)[0].starts_with("times are counted from the first sample"),
            "{:?}",
            findings(&file)
        );
    }
}

#[test]
fn one_of_several_logs_has_to_be_named() {
    let states: Vec<_> = (0..3).map(|k| joint_state(k, &["a"], &[k as f64], &[])).collect();
    let poses: Vec<_> = (0..4).map(pose).collect();
    let frames: Vec<_> = (0..5).map(|k| tf(k, &["upper", "tool"])).collect();
    let two = bag(&[
        ("/joint_states", JOINTS, "cdr", states.clone()),
        ("/pose", POSE, "cdr", poses),
        ("/tf", TF, "cdr", frames.clone()),
    ]);
    assert_eq!(
        refused(&two, None),
        "there is more than one log of a motion: /joint_states (3 messages), /pose (4 messages) (name it: topic = \"…\" in [machine.log]; `inspect` takes option `topic`)"
    );
    assert_eq!(read(&two, Some("/pose")).log.times_s().len(), 4);
    assert_eq!(read(&two, Some("/tf:tool")).log.times_s().len(), 5);
    let arm = bag(&[("/joint_states", JOINTS, "cdr", states), ("/tf", TF, "cdr", frames.clone())]);
    assert!(read(&arm, None).joints().is_some(), "the frames follow from the joints");
    let many = bag(&[("/tf", TF, "cdr", frames)]);
    assert_eq!(
        refused(&many, None),
        "there is more than one log of a motion: /tf:tool (5 messages), /tf:upper (5 messages) (name it: topic = \"…\" in [machine.log]; `inspect` takes option `topic`)"
    );
}

#[test]
fn broken_bags_say_why() {
    let types = "sensor_msgs/msg/JointState, geometry_msgs/msg/PoseStamped, geometry_msgs/msg/TransformStamped, nav_msgs/msg/Odometry, tf2_msgs/msg/TFMessage";
    let joints = |messages: Vec<Vec<u8>>| bag(&[("/j", JOINTS, "cdr", messages)]);
    let is = |bytes: &[u8], expected: &str| assert_eq!(refused(bytes, None), expected);
    is(
        &bag(&[("/imu", IMU, "cdr", vec![message(0)])]),
        &format!(
            "the bag has no messages of {types}; its topics are `/imu (sensor_msgs/msg/Imu)` (record the topic of the log of a motion)"
        ),
    );
    is(
        &joints(vec![joint_state(0, &["a", "b"], &[1.0], &[])]),
        "message 1 of `/j` cannot be read: it has another number of positions than of names (was it recorded as sensor_msgs/msg/JointState by ROS?)",
    );
    is(
        &joints(vec![joint_state(0, &["a"], &[1.0], &[])[..30].to_vec()]),
        "message 1 of `/j` cannot be read: it is too short (was it recorded as sensor_msgs/msg/JointState by ROS?)",
    );
    is(
        &joints(vec![joint_state(1, &["a"], &[1.0], &[]), joint_state(0, &["a"], &[1.0], &[])]),
        "message 2: time goes backwards, from 0.0 s to -0.01 s (are these files put together, or did a counter wrap? split the file here)",
    );
    is(
        &joints(vec![joint_state(0, &["a"], &[1.0], &[]), joint_state(1, &["a"], &[f64::INFINITY], &[])]),
        "message 2: the value inf is out of range (is the unit right? is the file damaged?)",
    );
    is(
        &joints(vec![joint_state(0, &["a"], &[1.0], &[]); 3]),
        "the time is 0.0 s in every row (did the clock stand still?)",
    );
    is(
        &joints(vec![joint_state(0, &["a"], &[], &[1.0]), joint_state(1, &["a"], &[], &[1.0])]),
        "the messages of JointState have no positions (record a topic whose messages have them: velocities and efforts are no reference)",
    );
    is(
        &joints(Vec::new()),
        &format!(
            "the bag has no messages of {types}; its topics are `/j (sensor_msgs/msg/JointState)` (record the topic of the log of a motion)"
        ),
    );
    let zeros = |k: u64| Cdr::new(false).header(k, "").numbers(&[0.0; 7]).done();
    is(
        &bag(&[("/p", POSE, "cdr", (0..3).map(zeros).collect())]),
        "no row has a pose: every value is NaN, or a placeholder (a log needs two rows with a time and a position at least)",
    );
    assert!(
        refused(&joints(vec![joint_state(0, &["a"], &[1.0], &[])]), Some("/k")).contains("no messages of")
    );
    let whole = joints((0..50).map(|k| joint_state(k, &["a"], &[k as f64], &[])).collect());
    let cut = whole[..whole.len() - 8].to_vec();
    assert!(findings(&read(&cut, None)).iter().any(|found| found.contains("50 messages were read")));
}

#[test]
fn joints_and_poses_are_read_in_the_order_of_time_and_not_of_the_file() {
    let joints = |k: u64| joint_state(k, &["elbow"], &[(0.1 * k as f64).sin()], &[]);
    let pose = |k: u64| Cdr::new(false).header(k, "").numbers(&values(k)).done();
    for (schema, message) in [(JOINTS, &joints as &dyn Fn(u64) -> Vec<u8>), (POSE, &pose)] {
        let read = |order: &[u64]| {
            let logged: Vec<_> = order.iter().map(|&k| (STAMP + 10_000_000 * k, message(k))).collect();
            parse_reference_log(&logged_bag(schema, &logged), &ReferenceLogOptions::default()).expect("read")
        };
        let straight = read(&(0..400).collect::<Vec<_>>());
        for (what, order) in orders() {
            let file = read(&order);
            assert_eq!(file.log, straight.log, "{schema}: {what}");
            let said = findings(&file).join("; ");
            assert!(said.contains("they were sorted by their log time"), "{said}");
        }
    }
}
