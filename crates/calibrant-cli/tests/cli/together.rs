//! Several recordings of one sensor, calibrated together.

use crate::bench::Bench;

/// A recording of 24 poses in three parts: none determines the sensor by itself.
fn parts() -> Bench {
    let bench = Bench::new();
    bench.preset("static-poses", "poses.toml", &[]);
    bench.run("simulate poses.toml -o whole").done();
    let text = bench.read("whole/recording.csv");
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    let (header, rows) = lines.split_first().expect("a header");
    for (name, rows) in ["a.csv", "b.csv", "c.csv"].iter().zip(rows.chunks(rows.len().div_ceil(3))) {
        bench.write(name, format!("{header}\n{}\n", rows.join("\n")));
    }
    bench
}

#[test]
fn parts_of_a_session_give_together_what_the_whole_gives() {
    let bench = parts();
    bench.refuses("calibrate poses.toml a.csv -o alone", 4, &["holds"]);
    bench.run("calibrate poses.toml whole/recording.csv -o result").done();
    let outcome = bench.run("calibrate poses.toml a.csv b.csv c.csv --together -o joined").done();
    assert!(outcome.printed().contains("from 24 of 24 holds"), "{}", outcome.stdout);
    let (whole, joined) = (bench.json("result/calibration.json"), bench.json("joined/calibration.json"));
    let files: Vec<_> =
        joined["inputs"].as_array().expect("files").iter().map(|input| &input["file"]).collect();
    assert_eq!(files, ["a.csv", "b.csv", "c.csv"]);
    bench.refuses(
        "calibrate poses.toml a.csv b.csv c.csv --together --sensor-from {sensor} -o named",
        2,
        &["--together is for one sensor, and the recordings name \"a\" and \"b\""],
    );
    for (one, other) in whole["parameters"]
        .as_array()
        .expect("nine")
        .iter()
        .zip(joined["parameters"].as_array().expect("nine"))
    {
        let [value, again, sd] =
            [&one["value"], &other["value"], &one["sd"]].map(|of| of.as_f64().expect("a number"));
        assert!((value - again).abs() < sd, "{one} {other}");
    }
}

#[test]
fn a_recording_of_which_nothing_is_used_is_named() {
    let bench = parts();
    let in_another_unit = |line: &str| {
        let scaled = |value: &str| {
            value.parse::<f64>().map_or_else(|_| value.to_owned(), |of| (of * 90.0).to_string())
        };
        let mut values = line.split(',');
        let time = values.next().unwrap_or_default().to_owned();
        std::iter::once(time).chain(values.map(scaled)).collect::<Vec<_>>().join(",")
    };
    let text = bench.read("c.csv");
    bench.write("c.csv", text.lines().map(in_another_unit).collect::<Vec<_>>().join("\n"));
    let outcome = bench.run("calibrate poses.toml a.csv b.csv c.csv --together -o joined").done();
    assert!(outcome.stdout.contains("verdict: doubtful (recording-unused)"), "{}", outcome.stdout);
}

#[test]
fn what_cannot_be_calibrated_together_is_refused() {
    let bench = parts();
    bench.refuses(
        "calibrate poses.toml a.csv a.csv --together -o joined",
        3,
        &["a.csv", "they would count twice"],
    );
    bench.preset(
        "static-poses",
        "given.toml",
        &[("# intervals_s = [[0.0, 50.0]", "intervals_s = [[0.0, 50.0]")],
    );
    bench.refuses(
        "calibrate given.toml a.csv b.csv --together -o joined",
        2,
        &["--together needs holds that are found, and holds.intervals_s gives them"],
    );
}

/// The rows of a recording of an IMU from this time on, or up to it, with this change of the readings of both sensors' first axes.
fn part(bench: &Bench, from: &str, keep: impl Fn(f64) -> bool, change: [f64; 2]) -> String {
    let text = bench.read(from);
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let mut out = format!("{}\n", lines.next().expect("a header"));
    for line in lines {
        let mut values: Vec<f64> = line.split(',').map(|value| value.parse().expect("a number")).collect();
        if keep(values[0]) {
            (values[1], values[4]) = (values[1] + change[0], values[4] + change[1]);
            let values: Vec<String> = values.iter().map(f64::to_string).collect();
            out.push_str(&format!("{}\n", values.join(",")));
        }
    }
    out
}

/// The estimates and their standard deviations.
fn estimates(bench: &Bench, result: &str) -> Vec<(String, f64, f64)> {
    let result = bench.json(result);
    let number = |of: &serde_json::Value, key: &str| of[key].as_f64().expect("a number");
    let parameters = result["parameters"].as_array().expect("parameters");
    parameters.iter().map(|of| (of["name"].to_string(), number(of, "value"), number(of, "sd"))).collect()
}

/// A sensor that was off between two recordings has another bias in each. The result's is that of the last, and its standard deviation is that of the last recording's holds.
#[test]
fn an_imu_of_two_recordings_has_the_bias_of_the_last_and_one_matrix() {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    bench.run("simulate imu.toml -o whole").done();
    bench.run("calibrate imu.toml whole/recording.csv --no-report -o result").done();
    let end_s: f64 = bench
        .read("whole/recording.csv")
        .lines()
        .last()
        .and_then(|line| line.split(',').next())
        .and_then(|t| t.parse().ok())
        .expect("a time");
    let middle_s = 0.5 * end_s;
    let changes = [("same", [0.0, 0.0]), ("other", [0.03, -0.004])];
    for (name, change) in changes {
        bench.write("a.csv", part(&bench, "whole/recording.csv", |t| t < middle_s, change));
        bench.write("b.csv", part(&bench, "whole/recording.csv", |t| t >= middle_s, [0.0, 0.0]));
        let joined = format!("calibrate imu.toml a.csv b.csv --together --no-report -o {name}");
        let printed = bench.run(&joined).done().printed();
        assert!(printed.contains("verdict: ok"), "{printed}");
    }
    // a last recording without a hold tells nothing of its bias: all have one
    bench.write("a.csv", part(&bench, "whole/recording.csv", |t| t < middle_s, [0.0, 0.0]));
    bench.write("b.csv", part(&bench, "whole/recording.csv", |t| t > end_s - 0.5, [0.0, 0.0]));
    let printed =
        bench.run("calibrate imu.toml a.csv b.csv --together --no-report -o short").done().printed();
    assert!(!printed.contains("bias 1"), "{printed}");
    let whole = estimates(&bench, "result/calibration.json");
    for (name, change) in changes {
        let joined = estimates(&bench, &format!("{name}/calibration.json"));
        for ((parameter, value, _), (_, again, sd)) in whole.iter().zip(&joined) {
            assert!((value - again).abs() < 1.5 * sd, "{name}: {parameter} {value} {again} ± {sd}");
        }
        let result = bench.json(&format!("{name}/calibration.json"));
        let first = |of: &str, key: &str| result[of][key][0][0].as_f64();
        let [accelerometer, gyroscope] =
            [first("holds", "earlier_biases_mps2"), first("still_gyroscope", "earlier_biases_radps")];
        if name == "other" {
            assert!((accelerometer.expect("differs") - change[0]).abs() < 0.004, "{accelerometer:?}");
            assert!((gyroscope.expect("differs") - change[1]).abs() < 0.0002, "{gyroscope:?}");
        }
        // half of the holds tell it
        let sd = |of: &[(String, f64, f64)]| {
            of.iter().find(|(name, ..)| name.contains("gyroscope.bias.x")).expect("it is estimated").2
        };
        let ratio = sd(&joined) / sd(&whole);
        assert!(name != "other" || (1.2..1.6).contains(&ratio), "{ratio}");
    }
}
