//! Broken URDF files: each gets a message with line and element, and a code.

use calibrant::io::{MACHINE_PRESETS, Urdf, machine_preset};
use rand::{RngExt, SeedableRng};
use std::fmt::Write as _;

/// An arm of two joints with one text replaced by another.
fn arm_with(old: &str, new: &str) -> String {
    let arm = r#"<robot name="two">
<link name="base"/>
<link name="upper"/>
<link name="fore"/>
<link name="hand"/>
<joint name="shoulder" type="revolute">
  <parent link="base"/> <child link="upper"/>
  <origin xyz="0 0 0.5" rpy="0 0 0"/>
  <axis xyz="0 0 1"/>
  <limit lower="-1" upper="1" velocity="2" effort="3"/>
</joint>
<joint name="elbow" type="prismatic">
  <parent link="upper"/> <child link="fore"/>
  <axis xyz="1 0 0"/>
  <limit lower="0" upper="1" velocity="2" effort="3"/>
</joint>
<joint name="wrist" type="fixed"> <parent link="fore"/> <child link="hand"/> </joint>
</robot>
"#;
    assert!(arm.contains(old), "{old}");
    arm.replacen(old, new, 1)
}

fn message(bytes: &[u8], base: Option<&str>, tip: Option<&str>) -> String {
    let found = Urdf::parse(bytes).and_then(|machine| machine.chain(base, tip));
    let error = found.expect_err("broken");
    assert!(error.is_invalid_experiment(), "{error}");
    format!("{error} [{}]", error.code().name())
}

/// Text, its replacement, and the message.
const BROKEN: &[(&str, &str, &str)] = &[
    (
        "</robot>",
        "",
        "line 17, column 86: not valid XML: the root node was opened but never closed (correct it at this place) [syntax-invalid]",
    ),
    (
        r#"<link name="upper"/>"#,
        r#"<link name="upper">"#,
        "line 18, column 1: not valid XML: expected 'link' tag, not 'robot' (correct it at this place) [syntax-invalid]",
    ),
    (
        r#"type="fixed""#,
        "type=fixed",
        "line 17, column 26: not valid XML: expected a quote not 'f' (correct it at this place) [syntax-invalid]",
    ),
    (
        r#"<robot name="two">"#,
        r#"<!DOCTYPE robot><robot name="two">"#,
        "line 1, column 1: the file declares a document type (DTD) (remove <!DOCTYPE …>) [format-unsupported]",
    ),
    (
        r#"<link name="base"/>"#,
        r#"<xacro:arm name="base"/>"#,
        "line 2, column 2: this is a xacro file, not URDF (expand it first: `xacro FILE > machine.urdf`) [format-unsupported]",
    ),
    (
        r#"<link name="upper"/>"#,
        "<link/>",
        "line 3, column 1: `link`: the attribute `name` is missing (write <link name=\"…\">) [key-missing]",
    ),
    (
        r#"<link name="hand"/>"#,
        r#"<link name="fore"/>"#,
        "line 5, column 1: `link fore`: there are two links of this name (rename one) [key-repeated]",
    ),
    (
        r#"name="elbow""#,
        r#"name="shoulder""#,
        "line 12, column 1: `joint shoulder`: there are two joints of this name (rename one) [key-repeated]",
    ),
    (
        r#"<parent link="base"/>"#,
        r#"<parent link="bsae"/>"#,
        "line 7, column 3: `joint shoulder > parent`: there is no link `bsae` (did you mean `base`?) [key-unknown]",
    ),
    (
        r#"<child link="upper"/>"#,
        r#"<child link="xyzzy"/>"#,
        "line 7, column 25: `joint shoulder > child`: there is no link `xyzzy` (the links are base, upper, fore, hand) [key-unknown]",
    ),
    (
        r#"<parent link="base"/>"#,
        "",
        "line 6, column 1: `joint shoulder`: <parent> is missing (add <parent …/>) [key-missing]",
    ),
    (
        r#"<child link="upper"/>"#,
        r#"<child/>"#,
        "line 7, column 25: `joint shoulder > child`: the attribute `link` is missing (write <child link=\"…\">) [key-missing]",
    ),
    (
        r#"type="prismatic""#,
        "",
        "line 12, column 1: `joint elbow`: the attribute `type` is missing (write <joint type=\"…\">) [key-missing]",
    ),
    (
        r#"type="prismatic""#,
        r#"type="floating""#,
        "line 12, column 1: `joint elbow`: a joint of type \"floating\" is not supported in the chain (revolute, continuous, prismatic and fixed joints are; choose a base behind it, or another tip) [joint-unsupported]",
    ),
    (
        r#"type="prismatic""#,
        r#"type="planar""#,
        "line 12, column 1: `joint elbow`: a joint of type \"planar\" is not supported in the chain (revolute, continuous, prismatic and fixed joints are; choose a base behind it, or another tip) [joint-unsupported]",
    ),
    (
        r#"<axis xyz="1 0 0"/>"#,
        r#"<mimic joint="shoulder" multiplier="-1"/>"#,
        "line 14, column 3: `joint elbow > mimic`: the joint follows `shoulder`: mimic joints are not supported in the chain (choose a tip before this joint) [joint-unsupported]",
    ),
    (
        r#"<axis xyz="0 0 1"/>"#,
        r#"<axis xyz="0 0 0"/>"#,
        "line 9, column 3: `joint shoulder > axis`: the axis is zero (write a direction, such as \"0 0 1\") [value-invalid]",
    ),
    (
        r#"<axis xyz="0 0 1"/>"#,
        "<axis/>",
        "line 9, column 3: `joint shoulder > axis`: the attribute `xyz` is missing (write <axis xyz=\"…\">) [key-missing]",
    ),
    (
        r#"<limit lower="-1" upper="1" velocity="2" effort="3"/>"#,
        "",
        "line 6, column 1: `joint shoulder`: <limit> is missing, which a revolute joint needs (add <limit lower=\"…\" upper=\"…\" velocity=\"…\" effort=\"…\"/>) [key-missing]",
    ),
    (
        r#"<limit lower="0" upper="1" velocity="2" effort="3"/>"#,
        "",
        "line 12, column 1: `joint elbow`: <limit> is missing, which a prismatic joint needs (add <limit lower=\"…\" upper=\"…\" velocity=\"…\" effort=\"…\"/>) [key-missing]",
    ),
    (
        r#"lower="-1""#,
        r#"lower="-1,57""#,
        "line 10, column 3: `joint shoulder > limit`: `lower` is not a number: \"-1,57\" (write it with a point before the decimals, and without a unit) [number-malformed]",
    ),
    (
        r#"lower="-1""#,
        r#"lower="4""#,
        "line 10, column 3: `joint shoulder > limit`: the lower limit 4 is above the upper one, 1 (exchange them) [value-invalid]",
    ),
    (
        r#"velocity="2""#,
        r#"velocity="-2""#,
        "line 10, column 3: `joint shoulder > limit`: `velocity` is negative: -2 (write its magnitude) [value-invalid]",
    ),
    (
        r#"upper="1""#,
        r#"upper="inf""#,
        "line 10, column 3: `joint shoulder > limit`: `upper` is not finite: inf (write a number) [value-out-of-range]",
    ),
    (
        r#"xyz="0 0 0.5""#,
        r#"xyz="0 0 nan""#,
        "line 8, column 3: `joint shoulder > origin`: `xyz` is not finite: nan (write a number) [value-out-of-range]",
    ),
    (
        r#"xyz="0 0 0.5""#,
        r#"xyz="0 0.5""#,
        "line 8, column 3: `joint shoulder > origin`: `xyz` has 2 numbers, not 3: \"0 0.5\" (write them with spaces in between, and a point before the decimals) [value-invalid]",
    ),
    (
        r#"xyz="0 0 0.5""#,
        r#"xyz="0 0 1625""#,
        "line 8, column 3: `joint shoulder > origin`: `xyz` is larger than 1000: 1625 (lengths are in m, angles in rad) [value-out-of-range]",
    ),
    (
        r#"rpy="0 0 0""#,
        r#"rpy="0 0 90deg""#,
        "line 8, column 3: `joint shoulder > origin`: `rpy` is not a number: \"90deg\" (write it with a point before the decimals, and without a unit) [number-malformed]",
    ),
    (
        r#"rpy="0 0 0""#,
        r#"rpy="0 0 0" quat_xyzw="0 0 0 1""#,
        "line 8, column 3: `joint shoulder > origin`: `rpy` and `quat_xyzw` are both there (keep one of them) [options-contradict]",
    ),
    (
        r#"rpy="0 0 0""#,
        r#"quat_xyzw="0 0 0 0""#,
        "line 8, column 3: `joint shoulder > origin`: `quat_xyzw` is zero (write \"0 0 0 1\") [value-invalid]",
    ),
    (
        r#"<axis xyz="0 0 1"/>"#,
        r#"<axis xyz="0 0 1"/><axis xyz="0 1 0"/>"#,
        "line 9, column 22: `joint shoulder > axis`: <axis> is there twice (keep one of them) [key-repeated]",
    ),
    (
        r#"<child link="fore"/>"#,
        r#"<child link="upper"/>"#,
        "line 13, column 26: `joint elbow > child`: the link `upper` is already the child of joint `shoulder` (a link has one parent; closed kinematic loops cannot be written in URDF) [machine-invalid]",
    ),
    (
        r#"<parent link="base"/>"#,
        r#"<parent link="fore"/>"#,
        "line 12, column 1: `joint elbow`: the joints lead from link `upper` back to itself (one of the links on this loop must not be the child of a joint) [machine-invalid]",
    ),
    (
        r#"<parent link="upper"/>"#,
        r#"<parent link="fore"/>"#,
        "line 12, column 1: `joint elbow`: the joints lead from link `fore` back to itself (one of the links on this loop must not be the child of a joint) [machine-invalid]",
    ),
    (
        r#"<link name="hand"/>"#,
        r#"<link name="hand"/><link name="table"/>"#,
        "line 5, column 20: `link table`: no joint leads to this link, and none to link `base`: the machine is in two pieces (join them with a fixed joint) [machine-invalid]",
    ),
    (
        r#"<parent link="fore"/>"#,
        r#"<parent link="upper"/>"#,
        "the machine has 2 ends: fore, hand (name the one that carries the sensor as the tip) [chain-unknown]",
    ),
];

#[test]
fn each_broken_file_gets_a_message_with_its_place() {
    let mut wrong = String::new();
    for (old, new, wanted) in BROKEN {
        let found = message(arm_with(old, new).as_bytes(), None, None);
        if found != *wanted {
            let _ = writeln!(wrong, "{new}\n  wanted {wanted}\n  found  {found}");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn other_files_are_named() {
    for (text, wanted) in [
        ("", "not valid XML"),
        ("t_s,q1\n0,1\n", "not valid XML"),
        ("<sdf version='1.7'><model/></sdf>", "this is an SDF file, not URDF"),
        ("<mujoco/>", "this is a MuJoCo model"),
        ("<html/>", "its first element is not <robot>"),
        ("<robot/>", "the machine has no links"),
        ("<robot name='a'><joint name='b' type='fixed'/></robot>", "the machine has no links"),
        ("\u{feff}<robot>\0</robot>", "binary data"),
        (
            "<robot xmlns:xacro='http://www.ros.org/wiki/xacro'><xacro:include filename='a'/></robot>",
            "this is a xacro file",
        ),
    ] {
        let found = message(text.as_bytes(), None, None);
        assert!(found.contains(wanted), "{text}: {found}");
    }
    let error = Urdf::parse("śxx".as_bytes()).expect_err("no XML");
    let (excerpt, range) = error.input_error().and_then(|of| of.excerpt.clone()).expect("an excerpt");
    assert_eq!(excerpt.get(range), Some("ś"), "whole characters");
    assert!(message(b"PK\x03\x04", None, None).contains("compressed with zip"));
    assert!(message(&vec![b' '; (16 << 20) + 1], None, None).contains("larger than 16 MiB"));
    let many = format!("<robot>{}</robot>", "<a/>".repeat(1 << 20));
    assert!(message(many.as_bytes(), None, None).contains("more than 1048576 elements"));
    // what would take minutes
    let attributes: String = (0..1001).map(|k| format!(" a{k}='>'")).collect();
    let wide = format!("<robot name='r'{attributes}><link name='a'/></robot>");
    assert!(message(wide.as_bytes(), None, None).contains("an element has more than 1000 attributes"));
    let links: String = (0..=101).map(|k| format!("<link name='l{k}'/>")).collect();
    let joint = |k: usize| {
        format!(
            "<joint name='j{k}' type='continuous'><parent link='l{k}'/><child link='l{}'/></joint>",
            k + 1
        )
    };
    let long = format!("<robot name='r'>{links}{}</robot>", (0..101).map(joint).collect::<String>());
    assert!(
        message(long.as_bytes(), None, None).contains("more than 100 joints move between `l0` and `l101`")
    );
    assert!(Urdf::parse(long.as_bytes()).and_then(|of| of.chain(None, Some("l100"))).is_ok());
}

#[test]
fn a_wrong_base_or_tip_is_explained() {
    let arm = arm_with("two", "two");
    for (base, tip, wanted) in [
        (Some("bas"), None, "the machine has no link `bas` (did you mean `base`?) [key-unknown]"),
        (None, Some("hnad"), "the machine has no link `hnad` (did you mean `hand`?) [key-unknown]"),
        (
            Some("hand"),
            Some("base"),
            "no joints lead from link `hand` to link `base` (exchange base and tip) [chain-unknown]",
        ),
    ] {
        assert_eq!(message(arm.as_bytes(), base, tip), wanted);
    }
    let fork = arm_with(r#"<parent link="fore"/>"#, r#"<parent link="upper"/>"#);
    assert_eq!(
        message(fork.as_bytes(), Some("fore"), Some("hand")),
        "no joints lead from link `fore` to link `hand` (both are behind link `base`: take it as the base) [chain-unknown]"
    );
    // what is broken behind the tip does not matter
    let floating = arm_with(r#"type="prismatic""#, r#"type="floating""#);
    let machine = Urdf::parse(floating.as_bytes()).expect("a tree");
    assert_eq!(machine.chain(None, Some("upper")).expect("one joint").joints.len(), 1);
}

#[test]
fn deep_and_long_files_take_no_time() {
    let deep = format!("<robot>{}{}</robot>", "<a>".repeat(200_000), "</a>".repeat(200_000));
    assert!(message(deep.as_bytes(), None, None).contains("no links"));
    let mut long = String::from("<robot><link name=\"0\"/>");
    for k in 1..20_000 {
        let _ = write!(
            long,
            "<link name=\"{k}\"/><joint name=\"{k}\" type=\"fixed\"><parent link=\"{}\"/><child link=\"{k}\"/></joint>",
            k - 1
        );
    }
    long.push_str("</robot>");
    assert!(Urdf::parse(long.as_bytes()).expect("a tree").chain(None, None).is_ok());
}

#[test]
fn every_beginning_of_a_file_is_refused() {
    let arm = machine_preset("arm").expect("known").trim_end();
    for end in 0..arm.len() {
        assert!(Urdf::parse(&arm.as_bytes()[..end]).is_err(), "{end}");
    }
}

#[test]
fn damaged_files_are_refused_or_read_and_never_panic() {
    let seeds = MACHINE_PRESETS.iter().map(|(_, text)| text.as_bytes());
    let words: [&[u8]; 8] = [b"<", b"/>", b"\"", b"1e999", b"nan", b"", b"\xff", b"base"];
    let mut numbers = rand_chacha::ChaCha8Rng::seed_from_u64(20);
    for seed in seeds {
        for _ in 0..2000 {
            let mut bytes = seed.to_vec();
            for _ in 0..numbers.random_range(1..4) {
                let at = numbers.random_range(0..bytes.len());
                let end = (at + numbers.random_range(0..8)).min(bytes.len());
                bytes.splice(at..end, words[numbers.random_range(0..words.len())].iter().copied());
            }
            let Err(error) = Urdf::parse(&bytes).and_then(|machine| machine.chain(None, None)) else {
                continue;
            };
            let input_error = error.input_error().expect("an input error");
            if let Some((excerpt, range)) = &input_error.excerpt {
                assert!(excerpt.get(range.clone()).is_some(), "{error}");
            }
        }
    }
}
