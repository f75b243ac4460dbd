//! Tests that the joints of a log are matched to those of a chain.

use super::read;

fn refused(text: &str, names: &[&str]) -> String {
    read(text).joints_in_order(names).expect_err("refused").to_string()
}

#[test]
fn joints_are_picked_by_name_in_the_order_of_the_chain() {
    let file = read("t_s,grip_mm,c_rad,a_rad,b_rad,b_radps\n0,1,3,1,2,20\n1,1,30,10,20,200\n");
    let log = file.joints_in_order(&["a", "b", "c"]).expect("there");
    assert_eq!((log.names.join(" "), log.row(1)), ("a b c".to_owned(), [10.0, 20.0, 30.0].as_slice()));
    assert_eq!(log.velocities.expect("some")[4], 200.0);
}

#[test]
fn columns_of_rtde_are_those_of_the_chain() {
    let text = "timestamp actual_q_1 actual_q_0\n1 20 10\n2 21 11\n";
    assert_eq!(read(text).joints_in_order(&["first", "second"]).expect("two").row(0), [10.0, 20.0]);
    assert_eq!(
        refused(text, &["one"]),
        "the log has 2 joints, and the chain has 1 (RTDE does not name its joints, so each must be one of the chain)"
    );
}

#[test]
fn missing_joints_are_named_with_the_nearest_of_the_log() {
    let text = "t_s,shoulder_lift_rad,shoulder_pan_joint_rad,elbow_deg\n0,1,2,3\n1,1,2,3\n";
    assert_eq!(
        refused(text, &["shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "qqq"]),
        "the log lacks the joints `shoulder_lift_joint` (is `shoulder_lift` meant?), `elbow_joint` (is `elbow` meant?), `qqq` (give them the names of the chain; the log has `shoulder_lift`, `shoulder_pan_joint`, `elbow`)"
    );
    assert_eq!(
        refused("0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", &["a"]),
        "the log holds poses, not positions of joints (a log of joints has a header such as t_s,elbow_rad)"
    );
}
