//! Raw counts of a sensor whose datasheet states its sensitivity: from a sketch's output to the firmware.

use crate::bench::Bench;
use serde_json::Value;

const PER_G: f64 = 16384.0;
const PER_DPS: f64 = 131.0;

/// A bench with a simulated recording, and `counts.csv` with the same in whole counts, as a sketch prints them.
fn counts() -> Bench {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    bench.run("simulate imu.toml -o made").done();
    let text = bench.read("made/recording.csv");
    let rows = text.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit()));
    let row = |line: &str| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        let counts = |k: usize| match k {
            1..=3 => cells[k] / 9.80665 * PER_G,
            _ => cells[k].to_degrees() * PER_DPS,
        };
        let counts: Vec<String> = (1..7).map(|k| format!("{:.0}", counts(k))).collect();
        format!("{:.0},{}\n", cells[0] * 1e3, counts.join(","))
    };
    bench.write("counts.csv", "ms,AcX,AcY,AcZ,GyX,GyY,GyZ\n".to_owned() + &rows.map(row).collect::<String>());
    bench
}

/// The numbers below a list of keys.
fn number(of: &Value, keys: &[&str]) -> f64 {
    keys.iter().fold(of, |of, key| &of[key]).as_f64().expect("a number")
}

#[test]
fn counts_of_a_known_sensitivity_are_calibrated_in_physical_units() {
    let bench = counts();
    bench.run("calibrate imu.toml made/recording.csv --no-report -o si").done();
    let given = "--accelerometer-lsb-per-g 16384 --gyroscope-lsb-per-dps 131";
    bench.run(&format!("calibrate imu.toml counts.csv {given} --no-report -o raw")).done();
    let (si, raw) = (bench.json("si/calibration.json"), bench.json("raw/calibration.json"));
    assert_eq!(raw["accelerometer"]["reading_unit"], "m/s²");
    assert!((number(&raw, &["accelerometer", "counts_per_mps2"]) - PER_G / 9.80665).abs() < 1e-9);
    assert!((number(&raw, &["gyroscope", "counts_per_radps"]) - PER_DPS.to_degrees()).abs() < 1e-9);
    for (one, other) in
        si["parameters"].as_array().expect("a list").iter().zip(raw["parameters"].as_array().expect("a list"))
    {
        let off = (number(one, &["value"]) - number(other, &["value"])) / number(one, &["sd"]);
        assert!(off.abs() < 1.0, "{}: {off}", one["name"]);
    }

    // an experiment file says the same, in the words of datasheets too
    for (accelerometer, gyroscope) in [
        ("accelerometer_lsb_per_g = 16384.0", "gyroscope_lsb_per_radps = 7505.747116"),
        ("accelerometer_unit = \"0.06103515625 mg/LSB\"", "gyroscope_unit = \"131 LSB/(°/s)\""),
    ] {
        bench.preset(
            "imu",
            "said.toml",
            &[("[columns]", &format!("[columns]\n{accelerometer}\n{gyroscope}"))],
        );
        bench.run("calibrate said.toml counts.csv --no-report -o said").done();
        let said = bench.json("said/calibration.json");
        let (one, other) = (&said["accelerometer"]["bias_mps2"], &raw["accelerometer"]["bias_mps2"]);
        assert!((one[0].as_f64().expect("a number") - other[0].as_f64().expect("a number")).abs() < 1e-9);
    }
    bench.preset(
        "imu",
        "twice.toml",
        &[("[columns]", "[columns]\naccelerometer_lsb_per_g = 16384.0\naccelerometer_unit = \"g\"")],
    );
    bench.refuses(
        "calibrate twice.toml counts.csv -o out",
        2,
        &["columns.accelerometer_lsb_per_g", "keep one of the two"],
    );

    // counts are corrected without a word of their unit, and C takes them
    bench.run("apply raw/calibration.json counts.csv -o corrected.csv").done();
    bench.run("apply raw/calibration.json made/recording.csv -o of_si.csv").done();
    let rows = |name: &str| -> Vec<Vec<f64>> {
        let text = bench.read(name);
        let cells = |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        text.lines().skip(1).map(cells).collect()
    };
    for (one, other) in rows("corrected.csv").iter().zip(&rows("of_si.csv")).step_by(997) {
        let off = one.iter().zip(other).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
        assert!(off < 0.6 * 9.80665 / PER_G, "half a count: {off}");
    }
    // what is no counts of this sensitivity is not taken for such
    let plain = bench.read("made/recording.csv").replace("_mps2", "").replace("_radps", "");
    bench.write("plain.csv", plain);
    bench.refuses(
        "apply raw/calibration.json plain.csv -o other.csv",
        3,
        &["the accelerometer's columns have no unit", "--accelerometer-unit"],
    );
    let half = bench.read("counts.csv");
    let half = half.lines().enumerate().map(|(row, line)| match row {
        0 => line.to_owned() + "\n",
        _ => {
            let of = |(k, cell): (usize, &str)| {
                let counts: i64 = cell.parse().expect("a whole number");
                if (1..4).contains(&k) { (counts / 2).to_string() } else { cell.to_owned() }
            };
            line.split(',').enumerate().map(of).collect::<Vec<_>>().join(",") + "\n"
        }
    });
    let half: String = half.collect();
    bench.write(
        "half.csv",
        half.replace("AcX", "ax_counts").replace("AcY", "ay_counts").replace("AcZ", "az_counts"),
    );
    let says = ["with 16384 LSB/g the accelerometer's magnitude is 0.498 g", "near 81"];
    bench.refuses("apply raw/calibration.json half.csv --gyroscope-unit counts -o other.csv", 3, &says);
    bench.run("convert raw/calibration.json imu.h --to c").done();
    let header = bench.read("imu.h");
    assert!(header.contains("accelerometer: readings in counts"), "{header}");
    bench.run("convert raw/calibration.json imu.yaml --to kalibr --gauge lower").done();
    bench.run("convert imu.h back.json --to calibrant").done();
    let back = bench.json("back.json");
    let gain = &back["accelerometer"]["matrix_counts_per_mps2"][0][0];
    let (gain, scale) = (gain.as_f64().expect("a number"), &raw["accelerometer"]["matrix"][0][0]);
    let expected = scale.as_f64().expect("a number") * PER_G / 9.80665;
    assert!((gain / expected - 1.0).abs() < 1e-12, "{gain} {expected}");

    // what `init` says works: a simulated recording is in m/s², the real one in counts
    bench.run("init imu-counts --sensor mpu-6050 -o sheet.toml").done();
    bench.run("simulate sheet.toml -o simulated").done();
    bench.run("calibrate sheet.toml simulated/recording.csv --no-report -o of_simulated").done();
    bench.run("calibrate sheet.toml counts.csv --no-report -o of_counts").done();
    let [simulated, counts] = ["of_simulated", "of_counts"].map(|name| {
        let found = bench.json(&format!("{name}/calibration.json"));
        (
            found["accelerometer"]["reading_unit"].clone(),
            found["accelerometer"]["counts_per_mps2"].is_number(),
        )
    });
    assert_eq!((simulated.0, counts.0), ("m/s²".into(), "m/s²".into()));
    assert_eq!((simulated.1, counts.1), (false, true));

    // the sensitivity of another range
    bench.refuses(
        "calibrate imu.toml counts.csv --accelerometer-lsb-per-g 8192 --gyroscope-lsb-per-dps 131 -o out",
        3,
        &["with 8192 LSB/g the accelerometer's magnitude is 1.99 g", "near 163"],
    );
}
