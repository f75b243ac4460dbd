//! Tests of Parquet files, written with the crate `parquet`.

use super::{findings, units};
use calibrant::budget::Budget;
use calibrant::error::Refusal;
use calibrant::io::{FileFormat, ImuFile, ImuReadOptions, ImuUnit, TimeUnit, parse_imu_recording};
use calibrant::sensor::SensorKind;
use parquet::basic::Compression;
use parquet::column::writer::ColumnWriter;
use parquet::data_type::{ByteArray, FixedLenByteArray, Int96};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;
use std::sync::Arc;

/// The values of a column; `None` is null.
enum Values {
    Double(Vec<Option<f64>>),
    Float(Vec<f32>),
    Int64(Vec<i64>),
    Int32(Vec<i32>),
    Text(Vec<&'static str>),
    /// Of a fixed length, or not.
    Bytes(Vec<Vec<u8>>),
    Int96(Vec<[u32; 3]>),
}

fn write(schema: &str, groups: &[Vec<Values>], compression: Compression) -> Vec<u8> {
    let schema = Arc::new(parse_message_type(&format!("message imu {{ {schema} }}")).expect("a schema"));
    let properties = Arc::new(WriterProperties::builder().set_compression(compression).build());
    let mut writer = SerializedFileWriter::new(Vec::new(), schema, properties).expect("a writer");
    for group in groups {
        let mut rows = writer.next_row_group().expect("a row group");
        let mut columns = group.iter();
        while let Some(mut column) = rows.next_column().expect("a column") {
            match (column.untyped(), columns.next().expect("values")) {
                (ColumnWriter::DoubleColumnWriter(writer), Values::Double(values)) => {
                    let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
                    let present: Vec<f64> = values.iter().flatten().copied().collect();
                    writer.write_batch(&present, Some(&levels), None).expect("written");
                }
                (ColumnWriter::FloatColumnWriter(writer), Values::Float(values)) => {
                    writer.write_batch(values, None, None).expect("written");
                }
                (ColumnWriter::Int64ColumnWriter(writer), Values::Int64(values)) => {
                    writer.write_batch(values, None, None).expect("written");
                }
                (ColumnWriter::Int32ColumnWriter(writer), Values::Int32(values)) => {
                    writer.write_batch(values, None, None).expect("written");
                }
                (ColumnWriter::ByteArrayColumnWriter(writer), Values::Text(values)) => {
                    let values: Vec<ByteArray> = values.iter().map(|text| ByteArray::from(*text)).collect();
                    writer.write_batch(&values, None, None).expect("written");
                }
                (ColumnWriter::ByteArrayColumnWriter(writer), Values::Bytes(values)) => {
                    let values: Vec<ByteArray> = values.iter().cloned().map(ByteArray::from).collect();
                    writer.write_batch(&values, None, None).expect("written");
                }
                (ColumnWriter::FixedLenByteArrayColumnWriter(writer), Values::Bytes(values)) => {
                    let values: Vec<FixedLenByteArray> =
                        values.iter().cloned().map(|bytes| ByteArray::from(bytes).into()).collect();
                    writer.write_batch(&values, None, None).expect("written");
                }
                (ColumnWriter::Int96ColumnWriter(writer), Values::Int96(values)) => {
                    let values: Vec<Int96> = values.iter().map(|of| Int96::from(of.to_vec())).collect();
                    writer.write_batch(&values, None, None).expect("written");
                }
                _ => panic!("the schema has another type"),
            }
            column.close().expect("closed");
        }
        rows.close().expect("closed");
    }
    writer.into_inner().expect("finished")
}

/// The schema of the test files.
const SCHEMA: &str = "required int64 stamp (TIMESTAMP(NANOS,true)); optional double ax_mps2; optional double ay_mps2; optional double az_mps2; \
    required float gx_degps; required float gy_degps; required float gz_degps; required int32 temp_c; required binary label (UTF8);";
/// The first time stamp, ns.
const STAMP: i64 = 1_700_000_000_123_456_789;

fn group(from: i64) -> Vec<Values> {
    let doubles = |x: f64| Values::Double((0..3).map(|k| Some(x + 0.1 * (from + k) as f64)).collect());
    let floats = |x: f32| Values::Float((0..3).map(|k| x + (from + k) as f32).collect());
    vec![
        Values::Int64((0..3).map(|k| STAMP + 10_000_000 * (from + k)).collect()),
        if from == 0 { Values::Double(vec![Some(0.0), None, Some(0.2)]) } else { doubles(0.0) },
        doubles(1.0),
        doubles(9.5),
        floats(90.0),
        floats(0.5),
        floats(-1.5),
        Values::Int32((0..3).map(|k| 20 + (from + k) as i32).collect()),
        Values::Text(vec!["a", "b", "c"]),
    ]
}

fn read(bytes: &[u8], options: &ImuReadOptions) -> ImuFile {
    parse_imu_recording(bytes, options).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_table_reads_with_any_compression() {
    let groups = [group(0), group(3)];
    for compression in [
        Compression::UNCOMPRESSED,
        Compression::SNAPPY,
        Compression::LZ4_RAW,
        Compression::ZSTD(Default::default()),
        Compression::GZIP(Default::default()),
    ] {
        let file = read(&write(SCHEMA, &groups, compression), &ImuReadOptions::default());
        assert_eq!((file.format, file.rows), (FileFormat::Parquet, 6));
        let (accelerometer, gyroscope) = (
            file.recording[SensorKind::Accelerometer].as_ref().expect("there"),
            file.recording[SensorKind::Gyroscope].as_ref().expect("there"),
        );
        assert_eq!(gyroscope.times_s(), [0.0, 0.01, 0.02, 0.03, 0.04, 0.05]);
        assert_eq!(accelerometer.times_s(), [0.0, 0.02, 0.03, 0.04, 0.05], "the second has no x");
        assert_eq!(gyroscope.readings()[0].x, std::f64::consts::FRAC_PI_2);
        assert_eq!(accelerometer.readings()[2].as_slice(), [0.1 * 3.0, 1.0 + 0.1 * 3.0, 9.5 + 0.1 * 3.0]);
        assert_eq!(file.recording.temperature_c, Some(vec![20.0, 22.0, 23.0, 24.0, 25.0]));
        assert_eq!(
            findings(&file)[..2],
            [
                "times are counted from the first sample, where `stamp` is 1700000000123456789 ns",
                "accelerometer: 1 sample with a missing or NaN value dropped"
            ]
        );
        assert_eq!(file.columns[8].unused.as_deref(), Some("not known to be needed"));
    }
}

#[test]
fn a_compression_that_is_not_read_is_named_with_its_column() {
    let file = write(SCHEMA, &[group(0)], Compression::SNAPPY);
    // in the metadata, the codec follows the column's name: SNAPPY is 1, LZO 3 and BROTLI 4, each twice that
    let name = b"ay_mps2\x15\x02";
    let at = file.windows(name.len()).position(|bytes| bytes == name).expect("the column") + name.len() - 1;
    for (codec, says) in
        [(6, "column `ay_mps2` is compressed with LZO"), (8, "is compressed with brotli, which")]
    {
        let mut changed = file.clone();
        changed[at] = codec;
        let refused = parse_imu_recording(&changed, &ImuReadOptions::default()).expect_err("not read");
        assert_eq!(refused.code(), Refusal::FormatUnsupported);
        assert!(refused.to_string().contains(says), "{refused}");
    }
    let unused = b"label\x15\x02";
    let at =
        file.windows(unused.len()).position(|bytes| bytes == unused).expect("the column") + unused.len() - 1;
    let mut changed = file.clone();
    changed[at] = 8;
    assert_eq!(read(&changed, &ImuReadOptions::default()).rows, 3, "what is not needed is not unpacked");
}

#[test]
fn tables_that_cannot_be_used_say_why() {
    let simple = |schema: &str, columns: Vec<Values>| write(schema, &[columns], Compression::UNCOMPRESSED);
    let gyroscope = || {
        vec![Values::Float(vec![1.0, 2.0]), Values::Float(vec![1.0, 3.0]), Values::Float(vec![100.0, 2.0])]
    };
    let plain = ImuReadOptions::default();
    let columns = "required float gx; required float gy; required float gz;";
    let unitless = simple(
        &format!("required int64 time; {columns}"),
        [vec![Values::Int64(vec![0, 10])], gyroscope()].into_iter().flatten().collect(),
    );
    for (bytes, expected) in [
        (
            unitless.clone(),
            "the gyroscope's columns have no unit: magnitudes up to 100 suggest deg/s; the time column `time` has no unit: steps of 10 suggest ms \
             (say option `gyroscope_unit` rad/s, deg/s, mdps or counts (gyroscope_unit in [columns]); option `time_unit` s, ms, us or ns (time_unit in [columns]), or end its name in _s, _ms, _us or _ns)",
        ),
        (
            simple(
                "required int64 t_s; required binary gx_radps (UTF8); required float gy_radps; required float gz_radps;",
                vec![
                    Values::Int64(vec![0, 10]),
                    Values::Text(vec!["1", "2"]),
                    Values::Float(vec![1.0, 2.0]),
                    Values::Float(vec![1.0, 2.0]),
                ],
            ),
            "column `gx_radps` holds text, not numbers (write numbers: in SQL, CAST(\"gx_radps\" AS DOUBLE); is it the right column?)",
        ),
        (
            simple(
                "required int64 t_s; required float gx_radps; required float gy_radps; required float gz_radps;",
                vec![
                    Values::Int64(vec![0, 10]),
                    Values::Float(vec![1.0, f32::INFINITY]),
                    Values::Float(vec![1.0, 2.0]),
                    Values::Float(vec![1.0, 2.0]),
                ],
            ),
            "the value inf in row 2 is out of range (is the unit right? is the file damaged?)",
        ),
        (b"PAR1".to_vec(), "the Parquet file is damaged: "),
        (b"PAR1 and then nothing of the kindPAR1".to_vec(), "the Parquet file is damaged: "),
    ] {
        let message = parse_imu_recording(&bytes, &plain).expect_err("refused").to_string();
        assert!(message.starts_with(expected), "{message}");
    }
    let reported = ImuReadOptions {
        time_unit: Some(TimeUnit::Millisecond),
        ..units(ImuUnit::Counts, ImuUnit::DegreePerSecond)
    };
    assert_eq!(
        read(&unitless, &reported).recording[SensorKind::Gyroscope].clone().expect("there").times_s(),
        [0.0, 0.01]
    );
}

#[test]
fn a_table_that_is_damaged_is_refused_and_never_ends_the_program() {
    let whole = write(SCHEMA, &[group(0), group(3)], Compression::SNAPPY);
    std::panic::set_hook(Box::new(|_| ())); // a panic of the crate that reads the file is caught; its message is noise
    let (mut read, mut refused) = (0, 0);
    for at in 4..whole.len() {
        let mut bytes = whole.clone();
        bytes[at] ^= 0x55;
        for bytes in [&bytes[..], &whole[..at]] {
            match parse_imu_recording(bytes, &ImuReadOptions::default()) {
                Ok(_) => read += 1,
                Err(error) => {
                    assert!(error.is_invalid_recording());
                    refused += 1;
                }
            }
        }
    }
    drop(std::panic::take_hook());
    assert!(refused > read, "{refused} {read}");
}

/// A few bytes can state billions of equal values.
#[test]
fn a_table_beyond_the_budget_is_refused_before_it_is_read() {
    let bytes = write(SCHEMA, &[group(0), group(3)], Compression::UNCOMPRESSED);
    let within = |bytes| Some(Budget { bytes, ..Budget::USUAL });
    read(&bytes, &ImuReadOptions { budget: within(1e4), ..ImuReadOptions::default() });
    let options = ImuReadOptions { budget: within(1e3), ..ImuReadOptions::default() };
    let refused = parse_imu_recording(&bytes, &options).expect_err("refused");
    assert_eq!(refused.code(), Refusal::WorkTooLarge);
    assert!(refused.to_string().contains("a file of 6.0e0 rows would take about"), "{refused}");
}

/// The crate that decodes pages would reserve room for every value that a dictionary promises, up to 2³¹ of them.
#[test]
fn a_dictionary_that_promises_more_values_than_it_has_bytes_is_refused() {
    let mut bytes = write(SCHEMA, &[group(0)], Compression::UNCOMPRESSED);
    // a page of type 2 with two sizes, and in its dictionary's header 3 values (compact Thrift, zigzag)
    let is_header = |b: &[u8]| b[..3] == [0x15, 0x04, 0x15] && b[4] == 0x15 && b[6..] == [0x4c, 0x15, 0x06];
    let at = bytes.windows(9).position(is_header).expect("a dictionary of three values");
    bytes[at + 8] = 0x0e; // 7, which take 28 bytes at least
    let message = parse_imu_recording(&bytes, &ImuReadOptions::default()).expect_err("refused").to_string();
    assert!(
        message.contains("damaged") && message.contains("a dictionary of 7 values has 24 bytes"),
        "{message}"
    );
}

#[test]
fn one_absurd_number_of_a_table_is_a_invalid_sample() {
    let table = |invalid: usize| {
        let values = |axis: usize| (0..200).map(|k| ((7 * k + axis) % 101) as f32).collect::<Vec<_>>();
        let mut x = values(0);
        x[20..20 + invalid].fill(1e38);
        let times = (0..200).map(|k| 10 * k).collect();
        write(
            "required int64 t_ms; required float gx_radps; required float gy_radps; required float gz_radps;",
            &[vec![
                Values::Int64(times),
                Values::Float(x),
                Values::Float(values(1)),
                Values::Float(values(2)),
            ]],
            Compression::UNCOMPRESSED,
        )
    };
    let read = |invalid| parse_imu_recording(&table(invalid), &ImuReadOptions::default());
    let recording = read(1).expect("read").recording[SensorKind::Gyroscope].clone().expect("there");
    assert_eq!(recording.readings()[20].x, f64::from(1e38_f32));
    let message = read(5).expect_err("refused").to_string();
    assert!(
        message.starts_with("the value 9.99999968028569")
            && message.contains("e37 in row 21 is out of range"),
        "{message}"
    );
}

/// A table of one gyroscope with these columns for x, y and z, and this one for the time.
fn gyroscope(time: (&str, Values), axes: [(&str, Values); 3]) -> Result<ImuFile, String> {
    let [x, y, z] = axes;
    let schema: Vec<String> = [&time, &x, &y, &z].map(|(column, _)| format!("required {column};")).to_vec();
    let columns = vec![time.1, x.1, y.1, z.1];
    let bytes = write(&schema.concat(), &[columns], Compression::UNCOMPRESSED);
    parse_imu_recording(&bytes, &ImuReadOptions::default()).map_err(|error| error.to_string())
}

fn floats() -> [(&'static str, Values); 3] {
    ["float gx_radps", "float gy_radps", "float gz_radps"].map(|name| (name, Values::Float(vec![0.1, 0.2])))
}

#[test]
fn a_decimal_is_the_number_that_its_digits_say() {
    let time = || ("int64 t_ms", Values::Int64(vec![0, 10]));
    let bytes = |width: usize| {
        Values::Bytes([-17_500_i64, 12_345].map(|n| n.to_be_bytes()[8 - width..].to_vec()).to_vec())
    };
    for (column, values) in [
        ("int32 gx_degps (DECIMAL(9,4))", Values::Int32(vec![-17_500, 12_345])),
        ("int64 gx_degps (DECIMAL(15,4))", Values::Int64(vec![-17_500, 12_345])),
        ("fixed_len_byte_array(3) gx_degps (DECIMAL(6,4))", bytes(3)),
        ("binary gx_degps (DECIMAL(12,4))", bytes(5)),
    ] {
        let axes = ["double gy_degps", "double gz_degps"]
            .map(|name| (name, Values::Double(vec![Some(0.5), Some(1.0)])));
        let [y, z] = axes;
        let file =
            gyroscope(time(), [(column, values), y, z]).unwrap_or_else(|error| panic!("{column}: {error}"));
        let read: Vec<f64> = file.recording[SensorKind::Gyroscope]
            .clone()
            .expect("there")
            .readings()
            .iter()
            .map(|of| of.x)
            .collect();
        assert_eq!(read, [-1.75_f64, 1.2345].map(|degps| degps * (std::f64::consts::PI / 180.0)), "{column}");
    }
    let time = ("int64 t_s (DECIMAL(18,3))", Values::Int64(vec![1000, 1010]));
    assert_eq!(
        gyroscope(time, floats()).expect("read").recording[SensorKind::Gyroscope]
            .clone()
            .expect("there")
            .times_s(),
        [1.0, 1.01]
    );
}

#[test]
fn a_type_states_the_unit_of_a_time_and_the_sign_of_a_number() {
    // nanoseconds of the day after the Julian day of 1970-01-01
    let later = |ns: u64| [ns as u32, (ns >> 32) as u32, 2_440_588 + 1];
    let day = 86_400_000;
    for (time, values) in [
        ("int32 clock_of_day (TIME(MILLIS,false))", Values::Int32(vec![day - 10, 0])),
        ("int64 time (TIME(MICROS,true))", Values::Int64(vec![1000, 11_000])),
        ("int64 stamp (TIMESTAMP(MILLIS,false))", Values::Int64(vec![1_700_000_000_000, 1_700_000_000_010])),
        ("int96 stamp", Values::Int96(vec![later(3_600_000_000_000), later(3_600_010_000_000)])),
        ("int32 t_ms (INTEGER(32,false))", Values::Int32(vec![i32::MAX, i32::MIN + 9])),
    ] {
        let file = gyroscope((time, values), floats()).unwrap_or_else(|error| panic!("{time}: {error}"));
        let times_s = file.recording[SensorKind::Gyroscope].clone().expect("there").times_s().to_vec();
        assert!((times_s[1] - times_s[0] - 0.01).abs() < 1e-9, "{time}: {times_s:?}");
    }
}

#[test]
fn types_without_numbers_are_named() {
    let time = || ("int64 t_ms", Values::Int64(vec![0, 10]));
    let [_, y, z] = floats();
    let half = ("fixed_len_byte_array(2) gx_radps (FLOAT16)", Values::Bytes(vec![vec![0, 60]; 2]));
    let message = gyroscope(time(), [half, y, z]).expect_err("refused");
    assert!(message.starts_with("column `gx_radps` holds numbers of half precision, float16"), "{message}");
    let schema =
        "required int64 t_ms; required group acc (LIST) { repeated group list { required double element; } }";
    let list = write(schema, &[], Compression::UNCOMPRESSED);
    let message = parse_imu_recording(&list, &ImuReadOptions::default()).expect_err("refused").to_string();
    assert!(message.contains("`acc` holds a list in each row: write a column for each axis"), "{message}");
}

#[test]
fn a_gyroscope_that_no_sensor_is_like_is_refused() {
    let table = |largest: f32| {
        let values = |axis: i32| {
            Values::Float((0..200).map(|k| ((7 * k + axis) % 101) as f32 / 101.0 * largest).collect())
        };
        let axes =
            [("float gx_radps", values(0)), ("float gy_radps", values(1)), ("float gz_radps", values(2))];
        gyroscope(("int64 t_ms", Values::Int64((0..200).map(|k| 10 * k).collect())), axes)
    };
    table(300.0).expect("fast, but there are such sensors");
    let message = table(20_000.0).expect_err("refused");
    assert!(message.contains("beyond 1000 rad/s, which no gyroscope measures"), "{message}");
}

#[test]
fn rows_in_any_order_are_sorted_by_their_clock() {
    let table = |order: &dyn Fn(usize) -> usize, name: &str| {
        let rows: Vec<usize> = (0..400).map(order).collect();
        let values =
            |shift: f64| Values::Double(rows.iter().map(|&k| Some((k as f64 * 0.1 + shift).sin())).collect());
        let axes = [
            ("double gx_radps", values(0.0)),
            ("double gy_radps", values(1.0)),
            ("double gz_radps", values(2.0)),
        ];
        gyroscope((name, Values::Int64(rows.iter().map(|&k| 10 * k as i64).collect())), axes)
    };
    let straight = table(&|k| k, "int64 t_ms").expect("read").recording;
    // row groups that were written in parallel, and rows that overtook each other
    let orders: [&dyn Fn(usize) -> usize; 2] = [&|k| (k + 100) % 400, &|k| k / 8 * 8 + (3 * k) % 8];
    for order in orders {
        let file = table(order, "int64 t_ms").expect("sorted");
        assert_eq!(file.recording, straight);
        let said = findings(&file);
        assert!(
            said.iter().any(|said| said.contains("come after a later one: they were sorted by `t_ms`")),
            "{said:?}"
        );
    }
    // the times of two recordings are not mixed, whatever rate is given
    let message = table(&|k| 2 * (k % 200) + k / 200, "int64 t_ms").expect_err("refused");
    assert!(message.starts_with("time goes backwards, from 3.98 s to 0.01 s"), "{message}");
}
