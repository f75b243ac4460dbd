//! Tests of the temperature model through calibrant JSON and the C header; other formats refuse it.

use super::nonlinearity::bent;
use super::{COUNTS, SI, file, imu, largest_difference, readings, there_and_back};
use calibrant::io::{
    ConventionOptions, ImuFormat, calibrated_imu_texts, parse_calibrated_imu, write_calibrated_imu,
};
use calibrant::sensor::{CalibratedImu, ImuCorrection, ImuPart, ImuQuantity, ReadingUnit, ThermalPart};
use nalgebra::DMatrix;
use std::io::Write;
use std::process::{Command, Stdio};

/// The IMU of the other tests with terms of every kind, and their covariance.
pub(super) fn warm(unit: [ReadingUnit; 2]) -> CalibratedImu {
    let mut imu = imu(unit, true);
    imu.parameters.thermal.reference_c = 31.5;
    imu.parameters.thermal.range_c = Some([-12.25, 58.0]);
    for (k, quantity) in ImuQuantity::all_thermal(true, true).into_iter().enumerate() {
        let ImuQuantity::Thermal(sensor_kind, term) = quantity else { continue };
        let gain = imu.parameters.sensor(sensor_kind).matrix[(0, 0)];
        let size = if term.part == ThermalPart::Bias { 1e-3 * gain } else { 1e-4 };
        quantity
            .add_to(&mut imu.parameters, size * (k as f64 % 7.0 - 3.3) / 20f64.powi(term.order as i32 - 1));
        imu.quantities.push(quantity);
    }
    let (old, n) = (imu.covariance.expect("there"), imu.quantities.len());
    let first = old.nrows();
    let entry = |i: usize, j: usize| if i == j { 1e-9 * (1 + i) as f64 } else { 0.0 };
    imu.covariance =
        Some(DMatrix::from_fn(n, n, |i, j| if i < first && j < first { old[(i, j)] } else { entry(i, j) }));
    imu
}

#[test]
fn calibrant_json_keeps_the_terms_to_the_bit() {
    for unit in [SI, COUNTS] {
        let before = file(warm(unit));
        assert_eq!(there_and_back(&before, ImuFormat::CalibrantJson), [before]);
    }
}

#[test]
fn the_c_header_corrects_as_we_do_at_every_temperature() {
    for unit in [SI, COUNTS] {
        let before = warm(unit);
        let after = there_and_back(&file(before.clone()), ImuFormat::CHeader).remove(0).imu;
        assert_eq!(after.parameters.thermal, before.parameters.thermal);
        for temperature in [-12.0, 31.5, 50.0] {
            let [a, b] = [&before, &after].map(|imu| imu.at(temperature).expect("positive gains"));
            let readings = readings(&a, 200, 3);
            assert!(largest_difference(&a, &b, &readings) < 1e-12);
        }
    }
}

/// The C program that corrects a reading at a temperature.
const PROGRAM: &str = r#"
#include <stdio.h>
#include "imu.h"
int main(void)
{
    double t, a[3], g[3], f[3], w[3];
    while (scanf("%lf %lf %lf %lf %lf %lf %lf", &t, a, a + 1, a + 2, g, g + 1, g + 2) == 7) {
        calibrant_correct_accelerometer(a, t, f);
        calibrant_correct_gyroscope(g, t, f, w);
        printf("%.17g %.17g %.17g %.17g %.17g %.17g\n", f[0], f[1], f[2], w[0], w[1], w[2]);
    }
    return 0;
}
"#;

#[test]
fn the_c_header_takes_the_temperature() {
    c_takes_the_temperature(&warm(COUNTS));
    c_takes_the_temperature(&bent(warm(COUNTS)));
}

fn c_takes_the_temperature(imu: &CalibratedImu) {
    if Command::new("cc").arg("--version").output().is_err() {
        return;
    }
    let directory = tempfile::tempdir().expect("a directory");
    write_calibrated_imu(&directory.path().join("imu.h"), &file(imu.clone()), ImuFormat::CHeader)
        .expect("written");
    std::fs::write(directory.path().join("main.c"), PROGRAM).expect("written");
    let compiled = Command::new("cc")
        .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-o", "main", "main.c"])
        .current_dir(directory.path())
        .output()
        .expect("a compiler");
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    // beyond the range it corrects as at the nearer end
    let temperatures = [-40.0, -12.0, 3.25, 31.5, 57.0, 90.0];
    let mut lines = String::new();
    let mut expected = Vec::new();
    for temperature in temperatures {
        let [low, high] = imu.parameters.thermal.range_c.expect("there");
        let counted: f64 = temperature;
        let counted = counted.clamp(low, high);
        let here = ImuCorrection::of(imu).and_then(|of| of.at(counted)).expect("regular");
        for [a, g] in readings(&imu.at(counted).expect("positive gains"), 50, 4) {
            lines +=
                &format!("{temperature:?} {:?} {:?} {:?} {:?} {:?} {:?}\n", a.x, a.y, a.z, g.x, g.y, g.z);
            let force = here.force(&a).expect("there");
            expected.push((force, here.rate(&g, &force).expect("there")));
        }
    }
    let mut child = Command::new(directory.path().join("main"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("runs");
    let mut input = child.stdin.take().expect("piped");
    let writer = std::thread::spawn(move || input.write_all(lines.as_bytes()));
    let output = child.wait_with_output().expect("ends");
    writer.join().expect("no panic").expect("read by the program");
    let text = String::from_utf8(output.stdout).expect("text");
    assert_eq!(text.lines().count(), expected.len());
    for (line, (force, rate)) in text.lines().zip(expected) {
        let v: Vec<f64> = line.split(' ').map(|word| word.parse().expect("a number")).collect();
        for axis in 0..3 {
            assert!(
                (v[axis] - force[axis]).abs() < 1e-12 && (v[axis + 3] - rate[axis]).abs() < 1e-12,
                "{line}"
            );
        }
    }
}

#[test]
fn formats_without_a_place_for_it_refuse_it_and_take_one_temperature() {
    let imu = warm(SI).without(ImuPart::GSensitivity);
    for format in [ImuFormat::Kalibr, ImuFormat::ImuTk, ImuFormat::Imucal] {
        let message = calibrated_imu_texts(&file(imu.clone()), format).expect_err("refused").to_string();
        assert!(message.contains("no place for what temperature does"), "{message}");
        assert!(message.contains("option `temperature` CELSIUS"), "{message}");
        let there = imu.at(48.0).expect("positive gains");
        for after in there_and_back(&file(there.clone()), format) {
            assert!(largest_difference(&there, &after.imu, &readings(&there, 100, 6)) < 1e-12);
        }
    }
}

#[test]
fn contradictions_are_refused() {
    let text = calibrated_imu_texts(&file(warm(SI)), ImuFormat::CalibrantJson).expect("written").remove(0).1;
    let message = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}: {text}");
        let text = text.replacen(from, to, 1);
        parse_calibrated_imu(text.as_bytes(), &ConventionOptions::default()).expect_err(to).to_string()
    };
    for (from, to, says) in [
        (
            "\"bias_radps_per_k\"",
            "\"bias_counts_per_k\"",
            "`temperature.gyroscope` has a bias in another unit",
        ),
        ("\"reference_c\": 31.5", "\"reference_c\": null", "`temperature.reference_c` is missing"),
        ("[-12.25, 58.0]", "[58.0, -12.25]", "the range of temperatures is none"),
        ("[-12.25, 58.0]", "[58.0]", "`temperature.range_c` is not two numbers"),
        (
            "\"scale_per_k2\": [",
            "\"scale_per_k2\": [1.0, ",
            "`temperature.accelerometer.scale_per_k2` has 4 numbers",
        ),
        ("\"bias_mps2_per_k\": [-", "\"bias_mps2_per_k\": [-9", "accelerometer.bias_per_k.x is"),
    ] {
        let message = message(from, to);
        assert!(message.contains(says), "{to}: {message}");
    }
}
