//! Logged positions beside the limits of the machine's file.

use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::log::BeyondLimits;
use calibrant_machine::chain::KinematicChain;
use calibrant_machine::log::{JointLog, ReferenceLog};
use std::f64::consts::TAU;

/// Part of the range by which noise and stops may pass a limit.
const PASSED: f64 = 0.01;

/// The joints that are logged beyond their limits. An angle may be counted from another turn.
pub(crate) fn beyond_limits(log: &ReferenceLog, chain: Option<&KinematicChain>) -> Vec<Diagnostic> {
    let (ReferenceLog::Joints(log), Some(chain)) = (log, chain) else { return Vec::new() };
    (0..chain.joints.len()).filter_map(|j| of_joint(log, chain, j)).collect()
}

fn of_joint(log: &JointLog, chain: &KinematicChain, j: usize) -> Option<Diagnostic> {
    let joint = &chain.joints[j];
    let (lower, upper) = joint.limits.lower.zip(joint.limits.upper)?;
    let positions = log.positions.iter().skip(j).step_by(log.names.len()).filter(|at| at.is_finite());
    let (least, most) =
        positions.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), at| (at.min(least), at.max(most)));
    let passed = PASSED * (upper - lower);
    // the turn in which the middles are nearest
    let turns = ((lower + upper - least - most) / (2.0 * TAU)).round();
    let shift = if joint.kind.turns() && turns.is_finite() { TAU * turns } else { 0.0 };
    let is_beyond = least + shift < lower - passed || most + shift > upper + passed;
    is_beyond.then(|| {
        let position_unit = joint.kind.unit();
        BeyondLimits { joint: joint.name.clone(), least, most, lower, upper, position_unit }.into()
    })
}
