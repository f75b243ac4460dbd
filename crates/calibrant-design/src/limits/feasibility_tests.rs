//! Tests of prescribed ends: what they admit, and what clashes.

use super::*;

fn times(n: usize) -> Vec<f64> {
    (0..=n).map(|i| i as f64).collect()
}

#[test]
fn an_interior_motion_keeps_everything_with_room_to_spare() {
    let limits = AxisLimits {
        acceleration: Some(20.0),
        jerk: Some(15.0),
        velocity: Some(10.0),
        displacement: Some(10.0),
        rest: Rest::Both,
        start: Some(2.0),
        end: Some(-3.0),
        ..AxisLimits::default()
    };
    let interior = interior_motion(&limits, &times(10)).expect("there is one");
    assert!(interior.slack > 0.1, "{interior:?}");
    assert_eq!((interior.nodes[0], interior.nodes[10]), (2.0, -3.0));
    assert!(worst_violation(&limits, &times(10), &interior.nodes) < 1e-12);
}

#[test]
fn an_end_on_its_limit_leaves_room_elsewhere() {
    let limits = AxisLimits {
        acceleration: Some(20.0),
        intercept: Some(20.0),
        jerk: Some(15.0),
        start: Some(20.0),
        ..AxisLimits::default()
    };
    let interior = interior_motion(&limits, &times(5)).expect("there is one");
    assert!(interior.slack > 0.1 && interior.nodes[0] == 20.0, "{interior:?}");
}

#[test]
fn plain_clashes_are_named() {
    let base = AxisLimits { acceleration: Some(10.0), jerk: Some(1.0), ..AxisLimits::default() };
    let stated = |limits: AxisLimits| plain_clash(Axis::Y, &limits, &times(4)).expect("a clash").to_string();
    let beyond = stated(AxisLimits { start: Some(-12.0), ..base });
    assert!(beyond.contains("`limits.start_acceleration_mps2`: the limits admit no motion: the acceleration at the start of axis y, -12 m/s², lies beyond"), "{beyond}");
    let apart = stated(AxisLimits { start: Some(-5.0), end: Some(5.0), ..base });
    assert!(apart.contains("takes a jerk of 2.5000 m/s³, the limit is 1 m/s³"), "{apart}");
    let intercept = stated(AxisLimits { start: Some(8.0), intercept: Some(5.0), ..base });
    assert!(intercept.contains("begins at 8 m/s², which is its intercept"), "{intercept}");
}

#[test]
fn a_minimal_clashing_set_is_named() {
    // from 9 m/s² at jerk 1 the velocity reaches 40 m/s before it turns
    let limits = AxisLimits {
        acceleration: Some(10.0),
        jerk: Some(1.0),
        velocity: Some(10.0),
        displacement: Some(1e6),
        start: Some(9.0),
        ..AxisLimits::default()
    };
    assert!(interior_motion(&limits, &times(10)).is_none());
    let stated = clash(Axis::X, &limits, &times(10)).to_string();
    assert!(stated.contains("its limits on jerk, velocity and acceleration at the start clash"), "{stated}");
    let freed = AxisLimits { velocity: Some(50.0), ..limits };
    assert!(interior_motion(&freed, &times(20)).is_some());
}

#[test]
fn a_clash_names_durations_without_the_rounding_of_sums() {
    let limits = AxisLimits {
        acceleration: Some(10.0),
        displacement: Some(0.01),
        start: Some(9.0),
        end: Some(-9.0),
        jerk: Some(25.0),
        ..AxisLimits::default()
    };
    let times: Vec<f64> = (0..=3).map(|i| f64::from(i) * 0.3).collect();
    let stated = clash(Axis::X, &limits, &times).to_string();
    assert!(stated.starts_with("the limits admit no motion of 0.9 s in intervals of 0.3 s"), "{stated}");
}

#[test]
fn clashes_between_the_nodes_are_found() {
    // one interval, at rest at both ends: a falls from 4 to −4, the velocity peaks at 1 m/s in the middle
    let limits = AxisLimits {
        velocity: Some(0.9),
        acceleration: Some(10.0),
        rest: Rest::Both,
        start: Some(4.0),
        ..AxisLimits::default()
    };
    assert!(interior_motion(&limits, &times(1)).is_none());
    let stated = clash(Axis::X, &limits, &times(1)).to_string();
    assert!(stated.contains("velocity, rest at the end and acceleration at the start clash"), "{stated}");
    let freed = AxisLimits { velocity: Some(1.1), ..limits };
    assert!(interior_motion(&freed, &times(1)).is_some());
}
