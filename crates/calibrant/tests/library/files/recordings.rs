//! Tests of recordings that can be used: every dialect, and every finding in words.

use calibrant::Error;
use calibrant::diagnostic::Code;
use calibrant::diagnostic::reader::{
    AxisStuck, ColumnsIgnored, LineTruncated, ReadingsClipped, SamplingGap, SamplingIrregular, UnitUnexpected,
};
use calibrant::diagnostic::{Check, Diagnostic};
use calibrant::io::{ImuReadOptions, ImuUnit, parse_imu_recording};
use calibrant::sensor::{ReadingUnit, Recording, SensorKind};

/// A recording as it was read.
#[derive(Debug)]
struct Read {
    recording: Recording,
    findings: Vec<Diagnostic>,
    sha256: String,
}

fn read(bytes: &[u8], options: &ImuReadOptions) -> Result<Read, Error> {
    let file = parse_imu_recording(bytes, options)?;
    let recording = file.recording[SensorKind::Accelerometer].clone().expect("there");
    Ok(Read { recording, findings: file.findings, sha256: file.sha256.concat() })
}

fn options(axes: usize) -> ImuReadOptions {
    ImuReadOptions::accelerometer(axes, ReadingUnit::MetrePerSecondSquared)
}

fn parse(bytes: &[u8]) -> Read {
    read(bytes, &options(3)).unwrap_or_else(|error| panic!("{error}"))
}

/// The only finding, and the number of remaining samples.
fn finding(text: &str) -> (Code, String, usize) {
    let file = parse(text.as_bytes());
    assert_eq!(file.findings.len(), 1, "{:?}", file.findings);
    (file.findings[0].code(), file.findings[0].to_string(), file.recording.len())
}

/// A header and 200 rows with three axes that change.
fn rows(row: impl Fn(usize) -> String) -> String {
    (0..200).fold("t_s,ax,ay,az\n".to_owned(), |text, k| text + &row(k) + "\n")
}

#[test]
fn all_dialects_read_the_same() {
    let plain = parse(b"t_s,ax,ay,az\n0,1,2,3\n1,2,3,4\n");
    assert!(plain.findings.is_empty());
    assert_eq!(plain.sha256, "380f9ee2710fccdef458d6bbb6dcbd39173fc7a919504f0d7be326d73470216d");
    let dialects: &[&[u8]] = &[
        b"\xef\xbb\xbf\"t_s\";\"ax\";\"ay\";\"az\";\r\n0;1;2;3;\r\n1;2;3;4;\r\n\r\n\r\n",
        b"t_s,ax,ay,az\r0,1,2,3\r1,2,3,4\r",
        b"t_s,ax,ay,az\r0,1,2,3\r1,2,3,4\n",
        b"t_s,ax,ay,az\r0,1,2,3\r1,2,3,4\r\n",
        b"% comment\n0\t1\t2\t3\n// another\n1\t2\t3\t4\n",
        b" 0.0, 1, 2, 3\n 1.0, 2, 3, 4",
        b"   0.0e+00   1.0e+00   2.0e+00   3.0e+00\n   1.0e+00   2.0e+00   3.0e+00   4.0e+00\n",
        b"\n# T_S is the time\nT_S AX AY AZ\n0 1 2 3\n\n1 2 3 4\n",
        b"az,ay,ax,t_s\n3,2,1,0\n4,3,2,1\n",
        b"t_s,ax_mps2,ay_mps2,az_mps2\n0,+1,2.,3\n1,2,3,.4e1\n",
    ];
    for dialect in dialects {
        let file = parse(dialect);
        assert_eq!(file.recording, plain.recording, "{}", String::from_utf8_lossy(dialect));
        assert!(file.findings.is_empty());
    }
}

#[test]
fn the_unit_comes_from_the_header_then_the_option_then_the_experiment() {
    use ReadingUnit::{Counts, MetrePerSecondSquared};
    let read = |header: &str, unit: Option<ReadingUnit>, expected| {
        let text = format!("t_s,{header}\n0,1,2,3\n1,2,3,4\n");
        let options = ImuReadOptions::accelerometer(3, expected);
        read(text.as_bytes(), &ImuReadOptions { accelerometer_unit: unit.map(ImuUnit::from), ..options })
    };
    let unit = |header, unit, expected| read(header, unit, expected).expect("good").recording.unit();
    assert_eq!(unit("ax,ay,az", None, Counts), Counts);
    assert_eq!(unit("ax,ay,az", Some(MetrePerSecondSquared), Counts), MetrePerSecondSquared);
    assert_eq!(unit("ax_counts,ay_counts,az_counts", Some(Counts), MetrePerSecondSquared), Counts);
    assert_eq!(unit("ax_mps2,ay_mps2,az_mps2", None, MetrePerSecondSquared), MetrePerSecondSquared);
    let contradiction = |header, unit| read(header, Some(unit), unit).expect_err("contradiction").to_string();
    let help = "(leave option `unit` away: the file decides (name the columns in [columns] to overrule it))";
    assert_eq!(
        contradiction("ax_counts,ay_counts,az_counts", MetrePerSecondSquared),
        format!("line 1: the accelerometer's columns are in counts, but the unit was given as m/s² {help}")
    );
    assert_eq!(
        contradiction("ax_g,ay_g,az_g", MetrePerSecondSquared),
        format!("line 1: the accelerometer's columns are in g, but the unit was given as m/s² {help}")
    );
    let file = read("ax_g,ay_g,az_g", None, Counts).expect("good");
    assert_eq!(file.recording.readings()[1].as_slice(), [2.0 * 9.80665, 3.0 * 9.80665, 4.0 * 9.80665]);
    assert_eq!(
        file.findings[0].to_string(),
        "line 1: readings are in m/s² by their header, the experiment says counts"
    );
    assert_eq!(file.findings[0].code(), UnitUnexpected::CODE);
}

#[test]
fn one_axis_needs_one_column() {
    for text in ["t_s,ax\n0,1\n1,2\n", "0 1\n1 2\n", "t_s,ax,ay,az\n0,1,x,\n1,2,,\n"] {
        let file = read(text.as_bytes(), &options(1)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(file.recording.axes(), 1);
        assert_eq!(file.recording.readings()[1].as_slice(), [2.0, 0.0, 0.0]);
    }
}

#[test]
fn samples_that_are_missing_or_twice_are_dropped_with_a_word() {
    use calibrant::diagnostic::reader::{RowsRepeated, TimesRepeated, ValuesMissing};
    assert_eq!(
        finding("t_s,ax,ay,az\n0,1,2,3\n1,,2,3\n2,NaN,2,3\n3,1,NA,3\n4,2,3,4\n"),
        (ValuesMissing::CODE, "line 3: 3 samples with a missing or NaN value dropped (first here)".into(), 2)
    );
    assert_eq!(
        finding("t_s,ax,ay,az\n0,1,2,3\n0,1,2,3\n1,2,3,4\n2,2,2,2\n2,2,2,2\n"),
        (RowsRepeated::CODE, "line 3: 2 rows equal to the one before dropped (first here)".into(), 3)
    );
    assert_eq!(
        finding("t_s,ax,ay,az\n0,1,2,3\n1,2,3,4\n1,5,5,5\n2,2,2,2\n"),
        (
            TimesRepeated::CODE,
            "line 4: 1 row with the time of the one before but another reading dropped".into(),
            3
        )
    );
}

#[test]
fn a_last_line_that_was_cut_off_is_dropped_with_a_word() {
    let expected = |line| (LineTruncated::CODE, format!("line {line}: truncated last line dropped"));
    for (text, line) in [
        ("t_s,ax,ay,az\n0,1,2,3\n1,2,3,4\n2,3,4", 4),
        ("t_s,ax,ay,az\n0,1,2,3\n1,2,3,4\n2", 4),
        ("t_s,ax,ay,az\n0,1,2,3\n1,2,3,4\n2,3,4,5e", 4),
        ("0 1e+00 2 3\n1 2e+00 3 4\n2 3e+00 4 5\n3 4e+00 5", 4),
        ("0 1 2 3e+00\n1 2 3 4e+00\n2 3 4 5e+00\n3 4 5 6e+0", 4), // complete, but shorter than all others
    ] {
        let (kind, message, _) = finding(text);
        assert_eq!((kind, message), expected(line));
    }
    // the last number has fewer digits than any before
    let rows: String = (0..10).map(|k| format!("0.{k},{k},{},9.80{k}\n", k * k)).collect();
    let (kind, message, samples) = finding(&format!("t_s,ax,ay,az\n{rows}1.0,3,2,9.8"));
    assert_eq!(((kind, message), samples), (expected(12), 10));
    // a last line that only lacks its end is whole
    assert_eq!(parse(b"t_s,ax,ay,az\n0,1,2,3\n1,2,3,4\n2,3,4,5").recording.len(), 3);
}

#[test]
fn columns_that_are_not_needed_are_named() {
    let (kind, message, _) = finding("t_s,ax,ay,az,temp,flag\n0,1,2,3,4,5\n1,2,3,4,5,x\n");
    assert_eq!((kind, message.as_str()), (ColumnsIgnored::CODE, "line 1: ignored columns `temp`, `flag`"));
    let (_, message, _) = finding("0 1 2 3 9 9\n1 2 3 4 9 9\n");
    assert_eq!(message, "line 1: ignored columns `5`, `6`");
}

#[test]
fn an_axis_that_never_changes_is_told() {
    let (kind, message, _) = finding("t_s,ax,ay,az\n0,1,0,3\n1,2,0,4\n");
    assert_eq!(kind, AxisStuck::CODE);
    assert_eq!(message, "axis y never changes: 0 throughout; is it connected?");
}

#[test]
fn gaps_are_told_with_place_and_length_and_not_too_many() {
    let one = rows(|k| {
        format!("{:.2},{},{},{}", 0.01 * k as f64 + if k < 20 { 0.0 } else { 10.0 }, k % 7, k % 5, k % 3)
    });
    let (kind, message, _) = finding(&one);
    assert_eq!(kind, SamplingGap::CODE);
    assert_eq!(message, "line 22: gap of 10.01 s after t = 0.19 s: about 1000 samples are missing");
    let many = rows(|k| format!("{:.2},{},{},{}", 0.01 * k as f64 + (k / 10) as f64, k % 7, k % 5, k % 3));
    let messages: Vec<String> = parse(many.as_bytes()).findings.iter().map(ToString::to_string).collect();
    assert_eq!(messages.len(), 4);
    assert!(messages[3].contains("and 16 more gaps; the longest is 1.01 s after t = "), "{}", messages[3]);
    let four =
        rows(|k| format!("{:.2},{},{},{}", 1.7e9 + 0.01 * k as f64 + (k / 40) as f64, k % 7, k % 5, k % 3));
    let messages: Vec<String> = parse(four.as_bytes()).findings.iter().map(ToString::to_string).collect();
    assert_eq!(
        messages[0],
        "line 42: gap of 1.01 s after t = 1700000000.39 s: about 100 samples are missing"
    );
    assert!(messages[3].contains("and 1 more gap; the longest is "), "{}", messages[3]);
}

#[test]
fn irregular_sampling_is_told_once() {
    let text = rows(|k| format!("{},{},{},{}", 0.01 * k as f64 + 3e-4 * (k % 2) as f64, k % 7, k % 5, k % 3));
    let (kind, message, _) = finding(&text);
    assert_eq!(kind, SamplingIrregular::CODE);
    assert!(
        message.starts_with("sampling is irregular: time steps from 9.7 to 10.3 ms, usually "),
        "{message}"
    );
    // half a percent needs no finding, nor does the rounding of time stamps that began in 1970
    let text = rows(|k| format!("{},{},{},{}", 0.01 * k as f64 + 5e-5 * (k % 2) as f64, k % 7, k % 5, k % 3));
    assert!(parse(text.as_bytes()).findings.is_empty());
    let text = rows(|k| format!("{},{},{},{}", 1.7e9 + 1e-5 * k as f64, k % 7, k % 5, k % 3));
    assert!(parse(text.as_bytes()).findings.is_empty());
}

#[test]
fn clipped_readings_are_told_but_still_ones_are_not() {
    let swing = |k: usize| ((k as f64 * 0.1).sin() * 30.0).clamp(-20.0, 25.0);
    let file = parse(rows(|k| format!("{k},{},{},{}", swing(k), k % 5, k % 3)).as_bytes());
    let messages: Vec<String> = file.findings.iter().map(ToString::to_string).collect();
    assert!(file.findings.iter().all(|finding| finding.code() == ReadingsClipped::CODE));
    let expected = [
        "line 41: axis x may be saturated: 17 samples in a row at its smallest value -20 m/s²",
        "line 12: axis x may be saturated: 12 samples in a row at its largest value 25 m/s²",
    ];
    assert_eq!(messages, expected);
    // a quiet sensor in a few orientations repeats its readings everywhere
    let still = rows(|k| format!("{},{},{},{}", k, [9.81, 0.0, -9.81, 3.0][k / 50], k % 5, k % 3));
    assert!(parse(still.as_bytes()).findings.is_empty());
}
