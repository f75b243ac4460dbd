//! Tests of broken input at the command line: exit status, message with its place, and nothing written.
//!
//! The tests of the library check the reader's messages word for word; here they must reach the user.

mod experiments;
mod motions;
mod recordings;
mod usage;

use crate::bench::Bench;

/// The command of these tests.
const CALIBRATE: &str = "calibrate experiment.toml recording.csv --motion motion.csv -o result";

/// An experiment with its motion and a good recording, and a static experiment.
fn bench() -> Bench {
    let bench = Bench::new();
    bench.preset("report", "experiment.toml", &[]);
    bench.preset("static-poses", "static.toml", &[]);
    bench.run("simulate experiment.toml -o made").done();
    for name in ["motion.csv", "recording.csv"] {
        bench.write(name, bench.read(&format!("made/{name}")));
    }
    std::fs::remove_dir_all(bench.path("made")).expect("removed");
    bench
}

#[test]
fn what_is_broken_below_is_good_before() {
    bench().run(CALIBRATE).done();
}
