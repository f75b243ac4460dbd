//! Tests of the exact check against ten thousand random times.

use super::*;
use calibrant_core::simulate::{Purpose, stream};
use nalgebra::Vector3;
use rand::RngExt;

#[test]
fn peaks_agree_with_ten_thousand_random_times() {
    let limits = AxisLimits {
        acceleration: Some(1.0),
        jerk: Some(1.0),
        intercept: Some(1.0),
        velocity: Some(1.0),
        displacement: Some(1.0),
        ..AxisLimits::default()
    };
    for index in 0..20 {
        let mut rng = stream(3, Purpose::Motion, index);
        let n = 3 + index as usize;
        let mut times = vec![0.0];
        (0..n).for_each(|i| times.push(times[i] + rng.random_range(0.1..1.5)));
        let nodes: Vec<f64> = (0..=n).map(|_| rng.random_range(-5.0..5.0)).collect();
        let whole = nodes.iter().map(|&a| Vector3::repeat(a)).collect();
        let motion = JerkControlledMotion::new(times.clone(), whole).expect("valid");
        let random: Vec<f64> = (0..10_000).map(|_| rng.random_range(0.0..times[n])).collect();
        let states = motion.states_at(&random);
        let found = axis_use(&limits, &times, &nodes);
        let peak = |kind: LimitKind| found.iter().find(|use_| use_.kind == kind).expect("there").value.abs();
        let check = |kind: LimitKind, seen: f64, slack: f64| {
            assert!(seen <= peak(kind) * (1.0 + 1e-12), "{kind:?}: {seen} above {}", peak(kind));
            assert!(seen >= peak(kind) * (1.0 - slack), "{kind:?}: {seen} far below {}", peak(kind));
        };
        let largest = |of: &dyn Fn(usize) -> f64| (0..random.len()).fold(0.0, |m: f64, k| m.max(of(k).abs()));
        check(LimitKind::Acceleration, largest(&|k| states[k].acceleration_mps2.x), 0.01);
        check(LimitKind::Jerk, largest(&|k| states[k].jerk_mps3.x), 1e-12);
        check(LimitKind::Velocity, largest(&|k| states[k].velocity_mps.x), 0.01);
        check(LimitKind::Displacement, largest(&|k| states[k].displacement_m.x), 0.01);
        for use_ in &found {
            let state = motion.states_at(&[use_.time_s])[0];
            let there = match use_.kind {
                LimitKind::Velocity => state.velocity_mps.x,
                LimitKind::Displacement => state.displacement_m.x,
                LimitKind::Acceleration => state.acceleration_mps2.x,
                _ => continue,
            };
            assert!((there - use_.value).abs() < 1e-10 * (1.0 + use_.value.abs()), "{use_:?}");
        }
    }
}

#[test]
fn rest_and_prescribed_ends_are_held_to_both_sides() {
    let limits = AxisLimits {
        acceleration: Some(10.0),
        rest: Rest::Both,
        start: Some(0.0),
        end: Some(-2.0),
        ..AxisLimits::default()
    };
    let times = [0.0, 1.0, 2.0];
    assert_eq!(worst_violation(&limits, &times, &[0.0, 1.0, -2.0]), 0.0);
    let found = axis_use(&limits, &times, &[1.0, 1.0, -2.0]);
    let start = found.iter().find(|use_| use_.kind == LimitKind::StartAcceleration).expect("there");
    assert_eq!((start.excess(), start.violation), (1.0, 0.1));
    let rest = found.iter().find(|use_| use_.kind == LimitKind::RestAtEnd).expect("there");
    assert!(rest.is_violated() && (rest.value - 0.5).abs() < 1e-15);
}

#[test]
fn a_still_axis_keeps_everything() {
    let limits = AxisLimits {
        acceleration: Some(1.0),
        jerk: Some(1.0),
        velocity: Some(1.0),
        displacement: Some(1.0),
        rest: Rest::Both,
        ..AxisLimits::default()
    };
    assert_eq!(worst_violation(&limits, &[0.0, 1.0, 2.0], &[0.0; 3]), 0.0);
    assert!(roots(0.0, 0.0, 0.0).next().is_none());
    assert_eq!(roots(0.0, 2.0, -4.0).collect::<Vec<_>>(), [2.0]);
}
