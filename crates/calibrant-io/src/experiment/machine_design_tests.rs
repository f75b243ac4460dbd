//! `[machine.limits]`, `[machine.world]` and `[machine.design]`: where each number is from, and what is wrong with broken ones.

use super::presets::preset;
use super::{Dwells, Experiment, LinksKnown, MachineDesignPlan};
use calibrant_core::error::Result;
use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::Path;

fn design(text: &str, beside: Option<&Path>) -> Result<MachineDesignPlan> {
    Experiment::parse(text, beside)?.machine_design()
}

/// The preset of an arm with one text replaced.
fn arm_with(old: &str, new: &str) -> String {
    let text = preset("arm").expect("known");
    assert!(text.contains(old), "{old}");
    text.replacen(old, new, 1)
}

#[test]
fn the_presets_can_be_designed_for() {
    for (name, joints) in [("arm", 6), ("rate-table", 1), ("gantry", 3)] {
        let plan =
            design(preset(name).expect("known"), None).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(plan.limits.joints.len(), joints);
        assert!(
            plan.limits.joints.iter().all(|of| of.acceleration.is_finite() && of.jerk.is_finite()),
            "{name}"
        );
        assert_eq!((plan.duration_s, plan.knot_s, plan.dwells), (20.0, 0.2, Dwells::Auto));
    }
    let arm = design(preset("arm").expect("known"), None).expect("valid");
    assert_eq!(arm.world.links, LinksKnown::Shapes);
    assert_eq!(arm.world.scene.bodies.len(), 8, "seven links and the sensor");
    // a sample's standard deviation is N √rate
    assert!((arm.force_density * 200.0_f64.sqrt() - 0.01).abs() < 1e-15);
    assert_eq!(arm.limits.joints[0].velocity, PI, "of the urdf");
}

#[test]
fn a_number_for_all_joints_is_a_cap_and_a_table_stands_in_the_place_of_all_else() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let limits = "joint_limits:\n  elbow: {has_acceleration_limits: true, max_acceleration: 3.0, has_jerk_limits: true, max_jerk: 20.0, has_velocity_limits: true, max_velocity: 2.0, position_based_velocity_limits: {velocity_offset: 0.3, deceleration_limit: 6.0}}\n";
    std::fs::write(directory.path().join("joint_limits.yaml"), limits).expect("written");
    let text = arm_with("# joint_limits =", "joint_limits =")
        .replace("# position = { elbow = [-2.6, 2.6] }", "position = { elbow = [-2.6, 2.6] }")
        .replace("# velocity = 2.98 ", "velocity = { wrist_3 = 9.0 } ")
        .replace("# range_radps = 17.4 ", "range_degps = 180.0 ");
    let path = directory.path().join("arm.toml");
    let plan = design(&text, Some(&path)).unwrap_or_else(|error| panic!("{error}"));
    let [pan, elbow, wrist] = [0, 2, 5].map(|k| plan.limits.joints[k]);
    assert_eq!((pan.acceleration, pan.jerk, pan.velocity, pan.upper), (5.0, 50.0, PI, 2.0 * PI));
    assert_eq!((elbow.acceleration, elbow.jerk, elbow.velocity, elbow.upper), (3.0, 20.0, 2.0, 2.6));
    assert_eq!(elbow.near_ends.map(|of| (of.slope, of.offset, of.upper)), Some((12.0, 0.3, 2.6)));
    assert_eq!(wrist.velocity, 9.0);
    assert!((plan.rate_range_radps.x - PI).abs() < 1e-15);
    let notes = |plan: &MachineDesignPlan| -> Vec<String> {
        let all = plan.limits.notes.iter().chain(&plan.world.notes);
        all.map(|note| note.message().to_owned()).collect()
    };
    let found = notes(&plan);
    assert!(found.len() == 1 && found[0].contains("`wrist_3`"), "{found:?}");
    assert!(found[0].contains("speed 9 rad/s, in the URDF file 3.142 rad/s"), "{found:?}");

    // MoveIt's own factors, and wider positions
    let scaled =
        format!("default_velocity_scaling_factor: 0.5\ndefault_acceleration_scaling_factor: 0.1\n{limits}");
    std::fs::write(directory.path().join("joint_limits.yaml"), scaled).expect("written");
    let wider = text.replace("[-2.6, 2.6]", "[-20.0, 2.6]").replace("{ wrist_3 = 9.0 }", "{ wrist_3 = 3.0 }");
    let plan = design(&wider, Some(&path)).unwrap_or_else(|error| panic!("{error}"));
    let [pan, elbow, wrist] = [0, 2, 5].map(|k| plan.limits.joints[k]);
    assert_eq!((pan.velocity, pan.acceleration, wrist.velocity), (PI / 2.0, 5.0, 3.0));
    assert_eq!((elbow.velocity, elbow.acceleration, elbow.lower), (1.0, 0.1 * 3.0, -20.0));
    let found = notes(&plan);
    assert!(
        found.len() == 2 && found[1].contains("0.500 of each speed, 0.100 of each acceleration"),
        "{found:?}"
    );
    assert!(
        found[0].contains("`elbow`")
            && found[0].contains("from -20 to 2.6 rad, in the URDF file from -3.142"),
        "{found:?}"
    );
    let broken = format!("default_velocity_scaling_factor: 2.0\n{limits}");
    std::fs::write(directory.path().join("joint_limits.yaml"), broken).expect("written");
    let refused = design(&text, Some(&path)).expect_err("twice as fast").to_string();
    assert!(
        refused.contains(
            "joint_limits.yaml:1: `default_velocity_scaling_factor`: 2 is not above 0 and at most 1"
        ),
        "{refused}"
    );
}

#[test]
fn a_file_of_pairs_of_another_machine_is_noticed() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let path = directory.path().join("arm.toml");
    let text = arm_with("# srdf =", "srdf =");
    let pair = |one: &str| format!("<disable_collisions link1='{one}' link2='forearm' reason='Never'/>");
    let found = |robot: &str, links: &[&str]| -> Vec<String> {
        let pairs: String = links.iter().map(|link| pair(link)).collect();
        let file = format!("<robot name='{robot}'>{pairs}</robot>");
        std::fs::write(directory.path().join("arm.srdf"), file).expect("written");
        let plan = design(&text, Some(&path)).unwrap_or_else(|error| panic!("{error}"));
        plan.world.notes.iter().map(|note| note.message().to_owned()).collect()
    };
    assert_eq!(found("arm", &["base", "upper_arm"]), Vec::<String>::new());
    let other = found("picker", &["base", "left_finger"]);
    assert!(other.len() == 1 && other[0].contains("of the robot `picker`"), "{other:?}");
    assert!(other[0].contains("`left_finger`") && !other[0].contains("`base`"), "{other:?}");
}

#[test]
fn capsules_of_links_and_boxes_stand_where_the_file_puts_them() {
    let text = arm_with("# capsules = { forearm =", "capsules = { forearm =")
        .replace("# boxes = [{", "floor_m = -0.1\nboxes = [{");
    let plan = design(&text, None).unwrap_or_else(|error| panic!("{error}"));
    let around = &plan.world.scene;
    let forearm = around.bodies.iter().find(|body| body.name == "forearm").expect("there");
    assert_eq!((forearm.frame, forearm.capsules[0].radius_m), (3, 0.07));
    assert_eq!((around.floor_m, around.boxes.len()), (Some(-0.1), 1));
    assert_eq!(around.boxes[0].half_m.x, 0.15);
}

#[test]
fn broken_designs_name_key_and_remedy() {
    let mut wrong = String::new();
    for (old, new, wanted) in [
        (
            "acceleration = 5.0           # largest acceleration, ",
            "# ",
            "`machine.limits.acceleration`: this required key is missing (URDF has none (shoulder_pan, shoulder_lift, elbow, wrist_1, wrist_2, wrist_3): acceleration = 5.0 in [machine.limits]",
        ),
        (
            "acceleration = 5.0           # largest acceleration, ",
            "acceleration = 0.0 # ",
            "line 67, column 16: `machine.limits.acceleration`: 0.0 is out of range",
        ),
        (
            "# velocity = 2.98 ",
            "velocity = { elbo = 2.0 } ",
            "`machine.limits.velocity.elbo`: the chain has no joint `elbo` (did you mean `elbow`?",
        ),
        (
            "# position = { elbow = [-2.6, 2.6] }",
            "position = [2.6, -2.6]",
            "`machine.limits.position`: 2.6 is not below -2.6 (exchange them)",
        ),
        (
            "# position = { elbow = [-2.6, 2.6] }",
            "position = { elbow = [2.6] }",
            "`machine.limits.position.elbow`: 1 numbers are not two",
        ),
        (
            "# position = { elbow = [-2.6, 2.6] }",
            "position = [7.0, 8.0]",
            "`machine.limits.position`: nothing is left to `shoulder_pan` between 7 and 6.28",
        ),
        (
            "# position = { elbow = [-2.6, 2.6] }",
            "position = 2.6",
            "`machine.limits.position`: a table or an array is needed here, not a number",
        ),
        (
            "# joint_limits = \"joint_limits.yaml\"",
            "joint_limits = \"none.yaml\"",
            "cannot read joint_limits.yaml",
        ),
        (
            "# home = [0.0, -1.57, -1.57, -1.57, 1.57, 0.0]",
            "home = [0.0, -1.57]",
            "`machine.design.home`: 2 positions for 6 joints",
        ),
        (
            "# home = [0.0, -1.57, -1.57, -1.57, 1.57, 0.0]",
            "home = [0, 0, 3.2, 0, 0, 0]",
            "`machine.design.home`: `elbow` is at 3.2 rad, and may be from -3.14",
        ),
        ("dwells = \"auto\"", "dwells = \"som\"", "`machine.design.dwells`: \"som\" is not known here"),
        ("dwells = \"auto\"", "dwells = -1", "`machine.design.dwells`: -1 is out of range"),
        ("knot_s = 0.2", "knot_s = 0.0", "`machine.design.knot_s`: 0.0 is out of range"),
        ("moving_noise = 1.0", "moving_noise = 0.5", "`machine.design.moving_noise`: 0.5 is out of range"),
        (
            "duration_s = 20.0            # duration of the t",
            "duration_s = 0.0 # ",
            "`machine.design.duration_s`: 0.0 is out of range",
        ),
        (
            "# boxes = [{ center_m = [0.45, 0.35, 0.2], half",
            "boxes = [{ center_m = [0.45, 0.35], half",
            "`machine.world.boxes[0].center_m`: this has 2 numbers, not three",
        ),
        (
            "# boxes = [{ center_m = [0.45, 0.35, 0.2], half_m = [0.15",
            "boxes = [{ center_m = [0.45, 0.35, 0.2], half_m = [-0.15",
            "`machine.world.boxes[0].half_m[0]`: -0.15 is out of range",
        ),
        (
            "center_m = [0.0, 0.0, 0.025], radius_m = 0.05",
            "center_m = [0.0, 0.0, 0.025]",
            "`machine.world.sensor_body.radius_m`: this required key is missing",
        ),
        (
            "# capsules = { forearm =",
            "capsules = { forarm =",
            "`machine.world.capsules.forarm`: no link `forarm` moves with the chain (did you mean `forearm`?",
        ),
        (
            "# floor_m = 0.0",
            "floor_m = 0.2",
            "`machine.world.floor_m`: the floor, 0.2 m above the origin of `base`, is above the joint `shoulder_pan`, at 0.000 m",
        ),
        ("# srdf = \"arm.srdf\"", "srdf = \"none.srdf\"", "cannot read an SRDF file"),
        ("# srdf = \"arm.srdf\"", "srdff = \"arm.srdf\"", "did you mean `srdf`?"),
        (
            "clearance_m = 0.005",
            "clearance_m = -0.005",
            "`machine.world.clearance_m`: -0.005 is out of range",
        ),
        (
            "# range_radps = 17.4 ",
            "range_radps = 17.4\nrange_degps = 1000.0 ",
            "`gyroscope.range_degps`: the range is given twice",
        ),
        ("noise_mps2 = 0.01 ", "# ", "`sensor.noise_mps2`: this required key is missing"),
        ("noise_radps = 2e-3 ", "# ", "`gyroscope.noise_radps`: this required key is missing"),
        ("urdf = \"arm\" ", "# ", "this needs a machine"),
    ] {
        let error = match design(&arm_with(old, new), None) {
            Err(error) => error.to_string(),
            Ok(_) => "nothing is wrong".into(),
        };
        if !error.contains(wanted) {
            let _ = writeln!(wrong, "{new}\n  wanted {wanted}\n  found  {error}");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}
