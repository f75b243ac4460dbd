//! Tests of several recordings in one call: none stops the others, none overwrites another.

use crate::bench::Bench;

/// An experiment, its motion, and recordings of one sensor for each name.
fn bench(recordings: &[&str]) -> Bench {
    let bench = Bench::new();
    bench.preset("report", "experiment.toml", &[]);
    bench.run("simulate experiment.toml -o simulated").done();
    for (seed, name) in recordings.iter().enumerate() {
        // the motion of the first seed, the sensor of another
        let seed = seed + 1;
        bench
            .run(&format!("simulate experiment.toml --motion simulated/motion.csv --seed {seed} -o made"))
            .done();
        bench.write(name, bench.read("made/recording.csv"));
    }
    bench
}

/// The command of these tests, without its recordings.
const CALIBRATE: &str = "calibrate experiment.toml --motion simulated/motion.csv";

#[test]
fn one_bad_recording_does_not_stop_the_others() {
    let bench = bench(&["a.csv", "b.csv", "c.csv"]);
    let cut: String = bench.read("b.csv").replace("\n0.3,", "\n0.3,oops,");
    bench.write("b.csv", cut);
    let outcome = bench.run(&format!("{CALIBRATE} a.csv b.csv c.csv missing.csv -o result"));
    assert_eq!(outcome.status, 3, "{outcome:?}");
    outcome.says("b.csv:5:5: \"oops\" in column `ax_mps2` is not a number");
    outcome.says("missing.csv: cannot read the recording");
    assert!(outcome.printed().contains("2 calibrated, 2 failed: result/summary.csv"), "{outcome:?}");
    for (folder, there) in [("a", true), ("b", false), ("c", true), ("missing", false)] {
        assert_eq!(bench.path(&format!("result/{folder}/calibration.json")).is_file(), there, "{folder}");
        assert_eq!(bench.path(&format!("result/{folder}")).is_dir(), there, "{folder}");
    }
    let summary = bench.read("result/summary.csv");
    let rows: Vec<&str> = summary.lines().collect();
    assert!(
        rows[0].starts_with(
            "file,recording,verdict,codes,status,error,code,limits_failed,worst_sd_parameter,worst_sd_ratio,worst_sd_relative_to,warnings,chi2,degrees_of_freedom,p_value,accelerometer.bias.x_mps2,accelerometer.bias.x_sd_mps2,"
        ),
        "{summary}"
    );
    assert!(rows[0].ends_with(",accelerometer.scale.z,accelerometer.scale.z_sd"), "{summary}");
    let starts = [
        "a,a.csv,ok,,converged,,,,",
        "b,b.csv,none,,error,\"b.csv:5:5: \"\"oops\"\" in column",
        "c,c.csv,ok,,converged,,,,",
        "missing,missing.csv,none,,error,",
    ];
    assert_eq!(rows.len(), 1 + starts.len(), "{summary}");
    for (row, start) in rows[1..].iter().zip(starts) {
        assert!(row.starts_with(start), "{row}");
    }
    let values: Vec<&str> = rows[3].split(',').skip(15).collect();
    let calibration = bench.read("result/c/calibration.json");
    assert_eq!(values.len(), 12, "{summary}");
    for (pair, field) in values.chunks(2).flat_map(|pair| [(pair[0], "value"), (pair[1], "sd")]) {
        assert!(calibration.contains(&format!("\"{field}\": {pair},")), "{field} {pair}");
    }
}

#[test]
fn the_worst_exit_status_counts_and_the_undetermined_one_is_named() {
    let bench = bench(&["a.csv"]);
    let short: String = bench.read("a.csv").lines().take(3).map(|line| format!("{line}\n")).collect();
    bench.write("short.csv", short.replace("\n0.1,", "\n99,"));
    bench.write("broken.csv", "");
    let outcome = bench.run(&format!("{CALIBRATE} a.csv short.csv broken.csv -o result"));
    assert_eq!(outcome.status, 4, "{outcome:?}");
    outcome.says("error: short.csv: the data cannot determine the parameters; accelerometer.bias.x and accelerometer.scale.x");
    outcome.says("error: broken.csv: the file is empty");
    let summary = bench.read("result/summary.csv");
    assert!(
        summary.contains(
            "\nshort,short.csv,none,,error,the data cannot determine the parameters; accelerometer.bias.x"
        ),
        "{summary}"
    );
}

#[test]
fn files_of_one_name_do_not_collide() {
    let bench = bench(&["one/rec.csv", "two/rec.csv", "rec-2.csv", "three/rec.txt"]);
    let command = format!("{CALIBRATE} one/rec.csv two/rec.csv rec-2.csv three/rec.txt -o result");
    bench.run(&command).done();
    let value = |folder: &str| {
        let calibration = bench.json(&format!("result/{folder}/calibration.json"));
        (calibration["inputs"][0]["file"].to_string(), calibration["inputs"][0]["sha256"].to_string())
    };
    let (one, two, dash, three) = (value("one-rec"), value("two-rec"), value("rec-2"), value("three-rec"));
    assert_eq!((one.0.as_str(), two.0.as_str()), ("\"rec.csv\"", "\"rec.csv\""));
    assert_eq!((dash.0.as_str(), three.0.as_str()), ("\"rec-2.csv\"", "\"rec.txt\""));
    let mut sums = [one.1, two.1, dash.1, three.1];
    sums.sort();
    assert!(sums.windows(2).all(|pair| pair[0] != pair[1]), "four recordings");
    let summary = bench.read("result/summary.csv");
    let files: Vec<_> =
        summary.lines().skip(1).map(|row| row.split(',').take(2).collect::<Vec<_>>().join(" ")).collect();
    assert_eq!(
        files,
        ["one-rec one/rec.csv", "two-rec two/rec.csv", "rec-2 rec-2.csv", "three-rec three/rec.txt"]
    );
}

#[test]
fn folders_name_the_sensors_whose_files_have_one_name() {
    let bench = bench(&["line/S1/rec.csv", "line/S2/rec.csv"]);
    let short: String =
        bench.read("line/S1/rec.csv").lines().take(3).map(|line| format!("{line}\n")).collect();
    bench.write("line/S3/rec.csv", short.replace("\n0.1,", "\n99,"));
    let outcome = bench.run(&format!("{CALIBRATE} line/S1/rec.csv line/S2/rec.csv line/S3/rec.csv -o out"));
    assert!(!outcome.stderr.contains("the name is taken") && outcome.stdout.contains("  S1 "), "{outcome:?}");
    assert_eq!(bench.json("out/S2/calibration.json")["sensor"], "S2");
    let summary = bench.read("out/summary.csv");
    assert!(summary.contains("\nS3,line/S3/rec.csv,none,"), "{summary}");
    // the page about the one that failed
    assert!(bench.read("out/S3/report.html").contains("✗ Not calibrated:"));
    let page = bench.read("out/batch.html");
    assert!(page.contains("<a href=\"S3/report.html\">S3</a>") && page.contains("<a href=\"summary.csv\">"));
}

#[test]
fn what_is_left_of_an_earlier_run_is_told() {
    let bench = bench(&["a.csv", "b.csv"]);
    bench.run(&format!("{CALIBRATE} a.csv b.csv -o result")).done();
    bench.write("a.csv", String::new());
    let message = "a/calibration.json is that of an earlier run";
    for command in ["a.csv b.csv -o result", "a.csv -o result/a"] {
        bench.run(&format!("{CALIBRATE} {command}")).says(&format!("warning: result/{message}"));
    }
}

#[test]
fn a_result_takes_the_place_of_no_recording() {
    let bench = bench(&["summary.csv", "a.csv", "a/calibration.json", "b.csv"]);
    for (command, file) in [
        ("summary.csv a.csv -o .", "summary.csv"),
        ("a.csv a/calibration.json b.csv -o .", "a/calibration.json"),
        ("a/calibration.json -o a", "a/calibration.json"),
    ] {
        let before = bench.read(file);
        bench.refuses(
            &format!("{CALIBRATE} {command}"),
            2,
            &[file, "this file is read, and would be replaced"],
        );
        assert_eq!(bench.read(file), before, "{command}");
    }
    assert!(!bench.path("b").exists(), "nothing is written before");
}

#[test]
fn no_name_of_a_recording_leads_out_of_its_subfolder() {
    let bench = bench(&["...csv", "..csv", "summary.csv.txt", "Rec.csv", "rec.csv"]);
    let before = bench.files();
    bench.run(&format!("{CALIBRATE} ...csv ..csv summary.csv.txt Rec.csv rec.csv -o result")).done();
    let new: Vec<String> = bench.files().difference(&before).cloned().collect();
    assert!(new.iter().all(|file| file.starts_with("result")), "{new:?}");
    assert_eq!(new.iter().filter(|file| file.ends_with("/calibration.json")).count(), 5, "{new:?}");
    assert!(!new.iter().any(|file| file == "result/calibration.json"), "{new:?}");
    let folders: Vec<String> =
        new.iter().filter_map(|file| Some(file.strip_suffix("/report.html")?.to_lowercase())).collect();
    let distinct: std::collections::BTreeSet<_> = folders.iter().collect();
    assert_eq!(distinct.len(), 5, "also where capitals do not tell names apart: {folders:?}");
    assert!(bench.path("result/summary.csv").is_file());
}

#[test]
fn the_motion_is_no_recording() {
    // `*.csv` catches motion.csv as well
    let bench = Bench::new();
    bench.preset("report", "experiment.toml", &[]);
    bench.run("simulate experiment.toml -o simulated").done();
    bench.refuses(
        "calibrate experiment.toml simulated/recording.csv simulated/motion.csv --motion simulated/motion.csv -o result",
        2,
        &["simulated/motion.csv is both the motion and a recording", "leave it out of the recordings"],
    );
}

/// Three IMUs of one kind, and a broken file.
fn imus() -> Bench {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    for seed in 1..=3 {
        bench.run(&format!("simulate imu.toml --seed {seed} -o made{seed}")).done();
        bench.write(&format!("imu{seed}.csv"), bench.read(&format!("made{seed}/recording.csv")));
    }
    bench
}

#[test]
fn every_imu_is_calibrated_as_if_it_were_alone() {
    let bench = imus();
    bench.write("broken.csv", "t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps\n0,1,2,oops,4,5,6\n");
    let outcome = bench.run("calibrate imu.toml imu1.csv broken.csv imu2.csv imu3.csv -o all");
    assert_eq!(outcome.status, 3, "{outcome:?}");
    outcome.says("broken.csv:2:");
    assert!(outcome.printed().contains("3 calibrated, 1 failed: all/summary.csv"), "{outcome:?}");
    let summary = bench.read("all/summary.csv");
    let rows: Vec<Vec<&str>> = summary.lines().map(|row| row.split(',').collect()).collect();
    assert_eq!(
        rows[0][..8],
        ["file", "recording", "verdict", "codes", "status", "error", "code", "limits_failed"],
        "{summary}"
    );
    assert_eq!(rows[2][..5], ["broken", "broken.csv", "none", "", "error"], "{summary}");
    let column = |name: &str| rows[0].iter().position(|column| *column == name).expect(name);
    for (row, seed) in [(1, 1), (3, 2), (4, 3)] {
        bench.run(&format!("calibrate imu.toml imu{seed}.csv -o alone{seed}")).done();
        let file = |directory: &str| bench.read(&format!("{directory}/calibration.json"));
        assert_eq!(file(&format!("all/imu{seed}")), file(&format!("alone{seed}")));
        let calibration = bench.json(&format!("all/imu{seed}/calibration.json"));
        for parameter in calibration["parameters"].as_array().expect("parameters") {
            let ending = match parameter["unit"].as_str().expect("a unit") {
                "m/s²" => "_mps2",
                "rad/s" => "_radps",
                "(rad/s)/(m/s²)" => "_radps_per_mps2",
                "1" => "",
                unit => panic!("{unit}"),
            };
            let name = parameter["name"].as_str().expect("a name");
            let field =
                |column_name: String| rows[row][column(&column_name)].parse::<f64>().expect("a number");
            assert_eq!(Some(field(format!("{name}{ending}"))), parameter["value"].as_f64());
            assert_eq!(Some(field(format!("{name}_sd{ending}"))), parameter["sd"].as_f64());
        }
    }
    let printed = bench.run("calibrate imu.toml imu1.csv broken.csv absent\\\".csv imu2.csv --json -o json");
    let printed = printed.ends_with(3).list("batch");
    let files: Vec<&str> = (0..4).filter_map(|k| printed[k]["file"].as_str()).collect();
    assert_eq!(files, ["imu1.csv", "broken.csv", "absent\\\".csv", "imu2.csv"]);
    assert_eq!(printed[3]["calibration"], bench.json("json/imu2/calibration.json"));
    assert!(printed[3].get("error").is_none() && printed[1].get("calibration").is_none(), "{printed}");
    let error = printed[1]["error"].as_str().expect("a text");
    assert!(error.starts_with("broken.csv:2:7: \"oops\" in column `az_mps2` is not a number"), "{error}");
}

#[test]
fn gyroscopes_with_files_of_their_own_go_with_their_accelerometers() {
    let bench = imus();
    for seed in 1..=2 {
        let text = bench.read(&format!("imu{seed}.csv"));
        for (name, columns) in [("acc", 1..4), ("gyro", 4..7)] {
            let row = |line: &str| {
                let fields: Vec<&str> = line.split(',').collect();
                format!("{},{}\n", fields[0], fields[columns.clone()].join(","))
            };
            bench.write(&format!("{name}{seed}.csv"), text.lines().map(row).collect::<String>());
        }
    }
    let command = "calibrate imu.toml acc1.csv acc2.csv --gyroscope gyro1.csv";
    bench.run(&format!("{command} --gyroscope gyro2.csv -o out")).done();
    for seed in 1..=2 {
        bench.run(&format!("calibrate imu.toml imu{seed}.csv -o whole{seed}")).done();
        let of = |directory: String| bench.json(&format!("{directory}/calibration.json"));
        let (split, whole) = (of(format!("out/acc{seed}")), of(format!("whole{seed}")));
        assert_eq!(split["inputs"][1]["file"], format!("gyro{seed}.csv"));
        assert_eq!(split["parameters"], whole["parameters"]);
    }
    bench
        .run(&format!("{command} --gyroscope gyro1.csv -o repeated"))
        .ends_with(3)
        .says("gyro1.csv: this file is given twice");
    bench.refuses(
        &format!("{command} -o out"),
        2,
        &["1 file of gyroscopes for 2 recordings", "give --gyroscope FILE once for each recording"],
    );
    bench.refuses(
        "calibrate imu.toml imu1.csv imu2.csv --folds 3 -o out",
        2,
        &["one calibration is validated at a time"],
    );
}
