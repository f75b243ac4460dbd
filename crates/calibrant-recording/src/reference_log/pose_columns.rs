//! The names of the columns of a pose.
//!
//! | meaning | names | units, as an ending or in brackets |
//! |---|---|---|
//! | position | `px`, `tx`, `p_x`, `pos_x`, `position.x`, `translation.x`, `tcp_x`, `p_RS_R_x`; `x` beside an orientation | `m`, `cm`, `mm`; m if there is none |
//! | quaternion | `qw`, `q_w`, `quat_w`, `orientation.w`, `rotation.w`, `q_RS_w` | |
//! | quaternion in a row | `q1` to `q4` beside a position (as ABB), `q0` to `q3`: w first | |
//! | rotation vector | `rotvec_x`, `rv_x`, `axis_angle_x`; `rx` beside a position (as Universal Robots) | `rad`, `deg`; rad if there is none |
//! | Euler angles | `roll`, `pitch`, `yaw`; `a`, `b`, `c` and `w`, `p`, `r` beside a position: asked for | |
//!
//! Capitals do not matter, nor whether `_`, `.` or a space joins words.

use super::log_columns::{AngleUnit, LengthUnit};

/// The values of a pose: x, y, z, then w, x, y, z of the quaternion.
pub(super) const VALUES: usize = 7;
/// What the values are called in messages.
pub(super) const NAMES: [&str; VALUES] = ["x", "y", "z", "w", "x", "y", "z"];

/// Names of a position.
const POSITION: &[&str] =
    &["p", "t", "pos", "position", "trans", "translation", "prsr", "poseposition", "tcp", "tool"];
/// Names of an orientation.
const ORIENTATION: &[&str] =
    &["q", "quat", "quaternion", "rot", "rotation", "orientation", "qrs", "poseorientation"];

/// Names before the number of a quaternion's value.
const NUMBERED: &[&str] = &["q", "quat", "quaternion", "orientation"];
/// Names before the axis of a rotation vector.
const ROTATION_VECTOR: &[&str] = &["rotvec", "rv", "rvec", "rotationvector", "axisangle"];
/// What may stand before the names of a pose.
const BEFORE: &[&str] = &["", "tcp", "tool", "pose"];

/// Which value of a pose a column holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PoseColumn {
    /// Of x, y, z, then w, x, y, z of a quaternion.
    pub(super) value: usize,
    /// The unit of a position, where the name states it.
    pub(super) unit: Option<LengthUnit>,
    /// Is it only `x`, `y` or `z`, which may be anything?
    pub(super) is_bare: bool,
}

/// The meaning of a column's name; `None` where it is not of a pose.
pub(super) fn pose_column(name: &str) -> Option<PoseColumn> {
    let (plain, unit) = plain_and_unit(name);
    let length = match unit.as_deref() {
        None | Some("") => None,
        Some(unit) => Some(LengthUnit::parse(unit)?),
    };
    let last = plain.len().checked_sub(1)?;
    let (stem, end) = (plain.get(..last)?, plain.get(last..)?);
    let axis = ["x", "y", "z"].iter().position(|axis| end == *axis);
    match axis {
        Some(value) if stem.is_empty() || POSITION.contains(&stem) => {
            Some(PoseColumn { value, unit: length, is_bare: stem.is_empty() })
        }
        _ if !ORIENTATION.contains(&stem) || length.is_some() => None,
        Some(axis) => Some(PoseColumn { value: 4 + axis, unit: None, is_bare: false }),
        None => (end == "w").then_some(PoseColumn { value: 3, unit: None, is_bare: false }),
    }
}

/// The unit of a length that the name states.
pub(super) fn length_unit(name: &str) -> Option<LengthUnit> {
    LengthUnit::parse(&plain_and_unit(name).1?)
}

/// The unit of an angle that the name states.
pub(super) fn angle_unit(name: &str) -> Option<AngleUnit> {
    AngleUnit::parse(&plain_and_unit(name).1?)
}

/// The columns of a quaternion whose values are numbered: from 0, or from 1.
pub(super) fn numbered_quaternion(names: &[String]) -> Option<(usize, Vec<usize>)> {
    let plain: Vec<_> = names.iter().map(|name| plain_and_unit(name)).collect();
    let column = |stem: &str, number: usize| {
        plain.iter().position(|(of, unit)| unit.is_none() && *of == format!("{stem}{number}"))
    };
    NUMBERED.iter().find_map(|stem| {
        let first = usize::from(column(stem, 0).is_none());
        // what goes on is a list of joints
        let is_alone = column(stem, first + 4).is_none();
        let columns = (first..first + 4).map(|number| column(stem, number));
        Some((first, columns.collect::<Option<Vec<_>>>().filter(|_| is_alone)?))
    })
}

/// The columns of a rotation vector, and whether their names may mean another thing: `rx`, `ry`, `rz`.
pub(super) fn rotation_vector(names: &[String]) -> Option<(Vec<usize>, bool)> {
    let named = |stem: &&str| Some((axes(names, stem)?, false));
    let short = || BEFORE.iter().find_map(|before| axes(names, &format!("{before}r")));
    ROTATION_VECTOR.iter().find_map(named).or_else(|| Some((short()?, true)))
}

/// Three angles whose order their names do not say.
pub(super) struct EulerNames {
    names: [&'static str; 3],
    /// Are the names plain words, which are of nothing else?
    pub(super) is_plain: bool,
    /// What they usually are, and by whom.
    pub(super) form: &'static str,
    pub(super) of: &'static str,
}

const EULER: [EulerNames; 3] = [
    EulerNames {
        names: ["roll", "pitch", "yaw"],
        is_plain: true,
        form: "extrinsic-xyz",
        of: "roll about x, then pitch about y, then yaw about z, all fixed, as in ROS",
    },
    EulerNames {
        names: ["a", "b", "c"],
        is_plain: false,
        form: "intrinsic-zyx",
        of: "as KUKA's controllers have them",
    },
    EulerNames {
        names: ["w", "p", "r"],
        is_plain: false,
        form: "extrinsic-xyz",
        of: "as Fanuc's controllers have them",
    },
];

/// The columns of three such angles.
pub(super) fn euler_angles(names: &[String]) -> Option<(&'static EulerNames, Vec<usize>)> {
    let triple = |of: &'static EulerNames| {
        let found = |before: &&str| columns(names, of.names.map(|name| format!("{before}{name}")));
        Some((of, BEFORE.iter().find_map(found)?))
    };
    EULER.iter().find_map(triple)
}

/// The columns of the tool's pose in a log of RTDE: a position in m and a rotation vector in rad.
pub(super) fn tcp_pose(names: &[String]) -> Option<Vec<usize>> {
    let column = |number: usize| {
        let name = format!("actual_TCP_pose_{number}");
        names.iter().position(|known| known.trim() == name)
    };
    (0..6).map(column).collect()
}

fn axes(names: &[String], stem: &str) -> Option<Vec<usize>> {
    columns(names, ["x", "y", "z"].map(|axis| format!("{stem}{axis}")))
}

/// The columns of these names, whatever unit of an angle they state.
fn columns(names: &[String], wanted: [String; 3]) -> Option<Vec<usize>> {
    let plain: Vec<_> = names.iter().map(|name| plain_and_unit(name)).collect();
    let is_angle =
        |unit: &Option<String>| unit.as_deref().is_none_or(|unit| AngleUnit::parse(unit).is_some());
    let column = |name: &String| plain.iter().position(|(of, unit)| of == name && is_angle(unit));
    wanted.iter().map(column).collect()
}

/// A name in small letters and digits without its unit, and the unit: in brackets, or after the last `_`.
fn plain_and_unit(name: &str) -> (String, Option<String>) {
    let lower = name.trim().to_lowercase();
    let (base, unit) = split_unit(&lower);
    (base.chars().filter(|c| c.is_alphanumeric()).collect(), unit.map(ToOwned::to_owned))
}

fn split_unit(name: &str) -> (&str, Option<&str>) {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((base, rest)) = name.split_once(open)
            && let Some(unit) = rest.strip_suffix(close)
            && (unit.is_empty() || !unit.bytes().all(|byte| byte.is_ascii_digit()))
        {
            return (base.trim(), Some(unit.trim()));
        }
    }
    match name.rsplit_once(['_', ' ']) {
        Some((base, unit @ ("m" | "cm" | "mm" | "rad" | "deg"))) => (base, Some(unit)),
        _ => (name, None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_the_value_and_its_unit() {
        for (name, value, unit) in [
            ("px_m", 0, Some(LengthUnit::M)),
            ("ty", 1, None),
            ("z", 2, None),
            ("x [mm]", 0, Some(LengthUnit::Mm)),
            ("p_RS_R_z [m]", 2, Some(LengthUnit::M)),
            ("pose.position.y", 1, None),
            ("position_x_cm", 0, Some(LengthUnit::Cm)),
            ("qw", 3, None),
            ("q_RS_w []", 3, None),
            ("Quat_X", 4, None),
            ("orientation.z", 6, None),
        ] {
            let column = pose_column(name).unwrap_or_else(|| panic!("{name}"));
            assert_eq!((column.value, column.unit), (value, unit), "{name}");
        }
        for name in [
            "ax",
            "gx_radps",
            "v_RS_R_x [m s^-1]",
            "t_s",
            "w",
            "b_w_RS_S_x [rad s^-1]",
            "é",
            "",
            "q",
            "x_deg",
        ] {
            assert_eq!(pose_column(name), None, "{name}");
        }
    }

    #[test]
    fn orientations_are_found_by_the_names_of_all_their_columns() {
        let names = |of: &str| of.split(',').map(ToOwned::to_owned).collect::<Vec<_>>();
        assert_eq!(numbered_quaternion(&names("t,q1,q2,q3,q4")), Some((1, vec![1, 2, 3, 4])));
        assert_eq!(numbered_quaternion(&names("q[0],q[1],q[2],q[3]")), Some((0, vec![0, 1, 2, 3])));
        for joints in
            ["q1,q2,q3,q4,q5,q6", "q0,q1,q2,q3,q4", "q1 [deg],q2 [deg],q3 [deg],q4 [deg]", "q1,q2,q3"]
        {
            assert_eq!(numbered_quaternion(&names(joints)), None, "{joints}");
        }
        assert_eq!(rotation_vector(&names("t,rx,ry,rz")), Some((vec![1, 2, 3], true)));
        assert_eq!(rotation_vector(&names("RX [deg],RY [deg],RZ [deg]")), Some((vec![0, 1, 2], true)));
        assert_eq!(rotation_vector(&names("rotvec_x,rotvec_y,rotvec_z")), Some((vec![0, 1, 2], false)));
        assert_eq!(rotation_vector(&names("rx,ry")), None);
        assert_eq!(euler_angles(&names("yaw,pitch_deg,roll")).map(|of| of.1), Some(vec![2, 1, 0]));
        assert_eq!(angle_unit("rx_deg"), Some(AngleUnit::Deg));
    }
}
