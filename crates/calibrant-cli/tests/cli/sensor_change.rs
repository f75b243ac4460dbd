//! Tests of a sensor that changes within a recording: every output reports it.

use crate::bench::Bench;

#[test]
fn an_accelerometer_that_changes_is_told_on_the_console_in_the_json_and_in_the_report() {
    let bench = Bench::new();
    bench.stepped_poses();
    for (file, changes) in [("honest/recording.csv", false), ("stepped.csv", true)] {
        let outcome = bench.run(&format!("calibrate poses.toml {file} --folds 4 -o result")).done();
        let message = "the accelerometer changes at about";
        assert_eq!(outcome.stderr.contains(message), changes, "{}", outcome.stderr);
        assert_eq!(
            outcome.printed().contains("but they confirm nothing: the accelerometer"),
            changes,
            "{}",
            outcome.stdout
        );
        assert_eq!(
            outcome.printed().contains("is consistent with the errors"),
            !changes,
            "{}",
            outcome.stdout
        );
        let json = bench.json("result/calibration.json");
        let warnings = json["warnings"].as_array().expect("a list").iter();
        let warned = warnings
            .filter_map(|warning| warning["message"].as_str())
            .any(|warning| warning.contains(message));
        assert_eq!(warned, changes, "{}", json["warnings"]);
        let errors = &json["validation"]["folds"]["magnitude"];
        let verdict = if changes { ("doubtful", "\"sensor-changed\"") } else { ("believed", "null") };
        assert_eq!(
            (errors["verdict"].as_str(), &*errors["caveat"]["code"].to_string()),
            (Some(verdict.0), verdict.1)
        );
        assert_eq!(bench.read("result/report.html").contains(message), changes);
    }
}
