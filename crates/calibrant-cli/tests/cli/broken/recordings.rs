//! Tests of broken recordings: exit status 3, the line in the message.

use super::{CALIBRATE, bench};

/// The bytes of a recording and the message about it.
const CASES: &[(&[u8], &str)] = &[
    (b"", ": the file is empty (a recording has a header, such as t_s,ax_mps2,"),
    (b"\n\n  \n", ": the file is empty"),
    (b"# only a comment\n", ": the file has only comments"),
    (b"t_s,ax,ay,az\n", ":1: there is a header but no sample below it"),
    (b"t_s,ax,ay,az\n0,1,2,3\n", ":2: only 1 usable sample of the accelerometer in 1 row"),
    (b"\x7fELF\x02\x01\x01\0\0\0", ": this is binary data, not text: NUL byte at offset 7"),
    (b"PK\x03\x04\x14\0\0\0", ": this file is compressed with zip (unpack it first: unzip FILE; a workbook"),
    (b"\x1f\x8b\x08\0\0\0\0\0", ": this file is compressed with gzip (unpack it first: gunzip FILE)"),
    (b"\x1f\x8b\x08\x01\x02\n\x03", ": this file is compressed with gzip"),
    (b"\x28\xb5\x2f\xfd\0\x01", ": this file is compressed with zstd (unpack it first: unzstd FILE)"),
    (b"\xfd7zXZ\0\0\x04", ": this file is compressed with xz (unpack it first: unxz FILE)"),
    (b"BZh91AY&SY\xe8\0", ": this file is compressed with bzip2 (unpack it first: bunzip2 FILE)"),
    (b"BZh,1,2,3\n0,1,2,3\n", ":1:1: \"BZh\" in column 1 is not a number"),
    (
        b"t_s,ax,ay,az\r0,1,2,3\n1,1,2,3\r",
        ":1: 1 line end is a lone CR, as on an old Mac, others are LF (end all lines alike: tr",
    ),
    (b"t_s,ax,ay,az\n0,1,2,3\r1,1,2,3\r2,1,2,3\r", ":2: 2 line ends are a lone CR, as on an old Mac"),
    (b"\xff\xfet\0_\0s\0", ": the text is encoded in UTF-16"),
    (b"t_s,ax,ay,az\n0,1,2,3\n\xfc,1,2,3\n", ":3: not UTF-8 text: byte 0xfc"),
    (
        b"t_s,ax,ay,az\n0,nan,2,3\n1,nan,2,3\n",
        ": the columns of the accelerometer are empty (were they recorded, and exported?)",
    ),
    (b"t_s,ax,ay,az\n0,1,2,3\n1,1e300,2,3\n2,1,2,3\n", ":3:3: \"1e300\" in column `ax` is out of range"),
    (b"t_s,ax,ay,az\n0,1,2,3\n1,1,-inf,3\n2,1,2,3\n", ":3:5: \"-inf\" in column `ay` is out of range"),
    (b"t_s,ax,ay,az\n1e300,1,2,3\n2e300,1,2,3\n", ":2:1: \"1e300\" in column `t_s` is out of range"),
    (b"t_s,ax,ay,az\n0,1,2,3\n0,1,2,3\n0,1,2,3\n", ":4: only 1 usable sample of the accelerometer in 3 rows"),
    (b"t_s,ax,ay,az\n0,1,2,3\n2,1,2,3\n1,1,2,3\n", ":4: time goes backwards, from 2.0 s to 1.0 s"),
    (b"t_s,ax,ay,az\n0,1,2,3\n1,1,2\n2,1,2,3\n", ":3: 3 columns where the header has 4"),
    (b"t_s,ax,ay,az\n0,1,2,3\n1,1,2,3,4\n", ":3: 5 columns where the header has 4"),
    (b"t_s,ax,ay,az\n0,1,2,3\n1,one,2,3\n2,1,2,3\n", ":3:3: \"one\" in column `ax` is not a number"),
    (b"t_s,ax,ay\n0,1,2\n1,2,3\n", ":1: the accelerometer has no column for axis z"),
    (
        b"time,x,y,z\n0,1,2,3\n1,2,3,4\n",
        ": the accelerometer's columns have no unit: magnitudes around 5.39 do not tell; the time column `time` has no unit",
    ),
    (b"t_s,ax_g,ay_counts,az\n0,1,2,3\n", ":1: the axes of the accelerometer have different units"),
    (b"0 1 2\n1 2 3\n", ":1: 3 columns where 4 are needed"),
    (
        b"{\"t_s\": [0, 1], \"ax\": [1, 2]}\n",
        ":1: this is JSON, not a recording (a recording is a table: a header",
    ),
    (
        b"{\n\"parameters\": []}\n",
        ":1: this is JSON, a calibration as it seems, not a recording (`calibrant convert`",
    ),
    (
        b"t_s,ax_counts,ay_counts,az_counts\n0,1,2,3\n1,2,3,4\n",
        ": the recording is in counts, the sensor's readings in m/s²",
    ),
    (
        b"t_s,ax,ay,az\n90,1,2,3\n91,2,3,4\n",
        ": no sample lies within the motion: the recording spans 90 to 91 s",
    ),
];

#[test]
fn every_broken_recording_is_refused_at_its_line() {
    let bench = bench();
    for (bytes, says) in CASES {
        bench.write("recording.csv", bytes);
        bench.refuses(CALIBRATE, 3, &[&format!("error: recording.csv{says}")]);
    }
}

#[test]
fn a_recording_in_the_wrong_unit_is_refused() {
    let bench = bench();
    bench.preset("static-poses-counts", "counts.toml", &[]);
    bench.refuses(
        "calibrate counts.toml recording.csv -o result",
        3,
        &["recording.csv: the recording is in m/s², the sensor's readings in counts (set `sensor.unit`"],
    );
}

#[test]
fn holds_outside_the_recording_are_refused() {
    let bench = bench();
    bench.preset("static-poses", "given.toml", &[("# intervals_s", "intervals_s")]);
    bench.refuses(
        "calibrate given.toml recording.csv -o result",
        3,
        &["recording.csv: hold 2 from 52 to 57 s has 0 samples; the recording spans 0 to 10 s"],
    );
}

#[test]
fn a_recording_that_is_no_file_is_refused() {
    let bench = bench();
    bench.refuses(
        &CALIBRATE.replace("recording.csv", "absent.csv"),
        3,
        &["absent.csv: cannot read the recording"],
    );
    bench.write("folder/inside.csv", "");
    bench.refuses(
        &CALIBRATE.replace("recording.csv", "folder"),
        3,
        &["folder: this is a directory, not the recording (name a file in it)"],
    );
}
