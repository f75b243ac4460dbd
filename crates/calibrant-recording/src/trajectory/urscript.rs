//! `trajectory.script`: a program in URScript for an arm of Universal Robots.
//!
//! A program with a target for each time step does not load: the controller takes some 1000. So this one has the control points and evaluates the spline itself, at
//! each step of the controller.

use super::Trajectory;
use crate::files::atomic_output::write_text;
use calibrant_core::error::Result;
use std::path::Path;

/// Joints of an arm of Universal Robots.
const JOINTS: usize = 6;

/// The joints of an arm of Universal Robots, with or without a prefix before and `_joint` behind.
const NAMES: [&str; JOINTS] = ["shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3"];

/// The program; `None` for a machine that is no arm of Universal Robots, which has six joints of their names that turn: another controller would not take it, or another arm
/// would go elsewhere.
///
/// It moves slowly to the first posture, waits a second, follows the spline with `servoj` and stands still again.
#[must_use]
pub fn urscript_text(trajectory: &Trajectory) -> Option<String> {
    let Trajectory { spline, turns, names } = trajectory;
    let is_named = |(name, of): (&String, &&str)| name.strip_suffix("_joint").unwrap_or(name).ends_with(*of);
    let of_universal_robots = names.len() == JOINTS && names.iter().zip(&NAMES).all(is_named);
    if !of_universal_robots || !turns.iter().all(|turns| *turns) {
        return None;
    }
    let knots = spline.knots;
    let list = |numbers: &mut dyn Iterator<Item = f64>| {
        let all: Vec<String> = numbers.map(|number| format!("{number:.12}")).collect();
        format!("[{}]", all.join(", "))
    };
    let mut text = String::new();
    let mut line = |line: &str| text.extend([line, "\n"]);
    line("def calibrant_trajectory():");
    line(
        "  # sent to port 30002 of the controller it runs; as a script file in a program, call calibrant_trajectory() behind it",
    );
    line("  # cubic B-spline: control points of each joint, rad, and the distance of its knots, s");
    for joint in 0..JOINTS {
        let mut controls = spline.controls.iter().skip(joint).step_by(JOINTS).copied();
        line(&format!("  c{joint} = {}", list(&mut controls)));
    }
    line(&format!("  h = {:.12}", knots.step_s));
    line(&format!("  intervals = {}", knots.intervals));
    line(&format!("  movej({}, a=0.5, v=0.25)", list(&mut spline.at(knots.start_s, 0).into_iter())));
    line("  sleep(1.0)");
    line("  dt = get_steptime()");
    line("  steps = floor(intervals * h / dt + 0.5)");
    line("  step = 0");
    line("  while step <= steps:");
    line("    i = floor(step * dt / h)");
    line("    if i > intervals - 1:");
    line("      i = intervals - 1");
    line("    end");
    line("    u = step * dt / h - i");
    line("    w0 = (1 - u) * (1 - u) * (1 - u) / 6");
    line("    w1 = (3 * u * u * u - 6 * u * u + 4) / 6");
    line("    w2 = (3 * u * u - 3 * u * u * u + 3 * u + 1) / 6");
    line("    w3 = u * u * u / 6");
    let position = |joint: usize| {
        let term = |r: usize| match r {
            0 => format!("w0 * c{joint}[i]"),
            _ => format!("w{r} * c{joint}[i + {r}]"),
        };
        (0..4).map(term).collect::<Vec<_>>().join(" + ")
    };
    for joint in 0..JOINTS {
        line(&format!("    q{joint} = {}", position(joint)));
    }
    line("    servoj([q0, q1, q2, q3, q4, q5], 0, 0, dt, 0.03, 2000)");
    line("    step = step + 1");
    line("  end");
    line("  stopj(2.0)");
    line("  sleep(1.0)");
    line("end");
    Some(text)
}

/// Writes the program, if the machine is such an arm; says whether it was.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_urscript(path: &Path, trajectory: &Trajectory) -> Result<bool> {
    match urscript_text(trajectory) {
        Some(text) => write_text(path, &text).map(|()| true),
        None => Ok(false),
    }
}
