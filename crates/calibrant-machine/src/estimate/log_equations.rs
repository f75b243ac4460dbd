//! The normal equations of the reference's log: it measures the control points.

use super::moments::Moments;
use super::robust::huber;
use crate::log::{JointLog, PoseLog, ReferenceLog};
use crate::reference::Motion;
use crate::reference::PoseMotion;
use crate::spline::{VectorSpline, Weights, rotation_sensitivity};
use nalgebra::{DMatrix, DVector, Vector3};
use std::ops::Range;

/// The log with its noise.
#[derive(Debug, Clone)]
pub(super) struct WeighedLog<'a> {
    pub(super) log: &'a ReferenceLog,
    /// Standard deviation of one sample, for each unknown of a control point.
    pub(super) sd: Vec<f64>,
    /// How many times larger the noise of each sample is. Empty: everywhere 1.
    pub(super) growth: Vec<f64>,
}

impl WeighedLog<'_> {
    /// Adds the samples of these places to the normal equations of their interval. The last column is the right side. Returns their cost `2ρ`.
    pub(super) fn add(&self, samples: Range<usize>, motion: &Motion, equations: &mut DMatrix<f64>) -> f64 {
        match (self.log, motion) {
            (ReferenceLog::Joints(log), Motion::Joints(joints)) => {
                samples.map(|k| self.add_joints(log, k, &joints.positions, equations)).sum()
            }
            (ReferenceLog::Poses(log), Motion::Poses(poses)) => {
                self.add_poses(log, samples, poses, equations)
            }
            _ => 0.0,
        }
    }

    /// Standard deviation of sample `k`.
    fn sd(&self, component: usize, k: usize) -> f64 {
        self.sd[component] * self.growth.get(k).copied().unwrap_or(1.0)
    }

    fn add_joints(
        &self,
        log: &JointLog,
        k: usize,
        spline: &VectorSpline,
        equations: &mut DMatrix<f64>,
    ) -> f64 {
        let weights = spline.knots.weights(log.times_s[k]);
        let (n, right) = (spline.dimension, equations.ncols() - 1);
        let mut cost = 0.0;
        for (j, seen) in log.row(k).iter().enumerate().filter(|(_, seen)| seen.is_finite()) {
            let sd = self.sd(j, k);
            let whitened = (seen - spline.component(&weights, 0, j)) / sd;
            let (weight, part) = huber(whitened);
            cost += part;
            let scale = weight / sd;
            for r in 0..weights.order {
                let one = scale * weights.derivative[0][r];
                for s in 0..weights.order {
                    equations[(n * r + j, n * s + j)] += one * scale * weights.derivative[0][s];
                }
                let towards = one * weight * whitened;
                equations[(n * r + j, right)] += towards;
                equations[(right, n * r + j)] += towards;
            }
        }
        cost
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
                cost += self.add_position(k, &weights, &(position - fitted), equations);
            }
            if let Some(orientation) = &log.world_from_body[k] {
                cost += self.add_orientation(k, &weights, motion, orientation, equations);
            }
        }
        cost
    }

    fn add_position(
        &self,
        k: usize,
        weights: &Weights,
        residual: &Vector3<f64>,
        equations: &mut DMatrix<f64>,
    ) -> f64 {
        let (right, mut cost) = (equations.ncols() - 1, 0.0);
        for j in 0..3 {
            let sd = self.sd(j, k);
            let whitened = residual[j] / sd;
            let (weight, part) = huber(whitened);
            cost += part;
            let scale = weight / sd;
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
        k: usize,
        weights: &Weights,
        motion: &PoseMotion,
        seen: &nalgebra::UnitQuaternion<f64>,
        equations: &mut DMatrix<f64>,
    ) -> f64 {
        let (right, mut cost) = (equations.ncols() - 1, 0.0);
        let sensitivity = rotation_sensitivity(&motion.orientation, weights);
        let residual = (sensitivity.at.world_from_body.inverse() * seen).scaled_axis();
        for axis in 0..3 {
            let sd = self.sd(3 + axis, k);
            let whitened = residual[axis] / sd;
            let (weight, part) = huber(whitened);
            cost += part;
            let scale = weight / sd;
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
        (local, step): (&DMatrix<f64>, &DVector<f64>),
        moments: &mut [Moments],
    ) {
        match (self.log, motion) {
            (ReferenceLog::Joints(log), Motion::Joints(joints)) => {
                let (spline, n) = (&joints.positions, joints.positions.dimension);
                for k in samples {
                    let weights = spline.knots.weights(log.times_s[k]);
                    for (j, seen) in log.row(k).iter().enumerate().filter(|(_, seen)| seen.is_finite()) {
                        let of = |r: usize, _: usize| (n * r + j, weights.derivative[0][r]);
                        let residual = seen - spline.component(&weights, 0, j);
                        let after = after_step(residual, local, step, (weights.order, 1), of);
                        self.add_moment(j, k, after, moments);
                    }
                }
            }
            (ReferenceLog::Poses(log), Motion::Poses(poses)) => {
                for k in samples {
                    let weights = poses.position.knots.weights(log.times_s[k]);
                    if let Some(position) = &log.positions_m[k] {
                        for j in 0..3 {
                            let fitted = poses.position.component(&weights, 0, j);
                            let of = |r: usize, _: usize| (6 * r + j, weights.derivative[0][r]);
                            let after = after_step(position[j] - fitted, local, step, (weights.order, 1), of);
                            self.add_moment(j, k, after, moments);
                        }
                    }
                    if let Some(seen) = &log.world_from_body[k] {
                        let sensitivity = rotation_sensitivity(&poses.orientation, &weights);
                        let residual = (sensitivity.at.world_from_body.inverse() * seen).scaled_axis();
                        for axis in 0..3 {
                            let of =
                                |r: usize, a: usize| (6 * r + 3 + a, sensitivity.controls[r].turn[(axis, a)]);
                            let after = after_step(residual[axis], local, step, (weights.order, 3), of);
                            self.add_moment(3 + axis, k, after, moments);
                        }
                    }
                }
            }
            _ => {}
        }
    }

    /// Time and mean square of the whitened residuals of each sample.
    pub(super) fn squares<'b>(&'b self, motion: &'b Motion) -> impl Iterator<Item = (f64, f64)> + 'b {
        let times = self.log.times_s();
        (0..times.len()).filter_map(move |k| {
            let weights = motion.knots().weights(times[k]);
            let whitened: Vec<f64> = match (self.log, motion) {
                (ReferenceLog::Joints(log), Motion::Joints(joints)) => {
                    let of =
                        |j: usize| (log.row(k)[j] - joints.positions.component(&weights, 0, j)) / self.sd[j];
                    (0..log.names.len()).map(of).filter(|r| r.is_finite()).collect()
                }
                (ReferenceLog::Poses(log), Motion::Poses(poses)) => {
                    let position = log.positions_m[k]?;
                    let seen = log.world_from_body[k]?;
                    let turn =
                        (poses.orientation.with(&weights).world_from_body.inverse() * seen).scaled_axis();
                    let of = |j: usize| {
                        let residual = match j {
                            0..3 => position[j] - poses.position.component(&weights, 0, j),
                            _ => turn[j - 3],
                        };
                        residual / self.sd[j]
                    };
                    (0..6).map(of).collect()
                }
                _ => return None,
            };
            let mean = whitened.iter().map(|r| r * r).sum::<f64>() / whitened.len() as f64;
            (mean < 50.0).then_some((times[k], mean))
        })
    }

    fn add_moment(
        &self,
        component: usize,
        k: usize,
        (residual, variance): (f64, f64),
        moments: &mut [Moments],
    ) {
        let sd = self.sd(component, k);
        let whitened = residual / sd;
        let (weight, _) = huber(whitened);
        let scale = weight / sd;
        moments[component].add(weight * whitened, scale * scale * variance);
    }
}

/// A residual after the step, and the variance of what was fitted: both are sums over control points, of which `of` tells place and factor.
fn after_step(
    residual: f64,
    local: &DMatrix<f64>,
    step: &DVector<f64>,
    (order, terms): (usize, usize),
    of: impl Fn(usize, usize) -> (usize, f64),
) -> (f64, f64) {
    let places = || (0..order).flat_map(|r| (0..terms).map(move |a| (r, a)));
    let (mut moved, mut variance) = (0.0, 0.0);
    for (r, a) in places() {
        let (row, one) = of(r, a);
        moved += one * step[row];
        for (s, b) in places() {
            let (column, other) = of(s, b);
            variance += one * other * local[(row, column)];
        }
    }
    (residual - moved, variance)
}
