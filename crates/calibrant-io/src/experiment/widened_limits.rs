//! Limits of joints that are wider than those of a file: a trajectory is run on a machine.

use crate::machine::FileJointLimits;
use calibrant_core::diagnostic::design::LimitWidened;
use calibrant_core::diagnostic::{Diagnostic, Phrase};
use calibrant_core::number_format::plain;
use calibrant_machine::chain::{Joint, JointKind};
use calibrant_machine_design::JointLimit;

/// Part of a number by which files that agree may differ: it is rounded in one of them.
const ROUNDED: f64 = 1e-3;

/// What is wider than in the URDF file, or than in joint_limits.yaml; `None` where nothing is.
pub(super) fn widened(joint: &Joint, in_file: &FileJointLimits, used: &JointLimit) -> Option<Diagnostic> {
    let nominal = joint.limits;
    let unit = joint.kind.unit();
    let ends = nominal.lower.zip(nominal.upper).filter(|_| joint.kind != JointKind::Continuous);
    let mut all = Vec::new();
    for (source, of) in
        [("the URDF file", ends), ("joint_limits.yaml", in_file.position.map(<(f64, f64)>::from))]
    {
        let Some((lower, upper)) = of else { continue };
        let room = ROUNDED * (upper - lower);
        if used.lower < lower - room || used.upper > upper + room {
            let [a, b, c, d] = [used.lower, used.upper, lower, upper].map(|of| plain(of, 4));
            all.push(format!("position from {a} to {b} {unit}, in {source} from {c} to {d} {unit}"));
        }
    }
    for (name, per, used, of) in [
        ("speed", "/s", used.velocity, [nominal.velocity, in_file.velocity]),
        ("acceleration", "/s²", used.acceleration, [None, in_file.acceleration]),
        ("jerk", "/s³", used.jerk, [None, in_file.jerk]),
    ] {
        for (source, of) in ["the URDF file", "joint_limits.yaml"].into_iter().zip(of) {
            if let Some(of) = of.filter(|of| used > of * (1.0 + ROUNDED)) {
                let [used, of] = [used, of].map(|of| plain(of, 4));
                all.push(format!("{name} {used} {unit}{per}, in {source} {of} {unit}{per}"));
            }
        }
    }
    let of = Phrase(format!(
        "the joint `{}` is given more than a file of the machine: {}",
        joint.name,
        all.join("; ")
    ));
    (!all.is_empty()).then(|| LimitWidened { of }.into())
}
