//! What the numbers of an orientation are. Each turns the axes of the body into those of the world.

use super::quaternion::of_quaternion;
use calibrant_core::sensor::Axis;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::fmt;

/// What the numbers of an orientation in a log are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum OrientationForm {
    /// A quaternion, w first.
    QuaternionWxyz,
    /// A quaternion, w last.
    QuaternionXyzw,
    /// Axis times angle.
    RotationVector,
    /// Three angles, each about one of these axes, in this order.
    Euler {
        /// Does each turn about the axes of the body, as the turns before left them? Otherwise about those of the world.
        intrinsic: bool,
        /// The axes.
        axes: [Axis; 3],
    },
    /// A matrix, row by row.
    MatrixRows,
    /// A matrix, column by column.
    MatrixColumns,
}

/// The norm of a rotation vector is at most a full turn, and some rounding.
const LONGEST_RAD: f64 = TAU * 1.001;
/// Largest difference of a matrix from orthogonal.
const MATRIX_OFF: f64 = 0.1;

impl OrientationForm {
    /// The forms that have no axes.
    const PLAIN: [(Self, &'static str); 5] = [
        (Self::QuaternionWxyz, "quaternion-wxyz"),
        (Self::QuaternionXyzw, "quaternion-xyzw"),
        (Self::RotationVector, "rotation-vector"),
        (Self::MatrixRows, "matrix-rows"),
        (Self::MatrixColumns, "matrix-columns"),
    ];

    /// What may be written, for errors.
    pub(super) const WORDS: &'static str = "one of \"quaternion-wxyz\", \"quaternion-xyzw\", \"rotation-vector\", \"intrinsic-zyx\" (each angle turns \
        about an axis of the body, first about z), \"extrinsic-xyz\" (about the fixed axes, first about x), with any other order of axes, \
        \"matrix-rows\", \"matrix-columns\"";

    /// The form of this name: `quaternion-wxyz`, `rotation-vector`, `intrinsic-zyx`, `extrinsic-xyz`, ….
    ///
    /// # Examples
    /// ```
    /// use calibrant_recording::OrientationForm;
    ///
    /// let form = OrientationForm::parse("intrinsic-zyx").expect("yaw, pitch, roll");
    /// assert_eq!(form.to_string(), "intrinsic-zyx");
    /// assert_eq!(OrientationForm::parse("euler-zyx"), None, "about which axes?");
    /// ```
    #[must_use]
    pub fn parse(name: &str) -> Option<Self> {
        if let Some((form, _)) = Self::PLAIN.into_iter().find(|(_, plain)| *plain == name) {
            return Some(form);
        }
        let (kind, letters) = name.split_once('-')?;
        let intrinsic = match kind {
            "intrinsic" => true,
            "extrinsic" => false,
            _ => return None,
        };
        let axis =
            |letter: char| Axis::ALL.into_iter().find(|axis| "xyz".chars().nth(axis.index()) == Some(letter));
        let axes: [Axis; 3] = letters.chars().map(axis).collect::<Option<Vec<_>>>()?.try_into().ok()?;
        // a second turn about the same axis is none
        (axes[0] != axes[1] && axes[1] != axes[2]).then_some(Self::Euler { intrinsic, axes })
    }

    /// Number of its values.
    #[must_use]
    pub fn width(self) -> usize {
        match self {
            Self::QuaternionWxyz | Self::QuaternionXyzw => 4,
            Self::RotationVector | Self::Euler { .. } => 3,
            Self::MatrixRows | Self::MatrixColumns => 9,
        }
    }

    /// Are its numbers angles, which need a unit?
    #[must_use]
    pub fn has_unit(self) -> bool {
        self.width() == 3
    }

    /// The values of no rotation.
    pub(super) fn identity(self) -> &'static [f64] {
        match self {
            Self::QuaternionWxyz => &[1.0, 0.0, 0.0, 0.0],
            Self::QuaternionXyzw => &[0.0, 0.0, 0.0, 1.0],
            Self::RotationVector | Self::Euler { .. } => &[0.0; 3],
            Self::MatrixRows | Self::MatrixColumns => &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        }
    }

    /// The orientation, and how far a quaternion's norm is from 1; `None` where a value is missing. The error is what is
    /// wrong, and what to do.
    pub(super) fn orientation(
        self,
        values: &[f64],
    ) -> Result<Option<(UnitQuaternion<f64>, f64)>, [String; 2]> {
        if values.iter().any(|value| value.is_nan()) {
            return Ok(None);
        }
        match (self, values) {
            (Self::QuaternionWxyz, &[w, x, y, z]) | (Self::QuaternionXyzw, &[x, y, z, w]) => {
                of_quaternion([w, x, y, z]).map(Some).map_err(|message| {
                    let help = "are its columns in the order of the format, w first or last? a body that was not seen is NaN";
                    [message, help.into()]
                })
            }
            (Self::RotationVector, &[x, y, z]) => {
                let vector = Vector3::new(x, y, z);
                if vector.norm() > LONGEST_RAD {
                    return Err(too_long(vector.norm()));
                }
                Ok(Some((UnitQuaternion::from_scaled_axis(vector), 0.0)))
            }
            (Self::Euler { intrinsic, axes }, angles) => {
                let turns = axes.iter().zip(angles).map(|(axis, angle)| {
                    UnitQuaternion::from_scaled_axis(Vector3::ith(axis.index(), *angle))
                });
                let all = turns.fold(UnitQuaternion::identity(), |before, turn| match intrinsic {
                    true => before * turn,
                    false => turn * before,
                });
                Ok(Some((all, 0.0)))
            }
            (form, values) => {
                let rows = Matrix3::from_row_slice(values);
                of_matrix(if form == Self::MatrixRows { rows } else { rows.transpose() })
            }
        }
    }
}

fn too_long(norm: f64) -> [String; 2] {
    let help = "are its angles in degrees? [machine.log.columns] orientation_unit = \"deg\". Are they Euler angles? orientation = [\"…\", \"…\", \"…\"], their \
                columns in the order of the turns, and orientation_is, such as \"extrinsic-xyz\"";
    [format!("the rotation vector has a length of {norm:.3} rad, more than a full turn"), help.into()]
}

fn of_matrix(matrix: Matrix3<f64>) -> Result<Option<(UnitQuaternion<f64>, f64)>, [String; 2]> {
    let off = (matrix.transpose() * matrix - Matrix3::identity()).amax();
    if off > MATRIX_OFF || matrix.determinant() < 0.0 {
        let what = if off > MATRIX_OFF { "its axes are not orthogonal" } else { "it is a mirror" };
        return Err([
            format!("the matrix is no rotation: {what}"),
            "are its nine columns all there, in their order?".into(),
        ]);
    }
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix));
    Ok(Some((UnitQuaternion::from_quaternion(rotation.into_inner()), 0.0)))
}

impl fmt::Display for OrientationForm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((_, plain)) = Self::PLAIN.iter().find(|(form, _)| form == self) {
            return f.write_str(plain);
        }
        let Self::Euler { intrinsic, axes } = self else { return Ok(()) };
        f.write_str(if *intrinsic { "intrinsic-" } else { "extrinsic-" })?;
        axes.iter().try_for_each(|axis| f.write_str(["x", "y", "z"][axis.index()]))
    }
}

impl From<OrientationForm> for String {
    fn from(form: OrientationForm) -> Self {
        form.to_string()
    }
}

impl TryFrom<String> for OrientationForm {
    type Error = String;

    fn try_from(name: String) -> Result<Self, String> {
        Self::parse(&name)
            .ok_or_else(|| format!("\"{}\" is not known here\n{}", name.escape_debug(), Self::WORDS))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(name: &str, values: &[f64]) -> UnitQuaternion<f64> {
        OrientationForm::parse(name).expect("known").orientation(values).expect("right").expect("seen").0
    }

    #[test]
    fn the_forms_of_one_orientation_agree() {
        let (roll, pitch, yaw) = (0.3, -0.5, 1.2);
        // nalgebra's own: roll about the fixed x, then pitch about y, then yaw about z
        let truth = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        let matrix = truth.to_rotation_matrix();
        let [vector, coords] = [truth.scaled_axis().as_slice().to_vec(), truth.coords.as_slice().to_vec()];
        let by_columns = matrix.matrix().as_slice();
        let by_rows = matrix.matrix().transpose();
        for (name, values) in [
            ("extrinsic-xyz", &[roll, pitch, yaw][..]),
            ("intrinsic-zyx", &[yaw, pitch, roll]),
            ("rotation-vector", &vector),
            ("quaternion-xyzw", &coords),
            ("quaternion-wxyz", &[coords[3], coords[0], coords[1], coords[2]]),
            ("matrix-columns", by_columns),
            ("matrix-rows", by_rows.as_slice()),
        ] {
            assert!(of(name, values).angle_to(&truth) < 1e-7, "{name}");
            let form = OrientationForm::parse(name).expect("known");
            assert_eq!((form.to_string().as_str(), form.width()), (name, values.len()));
            assert_eq!(of(name, form.identity()).angle(), 0.0, "{name}");
        }
        assert!(of("intrinsic-xyz", &[roll, pitch, yaw]).angle_to(&truth) > 0.1);
        for name in ["euler-zyx", "intrinsic-xxz", "intrinsic-xy", "extrinsic-xyzx", "intrinsic-", "zyx"] {
            assert_eq!(OrientationForm::parse(name), None, "{name}");
        }
    }

    #[test]
    fn what_cannot_be_an_orientation_is_refused() {
        let refused =
            |form: OrientationForm, values: &[f64]| form.orientation(values).expect_err("refused")[0].clone();
        assert!(refused(OrientationForm::RotationVector, &[0.0, 90.0, 0.0]).contains("90.000 rad"));
        assert!(refused(OrientationForm::MatrixRows, &[0.0; 9]).contains("not orthogonal"));
        let mirror = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0];
        assert!(refused(OrientationForm::MatrixRows, &mirror).contains("a mirror"));
    }
}
