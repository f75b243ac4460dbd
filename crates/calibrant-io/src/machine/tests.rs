//! Shapes of links, meshes, SRDF and MoveIt's limits: what they mean, and what is wrong with broken ones.

use super::*;
use calibrant_machine_design::world::{BodySource, Scene, World};
use nalgebra::{Isometry3, Vector3};
use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// An arm of two joints: a pedestal below its base, a camera beside its forearm, a gripper whose finger moves.
const ARM: &str = r#"<robot name="two">
<link name="floor"/>
<link name="pedestal"><collision><geometry><box size="0.2 0.2 0.6"/></geometry></collision></link>
<link name="base"/>
<link name="upper"><collision><origin xyz="0 0 0.2"/><geometry><cylinder radius="0.05" length="0.4"/></geometry></collision></link>
<link name="fore"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
<link name="camera"><collision><origin xyz="0 0 0.01"/><geometry><capsule radius="0.02" length="0.1"/></geometry></collision></link>
<link name="finger"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
<joint name="a" type="fixed"><parent link="floor"/><child link="pedestal"/><origin xyz="0 0 0.3"/></joint>
<joint name="b" type="fixed"><parent link="pedestal"/><child link="base"/><origin xyz="0 0 0.3"/></joint>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="2" effort="3"/></joint>
<joint name="elbow" type="revolute"><parent link="upper"/><child link="fore"/><origin xyz="0 0 0.4"/><axis xyz="1 0 0"/><limit lower="-1" upper="1" velocity="2" effort="3"/></joint>
<joint name="c" type="fixed"><parent link="fore"/><child link="camera"/><origin xyz="0.1 0 0" rpy="0 1.5707963267948966 0"/></joint>
<joint name="d" type="prismatic"><parent link="fore"/><child link="finger"/><axis xyz="1 0 0"/><limit lower="0" upper="1" velocity="2" effort="3"/></joint>
</robot>
"#;

fn bodies(text: &str) -> MachineBodies {
    let machine = Urdf::parse(text.as_bytes()).expect("valid");
    machine.bodies(Some("base"), Some("camera"), &[]).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn links_move_with_the_frame_to_which_fixed_joints_join_them() {
    let found = bodies(ARM);
    let names: Vec<(&str, usize)> =
        found.bodies.iter().map(|body| (body.name.as_str(), body.frame)).collect();
    assert_eq!(names, [("pedestal", 0), ("upper", 1), ("fore", 2), ("camera", 2)]);
    let pedestal = &found.bodies[0].capsules[0];
    assert!((pedestal.ends_m[0].z + pedestal.ends_m[1].z + 0.6).abs() < 1e-3, "its middle is 0.3 m below");
    let camera = found.bodies[3].capsules[0];
    let ends = [Vector3::new(0.1 + 0.01 - 0.05, 0.0, 0.0), Vector3::new(0.1 + 0.01 + 0.05, 0.0, 0.0)];
    assert!((camera.ends_m[0] - ends[0]).norm() + (camera.ends_m[1] - ends[1]).norm() < 1e-12, "{camera:?}");
    let links: Vec<&str> = found.links.iter().map(|link| link.name.as_str()).collect();
    assert_eq!(
        links,
        ["floor", "pedestal", "base", "upper", "fore", "camera"],
        "the finger moves on its own"
    );
}

#[test]
fn a_mesh_that_is_not_there_is_a_capsule_from_joint_to_joint() {
    let text = ARM.replace(
        r#"<cylinder radius="0.05" length="0.4"/>"#,
        r#"<mesh filename="package://two/upper.stl"/>"#,
    );
    let found = bodies(&text);
    assert_eq!((found.without_mesh.len(), found.without_mesh[0].link.as_str()), (1, "upper"));
    let upper = &found.bodies[1];
    assert_eq!(upper.source, BodySource::Joints);
    assert!((upper.capsules[0].ends_m[1] - Vector3::new(0.0, 0.0, 0.4)).norm() < 1e-12);
}

/// The directory of the arms that are tested, if it is there.
fn arms() -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let data = std::env::var_os("CALIBRANT_DATA").map_or_else(beside, PathBuf::from).join("arms");
    let is_there = data.is_dir();
    if !is_there {
        eprintln!("SKIPPED: {} is not there", data.display());
    }
    is_there.then_some(data)
}

#[test]
fn the_capsules_of_a_ur5e_are_as_small_as_those_of_another_search() {
    let Some(arms) = arms() else { return };
    let machine = Urdf::read(&arms.join("ur5e.urdf")).expect("valid");
    let found = machine.bodies(Some("base_link"), Some("tool0"), &[]).expect("with meshes");
    // scipy's Nelder-Mead from eight starts around the hulls of the same meshes: radius and length of the axis
    let others = [
        ("base_link_inertia", 0.0805, 0.0157),
        ("shoulder_link", 0.0834, 0.0135),
        ("upper_arm_link", 0.0898, 0.4119),
        ("forearm_link", 0.0663, 0.3882),
        ("wrist_1_link", 0.0641, 0.0209),
        ("wrist_2_link", 0.0573, 0.0183),
        ("wrist_3_link", 0.042, 0.0028),
    ];
    assert_eq!(found.bodies.len(), others.len());
    for (body, (name, radius, length)) in found.bodies.iter().zip(others) {
        assert_eq!((body.name.as_str(), body.source), (name, BodySource::Mesh));
        let other = PI * radius * radius * (length + 4.0 / 3.0 * radius);
        let ratio = body.capsules[0].volume_m3() / other;
        assert!((0.9..1.01).contains(&ratio), "{name}: {ratio} of the other's volume");
    }
    let chain = machine.chain(Some("base_link"), Some("tool0")).expect("valid");
    let ranges = [3.05, 3.05, 2.6, 3.05, 3.05, 3.05].map(|end| (-end, end));
    let scene = Scene { bodies: found.bodies, ..Scene::default() };
    let world = World::new(&chain, &ranges, scene);
    let apart: Vec<String> = (world.left_out().iter())
        .filter(|pair| pair.reason != calibrant_machine_design::world::Reason::Neighbours)
        .map(|pair| pair.bodies.join("–"))
        .collect();
    let expected =
        ["base_link_inertia–upper_arm_link", "forearm_link–wrist_2_link", "wrist_1_link–wrist_3_link"];
    assert_eq!(apart, expected);
}

#[test]
fn the_speed_limits_of_an_fr3_fall_towards_its_ends() {
    let Some(arms) = arms() else { return };
    let machine = Urdf::read(&arms.join("fr3.urdf")).expect("valid");
    let chain = machine.chain(None, Some("fr3_link8")).expect("valid");
    // franka's own code: min(4.18, max(0, −0.35 + √(11 (4.5205 − q))))
    let of = chain.joints[5].limits.near_ends.expect("documented");
    let fastest = (of.slope * (of.upper - 4.4)).sqrt() - of.offset;
    assert!((fastest - ((11.0 * (4.5205 - 4.4_f64)).sqrt() - 0.35)).abs() < 1e-12);
    let found = machine.bodies(None, Some("fr3_link8"), &[]).expect("with meshes");
    assert_eq!((found.bodies.len(), found.without_mesh.len()), (8, 0));
    let stated = ARM.replace("<axis xyz=\"1 0 0\"/><limit lower=\"-1\"", "<axis xyz=\"1 0 0\"/><position_based_velocity_limits velocity_offset=\"0.2\" deceleration_limit=\"3\"/><limit lower=\"-1\"");
    let chain = Urdf::parse(stated.as_bytes()).and_then(|of| of.chain(None, Some("camera"))).expect("valid");
    let of = chain.joints[1].limits.near_ends.expect("stated");
    assert_eq!((of.lower, of.upper, of.slope, of.offset), (-1.0, 1.0, 6.0, 0.2));
    assert!(chain.joints[0].limits.near_ends.is_none());
}

#[test]
fn broken_shapes_are_refused_at_their_line() {
    let mut wrong = String::new();
    for (old, new, wanted) in [
        (
            r#"<box size="0.2 0.2 0.6"/>"#,
            "<box/>",
            "line 3, column 44: `link pedestal > box`: the attribute `size` is missing",
        ),
        (
            r#"<box size="0.2 0.2 0.6"/>"#,
            r#"<box size="0.2 0 0.6"/>"#,
            "`size` has a number that is not above 0",
        ),
        (r#"<box size="0.2 0.2 0.6"/>"#, r#"<box size="0.2 0.6"/>"#, "`size` has 2 numbers, not 3"),
        (r#"<cylinder radius="0.05""#, r#"<cylinder radius="-0.05""#, "`radius` is not above 0: -0.05"),
        (r#"<sphere radius="0.1"/>"#, r#"<sphere radius="ten"/>"#, "`radius` is not a number: \"ten\""),
        (r#"<sphere radius="0.1"/>"#, "<plane/>", "there is no shape that is known"),
        (
            r#"<geometry><sphere radius="0.1"/></geometry>"#,
            "",
            "line 6, column 19: `link fore > collision`: <geometry> is missing",
        ),
    ] {
        assert!(ARM.contains(old), "{old}");
        let machine = Urdf::parse(ARM.replacen(old, new, 1).as_bytes()).expect("a valid chain");
        let error = machine.bodies(Some("base"), Some("camera"), &[]).expect_err("broken").to_string();
        if !error.contains(wanted) {
            let _ = writeln!(wrong, "{new}\n  wanted {wanted}\n  found  {error}");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// A triangle as text.
const TRIANGLE: &str = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0.5\nendloop\nendfacet\nendsolid s\n";

/// The same in bytes.
fn binary() -> Vec<u8> {
    let mut bytes = [&b"solid in its name only"[..], &[b' '; 58], &1_u32.to_le_bytes()].concat();
    for number in [0.0_f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.5] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend([0, 0]);
    bytes
}

#[test]
fn meshes_are_read_as_text_and_as_bytes_and_broken_ones_say_why() {
    let corners = [Vector3::zeros(), Vector3::x(), Vector3::new(0.0, 1.0, 0.5)];
    assert_eq!(parse_stl(TRIANGLE.as_bytes()).expect("text"), corners);
    assert_eq!(parse_stl(&binary()).expect("bytes"), corners);
    let mut wrong = String::new();
    let mut not_finite = binary();
    not_finite[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
    for (bytes, wanted) in [
        (Vec::new(), "the file has 0 bytes, and a mesh in STL at least 84"),
        (binary()[..100].to_vec(), "the file says 1 triangles, and has 0"),
        (not_finite, "triangle 1 has a vertex that is not finite"),
        (b"solid s\nendsolid s\n".to_vec(), "the mesh has no triangle"),
        (
            TRIANGLE.replace("1 0 0", "1,0,0").into_bytes(),
            "line 5: a vertex has three finite numbers, this has not",
        ),
        (TRIANGLE.replace("vertex 1 0 0\n", "").into_bytes(), "line 8: 2 vertices make no triangles"),
        (
            TRIANGLE.replace("endsolid s\n", "").into_bytes(),
            "line 8: the mesh ends after 3 vertices, without endsolid",
        ),
    ] {
        let found = parse_stl(&bytes).expect_err("broken").to_string();
        if !found.contains(wanted) {
            let _ = writeln!(wrong, "wanted {wanted}\nfound  {found}");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn a_mesh_in_millimetres_is_noticed_and_a_scale_mends_it() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    std::fs::write(directory.path().join("upper.stl"), TRIANGLE.replace("1 0 0", "1000 0 0"))
        .expect("written");
    let with = |scale: &str| {
        let mesh = format!(r#"<mesh filename="upper.stl"{scale}/>"#);
        let text = ARM.replace(r#"<cylinder radius="0.05" length="0.4"/>"#, &mesh);
        let path = directory.path().join("two.urdf");
        std::fs::write(&path, text).expect("written");
        Urdf::read(&path).expect("valid").bodies(Some("base"), Some("camera"), &[])
    };
    let error = with("").expect_err("1 km").to_string();
    assert!(error.contains("reaches 1000 m") && error.contains("scale=\"0.001 0.001 0.001\""), "{error}");
    let found = with(r#" scale="0.001 0.001 0.001""#).expect("1 m");
    assert_eq!(found.bodies[1].source, BodySource::Mesh);
    assert!(found.bodies[1].capsules[0].placed(&Isometry3::identity()).extent_m() < 1.3);
}

/// Limits of one joint, with one text replaced.
fn limits_with(old: &str, new: &str) -> String {
    let text = "joint_limits:\n  elbow:\n    has_position_limits: true\n    min_position: -2.6\n    max_position: 2.5\n    has_velocity_limits: true\n    max_velocity: 3.1\n    has_acceleration_limits: true\n    max_acceleration: 5.0\n    has_jerk_limits: false\n    max_jerk: 0\n";
    assert!(text.contains(old), "{old}");
    text.replacen(old, new, 1)
}

#[test]
fn limits_of_moveit_are_read_and_broken_ones_say_line_and_key() {
    for text in [
        limits_with("elbow", "elbow"),
        limits_with("joint_limits:\n", "robot_description_planning:\n joint_limits:\n"),
        limits_with("joint_limits:\n", "default_velocity_scaling_factor: 0.1\njoint_limits:\n"),
    ] {
        let of = parse_joint_limits(text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))["elbow"];
        assert_eq!(
            (of.position, of.velocity, of.acceleration, of.jerk),
            (Some([-2.6, 2.5]), Some(3.1), Some(5.0), None)
        );
    }
    let mut wrong = String::new();
    for (old, new, wanted) in [
        ("joint_limits", "limits", "`joint_limits`: there is no `joint_limits`"),
        ("5.0", "-5.0", "line 9: `joint_limits.elbow.max_acceleration`: -5 is not above 0"),
        ("5.0", ".inf", "line 9: `joint_limits.elbow.max_acceleration`: this is not finite"),
        ("5.0", "fast", "line 9"),
        (
            "    max_acceleration: 5.0\n",
            "",
            "line 3: `joint_limits.elbow.max_acceleration`: has_acceleration_limits is true, and this is missing",
        ),
        (
            "    has_velocity_limits: true\n",
            "",
            "line 6: `joint_limits.elbow.max_velocity`: MoveIt does not use it without has_velocity_limits",
        ),
        ("-2.6", "2.6", "line 4: `joint_limits.elbow.min_position`: 2.6 is not below max_position, 2.5"),
        ("3.1", "!degrees 180", "line 7: the angle is in degrees"),
        ("  elbow:", "  elbow: [", "not MoveIt's joint_limits.yaml"),
    ] {
        let found = parse_joint_limits(limits_with(old, new).as_bytes()).expect_err("broken").to_string();
        if !found.contains(wanted) {
            let _ = writeln!(wrong, "{new}\n  wanted {wanted}\n  found  {found}");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn broken_srdf_files_say_where() {
    for (text, wanted) in [
        (
            "<robot><disable_collisions link1='a'/></robot>",
            "line 1, column 8: `disable_collisions`: the attribute `link2` is missing",
        ),
        ("<sdf/>", "this is an SDF file, not SRDF"),
        ("<robot>", "not valid XML"),
    ] {
        let found = parse_srdf(text.as_bytes()).expect_err("broken").to_string();
        assert!(found.contains(wanted), "{found}");
    }
}
