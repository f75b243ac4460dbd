//! Tests of determinism: the same input and seed give the same bytes, whatever the number of threads and the
//! place of the files.

use crate::bench::Bench;
use std::collections::BTreeSet;

#[test]
fn a_calibration_does_not_depend_on_threads_or_folders() {
    for preset in ["report-noisy", "static-poses"] {
        let bench = Bench::new();
        bench.preset(preset, "experiment.toml", &[]);
        bench.run("simulate experiment.toml -o a").done();
        bench.run("simulate experiment.toml -o deep/b").done();
        assert_eq!(bench.read("a/recording.csv"), bench.read("deep/b/recording.csv"));
        assert_eq!(bench.read("a/truth.json"), bench.read("deep/b/truth.json"));
        let motion = if preset == "static-poses" { "" } else { "--motion a/motion.csv" };
        let calibrate = |options: &str| {
            bench.run(&format!("calibrate experiment.toml {motion} {options}")).done();
        };
        calibrate("--threads 1 a/recording.csv -o one");
        calibrate("--threads 2 deep/b/recording.csv -o two");
        bench.run(&format!("simulate experiment.toml --seed 2 {motion} -o other")).done();
        calibrate("--threads 2 other/recording.csv deep/b/recording.csv -o both");
        calibrate("--threads 1 other/recording.csv deep/b/recording.csv -o again");
        let one = bench.read("one/calibration.json");
        assert!(one == bench.read("two/calibration.json"), "{preset}");
        let in_batch = bench.read("both/deep-b/calibration.json");
        assert!(one.replace("\"sensor\": \"recording\"", "\"sensor\": \"deep-b\"") == in_batch, "{preset}");
        assert_eq!(bench.read("both/summary.csv"), bench.read("again/summary.csv"));
        calibrate("--threads 2 a/recording.csv -o one-again");
        let page = bench.read("one/report.html");
        assert!(page == bench.read("one-again/report.html"), "{preset}");
        assert!(assert_ids_differ(&page) > 0, "{preset}");
    }
}

/// No id is twice in a page, and every reference finds its id. The number of references.
fn assert_ids_differ(page: &str) -> usize {
    let after = |begin: &str, end: char| -> Vec<String> {
        let pieces = page.split(begin).skip(1);
        pieces.map(|piece| piece.split(end).next().unwrap_or_default().to_owned()).collect()
    };
    let ids = after(" id=\"", '"');
    let different: BTreeSet<&String> = ids.iter().collect();
    assert_eq!(different.len(), ids.len());
    let referred = after("href=\"#", '"');
    assert!(referred.iter().all(|id| different.contains(id)));
    referred.len()
}

#[test]
fn the_pages_of_an_imu_are_the_same_to_the_byte() {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    bench.run("simulate imu.toml -o a").done();
    bench.run("calibrate imu.toml a/recording.csv --threads 1 -o one").done();
    bench.run("calibrate imu.toml a/recording.csv --threads 2 -o two").done();
    bench.run("noise a/recording.csv --sensor gyroscope --threads 2 -o noise-two").done();
    bench.run("noise a/recording.csv --sensor gyroscope --threads 1 -o noise-one").done();
    for (one, two) in [("one", "two"), ("noise-one", "noise-two")] {
        let page = bench.read(&format!("{one}/report.html"));
        assert!(page == bench.read(&format!("{two}/report.html")), "{one}");
        // the page of noise is short, and has no contents
        assert!(assert_ids_differ(&page) > 0 || one == "noise-one");
    }
}

#[test]
fn a_study_does_not_depend_on_threads() {
    let bench = Bench::new();
    bench.run("study --sensors 3 --starts 2 --threads 1 -o one").done();
    bench.run("study --sensors 3 --starts 2 --threads 2 -o two").done();
    assert!(bench.read("one/study.json") == bench.read("two/study.json"));
    assert!(bench.read("one/report.html") == bench.read("two/report.html"));
    bench.run("study --sensors 3 --starts 2 --seed 2 -o other").done();
    assert!(bench.read("one/study.json") != bench.read("other/study.json"));
}
