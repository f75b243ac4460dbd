//! Tests of invalid samples, numbers that no sensor gives, in a recording of a whole IMU.

use crate::bench::Bench;

#[test]
fn an_absurd_number_is_left_out_and_named_whatever_its_size() {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    bench.run("simulate imu.toml -o made").done();
    let text = bench.read("made/recording.csv");
    let with = |value: &str| {
        let mut rows: Vec<String> = text.lines().map(str::to_owned).collect();
        let mut cells: Vec<&str> = rows[5000].split(',').collect();
        cells[5] = value;
        rows[5000] = cells.join(",");
        bench.write("wild.csv", rows.join("\n") + "\n");
        bench.run("calibrate imu.toml wild.csv --no-report -o out").done()
    };
    with("1e12").says("1 sample is a spike and was replaced");
    let expected = bench.json("out/calibration.json")["parameters"].clone();
    let outcome = with("-1e300");
    outcome.says("gyroscope: 1 sample is a spike and was replaced");
    outcome.says("The farthest reads -1e300 rad/s at 49.990 s on axis y");
    assert_eq!(bench.json("out/calibration.json")["parameters"], expected, "not by a bit");
    let inspected = bench.run("inspect wild.csv").done().printed();
    assert!(
        inspected.contains("The farthest reads -1e300 rad/s") && inspected.contains("24 holds found"),
        "{inspected}"
    );
    bench
        .run("apply out/calibration.json wild.csv -o true.csv")
        .done()
        .says("gyroscope: 1 sample is a spike");
    // its own uncertainty overflows, which does not mean certainty
    let corrected = bench.read("true.csv");
    let row: Vec<&str> = corrected.lines().nth(5000).expect("a row").split(',').collect();
    assert_eq!((row[0], &row[10..]), ("49.99", &["inf"; 3][..]), "{row:?}");
}
