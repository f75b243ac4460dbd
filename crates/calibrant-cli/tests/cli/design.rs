//! Tests of `calibrant design`: from an experiment to a motion, its files and messages.

use crate::bench::{Bench, names};
use serde_json::Value;

/// Two starts and no certificate: seconds matter in tests.
const QUICK: &str = "--starts 2 --no-certificate";

/// The report's experiment with every limit of an arm, and these edits.
fn arm(bench: &Bench, file: &str, edits: &[(&str, &str)]) {
    let mut all = vec![
        ("# acceleration_mps2", "acceleration_mps2"),
        ("# velocity_mps", "velocity_mps"),
        ("# displacement_m", "displacement_m"),
        ("# rest = \"both\"", "rest = \"both\""),
    ];
    all.extend(edits);
    bench.preset("report", file, &all);
}

fn bench() -> Bench {
    let bench = Bench::new();
    arm(&bench, "arm.toml", &[]);
    bench
}

/// The place of a parameter in the lists of a file.
fn place(file: &Value, name: &str) -> usize {
    let list = file["parameters"].as_array().expect("parameters");
    list.iter().position(|parameter| parameter["name"] == name).expect("there")
}

/// The standard deviation that a design predicts: with its `optimal` motion, or the `initial` one.
fn sd(design: &Value, motion: &str, name: &str) -> f64 {
    design[motion]["sd"][place(design, name)].as_f64().expect("a number")
}

#[test]
fn a_design_leaves_a_motion_and_everything_needed_to_judge_it() {
    let bench = bench();
    let outcome = bench.run(&format!("design arm.toml {QUICK} --sample-rate 20 -o d")).done();
    for word in [
        "criterion A (trace C, in SI units)",
        "sd shuttle",
        "sd optimal",
        "scale.z",
        "6 starts",
        "d/motion.csv",
    ] {
        assert!(outcome.printed().contains(word), "{word}\n{}", outcome.stdout);
    }
    assert_eq!(outcome.stderr, "");
    assert!(bench.read("d/report.html").trim_end().ends_with("</html>"));
    let design = bench.json("d/design.json");
    assert_eq!((&design["schema"], &design["status"]), (&Value::from(2), &Value::from("converged")));
    assert_eq!(names(&design["parameters"]), ["bias.x", "bias.y", "bias.z", "scale.x", "scale.y", "scale.z"]);
    assert_eq!(design["criterion"]["name"], "A");
    for part in [&design["optimal"], &design["initial"]] {
        let trace: f64 = (0..6).map(|k| part["covariance"][k][k].as_f64().expect("a number")).sum();
        assert!((part["value"].as_f64().expect("a number") / trace - 1.0).abs() < 1e-12);
        for (field, length) in [
            ("times_s", 11),
            ("acceleration_mps2", 11),
            ("jerk_mps3", 10),
            ("velocity_mps", 11),
            ("displacement_m", 11),
        ] {
            assert_eq!(part["motion"][field].as_array().map(Vec::len), Some(length), "{field}");
        }
    }
    assert!(sd(&design, "optimal", "scale.x") < 0.5 * sd(&design, "initial", "scale.x"));
    for found in design["limit_use"].as_array().expect("limits") {
        assert_eq!(found["violated"], false, "{found}");
    }
    assert_eq!(design["certificate"], Value::Null);
    assert_eq!(design["starts"].as_array().map(Vec::len), Some(6), "every start");
    assert_eq!(design["setting"]["noise_mps2"], serde_json::json!([2e-4, 2e-4, 2e-4]));
    assert_eq!(design["limits"]["rest"], "both");
    // 10 s at 20 Hz, both ends included
    let dense = bench.read("d/motion_dense.csv");
    assert!(dense.starts_with("t_s,px_m,vx_mps,ax_mps2,jx_mps3,py_m,"), "{dense}");
    assert_eq!(dense.lines().count(), 202);
    let last: Vec<f64> =
        dense.lines().last().expect("rows").split(',').map(|n| n.parse().expect("a number")).collect();
    assert!(last[2].abs() < 1e-9, "at rest at the end: {last:?}");
    // the next commands read the motion
    bench.run("simulate arm.toml --motion d/motion.csv -o s").done();
    bench.run("calibrate arm.toml s/recording.csv --motion d/motion.csv -o c").done();
    let (found, promised) = (bench.json("c/calibration.json"), &design);
    for name in ["bias.y", "scale.x"] {
        let own = &found["parameters"][place(&found, &format!("accelerometer.{name}"))]["sd"];
        let own = own.as_f64().expect("a number");
        assert!((own / sd(promised, "optimal", name) - 1.0).abs() < 1e-6, "{name}: what was promised");
    }
}

#[test]
fn the_same_seed_gives_the_same_bytes_whatever_the_threads() {
    let bench = bench();
    bench.run(&format!("design arm.toml {QUICK} --threads 1 -o one")).done();
    bench.run(&format!("design arm.toml {QUICK} --threads 4 -o four")).done();
    assert_eq!(bench.read("one/design.json"), bench.read("four/design.json"));
    let json = bench.run(&format!("design arm.toml {QUICK} --json -o one")).done().stdout;
    assert_eq!(json, bench.read("one/design.json"));
    bench.run(&format!("design arm.toml {QUICK} --seed 2 -o other")).done();
    assert_ne!(bench.read("one/design.json"), bench.read("other/design.json"));
}

#[test]
fn every_criterion_by_its_letter() {
    let bench = Bench::new();
    let edits = [("# weights = {", "weights = {"), ("# range_mps2 = 20.0", "range_mps2 = 20.0")];
    arm(&bench, "arm.toml", &edits);
    for letter in ["A", "D", "E", "M", "c", "I"] {
        bench.run(&format!("design arm.toml {QUICK} --criterion {letter} -o {letter}")).done();
        let file = bench.json(&format!("{letter}/design.json"));
        assert_eq!(file["criterion"]["name"], letter);
        let value = |part: &Value| part["value"].as_f64().expect("a number");
        assert!(value(&file["optimal"]) < value(&file["initial"]), "{letter}");
    }
}

#[test]
fn what_is_known_already_counts() {
    let bench = bench();
    bench.run("simulate arm.toml -o s").done();
    bench.run("calibrate arm.toml s/recording.csv --motion s/motion.csv -o c").done();
    bench.run(&format!("design arm.toml {QUICK} -o alone")).done();
    bench.run(&format!("design arm.toml {QUICK} --from c/calibration.json -o after")).done();
    let twice = "--from c/calibration.json --from c/calibration.json";
    let outcome = bench.run(&format!("design arm.toml {QUICK} {twice} -o twice")).done();
    outcome.says("warning: c/calibration.json and c/calibration.json are equal to the last digit");
    let bias = |name: &str| sd(&bench.json(&format!("{name}/design.json")), "optimal", "bias.x");
    // the bias is known equally from any recording of this length, so information adds up: 1, 2 and 3
    // recordings
    for (name, recordings) in [("after", 2.0_f64), ("twice", 3.0)] {
        assert!((bias("alone") / bias(name) / recordings.sqrt() - 1.0).abs() < 0.01, "{name}");
    }
    bench.run("simulate arm.toml --seed 2 -o s2").done();
    bench.run("calibrate arm.toml s2/recording.csv --motion s2/motion.csv -o c2").done();
    let outcome = bench
        .run(&format!("design arm.toml {QUICK} --from c/calibration.json --from c2/calibration.json -o no"));
    outcome.says(
        "warning: c/calibration.json and c2/calibration.json differ by more than their uncertainty (χ²",
    );
    let after = bench.json("after/design.json");
    let guess = bench.json("c/calibration.json")["parameters"][0]["value"].clone();
    assert_eq!(after["setting"]["guess"][0], guess);
    assert!(after["setting"]["prior_information"].is_array());
    arm(&bench, "prior.toml", &[("prior = \"none\"", "prior = \"datasheet\"")]);
    bench.run(&format!("design prior.toml {QUICK} -o prior")).done();
    let prior = &bench.json("prior/design.json")["setting"]["prior_information"];
    assert!((prior[0][0].as_f64().expect("a number") - 100.0).abs() < 1e-9, "1/0.1²");
}

#[test]
fn a_motion_of_ones_own_is_judged() {
    let bench = bench();
    bench.run("simulate arm.toml -o s").done();
    let outcome = bench.run(&format!("design arm.toml {QUICK} --evaluate s/motion.csv -o e")).done();
    for words in ["sd own", "of the best motion found", "all limits are kept, at all times"] {
        assert!(outcome.printed().contains(words), "{words}\n{}", outcome.stdout);
    }
    assert!(bench.read("e/evaluation.html").trim_end().ends_with("</html>"));
    let file = bench.json("e/evaluation.json");
    assert_eq!((&file["admissible"], &file["determined"]), (&Value::from(true), &Value::from(true)));
    let efficiency = file["efficiency"].as_f64().expect("a number");
    assert!(efficiency > 0.0 && efficiency < 1.0);
    assert_eq!(bench.json("e/design.json")["optimal"], file["design"]["optimal"]);

    // faster than the arm between the nodes only: v is zero at every node, 12.5 in the middle of the first interval
    let mut rows = "t_s,ax_mps2,ay_mps2,az_mps2\n0,25,3,1\n2,-25,-3,-1\n".to_owned();
    rows += "4,25,3,2\n6,-25,-3,-2\n";
    bench.write("fast.csv", rows);
    let outcome = bench.run(&format!("design arm.toml {QUICK} --evaluate fast.csv -o f"));
    assert_eq!(outcome.status, 4, "it breaks a limit: {outcome:?}");
    for words in [
        "BROKEN: velocity of axis x is 12.50 m/s at 1.000 s, 2.500 beyond the limit of 10.00 (25.0 %)",
        "The motion takes 6 s in 3 intervals, but the best motion is for the experiment's 10 s in 10 intervals.",
    ] {
        let stdout = outcome.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(stdout.contains(words), "{words}\n{stdout}");
    }
    assert_eq!(bench.json("f/evaluation.json")["other_setting"]["intervals"], 3);
}

#[test]
fn a_motion_that_leaves_something_undetermined_says_why() {
    let bench = bench();
    bench.write("still.csv", "t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,1\n5,-1,2,-1\n10,1,2,3\n");
    let outcome = bench.run(&format!("design arm.toml {QUICK} --evaluate still.csv -o e"));
    assert_eq!(outcome.status, 4, "{outcome:?}");
    outcome.says("still.csv leaves bias.y, scale.y undetermined: axis y does not move, its acceleration is 2 m/s² throughout (move the sensor along axis y)");
    let file = bench.json("e/evaluation.json");
    assert_eq!(file["evaluation"]["undetermined"][0]["parameters"], serde_json::json!(["bias.y", "scale.y"]));
    assert_eq!((&file["efficiency"], &file["evaluation"]["value"]), (&Value::Null, &Value::Null));
}

#[test]
fn counts_and_criteria_are_put_into_words() {
    let bench = Bench::new();
    let edits = [
        ("axes = 3", "axes = 1"),
        ("intervals = 10", "intervals = 1"),
        ("starts = 30", "starts = 1"),
        ("scale_by = \"none\"", "scale_by = \"datasheet\""),
    ];
    arm(&bench, "one.toml", &edits);
    bench.write("own.csv", "t_s,ax_mps2\n0,1\n2,-1\n");
    let outcome = bench.run("design one.toml --evaluate own.csv -o d").done();
    for words in [
        "criterion A (trace C, each parameter divided by its datasheet spread)",
        "The motion takes 2 s in 1 interval, but the best motion is for the experiment's 1 s in 1 interval.",
    ] {
        let stdout = outcome.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(stdout.contains(words), "{words}\n{stdout}");
    }
    let outcome = bench.run("design one.toml -o d").done();
    assert!(outcome.printed().contains("1 start, 1 converged, 1 within 0.001 % of the best"), "{outcome:?}");
    let outcome = bench.run("design one.toml --no-certificate --sweep duration=0.4,2 -o d").done();
    outcome.says("duration 0.4 s is not a whole number of intervals: 1 s, 1 interval, instead");
}

#[test]
fn too_few_intervals_for_a_full_sensor_are_named() {
    let bench = Bench::new();
    let full = [("model = \"scale-bias\"", "model = \"full\""), ("# cross_axis_sd", "cross_axis_sd")];
    arm(&bench, "full.toml", &[full[0], full[1], ("intervals = 10", "intervals = 2")]);
    let outcome = bench.run(&format!("design full.toml {QUICK} -o d"));
    assert_eq!(outcome.status, 4, "{outcome:?}");
    outcome.says("the motion has 3 nodes, too few for the accelerations along x, y and z to be independent of each other (use at least 3 intervals)");
    // there is no best motion to be near to
    assert!(!outcome.stderr.contains("a better one may be near"), "{outcome:?}");
    assert!(!outcome.printed().contains("of the best"), "{outcome:?}");
}

#[test]
fn sweeps_say_what_things_cost() {
    let bench = bench();
    let outcome = bench.run(&format!("design arm.toml {QUICK} --sweep duration=5,10.4 -o d")).done();
    outcome.says("note: duration 10.4 s is not a whole number of intervals: 10 s, 10 intervals, instead");
    assert!(
        outcome.printed().contains("duration (s)") && outcome.printed().contains("sd scale.z"),
        "{outcome:?}"
    );
    let file = bench.json("d/sweep.json");
    let value = |k: usize| file["points"][k]["design"]["optimal"]["value"].as_f64().expect("a number");
    assert!(value(1) < value(0), "more time tells more");
    let csv = bench.read("d/sweep.csv");
    assert!(csv.starts_with("duration_s,duration_s_asked,intervals,status,error,criterion_A,"), "{csv}");
    assert!(bench.read("d/report.html").trim_end().ends_with("</html>"));
    assert!(csv.contains(",scale.x_sd,") && csv.contains(",bias.x_sd_mps2,"), "{csv}");
    assert_eq!(csv.lines().count(), 3);
    bench.run(&format!("design arm.toml {QUICK} --sweep limits.velocity_mps=2:10:3 -o v")).done();
    let file = bench.json("v/sweep.json");
    assert_eq!(
        (&file["variable"], &file["unit"]),
        (&Value::from("limits.velocity_mps"), &Value::from("m/s"))
    );
    let sd = |k: usize| sd(&file["points"][k]["design"], "optimal", "scale.x");
    assert!(sd(2) <= sd(1) && sd(1) <= sd(0), "a tighter limit costs");
}

#[test]
fn limits_that_clash_are_named_before_the_search() {
    let bench = bench();
    let with = |line: &str| {
        arm(&bench, "clash.toml", &[("[calibrate]", &format!("{line}\n[calibrate]"))]);
    };
    with("start_acceleration_mps2 = [0.0, 31.0, 0.0]");
    bench.refuses(
        "design clash.toml -o none",
        4,
        &["clash.toml: `limits.start_acceleration_mps2`: the limits admit no motion: the acceleration at the start of axis y, 31 m/s², lies beyond"],
    );
    let slow = ("jerk_mps3 = 30.0", "jerk_mps3 = 1.0");
    arm(&bench, "clash.toml", &[slow, ("# start_acceleration_mps2 = 0.0", "start_acceleration_mps2 = 9.0")]);
    bench.refuses(
        "design clash.toml -o none",
        4,
        &[
            "clash.toml: the limits admit no motion of 10 s in intervals of 1 s along axis x: its limits on jerk",
            "acceleration at the start clash",
        ],
    );
    // a sweep continues where the limits admit a motion
    let outcome = bench.run(&format!("design clash.toml {QUICK} --sweep jerk=1,20 -o sweep")).done();
    outcome.says("warning: jerk 1 m/s³: the limits admit no motion");
    with("start_acceleration_mps2 = 0.0\nend_acceleration_mps2 = [0.0, 1.0, -1.0]");
    bench.run(&format!("design clash.toml {QUICK} -o held")).done();
    let file = bench.json("held/design.json");
    for part in ["optimal", "initial"] {
        let nodes = &file[part]["motion"]["acceleration_mps2"];
        assert_eq!(nodes[0], serde_json::json!([0.0, 0.0, 0.0]));
        assert_eq!(nodes[10], serde_json::json!([0.0, 1.0, -1.0]));
    }
}

#[test]
fn wrong_requests_are_refused_and_nothing_is_written() {
    let bench = bench();
    bench.preset("static-poses", "static.toml", &[]);
    bench.preset("report", "free.toml", &[("intercept_mps2 = 30.0", "")]);
    bench.write("not.json", "t_s,ax\n1,2\n");
    bench.write("other.json", "{ \"schema\": 7 }");
    bench.write("empty.csv", "");
    bench.refuses("design arm.toml", 2, &["--output <DIR>"]);
    for (arguments, says) in [
        ("arm.toml --criterion Z", "invalid value 'Z' for '--criterion <LETTER>': one of A, D, E, M, c, I"),
        ("arm.toml --criterion c", "arm.toml: `design.weights`: criterion c needs a weight above 0"),
        ("arm.toml --criterion I", "arm.toml: `design.range_mps2`: criterion I needs the operating range"),
        ("arm.toml --starts 0", "invalid value '0' for '--starts <STARTS>'"),
        ("arm.toml --sample-rate=-1", "a number above 0"),
        ("arm.toml --sweep speed=1,2", "\"speed\" cannot be swept; what can is duration, acceleration"),
        ("arm.toml --sweep duration=1:2", "a range is FROM:TO:COUNT"),
        ("arm.toml --sweep duration=5 --evaluate empty.csv", "cannot be used with"),
        ("arm.toml --evaluate empty.csv", "empty.csv: the file is empty"),
        ("arm.toml --evaluate absent.csv", "absent.csv: cannot read the motion"),
        ("arm.toml --from absent.json", "absent.json: cannot read the calibration"),
        ("arm.toml --from not.json", "not.json:1:2: not valid JSON"),
        ("arm.toml --from other.json", "other.json: schema 7 of a calibration is not known to this version"),
        ("free.toml", "nothing bounds the acceleration of axis x"),
    ] {
        bench.refuses(&format!("design {arguments} -o none"), 2, &[says]);
    }
}

#[test]
fn a_calibration_of_another_sensor_is_refused() {
    let bench = bench();
    arm(&bench, "one.toml", &[("axes = 3", "axes = 1")]);
    bench.run("simulate one.toml -o s").done();
    bench.run("calibrate one.toml s/recording.csv --motion s/motion.csv -o c").done();
    bench.run(&format!("design one.toml {QUICK} --from c/calibration.json -o d")).done();
    bench.refuses(
        "design arm.toml --from c/calibration.json -o none",
        2,
        &["c/calibration.json: this calibration is of another sensor model: its parameters are bias.x, scale.x, those of the experiment bias.x, bias.y"],
    );
}

#[test]
fn a_gap_that_is_proved_ends_the_search() {
    let bench = Bench::new();
    bench.preset("report", "box.toml", &[]);
    let outcome = bench.run("design box.toml --gap 5% -o d").done();
    assert!(outcome.printed().contains("that was asked for is proved"), "{}", outcome.stdout);
    let file = bench.json("d/design.json");
    let goal = &file["gap_goal"];
    assert_eq!(
        (&goal["gap"], &file["gap_is_reached"], &goal["most_starts"]),
        (&0.05.into(), &true.into(), &90.into())
    );
    assert!(file["starts"].as_array().expect("every start").len() < 30);
    assert!(bench.read("d/report.html").contains("that was asked for is proved"));
    for nonsense in ["0", "200%", "nan"] {
        let outcome = bench.run(&format!("design box.toml --gap {nonsense} -o e"));
        assert_eq!(outcome.status, 2, "{}", outcome.stderr);
        assert!(outcome.stderr.contains("1%"), "{}", outcome.stderr);
    }
}
