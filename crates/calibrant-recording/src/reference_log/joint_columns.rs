//! The names of the columns of joints: the joint's name, and an ending that says position, velocity or acceleration and unit.

use std::f64::consts::PI;

/// What a column of a joint holds.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct JointColumn {
    /// The name of the joint.
    pub(super) joint: String,
    /// 0 a position, 1 a velocity, 2 an acceleration.
    pub(super) derivative: usize,
    /// Is its unit that of an angle?
    pub(super) turns: bool,
    /// The factor to rad and m, with s.
    pub(super) factor: f64,
}

/// The endings: text, derivative, factor. No ending is the end of one below it.
const ENDINGS: &[(&str, usize, f64)] = &[
    ("radps2", 2, 1.0),
    ("degps2", 2, PI / 180.0),
    ("mmps2", 2, 1e-3),
    ("mps2", 2, 1.0),
    ("radps", 1, 1.0),
    ("rad_s", 1, 1.0),
    ("rad/s", 1, 1.0),
    ("degps", 1, PI / 180.0),
    ("deg_s", 1, PI / 180.0),
    ("deg/s", 1, PI / 180.0),
    ("mmps", 1, 1e-3),
    ("mm_s", 1, 1e-3),
    ("mm/s", 1, 1e-3),
    ("mps", 1, 1.0),
    ("m_s", 1, 1.0),
    ("m/s", 1, 1.0),
    ("rad", 0, 1.0),
    ("deg", 0, PI / 180.0),
    ("mm", 0, 1e-3),
    ("m", 0, 1.0),
];

/// The meaning of a column's name; `None` where it has no unit of a joint.
pub(super) fn joint_column(name: &str) -> Option<JointColumn> {
    let name = name.trim();
    // `elbow [deg]` says the same as `elbow_deg`
    let bracket = name.strip_suffix([']', ')']).and_then(|name| name.rsplit_once(['[', '(']));
    let (base, derivative, factor, turns) = ENDINGS.iter().find_map(|&(ending, derivative, factor)| {
        let base = match bracket {
            Some((base, unit)) => unit.trim().eq_ignore_ascii_case(ending).then_some(base.trim_end()),
            None => {
                let (base, end) = name.split_at_checked(name.len().checked_sub(ending.len())?)?;
                if end.eq_ignore_ascii_case(ending) { base.strip_suffix('_') } else { None }
            }
        }?;
        Some((base, derivative, factor, ending.starts_with(['r', 'd'])))
    })?;
    let words = [
        ["_position", "_pos", ".position"],
        ["_velocity", "_vel", ".velocity"],
        ["_acceleration", "_acc", ".acceleration"],
    ][derivative];
    let joint = words.iter().find_map(|word| base.strip_suffix(word)).unwrap_or(base);
    (!joint.is_empty()).then(|| JointColumn { joint: joint.to_owned(), derivative, turns, factor })
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
        for (name, joint, derivative, factor) in [
            ("elbow_joint_rad", "elbow_joint", 0, 1.0),
            ("elbow_joint_deg", "elbow_joint", 0, PI / 180.0),
            ("Elbow [deg]", "Elbow", 0, PI / 180.0),
            ("rail_m", "rail", 0, 1.0),
            ("rail_mm", "rail", 0, 1e-3),
            ("rail_position_mm", "rail", 0, 1e-3),
            ("elbow_radps", "elbow", 1, 1.0),
            ("elbow_velocity_radps", "elbow", 1, 1.0),
            ("elbow_deg_s", "elbow", 1, PI / 180.0),
            ("rail_mmps", "rail", 1, 1e-3),
            ("rail_m_s", "rail", 1, 1.0),
            ("arm_1_m_rad", "arm_1_m", 0, 1.0),
            ("elbow_radps2", "elbow", 2, 1.0),
            ("rail_acceleration_mps2", "rail", 2, 1.0),
        ] {
            let turns = !name.contains("rail");
            let expected = JointColumn { joint: joint.to_owned(), derivative, turns, factor };
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
