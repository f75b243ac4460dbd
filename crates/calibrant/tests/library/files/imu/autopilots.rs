//! Tests of the logs of autopilots, PX4's ULog and ArduPilot's DataFlash, with writers of their own.

use super::findings;
use calibrant::diagnostic::Check;
use calibrant::diagnostic::reader::{CorrectedOnBoard, LogPassedOver, MessagesChosen};
use calibrant::error::Error;
use calibrant::io::{FileFormat, ImuFile, ImuReadOptions, parse_imu_recording};
use calibrant::sensor::SensorKind::{Accelerometer, Gyroscope};

fn read(bytes: &[u8]) -> ImuFile {
    read_with(bytes, &ImuReadOptions::default())
}

fn read_with(bytes: &[u8], options: &ImuReadOptions) -> ImuFile {
    parse_imu_recording(bytes, options).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(bytes: &[u8], options: &ImuReadOptions) -> String {
    parse_imu_recording(bytes, options).expect_err("refused").to_string()
}

fn topic(name: &str) -> ImuReadOptions {
    ImuReadOptions { topic: Some(name.into()), ..ImuReadOptions::default() }
}

fn instance(value: &str) -> ImuReadOptions {
    ImuReadOptions { instance: Some(value.into()), ..ImuReadOptions::default() }
}

fn has<C: Check>(file: &ImuFile) -> bool {
    file.findings.iter().any(|found| found.code() == C::CODE)
}

/// A message of ULog.
fn ulog(kind: u8, content: &[u8]) -> Vec<u8> {
    [&(content.len() as u16).to_le_bytes()[..], &[kind], content].concat()
}

/// The beginning of a log of this version of PX4, with the formats of its topics.
fn px4(version: [u8; 2]) -> Vec<u8> {
    let [major, minor] = version;
    let mut log = [&b"ULog\x01\x12\x35\x01"[..], &[0; 8]].concat();
    log.extend(ulog(b'B', &[0; 40]));
    log.extend(ulog(b'I', &[&b"\x17uint32_t ver_sw_release"[..], &[255, 0, minor, major]].concat()));
    for format in [
        "sensor_accel:uint64_t timestamp;uint64_t timestamp_sample;uint32_t device_id;float x;float y;float z;float temperature;uint8_t[4] _padding0;",
        "sensor_gyro:uint64_t timestamp;uint64_t timestamp_sample;float x;float y;float z;float temperature;",
        "sensor_combined:uint64_t timestamp;float[3] gyro_rad;uint32_t gyro_integral_dt;int32_t accelerometer_timestamp_relative;float[3] accelerometer_m_s2;",
        "sensor_gyro_fifo:uint64_t timestamp;uint64_t timestamp_sample;uint32_t device_id;float dt;float scale;uint8_t samples;int16_t[4] x;int16_t[4] y;int16_t[4] z;",
        "vehicle_status:uint64_t timestamp;other_type[2] parts;",
    ] {
        log.extend(ulog(b'F', format.as_bytes()));
    }
    log
}

fn subscribe(log: &mut Vec<u8>, number: u16, instance: u8, name: &str) {
    let [low, high] = number.to_le_bytes();
    log.extend(ulog(b'A', &[&[instance, low, high], name.as_bytes()].concat()));
}

/// A message of data: its number, its bytes.
fn data(log: &mut Vec<u8>, number: u16, parts: &[&[u8]]) {
    log.extend(ulog(b'D', &[&number.to_le_bytes()[..], &parts.concat()].concat()));
}

fn floats(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|value| (*value as f32).to_le_bytes()).collect()
}

fn accel(log: &mut Vec<u8>, number: u16, time_us: u64, force: [f64; 3], temperature_c: f64) {
    let times = [(time_us + 300).to_le_bytes(), time_us.to_le_bytes()].concat();
    data(log, number, &[&times, &[9; 4], &floats(&force), &floats(&[temperature_c]), &[0; 4]]);
}

fn gyro(log: &mut Vec<u8>, number: u16, time_us: u64, rate: [f64; 3]) {
    let times = [(time_us + 300).to_le_bytes(), time_us.to_le_bytes()].concat();
    data(log, number, &[&times, &floats(&rate), &floats(&[30.0])]);
}

fn combined(log: &mut Vec<u8>, number: u16, time_us: u64, force: [f64; 3]) {
    let rest = [4000_u32.to_le_bytes(), (-500_i32).to_le_bytes()].concat();
    data(log, number, &[&time_us.to_le_bytes(), &floats(&[0.5, 0.0, 0.25]), &rest, &floats(&force)]);
}

/// Two IMUs at 200 Hz, the second sensor of each with a clock of its own, and `sensor_combined` at 100 Hz.
fn flight(version: [u8; 2]) -> Vec<u8> {
    let mut log = px4(version);
    subscribe(&mut log, 7, 0, "sensor_accel");
    subscribe(&mut log, 8, 0, "sensor_gyro");
    subscribe(&mut log, 9, 1, "sensor_accel");
    subscribe(&mut log, 10, 1, "sensor_gyro");
    subscribe(&mut log, 11, 0, "sensor_combined");
    for k in 0..400 {
        let (time, x) = (2_000_000 + 5000 * k, 0.01 * k as f64);
        accel(&mut log, 7, time, [x, 0.5, -9.75], 40.0 + x);
        gyro(&mut log, 8, time + 1250, [0.0, x, 0.125]);
        accel(&mut log, 9, time, [x, 0.25, -9.5], 20.0);
        gyro(&mut log, 10, time + 1250, [0.0, x, 0.375]);
        if k % 2 == 0 {
            combined(&mut log, 11, time, [x, 0.0, -9.0]);
        }
    }
    log
}

#[test]
fn raw_readings_of_px4_are_those_of_the_instance_with_the_clocks_of_the_sensors() {
    let log = flight([1, 14]);
    let question = parse_imu_recording(&log, &ImuReadOptions::default()).expect_err("two IMUs");
    let Error::Recording(question) = question else { panic!("{question}") };
    assert!(question.message.contains("2 IMUs in sensor_accel and sensor_gyro: 0, 1"), "{question}");
    assert_eq!(question.answers[0].values, ["0", "1"]);
    let file = read_with(&log, &instance("1"));
    assert_eq!(file.format, FileFormat::Ulog);
    let (force, rate) = (
        file.recording.sensor(Accelerometer).expect("there"),
        file.recording.sensor(Gyroscope).expect("there"),
    );
    assert_eq!((force.len(), rate.len()), (400, 400));
    assert_eq!(force.readings()[100].as_slice(), [f64::from(1.0_f32), 0.25, -9.5]);
    assert_eq!(rate.readings()[100].as_slice(), [0.0, f64::from(1.0_f32), 0.375]);
    assert!((rate.times_s()[7] - force.times_s()[7] - 1.25e-3).abs() < 1e-9, "each has its own clock");
    assert!((force.times_s()[400 - 1] - force.times_s()[0] - 399.0 * 5e-3).abs() < 1e-9);
    assert_eq!(file.recording.temperature_c.as_ref().expect("there")[3], 20.0);
    assert!(!has::<CorrectedOnBoard>(&file) && has::<MessagesChosen>(&file), "{:?}", findings(&file));
    let said = findings(&file).join("\n");
    assert!(
        said.contains("`sensor_accel` and `sensor_gyro`, instance 1, at 200 Hz")
            && said.contains("`sensor_combined` 0 at 100"),
        "{said}"
    );
    // drivers of earlier versions corrected
    assert!(has::<CorrectedOnBoard>(&read_with(&flight([1, 11]), &instance("1"))));
}

#[test]
fn sensor_combined_is_read_where_it_is_chosen_or_the_raw_readings_are_too_few() {
    let file = read_with(&flight([1, 14]), &topic("sensor_combined"));
    let force = file.recording.sensor(Accelerometer).expect("there");
    assert_eq!((force.len(), force.readings()[50].z), (200, -9.0));
    let rate = file.recording.sensor(Gyroscope).expect("there");
    assert!(
        (rate.times_s()[1] - force.times_s()[1] - 5e-4).abs() < 1e-9,
        "the accelerometer's time is relative"
    );
    assert!(has::<CorrectedOnBoard>(&file));
    let mut log = px4([1, 14]);
    for (number, name) in [(1, "sensor_accel"), (2, "sensor_gyro"), (3, "sensor_combined")] {
        subscribe(&mut log, number, 0, name);
    }
    for k in 0..400_u64 {
        combined(&mut log, 3, 5000 * k, [0.01 * k as f64, 0.0, -9.0]);
        if k % 200 == 0 {
            accel(&mut log, 1, 5000 * k, [0.0, 0.0, -9.75], 33.0);
            gyro(&mut log, 2, 5000 * k, [0.0; 3]);
        }
    }
    let file = read(&log);
    assert_eq!(file.recording.sensor(Accelerometer).expect("there").len(), 400);
    assert!(has::<CorrectedOnBoard>(&file));
    assert_eq!(
        read_with(&log, &topic("sensor_gyro")).recording.sensor(Accelerometer).expect("there").len(),
        2
    );
    let said = refused(&log, &topic("sensor_mag"));
    assert!(
        said.contains("`sensor_mag`") && said.contains("sensor_accel, sensor_gyro or sensor_combined"),
        "{said}"
    );
    assert!(refused(&log, &instance("4")).contains("no IMU 4"));
    assert!(refused(&px4([1, 14]), &ImuReadOptions::default()).contains("no readings of an IMU"));
}

#[test]
fn samples_of_a_fifo_end_at_the_time_of_their_message() {
    let mut log = px4([1, 14]);
    subscribe(&mut log, 1, 0, "sensor_gyro_fifo");
    for k in 0..100_u64 {
        let time = 1_000_000 + 4000 * k;
        let times = [(time + 90).to_le_bytes(), time.to_le_bytes()].concat();
        let counts = |from: i16| -> Vec<u8> { (from..from + 4).flat_map(i16::to_le_bytes).collect() };
        let rest =
            [&[0; 4][..], &floats(&[1000.0, 0.0625]), &[4], &counts(k as i16), &counts(-2), &counts(7)]
                .concat();
        data(&mut log, 1, &[&times, &rest]);
    }
    let file = read(&log);
    let rate = file.recording.sensor(Gyroscope).expect("there");
    assert_eq!(rate.len(), 400);
    assert_eq!(rate.readings()[4 * 9 + 2].as_slice(), [0.6875, 0.0, 0.5625]);
    assert!(rate.times_s().windows(2).all(|pair| (pair[1] - pair[0] - 1e-3).abs() < 1e-9));
}

#[test]
fn a_damaged_log_is_read_on_where_it_can_be() {
    let whole = flight([1, 14]);
    let sync = ulog(b'S', b"\x2f\x73\x13\x20\x25\x0c\xbb\x12");
    let middle = {
        let mut at = 16;
        while at < whole.len() / 2 {
            at += 3 + usize::from(u16::from_le_bytes([whole[at], whole[at + 1]]));
        }
        at
    };
    let damaged = [&whole[..middle], &[0; 500], &sync, &whole[middle..]].concat();
    let file = read_with(&damaged, &instance("0"));
    assert_eq!(file.recording.sensor(Accelerometer).expect("there").len(), 400);
    assert!(
        findings(&file).iter().any(|found| found.contains("500 bytes at 1 place of the log are no messages"))
    );
    // cut off within a message, as by the end of the power
    let cut = read_with(&whole[..whole.len() - 5], &instance("0"));
    assert!(!has::<LogPassedOver>(&cut));
    assert_eq!(cut.recording.sensor(Gyroscope).expect("there").len(), 400);
    // whatever is missing or wrong, it is no panic
    for length in 0..600.min(whole.len()) {
        let _ = parse_imu_recording(&whole[..length], &ImuReadOptions::default());
    }
    for at in 0..600 {
        for value in [0, 3, 255] {
            let mut broken = whole[..4000].to_vec();
            broken[at] = value;
            let _ = parse_imu_recording(&broken, &instance("0"));
        }
    }
    let mut newer = whole.clone();
    newer[16 + 3 + 8] = 2;
    assert!(refused(&newer, &ImuReadOptions::default()).contains("ulog2csv -m sensor_accel"));
}

#[test]
fn data_that_were_appended_are_read_behind_a_message_that_was_cut_off() {
    let whole = flight([1, 14]);
    let (first, second) = (whole.len(), whole.len() - 3);
    let mut log = whole[..second].to_vec();
    let mut more = Vec::new();
    for k in 400..500 {
        accel(&mut more, 7, 2_000_000 + 5000 * k, [0.0, 0.5, -9.75], 40.0);
    }
    log.extend(&more);
    assert!(first > second);
    log[16 + 3 + 8] = 1;
    log[16 + 3 + 16..16 + 3 + 24].copy_from_slice(&(second as u64).to_le_bytes());
    let file = read_with(&log, &instance("0"));
    assert_eq!(file.recording.sensor(Accelerometer).expect("there").len(), 500);
    assert!(!has::<LogPassedOver>(&file));
}

/// A format of DataFlash, with its own number.
fn format(kind: u8, name: &str, letters: &str, labels: &str) -> Vec<u8> {
    let size = |letter: char| match letter {
        'B' => 1,
        'c' => 2,
        'Q' => 8,
        'a' => 64,
        _ => 4,
    };
    let length = 3 + letters.chars().map(size).sum::<usize>();
    let padded = |text: &str, length: usize| [text.as_bytes(), &vec![0; length - text.len()]].concat();
    [&[0xa3, 0x95, 0x80, kind, length as u8][..], &padded(name, 4), &padded(letters, 16), &padded(labels, 64)]
        .concat()
}

fn record(log: &mut Vec<u8>, kind: u8, parts: &[&[u8]]) {
    log.extend([0xa3, 0x95, kind]);
    parts.iter().for_each(|part| log.extend(*part));
}

/// Two IMUs at 1 kHz in `ACC` and `GYR`, and in `IMU` at 50 Hz with temperatures.
fn ardupilot() -> Vec<u8> {
    let mut log = format(0x80, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
    log.extend(format(1, "ACC", "QBQfff", "TimeUS,I,SampleUS,AccX,AccY,AccZ"));
    log.extend(format(2, "GYR", "QBQfff", "TimeUS,I,SampleUS,GyrX,GyrY,GyrZ"));
    log.extend(format(3, "IMU", "QBffffffIIfBB", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH"));
    log.extend(format(4, "ISBD", "Qa", "TimeUS,x"));
    for k in 0..1000_u64 {
        let (sample, x) = (500_000 + 1000 * k, 1e-3 * k as f64);
        let head =
            |later: u64, i: u8| [&(sample + later).to_le_bytes()[..], &[i], &sample.to_le_bytes()].concat();
        for i in [0, 1] {
            record(&mut log, 1, &[&head(40 + k % 7, i), &floats(&[x, f64::from(i), -9.75])]);
            record(&mut log, 2, &[&head(60 + k % 7, i), &floats(&[x, 0.5, 0.125 * f64::from(i)])]);
            if k % 20 == 0 {
                let head = [&sample.to_le_bytes()[..], &[i]].concat();
                let values = floats(&[x, 0.5, 0.0, x, 0.0, -9.5]);
                record(&mut log, 3, &[&head, &values, &[0; 8], &floats(&[45.0 + x]), &[1, 1]]);
            }
        }
        record(&mut log, 4, &[&sample.to_le_bytes(), &[0; 64]]);
    }
    log
}

#[test]
fn ardupilots_full_rate_readings_have_the_times_of_the_samples() {
    let log = ardupilot();
    assert!(refused(&log, &ImuReadOptions::default()).contains("2 IMUs in ACC and GYR: 0, 1"));
    let file = read_with(&log, &instance("1"));
    assert_eq!((file.format, file.rows), (FileFormat::DataFlash, 1000), "both sensors share their rows");
    let (force, rate) = (
        file.recording.sensor(Accelerometer).expect("there"),
        file.recording.sensor(Gyroscope).expect("there"),
    );
    assert_eq!(force.readings()[500].as_slice(), [f64::from(0.5_f32), 1.0, -9.75]);
    assert_eq!(rate.readings()[500].as_slice(), [f64::from(0.5_f32), 0.5, 0.125]);
    assert!(
        force.times_s().windows(2).all(|pair| (pair[1] - pair[0] - 1e-3).abs() < 1e-9),
        "SampleUS, not TimeUS"
    );
    let temperature = file.recording.temperature_c.as_ref().expect("that of IMU");
    assert!((temperature[510] - 45.51).abs() < 1e-3);
    assert!(has::<CorrectedOnBoard>(&file));
    let filtered = read_with(&log, &ImuReadOptions { instance: Some("0".into()), ..topic("IMU") });
    assert_eq!(filtered.rows, 50);
    assert!(findings(&filtered).iter().any(|found| found.contains("filtered")));
}

#[test]
fn old_logs_of_ardupilot_number_their_messages_by_name() {
    let mut log = format(0x80, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
    log.extend(format(1, "IMU", "Ifffccc", "TimeMS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ"));
    log.extend(format(2, "IMU2", "Ifffccc", "TimeMS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ"));
    for k in 0..100_u32 {
        for kind in [1, 2] {
            let force: Vec<u8> =
                [k as i16, 0, -970 - i16::from(kind)].into_iter().flat_map(i16::to_le_bytes).collect();
            record(
                &mut log,
                kind,
                &[&(1000 + 20 * k).to_le_bytes(), &floats(&[0.0, 0.01 * f64::from(k), 0.25]), &force],
            );
        }
    }
    let file = read_with(&log, &instance("1"));
    let force = file.recording.sensor(Accelerometer).expect("there");
    assert!((force.readings()[7] - nalgebra::Vector3::new(0.07, 0.0, -9.72)).norm() < 1e-12);
    assert!((force.times_s()[99] - force.times_s()[0] - 1.98).abs() < 1e-9);
}

#[test]
fn a_damaged_log_of_ardupilot_is_read_on() {
    let whole = ardupilot();
    let at = whole.windows(3).rposition(|bytes| bytes == [0xa3, 0x95, 4]).expect("a message");
    let damaged = [&whole[..at], &[7; 70], &whole[at..], &whole[..0]].concat();
    let file = read_with(&damaged, &instance("0"));
    assert!(has::<LogPassedOver>(&file) && file.rows == 1000);
    assert!(!has::<LogPassedOver>(&read_with(&whole[..whole.len() - 9], &instance("0"))));
    for at in 0..500 {
        for value in [0, 1, 0x80, 255] {
            let mut broken = whole[..3000].to_vec();
            broken[at] = value;
            let _ = parse_imu_recording(&broken, &instance("0"));
        }
    }
    assert!(
        refused(&format(0x80, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns"), &ImuReadOptions::default())
            .contains("no readings of an IMU")
    );
}
