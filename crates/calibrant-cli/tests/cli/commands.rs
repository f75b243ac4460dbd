//! Tests of every command from its start to the files that it writes.

use crate::bench::{Bench, assert_close_to_truth, names};
use serde_json::Value;

/// The parameters of the scale-bias model.
const SCALE_BIAS: [&str; 6] = ["bias.x", "bias.y", "bias.z", "scale.x", "scale.y", "scale.z"];
/// The parameters of the full model in the upper gauge.
const UPPER: [&str; 9] =
    ["bias.x", "bias.y", "bias.z", "scale.x", "scale.y", "scale.z", "matrix.xy", "matrix.xz", "matrix.yz"];

/// The names of these parameters of an accelerometer in `calibration.json`.
fn of_accelerometer(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| format!("accelerometer.{name}")).collect()
}

/// The fields that every `calibration.json` has, in the unit of its readings.
fn assert_calibration_fields(calibration: &Value, expected: &[&str], unit: &str) {
    assert_eq!(names(&calibration["parameters"]), of_accelerometer(expected));
    for parameter in calibration["parameters"].as_array().expect("an array") {
        assert!(parameter["unit"].is_string() && parameter["value"].is_f64() && parameter["sd"].is_f64());
    }
    for matrix in ["covariance", "correlation"] {
        let rows = calibration[matrix].as_array().expect("rows");
        assert_eq!(rows.len(), expected.len(), "{matrix}");
        assert!(rows.iter().all(|row| row.as_array().is_some_and(|row| row.len() == expected.len())));
    }
    let sd = calibration["parameters"][0]["sd"].as_f64().expect("a number");
    let variance = calibration["covariance"][0][0].as_f64().expect("a number");
    assert!((sd * sd / variance - 1.0).abs() < 1e-12);
    let fit = &calibration["fit"];
    assert!(fit["chi2"].is_f64() && fit["degrees_of_freedom"].is_u64() && fit.get("p_value").is_some());
    for field in ["residual_rms", "noise_estimate"] {
        assert_eq!(fit[format!("{field}_{unit}")].as_array().map(Vec::len), Some(3), "{field}: {fit}");
    }
    assert_eq!(calibration["status"], "converged");
    let input = &calibration["inputs"][0];
    assert_eq!(input["sha256"].as_str().map(str::len), Some(64));
    assert!(input["samples"].is_u64() && input["rate_hz"].is_f64());
    assert!(calibration["direction"].as_str().is_some_and(|direction| direction.starts_with("true to raw")));
}

fn assert_report(bench: &Bench, name: &str) {
    let html = bench.read(name);
    assert!(html.starts_with("<!DOCTYPE html>") || html.starts_with("<!doctype html>"), "{name}");
    assert!(html.trim_end().ends_with("</html>"), "{name} is whole");
}

#[test]
fn without_arguments_the_help_is_shown() {
    let outcome = Bench::new().run("");
    assert_eq!((outcome.status, outcome.stdout.as_str()), (2, ""));
    for word in ["Usage: calibrant", "init", "simulate", "calibrate", "study", "--threads"] {
        outcome.says(word);
    }
    let version = Bench::new().run("--version").done().stdout;
    assert_eq!(version, format!("calibrant {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn motion_presets_go_from_init_to_calibration() {
    for (preset, intervals) in [("report", 10), ("report-noisy", 10), ("report-unknown", 14)] {
        let bench = Bench::new();
        let written = bench.run(&format!("init {preset} -o experiment.toml")).done();
        assert!(written.printed().contains("wrote experiment.toml"), "{}", written.stdout);
        let outcome = bench.run("simulate experiment.toml --seed 3 -o simulated").done();
        assert!(outcome.printed().contains("seed 3: simulated/recording.csv"), "{outcome:?}");
        assert_eq!(bench.path("simulated/true_motion.csv").exists(), preset == "report-noisy");
        let command =
            "calibrate experiment.toml simulated/recording.csv --motion simulated/motion.csv -o result";
        let outcome = bench.run(command).done();
        assert_eq!(outcome.stderr, "", "{preset}");
        for word in SCALE_BIAS.iter().chain(&["estimate ± sd", "converged", "result/report.html"]) {
            assert!(outcome.printed().contains(word), "{preset}: {word}\n{}", outcome.stdout);
        }
        let calibration = bench.json("result/calibration.json");
        assert_calibration_fields(&calibration, &SCALE_BIAS, "mps2");
        let motion = &calibration["motion"];
        for (field, length) in [
            ("times_s", intervals + 1),
            ("acceleration_mps2", intervals + 1),
            ("jerk_mps3", intervals),
            ("velocity_mps", intervals + 1),
            ("displacement_m", intervals + 1),
        ] {
            assert_eq!(motion[field].as_array().map(Vec::len), Some(length), "{preset}: {field}");
        }
        assert!(calibration.get("holds").is_none());
        assert_close_to_truth(&calibration, &bench.json("simulated/truth.json"));
        assert_report(&bench, "result/report.html");
    }
}

#[test]
fn one_axis_has_one_column() {
    let bench = Bench::new();
    bench.preset("report", "experiment.toml", &[("axes = 3", "axes = 1")]);
    bench.run("simulate experiment.toml -o simulated").done();
    assert!(bench.read("simulated/recording.csv").starts_with("t_s,ax_mps2\n"));
    bench
        .run("calibrate experiment.toml simulated/recording.csv --motion simulated/motion.csv -o result")
        .done();
    let calibration = bench.json("result/calibration.json");
    assert_eq!(names(&calibration["parameters"]), of_accelerometer(&["bias.x", "scale.x"]));
    assert_close_to_truth(&calibration, &bench.json("simulated/truth.json"));
}

#[test]
fn static_poses_go_from_init_to_calibration() {
    let bench = Bench::new();
    bench.run("init static-poses -o experiment.toml").done();
    bench.run("simulate experiment.toml -o simulated").done();
    let outcome = bench.run("calibrate experiment.toml simulated/recording.csv -o result").done();
    assert!(outcome.printed().contains("from 24 of 24 holds"), "{}", outcome.stdout);
    let calibration = bench.json("result/calibration.json");
    assert_calibration_fields(&calibration, &UPPER, "mps2");
    assert_eq!(calibration["gauge"], "upper");
    assert_eq!(calibration["holds"]["table"].as_array().map(Vec::len), Some(24));
    assert!(calibration.get("motion").is_none());
    assert_close_to_truth(&calibration, &bench.json("simulated/truth.json"));
    assert_report(&bench, "result/report.html");
}

#[test]
fn static_poses_in_counts_are_simulated_once_gain_and_noise_are_given() {
    let bench = Bench::new();
    bench.run("init static-poses-counts -o experiment.toml").done();
    let says = "experiment.toml: `sensor.gain_counts_per_mps2`: a simulation needs `gain_counts_per_mps2`";
    bench.refuses("simulate experiment.toml -o simulated", 2, &[says]);
    bench.preset(
        "static-poses-counts",
        "complete.toml",
        &[
            ("# gain_counts", "gain_counts"),
            ("# offset_counts", "offset_counts"),
            ("# noise_counts", "noise_counts"),
        ],
    );
    bench.run("simulate complete.toml -o simulated").done();
    assert!(bench.read("simulated/recording.csv").starts_with("t_s,ax_counts,ay_counts,az_counts\n"));
    // the gain need not be known
    bench.run("calibrate experiment.toml simulated/recording.csv -o result").done();
    let calibration = bench.json("result/calibration.json");
    assert_calibration_fields(&calibration, &UPPER, "counts");
    assert_eq!(calibration["parameters"][3]["unit"], "counts/(m/s²)");
    assert_close_to_truth(&calibration, &bench.json("simulated/truth.json"));
}

#[test]
fn init_prints_a_preset_or_keeps_the_file_that_is_there() {
    let bench = Bench::new();
    let preset = bench.run("init").done().stdout;
    assert!(preset.contains("schema = 1"));
    assert_eq!(preset, bench.run("init report").done().stdout);
    bench.write("mine.toml", "mine");
    bench.refuses("init -o mine.toml", 2, &["mine.toml: this file is there already", "--force"]);
    assert_eq!(bench.read("mine.toml"), "mine");
    bench.run("init -o mine.toml --force").done();
    assert_eq!(bench.read("mine.toml"), preset);
    bench.run("init -o new/folder/file.toml").done();
    assert_eq!(bench.read("new/folder/file.toml"), preset);
}

#[test]
fn the_study_of_the_report_needs_no_file() {
    let bench = Bench::new();
    let outcome = bench.run("study --sensors 2 --starts 2 -o study").done();
    assert_eq!(outcome.stderr, "");
    for text in [
        "2 sensors, trust unknown, 14 intervals, 2 Hz, seed 1",
        "2 sensors, trust known, initial against optimal motion, 10 intervals, 10 Hz, seed 1",
        "2 sensors, trust noisy, initial against optimal motion",
        "scale.z",
        "study/report.html",
    ] {
        assert!(outcome.printed().contains(text), "{text}\n{}", outcome.stdout);
    }
    let study = bench.json("study/study.json");
    let unknown = &study["calibration"];
    assert!((unknown["fine"]["rate_hz"].as_f64().expect("a number") - 10.0).abs() < 1e-9);
    assert_eq!(study["surface"]["log10_trace"].as_array().map(Vec::len), Some(41));
    assert_eq!(study["surface"]["log10_trace"][20][20], Value::Null);
    for part in ["calibration", "design", "noisy"] {
        assert_eq!(study[part]["sensors"].as_array().map(Vec::len), Some(2), "{part}");
        assert_eq!(names(&study[part]["parameters"]), SCALE_BIAS, "{part}");
    }
    assert_eq!(names(&unknown["summary"]), SCALE_BIAS);
    assert_eq!(study["noisy"]["input_noise"]["ratio"], 0.01);
    assert_eq!(study["noisy"]["limits"]["jerk_mps3"][0], 20.0);
    for part in ["design", "noisy"] {
        let scale = &study[part]["summary"][3];
        assert_eq!(scale["optimal"]["name"], "scale.x");
        assert!(scale["predicted"]["value"].as_f64().is_some_and(|factor| factor > 1.0), "{scale}");
        assert!(scale["realised"]["standard_error"].is_number(), "{scale}");
    }
    assert_report(&bench, "study/report.html");
}

#[test]
fn a_study_follows_its_experiment_and_its_motion() {
    let bench = Bench::new();
    bench.preset("report", "whole.toml", &[("sensors = 30", "sensors = 3")]);
    let whole = bench.read("whole.toml");
    let alone = &whole[..whole.find("[study.surface]").expect("there")];
    bench.write("experiment.toml", alone);
    bench.run("simulate experiment.toml -o simulated").done();
    bench.run("study experiment.toml --motion simulated/motion.csv --seed 4 --starts 2 -o study").done();
    let study = bench.json("study/study.json");
    for absent in ["calibration", "surface", "noisy"] {
        assert_eq!(study[absent], Value::Null, "{absent}");
    }
    let design = &study["design"];
    assert_eq!((&design["seed"], &design["trust"]), (&4.into(), &"known".into()));
    assert_eq!((&design["starts"], &design["initial_given"]), (&2.into(), &true.into()));
    assert_eq!(design["sensors"].as_array().map(Vec::len), Some(3));
    let motion = bench.read("simulated/motion.csv");
    let node = motion.lines().nth(1).and_then(|line| line.strip_prefix("0.0,")).expect("the first node");
    assert!(bench.read("study/study.json").contains(&format!("[{}]", node.replace(',', ", "))), "{node}");
    bench.write("fast.csv", "t_s,ax_mps2,ay_mps2,az_mps2\n0,40,1,1\n5,-40,-1,-1\n10,40,2,3\n");
    let outcome = bench.run("study experiment.toml --motion fast.csv --starts 2 -o fast").done();
    outcome.says("note: the given motion breaks limits that the optimal one keeps: intercept of axis x");
}

#[test]
fn a_study_without_a_design_says_why() {
    let bench = Bench::new();
    bench.preset("report-unknown", "unknown.toml", &[]);
    let outcome = bench.run("study unknown.toml --sensors 2 -o unknown").done();
    assert_eq!(
        outcome.stderr,
        "note: no motion was designed: nothing is known of the motion but its ends, so none can be commanded [motion-not-designed]\n"
    );
    bench.write(
        "free.toml",
        bench.run("init report-noisy").done().stdout.replace("acceleration_mps2 = 20.0", ""),
    );
    let outcome = bench.run("study free.toml --sensors 2 -o free").done();
    assert!(outcome.stderr.contains("nothing bounds the acceleration of axis x"), "{}", outcome.stderr);
    for study in ["unknown", "free"] {
        let json = bench.json(&format!("{study}/study.json"));
        assert_eq!((&json["design"], &json["noisy"]), (&Value::Null, &Value::Null));
        assert_eq!(json["calibration"]["sensors"].as_array().map(Vec::len), Some(2));
        assert_eq!(json["notes"].as_array().map(Vec::len), Some(1));
        assert_report(&bench, &format!("{study}/report.html"));
    }
}

#[test]
fn json_on_stdout_is_the_file_and_nothing_else() {
    let bench = Bench::new();
    bench.preset("report", "experiment.toml", &[]);
    bench.run("simulate experiment.toml -o a").done();
    bench.run("simulate experiment.toml --seed 2 -o b").done();
    let calibrate = "calibrate experiment.toml --motion a/motion.csv --json";
    let outcome = bench.run(&format!("{calibrate} a/recording.csv -o one")).done();
    assert_eq!(outcome.stdout, bench.read("one/calibration.json"));
    let outcome = bench.run("study --sensors 2 --starts 1 --json -o study").done();
    assert_eq!(outcome.stdout, bench.read("study/study.json"));
    let outcome = bench.run(&format!("{calibrate} a/recording.csv b/recording.csv -o two")).ends_with(5);
    let list = outcome.list("batch");
    assert_eq!(list.as_array().map(Vec::len), Some(2));
    for (k, (file, folder)) in [("a", "a"), ("b", "b")].into_iter().enumerate() {
        assert_eq!(list[k]["file"], format!("{file}/recording.csv"));
        assert_eq!(list[k]["calibration"], bench.json(&format!("two/{folder}/calibration.json")));
    }
}

#[test]
fn the_unit_is_the_option_where_the_header_does_not_say() {
    let bench = Bench::new();
    bench.preset("static-poses", "experiment.toml", &[]);
    bench.run("simulate experiment.toml -o simulated").done();
    let plain = bench.read("simulated/recording.csv").replace("_mps2", "");
    bench.write("plain.csv", plain);
    bench.run("calibrate experiment.toml plain.csv -o result").done();
    bench.run("calibrate experiment.toml plain.csv --unit mps2 -o named").done();
    assert_eq!(bench.read("result/calibration.json"), bench.read("named/calibration.json"));
    let in_g = |line: &str| match line.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>() {
        Ok(values) => {
            let [t, a @ ..] = values.as_slice() else { panic!("{line}") };
            let a: Vec<_> = a.iter().map(|a| (a / 9.806_65).to_string()).collect();
            format!("{t},{}\n", a.join(","))
        }
        Err(_) => format!("{line}\n"),
    };
    bench.write("g.csv", bench.read("plain.csv").lines().map(in_g).collect::<String>());
    bench.run("calibrate experiment.toml g.csv --unit g -o g").done();
    let bias = |of: &str| bench.json(&format!("{of}/calibration.json"))["parameters"][0]["value"].as_f64();
    let [of_g, of_mps2] = [bias("g"), bias("result")].map(|bias| bias.expect("a number"));
    assert!((of_g - of_mps2).abs() < 1e-9, "{of_g} {of_mps2}");
    bench.refuses(
        "calibrate experiment.toml plain.csv --unit g --accelerometer-unit mg -o refused",
        2,
        &["--unit is g, but the accelerometer's unit is given as mg"],
    );
    bench.refuses(
        "calibrate experiment.toml plain.csv --unit counts -o refused",
        3,
        &["plain.csv: the recording is in counts, the sensor's readings in m/s²"],
    );
    bench.refuses(
        "calibrate experiment.toml simulated/recording.csv --unit counts -o refused",
        3,
        &["simulated/recording.csv:1: the accelerometer's columns are in m/s², but the unit was given as counts"],
    );
}

#[test]
fn standard_output_that_cannot_be_written_is_an_error() {
    let bench = Bench::new();
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full");
    let Ok(full) = full else { return }; // only some systems have it
    let status = std::process::Command::new(env!("CARGO_BIN_EXE_calibrant"))
        .args(["init", "report"])
        .current_dir(bench.path("."))
        .stdout(full)
        .status()
        .expect("started");
    assert_eq!(status.code(), Some(2));
}
