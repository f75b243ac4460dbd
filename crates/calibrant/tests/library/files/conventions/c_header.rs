//! Tests of the C header, compiled and run where there is a C compiler.

use super::{COUNTS, SI, file, imu, readings};
use calibrant::io::{ImuFormat, calibrated_imu_texts, write_calibrated_imu};
use calibrant::sensor::{CalibratedImu, ImuCorrection};
use nalgebra::Vector3;
use std::io::Write;
use std::process::{Command, Stdio};

/// The C program that corrects readings with the header.
const PROGRAM: &str = r#"
#include <stdio.h>
#include "imu.h"
int main(void)
{
    CALIBRANT_REAL a[3], g[3], f[3], w[3];
    double in[6];
    while (scanf("%lf %lf %lf %lf %lf %lf", in, in + 1, in + 2, in + 3, in + 4, in + 5) == 6) {
        int i;
        for (i = 0; i < 3; i++) { a[i] = (CALIBRANT_REAL)in[i]; g[i] = (CALIBRANT_REAL)in[i + 3]; }
        calibrant_correct_accelerometer(a, f);
        calibrant_correct_gyroscope(g, f, w);
#ifdef FORWARD
        /* the reading of the corrected reading, less the reading */
        calibrant_read_accelerometer(f, w);
        for (i = 0; i < 3; i++) f[i] = w[i] - a[i];
#endif
        printf("%.17g %.17g %.17g %.17g %.17g %.17g\n", (double)f[0], (double)f[1], (double)f[2],
               (double)w[0], (double)w[1], (double)w[2]);
    }
    return 0;
}
"#;

/// The largest difference of a thousand readings corrected in C, with `-DFORWARD` of readings of their corrections; `None` without a compiler.
pub(super) fn largest_difference_in_c(imu: &CalibratedImu, options: &[&str]) -> Option<f64> {
    Command::new("cc").arg("--version").output().ok()?;
    let directory = tempfile::tempdir().expect("a directory");
    write_calibrated_imu(&directory.path().join("imu.h"), &file(imu.clone()), ImuFormat::CHeader)
        .expect("written");
    std::fs::write(directory.path().join("main.c"), PROGRAM).expect("written");
    let compiled = Command::new("cc")
        .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-o", "main", "main.c"])
        .args(options)
        .current_dir(directory.path())
        .output()
        .expect("a compiler");
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let readings = readings(imu, 1000, 5);
    let mut child = Command::new(directory.path().join("main"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("runs");
    let lines: String = readings
        .iter()
        .map(|[a, g]| format!("{:?} {:?} {:?} {:?} {:?} {:?}\n", a.x, a.y, a.z, g.x, g.y, g.z))
        .collect();
    let mut input = child.stdin.take().expect("piped");
    let writer = std::thread::spawn(move || input.write_all(lines.as_bytes()));
    let output = child.wait_with_output().expect("ends");
    writer.join().expect("no panic").expect("read by the program");
    let correction = ImuCorrection::of(imu).expect("regular");
    let text = String::from_utf8(output.stdout).expect("text");
    assert_eq!(text.lines().count(), readings.len());
    let mut largest = 0.0_f64;
    for (line, [a, g]) in text.lines().zip(&readings) {
        let v: Vec<f64> = line.split(' ').map(|word| word.parse().expect("a number")).collect();
        if options.contains(&"-DFORWARD") {
            largest = largest.max(Vector3::new(v[0], v[1], v[2]).amax());
            continue;
        }
        let force = correction.force(a).expect("there");
        let rate = correction.rate(g, &force).expect("there");
        largest = largest.max((Vector3::new(v[0], v[1], v[2]) - force).amax());
        largest = largest.max((Vector3::new(v[3], v[4], v[5]) - rate).amax());
    }
    Some(largest)
}

#[test]
fn it_compiles_without_warnings_and_corrects_as_we_do() {
    if let Some(difference) = largest_difference_in_c(&imu(COUNTS, true), &[]) {
        assert!(difference < 1e-12, "{difference:e}");
    }
}

#[test]
fn single_precision_is_good_for_its_digits() {
    if let Some(difference) = largest_difference_in_c(&imu(COUNTS, true), &["-DCALIBRANT_REAL=float"]) {
        assert!(difference < 1e-4 && difference > 1e-9, "{difference:e}");
    }
}

#[test]
fn it_takes_the_counts_of_a_known_sensitivity() {
    let mut imu = imu(SI, true);
    imu.counts_per_unit = [Some(1670.7), Some(7505.7)].into();
    let raw = imu.in_counts();
    let header =
        |imu: &CalibratedImu| calibrated_imu_texts(&file(imu.clone()), ImuFormat::CHeader).expect("text");
    assert_eq!(header(&imu), header(&raw));
    let scaled = readings(&raw, 100, 3);
    for ([a, g], [a_raw, g_raw]) in readings(&imu, 100, 3).iter().zip(&scaled) {
        assert!((a * 1670.7 - a_raw).amax() < 1e-9 && (g * 7505.7 - g_raw).amax() < 1e-9);
    }
}
