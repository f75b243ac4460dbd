//! Tests of URDF files that are whole.

use crate::common::shared_data;
use calibrant::io::{MACHINE_PRESETS, Urdf, machine_preset};
use calibrant::machine::chain::{JointKind, KinematicChain};
use std::f64::consts::{FRAC_PI_2, PI};
use std::path::{Path, PathBuf};

fn preset(name: &str) -> KinematicChain {
    let text = machine_preset(name).expect("known");
    Urdf::parse(text.as_bytes()).and_then(|machine| machine.chain(None, None)).expect("a chain")
}

#[test]
fn each_preset_is_a_chain_with_limits() {
    for (name, text) in MACHINE_PRESETS {
        assert_eq!(Urdf::parse(text.as_bytes()).expect("read").name, *name);
        for joint in &preset(name).joints {
            let limits = joint.limits;
            assert!(limits.velocity.is_some() && limits.effort.is_some(), "{name} {}", joint.name);
            assert_eq!(limits.lower.is_some(), joint.kind != JointKind::Continuous, "{name} {}", joint.name);
        }
    }
    assert_eq!(preset("rate-table").joints.len(), 1);
    assert!(preset("gantry").joints.iter().all(|joint| joint.kind == JointKind::Prismatic));
}

/// By the Denavit–Hartenberg table: at zero the arm is stretched along −x, with the wrist to the side and down.
#[test]
fn the_arm_has_the_published_lengths() {
    let (a2, a3, d1, d4, d5, d6) = (-0.425, -0.3922, 0.1625, 0.1333, 0.0997, 0.0996);
    let tip = preset("arm").nominal().tip_pose(&[0.0; 6]).translation.vector;
    assert!((tip - nalgebra::Vector3::new(a2 + a3, -d4 - d6, d1 - d5)).norm() < 1e-12, "{tip}");
}

#[test]
fn the_arm_moves_as_the_manufacturers_file() {
    let Some(path) = shared_data("arms/ur5e.urdf") else { return };
    let machine = Urdf::read(&path).expect("read");
    let theirs = machine.chain(Some("base_link_inertia"), Some("tool0")).expect("a chain").nominal();
    let ours = preset("arm").nominal();
    for k in 0..50 {
        let q: Vec<f64> = (0..6).map(|i| 2.0 * (1.7 * f64::from(k) + f64::from(i * i)).sin()).collect();
        let (one, other) = (theirs.tip_pose(&q), ours.tip_pose(&q));
        // theirs has right angles of nine digits
        assert!((one.translation.vector - other.translation.vector).norm() < 1e-9);
        assert!(one.rotation.angle_to(&other.rotation) < 1e-8);
    }
    let error = machine.chain(None, None).expect_err("three ends").to_string();
    assert!(error.contains("3 ends: ft_frame, base, tool0"), "{error}");
}

#[test]
fn fixed_joints_are_merged_and_the_axis_has_unit_length() {
    let text = r#"<robot name="r"><link name="a"/><link name="b"/><link name="c"/><link name="d"/><link name="e"/>
        <joint name="1" type="fixed"><origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/><parent link="a"/><child link="b"/></joint>
        <joint name="2" type="continuous"><origin xyz="2 0 0"/><parent link="b"/><child link="c"/><axis xyz="0 0 3"/></joint>
        <joint name="3" type="fixed"><origin quat_xyzw="0 0 2 0"/><parent link="c"/><child link="d"/></joint>
        <joint name="4" type="fixed"><origin xyz="0.5 0 0"/><parent link="d"/><child link="e"/></joint></robot>"#;
    let chain = Urdf::parse(text.as_bytes()).and_then(|machine| machine.chain(None, None)).expect("a chain");
    let [joint] = chain.joints.as_slice() else { panic!("one joint") };
    assert!((joint.origin.translation.vector - nalgebra::Vector3::new(1.0, 2.0, 0.0)).norm() < 1e-15);
    assert!((joint.axis.norm() - 1.0).abs() < 1e-15);
    let tip = chain.nominal().tip_pose(&[FRAC_PI_2]);
    assert!((tip.translation.vector - nalgebra::Vector3::new(1.5, 2.0, 0.0)).norm() < 1e-15, "{tip}");
    assert!(tip.rotation.angle() < 1e-15, "90° + 90° + 180°: {}", tip.rotation.angle());
    let part = Urdf::parse(text.as_bytes()).and_then(|machine| machine.chain(Some("c"), Some("d")));
    assert!((part.expect("no joint moves").tip_transform.rotation.angle() - PI).abs() < 1e-15);
}

#[test]
fn meshes_are_looked_for_in_packages_and_beside_the_file() {
    let Some(path) = shared_data("arms/ur5e.urdf") else { return };
    let machine = Urdf::read(&path).expect("read");
    let beside = path.parent().map(Path::to_path_buf).expect("a directory");
    assert_eq!(machine.missing_meshes(&[PathBuf::from("/nowhere"), beside]), []);
    // a package is looked for beside the file, too
    assert_eq!(machine.missing_meshes(&[]), []);
    let machine = Urdf::parse(&std::fs::read(&path).expect("read")).expect("a machine");
    let missing = machine.missing_meshes(&[PathBuf::from("/nowhere")]);
    assert_eq!(missing.len(), 7);
    assert_eq!(
        missing[0].to_string(),
        "link base_link_inertia: no mesh package://ur_description/meshes/ur5e/collision/base.stl (looked for /nowhere/ur_description/meshes/ur5e/collision/base.stl)"
    );
    assert!(machine.missing_meshes(&[])[0].to_string().contains("nothing says where"));
}
