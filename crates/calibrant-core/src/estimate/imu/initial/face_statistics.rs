//! Statistics of the residuals of faces: degrees of freedom, noise and χ², along and across the given directions.

use crate::estimate::imu::initial::face_alignment::{Chi2, Degrees};
use crate::sensor::{Quantity, SensorParameters};
use nalgebra::{DMatrix, Matrix3, Vector3};

/// Equations along gravity count as one if they differ by less than this share.
const SAME_SHARE: f64 = 1e-6;

/// Degrees of freedom of the scatter of faces along these forces. `others`: number of further parameters.
pub(crate) fn face_degrees(forces: &[Vector3<f64>], quantities: &[Quantity], others: usize) -> Degrees {
    // along gravity, in a sensor without errors: one equation for each face
    let ideal = SensorParameters::identity();
    let rows = DMatrix::from_fn(forces.len(), quantities.len(), |j, k| {
        let up = forces[j].normalize();
        up.dot(&quantities[k].derivative(&ideal, &up))
    });
    let all = (3 * forces.len()).saturating_sub(quantities.len() + others);
    Degrees {
        faces: forces.len(),
        along: (forces.len() - rows.rank(SAME_SHARE)).saturating_sub(others).min(all),
        all,
    }
}

/// Variance of the direction of a face's mean, by noise alone, rad². `weights`: inverse covariances of the means.
pub(crate) fn noise_rad2(
    weights: impl ExactSizeIterator<Item = Matrix3<f64>>,
    s: &Matrix3<f64>,
    gravity: f64,
) -> f64 {
    let count = weights.len() as f64;
    let precision: f64 = weights.map(|weight| (s.transpose() * weight * s).trace() / 3.0).sum();
    count / (precision * gravity * gravity)
}

/// The contribution of a face to χ². `r`: residual of its mean. `weight`: inverse covariance of the mean.
pub(crate) fn chi2_of_face(
    r: &Vector3<f64>,
    s: &Matrix3<f64>,
    force: &Vector3<f64>,
    weight: &Matrix3<f64>,
) -> Option<Chi2> {
    let (up, to_force) = (force.normalize(), s.try_inverse()?);
    let covariance = to_force * weight.try_inverse()? * to_force.transpose();
    let along = up.dot(&(to_force * r)).powi(2) / up.dot(&(covariance * up));
    Some(Chi2 { along, all: r.dot(&(weight * r)) })
}
