//! A gyroscope whose axes are not the accelerometer's.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::gyroscope::{AxesInOtherOrder, GyroscopeTurned};
use crate::estimate::imu::alignment::axes::Axes;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::sensor::SensorKind;
use nalgebra::{Matrix3, Rotation3, Vector3};

/// How its axes lie, where they were found by the rotations.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let stated = evidence.axes.map(|axes| match axes {
        Axes::InOrder(order) => Diagnostic::from(AxesInOtherOrder { order: order.clone(), by_turns: false }),
        Axes::Rotated => mounting(&evidence.calibration.imu[SensorKind::Gyroscope].matrix),
    });
    stated.into_iter().collect()
}

/// By how much and about what the gyroscope is turned.
fn mounting(matrix: &Matrix3<f64>) -> Diagnostic {
    let svd = matrix.svd(true, true);
    let attitude = svd.u.zip(svd.v_t).map_or_else(Matrix3::identity, |(u, v)| u * v);
    let is_mirrored = attitude.determinant() < 0.0;
    let rotation = Rotation3::from_matrix_unchecked(if is_mirrored { -attitude } else { attitude });
    let axis = rotation.axis().map_or_else(Vector3::zeros, |axis| axis.into_inner());
    Diagnostic::from(GyroscopeTurned {
        angle_rad: rotation.angle(),
        about_x: axis.x,
        about_y: axis.y,
        about_z: axis.z,
        is_mirrored,
    })
}
