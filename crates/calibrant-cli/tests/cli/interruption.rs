//! Tests of an interruption: a first signal keeps the best so far, a second ends at once.

use crate::bench::{Bench, Outcome};
use std::process::{Command, Stdio};
use std::time::Duration;

/// Starts the program, and sends it these signals, each after this time.
fn interrupted(bench: &Bench, arguments: &str, after: &[Duration]) -> Outcome {
    let child = Command::new(env!("CARGO_BIN_EXE_calibrant"))
        .args(arguments.split_whitespace())
        .current_dir(bench.path(""))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    for time in after {
        std::thread::sleep(*time);
        let kill = Command::new("kill").args(["-TERM", &child.id().to_string()]).status();
        assert!(kill.expect("kill runs").success());
    }
    let output = child.wait_with_output().expect("it ends");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
    Outcome {
        command: format!("calibrant {arguments}"),
        status: output.status.code().expect("an exit status, not a signal"),
        stdout: text(output.stdout),
        stderr: text(output.stderr),
    }
}

const SOON: Duration = Duration::from_millis(1500);

#[test]
fn a_design_keeps_its_best_and_is_beyond_the_budget_on_demand() {
    let bench = Bench::new();
    bench.preset("report", "motion.toml", &[]);
    // hours of work, which --force begins
    let design = "design motion.toml --starts 1000000 --force -o result";
    let outcome = interrupted(&bench, design, &[SOON]).ends_with(130);
    outcome.says("warning: the search was interrupted. The motion is the best so far");
    let design = bench.json("result/design.json");
    assert_eq!(design["status"], "interrupted");
    assert!(design["starts"].as_array().expect("every start").len() < 1_000_000);
    // the bound that takes no time
    assert!(design["certificate"]["gap"].as_f64().expect("a number") > 0.0, "{}", design["certificate"]);
    assert!(bench.read("result/report.html").contains("! Interrupted."));
    bench.run("design motion.toml --evaluate result/motion.csv --starts 1 --no-certificate -o other").done();
}

#[test]
fn a_study_keeps_the_finished_sensors() {
    let bench = Bench::new();
    let study = "study --sensors 4000 --starts 5 -o result";
    interrupted(&bench, study, &[SOON]).ends_with(130).says("warning: the study was interrupted: ");
    let study = bench.json("result/study.json");
    let note = study["notes"].to_string();
    assert!(note.contains("of 12000 sensors are finished"), "{note}");
    assert!(study["calibration"]["sensors"].as_array().is_some_and(|sensors| !sensors.is_empty()));
}

#[test]
fn a_second_interruption_ends_at_once() {
    let bench = Bench::new();
    bench.preset(
        "report",
        "motion.toml",
        &[("intervals = 10 ", "intervals = 3000 "), ("\"scale-bias\"", "\"full\"")],
    );
    let design = "design motion.toml --force -o result";
    interrupted(&bench, design, &[SOON, Duration::from_millis(20)]).ends_with(130);
    assert!(!bench.files().iter().any(|name| name.starts_with("result/.calibrant-")), "{:?}", bench.files());
}
