//! Tests of wrong commands and places that cannot be written: exit status 2.

use super::{CALIBRATE, bench};
use crate::bench::Bench;

/// Arguments and the messages about them.
const CASES: &[(&str, &[&str])] = &[
    ("frobnicate", &["unrecognized subcommand 'frobnicate'", "Usage: calibrant"]),
    ("calibrat experiment.toml", &["'calibrate'"]),
    (
        "init nosuch",
        &[
            "there is no preset `nosuch` (choose one of report, report-unknown,",
            "imu-counts, ferraris, campaign, arm, rate-table, gantry, mocap)",
        ],
    ),
    ("init report extra", &["unexpected argument 'extra'"]),
    ("simulate experiment.toml", &["--output <DIR>"]),
    ("simulate experiment.toml --seed -1 -o result", &["invalid value '-1' for '--seed"]),
    ("simulate experiment.toml --seed one -o result", &["invalid value 'one' for '--seed <SEED>'"]),
    ("simulate experiment.toml --recording 0 -o result", &["0 is not in 1..="]),
    ("calibrate experiment.toml --motion motion.csv -o result", &["<RECORDINGS>..."]),
    ("calibrate experiment.toml recording.csv --motion motion.csv", &["--output <DIR>"]),
    (
        "calibrate experiment.toml recording.csv -o result",
        &["needs the commanded motion", "add --motion FILE"],
    ),
    (
        "calibrate experiment.toml recording.csv --motion absent.csv -o result",
        &["absent.csv: cannot read the motion"],
    ),
    (
        "calibrate experiment.toml recording.csv --motion motion.csv --unit furlongs -o result",
        &["invalid value 'furlongs' for '--unit <UNIT>'", "m/s², mm/s², g, mg or counts"],
    ),
    ("study --sensors 0", &["0 is not in 1..="]),
    ("study static.toml -o result", &["a study needs a [motion] experiment, this one has [holds]"]),
    ("study --threads 0", &["0 is not in 1..="]),
];

#[test]
fn every_wrong_command_is_refused() {
    let bench = bench();
    for (arguments, says) in CASES {
        bench.refuses(arguments, 2, says);
    }
}

#[test]
fn a_file_in_the_way_of_the_directory_is_named_before_the_work_is_done() {
    let bench = bench();
    bench.write("taken", "mine");
    bench.preset("static-poses", "static.toml", &[]);
    let says = ["error: cannot write taken", "taken is a file, not a directory"];
    for command in [
        CALIBRATE.replace("result", "taken"),
        CALIBRATE.replace("result", "taken/below"),
        CALIBRATE.replace("recording.csv", "recording.csv recording.csv").replace("result", "taken"),
        // the place is checked first: this recording is not there
        CALIBRATE.replace("recording.csv", "absent.csv").replace("result", "taken"),
        "simulate experiment.toml -o taken".into(),
        "simulate static.toml -o taken".into(),
        "study --sensors 10000000 -o taken".into(),
    ] {
        bench.refuses(&command, 2, &says);
    }
    bench.refuses("init -o taken/experiment.toml", 2, &["cannot write taken/experiment.toml"]);
    assert_eq!(bench.read("taken"), "mine");
}

#[test]
fn a_directory_in_the_way_of_a_result_leaves_no_temporary_file() {
    let bench = bench();
    bench.write("result/calibration.json/mine", "");
    bench.refuses(
        CALIBRATE,
        2,
        &["cannot write result/calibration.json: a directory of this name is in the way"],
    );
}

#[test]
fn a_motion_that_is_not_used_is_told() {
    let bench = Bench::new();
    bench.preset("static-poses", "static.toml", &[]);
    let outcome = bench.run("simulate static.toml --motion absent.csv -o made").done();
    outcome.says("warning: --motion is not used: a [holds] experiment has no motion");
    let outcome = bench.run("calibrate static.toml made/recording.csv --motion absent.csv -o result").done();
    outcome.says("warning: --motion is not used: a [holds] experiment needs no motion");
}
