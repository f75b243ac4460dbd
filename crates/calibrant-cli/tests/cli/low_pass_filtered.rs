//! Tests of sensors behind a slow low-pass filter, which divides their holds.

use crate::bench::Bench;

/// A recording whose readings went through a filter of one pole.
fn filtered(recording: &str, pole: f64) -> String {
    let mut state: Option<Vec<f64>> = None;
    let mut text = String::new();
    for line in recording.lines() {
        let cells: Vec<f64> = line.split(',').filter_map(|cell| cell.parse().ok()).collect();
        let Some((time, readings)) = cells.split_first() else {
            text += &format!("{line}\n");
            continue;
        };
        let before = state.unwrap_or_else(|| readings.to_vec());
        let after: Vec<f64> = before.iter().zip(readings).map(|(x, y)| pole * x + (1.0 - pole) * y).collect();
        let row: Vec<String> = after.iter().map(f64::to_string).collect();
        text += &format!("{time},{}\n", row.join(","));
        state = Some(after);
    }
    text
}

/// The words of the warning about a filter.
const FILTER: &str =
    "neighbouring samples are strongly correlated, as behind a low-pass filter far below the sample rate";
/// The remedy.
const HELP: &str = "give holds.intervals_s, hold longer, or record with a wider bandwidth";

#[test]
fn holds_that_a_filter_breaks_up_are_told_with_what_to_do() {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    let calibrate = |file: &str| bench.run(&format!("calibrate imu.toml {file} --no-report -o out"));
    for (seed, found) in [(1, 14), (2, 8)] {
        bench.run(&format!("simulate imu.toml --seed {seed} -o made")).done();
        let recording = bench.read("made/recording.csv");
        for pole in [0.0, 0.8] {
            bench.write("plain.csv", filtered(&recording, pole));
            let message = bench.run("inspect plain.csv").done().printed();
            assert!(message.contains("24 holds found") && !message.contains(FILTER), "{pole}: {message}");
        }
        let outcome = calibrate("plain.csv").done();
        assert!(!outcome.stderr.contains(FILTER), "{outcome:?}");
        bench.write("slow.csv", filtered(&recording, 0.95));
        let message = bench.run("inspect slow.csv").done().printed();
        assert!(message.contains(&format!("{found} holds found")) && message.contains(FILTER), "{message}");
        let outcome = calibrate("slow.csv");
        assert_eq!(outcome.status, if found > 9 { 0 } else { 4 }, "{outcome:?}");
        outcome.says(FILTER);
        outcome.says(HELP);
        if found > 9 {
            outcome.says(&format!("{found} holds are found. {} other segments look stationary", 24 - found));
        }
    }
    // the holds are there: where they are given, they calibrate the sensor
    calibrate("plain.csv").done();
    let holds = bench.json("out/calibration.json")["holds"]["table"].clone();
    let intervals: Vec<String> = holds
        .as_array()
        .expect("holds")
        .iter()
        .map(|hold| {
            let time = |key: &str| hold[key].as_f64().expect("a time");
            format!("[{}, {}]", time("start_s") + 0.6, time("end_s"))
        })
        .collect();
    bench.preset(
        "imu",
        "given.toml",
        &[(
            "# intervals_s = [[0.0, 50.0], [52.0, 57.0]]",
            &format!("intervals_s = [{}]", intervals.join(", ")),
        )],
    );
    let outcome = bench.run("calibrate given.toml slow.csv --no-report -o given").done();
    assert!(!outcome.stderr.contains(FILTER), "{outcome:?}");
}
