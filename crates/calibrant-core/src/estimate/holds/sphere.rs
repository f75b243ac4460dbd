//! The sphere through the means of the holds: where an accelerometer's offset and gain begin.

use crate::motion::Hold;
use crate::sensor::SensorParameters;
use nalgebra::{Matrix3, Vector3, Vector4};

/// Centre and radius of the sphere through the means, by linear least squares on `|y|² = 2 c·y + const`.
pub(in crate::estimate) fn sphere(holds: &[Hold], gravity: f64) -> Option<SensorParameters> {
    if holds.len() < 4 {
        return None;
    }
    let center = holds.iter().map(|hold| hold.mean).sum::<Vector3<f64>>() / holds.len() as f64;
    let size = holds.iter().map(|hold| (hold.mean - center).norm()).fold(0.0, f64::max);
    if size <= 0.0 {
        return None;
    }
    let rows: Vec<Vector4<f64>> = holds.iter().map(|hold| ((hold.mean - center) / size).push(1.0)).collect();
    let normal: nalgebra::Matrix4<f64> = rows.iter().map(|row| row * row.transpose()).sum();
    let rhs: Vector4<f64> = rows.iter().map(|row| row * row.xyz().norm_squared()).sum();
    let eigenvalues = normal.symmetric_eigenvalues();
    if eigenvalues.min() <= 1e-8 * eigenvalues.max() {
        return None;
    }
    let solution = normal.cholesky()?.solve(&rhs);
    let c = solution.xyz() / 2.0;
    let radius = (solution.w + c.norm_squared()).sqrt();
    (radius.is_finite() && radius > 0.0).then(|| SensorParameters {
        bias: center + c * size,
        matrix: Matrix3::identity() * (radius * size / gravity),
        ..SensorParameters::identity()
    })
}
