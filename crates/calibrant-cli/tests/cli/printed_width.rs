//! Tests of the width of what is printed where there is no terminal.

use crate::bench::Bench;

/// Commands whose files are made by the ones before.
const COMMANDS: &[&str] = &[
    "init --list",
    "init imu -o imu.toml",
    "init report-noisy -o noisy.toml",
    "init report-unknown -o report-unknown.toml",
    "init static-poses -o poses.toml",
    "init ferraris -o ferraris.toml",
    "init arm -o arm.toml",
    "simulate imu.toml -o imu",
    "simulate imu.toml -o later --seed 2",
    "simulate noisy.toml -o noisy",
    "simulate poses.toml -o poses",
    "inspect imu/recording.csv",
    "calibrate imu.toml imu/recording.csv --no-report --sensor a -o one",
    "calibrate imu.toml later/recording.csv -o two",
    "calibrate imu.toml imu/recording.csv later/recording.csv --no-report -o batch",
    "calibrate noisy.toml noisy/recording.csv --motion noisy/motion.csv --no-report -o of-motion",
    "calibrate poses.toml poses/recording.csv --no-report -o of-poses",
    "design noisy.toml --starts 2 --no-certificate -o best",
    "design poses.toml --starts 2 -o best-poses",
    "apply two/calibration.json imu/recording.csv -o corrected.csv",
    "convert two/calibration.json imu.yaml",
    "convert two/calibration.json calibration.h",
    "convert two/calibration.json calibration.calib --drop-g-sensitivity",
    "compare one/calibration.json two/calibration.json",
    "compare two/calibration.json imu/truth.json",
    "noise imu/recording.csv -o noise",
    "explain",
    "explain spikes not-identifiable",
    "schema",
    "man pages",
    "study --sensors 2 --starts 2 -o study",
    "records add all.db one/calibration.json two/calibration.json",
    "records list all.db",
    "records fleet all.db",
    "records export all.db -o records.csv",
];

#[test]
fn without_a_terminal_nothing_is_wider_than_80_columns() {
    let bench = Bench::new();
    for command in COMMANDS {
        let outcome = bench.run(command).done();
        assert!(!outcome.stdout.is_empty(), "{outcome:?}");
        for line in outcome.stdout.lines() {
            assert!(line.chars().count() <= 80, "{command}: {} columns\n{line}", line.chars().count());
        }
    }
    // the name of a file is never broken
    let long = format!("{}.csv", "a name with blanks ".repeat(6).trim());
    let applied =
        bench.run_with(&["apply", "two/calibration.json", "imu/recording.csv", "-o", long.as_str()]).done();
    assert_eq!(applied.stdout.lines().last(), Some(long.as_str()));
}
