//! Angles of an encoder that counts one turn, and begins again.

use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::log::AnglesContinued;
use calibrant_machine::log::JointLog;
use std::f64::consts::{PI, TAU};

/// Continues the angles that jump by a full turn. Only angles within one turn do: between two samples no joint turns by
/// more than half of one.
pub(super) fn unwrap_angles(log: &mut JointLog, turns: &[Option<bool>]) -> Option<Diagnostic> {
    let (joints, mut names, mut jumps) = (log.names.len(), Vec::new(), 0);
    for joint in (0..joints).filter(|joint| turns[*joint] != Some(false)) {
        let seen = || log.positions.iter().skip(joint).step_by(joints).filter(|angle| angle.is_finite());
        let (least, most) = seen()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), at| (at.min(least), at.max(most)));
        if most - least > TAU * (1.0 + f64::EPSILON) {
            continue;
        }
        let (mut before, mut full_turns, mut found) = (None, 0.0, 0);
        for angle in log.positions.iter_mut().skip(joint).step_by(joints).filter(|angle| angle.is_finite()) {
            let step = before.map_or(0.0, |before: f64| *angle - before);
            before = Some(*angle);
            if step.abs() > PI {
                full_turns -= step.signum();
                found += 1;
            }
            *angle += TAU * full_turns;
        }
        if found > 0 {
            names.push(log.names[joint].clone());
            jumps += found;
        }
    }
    (jumps > 0).then(|| AnglesContinued { joints: names, jumps }.into())
}

#[cfg(test)]
mod tests {
    use super::super::options::ReferenceLogOptions;
    use super::super::read::parse_reference_log;

    #[test]
    fn angles_that_wrap_are_continued_and_it_is_said() {
        // two turns in steps of 10°, counted from 0 to 360° and from −180 to 180°, beside a rail that goes back
        let wrapped = |k: i32, from: i32| (10 * k - from).rem_euclid(360) + from;
        let rows = (0..72).map(|k| {
            format!("{},{},{},{}\n", f64::from(k) / 100.0, wrapped(k, 0), wrapped(k, -180), 5000 * (k % 2))
        });
        let text = "t_s,table_deg,arm_deg,rail_mm\n".to_owned() + &rows.collect::<String>();
        let file = parse_reference_log(text.as_bytes(), &ReferenceLogOptions::default()).expect("a log");
        let joints = file.joints().expect("of joints");
        for k in 0..72 {
            let angle = (10.0 * k as f64).to_radians();
            assert!((joints.row(k)[0] - angle).abs() < 1e-12 && (joints.row(k)[1] - angle).abs() < 1e-12);
            assert!((joints.row(k)[2] - 5.0 * (k % 2) as f64).abs() < 1e-12);
        }
        let said: Vec<_> = file.findings.iter().map(|found| found.message().to_owned()).collect();
        assert_eq!(said, ["the angles of table, arm jump by a full turn 3 times. They are continued"]);
    }
}
