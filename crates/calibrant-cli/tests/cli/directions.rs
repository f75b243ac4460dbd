//! Tests of an accelerometer alone in known directions.

use crate::bench::{Bench, assert_close_to_truth, names};

const FACES: &str = r#""x", "-x", "y", "-y", "z", "-z", "x", "-x", "y", "-y", "z", "-z""#;

/// The experiment with these lines in `[holds]`.
fn with(bench: &Bench, file: &str, lines: &str) {
    let intervals: Vec<String> = (0..12).map(|k| format!("[{}, {}]", 6 * k, 6 * k + 4)).collect();
    let holds = format!("intervals_s = [{}]\n{lines}\nminimum_hold_s = 1.0", intervals.join(", "));
    bench.preset("static-poses", file, &[("minimum_hold_s = 1.0", &holds)]);
}

#[test]
fn directions_fix_the_frame_and_wrong_ones_are_refused() {
    let bench = Bench::new();
    with(&bench, "faces.toml", &format!("directions = [{FACES}]\nface_sd_deg = 0.3"));
    with(&bench, "free.toml", "");
    with(&bench, "alone.toml", "face_sd_deg = 0.3");
    with(&bench, "flipped.toml", &format!("directions = [{}]", FACES.replacen("\"y\"", "\"-y\"", 1)));
    let oblique = (0..12).map(|k| format!("[{}, {}, {}]", k % 5 - 2, k * 7 % 11 - 5, k * k % 7 - 3));
    let nonsense = oblique.collect::<Vec<_>>().join(", ");
    with(&bench, "nonsense.toml", &format!("directions = [{nonsense}]"));
    bench.run("simulate faces.toml --seed 3 -o made").done();
    let calibrate = |file: &str| format!("calibrate {file}.toml made/recording.csv --no-report -o {file}");
    let done = bench.run(&calibrate("faces")).done();
    assert!(!done.stderr.contains("warning"), "{}", done.stderr);
    assert!(done.printed().contains("face alignment is 0.30° about each axis, as given"), "{}", done.stdout);
    let (found, truth) = (bench.json("faces/calibration.json"), bench.json("made/truth.json"));
    assert_eq!(names(&found["parameters"]).len(), 12);
    assert_close_to_truth(&found, &truth);
    bench.run(&calibrate("free")).done();
    assert_eq!(names(&bench.json("free/calibration.json")["parameters"]).len(), 9, "in a gauge");
    bench.run(&calibrate("alone")).done().says("holds.face_sd_deg is not used");
    let hold_3 = "is given with -y up, but the accelerometer shows y up";
    bench.refuses(&calibrate("flipped"), 2, &["hold 3", hold_3, "correct the directions"]);
    bench.refuses(&calibrate("nonsense"), 2, &["hold 1", "correct the directions"]);
    bench.refuses(&format!("{} --folds 3", calibrate("faces")), 2, &["folds say nothing"]);
}

#[test]
fn six_known_faces_determine_twelve_parameters() {
    let bench = Bench::new();
    bench.preset("faces", "faces.toml", &[]);
    bench.run("simulate faces.toml -o made").done();
    let done = bench.run("calibrate faces.toml made/recording.csv --no-report -o result").done();
    assert!(done.printed().contains("from 6 of 6 holds") && !done.stderr.contains("warning"), "{done:?}");
    let found = bench.json("result/calibration.json");
    assert_eq!(names(&found["parameters"]).len(), 12);
    assert_close_to_truth(&found, &bench.json("made/truth.json"));
}

#[test]
fn holds_without_times_are_on_the_faces_that_they_show() {
    let bench = Bench::new();
    let in_order = "directions = [\"x\", \"-x\", \"y\", \"-y\", \"z\", \"-z\"]";
    let edited = |file: &str, directions: &str| bench.preset("faces", file, &[(in_order, directions)]);
    bench.preset("faces", "faces.toml", &[]);
    bench.run("simulate faces.toml -o made").done();
    let calibrate = |file: &str| format!("calibrate {file}.toml made/recording.csv --no-report -o {file}");
    bench.run(&calibrate("faces")).done();
    edited("other.toml", "directions = [\"-z\", \"y\", \"x\", \"z\", \"-x\", \"-y\"]");
    assert!(!bench.run(&calibrate("other")).done().stderr.contains("faces-unmatched"));
    let parameters = |folder: &str| bench.json(&format!("{folder}/calibration.json"))["parameters"].clone();
    assert_eq!(parameters("other"), parameters("faces"), "in any order");
    edited("five.toml", "directions = [\"x\", \"-x\", \"y\", \"-y\", \"z\", [1, 1, -1]]");
    let said = bench.run(&calibrate("five")).done();
    said.says("not used: 61.1 to 71.8 s with -z up; no hold has (+0.6, +0.6, -0.6) up");
    edited("none.toml", "directions = [[1, 1, 1]]");
    bench.refuses(&calibrate("none"), 3, &["no hold is in one of holds.directions", "lay the sensor"]);
    // counts of unknown gain: by the ends of each axis
    let counts: Vec<String> = bench.read("made/recording.csv").lines().map(in_counts).collect();
    bench.write("counts.csv", counts.join("\n"));
    bench.preset("faces", "counts.toml", &[("unit = \"mps2\" ", "unit = \"counts\" ")]);
    bench.run("calibrate counts.toml counts.csv --no-report -o counts").done();
    let gain = |folder: &str| parameters(folder)[3]["value"].as_f64().expect("a number");
    assert!((gain("counts") / gain("faces") / 400.0 - 1.0).abs() < 1e-3, "{}", gain("counts"));
}

/// A row of a recording in m/s² in counts.
fn in_counts(row: &str) -> String {
    let fields: Vec<&str> = row.split(',').collect();
    match fields[1].parse::<f64>() {
        Err(_) => "t_s,ax_counts,ay_counts,az_counts".to_owned(),
        Ok(_) => {
            let count = |of: &&str| format!("{:.0}", 400.0 * of.parse::<f64>().expect("a number") + 3e4);
            format!("{},{}", fields[0], fields[1..].iter().map(count).collect::<Vec<_>>().join(","))
        }
    }
}

#[test]
fn an_imu_may_lie_on_faces_too() {
    let bench = Bench::new();
    let faces = format!("[holds]\ndirections = [{FACES}]\nface_sd_deg = 0.3");
    bench.preset("imu", "imu.toml", &[("[holds]", &faces)]);
    bench.run("simulate imu.toml -o made").done();
    let done = bench.run("calibrate imu.toml made/recording.csv --no-report -o result").done();
    assert!(done.printed().contains("from 12 of 12 holds"), "{}", done.stdout);
    assert!(done.printed().contains("face alignment is 0.30° about each axis, as given"), "{}", done.stdout);
    assert_close_to_truth(&bench.json("result/calibration.json"), &bench.json("made/truth.json"));
}
