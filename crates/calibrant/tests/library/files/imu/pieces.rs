//! Tests of long text files, which are read in pieces: the result is that of their bytes at once.

use calibrant::io::{
    ImuFile, ImuReadOptions, ImuUnit, parse_imu_pair, parse_imu_recording, read_imu_pair, read_imu_recording,
};
use calibrant::sensor::SensorKind;
use std::fmt::Write;
use std::path::PathBuf;

/// The names of the columns.
const HEADER: &str = "t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps";
/// Enough for several pieces.
const ROWS: usize = 12_000;

fn row(k: usize) -> String {
    let t = k as f64 * 0.01;
    format!("{t:.2},{:.4},{:.4},9.8{},{:.5},0.0{},-0.1", t.sin(), t.cos(), k % 100, 0.1 * t.sin(), k % 7)
}

fn rows(end: &str) -> String {
    (0..ROWS).fold(String::new(), |mut text, k| {
        let _ = write!(text, "{}{end}", row(k));
        text
    })
}

/// Reads a file of these bytes: the text of its error has no path.
fn from_file(bytes: &[u8]) -> Result<ImuFile, String> {
    let directory = tempfile::tempdir().expect("a directory");
    let path: PathBuf = directory.path().join("long.csv");
    std::fs::write(&path, bytes).expect("written");
    read_imu_recording(&path, &ImuReadOptions::default())
        .map_err(|error| error.to_string().replace(&format!("{}", path.display()), ""))
}

/// The bytes read from a file, and at once.
fn both(bytes: &[u8]) -> [Result<ImuFile, String>; 2] {
    let at_once = parse_imu_recording(bytes, &ImuReadOptions::default()).map_err(|error| error.to_string());
    [from_file(bytes), at_once]
}

#[test]
fn a_file_in_pieces_is_its_bytes() {
    let (comment, blank) = (format!("# {}\n", "long ".repeat(60_000)), "\n \n# between\n\n");
    let middle = ROWS / 2;
    let with = |more: &str| {
        let rows = rows("\n");
        let at = rows.match_indices('\n').nth(middle).expect("many rows").0 + 1;
        format!("{HEADER}\n{}{more}{}", &rows[..at], &rows[at..])
    };
    let plain = with("");
    for text in [
        plain.clone(),
        format!("{HEADER}\r\n{}", rows("\r\n")),
        format!("{HEADER}\r{}", rows("\r")),
        format!("{HEADER}\r{}\n", rows("\r")),
        format!("{HEADER}\r{}\n", rows("\r").trim_end()),
        plain.trim_end().to_owned(),
        plain[..plain.len() - 9].to_owned(),
        format!("\u{feff}{plain}"),
        format!("{}{plain}", "# one of many comments\n".repeat(9_000)),
        format!("{comment}{plain}"),
        with(&comment),
        with(blank),
        with(&format!("{}\n{}\n", row(middle), row(middle))),
        with("1,2,3\n"),
        with("1,2,3,x,5,6,7\n"),
        with("0,0,0,9.8,0,0,0\n"),
        with("1e13,0,0,9.8,0,0,0\n"),
    ] {
        let [file, bytes] = both(text.as_bytes());
        let place = |error: &String| error.trim_start_matches([':', ' ']).to_owned();
        match (&file, &bytes) {
            (Ok(_), Ok(_)) => assert!(file == bytes),
            (Err(file), Err(bytes)) => {
                let line =
                    |error: &String| place(error).chars().filter(char::is_ascii_digit).collect::<String>();
                assert!(line(file) == line(bytes) && !line(file).is_empty(), "{file}\n{bytes}");
            }
            _ => panic!("{file:?}\n{bytes:?}"),
        }
        let is_bad = text.contains(",x,")
            || text.contains("1,2,3\n")
            || text.contains("1e13")
            || text.contains("\n0,0,0");
        assert_eq!(file.is_err(), is_bad);
    }
}

#[test]
fn what_is_no_text_is_found_where_it_is() {
    let text = format!("{HEADER}\n{}", rows("\n"));
    for (byte, at) in [(0_u8, 100), (0, text.len() - 3), (0xff, 100), (0xff, text.len() - 3)] {
        let mut bytes = text.clone().into_bytes();
        bytes[at] = byte;
        let [file, at_once] = both(&bytes).map(|read| read.expect_err("no text"));
        let message = format!("at offset {at}");
        assert!(file.contains(&message) && at_once.contains(&message), "{file}\n{at_once}");
        if byte == 0xff {
            let line = format!("{}", 1 + bytes[..at].iter().filter(|&&byte| byte == b'\n').count());
            assert!(file.contains(&line) && at_once.contains(&line), "{file}\n{at_once}");
        }
    }
}

#[test]
fn a_pair_in_pieces_is_its_bytes() {
    let of = |offset: f64| {
        (0..ROWS).fold(String::new(), |mut text, k| {
            let t = k as f64 * 0.01;
            let _ = writeln!(text, "   {t:.7e}   {:.7e}   {:.7e}   {:.7e}", offset, offset + t, offset - t);
            text
        })
    };
    let (first, second) = (of(33_000.0), of(32_000.0));
    let options = ImuReadOptions {
        accelerometer_unit: Some(ImuUnit::Counts),
        gyroscope_unit: Some(ImuUnit::Counts),
        ..ImuReadOptions::default()
    };
    let directory = tempfile::tempdir().expect("a directory");
    let [one, other] = [("acc.mat", &first), ("gyro.mat", &second)].map(|(name, text)| {
        let path = directory.path().join(name);
        std::fs::write(&path, text).expect("written");
        path
    });
    let pair = read_imu_pair(&one, &other, &options).expect("a pair");
    assert!(pair == parse_imu_pair(first.as_bytes(), second.as_bytes(), &options).expect("a pair"));
    assert_eq!(pair.sha256.len(), 2);
    assert_eq!(
        pair.recording[SensorKind::Gyroscope].clone().expect("there").readings()[ROWS - 1].y,
        32_000.0 + 119.99
    );
}
