//! `calibrate` with a [machine] experiment: a rate table, an arm of two joints, a gantry, a tracked body, and what is refused.

use crate::bench::Bench;
use calibrant::io::{Urdf, machine_preset};
use calibrant::machine::chain::{FrameMotion, JointState, KinematicChain};
use nalgebra::{UnitQuaternion, Vector3};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use std::fmt::Write;

/// Gravity, m/s².
const GRAVITY: f64 = 9.80665;
/// Rate of the recording, Hz.
const RATE_HZ: f64 = 100.0;
/// Duration of the log, s. The recording begins later and ends earlier.
const LOG_S: f64 = 22.0;
/// Motion time less IMU time, s.
const DELAY_S: f64 = 0.004;

/// Two joints: one about the vertical, and one about a horizontal axis 0.3 m from it.
const TWO_JOINTS: &str = r#"<robot name="two">
  <link name="base"/>
  <joint name="pan" type="continuous"><parent link="base"/><child link="post"/><axis xyz="0 0 1"/></joint>
  <link name="post"/>
  <joint name="lift" type="continuous">
    <parent link="post"/><child link="fork"/><origin xyz="0.3 0 0.2"/><axis xyz="0 1 0"/>
  </joint>
  <link name="fork"/>
</robot>
"#;

/// A machine that moves, and the sensor on it.
struct Rig {
    chain: KinematicChain,
    /// Amplitude of the first of two sines of each joint, rad or m.
    amplitude: f64,
    lever_m: Vector3<f64>,
    tip_from_sensor: UnitQuaternion<f64>,
}

impl Rig {
    fn two_joints() -> Self {
        let chain =
            Urdf::parse(TWO_JOINTS.as_bytes()).expect("a machine").chain(None, None).expect("a chain");
        let lever_m = Vector3::new(0.101, 0.02, -0.03);
        Self { chain, amplitude: 1.4, lever_m, tip_from_sensor: UnitQuaternion::identity() }
    }

    fn preset(name: &str, amplitude: f64) -> Self {
        let text = machine_preset(name).expect("built in");
        let chain = Urdf::parse(text.as_bytes()).expect("a machine").chain(None, None).expect("a chain");
        Self { chain, amplitude, lever_m: Vector3::zeros(), tip_from_sensor: UnitQuaternion::identity() }
    }

    /// Position, velocity and acceleration of a joint.
    fn joint(&self, joint: usize, t: f64) -> [f64; 3] {
        let sines =
            [(1.0, 2.1), (0.3, 5.3)].map(|(part, rate)| (part * self.amplitude, rate + 0.7 * joint as f64));
        let sum = |of: &dyn Fn(f64, f64) -> f64| sines.iter().map(|(a, w)| of(*a, *w)).sum::<f64>();
        let phase = joint as f64;
        [
            sum(&|a, w| a * (w * t + phase).sin()),
            sum(&|a, w| a * w * (w * t + phase).cos()),
            sum(&|a, w| -a * w * w * (w * t + phase).sin()),
        ]
    }

    /// Specific force and rate of the sensor.
    fn felt(&self, t: f64) -> (Vector3<f64>, Vector3<f64>) {
        let states: Vec<[f64; 3]> = (0..self.chain.joints.len()).map(|j| self.joint(j, t)).collect();
        let column = |k: usize| states.iter().map(|state| state[k]).collect::<Vec<f64>>();
        let [positions, velocities, accelerations] = [column(0), column(1), column(2)];
        let state =
            JointState { positions: &positions, velocities: &velocities, accelerations: &accelerations };
        let base = FrameMotion::at_rest(&Vector3::new(0.0, 0.0, -GRAVITY));
        let tip = self.chain.nominal().tip_motion(state, &base);
        let force = tip.specific_force + tip.force_gradient() * self.lever_m;
        let turn = self.tip_from_sensor.inverse();
        (turn * force, turn * tip.rate)
    }

    /// Writes joints.csv and recording.csv: a bias of 0.05 m/s² and 0.01 rad/s on x, a scale factor of 1.002 on z of both sensors.
    fn record(&self, bench: &Bench, with_gyroscope: bool) {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let mut noise = move |sd: f64| -> f64 { sd * Distribution::<f64>::sample(&StandardNormal, &mut rng) };
        let joints = &self.chain.joints;
        let mut log = String::from("t_s");
        joints.iter().for_each(|joint| write!(log, ",{}_{}", joint.name, joint.kind.unit()).expect("text"));
        for k in 0..(LOG_S * 200.0) as usize {
            let t = k as f64 / 200.0;
            write!(log, "\n{t}").expect("text");
            (0..joints.len())
                .for_each(|j| write!(log, ",{}", self.joint(j, t)[0] + noise(2e-5)).expect("text"));
        }
        bench.write("joints.csv", log + "\n");
        let mut text = String::from("t_s,acc_x_mps2,acc_y_mps2,acc_z_mps2");
        text.push_str(if with_gyroscope { ",gyro_x_radps,gyro_y_radps,gyro_z_radps" } else { "" });
        for k in 0..((LOG_S - 2.0) * RATE_HZ) as usize {
            let t = 1.0 + k as f64 / RATE_HZ;
            let (force, rate) = self.felt(t + DELAY_S);
            let read = |s: Vector3<f64>, bias: f64| Vector3::new(s.x + bias, s.y, 1.002 * s.z);
            write!(text, "\n{t}").expect("text");
            read(force, 0.05).iter().for_each(|y| write!(text, ",{}", y + noise(5e-3)).expect("text"));
            if with_gyroscope {
                read(rate, 0.01).iter().for_each(|y| write!(text, ",{}", y + noise(1e-3)).expect("text"));
            }
        }
        bench.write("recording.csv", text + "\n");
    }
}

/// The arm of two joints in arm.toml, two.urdf, joints.csv and recording.csv.
fn two_joint_bench() -> Bench {
    let bench = Bench::new();
    bench.write("two.urdf", TWO_JOINTS);
    let edits = [
        ("urdf = \"arm\" ", "urdf = \"two.urdf\" "),
        ("tip = \"flange\"", "tip = \"fork\""),
        ("lever_m = [0.0, 0.0, 0.0]", "lever_m = [0.1, 0.02, -0.03]"),
    ];
    bench.preset("arm", "arm.toml", &edits);
    Rig::two_joints().record(&bench, true);
    bench
}

/// Value and standard deviation of a quantity of calibration.json: a parameter of the sensor, or of the machine.
fn estimate(calibration: &serde_json::Value, name: &str) -> (f64, f64) {
    let lists = [&calibration["parameters"], &calibration["machine"]["quantities"]];
    let found = lists.into_iter().flat_map(|list| list.as_array().expect("a list"));
    let found = found.clone().find(|entry| entry["name"] == name).unwrap_or_else(|| panic!("no {name}"));
    (found["value"].as_f64().expect("a number"), found["sd"].as_f64().expect("a number"))
}

/// Each quantity must be within four standard deviations, and these must be small.
fn finds(bench: &Bench, file: &str, expected: &[(&str, f64, f64)]) {
    let calibration = bench.json(file);
    for (name, truth, largest_sd) in expected {
        let (value, sd) = estimate(&calibration, name);
        assert!(
            (value - truth).abs() < 4.0 * sd && sd < *largest_sd,
            "{name}: {value} ± {sd}, truth {truth}"
        );
    }
}

#[test]
fn an_arm_of_two_joints_calibrates_an_imu() {
    let bench = two_joint_bench();
    let outcome = bench.run("calibrate arm.toml recording.csv --motion joints.csv -o out").done();
    for words in [
        "status converged",
        "samples were used, 100 % of all",
        ", noise from the residuals",
        "accelerometer.bias.x",
        "lever.x",
        "expected ± prior sd",
        "14 corrections of the joints, the largest ",
        "variance from, %",
        "sd of a sample",
    ] {
        assert!(outcome.printed().contains(words), "{words}\n{}", outcome.stdout);
    }
    finds(
        &bench,
        "out/calibration.json",
        &[
            ("accelerometer.bias.x", 0.05, 2e-3),
            ("accelerometer.scale.z", 1.002, 5e-4),
            ("gyroscope.bias.x", 0.01, 1e-4),
            ("gyroscope.scale.z", 1.002, 5e-4),
            ("lever.x", 0.101, 1e-3),
            ("delay.gyroscope", DELAY_S, 1e-4),
        ],
    );
    let machine = &bench.json("out/calibration.json")["machine"];
    assert_eq!((machine["trust"].as_str(), machine["base"].as_str()), (Some("noisy"), Some("base")));
    assert_eq!(machine["budget"]["shares"].as_array().map(Vec::len), Some(24));
    let total: f64 =
        machine["budget"]["shares"][0].as_array().expect("shares").iter().filter_map(|s| s.as_f64()).sum();
    assert!((total - 1.0).abs() < 1e-9, "{total}");
}

#[test]
fn other_commands_read_the_calibration_on_a_machine() {
    let bench = two_joint_bench();
    bench.run("calibrate arm.toml recording.csv --motion joints.csv -o out").done();
    bench.run("apply out/calibration.json recording.csv -o corrected.csv").done();
    bench.run("convert out/calibration.json kalibr.yaml --to kalibr").done();
    bench.run("compare out/calibration.json out/calibration.json").done();
}

#[test]
fn several_recordings_share_the_log() {
    let bench = two_joint_bench();
    let second = |(k, line): (usize, &str)| if k == 0 { format!("{line}\n") } else { format!("{line}1\n") };
    bench
        .write("second.csv", bench.read("recording.csv").lines().enumerate().map(second).collect::<String>());
    let outcome = bench.run("calibrate arm.toml recording.csv second.csv --motion joints.csv -o out").done();
    assert!(outcome.printed().contains("2 calibrated, 0 failed"), "{}", outcome.stdout);
    assert!(bench.read("out/summary.csv").contains("used_share"), "{}", bench.read("out/summary.csv"));
}

#[test]
fn a_rate_table_calibrates_biases_and_scale_factors() {
    let bench = Bench::new();
    bench.preset("rate-table", "table.toml", &[]);
    let tip_from_sensor =
        UnitQuaternion::from_scaled_axis(Vector3::new(38.704, -38.704, 0.0).map(f64::to_radians));
    let rig =
        Rig { lever_m: Vector3::new(0.12, 0.0, 0.03), tip_from_sensor, ..Rig::preset("rate-table", 2.0) };
    rig.record(&bench, true);
    bench.run("calibrate table.toml recording.csv --motion joints.csv -o out").done();
    finds(
        &bench,
        "out/calibration.json",
        &[("gyroscope.scale.z", 1.002, 0.02), ("gyroscope.bias.x", 0.01, 2e-4)],
    );

    let text = bench.read("table.toml").replace("model = \"scale-bias\"", "model = \"full\"");
    bench.write("full.toml", text);
    bench.refuses(
        "calibrate full.toml recording.csv --motion joints.csv -o full",
        4,
        &["not-identifiable", "gyroscope.matrix"],
    );
}

#[test]
fn a_gantry_calibrates_an_accelerometer() {
    let bench = Bench::new();
    bench.preset("gantry", "gantry.toml", &[]);
    Rig::preset("gantry", 0.1).record(&bench, false);
    bench.run("calibrate gantry.toml recording.csv --motion joints.csv -o out").done();
    finds(
        &bench,
        "out/calibration.json",
        &[("accelerometer.scale.z", 1.002, 1e-3), ("accelerometer.bias.x", 0.05, 0.05)],
    );
    // the truth of a simulation has the fixed values of a gyroscope that is not there
    bench.run("simulate gantry.toml -o simulated").done();
    bench.run("calibrate gantry.toml simulated/recording.csv --motion simulated/joints.csv -o found").done();
    bench.run("compare simulated/truth.json found/calibration.json").done();
}

/// What one axis does not move is refused by name, and the remedy leads to a result: the moved column from the data, the rest from the datasheet.
#[test]
fn a_gantry_of_one_axis_takes_the_rest_from_the_datasheet() {
    let bench = Bench::new();
    bench.preset("gantry", "bare.toml", &[("# tip = ", "tip = ")]);
    let urdf = Urdf::parse(machine_preset("gantry").expect("built in").as_bytes()).expect("a machine");
    let chain = urdf.chain(None, Some("bridge")).expect("a chain");
    Rig { chain, ..Rig::preset("gantry", 0.1) }.record(&bench, false);
    let calibrate = |file: &str| format!("calibrate {file} recording.csv --motion joints.csv -o out");
    bench.refuses(&calibrate("bare.toml"), 4, &["not-identifiable", "prior = \"datasheet\" in [calibrate]"]);
    let spreads = "unit = \"mps2\"\nbias_sd_mps2 = 0.1\nscale_sd = 0.005\ncross_axis_sd = 0.01";
    let text = bench.read("bare.toml").replace("unit = \"mps2\"", spreads);
    bench.write("prior.toml", text + "\n[calibrate]\nprior = \"datasheet\"\n");
    bench.run(&calibrate("prior.toml")).done();
    finds(
        &bench,
        "out/calibration.json",
        &[
            ("accelerometer.scale.x", 1.0, 1e-3),
            ("accelerometer.matrix.yx", 0.0, 1e-3),
            ("accelerometer.scale.z", 1.002, 0.006),
        ],
    );
    let calibration = bench.json("out/calibration.json");
    assert!((estimate(&calibration, "accelerometer.scale.y").1 / 0.005 - 1.0).abs() < 1e-3);
    assert_eq!(calibration["prior"], "datasheet");
    let scale_y = &calibration["parameters"][4];
    assert_eq!(scale_y["name"], "accelerometer.scale.y");
    assert!(scale_y["prior_share"].as_f64().is_some_and(|share| share > 0.99), "{scale_y}");
    // rows and columns of the budget: scale.y is the fifth parameter, what was known of the sensor the last source
    let budget = &calibration["machine"]["budget"];
    assert_eq!(budget["sources"].as_array().and_then(|of| of.last()?.as_str()), Some("sensor_prior"));
    let share = budget["shares"][4].as_array().and_then(|of| of.last()?.as_f64());
    assert!(share.is_some_and(|share| share > 0.99), "{share:?}");
}

#[test]
fn what_does_not_fit_is_refused() {
    let bench = two_joint_bench();
    bench.refuses(
        "calibrate arm.toml recording.csv -o out",
        2,
        &["needs the log of the machine's motion", "--motion FILE"],
    );
    let second = |(k, line): (usize, &str)| if k == 0 { format!("{line}\n") } else { format!("{line}1\n") };
    bench
        .write("second.csv", bench.read("recording.csv").lines().enumerate().map(second).collect::<String>());
    bench.refuses(
        "calibrate arm.toml recording.csv --motion joints.csv --validate second.csv -o out",
        2,
        &["--validate-motion FILE"],
    );
    for folds in [1, 60] {
        bench.refuses(
            &format!("calibrate arm.toml recording.csv --motion joints.csv --folds {folds} -o out"),
            2,
            &["choose between 2 and 19"],
        );
    }
    let joints = bench.read("joints.csv");
    bench.write("other.csv", joints.replace("lift_rad", "liftt_rad"));
    bench.refuses(
        "calibrate arm.toml recording.csv --motion other.csv -o out",
        3,
        &["other.csv", "the log lacks the joint `lift` (is `liftt` meant?)"],
    );
    let late: String = joints
        .lines()
        .map(|line| match line.split_once(',') {
            Some((t, rest)) if t != "t_s" => {
                format!("{},{rest}\n", 1000.0 + t.parse::<f64>().expect("a time"))
            }
            _ => format!("{line}\n"),
        })
        .collect();
    bench.write("late.csv", late);
    bench.refuses("calibrate arm.toml recording.csv --motion late.csv -o out", 3, &["machine-unsolved"]);
    bench.write("missing.toml", bench.read("arm.toml").replace("two.urdf", "three.urdf"));
    bench.refuses(
        "calibrate missing.toml recording.csv --motion joints.csv -o out",
        2,
        &["three.urdf", "file-unreadable"],
    );
    bench.write(
        "poses.toml",
        bench.read("arm.toml").replace("urdf = ", "# ").replace("base = ", "# ").replace("tip = ", "# "),
    );
    bench.refuses(
        "calibrate poses.toml recording.csv --motion joints.csv -o out",
        2,
        &["without a urdf there are no joints"],
    );
}

#[test]
fn angles_in_degrees_that_are_called_radians_are_refused() {
    let bench = two_joint_bench();
    let joints = bench.read("joints.csv");
    let in_degrees: String = joints
        .lines()
        .map(|line| match line.split_once(',') {
            Some((t, rest)) if t != "t_s" => {
                let degrees =
                    rest.split(',').map(|q| q.parse::<f64>().expect("an angle").to_degrees().to_string());
                format!("{t},{}\n", degrees.collect::<Vec<_>>().join(","))
            }
            _ => format!("{line}\n"),
        })
        .collect();
    bench.write("degrees.csv", in_degrees);
    bench.refuses(
        "calibrate arm.toml recording.csv --motion degrees.csv -o out",
        3,
        &["the gyroscope reads 0.017 times the rate of the log's motion", "degrees or radians"],
    );
}
