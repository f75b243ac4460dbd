//! The normal equations of the reference's log: it measures the control points.

use super::posterior::Moments;
use super::robust::huber;
use crate::log::{PoseLog, ReferenceLog};
use crate::reference::Motion;
use crate::reference::PoseMotion;
use crate::spline::{Weights, rotation_sensitivity};
use nalgebra::{DMatrix, Vector3};
use std::ops::Range;

/// The log with its noise.
#[derive(Debug, Clone)]
pub(super) struct WeighedLog<'a> {
    pub(super) log: &'a ReferenceLog,
    /// Standard deviation of one sample, for each unknown of a control point.
    pub(super) sd: Vec<f64>,
}

impl WeighedLog<'_> {
    /// Adds the samples of these places to the normal equations of their interval. The last column is the right side. Returns their cost `2ρ`.
    pub(super) fn add(&self, samples: Range<usize>, motion: &Motion, equations: &mut DMatrix<f64>) -> f64 {
        match (self.log, motion) {
            (ReferenceLog::Poses(log), Motion::Poses(poses)) => {
                self.add_poses(log, samples, poses, equations)
            }
            _ => 0.0,
        }
    }

    fn add_poses(
        &self,
        log: &PoseLog,
        samples: Range<usize>,
        motion: &PoseMotion,
        equations: &mut DMatrix<f64>,
    ) -> f64 {
        let knots = motion.position.knots;
        let mut cost = 0.0;
        for k in samples {
            let weights = knots.weights(log.times_s[k]);
            if let Some(position) = &log.positions_m[k] {
                let fitted = Vector3::from_fn(|j, _| motion.position.component(&weights, 0, j));
                cost += self.add_position(&weights, &(position - fitted), equations);
            }
            if let Some(orientation) = &log.world_from_body[k] {
                cost += self.add_orientation(&weights, motion, orientation, equations);
            }
        }
        cost
    }

    fn add_position(&self, weights: &Weights, residual: &Vector3<f64>, equations: &mut DMatrix<f64>) -> f64 {
        let (right, mut cost) = (equations.ncols() - 1, 0.0);
        for j in 0..3 {
            let whitened = residual[j] / self.sd[j];
            let (weight, part) = huber(whitened);
            cost += part;
            let scale = weight / self.sd[j];
            for r in 0..weights.order {
                let one = scale * weights.derivative[0][r];
                for s in 0..weights.order {
                    equations[(6 * r + j, 6 * s + j)] += one * scale * weights.derivative[0][s];
                }
                let towards = one * weight * whitened;
                equations[(6 * r + j, right)] += towards;
                equations[(right, 6 * r + j)] += towards;
            }
        }
        cost
    }

    fn add_orientation(
        &self,
        weights: &Weights,
        motion: &PoseMotion,
        seen: &nalgebra::UnitQuaternion<f64>,
        equations: &mut DMatrix<f64>,
    ) -> f64 {
        let (right, mut cost) = (equations.ncols() - 1, 0.0);
        let sensitivity = rotation_sensitivity(&motion.orientation, weights);
        let residual = (sensitivity.at.world_from_body.inverse() * seen).scaled_axis();
        for axis in 0..3 {
            let whitened = residual[axis] / self.sd[3 + axis];
            let (weight, part) = huber(whitened);
            cost += part;
            let scale = weight / self.sd[3 + axis];
            for r in 0..weights.order {
                for a in 0..3 {
                    let (row, one) = (6 * r + 3 + a, scale * sensitivity.controls[r].turn[(axis, a)]);
                    for s in 0..weights.order {
                        for b in 0..3 {
                            let other = scale * sensitivity.controls[s].turn[(axis, b)];
                            equations[(row, 6 * s + 3 + b)] += one * other;
                        }
                    }
                    let towards = one * weight * whitened;
                    equations[(row, right)] += towards;
                    equations[(right, row)] += towards;
                }
            }
        }
        cost
    }

    /// Adds residuals and leverages of samples to the sums of each component. `local` is the covariance of the interval's control points first.
    pub(super) fn add_moments(
        &self,
        samples: Range<usize>,
        motion: &Motion,
        local: &DMatrix<f64>,
        moments: &mut [Moments],
    ) {
        match (self.log, motion) {
            (ReferenceLog::Poses(log), Motion::Poses(poses)) => {
                for k in samples {
                    let weights = poses.position.knots.weights(log.times_s[k]);
                    if let Some(position) = &log.positions_m[k] {
                        for j in 0..3 {
                            let fitted = poses.position.component(&weights, 0, j);
                            let of = |r: usize| (6 * r + j, weights.derivative[0][r]);
                            let leverage = quadratic(local, weights.order, 1, |r, _| of(r));
                            self.add_moment(j, position[j] - fitted, leverage, moments);
                        }
                    }
                    if let Some(seen) = &log.world_from_body[k] {
                        let sensitivity = rotation_sensitivity(&poses.orientation, &weights);
                        let residual = (sensitivity.at.world_from_body.inverse() * seen).scaled_axis();
                        for axis in 0..3 {
                            let of =
                                |r: usize, a: usize| (6 * r + 3 + a, sensitivity.controls[r].turn[(axis, a)]);
                            let leverage = quadratic(local, weights.order, 3, of);
                            self.add_moment(3 + axis, residual[axis], leverage, moments);
                        }
                    }
                }
            }
            _ => {}
        }
    }

    fn add_moment(&self, component: usize, residual: f64, variance: f64, moments: &mut [Moments]) {
        let whitened = residual / self.sd[component];
        let (weight, _) = huber(whitened);
        let scale = weight / self.sd[component];
        moments[component].add(weight * whitened, scale * scale * variance);
    }
}

/// The variance of a sum over control points: place and factor of each of its terms.
fn quadratic(
    local: &DMatrix<f64>,
    order: usize,
    terms: usize,
    of: impl Fn(usize, usize) -> (usize, f64),
) -> f64 {
    let mut sum = 0.0;
    for (r, a) in (0..order).flat_map(|r| (0..terms).map(move |a| (r, a))) {
        let (row, one) = of(r, a);
        for (s, b) in (0..order).flat_map(|s| (0..terms).map(move |b| (s, b))) {
            let (column, other) = of(s, b);
            sum += one * other * local[(row, column)];
        }
    }
    sum
}
