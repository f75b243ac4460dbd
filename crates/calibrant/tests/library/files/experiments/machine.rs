//! Tests of `[machine]`: what is known of the machine, and what contradicts itself.

use calibrant::io::{
    Experiment, ExperimentFile, MachinePlan, OrientationForm, Plan, TimeColumns, Urdf, UrdfSource,
    machine_preset, preset,
};
use calibrant::machine::estimate::{MachineSetup, MachineTrust, MountingPrior};
use nalgebra::{UnitQuaternion, Vector3};
use std::path::Path;

/// The least that a machine needs.
const LEAST: &str = "schema = 1\n[sensor]\nkind = \"accelerometer\"\naxes = 3\nmodel = \"full\"\nnoise_mps2 = 0.01\n\
                     [machine]\ngravity_mps2 = 9.81\n";

fn plan(experiment: &Experiment) -> &MachinePlan {
    match &experiment.plan {
        Plan::Machine(plan) => plan,
        other => panic!("{}", other.section()),
    }
}

fn setup(text: &str) -> MachineSetup {
    let experiment = Experiment::parse(text, None).unwrap_or_else(|error| panic!("{error}\n{text}"));
    plan(&experiment).setup(&experiment.sensor, experiment.imu.as_ref(), 2).expect("valid")
}

#[test]
fn what_is_not_said_is_as_the_estimator_expects() {
    assert_eq!(setup(LEAST), MachineSetup { gravity_mps2: 9.81, ..MachineSetup::default() });
    let text = preset("arm").expect("known").replace("# gravity_mps2 = 9.80665", "gravity_mps2 = 9.81");
    assert_eq!(setup(&text), setup(LEAST), "the preset states the defaults");
}

#[test]
fn the_columns_of_the_log_arrive_at_its_reader() {
    let text = format!(
        "{LEAST}[machine.log]\ntopic = \"imu\"\n[machine.log.columns]\ntime = [\"sec\", \"nanosec\"]\nposition_unit = \"mm\"\norientation = [\"a\", \"b\", \"c\"]\n\
         orientation_is = \"intrinsic-zyx\"\norientation_unit = \"deg\"\n"
    );
    let options = plan(&Experiment::parse(&text, None).expect("valid")).log_options();
    assert!(options.poses && options.topic.as_deref() == Some("imu"));
    assert_eq!(options.columns.orientation_is, OrientationForm::parse("intrinsic-zyx"));
    assert_eq!(options.columns.time, Some(TimeColumns(vec!["sec".into(), "nanosec".into()])));
    let again = ExperimentFile::parse(&text, None).expect("valid").to_toml();
    assert_eq!(plan(&Experiment::parse(&again, None).expect(&again)).log_options(), options);
    let arm = preset("arm").expect("known").replace("# joints = {", "joints = {");
    let options = plan(&Experiment::parse(&arm, None).expect("valid")).log_options();
    assert!(!options.poses && options.columns.joints.is_some());
}

#[test]
fn every_key_arrives_in_si() {
    let text = format!(
        "{LEAST}urdf = \"arms/two.urdf\"\nbase = \"b\"\ntip = \"t\"\ntrust = \"known\"\nup = \"-y\"\ntilt_sd_deg = 1\nsensor_noise = \"datasheet\"\n\
         [machine.mount]\nlever_m = [0.1, 0, -0.2]\nlever_sd_m = 0.01\nrotation = [0, 0, 90]\nrotation_sd_deg = 0\n\
         [machine.clock]\ndelay_s = 0.5\ndelay_sd_s = 0.1\ndelay_difference_sd_s = 0\nrate_sd_ppm = 50\n\
         [machine.geometry]\ntranslation_sd_m = 1e-3\nrotation_sd_rad = 2e-3\nzero_sd = 3e-3\n\
         [machine.log]\nnoise = 1e-5\nknot_step_s = 0.1\n"
    );
    let found = setup(&text);
    let expected = MachineSetup {
        trust: MachineTrust::Known,
        gravity_mps2: 9.81,
        up: -Vector3::y(),
        tilt_sd_rad: 1_f64.to_radians(),
        lever_m: Vector3::new(0.1, 0.0, -0.2),
        lever_sd_m: 0.01,
        tip_from_sensor: found.tip_from_sensor,
        mounting: MountingPrior::Exact,
        delay_s: 0.5,
        delay_sd_s: 0.1,
        delay_difference_sd_s: 0.0,
        clock_rate_sd: 50e-6,
        geometry_translation_sd_m: 1e-3,
        geometry_rotation_sd_rad: 2e-3,
        zero_sd: 3e-3,
        knot_step_s: Some(0.1),
        accelerometer_noise: Some(Vector3::repeat(0.01)),
        reference_noise: Some(vec![1e-5; 2]),
        ..MachineSetup::default()
    };
    assert_eq!(found, expected);
    let quarter = UnitQuaternion::from_scaled_axis(Vector3::z() * std::f64::consts::FRAC_PI_2);
    assert!(found.tip_from_sensor.angle_to(&quarter) < 1e-12);
    let wxyz = text.replace("[0, 0, 90]", "[0.7071067811865476, 0, 0, 0.7071067811865476]");
    assert!(setup(&wxyz).tip_from_sensor.angle_to(&quarter) < 1e-12);

    let experiment = Experiment::parse(&text, Some(Path::new("cell/arm.toml"))).expect("valid");
    let machine = plan(&experiment);
    assert_eq!(machine.urdf, Some(UrdfSource::File(Path::new("cell/arms/two.urdf").into())));
    assert_eq!((machine.base.as_deref(), machine.tip.as_deref()), (Some("b"), Some("t")));
}

#[test]
fn noise_of_poses_has_six_components() {
    let text = format!("{LEAST}[machine.log]\nposition_noise_m = 1e-4\norientation_noise_rad = 2e-3\n");
    assert_eq!(setup(&text).reference_noise, Some([[1e-4; 3], [2e-3; 3]].concat()));
}

#[test]
fn the_machines_of_the_presets_are_built_in() {
    for name in ["arm", "rate-table", "gantry"] {
        let experiment = Experiment::parse(preset(name).expect("known"), None).expect("valid");
        let machine = plan(&experiment);
        assert_eq!(machine.urdf, Some(UrdfSource::Preset(name)));
        let chain = machine.kinematic_chain().expect("joints").expect("a machine");
        assert!(!chain.joints.is_empty());
    }
    let mocap = Experiment::parse(preset("mocap").expect("known"), None).expect("valid");
    assert!(!plan(&mocap).has_joints());
}

#[test]
fn a_machine_that_is_built_in_code_stands_in_place_of_a_file() {
    let arm = Urdf::parse(machine_preset("arm").expect("known").as_bytes()).expect("a machine");
    let chain = arm.chain(None, None).expect("joints");
    let mut file = ExperimentFile::preset("arm").expect("known");
    let of_file = file.experiment().expect("valid");
    let machine = file.machine.as_mut().expect("on a machine");
    (machine.urdf, machine.base, machine.tip) = (None, None, None);
    assert!(file.experiment().is_err(), "its geometry needs joints");
    file.machine.as_mut().expect("on a machine").chain = Some(Box::new(chain.clone()));
    let built = file.experiment().expect("valid");
    assert_eq!(plan(&built).kinematic_chain().expect("built"), Some(chain));
    let setup = |of: &Experiment| plan(of).setup(&of.sensor, of.imu.as_ref(), 6).expect("valid");
    assert_eq!(setup(&built), setup(&of_file));
}

/// Lines after those of [`LEAST`], and what is said of them.
const WRONG: &[(&str, &str)] = &[
    ("urdf = \"rate_table\"", "did you mean \"rate-table\"?"),
    ("urdf = \"robot\"", "no machine \"robot\" is built in"),
    ("tip = \"flange\"", "this needs a machine"),
    ("trust = \"unknown\"", "one of \"noisy\", \"known\""),
    ("tilt_sd_rad = 0.01", "did you mean `tilt_sd_deg`?"),
    ("lever_m = [0, 0, 0]", "`lever_m` belongs in [machine.mount]"),
    ("latitude_deg = 45", "gravity is given twice"),
    ("[machine.mount]\nlever_m = [100, 0, 0]", "100.0 is out of range"),
    ("[machine.mount]\nlever_m = [1, 0]", "a lever arm has three numbers, this has 2"),
    ("[machine.mount]\nrotation = [1, 1, 0, 0]", "the norm of this quaternion is 1.4142, not 1"),
    ("[machine.mount]\nrotation = [1, 1]", "a rotation has three or four numbers, this has 2"),
    ("[machine.mount]\nrotation = \"free\"", "write \"unknown\""),
    (
        "[machine.mount]\nrotation = \"unknown\"\nrotation_sd_deg = 1",
        "an unknown rotation has no standard deviation",
    ),
    ("[machine.geometry]\nzero_sd = 0.0", "without a urdf there are no joints"),
    ("urdf = \"arm\"\n[machine.geometry]\nrotation_sd_rad = 0.5", "0.1 rad is 5.7°"),
    ("urdf = \"arm\"\n[machine.log]\nposition_noise_m = 1e-4", "a log of joints has no poses"),
    ("[machine.log]\nnoise = 1e-4", "without a urdf the log has poses"),
    ("[machine.log]\nposition_noise_m = 1e-4", "`machine.log.orientation_noise_rad`"),
    (
        "[machine.log.columns]\norientation = [\"roll\", \"pitch\", \"yaw\"]",
        "nothing says what these columns of an orientation are",
    ),
    ("[machine.log.columns]\norientation_is = \"euler-zyx\"", "\"euler-zyx\" is not known here"),
    ("[machine.log.columns]\nposition = [\"x\", \"y\", \"x\"]", "the column `x` is named twice"),
    ("[machine.log.columns]\ntime = 3", "the name of a column, or two is needed here, not a whole number"),
    ("[machine.log.columns]\njoints = { a = \"q1\" }", "without a urdf the log has poses"),
    (
        "urdf = \"arm\"\n[machine.log.columns]\nposition = [\"x\", \"y\", \"z\"]",
        "the log of a machine has joints",
    ),
    ("[holds]\ngravity_mps2 = 9.81\ngauge = \"lower\"", "[holds] and [machine] are both there"),
    ("[motion]\nintervals = 2\ninterval_s = 1\nrate_hz = 10", "[motion] and [machine] are both there"),
    ("[gyroscope]", "only an IMU has a gyroscope"),
    ("[calibrate]\nprior = \"datasheet\"", "\"datasheet\" needs bias_sd_mps2"),
];

#[test]
fn contradictions_point_at_their_line() {
    for (lines, says) in WRONG {
        let text = format!("{LEAST}{lines}\n");
        let error = Experiment::parse(&text, None).expect_err(lines);
        assert!(error.is_invalid_experiment() && error.to_string().contains(says), "{lines}: {error}");
        let line = error.input_error().and_then(|input_error| input_error.line).expect("a line");
        assert!(line >= 7, "{lines}: {error}");
    }
    for (change, says) in [
        (("model = \"full\"", "model = \"scale-bias\"\n"), "an unknown mounting needs the full model"),
        (("axes = 3", "axes = 1"), ""),
        (("noise_mps2 = 0.01\n", ""), "\"datasheet\" needs noise_mps2"),
    ] {
        let more = "sensor_noise = \"datasheet\"\n[machine.mount]\nrotation = \"unknown\"\n";
        let text = format!("{LEAST}{more}").replacen(change.0, change.1, 1);
        let error = Experiment::parse(&text, None).expect_err(says).to_string();
        assert!(error.contains(says), "{says}: {error}");
    }
    let imu = preset("arm").expect("known");
    for (change, says) in [
        (("g_sensitivity = false", "turns = []"), "turns are not read with [machine]"),
        (("[columns]", "[temperature]\n[columns]"), "[temperature] is not read with [machine]"),
        (("\"residuals\"", "\"datasheet\""), "\"datasheet\" needs noise_mps2"),
    ] {
        let imu = imu.replace("\nnoise_", "\n# noise_");
        let error =
            Experiment::parse(&imu.replacen(change.0, change.1, 1), None).expect_err(says).to_string();
        assert!(error.contains(says), "{says}: {error}");
    }
}
