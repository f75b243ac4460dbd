//! The same input and seed give the same bytes, whatever the number of threads and the place of the files.

use crate::bench::Bench;

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
        calibrate("--threads 2 a/recording.csv deep/b/recording.csv -o both");
        calibrate("--threads 1 a/recording.csv deep/b/recording.csv -o again");
        let one = bench.read("one/calibration.json");
        for other in ["two", "both/recording", "both/recording-2"] {
            assert!(one == bench.read(&format!("{other}/calibration.json")), "{preset}: {other}");
        }
        assert_eq!(bench.read("both/summary.csv"), bench.read("again/summary.csv"));
    }
}

#[test]
fn a_study_does_not_depend_on_threads() {
    let bench = Bench::new();
    bench.run("study --sensors 3 --starts 2 --threads 1 -o one").done();
    bench.run("study --sensors 3 --starts 2 --threads 2 -o two").done();
    assert!(bench.read("one/study.json") == bench.read("two/study.json"));
    bench.run("study --sensors 3 --starts 2 --seed 2 -o other").done();
    assert!(bench.read("one/study.json") != bench.read("other/study.json"));
}
