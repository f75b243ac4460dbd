//! Several recordings of one accelerometer, calibrated together.

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
fn what_cannot_be_calibrated_together_is_refused() {
    let bench = parts();
    bench.refuses(
        "calibrate poses.toml a.csv a.csv --together -o joined",
        3,
        &["a.csv", "they would count twice"],
    );
    bench.preset("imu", "imu.toml", &[]);
    bench.refuses(
        "calibrate imu.toml a.csv b.csv --together -o joined",
        2,
        &["--together is for an accelerometer"],
    );
}
