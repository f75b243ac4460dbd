//! Tests of `--deny` and `--allow`: diagnostics set the exit status of a production line.

use crate::bench::Bench;
use calibrant::diagnostic::Code;
use calibrant::error::Refusal;

#[test]
fn a_denied_code_sets_the_exit_status_and_the_results_are_written() {
    let bench = Bench::new();
    bench.stepped_poses();
    for denied in ["sensor-changed", "warnings"] {
        let outcome =
            bench.run(&format!("calibrate poses.toml stepped.csv --deny {denied} -o {denied}")).ends_with(1);
        assert!(outcome.stderr.contains("error: denied: sensor-changed: "), "{}", outcome.stderr);
        assert!(!bench.read(&format!("{denied}/calibration.json")).is_empty());
    }
    bench.run("calibrate poses.toml stepped.csv --deny spikes -o other").done();
    bench.run("calibrate poses.toml stepped.csv honest/recording.csv --deny warnings -o both").ends_with(1);
}

#[test]
fn an_allowed_code_is_silent_and_stays_in_the_json() {
    let bench = Bench::new();
    bench.stepped_poses();
    let run = "calibrate poses.toml stepped.csv --deny warnings --allow sensor-changed -o allowed";
    let outcome = bench.run(run);
    assert!(!outcome.stderr.contains("the accelerometer changes"), "{}", outcome.stderr);
    let json = bench.json("allowed/calibration.json");
    let warnings = json["warnings"].as_array().expect("a list");
    let change = warnings.iter().find(|warning| warning["code"] == "sensor-changed").expect("there");
    assert_eq!(change["severity"], "allowed");
}

#[test]
fn an_unknown_code_is_refused_with_the_nearest_name() {
    let bench = Bench::new();
    let outcome = bench.run("calibrate poses.toml a.csv --deny sensor-chnaged -o x").ends_with(2);
    assert!(outcome.stderr.contains("did you mean `sensor-changed`?"), "{}", outcome.stderr);
}

#[test]
fn a_code_is_explained() {
    let bench = Bench::new();
    let text = bench.run("explain gyroscope-missing recording-repeated").done().stdout;
    assert!(
        text.starts_with("gyroscope-missing (warning)\n  The recording of an IMU has no gyroscope."),
        "{text}"
    );
    assert!(text.contains("\n  Decided: The file has no columns of a gyroscope"), "{text}");
    assert!(text.contains("\nrecording-repeated (no result)\n"), "{text}");
    let all = bench.run("explain").done().stdout;
    for code in Code::all().map(Code::name).chain(Refusal::ALL.iter().map(|code| code.name())) {
        assert!(all.contains(&format!("  {code} (")), "{code}");
    }
    bench.refuses("explain gyro-missing", 2, &["did you mean `gyroscope-missing`?"]);
    bench.refuses("explain recording-repeatd", 2, &["did you mean `recording-repeated`?"]);
    bench.refuses("init stge", 2, &["did you mean `stage`?"]);
}
