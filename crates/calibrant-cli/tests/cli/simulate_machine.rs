//! `simulate` on a machine: what is simulated is found again, and what is refused.

use crate::bench::Bench;
use nalgebra::{Quaternion, UnitQuaternion};
use serde_json::Value;
use std::collections::BTreeMap;

/// Less time than a preset asks for.
const SHORT: (&str, &str) = ("duration_s = 60.0", "duration_s = 20.0");

/// The values of a list of named quantities, and their standard deviations where they have some.
fn named(list: &Value) -> BTreeMap<String, (f64, Option<f64>)> {
    let number = |entry: &Value, key: &str| entry[key].as_f64();
    let entries = list.as_array().expect("a list").iter();
    let named = entries.map(|entry| {
        let name = entry["name"].as_str().expect("a name").to_owned();
        (name, (number(entry, "value").expect("a value"), number(entry, "sd")))
    });
    named.collect()
}

/// The errors of a result in standard deviations: of the sensor, then of the machine.
fn errors(bench: &Bench, folder: &str) -> [Vec<(String, f64)>; 2] {
    let [truth, found] =
        ["truth.json", "result/calibration.json"].map(|file| bench.json(&format!("{folder}/{file}")));
    let of = |truth: &Value, found: &Value| {
        let truth = named(truth);
        let found = named(found).into_iter().filter_map(|(name, (value, sd))| {
            let (true_value, _) = truth.get(&name)?;
            let error = (value - true_value) / sd.expect("a standard deviation");
            Some((name, error))
        });
        found.collect::<Vec<_>>()
    };
    let machine = |file: &Value| file["machine"]["quantities"].clone();
    [of(&truth["parameters"], &found["parameters"]), of(&machine(&truth), &machine(&found))]
}

/// The mean of squared errors is 1 up to five standard deviations of it, as if they were independent, and each is within 4.5.
fn plausible(what: &str, errors: &[(String, f64)]) {
    let n = errors.len() as f64;
    let mean = errors.iter().map(|(_, error)| error * error).sum::<f64>() / n;
    assert!(mean < 1.0 + 5.0 * (2.0 / n).sqrt(), "{what}: {mean} {errors:?}");
    assert!(errors.iter().all(|(_, error)| error.abs() < 4.5), "{what}: {errors:?}");
}

#[test]
fn what_is_simulated_on_joints_is_found_again() {
    for (preset, of_sensor, of_machine) in [("arm", 24, 53), ("rate-table", 12, 11), ("gantry", 12, 13)] {
        let bench = Bench::new();
        bench.preset(preset, "machine.toml", &[SHORT]);
        let outcome = bench.run("simulate machine.toml --seed 3 -o run").done();
        assert_eq!(outcome.stdout.trim(), "4001 samples, seed 3: run/recording.csv");
        bench.run("calibrate machine.toml run/recording.csv --motion run/joints.csv -o run/result").done();
        let [sensor, machine] = errors(&bench, "run");
        assert_eq!((sensor.len(), machine.len()), (of_sensor, of_machine), "{preset}");
        plausible(preset, &sensor);
        plausible(preset, &machine);
    }
}

/// The mounting is unknown. It is any rotation, and the accelerometer fixes the frame of truth and result.
#[test]
fn what_is_simulated_in_the_hand_is_found_again() {
    let bench = Bench::new();
    bench.preset("mocap", "body.toml", &[SHORT]);
    bench.run("simulate body.toml --seed 3 -o run").done();
    bench.run("calibrate body.toml run/recording.csv --motion run/poses.csv -o run/result").done();
    let [sensor, machine] = errors(&bench, "run");
    assert_eq!((sensor.len(), machine.len()), (21, 8));
    plausible("mocap", &sensor);
    plausible("mocap", &machine);
    let rotation = |file: &str| {
        let wxyz = bench.json(file)["machine"]["tip_from_sensor_wxyz"].clone();
        let [w, x, y, z] = [0, 1, 2, 3].map(|k| wxyz[k].as_f64().expect("a number"));
        UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
    };
    let turn = rotation("run/truth.json").angle_to(&rotation("run/result/calibration.json"));
    assert!(turn < 5e-4, "{turn}");
}

/// The log of one simulation is the motion of another: of the same motion, with other errors.
#[test]
fn a_log_is_the_motion_of_a_simulation() {
    for (preset, log) in [("gantry", "joints.csv"), ("mocap", "poses.csv")] {
        let bench = Bench::new();
        bench.preset(preset, "machine.toml", &[SHORT]);
        bench.run("simulate machine.toml -o one").done();
        let again = format!("simulate machine.toml --seed 2 --motion one/{log} -o two");
        let outcome = bench.run(&again).done();
        outcome.says(&format!("the motion is a spline through {log}, with knots every "));
        let [one, two] = ["one", "two"].map(|folder| bench.read(&format!("{folder}/{log}")));
        assert_eq!(one.lines().count(), two.lines().count());
        assert_ne!(one, two, "the noise differs");
        let row = |text: &str, k: usize| -> Vec<f64> {
            let line = text.lines().nth(k).expect("a row");
            line.split(',').map(|number| number.parse().expect("a number")).collect()
        };
        for k in [1, 900, 2000] {
            for (a, b) in row(&one, k).iter().zip(row(&two, k)) {
                // six standard deviations of the difference of two orientations
                assert!((a - b).abs() < 1e-2, "{preset} {k}: {a} {b}");
            }
        }
        let calibrate = format!("calibrate machine.toml two/recording.csv --motion two/{log} -o two/result");
        bench.run(&calibrate).done();
        let [_, machine] = errors(&bench, "two");
        plausible(preset, &machine);
    }
}

/// A controller that joins way-points by cubic splines: what it does is known exactly.
#[test]
fn a_motion_of_known_way_points_is_known_exactly() {
    let bench = Bench::new();
    let end = "[machine.simulate]";
    let log = format!("[machine.log]\nnoise = 1e-12\nknot_step_s = 0.25\n\n{end}");
    let edits = [("tilt_sd_deg", "trust = \"known\"\ntilt_sd_deg"), (end, &log), SHORT];
    bench.preset("gantry", "known.toml", &edits);
    bench.run("simulate known.toml --seed 3 -o run").done();
    bench.run("calibrate known.toml run/recording.csv --motion run/joints.csv -o run/result").done();
    let [sensor, machine] = errors(&bench, "run");
    plausible("sensor", &sensor);
    plausible("machine", &machine);
    let residual = &bench.json("run/result/calibration.json")["machine"]["sensor_noise"][0];
    let rms = residual["residual_rms"][0].as_f64().expect("a number");
    assert!((rms / 0.01 - 1.0).abs() < 0.05, "{rms}");
}

#[test]
fn joints_move_within_their_limits_and_end_as_they_begin() {
    let bench = Bench::new();
    bench.preset("gantry", "gantry.toml", &[("resolution = 0.0 ", "resolution = 0.001 ")]);
    bench.run("simulate gantry.toml -o run").done();
    let text = bench.read("run/joints.csv");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("t_s,x_m,y_m,z_m"));
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|number| number.parse().expect("a number")).collect()).collect();
    for axis in 1..=3 {
        let positions: Vec<f64> = rows.iter().map(|row| row[axis]).collect();
        let (lowest, highest) =
            positions.iter().fold((0.0_f64, 0.0_f64), |(low, high), p| (low.min(*p), high.max(*p)));
        assert!(lowest > -0.5 && highest < 0.5 && highest - lowest > 0.6, "{lowest} {highest}");
        assert!(positions.iter().all(|p| (p * 1e3 - (p * 1e3).round()).abs() < 1e-9), "steps of 1 mm");
        let ends = positions[..400].iter().chain(&positions[positions.len() - 400..]);
        assert!(ends.copied().all(|p| p == 0.0), "2 s at rest");
        for pair in positions.windows(20) {
            let speed = (pair[19] - pair[0]) / (19.0 / 200.0);
            assert!(speed.abs() < 1.0 + 0.02, "{speed}");
        }
    }
}

/// What `--motion` refuses, and what an experiment lacks.
#[test]
fn what_cannot_be_simulated_is_refused() {
    let bench = Bench::new();
    bench.preset("arm", "arm.toml", &[SHORT]);
    bench.preset("mocap", "body.toml", &[SHORT]);
    let log = |header: &str, rows: usize, step: f64| {
        let values = ",0.1".repeat(header.split(',').count() - 1);
        (0..rows).fold(format!("{header}\n"), |text, k| format!("{text}{}{values}\n", k as f64 * step))
    };
    bench.write(
        "still.urdf",
        r#"<robot name="still"><link name="base"/><link name="tip"/>
        <joint name="glue" type="fixed"><parent link="base"/><child link="tip"/></joint></robot>"#,
    );
    let still = [("urdf = \"arm\" ", "urdf = \"still.urdf\" "), ("tip = \"flange\"", "tip = \"tip\"")];
    bench.preset("arm", "still.toml", &still);
    bench.refuses("simulate still.toml -o out", 2, &["no joint between base and tip moves"]);
    bench.write("gantry.csv", log("t_s,x_m,y_m,z_m", 500, 0.01));
    let joints = "t_s,shoulder_pan_rad,shoulder_lift_rad,elbow_rad,wrist_1_rad,wrist_2_rad,wrist_3_rad";
    bench.write("short.csv", log(joints, 200, 0.01));
    bench.write("few.csv", log(joints, 5, 1.0));
    bench.refuses(
        "simulate arm.toml --motion gantry.csv -o out",
        3,
        &["gantry.csv", "the log lacks the joints"],
    );
    bench.refuses(
        "simulate arm.toml --motion short.csv -o out",
        3,
        &["short.csv", "the log lasts 1.99 s", "delay_sd_s in [machine.clock]"],
    );
    bench.refuses("simulate arm.toml --motion few.csv -o out", 3, &["fewer than 8 samples"]);
    bench.refuses("simulate body.toml --motion gantry.csv -o out", 2, &["[machine] names no machine"]);
    bench.refuses("simulate arm.toml --motion none.csv -o out", 3, &["none.csv"]);

    let edits = [
        ("counts", "unit = \"mps2\" ", "unit = \"counts\" ", "needs `sensor.gain_counts_per_mps2`"),
        (
            "noise",
            "# noise = 2e-5 ",
            "noise = [1e-5, 1e-5] ",
            "machine.log.noise has 2 values, the machine 6 joints",
        ),
        ("brief", "duration_s = 60.0", "duration_s = 1.0", "a number from 10 s"),
        ("unknown", "vibration = 0.0", "vibrations = 0.0", "did you mean `vibration`?"),
        (
            "endless",
            "rate_hz = 200.0              # sample rate of the IMU, Hz (default 200)\nlog",
            "rate_hz = 1e6\nlog",
            "add --force",
        ),
    ];
    for (name, from, to, says) in edits {
        let file = format!("{name}.toml");
        bench.preset("arm", &file, &[(from, to)]);
        if name == "endless" {
            bench.preset("arm", &file, &[(from, to), ("duration_s = 60.0", "duration_s = 1e5")]);
        }
        bench.refuses(&format!("simulate {file} -o out"), 2, &[says]);
    }
    let encoders = [("[machine.simulate] ", "[machine.simulate]\nresolution = 0.1 ")];
    bench.preset("mocap", "encoders.toml", &encoders);
    bench.refuses("simulate encoders.toml -o out", 2, &["without a urdf there are no encoders"]);
}
