//! A gyroscope whose axes are not the accelerometer's.

use crate::estimate::imu::alignment::axes::Axes;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use nalgebra::{Matrix3, Rotation3, Vector3};

/// How its axes lie, where they were found by the rotations.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let stated = evidence.axes.map(|axes| match axes {
        Axes::InOrder([x, y, z]) => format!(
            "the gyroscope's axes are not the accelerometer's: along x, y and z of the accelerometer lie {x}, {y} and {z} of the gyroscope"
        ),
        Axes::Turned => mounting_in_words(&evidence.calibration.imu.gyroscope.matrix),
    });
    stated.into_iter().collect()
}

/// By how much and about what the gyroscope is turned, in words.
fn mounting_in_words(matrix: &Matrix3<f64>) -> String {
    let svd = matrix.svd(true, true);
    let attitude = svd.u.zip(svd.v_t).map_or_else(Matrix3::identity, |(u, v)| u * v);
    let is_mirrored = attitude.determinant() < 0.0;
    let rotation = Rotation3::from_matrix_unchecked(if is_mirrored { -attitude } else { attitude });
    let axis = rotation.axis().map_or_else(Vector3::zeros, |axis| axis.into_inner());
    format!(
        "the gyroscope is turned by {:.0}° against the accelerometer, about the axis ({:.2}, {:.2}, {:.2}){}",
        rotation.angle().to_degrees(),
        axis.x,
        axis.y,
        axis.z,
        if is_mirrored { ", and its axes point the other way" } else { "" }
    )
}
