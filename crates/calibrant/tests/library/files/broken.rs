//! Tests of broken recordings and motions: every message word for word.

use calibrant::io::{ImuReadOptions, parse_imu_recording, parse_motion, read_imu_recording, read_motion};
use calibrant::sensor::ReadingUnit;

/// The bytes of a file and the message about it.
type Case = (&'static [u8], &'static str);

/// The options of all these readings.
fn options() -> ImuReadOptions {
    ImuReadOptions::accelerometer(3, ReadingUnit::MetrePerSecondSquared)
}

#[test]
fn recordings() {
    let directory = tempfile::tempdir().expect("a directory");
    for (bytes, expected) in RECORDINGS {
        let error = parse_imu_recording(bytes, &options()).expect_err(expected);
        assert_eq!(error.to_string(), *expected);
        assert!(error.is_invalid_recording() && !error.is_invalid_experiment());
        let path = directory.path().join("recording.csv");
        std::fs::write(&path, bytes).expect("written");
        let named = read_imu_recording(&path, &options()).expect_err(expected).to_string();
        let input_error = error.input_error().expect("a complaint");
        let place: String =
            [input_error.line, input_error.column].iter().flatten().map(|n| format!(":{n}")).collect();
        assert!(named.starts_with(&format!("{}{place}: ", path.display())), "{named}");
        assert!(named.contains(&input_error.message), "{named}");
    }
}

#[test]
fn motions() {
    for (bytes, expected) in MOTIONS {
        let error = parse_motion(bytes, 3).expect_err(expected);
        assert_eq!(error.to_string(), *expected);
        assert!(error.is_invalid_experiment() && !error.is_invalid_recording());
    }
}

#[test]
fn what_is_no_file_is_named() {
    let directory = tempfile::tempdir().expect("a directory");
    let error = read_imu_recording(directory.path(), &options()).expect_err("a directory");
    assert!(error.is_invalid_recording());
    assert!(
        error.to_string().ends_with("this is a directory, not the recording (name a file in it)"),
        "{error}"
    );
    let absent = directory.path().join("absent.csv");
    let error = read_motion(&absent, 3).expect_err("absent");
    assert!(error.is_invalid_experiment());
    assert!(
        error.to_string().starts_with(&format!("{}: cannot read the motion: ", absent.display())),
        "{error}"
    );
    assert!(error.to_string().ends_with("(check the name and the working directory)"), "{error}");
}

#[cfg(target_os = "linux")]
#[test]
fn an_endless_device_is_refused_at_once() {
    let error = read_imu_recording("/dev/zero".as_ref(), &options()).expect_err("zeros");
    assert!(error.to_string().contains("binary data, not text: NUL byte at offset 0"), "{error}");
}

/// The broken recordings.
const RECORDINGS: &[Case] = &[
    (
        b"",
        "the file is empty (a recording has a header, such as t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps, and a row for each sample)",
    ),
    (
        b"\n \n\n",
        "the file is empty (a recording has a header, such as t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps, and a row for each sample)",
    ),
    (
        b"# nothing\n// here\n",
        "the file has only comments (a recording has a header, such as t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps, and a row for each sample)",
    ),
    (
        b"t_s,ax,ay,az\n",
        "line 1: there is a header but no sample below it (a recording needs two samples at least)",
    ),
    (
        b"t_s,ax,ay,az\n0,1,2,3\n",
        "line 2: only 1 usable sample of the accelerometer in 1 row (a recording needs two samples at least)",
    ),
    (
        b"t_s,ax,ay,az\n0,1,2,3\n0,1,2,3\n1,nan,2,3\n",
        "line 4: only 1 usable sample of the accelerometer in 3 rows (a recording needs two samples at least; line 3: 1 row equal to the one before dropped; line 4: accelerometer: 1 sample with a missing or NaN value dropped)",
    ),
    (
        b"t_s,ax,ay,temp\n0,1,2,3\n1,2,3,4\n",
        "line 1: the accelerometer has no column for axis z (a recording of an accelerometer has the columns t_s,ax,ay,az)",
    ),
    (
        b"time;x;y;z\n0;1;2;3\n",
        "the accelerometer's columns have no unit: magnitudes around 3.74 do not tell; the time column `time` has no unit (say option `accelerometer_unit` m/s², mm/s², g, mg or counts (accelerometer_unit in [columns]); option `time_unit` s, ms, us or ns (time_unit in [columns]), or end its name in _s, _ms, _us or _ns)",
    ),
    (
        b"t_s,ax_mps2,ax_counts,ay_mps2,az_mps2\n0,1,2,3,4\n",
        "line 1: two columns hold the accelerometer x: `ax_mps2` and `ax_counts` (say which in [columns] of an experiment file)",
    ),
    (
        b"t_s,ax_mps2,ay_g,az_mps2\n0,1,2,3\n",
        "line 1: the axes of the accelerometer have different units: `ax_mps2` has m/s², `ay_g` has g (all axes need the same)",
    ),
    (
        b"t_s,ax,ay_g,az\n0,1,2,3\n",
        "line 1: the axes of the accelerometer have different units: `ax` has no stated unit, `ay_g` has g (all axes need the same)",
    ),
    (
        b"t_s,t_s,ax,ay,az\n0,0,1,2,3\n",
        "line 1: two columns hold the time: `t_s` and `t_s` (rename one of them in the file)",
    ),
    (
        b"t_s,ax,ay,az\n0,1,2,3\n1,1,2,3\n0.5,1,2,3\n",
        "line 4: time goes backwards, from 1.0 s to 0.5 s (are these files put together, or did a counter wrap? split the file here)",
    ),
    (
        b"t_s,ax,ay,az\n0,1,2,3\n1,1,2,3\nt_s,ax,ay,az\n0,1,2,3\n",
        r#"line 4, column 1: "t_s" in column `t_s` is not a number (a second header: are these files put together? keep one of them)"#,
    ),
    (
        b"t_s,ax,ay,az\n0,1,2,3\n1,1,oops,3\n2,1,2,3\n",
        r#"line 3, column 5: "oops" in column `ay` is not a number (numbers look like 9.81 or 1e-3; a missing value is an empty field or NaN)"#,
    ),
    (
        "t_s,ax,ay,az\n0,1,2,3\n1,µ1,2,3\n2,1,2,3\n".as_bytes(),
        r#"line 3, column 3: "µ1" in column `ax` is not a number (numbers look like 9.81 or 1e-3; a missing value is an empty field or NaN)"#,
    ),
    (
        b"t_s,ax,ay,az\n0,0,1,5,2,5,3,5\n1,0,1,5,2,5,3,5\n",
        "line 2: 8 columns where the header has 4 (numbers need a decimal point, not a comma; columns need one delimiter, and a name each: R writes row names without one (row.names = FALSE))",
    ),
    (
        b"t_s,ax,ay,az\n0,1,2,3\n1,1,2\n2,1,2,3\n",
        "line 3: 3 columns where the header has 4 (was the line cut off, or written while the file was read?)",
    ),
    (
        b"t_s,ax,ay,az\n0,1,2,3\n1,1,2,3,4\n2,1,2,3\n",
        "line 3: 5 columns where the header has 4 (numbers need a decimal point, not a comma; columns need one delimiter, and a name each: R writes row names without one (row.names = FALSE))",
    ),
    (
        b"0 1 2\n1 2 3\n",
        r#"line 1: 3 columns where 4 are needed (without a header the columns are t x y z; where each row is the mean of a hold, say option `rows_are_holds`; or say what they hold in [columns] of an experiment file (of a file of its own for option `columns`), a line each, such as rate_hz = 100, accelerometer = ["1", "2", "3"], accelerometer_unit = "m/s²")"#,
    ),
    (
        b"t_s,ax,ay,az\n0,1,2,3\n1,inf,2,3\n2,1,2,3\n",
        r#"line 3, column 3: "inf" in column `ax` is out of range (is the unit right? is the file damaged?)"#,
    ),
    (
        b"t_s,ax,ay,az\n0,1,2,3\n1,1,2,1e13\n2,1,2,3\n",
        r#"line 3, column 7: "1e13" in column `az` is out of range (is the unit right? is the file damaged?)"#,
    ),
    (
        b"t_s,ax,ay,az\n1763690000000000,1,2,3\n",
        r#"line 2, column 1: "1763690000000000" in column `t_s` is out of range (times are in seconds)"#,
    ),
    (
        b"t_s,ax,ay,az\n0,1,\x002,3\n",
        "this is binary data, not text: NUL byte at offset 17 (export the data as text)",
    ),
    (
        b"t_s,ax,ay,az\n0,1,2,3\n# caf\xe9\n",
        "line 3: not UTF-8 text: byte 0xe9 at offset 26 (save it as UTF-8 (or plain ASCII))",
    ),
    (
        b"\xff\xfet\x00_\x00s\x00,\x00a\x00x\x00\n\x00",
        "the text is encoded in UTF-16 (save it as UTF-8 (or plain ASCII))",
    ),
];

/// The broken motions.
const MOTIONS: &[Case] = &[
    (b"", "the file is empty (a motion has the header t_s,ax_mps2,ay_mps2,az_mps2 and a row for each node)"),
    (
        b"t_s,ax_mps2,ay_mps2,az_mps2\n",
        "a motion needs at least two nodes, this one has 0 (a motion has the header t_s,ax_mps2,ay_mps2,az_mps2 and a row for each node)",
    ),
    (
        b"0,1,2,3\n1,2,3,4\n",
        "line 1, column 1: there is no header, the first field is 0 (the header is t_s,ax_mps2,ay_mps2,az_mps2)",
    ),
    (
        b"t_s,ax_mps2,ay_mps2\n0,1,2\n",
        "line 1: column az_mps2 is missing (the header is t_s,ax_mps2,ay_mps2,az_mps2)",
    ),
    (
        b"t_s,ax_mps2,ay_mps2,az_mps2,vx\n0,1,2,3,4\n",
        "line 1, column 29: column `vx` is not known (the header is t_s,ax_mps2,ay_mps2,az_mps2)",
    ),
    (
        b"t_s,ax_mps2,ay_mps2,az_mps2,t_s\n0,1,2,3,4\n",
        "line 1, column 29: column `t_s` is there twice (the header is t_s,ax_mps2,ay_mps2,az_mps2)",
    ),
    (
        b"t_s,ax,ay,az\n0,1,2,3\n",
        "line 1, column 5: column `ax` is not known (the header is t_s,ax_mps2,ay_mps2,az_mps2)",
    ),
    (
        b"t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,3\n",
        "a motion needs at least two nodes, this one has 1 (a motion has the header t_s,ax_mps2,ay_mps2,az_mps2 and a row for each node)",
    ),
    (
        b"t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,3\n1,nan,2,3\n",
        r#"line 3, column 3: "nan" for axis x is not a usable number (times are in s, accelerations in m/s²)"#,
    ),
    (
        b"t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,3\n1,,2,3\n",
        r#"line 3, column 3: "" for axis x is not a number (numbers look like 9.81 or 1e-3)"#,
    ),
    (
        b"t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,3\ninf,1,2,3\n",
        r#"line 3, column 1: "inf" for the time is not a usable number (times are in s, accelerations in m/s²)"#,
    ),
    (
        b"t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,3\n1,1e10,2,3\n",
        r#"line 3, column 3: "1e10" for axis x is not a usable number (times are in s, accelerations in m/s²)"#,
    ),
    (
        b"t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,3\n1,1,x,3\n",
        r#"line 3, column 5: "x" for axis y is not a number (numbers look like 9.81 or 1e-3)"#,
    ),
    (
        b"t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,3\n1,1,2\n",
        "line 3: 3 columns where the header has 4 (every node needs a time and an acceleration for each axis)",
    ),
    (
        b"t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,3\n1,1,2,3\n1,4,5,6\n",
        "line 4: node times must increase: 1.0 s comes after 1.0 s (sort the rows and remove duplicates)",
    ),
    (b"t_s,ax_mps2\x00", "this is binary data, not text: NUL byte at offset 11 (export the data as text)"),
    (
        b"t_s,ax_mps2\xff",
        "line 1: not UTF-8 text: byte 0xff at offset 11 (save it as UTF-8 (or plain ASCII))",
    ),
];
