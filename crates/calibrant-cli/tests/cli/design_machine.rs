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
