//! A whole IMU: simulated, calibrated, and held against its truth.

use crate::bench::{Bench, assert_close_to_truth, names};
use serde_json::Value;

#[test]
fn a_simulated_imu_is_found_again_and_its_noise_in_a_long_hold() {
    let bench = Bench::new();
    let long = "minimum_hold_s = 1.0         # shortest";
    bench.preset("imu", "imu.toml", &[(long, &format!("poses = 14\nhold_s = 25.0\nrate_hz = 50.0\n{long}"))]);
    bench.run("simulate imu.toml --seed 8 -o sim").done();
    let outcome = bench.run("calibrate imu.toml sim/recording.csv -o out").done();
    assert!(outcome.stdout.contains("rad/s, from: Allan deviation of hold "), "{}", outcome.stdout);
    let calibration = bench.json("out/calibration.json");
    assert_close_to_truth(&calibration, &bench.json("sim/truth.json"));
    let noise = calibration["still_gyroscope"]["noise_per_sample_radps"].as_array().expect("axes").clone();
    // 1200 samples give the white noise to 4 % at best
    assert!(noise.iter().all(|sd| (sd.as_f64().expect("a number") / 2e-3 - 1.0).abs() < 0.15), "{noise:?}");
    // given noise counts
    let given = bench.read("imu.toml").replacen("# noise_radps = 2e-3 ", "noise_radps = 2e-3 ", 1);
    bench.write("given.toml", given);
    let outcome = bench.run("calibrate given.toml sim/recording.csv -o given").done();
    assert!(
        outcome.stdout.contains("0.00200, 0.00200, 0.00200 rad/s, from: datasheet"),
        "{}",
        outcome.stdout
    );
}

#[test]
fn counts_are_simulated_with_gains_alone_and_turns_do_not_overlap() {
    let bench = Bench::new();
    bench.preset("imu-counts", "counts.toml", &[]);
    bench.refuses(
        "simulate counts.toml -o sim",
        2,
        &["a simulation of counts needs `sensor.gain_counts_per_mps2`"],
    );
    let gains = bench
        .read("counts.toml")
        .replacen(
            "unit = \"counts\" ",
            "gain_counts_per_mps2 = 415.0\noffset_counts = 32768.0\nunit = \"counts\" ",
            1,
        )
        .replacen("# gain_counts_per_radps", "gain_counts_per_radps", 1);
    bench.write("gains.toml", gains);
    bench.run("simulate gains.toml --seed 4 -o sim").done();
    assert!(bench.read("sim/recording.csv").starts_with("t_s,ax_counts,ay_counts,az_counts,gx_counts,"));
    bench.run("calibrate gains.toml sim/recording.csv -o out").done();
    assert_close_to_truth(&bench.json("out/calibration.json"), &bench.json("sim/truth.json"));

    let table = include_str!("../../../../examples/06_whole_imu/table.toml");
    bench.write("table.toml", table.replacen("start_s = 7.0", "start_s = 5.0", 1));
    bench.refuses(
        "simulate table.toml -o table",
        2,
        &["begins at 5 s begins before what is done until 6 s is over"],
    );
}

/// Far from what is drawn without: 0.1 m/s² around 0, 0.02 rad/s around 0, 1 % around 1.
#[test]
fn what_the_experiment_knows_is_true_of_the_simulated_imu() {
    let bench = Bench::new();
    let known = r#"[known]
"gyroscope.bias.x" = 0.25
"gyroscope.scale.y" = { value = 1.3, sd = 1e-3 }
"accelerometer.bias.z" = { value = 3.0, sd = 0.01 }"#;
    bench.preset("imu", "hand.toml", &[("[known] ", &format!("{known} "))]);
    let table = include_str!("../../../../examples/06_whole_imu/table.toml");
    bench.write("table.toml", format!("{table}\n{known}\n"));
    for name in ["hand", "table"] {
        bench.run(&format!("simulate {name}.toml --seed 5 -o {name}")).done();
        bench.run(&format!("calibrate {name}.toml {name}/recording.csv -o {name}/out")).done();
        let (truth, found) =
            (bench.json(&format!("{name}/truth.json")), bench.json(&format!("{name}/out/calibration.json")));
        let of = |file: &Value, parameter: &str, field: &str| -> Option<f64> {
            let list = file["parameters"].as_array().expect("an array");
            list.iter().find(|entry| entry["name"] == parameter)?[field].as_f64()
        };
        let truth_of = |parameter: &str| of(&truth, parameter, "value").expect("drawn");
        assert!((truth_of("gyroscope.bias.x") - 0.25).abs() < 1e-15);
        for (parameter, value, sd) in [("gyroscope.scale.y", 1.3, 1e-3), ("accelerometer.bias.z", 3.0, 0.01)]
        {
            let error = (truth_of(parameter) - value) / sd;
            assert!(error != 0.0 && error.abs() < 4.0, "{name}: {parameter} {error}");
        }
        let all: Vec<&str> = names(&truth["parameters"]);
        assert_eq!(names(&found["parameters"]).len() + 1, all.len(), "one is fixed");
        for parameter in all.into_iter().filter(|parameter| *parameter != "gyroscope.bias.x") {
            let (value, sd) = (of(&found, parameter, "value"), of(&found, parameter, "sd"));
            let (value, sd) = (value.expect("estimated"), sd.expect("estimated"));
            assert!((value - truth_of(parameter)).abs() < 5.0 * sd, "{name}: {parameter} {value} ± {sd}");
        }
    }
}

#[test]
fn without_a_report_the_calibration_is_the_same() {
    let bench = Bench::new();
    for (preset, recording) in [("imu", "imu/recording.csv"), ("static-poses", "static-poses/recording.csv")]
    {
        let file = format!("{preset}.toml");
        bench.preset(preset, &file, &[]);
        bench.run(&format!("simulate {file} --seed 3 -o {preset}")).done();
        bench.run(&format!("calibrate {file} {recording} -o {preset}/with")).done();
        let outcome =
            bench.run(&format!("calibrate {file} {recording} --no-report -o {preset}/without")).done();
        assert!(outcome.stdout.trim_end().ends_with("calibration.json"), "{}", outcome.stdout);
        assert!(!bench.path(&format!("{preset}/without/report.html")).exists());
        let read = |of: &str| bench.read(&format!("{preset}/{of}/calibration.json"));
        assert_eq!(read("with"), read("without"));
        let outcome = bench.run(&format!("calibrate {file} {recording} --no-report -o {preset}/with")).done();
        assert!(
            outcome.stderr.contains("report.html is that of an earlier calibration"),
            "{}",
            outcome.stderr
        );
    }
}
