//! Tests of `calibrate --resume`: what is there is not computed again, and the batch is the same.

use crate::bench::Bench;
use std::time::SystemTime;

const CALIBRATE: &str =
    "calibrate experiment.toml --motion motion.csv s1.csv s2.csv s3.csv s4.csv s5.csv s6.csv -o results";

/// The sensors whose result was written after this time.
fn written_since(bench: &Bench, before: &[SystemTime]) -> Vec<usize> {
    let now = times(bench);
    (1..=6).filter(|k| now[k - 1] != before[k - 1]).collect()
}

/// When each calibration.json was written.
fn times(bench: &Bench) -> Vec<SystemTime> {
    let time = |k: usize| {
        let path = bench.path(&format!("results/s{k}/calibration.json"));
        path.metadata().and_then(|found| found.modified()).expect("a time")
    };
    (1..=6).map(time).collect()
}

fn finished() -> Bench {
    let bench = Bench::new();
    bench.six_sensors();
    bench.run(CALIBRATE).ends_with(5);
    bench
}

#[test]
fn an_interrupted_batch_goes_on_and_ends_as_if_it_had_not_been() {
    let bench = finished();
    let results = ["summary.csv", "batch.html"].map(|name| bench.read(&format!("results/{name}")));
    let uninterrupted = bench.run(CALIBRATE).ends_with(5);
    let before = times(&bench);
    // s3 was not begun, and s5 was interrupted before its last file
    std::fs::remove_dir_all(bench.path("results/s3")).expect("removed");
    std::fs::remove_file(bench.path("results/s5/resume.json")).expect("removed");
    for name in ["summary.csv", "batch.html"] {
        std::fs::remove_file(bench.path(&format!("results/{name}"))).expect("removed");
    }
    let resumed = bench.run(&format!("{CALIBRATE} --resume")).ends_with(5);
    assert_eq!(written_since(&bench, &before), [3, 5]);
    resumed.says("note: 4 of 6 recordings were calibrated before");
    assert_eq!(resumed.stdout, uninterrupted.stdout);
    let told = resumed.stderr.replace("note: 4 of 6 recordings were calibrated before [results-kept]\n", "");
    let left = |line: &&str| !line.contains("is that of an earlier run");
    assert_eq!(told, uninterrupted.stderr.lines().filter(left).map(|l| format!("{l}\n")).collect::<String>());
    assert_eq!(["summary.csv", "batch.html"].map(|name| bench.read(&format!("results/{name}"))), results);

    let before = times(&bench);
    bench.run(&format!("{CALIBRATE} --resume --threads 1")).ends_with(5).says("note: 6 of 6");
    assert!(written_since(&bench, &before).is_empty());
    assert_eq!(["summary.csv", "batch.html"].map(|name| bench.read(&format!("results/{name}"))), results);
    bench.run(CALIBRATE).ends_with(5);
    assert_eq!(written_since(&bench, &before).len(), 6, "without --resume, all are computed");
}

#[test]
fn what_is_of_other_input_is_computed_again() {
    let bench = finished();
    let resume = |options: &str, expected: &[usize]| {
        let before = times(&bench);
        bench.run(&format!("{CALIBRATE} --resume {options}")).ends_with(5);
        assert_eq!(written_since(&bench, &before), expected, "{options}");
    };
    let longer = bench.read("s1.csv");
    let shorter: Vec<&str> = longer.lines().collect();
    bench.write("s2.csv", shorter[..shorter.len() - 1].join("\n"));
    resume("", &[2]);
    // a result that was edited
    let edited = bench.read("results/s6/calibration.json").replace("converged", "stalled");
    bench.write("results/s6/calibration.json", edited);
    let says = ["results/s6/calibration.json: this file is there already", "--force"];
    bench.refuses(&format!("{CALIBRATE} --resume"), 2, &says);
    // a page that is missing
    std::fs::remove_file(bench.path("results/s1/report.html")).expect("removed");
    resume("--force", &[1, 6]);
    // a key file that is cut short
    let cut = bench.read("results/s3/resume.json")[..200].to_owned();
    bench.write("results/s3/resume.json", cut);
    let before = times(&bench);
    let says = "note: s3: results/s3/resume.json cannot be read: the recording is calibrated again";
    bench.run(&format!("{CALIBRATE} --resume")).ends_with(5).says(says);
    assert_eq!(written_since(&bench, &before), [3]);
    assert!(
        !bench.run(&format!("{CALIBRATE} --resume")).stderr.contains("resume-damaged"),
        "it was written anew"
    );
    resume("--allow spikes", &[1, 2, 3, 4, 5, 6]);
    resume("--allow spikes", &[]);
    bench.write("experiment.toml", bench.read("experiment.toml") + "# another\n");
    resume("--allow spikes", &[1, 2, 3, 4, 5, 6]);
    bench.write("motion.csv", bench.read("motion.csv") + "\n");
    resume("--allow spikes", &[1, 2, 3, 4, 5, 6]);
}

#[test]
fn a_resumed_batch_denies_and_prints_what_it_would_have() {
    let bench = finished();
    let all = |options: &str| bench.run(&format!("{CALIBRATE} {options}"));
    let json = all("--json").ends_with(5).stdout;
    assert_eq!(all("--json --resume").ends_with(5).stdout, json);
    let denied = all("--resume --deny parameter-implausible").ends_with(5);
    denied.says("error: denied: parameter-implausible: s4: ");
    let one = "calibrate experiment.toml --motion motion.csv s1.csv --resume -o one";
    bench.run(one).done().says("warning: --resume is not used");
}
