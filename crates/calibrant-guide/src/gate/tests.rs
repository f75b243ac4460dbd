//! Tests of the gate on simulated boards.

use super::*;

/// A board at rest but for what `motion` adds, with a biased accelerometer and a biased gyroscope.
fn run(seconds: f64, motion: impl Fn(f64) -> [f64; 3]) -> (Vec<Decision>, Gate) {
    let limits = Limits { hold_s: 3.0, least_s: 2.5, in_si: [true; 2], ..Limits::default() };
    let mut gate = Gate::new(limits);
    let mut found = Vec::new();
    for k in 0..(seconds * 100.0) as usize {
        let t_s = k as f64 * 0.01;
        let noise = |seed: usize| (((k * 7919 + seed * 104_729) % 1009) as f64 / 1009.0 - 0.5) * 0.06;
        let by = motion(t_s);
        // off by 0.9 m/s², and turning by 6°/s for the gyroscope
        let a = [0.9 + noise(1) + by[0], noise(2) + by[1], 8.9 + noise(3) + by[2]];
        let g = [0.105 + 0.05 * noise(4), 0.05 * noise(5), 0.05 * noise(6)];
        let sample = Sample { t_s, readings: [Some(a), Some(g)], temperature_c: None };
        found.extend(gate.take(&sample));
    }
    (found, gate)
}

#[test]
fn a_hold_of_a_sensor_that_is_far_off_counts_after_three_seconds() {
    let (found, gate) = run(6.0, |_| [0.0; 3]);
    assert!(matches!(found.as_slice(), [Decision::Held { seconds, .. }] if *seconds < 3.2), "{found:?}");
    assert_eq!(gate.phase, Phase::Held);
}

#[test]
fn a_knock_is_cut_out_and_a_motion_ends_the_hold() {
    let knock = |t: f64| if (4.0..4.1).contains(&t) { [3.0, -2.0, 1.0] } else { [0.0; 3] };
    let (found, _) = run(8.0, knock);
    assert!(found.contains(&Decision::Cut), "{found:?}");
    assert!(!found.iter().any(|one| matches!(one, Decision::Ended { .. })), "{found:?}");
    let turn = |t: f64| {
        if t > 5.0 { [9.0 * (t - 5.0).sin(), 0.0, -9.0 * (1.0 - (t - 5.0).cos())] } else { [0.0; 3] }
    };
    let (found, gate) = run(8.0, turn);
    let ended = found.iter().find_map(|one| match one {
        Decision::Ended { end_s, .. } => Some(*end_s),
        _ => None,
    });
    assert!(ended.is_some_and(|end| (4.5..5.2).contains(&end)), "{found:?}");
    assert_eq!(gate.phase, Phase::Moving);
}

#[test]
fn a_rotation_beyond_the_range_is_told_at_the_next_hold() {
    let limits =
        Limits { hold_s: 3.0, least_s: 1.0, in_si: [true; 2], range: [Some(4.0); 6], ..Limits::default() };
    let mut gate = Gate::new(limits);
    let mut found = Vec::new();
    for k in 0..900_u32 {
        let t_s = f64::from(k) * 0.01;
        let noise = f64::from(k * 7919 % 101) * 1e-4;
        let turns = (2.0..3.0).contains(&t_s);
        let a =
            if turns { [1.0 + 3.0 * noise, 2.0 * (9.0 * t_s).sin(), 1.0] } else { [1.0 + noise, 1.0, 1.0] };
        let g = [0.0, if turns { 3.8 } else { 0.0 }, noise];
        found.extend(gate.take(&Sample { t_s, readings: [Some(a), Some(g)], temperature_c: None }));
    }
    assert!(found.contains(&Decision::Fast { axis: 4 }), "{found:?}");
}

#[test]
fn a_hold_that_is_taken_back_is_left_and_blank_samples_are_none() {
    let (found, mut gate) = run(4.0, |_| [0.0; 3]);
    let [Decision::Held { start_s, .. }] = found.as_slice() else { panic!("{found:?}") };
    assert!(gate.leave(*start_s) && !gate.leave(*start_s));
    assert_eq!(gate.phase, Phase::Moving);
    for k in 0..500_u32 {
        let t_s = 4.0 + 0.01 * f64::from(k);
        let g = [0.105, 1e-3 * f64::from(k % 7), 0.0];
        let sample = Sample { t_s, readings: [None, Some(g)], temperature_c: None };
        assert_eq!(gate.take(&sample), [], "no accelerometer, no hold");
    }
}

#[test]
fn a_slide_is_told_and_a_hold_that_is_too_short() {
    let (found, _) = run(6.0, |t| [0.05 * t, 0.0, 0.0]);
    assert!(!found.iter().any(|one| matches!(one, Decision::Held { .. })), "{found:?}");
    let (found, _) = run(5.0, |t| if t > 2.0 { [5.0 * (6.0 * t).sin(), 0.0, 0.0] } else { [0.0; 3] });
    assert!(matches!(found.first(), Some(Decision::Short { needed_s, .. }) if *needed_s == 2.5), "{found:?}");
}
