//! Fits an orientation spline to a log of orientations.
//!
//! Its control points turn by `exp(η_i)` in the world. To first order the orientation then turns by `Σ_r B_r η_{i+r}`, as in a spline of vectors.
//! So the remaining rotations `η_k = log(R_k R(t_k)ᵀ)` are fitted by a spline of vectors, and its control points turn those of the orientation.
//! Each round leaves an error of second order in the angle between control points.

use super::{RotationSpline, UniformKnots, fit_vectors};
use nalgebra::{UnitQuaternion, Vector3};

/// Rounds at most; the last ones only confirm.
const ROUNDS: usize = 12;
/// The rounds end at a turn of this angle, rad.
const CONVERGED_RAD: f64 = 1e-10;

/// An orientation spline through a log.
#[derive(Debug, Clone)]
pub struct RotationFit {
    /// The spline.
    pub spline: RotationSpline,
    /// Standard deviation of one orientation about each axis of the world, rad.
    pub sd_rad: Vec<f64>,
    /// Number of outliers about each axis.
    pub outliers: Vec<usize>,
}

/// Fits an orientation to samples at these times; `None` was not seen. There is at least one orientation.
#[must_use]
pub fn fit_rotations(
    times_s: &[f64],
    orientations: &[Option<UnitQuaternion<f64>>],
    knots: UniformKnots,
) -> RotationFit {
    let seen: Vec<(f64, UnitQuaternion<f64>)> =
        times_s.iter().zip(orientations).filter_map(|(t, of)| of.map(|of| (*t, of))).collect();
    let times: Vec<f64> = seen.iter().map(|(t, _)| *t).collect();
    let controls = (0..knots.controls()).map(|i| interpolated(&seen, knots.centre_s(i))).collect();
    let mut spline = RotationSpline { knots, controls };
    let mut round = 0;
    loop {
        let error = |(t, seen): &(f64, UnitQuaternion<f64>)| {
            let error: Vector3<f64> = (seen * spline.at(*t).world_from_body.inverse()).scaled_axis();
            [error.x, error.y, error.z]
        };
        let errors: Vec<f64> = seen.iter().flat_map(error).collect();
        let fit = fit_vectors(&times, &errors, 3, spline.knots);
        let mut largest = 0.0_f64;
        for (control, turn) in spline.controls.iter_mut().zip(fit.spline.controls.chunks_exact(3)) {
            let turn = Vector3::new(turn[0], turn[1], turn[2]);
            largest = largest.max(turn.norm());
            *control = UnitQuaternion::from_scaled_axis(turn) * *control;
        }
        round += 1;
        if largest < CONVERGED_RAD || round == ROUNDS {
            return RotationFit { spline, sd_rad: fit.sd, outliers: fit.outliers };
        }
    }
}

/// The orientation at a time, between the two samples about it.
fn interpolated(seen: &[(f64, UnitQuaternion<f64>)], time_s: f64) -> UnitQuaternion<f64> {
    let after = seen.partition_point(|(t, _)| *t <= time_s).clamp(1, seen.len().max(2) - 1);
    let Some((end, two)) = seen.get(after) else { return seen[0].1 };
    let (start, one) = &seen[after - 1];
    let share = if end > start { ((time_s - start) / (end - start)).clamp(0.0, 1.0) } else { 0.0 };
    one * UnitQuaternion::from_scaled_axis((one.inverse() * two).scaled_axis() * share)
}

#[cfg(test)]
mod tests {
    use super::super::Degree;
    use super::*;

    #[test]
    fn it_finds_the_spline_that_the_samples_are_from() {
        let knots = UniformKnots { start_s: 0.0, step_s: 0.2, intervals: 20, degree: Degree::Cubic };
        let turn =
            |i: usize| Vector3::new(0.4 * (i as f64).sin(), 0.2 * i as f64, 0.3 * (0.7 * i as f64).cos());
        let controls = (0..knots.controls()).map(|i| UnitQuaternion::from_scaled_axis(turn(i))).collect();
        let truth = RotationSpline { knots, controls };
        let times: Vec<f64> = (0..400).map(|k| 0.01 * k as f64).collect();
        let mut log: Vec<_> = times.iter().map(|t| Some(truth.at(*t).world_from_body)).collect();
        log[50] = Some(UnitQuaternion::identity());
        log[120..127].fill(None);
        let fit = fit_rotations(&times, &log, knots);
        for t in [0.31, 1.23, 2.9] {
            let (one, two) = (fit.spline.at(t), truth.at(t));
            assert!(one.world_from_body.angle_to(&two.world_from_body) < 1e-8, "{t}");
            assert!((one.acceleration - two.acceleration).norm() < 1e-5, "{t}");
        }
        assert!(fit.outliers.iter().any(|count| *count > 0));
    }
}
