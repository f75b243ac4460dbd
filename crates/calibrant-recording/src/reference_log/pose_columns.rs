//! The names of the columns of a pose.
//!
//! | meaning | names | units, as an ending or in brackets |
//! |---|---|---|
//! | position | `px`, `tx`, `p_x`, `pos_x`, `position.x`, `translation.x`, `p_RS_R_x`; `x` beside a quaternion | `m`, `cm`, `mm`; m if there is none |
//! | orientation | `qw`, `q_w`, `quat_w`, `orientation.w`, `rotation.w`, `q_RS_w` | |
//!
//! Capitals do not matter, nor whether `_`, `.` or a space joins words.

/// The values of a pose: x, y, z, then w, x, y, z of the quaternion.
pub(super) const VALUES: usize = 7;
/// What the values are called in messages.
pub(super) const NAMES: [&str; VALUES] = ["x", "y", "z", "w", "x", "y", "z"];

/// Names of a position.
const POSITION: &[&str] = &["p", "t", "pos", "position", "trans", "translation", "prsr", "poseposition"];
/// Names of an orientation.
const ORIENTATION: &[&str] =
    &["q", "quat", "quaternion", "rot", "rotation", "orientation", "qrs", "poseorientation"];

/// Which value of a pose a column holds, and the factor on its numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PoseColumn {
    pub(super) value: usize,
    pub(super) factor: f64,
    /// Is it only `x`, `y` or `z`, which may be anything?
    pub(super) is_bare: bool,
}

/// The meaning of a column's name; `None` where it is not of a pose.
pub(super) fn pose_column(name: &str) -> Option<PoseColumn> {
    let lower = name.trim().to_lowercase();
    let (base, unit) = split_unit(&lower);
    let plain: String = base.chars().filter(|c| c.is_alphanumeric()).collect();
    let factor = match unit {
        None | Some("" | "m") => 1.0,
        Some("cm") => 1e-2,
        Some("mm") => 1e-3,
        Some(_) => return None,
    };
    let last = plain.len().checked_sub(1)?;
    let (stem, end) = (plain.get(..last)?, plain.get(last..)?);
    let axis = ["x", "y", "z"].iter().position(|axis| end == *axis);
    match axis {
        Some(value) if stem.is_empty() || POSITION.contains(&stem) => {
            Some(PoseColumn { value, factor, is_bare: stem.is_empty() })
        }
        _ if !ORIENTATION.contains(&stem) || !matches!(unit, None | Some("")) => None,
        Some(axis) => Some(PoseColumn { value: 4 + axis, factor: 1.0, is_bare: false }),
        None => (end == "w").then_some(PoseColumn { value: 3, factor: 1.0, is_bare: false }),
    }
}

/// A name without its unit, and the unit: in brackets, or after the last `_`.
fn split_unit(name: &str) -> (&str, Option<&str>) {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((base, rest)) = name.split_once(open)
            && let Some(unit) = rest.strip_suffix(close)
        {
            return (base.trim(), Some(unit.trim()));
        }
    }
    match name.rsplit_once(['_', ' ']) {
        Some((base, unit @ ("m" | "cm" | "mm"))) => (base, Some(unit)),
        _ => (name, None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_the_value_and_its_unit() {
        for (name, value, factor) in [
            ("px_m", 0, 1.0),
            ("ty", 1, 1.0),
            ("z", 2, 1.0),
            ("x [mm]", 0, 1e-3),
            ("p_RS_R_z [m]", 2, 1.0),
            ("pose.position.y", 1, 1.0),
            ("position_x_cm", 0, 1e-2),
            ("qw", 3, 1.0),
            ("q_RS_w []", 3, 1.0),
            ("Quat_X", 4, 1.0),
            ("orientation.z", 6, 1.0),
        ] {
            let column = pose_column(name).unwrap_or_else(|| panic!("{name}"));
            assert_eq!((column.value, column.factor), (value, factor), "{name}");
        }
        for name in ["ax", "gx_radps", "v_RS_R_x [m s^-1]", "t_s", "w", "b_w_RS_S_x [rad s^-1]", "é", "", "q"]
        {
            assert_eq!(pose_column(name), None, "{name}");
        }
    }
}
