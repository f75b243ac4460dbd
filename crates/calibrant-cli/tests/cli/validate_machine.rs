//! `calibrate --folds` and `--validate` on a machine: good recordings are believed, wrong models are not.

use crate::bench::Bench;

/// Less time than the preset asks for.
const SHORT: (&str, &str) = ("duration_s = 60.0", "duration_s = 20.0");

/// The verdict on the accelerometer by blocks or on another recording.
fn verdict(bench: &Bench, source: &str) -> String {
    let validation = &bench.json("out/calibration.json")["validation"][source];
    validation["parameters"]["accelerometer"]["verdict"].as_str().expect("a verdict").to_owned()
}

/// Two recordings of one sensor on one arm.
fn recorded() -> Bench {
    let bench = Bench::new();
    bench.preset("arm", "arm.toml", &[SHORT]);
    bench.run("simulate arm.toml --seed 3 -o one").done();
    bench.run("simulate arm.toml --seed 3 --recording 2 -o two").done();
    bench
}

#[test]
fn good_recordings_are_believed() {
    let bench = recorded();
    let command = "calibrate arm.toml one/recording.csv --motion one/joints.csv --folds 4 \
        --validate two/recording.csv --validate-motion two/joints.csv -o out";
    let outcome = bench.run(command).done();
    for words in [
        "4 blocks of 5.00 s, each left out in turn",
        "On recording.csv",
        "The parameters of the accelerometer move as far as their covariance predicts.",
    ] {
        assert!(outcome.printed().contains(words), "{words}\n{}", outcome.stdout);
    }
    assert_eq!([verdict(&bench, "folds"), verdict(&bench, "recording")], ["believed", "believed"]);
    assert_eq!(bench.json("out/calibration.json")["validation"]["recording"]["file"], "recording.csv");
    assert!(bench.read("out/report.html").contains("4 blocks of 5.00 s, each left out in turn"));
}

#[test]
fn a_lever_arm_that_is_wrong_and_held_is_found() {
    let bench = recorded();
    let wrong = bench.read("arm.toml").replace("lever_m = [0.0, 0.0, 0.0]", "lever_m = [0.02, 0.0, 0.0]");
    bench.write("wrong.toml", wrong.replace("lever_sd_m = 0.002", "lever_sd_m = 0.0"));
    let command = "calibrate wrong.toml one/recording.csv --motion one/joints.csv --folds 4 -o out";
    let outcome = bench.run(command).ends_with(5);
    // the residuals show it; the standard deviations are as wide as the blocks move
    assert!(outcome.printed().contains("verdict: bad (model-contradicted)"), "{}", outcome.stdout);
    assert_eq!(verdict(&bench, "folds"), "believed");
}
