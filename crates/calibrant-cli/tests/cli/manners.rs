//! Tests of what a command must not do: replace what it reads or what others wrote, hide an earlier run.

use crate::bench::Bench;

/// Poses, their recording and its calibration.
fn bench() -> Bench {
    let bench = Bench::new();
    bench.preset("static-poses", "poses.toml", &[]);
    bench.run("simulate poses.toml -o made").done();
    bench.run("calibrate poses.toml made/recording.csv -o result").done();
    bench
}

#[test]
fn a_file_that_is_read_is_never_replaced() {
    let bench = bench();
    let says = ["this file is read, and would be replaced by the result", "[file-taken]"];
    bench.write("report.html", bench.read("poses.toml"));
    for command in [
        "apply result/calibration.json made/recording.csv -o made/../made/recording.csv --force",
        "convert result/calibration.json ./result/calibration.json --force",
        "calibrate report.html made/recording.csv -o . --force",
        "study report.html -o . --force",
    ] {
        bench.refuses(command, 2, &says);
    }
}

#[cfg(unix)]
#[test]
fn a_link_is_not_followed_onto_the_recording() {
    let bench = bench();
    std::fs::create_dir(bench.path("linked")).expect("a directory");
    std::os::unix::fs::symlink(bench.path("made/recording.csv"), bench.path("linked/calibration.json"))
        .expect("a link");
    bench.refuses(
        "calibrate poses.toml made/recording.csv -o linked",
        2,
        &["linked/calibration.json: this file is read"],
    );
}

#[test]
fn what_others_wrote_is_replaced_on_demand_only() {
    let bench = bench();
    bench.write("mine/recording.csv", "t_s,ax_mps2,ay_mps2,az_mps2\n0,0,0,9.8\n");
    let says = ["mine/recording.csv: this file is there already, and calibrant did not write it", "--force"];
    bench.refuses("simulate poses.toml -o mine", 2, &says);
    bench.run("simulate poses.toml -o mine --force").done();
    bench.run("simulate poses.toml -o mine").done();
}

#[test]
fn a_result_that_was_edited_is_kept() {
    let bench = bench();
    for (file, command) in [
        ("result/calibration.json", "calibrate poses.toml made/recording.csv -o result"),
        ("result/report.html", "calibrate poses.toml made/recording.csv -o result"),
        ("made/recording.csv", "simulate poses.toml -o made"),
    ] {
        let written = bench.read(file);
        bench.write(file, format!("{written}\n"));
        bench.refuses(
            command,
            2,
            &[&format!("{file}: this file is there already"), "[file-taken]", "--force"],
        );
        bench.write(file, written);
        bench.run(command).done();
    }
    // a folder may be moved with its results
    std::fs::rename(bench.path("result"), bench.path("moved")).expect("renamed");
    bench.run("calibrate poses.toml made/recording.csv -o moved").done();
}

#[test]
fn tables_begin_with_their_header() {
    let bench = bench();
    assert!(bench.read("made/recording.csv").starts_with("t_s,ax_mps2,"));
    bench.run("simulate poses.toml --seed 2 -o other").done();
    bench.run("calibrate poses.toml made/recording.csv other/recording.csv -o both").done();
    assert!(bench.read("both/summary.csv").starts_with("file,recording,verdict,"));
    bench.run("apply result/calibration.json made/recording.csv -o true.csv").done();
    assert!(bench.read("true.csv").starts_with("t_s,ax_mps2,"));
}

#[test]
fn results_of_an_earlier_run_are_told() {
    let bench = bench();
    let outcome = bench.run("calibrate poses.toml absent.csv -o result").ends_with(3);
    outcome.says("warning: result/calibration.json is that of an earlier run");
    let outcome = bench.run("calibrate poses.toml made/recording.csv --no-report -o result").done();
    outcome.says("warning: result/report.html is that of an earlier run");
    assert!(!outcome.stderr.contains("calibration.json"), "{outcome:?}");
}

#[test]
fn a_directory_of_another_run_is_refused() {
    let bench = bench();
    let directory = std::fs::File::open(bench.path("result")).expect("a directory");
    if directory.try_lock().is_ok() {
        let says = ["another run of calibrant writes into this directory"];
        bench.refuses("calibrate poses.toml made/recording.csv -o result", 2, &says);
    }
}

#[test]
fn a_corrected_recording_is_not_corrected_again() {
    let bench = bench();
    bench.run("apply result/calibration.json made/recording.csv -o true.csv").done();
    let says = ["this recording has been corrected already, with calibration.json", "[recording-corrected]"];
    bench.refuses("apply result/calibration.json true.csv -o twice.csv", 3, &says);
    // a copy is known by its columns
    bench.write("elsewhere/copy.csv", bench.read("true.csv"));
    let says = ["this recording has been corrected already", "[recording-corrected]"];
    bench.refuses("apply result/calibration.json elsewhere/copy.csv -o twice.csv", 3, &says);
}

#[test]
fn a_contradictory_calibration_is_refused() {
    let bench = bench();
    let text = bench.read("result/calibration.json");
    for (before, after, says) in [
        ("\"kind\": \"calibration\"", "\"kind\": \"toaster\"", "the kind of this file is \"toaster\""),
        ("\"sd\": ", "\"sd\": -", "the sd of accelerometer.bias.x is negative"),
    ] {
        bench.write("changed.json", text.replacen(before, after, 1));
        bench.refuses("apply changed.json made/recording.csv -o changed.csv", 2, &[says]);
    }
    for (factor, says) in
        [(100.0, "the sd of accelerometer.bias.x is"), (0.0, "is 0 in `parameters`"), (1e300, "the sd of")]
    {
        let mut changed = bench.json("result/calibration.json");
        let sd = &mut changed["parameters"][0]["sd"];
        *sd = (sd.as_f64().expect("known") * factor).into();
        bench.write("changed.json", changed.to_string());
        for command in [
            "apply changed.json made/recording.csv -o changed.csv",
            "convert changed.json changed.yaml",
            "compare changed.json result/calibration.json",
            "records add r.db changed.json",
        ] {
            bench.refuses(command, 2, &["changed.json", says, "calibrate again"]);
        }
    }
    let mut exchanged = bench.json("result/calibration.json");
    exchanged["parameters"].as_array_mut().expect("a list").swap(0, 1);
    bench.write("changed.json", exchanged.to_string());
    bench.refuses("apply changed.json made/recording.csv -o changed.csv", 2, &["parameters were exchanged"]);
    for entries in [[[-1.0, 0.0], [0.0, 1.0]], [[1.0, 2.0], [2.0, 1.0]], [[1.0, 0.5], [0.0, 1.0]]] {
        let mut changed = bench.json("result/calibration.json");
        for (i, row) in entries.iter().enumerate() {
            for (j, factor) in row.iter().enumerate() {
                let sd = |k: usize| changed["parameters"][k]["sd"].as_f64().expect("known");
                let entry = factor * sd(i) * sd(j);
                changed["covariance"][i][j] = entry.into();
            }
        }
        bench.write("changed.json", changed.to_string());
        bench.refuses("records add r.db changed.json", 2, &["changed.json", "covariance"]);
    }
    let mut stalled = bench.json("result/calibration.json");
    stalled["status"] = "stalled".into();
    bench.write("changed.json", stalled.to_string());
    bench.run("records add r.db changed.json").done().says("it did not converge (stalled)");
    let mut unjudged = bench.json("result/calibration.json");
    unjudged.as_object_mut().expect("an object").retain(|key, _| key != "verdict" && key != "kind");
    bench.write("changed.json", unjudged.to_string());
    let outcome = bench.run("apply changed.json made/recording.csv -o changed.csv").done();
    outcome.says("the file does not say its kind");
    outcome.says("the file does not say a verdict");
    unjudged["kind"] = "machine".into();
    bench.write("changed.json", unjudged.to_string());
    bench.refuses("apply changed.json made/recording.csv -o changed.csv", 2, &["and it has no `machine`"]);
    let mut changed = bench.json("result/calibration.json");
    changed["accelerometer"]["correction"]["matrix"][0][0] = 2.0.into();
    bench.write("changed.json", changed.to_string());
    let says = ["the correction of the accelerometer is not the inverse of its matrix"];
    bench.refuses("apply changed.json made/recording.csv -o changed.csv", 2, &says);
}

#[test]
fn names_command_neither_the_terminal_nor_a_spreadsheet() {
    let bench = bench();
    bench.write("=1+1.csv", bench.read("made/recording.csv"));
    let outcome =
        bench.run("calibrate poses.toml made/recording.csv =1+1.csv a\u{1b}[2Jb.csv -o result").ends_with(3);
    outcome.says("a\\u001b[2Jb.csv: cannot read the recording");
    assert!(!outcome.stderr.contains('\u{1b}') && !outcome.stdout.contains('\u{1b}'));
    assert!(bench.read("result/summary.csv").contains("\n'=1+1,'=1+1.csv,"));
    // a name begins no line, and turns none round
    let forging = "a\nerror: forged\t\u{202e}";
    bench.write(&format!("{forging}.csv"), bench.read("made/recording.csv"));
    for arguments in [
        &["inspect", &format!("{forging}.csv")][..],
        &["inspect", forging],
        &["calibrate", "poses.toml", &format!("{forging}.csv"), "made/recording.csv", "-o", "forged"],
        &["calibrate", "poses.toml", &format!("{forging}.csv"), "-o", &format!("{forging}.d")],
    ] {
        let outcome = bench.run_with(arguments);
        let lines = || outcome.stdout.lines().chain(outcome.stderr.lines());
        assert!(!lines().any(|line| line.starts_with("error: forged")), "{outcome:?}");
        assert!(!lines().any(|line| line.contains(['\t', '\u{202e}'])), "{outcome:?}");
    }
}

#[test]
fn work_beyond_the_budget_is_refused_before_it_starts() {
    let bench = Bench::new();
    bench.preset("report", "motion.toml", &[]);
    let long = [("interval_s = 1.0 ", "interval_s = 1e6 "), ("rate_hz = 10.0 ", "rate_hz = 1e3 ")];
    bench.preset("report", "long.toml", &long);
    let unknown =
        [("detail_rate_hz = 10.0 ", "detail_rate_hz = 1e6 "), ("interval_s = 5.0 ", "interval_s = 1e4 ")];
    bench.preset("report", "detail.toml", &unknown);
    bench.preset("static-poses", "poses.toml", &[("poses = 24 ", "poses = 1000 ")]);
    let allowed: Vec<String> = (0..5000).map(|k| format!("[1.0, 0.1, {:.4}]", 1e-4 * f64::from(k))).collect();
    let allowed = format!("starts = 3000\nallowed = [{}] #", allowed.join(", "));
    bench.preset("static-poses", "allowed.toml", &[("# allowed = \"any\" ", &allowed), ("# starts", "# ")]);
    for (command, says) in [
        (
            "simulate long.toml -o result",
            "1.0e10 samples (10000000 s at 1000 Hz) would take about 931 GiB of memory",
        ),
        ("design motion.toml --starts 1000000 -o result", "1000000 starts of 10 intervals would take about"),
        ("design motion.toml --sweep duration=1e7 -o result", "1 value of the sweep would take about"),
        (
            "design motion.toml --sample-rate 1e9 -o result",
            "1.0e10 rows of motion_dense.csv would take about",
        ),
        ("study long.toml --sensors 2 -o result", "this study of 6 sensors would take about"),
        ("study detail.toml --sensors 2 -o result", "this study of 6 sensors would take about"),
        (
            "design motion.toml --starts 20000 --reach bias.x=1ug -o result",
            "a search among motions of up to 16 times 10 intervals would take about",
        ),
        ("design poses.toml -o result", "30 starts of 1000 poses would take about"),
        (
            "design poses.toml --starts 100000 --reach bias.x=1ug -o result",
            "a search for the fewest poses would take about",
        ),
        ("design allowed.toml -o result", "3000 starts of 24 poses would take about"),
        ("study motion.toml --threads 65535 -o result", "65535 threads would take about 128 GiB of memory"),
    ] {
        bench.refuses(command, 2, &[says, "or add --force", "[work-too-large]"]);
    }
    // nor does the environment lead around it
    let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_calibrant"));
    let refused = program.args(["explain"]).env("RAYON_NUM_THREADS", "100000").output().expect("it runs");
    let told = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(
        refused.status.code() == Some(2) && told.contains("100000 threads (RAYON_NUM_THREADS) would"),
        "{told}"
    );
}

#[test]
fn scale_and_bias_without_g_sensitivity_are_calibrated() {
    let bench = Bench::new();
    let plain =
        [("model = \"full\"", "model = \"scale-bias\""), ("g_sensitivity = true", "g_sensitivity = false")];
    bench.preset("imu", "imu.toml", &[plain[0], plain[0], plain[1]]);
    bench.run("simulate imu.toml -o made").done();
    bench.run("calibrate imu.toml made/recording.csv -o result");
}

#[test]
fn a_dash_is_standard_input() {
    let bench = Bench::new();
    bench.preset("report", "experiment.toml", &[]);
    bench.run_from("experiment.toml", "simulate - -o sim").done();
    let calibrate = "calibrate experiment.toml --motion sim/motion.csv";
    bench.run(&format!("{calibrate} sim/recording.csv -o named")).done();
    bench.run_from("sim/recording.csv", &format!("{calibrate} - -o read")).done();
    let of_file = bench.read("named/calibration.json");
    let of_file = of_file.replace("\"recording.csv\"", "\"-\"").replace("\"recording\"", "\"stdin\"");
    assert_eq!(bench.read("read/calibration.json"), of_file);
    let outcome = bench.run_from("sim/recording.csv", "inspect -").done();
    assert!(outcome.stdout.starts_with("-: CSV, "), "{outcome:?}");
    bench.refuses("inspect -", 3, &["-: the file is empty"]);
    let batch = bench.run_from("sim/recording.csv", &format!("{calibrate} - sim/recording.csv -o batch"));
    batch.ends_with(3).says("-: this is a copy of sim/recording.csv");
    // and standard output, with nothing else in it
    let apply = "apply named/calibration.json sim/recording.csv -o";
    bench.run(&format!("{apply} corrected.csv")).done();
    assert_eq!(bench.run(&format!("{apply} -")).done().stdout, bench.read("corrected.csv"));
    let converted = bench.run("convert named/calibration.json - --to calibrant").done().stdout;
    assert!(converted.starts_with('{') && !bench.path("-").exists(), "{converted}");
}
