//! Tests of `calibrant noise`.

mod both_sensors;

use crate::bench::Bench;
use crate::data::shared_data;
use serde_json::Value;
use std::fmt::Write;

/// A recording of `n` samples at 100 Hz, z up, whose readings pass every test of whiteness that matters here.
fn recording(header: &str, n: u32, size: f64) -> String {
    let mut state = 1_u64;
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut text = format!("{header}\n");
    for k in 0..n {
        let [x, y, z] = [uniform(), uniform(), uniform()].map(|value| size * value);
        writeln!(text, "{:.2},{x:.9},{y:.9},{:.9}", f64::from(k) / 100.0, 9.8 + z).expect("written");
    }
    text
}

#[test]
fn white_noise_is_found_and_what_is_not_seen_is_said() {
    let bench = Bench::new();
    bench.write("still.csv", recording("t_s,ax_mps2,ay_mps2,az_mps2", 6000, 0.1));
    let outcome = bench.run("noise still.csv -o result").done();
    for text in [
        "velocity random walk N x",
        "µg/√Hz",
        "m/s/√h",
        "not determined",
        "record for longer",
        "result/report.html",
    ] {
        assert!(outcome.printed().contains(text), "{text}\n{}", outcome.stdout);
    }
    let json = bench.json("result/noise.json");
    let axis = &json["sensors"][0]["axes"][2];
    // uniform numbers: 0.1/√12 per sample
    let n = axis["random_walk"]["value"].as_f64().expect("determined");
    assert!((n / (0.1 / 12.0_f64.sqrt() * 0.1) - 1.0).abs() < 0.05, "{n}");
    assert_eq!(
        (&axis["bias_instability"]["determined"], &axis["bias_instability"]["value"]),
        (&Value::Bool(false), &Value::Null)
    );
    assert!(
        axis["bias_instability"]["upper_limit"].is_f64() && axis["bias_instability"]["reason"].is_string()
    );
    assert!(bench.read("result/report.html").contains("Allan deviation of the accelerometer"));

    // the line is one that an experiment file takes
    let line = json["sensors"][0]["experiment"]["line"].as_str().expect("determined");
    assert!(outcome.printed().contains(&format!("For an experiment file, in [sensor]: {line}")), "{line}");
    bench.preset("static-poses", "poses.toml", &[]);
    let poses = bench.read("poses.toml").replacen("[sensor]", &format!("[sensor]\n{line}"), 1);
    bench.write("noisy.toml", without_key(&poses, line));
    bench.run("simulate noisy.toml -o sim").done();

    let printed = bench.run("noise still.csv --json").done();
    assert_eq!(printed.stdout, bench.read("result/noise.json"));
    let part = bench.run("noise still.csv --hold 10 30 --json").done().json();
    assert_eq!(
        (&part["sensors"][0]["first_sample"], &part["sensors"][0]["end_sample"]),
        (&1000.into(), &3001.into())
    );
}

/// A spike among six thousand samples.
#[test]
fn an_outlier_is_named_and_left_out() {
    let bench = Bench::new();
    let clean = recording("t_s,ax_mps2,ay_mps2,az_mps2", 6000, 0.1);
    bench.write("still.csv", &clean);
    let mut lines: Vec<&str> = clean.lines().collect();
    lines[3001] = "30.00,20.0,0.0,9.8";
    bench.write("spark.csv", lines.join("\n") + "\n");
    let n = |file: &str| {
        let outcome = bench.run(&format!("noise {file} --hold 0 60 --json")).done();
        let json = outcome.json();
        (json["sensors"][0]["axes"][0]["random_walk"]["value"].as_f64().expect("determined"), outcome)
    };
    let ((expected, clean), (found, outcome)) = (n("still.csv"), n("spark.csv"));
    assert!((found / expected - 1.0).abs() < 0.01, "{found} {expected}");
    assert!(!clean.stderr.contains("outlier"), "{}", clean.stderr);
    outcome.says(
        "warning: accelerometer x: 1 of 6000 samples is an outlier (the farthest is 20 m/s² at 30.000 s",
    );
    outcome.says("With it, N would be");
}

/// A recording of this number of samples with an addition to x in some samples.
fn disturbed(n: u32, by: impl Fn(usize) -> f64) -> String {
    let still = recording("t_s,ax_mps2,ay_mps2,az_mps2", n, 0.1);
    let line = |(k, line): (usize, &str)| match by(k) {
        0.0 => line.to_owned(),
        by => {
            let fields: Vec<&str> = line.split(',').collect();
            let x: f64 = fields[1].parse().expect("a number");
            format!("{},{:.9},{},{}", fields[0], x + by, fields[2], fields[3])
        }
    };
    let lines: Vec<String> = still.lines().skip(1).enumerate().map(line).collect();
    format!("t_s,ax_mps2,ay_mps2,az_mps2\n{}\n", lines.join("\n"))
}

/// A spike divided the hold, and 5.5 of 600 s were used. With --hold N was 82 times too large.
#[test]
fn spikes_neither_divide_a_hold_nor_change_its_noise() {
    let bench = Bench::new();
    let expected = 0.1 / 12.0_f64.sqrt() * 0.1;
    for one_in in [600, 100] {
        bench.write("sparks.csv", disturbed(12_000, |k| if k % one_in == 50 { 20.0 } else { 0.0 }));
        for hold in ["", "--hold 0 120"] {
            let outcome = bench.run(&format!("noise sparks.csv {hold} -o result")).done();
            let sensor = &bench.json("result/noise.json")["sensors"][0];
            let n = sensor["axes"][0]["random_walk"]["value"].as_f64().expect("determined");
            // 12 000 samples: 0.7 % is one standard deviation
            assert!((n / expected - 1.0).abs() < 0.03, "one in {one_in} {hold}: {n}");
            let samples = sensor["end_sample"].as_u64().zip(sensor["first_sample"].as_u64());
            assert!(samples.is_some_and(|(end, first)| end - first > 11_800), "{samples:?}");
            assert!(
                !outcome.stderr.contains("moves") && outcome.printed().contains("noise_mps2 ="),
                "{outcome:?}"
            );
            assert!(!outcome.printed().contains("s recorded"), "{}", outcome.stdout);
            outcome.says("samples are outliers");
        }
    }
    // more than one in fifty are reported for what they are, and N is not usable
    bench.write("many.csv", disturbed(12_000, |k| if k % 40 == 7 { 20.0 } else { 0.0 }));
    let outcome = bench.run("noise many.csv --hold 0 120 -o result").done();
    outcome.says("accelerometer x: 300 of 12000 samples are spikes");
    outcome.says("too many to remove");
    assert!(
        !outcome.stderr.contains("behind a filter") && !outcome.stderr.contains("moves"),
        "{}",
        outcome.stderr
    );
    assert!(
        outcome.printed().contains("No noise for an experiment file. There are too many spikes"),
        "{}",
        outcome.stdout
    );
    assert!(bench.json("result/noise.json")["sensors"][0]["experiment"].is_null());
    assert!(bench.read("result/report.html").contains("This is not only the noise of a sensor at rest"));
}

#[test]
fn noise_of_a_sensor_that_moves_is_not_for_use() {
    let bench = Bench::new();
    let burst = |k: usize| if (6000..6030).contains(&k) { 5.0 * (2.1 * k as f64).sin() } else { 0.0 };
    let step = |k: usize| if k >= 5000 { 0.5 } else { 0.0 };
    let calibration = r#"{"acc_unit": "m/s^2", "gyr_unit": "deg/s", "from_acc_unit": "m/s^2", "from_gyr_unit": "deg/s", "comment": null,
        "K_a": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], "R_a": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        "b_a": [0.0, 0.0, 0.0], "K_g": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], "R_g": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        "K_ga": [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], "b_g": [0.0, 0.0, 0.0], "cal_type": "Ferraris", "_format_version": "2.0.0"}"#;
    bench.write("imu.json", calibration);
    bench.write("burst.csv", disturbed(12_000, burst));
    bench.write("step.csv", disturbed(12_000, step));
    for name in ["burst", "step"] {
        let outcome = bench.run(&format!("noise {name}.csv --hold 0 120 -o {name}")).done();
        outcome.says("warning: the sensor moves or vibrates in");
        assert!(!outcome.printed().contains("noise_mps2"), "{}", outcome.stdout);
        let why = "No noise for an experiment file. The sensor moves or vibrates in";
        assert!(outcome.printed().contains(why), "{}", outcome.stdout);
        assert!(
            bench
                .read(&format!("{name}/report.html"))
                .contains("This is not only the noise of a sensor at rest")
        );
        bench.refuses(
            &format!("convert imu.json imu.yaml --noise {name}/noise.json"),
            2,
            &["the noise of the accelerometer is not that of a sensor at rest: the sensor moves"],
        );
        // without --hold the message names the part that is used
        let outcome = bench.run(&format!("noise {name}.csv -o {name}")).done();
        assert!(
            outcome.printed().contains("of the 120.0 s recorded, the longest of 2 holds"),
            "{}",
            outcome.stdout
        );
        assert!(outcome.printed().contains("noise_mps2 ="), "{}", outcome.stdout);
        assert!(bench.read(&format!("{name}/report.html")).contains("of the 120.0 s recorded"));
    }
}

/// Fifteen seconds at rest, thirty of a turn about the vertical at a steady rate, five at rest. The
/// accelerometer alone sees one hold. The gyroscope's longest calm is the turn.
#[test]
fn a_turn_at_a_steady_rate_is_no_hold_of_an_imu() {
    let forces = recording("", 5000, 1.0);
    let lines = || forces.lines().skip(1);
    let mut text = "t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps\n".to_owned();
    for (k, (line, other)) in lines().zip(lines().cycle().skip(100)).enumerate() {
        let noise: Vec<f64> = other.split(',').map(|value| value.parse().expect("a number")).collect();
        let turning = if (1500..4500).contains(&k) { 0.5 } else { 0.0 };
        let [x, y, z] = [noise[1], noise[2], noise[3] - 9.8].map(|value| 0.005 * value);
        writeln!(text, "{line},{x:.9},{y:.9},{:.9}", z + turning).expect("written");
    }
    let bench = Bench::new();
    bench.write("imu.csv", text);
    for sensor in ["accelerometer", "gyroscope"] {
        let outcome = bench.run(&format!("noise imu.csv --sensor {sensor} --json")).done();
        let json = outcome.json();
        assert_eq!(json["sensors"].as_array().map(Vec::len), Some(1));
        let place = |name: &str| json["sensors"][0][name].as_u64().expect("a number");
        let (first, end) = (place("first_sample"), place("end_sample"));
        assert!(first < 50 && (1450..1520).contains(&end), "{sensor}: {first} to {end}");
        // a given interval is used; a warning reports the movement, in the results too
        let outcome = bench.run(&format!("noise imu.csv --sensor {sensor} --hold 12 40 --json")).done();
        outcome.says("warning: the sensor moves or vibrates in 25.");
        outcome.says("of the 28.0 s given with --hold");
        assert!(outcome.printed().contains("the sensor moves or vibrates in 25."), "{}", outcome.stdout);
        assert!(
            !bench
                .run(&format!("noise imu.csv --sensor {sensor} --hold 2 14"))
                .done()
                .stderr
                .contains("moves")
        );
    }
}

#[test]
fn an_interval_that_is_given_holds_still_or_is_said_to_move() {
    let still = recording("t_s,ax_mps2,ay_mps2,az_mps2", 6000, 1.0);
    // turned by 90° within a second
    let turn = |line: &str| {
        let fields: Vec<f64> = line.split(',').map(|field| field.parse().expect("a number")).collect();
        let angle = (fields[0] - 30.0).clamp(0.0, 1.0) * 1.57;
        let (x, z) = (fields[1] + 9.8 * angle.sin(), fields[3] + 9.8 * (angle.cos() - 1.0));
        format!("{},{x:.9},{},{z:.9}", fields[0], fields[2])
    };
    let mut turned: Vec<String> = still.lines().skip(1).map(turn).collect();
    turned.insert(0, "t_s,ax_mps2,ay_mps2,az_mps2".into());
    let bench = Bench::new();
    bench.write("still.csv", still);
    bench.write("turned.csv", turned.join("\n"));
    for interval in ["0 2", "0 60", "10 13"] {
        let outcome = bench.run(&format!("noise still.csv --hold {interval}")).done();
        assert!(!outcome.stderr.contains("moves"), "{interval}: {}", outcome.stderr);
    }
    bench.run("noise turned.csv --hold 0 60").done().says("warning: the sensor moves or vibrates in 1.");
}

/// The text without the lines that repeat the key of `line`.
fn without_key(text: &str, line: &str) -> String {
    let key = line.split(' ').next().expect("a key");
    let kept = text.lines().filter(|other| *other == line || !other.trim_start().starts_with(key));
    kept.collect::<Vec<_>>().join("\n")
}

#[test]
fn counts_stay_counts_without_a_gain() {
    let bench = Bench::new();
    bench.write("still.csv", recording("t_s,ax_counts,ay_counts,az_counts", 3000, 20.0));
    let outcome = bench.run("noise still.csv --unit counts").done();
    assert!(
        outcome.printed().contains("counts/√Hz") && !outcome.printed().contains("µg"),
        "{}",
        outcome.stdout
    );
    let outcome = bench.run("noise still.csv --sensor gyroscope --gain 4778,4758,4766").done();
    assert!(
        outcome.printed().contains("angle random walk N z") && outcome.printed().contains("deg/√h"),
        "{}",
        outcome.stdout
    );
    // uniform numbers of 20 counts: 5.77 counts, which the experiment file of these counts needs with a gain,
    // too
    let line = outcome.stdout.lines().find_map(|line| line.trim().strip_prefix("noise_counts = "));
    let values = line.expect("a line").trim_matches(['[', ']']).split(", ");
    let values: Vec<f64> = values.map(|value| value.parse().expect("a number")).collect();
    assert!(values.len() == 3 && values.iter().all(|value| (value / 5.77 - 1.0).abs() < 0.08), "{values:?}");
}

#[test]
fn what_cannot_be_used_is_refused() {
    let bench = Bench::new();
    bench.write("still.csv", recording("t_s,ax_mps2,ay_mps2,az_mps2", 3000, 0.1));
    bench.refuses("noise still.csv --hold 1 1.2 -o result", 3, &["still.csv: 21 samples from 1 to 1.2 s"]);
    let hold = |interval: &str| format!("noise still.csv --hold {interval} -o result");
    bench.refuses(&hold("nan 20"), 2, &["an interval from NaN to 20 s is none"]);
    bench.refuses(&hold("20 10"), 2, &["the interval from 20 to 10 s ends before it starts"]);
    bench.refuses(&hold("100 200"), 2, &["outside the recording", "the recording goes from 0 to 29.99 s"]);
    bench.refuses("noise still.csv --gain 1,2 -o result", 2, &["--gain is one number or three"]);
    // readings of an accelerometer are no gyroscope's
    bench.write("acc.csv", recording("t_s,ax_mps2,ay_mps2,az_mps2", 3000, 1.0));
    bench.refuses("noise acc.csv --sensor gyroscope -o result", 3, &["acc.csv: the file has no gyroscope"]);
    let imu = bench.read("acc.csv").replace('\n', ",0.1,0.2,0.3\n").replacen(
        "az_mps2,0.1,0.2,0.3",
        "az_mps2,gx,gy,gz",
        1,
    );
    bench.write("imu.csv", imu);
    bench.refuses("noise imu.csv --sensor gyroscope -o result", 3, &["the gyroscope's columns have no unit"]);
    bench.refuses("noise missing.csv -o result", 3, &["missing.csv"]);
}

#[test]
fn a_unit_that_the_file_does_not_say_is_asked_for() {
    let bench = Bench::new();
    let si = recording("t_s,ax,ay,az", 3000, 0.1);
    let scaled = |factor: f64, header: &str| {
        let line = |line: &str| {
            let values: Vec<f64> = line.split(',').map(|value| value.parse().expect("a number")).collect();
            let [x, y, z] = [1, 2, 3].map(|k| factor * values[k]);
            format!("{},{x:.12},{y:.12},{z:.12}", values[0])
        };
        let lines: Vec<String> = si.lines().skip(1).map(line).collect();
        format!("{header}{}\n", lines.join("\n"))
    };
    bench.write("si.csv", &si);
    bench.write("g.csv", scaled(1.0 / 9.80665, "t_s,ax,ay,az\n"));
    bench.write("said-si.csv", scaled(1.0 / 9.80665, "t_s,ax_mps2,ay_mps2,az_mps2\n"));
    bench.write("said-g.csv", scaled(1.0 / 9.80665, "t_s,ax_g,ay_g,az_g\n"));
    bench.write("bare.mat", scaled(1.0 / 9.80665, "").replace(',', " "));
    bench.write("gyro.csv", scaled(0.01, "t_s,x,y,z\n"));
    let units = "[columns]\naccelerometer_unit = \"g\"\ngyroscope_unit = \"deg/s\"\n";
    bench.preset("static-poses", "poses.toml", &[]);
    bench.write("columns.toml", bench.read("poses.toml") + "\n" + units);

    for (arguments, hint, option) in [
        ("si.csv", "magnitudes around 9.8 suggest m/s²", "--accelerometer-unit m/s², mm/s², g, mg or counts"),
        ("g.csv", "magnitudes around 0.999 suggest g", "--accelerometer-unit m/s², mm/s², g, mg or counts"),
        (
            "bare.mat",
            "magnitudes around 0.999 suggest g",
            "--accelerometer-unit m/s², mm/s², g, mg or counts",
        ),
        (
            "gyro.csv --sensor gyroscope",
            "may be rad/s, or deg/s of slow turns",
            "--gyroscope-unit rad/s, deg/s, mdps or counts",
        ),
        (
            "bare.mat --sensor gyroscope",
            "may be rad/s, or deg/s of slow turns",
            "--gyroscope-unit rad/s, deg/s, mdps or counts",
        ),
        (
            "si.csv --sensor gyroscope",
            "may be rad/s, or deg/s of slow turns",
            "--gyroscope-unit rad/s, deg/s, mdps or counts",
        ),
    ] {
        bench.refuses(&format!("noise {arguments} -o result"), 3, &["columns have no unit", hint, option]);
    }
    // whatever gives the unit, the result is the same
    let n = |arguments: &str| {
        let outcome = bench.run(&format!("noise {arguments} --json")).done();
        let json = outcome.json();
        let sensor = &json["sensors"][0];
        let unit = sensor["reading_unit"].as_str().expect("a unit").to_owned();
        (sensor["axes"][1]["random_walk"]["value"].as_f64().expect("determined"), unit)
    };
    let expected = 0.1 / 12.0_f64.sqrt() * 0.1;
    for (arguments, factor, unit) in [
        ("si.csv --unit mps2", 1.0, "m/s²"),
        ("si.csv --accelerometer-unit m/s2", 1.0, "m/s²"),
        ("si.csv --unit counts", 1.0, "counts"),
        ("si.csv --gain 10", 0.1, "m/s²"),
        ("si.csv --unit counts --gain 10", 0.1, "m/s²"),
        ("g.csv --unit g", 1.0, "m/s²"),
        ("g.csv --columns columns.toml", 1.0, "m/s²"),
        ("bare.mat --unit g", 1.0, "m/s²"),
        ("said-g.csv", 1.0, "m/s²"),
        ("gyro.csv --sensor gyroscope --unit rad/s", 0.01, "rad/s"),
        ("gyro.csv --sensor gyroscope --gyroscope-unit dps", 0.01_f64.to_radians(), "rad/s"),
        ("gyro.csv --sensor gyroscope --columns columns.toml", 0.01_f64.to_radians(), "rad/s"),
        ("gyro.csv --sensor gyroscope --unit counts", 0.01, "counts"),
    ] {
        let (found, its) = n(arguments);
        // 3000 samples: 1.3 % is one standard deviation
        assert!((found / (factor * expected) - 1.0).abs() < 0.05, "{arguments}: {found}");
        assert_eq!(its, unit, "{arguments}");
    }
    // an answer that gravity contradicts, that is no unit, or that contradicts another
    let refused = [
        ("said-si.csv", 3, "said to be in m/s², but its magnitude is 0.999 most of the time: is it in g?"),
        ("g.csv --unit mps2", 3, "is it in g?"),
        ("said-g.csv --unit counts", 3, "columns are in g, but the unit was given as counts"),
        ("said-g.csv --gain 10", 2, "--gain is one of counts, but the file gives the accelerometer in m/s²"),
        ("si.csv --unit rad/s", 2, "--unit rad/s is no unit of the accelerometer"),
        (
            "si.csv --unit g --accelerometer-unit counts",
            2,
            "--unit is g, but the accelerometer's unit is given as",
        ),
        (
            "si.csv --unit furlongs",
            2,
            "the accelerometer is in m/s², mm/s², g, mg or counts, also of a sensitivity (16384 LSB/g, 0.061 mg/LSB), the gyroscope in rad/s",
        ),
        ("si.csv --columns poses.toml", 2, "there is no [columns] section"),
    ];
    refused.iter().for_each(|(arguments, status, says)| {
        bench.refuses(&format!("noise {arguments} -o result"), *status, &[says]);
    });
}

/// No unit is in imu_tk's files, and these are counts: once N was given as 0.37 m/s²/√Hz.
#[test]
fn the_units_of_the_mti_are_asked_for() {
    for (sensor, name) in [("accelerometer", "xsens_acc.mat"), ("gyroscope", "xsens_gyro.mat")] {
        let Some(path) = shared_data(&format!("xsens-mti-static/{name}")) else { return };
        let bench = Bench::new();
        std::fs::copy(&path, bench.path(name)).expect("copied");
        bench.refuses(
            &format!("noise {name} --sensor {sensor} -o result"),
            3,
            &[&format!("the {sensor}'s columns have no unit"), "suggest counts", &format!("--{sensor}-unit")],
        );
        let outcome = bench.run(&format!("noise {name} --sensor {sensor} --{sensor}-unit counts")).done();
        assert!(outcome.printed().contains("counts/√Hz"), "{}", outcome.stdout);
    }
}

#[test]
fn the_mti_at_rest() {
    let Some(path) = shared_data("xsens-mti-static/xsens_acc.mat") else { return };
    let bench = Bench::new();
    std::fs::copy(&path, bench.path("xsens_acc.mat")).expect("copied");
    let outcome = bench.run("noise xsens_acc.mat --gain 415,413,415 -o result").done();
    for says in [
        "Noise of the accelerometer From 5199 samples, 0.28 to 52.25 s, at 100.01 Hz.",
        "52.0 of the 511.7 s recorded, the longest of 38 holds",
    ] {
        assert!(outcome.printed().contains(says), "{says}\n{}", outcome.stdout);
    }
    let sensor = &bench.json("result/noise.json")["sensors"][0];
    // a line with 1.6 % of the variance of x, whose samples' filter leaves little else: N is that of longer
    // cluster times
    assert!(outcome.stderr.contains("accelerometer x: a line at 45.4 Hz has 1.6 %"), "{}", outcome.stderr);
    assert!(outcome.printed().contains("in [sensor]: noise_counts = ") && sensor["caveat"].is_null());
    let line = &sensor["axes"][0]["vibration"];
    assert!(line["left_out"] == true && line["of_white"].as_f64().expect("known") < 0.01, "{line}");
    for axis in sensor["axes"].as_array().expect("axes") {
        let n = axis["random_walk"]["value"].as_f64().expect("determined");
        // its samples are filtered: 8 to 9.5e-4 if the filter passes for the end of the white noise
        assert!((8e-4..1.05e-3).contains(&n), "{n} m/s²/√Hz");
        assert_eq!(axis["bias_instability"]["determined"], false);
    }
}

/// Kalibr's number is the white noise of one sample over the root of the rate, in SI whatever the unit of the
/// readings.
#[test]
fn what_was_measured_goes_into_an_imu_yaml() {
    let bench = Bench::new();
    bench.write("still.csv", recording("t_s,ax_counts,ay_counts,az_counts", 6000, 100.0));
    bench.run("noise still.csv -o noise").done();
    let calibration = r#"{"acc_unit": "m/s^2", "gyr_unit": "deg/s", "from_acc_unit": "a.u.", "from_gyr_unit": "a.u.", "comment": null,
        "K_a": [[200.0, 0.0, 0.0], [0.0, 200.0, 0.0], [0.0, 0.0, 200.0]], "R_a": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        "b_a": [0.0, 0.0, 0.0], "K_g": [[16.0, 0.0, 0.0], [0.0, 16.0, 0.0], [0.0, 0.0, 16.0]], "R_g": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        "K_ga": [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], "b_g": [0.0, 0.0, 0.0], "cal_type": "Ferraris", "_format_version": "2.0.0"}"#;
    bench.write("imu.json", calibration);
    bench.run("convert imu.json imu.yaml --noise noise/noise.json").done();
    let yaml = bench.read("imu.yaml");
    let value = |key: &str| -> Option<f64> {
        yaml.lines().find_map(|line| line.trim().strip_prefix(key)?.strip_prefix(": ")?.parse().ok())
    };
    let density = value("accelerometer_noise_density").expect("determined");
    let expected = 100.0 / 12.0_f64.sqrt() * 0.1 / 200.0;
    assert!((density / expected - 1.0).abs() < 0.05, "{density} beside {expected}");
    assert!((value("update_rate").expect("known") - 100.0).abs() < 1e-3, "{yaml}");
    assert_eq!(value("accelerometer_random_walk"), None, "not determined: {yaml}");
    let si = calibration.replace("a.u.\", \"from_gyr_unit", "m/s^2\", \"from_gyr_unit");
    bench.write("si.json", si.replace("a.u.", "deg/s"));
    bench.refuses(
        "convert si.json other.yaml --noise noise/noise.json",
        2,
        &["the noise of the accelerometer is in counts, the calibration in m/s²"],
    );
    bench.write("none.json", "{}");
    bench.refuses("convert imu.json other.yaml --noise none.json", 2, &["none.json", "calibrant noise"]);
}
