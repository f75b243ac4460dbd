//! The names of the columns of joints: the joint's name, and an ending that says position or velocity and unit.

use std::f64::consts::PI;

/// What a column of a joint holds.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct JointColumn {
    /// The name of the joint.
    pub(super) joint: String,
    pub(super) is_velocity: bool,
    /// Is its unit that of an angle?
    pub(super) turns: bool,
    /// The factor to rad, m, rad/s or m/s.
    pub(super) factor: f64,
}

/// The endings: text, velocity, factor. No ending is the end of one below it.
const ENDINGS: &[(&str, bool, f64)] = &[
    ("radps", true, 1.0),
    ("rad_s", true, 1.0),
    ("rad/s", true, 1.0),
    ("degps", true, PI / 180.0),
    ("deg_s", true, PI / 180.0),
    ("deg/s", true, PI / 180.0),
    ("mmps", true, 1e-3),
    ("mm_s", true, 1e-3),
    ("mm/s", true, 1e-3),
    ("mps", true, 1.0),
    ("m_s", true, 1.0),
    ("m/s", true, 1.0),
    ("rad", false, 1.0),
    ("deg", false, PI / 180.0),
    ("mm", false, 1e-3),
    ("m", false, 1.0),
];

/// The meaning of a column's name; `None` where it has no unit of a joint.
pub(super) fn joint_column(name: &str) -> Option<JointColumn> {
    let name = name.trim();
    // `elbow [deg]` says the same as `elbow_deg`
    let bracket = name.strip_suffix([']', ')']).and_then(|name| name.rsplit_once(['[', '(']));
    let (base, is_velocity, factor, turns) = ENDINGS.iter().find_map(|&(ending, is_velocity, factor)| {
        let base = match bracket {
            Some((base, unit)) => unit.trim().eq_ignore_ascii_case(ending).then_some(base.trim_end()),
            None => {
                let (base, end) = name.split_at_checked(name.len().checked_sub(ending.len())?)?;
                if end.eq_ignore_ascii_case(ending) { base.strip_suffix('_') } else { None }
            }
        }?;
        Some((base, is_velocity, factor, ending.starts_with(['r', 'd'])))
    })?;
    let words: &[&str] =
        if is_velocity { &["_velocity", "_vel", ".velocity"] } else { &["_position", "_pos", ".position"] };
    let joint = words.iter().find_map(|word| base.strip_suffix(word)).unwrap_or(base);
    (!joint.is_empty()).then(|| JointColumn { joint: joint.to_owned(), is_velocity, turns, factor })
}

/// The number of a column of RTDE, `actual_q_3` or `actual_qd_3`, and whether it is a velocity.
pub(super) fn rtde_column(name: &str) -> Option<(usize, bool)> {
    let rest = name.strip_prefix("actual_q")?;
    let (number, is_velocity) = match rest.strip_prefix("d_") {
        Some(number) => (number, true),
        None => (rest.strip_prefix('_')?, false),
    };
    Some((number.parse().ok()?, is_velocity))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_the_joint_and_its_unit() {
        for (name, joint, is_velocity, factor) in [
            ("elbow_joint_rad", "elbow_joint", false, 1.0),
            ("elbow_joint_deg", "elbow_joint", false, PI / 180.0),
            ("Elbow [deg]", "Elbow", false, PI / 180.0),
            ("rail_m", "rail", false, 1.0),
            ("rail_mm", "rail", false, 1e-3),
            ("rail_position_mm", "rail", false, 1e-3),
            ("elbow_radps", "elbow", true, 1.0),
            ("elbow_velocity_radps", "elbow", true, 1.0),
            ("elbow_deg_s", "elbow", true, PI / 180.0),
            ("rail_mmps", "rail", true, 1e-3),
            ("rail_m_s", "rail", true, 1.0),
            ("arm_1_m_rad", "arm_1_m", false, 1.0),
        ] {
            let turns = !name.contains("rail");
            let expected = JointColumn { joint: joint.to_owned(), is_velocity, turns, factor };
            assert_eq!(joint_column(name), Some(expected), "{name}");
        }
        for name in ["t_s", "t_ms", "elbow", "_rad", "rad", "m", "é", "", "[m]", "actual_q_0", "arm"] {
            assert_eq!(joint_column(name), None, "{name}");
        }
        assert_eq!(rtde_column("actual_q_5"), Some((5, false)));
        assert_eq!(rtde_column("actual_qd_0"), Some((0, true)));
        assert_eq!(rtde_column("actual_qdd_0"), None);
        assert_eq!(rtde_column("target_q_0"), None);
    }
}
