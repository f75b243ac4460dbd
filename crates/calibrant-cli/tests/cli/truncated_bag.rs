//! Tests of a bag without its end: it is read, and every command names the missing part.

use crate::bench::Bench;

/// A ROS 2 bag of the rows of a `recording.csv`, written from the specifications of MCAP and CDR. It has a
/// schema, a channel and messages, no chunks and no index.
fn bag(recording: &str) -> Vec<u8> {
    fn text(bytes: &mut Vec<u8>, text: &str) {
        bytes.extend((text.len() as u32).to_le_bytes());
        bytes.extend(text.bytes());
    }
    let mut bag = b"\x89MCAP0\r\n".to_vec();
    let mut record = |opcode: u8, content: &[u8]| {
        bag.push(opcode);
        bag.extend((content.len() as u64).to_le_bytes());
        bag.extend(content);
    };
    let mut header = Vec::new();
    text(&mut header, "ros2");
    text(&mut header, "by hand");
    record(1, &header);
    let mut schema = 1_u16.to_le_bytes().to_vec();
    text(&mut schema, "sensor_msgs/msg/Imu");
    text(&mut schema, "ros2msg");
    text(&mut schema, "");
    record(3, &schema);
    let mut channel = [0_u16.to_le_bytes(), 1_u16.to_le_bytes()].concat();
    text(&mut channel, "/imu/data_raw");
    text(&mut channel, "cdr");
    text(&mut channel, ""); // no metadata
    record(4, &channel);
    for row in recording.lines().skip(1) {
        let numbers: Vec<f64> = row.split(',').map(|cell| cell.parse().expect("a number")).collect();
        let ns = (numbers[0] * 1e9).round() as u64;
        let mut message = [0_u16.to_le_bytes().to_vec(), vec![0; 4], vec![0; 16]].concat();
        // encapsulation; header: stamp, frame "i", padding to eight bytes
        message.extend([0, 1, 0, 0]);
        message.extend(((ns / 1_000_000_000) as u32).to_le_bytes());
        message.extend(((ns % 1_000_000_000) as u32).to_le_bytes());
        message.extend(2_u32.to_le_bytes());
        message.extend(b"i\0\0\0");
        let unknown = [-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let orientation = [0.0, 0.0, 0.0, 1.0].iter().chain(&unknown);
        let (force, rate) = (&numbers[1..4], &numbers[4..7]);
        let values = orientation.chain(rate).chain(&[0.0; 9]).chain(force).chain(&[0.0; 9]);
        values.for_each(|value| message.extend(value.to_le_bytes()));
        record(5, &message);
    }
    record(15, &[0; 4]);
    record(2, &[0; 20]);
    bag.extend(b"\x89MCAP0\r\n");
    bag
}

#[test]
fn every_command_warns_of_a_bag_that_was_cut_off() {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    bench.run("simulate imu.toml -o simulated").done();
    let whole = bag(&bench.read("simulated/recording.csv"));
    let length = whole.len() * 3 / 4 + 100;
    bench.write("whole.mcap", &whole);
    bench.write("cut.mcap", &whole[..length]);
    let warning =
        format!("cut.mcap: the bag was cut off at byte {length}, within the message that begins at byte ");
    let calibrate = |file: &str| format!("calibrate imu.toml {file} -o out");
    for (command, says) in [
        (calibrate("whole.mcap"), false),
        (calibrate("cut.mcap"), true),
        ("apply out/calibration.json cut.mcap -o corrected.csv".to_owned(), true),
        ("inspect cut.mcap --json".to_owned(), true),
        ("inspect cut.mcap --quiet".to_owned(), true),
        ("noise cut.mcap --sensor gyroscope -o noise".to_owned(), true),
        ("noise whole.mcap --sensor gyroscope -o noise".to_owned(), false),
        ("inspect whole.mcap".to_owned(), false),
    ] {
        let outcome = bench.run(&command).done();
        if says {
            outcome.says(&format!("warning: {warning}"));
            outcome.says("`mcap recover` makes a whole file of it");
        } else {
            assert!(!outcome.stderr.contains("cut off"), "{outcome:?}");
        }
    }
    let inspected = bench.run("inspect cut.mcap").done();
    let listed = inspected.printed();
    assert!(
        listed.contains("warning: the bag was cut off") && listed.contains("[file-unfinished]"),
        "{listed}"
    );
    assert_eq!(inspected.stderr, "", "it is said once");
    assert!(bench.read("noise/report.html").contains("svg"));
}
