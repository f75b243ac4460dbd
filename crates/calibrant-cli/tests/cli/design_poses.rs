//! Tests of `calibrant design` of a [holds] experiment, and of `--reach`.

use crate::bench::{Bench, names};
use serde_json::Value;

const QUICK: &str = "--starts 4";

fn bench(poses: usize) -> Bench {
    let bench = Bench::new();
    bench.preset("static-poses", "static.toml", &[("poses = 24 ", &format!("poses = {poses} "))]);
    bench
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// The standard deviation of a parameter: what a design predicts, or what a calibration states.
fn sd(file: &Value, name: &str) -> f64 {
    let list = file["parameters"].as_array().expect("parameters");
    let place = list.iter().position(|parameter| parameter["name"] == name).expect("there");
    let predicted = file.pointer(&format!("/optimal/sd/{place}"));
    number(predicted.unwrap_or(&list[place]["sd"]))
}

#[test]
fn a_design_leaves_poses_a_checklist_and_the_bound() {
    let bench = bench(12);
    let outcome = bench.run(&format!("design static.toml {QUICK} -o d")).done();
    for word in ["criterion A", "pose", "up x", "matrix.yz", "The 12 poses have at least", "d/poses.csv"] {
        assert!(outcome.printed().contains(word), "{word}\n{}", outcome.stdout);
    }
    let design = bench.json("d/design.json");
    assert_eq!((&design["schema"], &design["kind"]), (&Value::from(2), &Value::from("poses")));
    assert_eq!(names(&design["parameters"]).len(), 9);
    let efficiency = number(&design["efficiency"]);
    assert!(efficiency > 0.99 && efficiency <= 1.0, "{efficiency}");
    assert!(number(&design["certificate"]["lower_bound"]) <= number(&design["optimal"]["value"]));
    let shares: f64 = design["certificate"]["shares"].as_array().expect("shares").iter().map(number).sum();
    assert!((shares - 1.0).abs() < 1e-9);
    for up in design["poses"].as_array().expect("poses") {
        let square: f64 = up.as_array().expect("three numbers").iter().map(|x| number(x).powi(2)).sum();
        assert!((square - 1.0).abs() < 1e-12);
    }
    assert_eq!(bench.read("d/poses.csv").lines().filter(|line| line.contains('"')).count(), 12);
    let page = bench.read("d/report.html");
    assert_eq!(page.matches("class=\"box\"").count(), 12);
    // the poses are input of a simulation, whose holds are rated
    bench.run("simulate static.toml --poses d/poses.csv -o s").done();
    let rated = bench.run("design static.toml --evaluate s/recording.csv -o e").done();
    assert!(rated.printed().contains("Efficiency 99."), "{}", rated.stdout);
    assert!(number(&bench.json("e/evaluation.json")["efficiency"]) > 0.98);
    assert!(bench.read("e/evaluation.html").contains("12 holds"));
    // machine output is the file, for any number of threads
    let json = bench.run(&format!("design static.toml {QUICK} --json -o j")).done();
    assert_eq!(json.stdout.trim_end(), bench.read("d/design.json").trim_end());
}

/// Which poses next, for a whole IMU: designed from the first recording, simulated, and calibrated together with it.
#[test]
fn poses_are_added_to_a_recording_of_a_whole_imu() {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[("# poses = 24", "poses = 14")]);
    bench.run("simulate imu.toml -o one").done();
    bench.run("calibrate imu.toml one/recording.csv -o first").done();
    let next =
        bench.run(&format!("design imu.toml --from first/calibration.json --add 3 {QUICK} -o next")).done();
    assert!(!next.stderr.contains("noise-assumed"), "the noise is that of the first: {}", next.stderr);
    bench.run("simulate imu.toml --poses next/poses.csv --recording 2 -o two").done();
    let both = "calibrate imu.toml one/recording.csv two/recording.csv --together -o both";
    assert!(bench.run(both).done().printed().contains("from 17 of 17 holds"));
    let (predicted, stated) = (bench.json("next/design.json"), bench.json("both/calibration.json"));
    let ratio = sd(&stated, "accelerometer.matrix.zy") / sd(&predicted, "matrix.zy");
    assert!((0.7..1.4).contains(&ratio), "{ratio}");
}

#[test]
fn too_few_poses_are_refused_with_the_number_that_is_needed() {
    let outcome = bench(6).run("design static.toml -o d");
    assert_eq!(outcome.status, 4);
    assert!(outcome.stderr.contains("need at least 9"), "{}", outcome.stderr);
    let bench = Bench::new();
    bench.preset("static-poses", "faces.toml", &[("# allowed = \"any\"", "allowed = \"faces\" # ")]);
    let outcome = bench.run("design faces.toml -o d");
    assert_eq!(outcome.status, 4);
    for word in ["matrix.xy", "design.allowed", "design.directions = \"known\""] {
        assert!(outcome.stderr.contains(word), "{word}\n{}", outcome.stderr);
    }
}

#[test]
fn known_directions_determine_twelve_parameters_from_six_faces() {
    let bench = Bench::new();
    let edits = [
        ("poses = 24 ", "poses = 6 "),
        ("# allowed = \"any\"", "allowed = \"faces\" # "),
        ("# directions = \"known\"", "directions = \"known\""),
        ("# face_sd_deg = 0.3", "face_sd_deg = 0.0"),
    ];
    bench.preset("static-poses", "faces.toml", &edits);
    bench.run(&format!("design faces.toml {QUICK} -o d")).done();
    let design = bench.json("d/design.json");
    assert_eq!(names(&design["parameters"]).len(), 12);
    assert!(number(&design["efficiency"]) > 0.9999);
    // the closed form: σ/√(n N), and √3/g times it
    let expected = 0.01 / (500.0_f64 * 6.0).sqrt();
    assert!((sd(&design, "bias.x") / expected - 1.0).abs() < 1e-6);
    assert!((sd(&design, "scale.x") / (expected * 3.0_f64.sqrt() / 9.80665) - 1.0).abs() < 1e-6);
}

#[test]
fn the_next_poses_lower_the_standard_deviations_that_were_there() {
    let bench = bench(12);
    bench.run("simulate static.toml -o s").done();
    bench.run("calibrate static.toml s/recording.csv -o c").done();
    let from = "--from c/calibration.json";
    let next = bench.run(&format!("design static.toml {from} --add 3 {QUICK} -o n")).done();
    assert!(next.printed().contains("sd before") && next.printed().contains("sd then"), "{}", next.stdout);
    let (before, then) = (bench.json("c/calibration.json"), bench.json("n/design.json"));
    for name in names(&then["parameters"]) {
        assert!(sd(&then, name) < sd(&before, &format!("accelerometer.{name}")), "{name}");
    }
    let goal = 0.7 * sd(&then, "scale.x");
    let reach = format!("design static.toml {from} --reach scale.x={goal} {QUICK} -o r");
    let reached = bench.run(&reach).done();
    assert!(reached.printed().contains("more poses reach"), "{}", reached.stdout);
    let file = bench.json("r/design.json");
    assert!(sd(&file, "scale.x") <= goal);
    assert_eq!(file["reach"]["goals"][0]["name"], "scale.x");
    let found = file["poses"].as_array().map(Vec::len).expect("poses");
    assert!(number(&file["reach"]["at_least"]) as usize <= found);
}

#[test]
fn what_cannot_be_is_said_with_a_remedy() {
    let bench = bench(12);
    for (options, word) in [
        ("--reach scal.x=50ppm", "did you mean scale.x?"),
        ("--reach scale.x=1mg", "give ppm or %"),
        ("--reach bias.x=1ppm", "give mg, ug or m/s2"),
        ("--reach scale.x=soon", "is not a number above 0"),
        ("--reach scale.x=0.1ppm", "more than 200 poses are needed"),
        ("--sweep duration=1,2", "--sweep is of the design of a motion"),
        ("--no-certificate", "--no-certificate is of the design of a motion"),
        ("--criterion c", "criterion c needs a weight"),
        ("--criterion I", "criterion I needs the operating range"),
        ("--add 0", "--add"),
    ] {
        let outcome = bench.run(&format!("design static.toml {options} -o d"));
        assert_eq!(outcome.status, 2, "{options}: {outcome:?}");
        assert!(outcome.stderr.contains(word), "{options}\n{}", outcome.stderr);
    }
    bench.preset("report", "motion.toml", &[]);
    let outcome = bench.run("design motion.toml --add 3 -o d");
    assert!(outcome.status == 2 && outcome.stderr.contains("[holds]"), "{outcome:?}");
    for (line, word) in [
        ("allowed = \"face\"", "did you mean \"faces\"?"),
        ("allowed = []", "no direction is allowed"),
        ("allowed = [\"w\"]", "is no direction"),
        ("within_deg = 100.0", "within_deg"),
        ("directions = \"some\"", "directions"),
        ("alowed = \"any\"", "allowed"),
    ] {
        bench.preset("static-poses", "wrong.toml", &[("# criterion = \"A\"", &format!("{line} #"))]);
        let outcome = bench.run("design wrong.toml -o d");
        assert_eq!(outcome.status, 2, "{line}: {outcome:?}");
        assert!(outcome.stderr.contains(word) && outcome.stderr.contains("wrong.toml"), "{}", outcome.stderr);
    }
    bench.write("north.csv", "up_x,up_y,up_z\n0,north,0\n");
    let outcome = bench.run("simulate static.toml --poses north.csv -o s");
    assert!(outcome.status == 2 && outcome.stderr.contains("north.csv:2"), "{outcome:?}");
}

#[test]
fn an_imu_and_gravity_from_the_latitude_are_designed_for() {
    let bench = Bench::new();
    let edits = [
        ("unit = \"mps2\" ", "noise_mps2 = 0.01\nunit = \"mps2\" "),
        ("gravity_mps2 = 9.80665 ", "latitude_deg = 45.0\nheight_m = 10.0 #"),
    ];
    bench.preset("imu", "imu.toml", &edits);
    let outcome = bench.run(&format!("design imu.toml {QUICK} -o d")).done();
    assert!(bench.read("d/report.html").contains("determine the gyroscope"), "{}", outcome.stdout);
    // 3.5e-4 m/s² of gravity are 36 ppm of every scale factor, whatever the poses
    assert!(sd(&bench.json("d/design.json"), "scale.x") > 3.5e-5);
    let outcome = bench.run("design imu.toml --reach scale.x=30ppm -o r");
    assert!(outcome.status == 2 && outcome.stderr.contains("gravity alone"), "{}", outcome.stderr);
}

#[test]
fn the_shortest_motion_that_is_good_enough_is_found_with_its_proof() {
    let bench = Bench::new();
    bench.preset("report", "stage.toml", &[("# acceleration_mps2", "acceleration_mps2")]);
    let outcome = bench.run(&format!("design stage.toml {QUICK} --reach scale.x=1ppm -o d")).done();
    assert!(outcome.printed().contains("reaches scale.x to 1ppm"), "{}", outcome.stdout);
    let design = bench.json("d/design.json");
    assert!(sd(&design, "scale.x") <= 1e-6);
    let intervals = design["optimal"]["motion"]["jerk_mps3"].as_array().map(Vec::len).expect("a motion");
    let least = number(&design["reach"]["at_least"]) as usize;
    assert!(least >= 1 && least <= intervals, "{least} {intervals}");
    assert!(bench.read("d/report.html").contains("reaches scale.x to 1ppm"));
    let far = bench.run(&format!("design stage.toml {QUICK} --no-certificate --reach bias.x=1e-9 -o d"));
    assert!(far.status == 2 && far.stderr.contains("160 intervals"), "{far:?}");
}
