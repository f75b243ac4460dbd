//! Tests of an interruption: a first signal keeps the best so far, a second ends at once.

use crate::bench::{Bench, Outcome};
use std::process::{Command, Stdio};
use std::time::Duration;

/// Starts the program, and sends it these signals, each after this time.
fn interrupted(bench: &Bench, arguments: &str, after: &[Duration]) -> Outcome {
    let mut program = Command::new(env!("CARGO_BIN_EXE_calibrant"));
    program.args(arguments.split_whitespace());
    let signals: Vec<_> = after.iter().map(|time| ("TERM", *time)).collect();
    signalled(bench, program, |signal| {
        for (name, time) in &signals {
            std::thread::sleep(*time);
            signal(name);
        }
    })
}

/// Starts this program; `interrupt` sends it signals by their names.
fn signalled(bench: &Bench, mut program: Command, interrupt: impl FnOnce(&dyn Fn(&str))) -> Outcome {
    let piped = program.current_dir(bench.path("")).stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = piped.spawn().expect("the program runs");
    interrupt(&|name| {
        let kill = Command::new("kill").args([&format!("-{name}"), &child.id().to_string()]).status();
        assert!(kill.expect("kill runs").success());
    });
    let output = child.wait_with_output().expect("it ends");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
    Outcome {
        command: format!("{program:?}"),
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

/// As `nohup` and a script's `&` start it.
#[test]
fn a_signal_that_is_ignored_stays_so_and_the_others_keep_the_best() {
    let bench = Bench::new();
    bench.preset("report", "motion.toml", &[]);
    let design = "design motion.toml --starts 1000000 --force -o result";
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("trap '' HUP INT; exec {} {design}", env!("CARGO_BIN_EXE_calibrant"))]);
    let outcome = signalled(&bench, shell, |signal| {
        std::thread::sleep(SOON);
        ["HUP", "INT", "TERM"].into_iter().for_each(signal);
    });
    outcome.ends_with(130).says("warning: the search was interrupted. The motion is the best so far");
    assert_eq!(bench.json("result/design.json")["status"], "interrupted");
}

#[test]
fn a_batch_says_what_is_finished_and_writes_its_summary() {
    let bench = Bench::new();
    bench.preset("static-poses", "poses.toml", &[]);
    bench.run("simulate poses.toml -o made").done();
    let text = bench.read("made/recording.csv");
    let names: Vec<String> = (100..300).map(|k| format!("s{k}.csv")).collect();
    for name in &names {
        bench.write(name, text.replacen("\n0.01,", &format!("\n0.01{}1,", &name[1..4]), 1));
    }
    let batch = format!("calibrate poses.toml {} --no-report -o result", names.join(" "));
    let mut program = Command::new(env!("CARGO_BIN_EXE_calibrant"));
    program.args(batch.split_whitespace()).args(["--threads", "1"]);
    let outcome = signalled(&bench, program, |signal| {
        while !bench.path("result/s101/resume.json").exists() {
            std::thread::sleep(Duration::from_millis(2));
        }
        signal("TERM");
    });
    let outcome = outcome.ends_with(130);
    outcome.says("warning: the batch was interrupted: ");
    outcome.says(" of 200 recordings are finished");
    let summary = bench.read("result/summary.csv");
    let finished = summary.matches(",converged,").count();
    assert!(
        (2..200).contains(&finished) && summary.matches(",interrupted,").count() == 200 - finished,
        "{summary}"
    );
    assert!(
        outcome.stdout.contains(&format!("\n{finished} calibrated, 0 failed: result/summary.csv\n")),
        "{outcome:?}"
    );
    assert!(
        outcome.stdout.contains(&format!("Yield 100 %: {finished} of {finished} sensors ok.")),
        "{outcome:?}"
    );
    assert!(bench.read("result/batch.html").contains(&format!("{finished} of 200 recordings are finished")));
    // what is left is calibrated when it goes on
    bench.run(&format!("{batch} --resume")).done().says(&format!("note: {finished} of 200 recordings"));
}

#[test]
fn a_limit_of_the_size_of_files_is_an_error_and_leaves_nothing() {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    let command = "ulimit -f 8; exec \"$0\" simulate imu.toml -o result";
    let mut shell = Command::new("sh");
    shell.args(["-c", command, env!("CARGO_BIN_EXE_calibrant")]);
    let outcome = signalled(&bench, shell, |_| ()).ends_with(2);
    outcome.says("File too large");
    let left = std::fs::read_dir(bench.path("result")).expect("a folder").flatten();
    let left: Vec<_> =
        left.map(|entry| entry.file_name()).filter(|name| name.to_string_lossy().ends_with(".tmp")).collect();
    assert!(left.is_empty(), "{left:?}");
}
