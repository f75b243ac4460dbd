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
