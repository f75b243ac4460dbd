//! `calibrant design` of a machine: the trajectory of its joints, and what is refused.

use crate::bench::Bench;

/// A rate table of one joint, for 8 s.
fn table() -> Bench {
    let bench = Bench::new();
    bench.preset("rate-table", "table.toml", &[("duration_s = 20.0 ", "duration_s = 8.0 ")]);
    bench
}

#[test]
fn a_trajectory_goes_from_the_design_to_the_verdict() {
    let bench = table();
    let outcome = bench.run("design table.toml --starts 2 -o best").done();
    for words in [
        "Predicted standard deviations",
        "variance from, %",
        "Begin at rest at: table",
        "best/trajectory.csv",
    ] {
        assert!(outcome.printed().contains(words), "{words}\n{}", outcome.stdout);
    }
    let design = bench.json("best/design.json");
    let limits = design["optimal"]["limits"].as_array().expect("limits");
    assert!(limits.iter().all(|limit| limit["is_proved"] == true), "{limits:?}");
    assert!(bench.read("best/follow_joint_trajectory.yaml").contains("joint_names: [\"table\"]"));
    assert!(!bench.path("best/trajectory.script").exists(), "no arm of six joints");

    // the file that was written is judged as it was designed
    bench.run("design table.toml --starts 2 --evaluate best/trajectory.csv -o judged").done();
    let judged = bench.json("judged/evaluation.json");
    let sd = |file: &serde_json::Value, key: &str, k: usize| file[key]["sd"][k].as_f64().expect("a number");
    for k in 0..12 {
        let ratio = sd(&judged, "evaluation", k) / sd(&design, "optimal", k);
        assert!((ratio - 1.0).abs() < 1e-6, "{k}: {ratio}");
    }

    bench.run("simulate table.toml --motion best/trajectory.csv --seed 3 -o made").done();
    let outcome = bench.run("calibrate table.toml made/recording.csv --motion made/joints.csv -o out").done();
    assert!(outcome.printed().contains("verdict: ok"), "{outcome:?}");
}

/// The same path twice as fast breaks the limits of speed, acceleration and jerk, and four times slower none.
#[test]
fn a_trajectory_that_is_too_fast_is_named_and_a_slow_one_is_the_same_path() {
    let bench = table();
    bench.run("design table.toml --starts 2 --slow 4 -o slow").done();
    let rows = |factor: f64| {
        let text = bench.read("slow/trajectory.csv");
        let scaled = |row: &str| {
            let numbers: Vec<f64> = row.split(',').map(|number| number.parse().expect("a number")).collect();
            let scales = [factor, 1.0, 1.0 / factor, 1.0 / (factor * factor)];
            numbers
                .iter()
                .zip(scales)
                .map(|(x, scale)| format!("{:.17e}", x * scale))
                .collect::<Vec<_>>()
                .join(",")
        };
        let (head, rows): (Vec<&str>, Vec<&str>) =
            text.lines().partition(|row| !row.starts_with(|c: char| c.is_ascii_digit() || c == '-'));
        head.into_iter().map(str::to_owned).chain(rows.into_iter().map(scaled)).collect::<Vec<_>>().join("\n")
            + "\n"
    };
    bench.write("fast.csv", rows(1.0 / 8.0));
    let outcome = bench.run("design table.toml --starts 2 --evaluate fast.csv -o judged").ends_with(4);
    for words in ["Limits are broken", "velocity of table", "acceleration of table"] {
        assert!(outcome.printed().contains(words), "{words}\n{}", outcome.stdout);
    }
}

/// Rows from the middle of a trajectory: the table moves where they begin, and where they end.
#[test]
fn a_trajectory_that_does_not_begin_at_rest_is_not_kept() {
    let bench = table();
    bench.run("design table.toml --starts 2 -o best").done();
    let text = bench.read("best/trajectory.csv");
    let rows: Vec<&str> = text.lines().collect();
    let of_row = |row: &str| row.split_once(',').map_or(String::new(), |(_, rest)| rest.to_owned());
    let middle: Vec<String> =
        (0..21).map(|k| format!("{},{}", 0.2 * f64::from(k), of_row(rows[11 + k as usize]))).collect();
    bench.write("middle.csv", format!("{}\n{}\n", rows[0], middle.join("\n")));
    let outcome = bench.run("design table.toml --starts 2 --evaluate middle.csv -o judged").ends_with(4);
    assert!(outcome.printed().contains("velocity at begin and end of table"), "{outcome:?}");
}

#[test]
fn what_cannot_be_designed_is_refused_with_what_to_do() {
    let bench = Bench::new();
    bench.preset("rate-table", "none.toml", &[("acceleration = 20.0 ", "# acceleration = 20.0 ")]);
    bench.refuses("design none.toml -o best", 2, &["machine.limits.acceleration", "joint_limits"]);
    bench.preset("rate-table", "letter.toml", &[("criterion = \"D\" ", "criterion = \"E\" ")]);
    bench.refuses("design letter.toml -o best", 2, &["design.criterion", "D, A, c and I"]);
    bench.preset("rate-table", "table.toml", &[]);
    bench.refuses("design table.toml --gap 1% -o best", 2, &["--gap", "leave it away"]);
    bench.preset("stage", "stage.toml", &[]);
    bench.refuses("design stage.toml --slow 2 -o best", 2, &["--slow", "the trajectory of a machine"]);
    bench.preset("mocap", "body.toml", &[]);
    bench.refuses("design body.toml -o best", 2, &["machine with joints"]);
}

/// Six poses beside the optimum of an arm, and the same bits for any number of threads.
#[test]
fn a_design_stands_beside_six_poses_whatever_the_number_of_threads() {
    let bench = Bench::new();
    bench.preset("arm", "arm.toml", &[]);
    let outcome = bench.run("design arm.toml --starts 2 --threads 1 -o one").done();
    for words in ["smaller than with six poses", "The mount, known to 0.50°, limits 18"] {
        assert!(outcome.printed().contains(words), "{outcome:?}");
    }
    bench.run("design arm.toml --starts 2 --threads 2 -o two").done();
    for file in ["trajectory.csv", "plain_trajectory.csv", "design.json"] {
        assert_eq!(bench.read(&format!("one/{file}")), bench.read(&format!("two/{file}")), "{file}");
    }
    let design = bench.json("one/design.json");
    assert_eq!(design["plain_routine"], "six poses");
    let limits = design["plain"]["limits"].as_array().expect("limits");
    assert!(limits.iter().all(|limit| limit["is_proved"] == true), "{limits:?}");
    let value = |of: &str| design[of]["value"].as_f64().expect("a number");
    assert!(value("optimal") < value("plain") && value("optimal") < value("random"));
    // it stands still six times, and moves in between
    let text = bench.read("one/plain_trajectory.csv");
    let still: Vec<bool> = text
        .lines()
        .skip(1)
        .map(|row| {
            let numbers: Vec<f64> = row.split(',').map(|number| number.parse().expect("a number")).collect();
            numbers[7..13].iter().all(|speed| speed.abs() < 1e-9)
        })
        .collect();
    let holds = still.chunk_by(|one, next| one == next).filter(|run| run[0] && run.len() > 2).count();
    assert_eq!(holds, 6, "{still:?}");
}

#[test]
fn durations_are_swept_and_the_shortest_that_is_enough_is_found() {
    let bench = table();
    bench.run("design table.toml --starts 2 --sweep duration=6,24 -o durations").done();
    let sweep = bench.json("durations/sweep.json");
    let names: Vec<&str> =
        sweep["parameters"].as_array().expect("names").iter().filter_map(|name| name.as_str()).collect();
    let place = names.iter().position(|name| *name == "gyroscope.bias.z").expect("estimated");
    let sd = |point: usize| sweep["points"][point]["sd"][place].as_f64().expect("a number");
    // four times the time is half the sd, or better
    let ratio = sd(0) / sd(1);
    assert!((1.8..6.0).contains(&ratio), "{ratio}");
    assert_eq!(bench.read("durations/sweep.csv").lines().count(), 3);
    // between both durations lies the one that reaches a goal between both
    let goal = (sd(0) * sd(1)).sqrt();
    let reach = format!("design table.toml --starts 2 --reach gyroscope.bias.z={goal} -o short");
    let outcome = bench.run(&reach).done();
    let design = bench.json("short/design.json");
    let duration = design["duration_s"].as_f64().expect("a number");
    assert!((6.0..24.0).contains(&duration), "{duration}");
    assert!(design["optimal"]["sd"][place].as_f64().expect("a number") <= goal);
    assert!(outcome.printed().contains("none was found in 2 starts"), "{outcome:?}");
    bench.refuses("design table.toml --reach scale=1mg -o none", 2, &["is not measured in the unit of 1mg"]);
    bench.refuses("design table.toml --reach skale=1ppm -o none", 2, &["no parameter \"skale\""]);
    bench.refuses("design table.toml --sweep velocity=1,2 -o none", 2, &["swept over its duration"]);
    bench.refuses("design table.toml --sweep duration=5,9000 -o none", 2, &["of 9000 s", "at most 3600 s"]);
}

/// The machine as a calibration found it: another lever, other noise.
#[test]
fn a_design_begins_with_the_machine_that_was_found() {
    let bench = table();
    bench.run("design table.toml --starts 2 -o best").done();
    bench.run("simulate table.toml --motion best/trajectory.csv --seed 4 -o made").done();
    bench.run("calibrate table.toml made/recording.csv --motion made/joints.csv -o out").done();
    // the same result with noise that is twice as large
    let mut found = bench.json("out/calibration.json");
    for sensor in found["machine"]["sensor_noise"].as_array_mut().expect("a list") {
        for value in sensor["noise"].as_array_mut().expect("a list") {
            *value = (value.as_f64().expect("a number") * 2.0).into();
        }
    }
    bench.write("noisy.json", found.to_string());
    let sd = |from: &str| {
        bench.run(&format!("design table.toml --starts 2 {from} -o next")).done();
        let design = bench.json("next/design.json");
        let names = design["parameters"].as_array().expect("names");
        let place = names.iter().position(|name| name == "gyroscope.bias.z").expect("estimated");
        design["optimal"]["sd"][place].as_f64().expect("a number")
    };
    let (stated, as_found, noisy) = (sd(""), sd("--from out/calibration.json"), sd("--from noisy.json"));
    assert!((as_found / stated - 1.0).abs() < 0.05, "{as_found} {stated}");
    assert!((noisy / as_found - 2.0).abs() < 0.1, "{noisy} {as_found}");
    bench.preset("arm", "arm.toml", &[]);
    bench.refuses(
        "design arm.toml --from out/calibration.json -o none",
        2,
        &["of another machine", "to plate"],
    );
    bench.preset("static-poses", "poses.toml", &[]);
    bench.run("simulate poses.toml -o held").done();
    bench.run("calibrate poses.toml held/recording.csv -o held").done();
    bench.refuses(
        "design arm.toml --from held/calibration.json -o none",
        2,
        &["not of a sensor on a machine"],
    );
}

/// Design, recording and calibration of simulated sensors in one command.
#[test]
fn a_machine_is_rehearsed() {
    let bench = table();
    let outcome = bench.run("study table.toml --sensors 4 --starts 2 -o study").done();
    assert!(outcome.printed().contains("against best trajectory"), "{outcome:?}");
    let rehearsal = &bench.json("study/study.json")["rehearsal"];
    assert_eq!(rehearsal["routine"], "joints in turn");
    let sensors = rehearsal["sensors"].as_array().expect("a list");
    assert_eq!(sensors.len(), 4);
    let number = |of: &serde_json::Value| of.as_f64().expect("a number");
    for (k, summary) in rehearsal["summary"].as_array().expect("a list").iter().enumerate() {
        let designed = number(&rehearsal["designed_sd_optimal"][k]);
        let stated = number(&summary["optimal"]["predicted_sd"]);
        assert!((0.9..1.5).contains(&(stated / designed)), "{summary}: {designed}");
        // four sensors: errors beyond three sds are none
        assert!(number(&summary["optimal"]["realised_rms"]) < 3.0 * stated, "{summary}");
    }
    // each sensor is one of `simulate`
    bench.run("design table.toml --starts 2 -o best").done();
    bench.run("simulate table.toml --motion best/trajectory.csv --seed 2 -o made").done();
    let truth = bench.json("made/truth.json");
    let first = number(&truth["parameters"][0]["value"]);
    assert_eq!(first.to_bits(), number(&sensors[1]["truth"][0]).to_bits());
    bench.refuses("study table.toml --motion best/trajectory.csv -o none", 2, &["designs the motions"]);
}

/// What the files of the machine say is not exceeded without a word, and a trajectory is of the joints' own units.
#[test]
fn wider_limits_and_other_units_are_told() {
    let bench = Bench::new();
    let edits =
        [("duration_s = 20.0 ", "duration_s = 8.0 "), ("# velocity = 10.0 ", "velocity = { table = 20.0 } ")];
    bench.preset("rate-table", "wide.toml", &edits);
    let outcome = bench.run("design wide.toml --starts 1 -o wide").done();
    outcome.says("warning: the joint `table` is given more than a file of the machine: speed 20 rad/s, in the URDF file 8.727 rad/s");
    let metres = bench.read("wide/trajectory.csv").replace("_rad", "_m");
    bench.write("metres.csv", metres);
    bench.refuses(
        "design wide.toml --starts 1 --evaluate metres.csv -o judged",
        3,
        &["metres.csv", "the joint `table` turns, and its column is not in rad or deg"],
    );
}

/// A move that takes hours is no part of a routine of seconds: the search for one came to no end, and no signal ended it.
#[test]
fn a_machine_that_hardly_moves_is_designed_for_in_seconds() {
    let bench = Bench::new();
    let edits = [
        ("duration_s = 20.0 ", "duration_s = 5.0 "),
        ("# velocity = 2.98 ", "velocity = 1e-4 "),
        ("starts = 8 ", "starts = 1 "),
    ];
    bench.preset("arm", "slow.toml", &edits);
    let begun = std::time::Instant::now();
    let outcome = bench.run("design slow.toml -o slow");
    assert!(matches!(outcome.status, 0 | 4), "{outcome:?}");
    assert!(begun.elapsed().as_secs() < 60, "{:?}", begun.elapsed());
}
