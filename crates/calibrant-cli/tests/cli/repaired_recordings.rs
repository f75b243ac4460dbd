//! Tests of recordings with small faults: they are used, and a finding names every repair and its line.

use crate::bench::Bench;

/// A change of a recording: the first line that was changed (from 1), and the new text.
type Edit = fn(&mut Vec<String>);

/// The faults: a name, the change, and the finding.
const CASES: &[(&str, Edit, &str)] = &[
    (
        "a sample is NaN",
        |rows| rows[7] = "0.6,NaN,1,2".into(),
        "line 8: 1 sample with a missing or NaN value dropped",
    ),
    (
        "a row is twice",
        |rows| rows.insert(7, rows[6].clone()),
        "line 8: 1 row equal to the one before dropped",
    ),
    (
        "a time is twice",
        |rows| rows.insert(7, rows[6].clone() + "e-1"),
        "line 8: 1 row with the time of the one before but another reading dropped",
    ),
    (
        "the last line is cut off",
        |rows| rows[101] = "10.0,1.".into(),
        "line 102: truncated last line dropped",
    ),
    (
        "samples are missing",
        |rows| drop(rows.drain(20..40)),
        "line 21: gap of 2.1 s after t = 1.8 s: about 20 samples are missing",
    ),
];

#[test]
fn small_faults_are_repaired_and_told() {
    let bench = Bench::new();
    bench.preset("report", "experiment.toml", &[]);
    bench.run("simulate experiment.toml -o simulated").done();
    let good = bench.read("simulated/recording.csv");
    for (what, edit, note) in CASES {
        let mut rows: Vec<String> = good.lines().map(str::to_owned).collect();
        edit(&mut rows);
        bench.write("faulty.csv", rows.join("\n"));
        let command = "calibrate experiment.toml faulty.csv --motion simulated/motion.csv -o result";
        let outcome = bench.run(command).done();
        outcome.says(&format!("note: faulty.csv: {note}"));
        assert!(outcome.printed().contains("converged"), "{what}");
        let report = bench.read("result/report.html");
        assert!(report.contains(note), "{what}: the report tells it too");
    }
}
