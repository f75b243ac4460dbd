//! The log as measurements of the control points.

use super::{Moments, huber};
use crate::log::ReferenceLog;
use crate::reference::{Motion, POSE_UNKNOWNS};
use crate::spline::rotation_sensitivity;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// The log with its noise.
#[derive(Debug, Clone)]
pub(crate) struct WeighedLog<'a> {
    pub(crate) log: &'a ReferenceLog,
    /// Standard deviation of one sample, for each unknown of a control point.
    pub(crate) sd: Vec<f64>,
    /// The part of it that is rounding: less noise than this is not found.
    pub(crate) rounding_sd: Vec<f64>,
    /// How many times larger the noise of each sample is. Empty: everywhere 1.
    pub(crate) growth: Vec<f64>,
}

/// One component of one sample.
pub(crate) struct Measured<'e> {
    pub(crate) sample: usize,
    pub(crate) component: usize,
    pub(crate) residual: f64,
    /// Derivative of the fitted value: place among the control points of the interval, and factor.
    derivative: &'e [(usize, f64)],
}

impl WeighedLog<'_> {
    /// Number of samples of a component.
    pub(crate) fn samples(&self, component: usize) -> usize {
        match self.log {
            ReferenceLog::Joints(log) => {
                let n = log.names.len();
                log.positions[component..].iter().step_by(n).filter(|seen| seen.is_finite()).count()
            }
            ReferenceLog::Poses(log) if component < 3 => log.positions_m.iter().flatten().count(),
            ReferenceLog::Poses(log) => log.world_from_body.iter().flatten().count(),
        }
    }

    /// Calls with each component of these samples.
    pub(crate) fn visit(&self, samples: Range<usize>, motion: &Motion, mut visit: impl FnMut(&Measured<'_>)) {
        let (times, mut derivative) = (self.log.times_s(), Vec::new());
        let mut found = |sample: usize, component: usize, residual: f64, derivative: &[(usize, f64)]| {
            visit(&Measured { sample, component, residual, derivative });
        };
        match (self.log, motion) {
            (ReferenceLog::Joints(log), Motion::Joints(joints)) => {
                let (spline, n) = (&joints.positions, joints.positions.dimension);
                for k in samples {
                    let weights = spline.knots.weights(times[k]);
                    for (j, seen) in log.row(k).iter().enumerate().filter(|(_, seen)| seen.is_finite()) {
                        derivative.clear();
                        derivative.extend((0..weights.order).map(|r| (n * r + j, weights.derivative[0][r])));
                        found(k, j, seen - spline.component(&weights, 0, j), &derivative);
                    }
                }
            }
            (ReferenceLog::Poses(log), Motion::Poses(poses)) => {
                for k in samples {
                    let weights = poses.position.knots.weights(times[k]);
                    let place = |r: usize, component: usize| POSE_UNKNOWNS * r + component;
                    for (j, seen) in log.positions_m[k].iter().flat_map(|seen| seen.iter().enumerate()) {
                        derivative.clear();
                        derivative
                            .extend((0..weights.order).map(|r| (place(r, j), weights.derivative[0][r])));
                        found(k, j, seen - poses.position.component(&weights, 0, j), &derivative);
                    }
                    let Some(seen) = &log.world_from_body[k] else { continue };
                    let of = rotation_sensitivity(&poses.orientation, &weights);
                    let residual = (of.at.world_from_body.inverse() * seen).scaled_axis();
                    for axis in 0..3 {
                        derivative.clear();
                        let turns = of.controls[..weights.order].iter().enumerate();
                        derivative.extend(turns.flat_map(|(r, control)| {
                            (0..3).map(move |a| (place(r, 3 + a), control.turn[(axis, a)]))
                        }));
                        found(k, 3 + axis, residual[axis], &derivative);
                    }
                }
            }
            _ => {}
        }
    }

    /// Adds the samples of these places to the normal equations of their interval. The last column is the right side. Returns their cost `2ρ`.
    pub(crate) fn add(&self, samples: Range<usize>, motion: &Motion, equations: &mut DMatrix<f64>) -> f64 {
        let (right, mut cost) = (equations.ncols() - 1, 0.0);
        self.visit(samples, motion, |of| {
            let whitened = of.residual / self.sd(of);
            let (weight, part) = huber(whitened);
            cost += part;
            let scale = weight / self.sd(of);
            for &(row, one) in of.derivative {
                for &(column, other) in of.derivative {
                    equations[(row, column)] += scale * one * scale * other;
                }
                let towards = scale * one * weight * whitened;
                equations[(row, right)] += towards;
                equations[(right, row)] += towards;
            }
        });
        cost
    }

    /// Adds residuals after a step, and leverages, to the sums of each component. `local` is the covariance of the interval's control points first.
    pub(crate) fn add_moments(
        &self,
        samples: Range<usize>,
        motion: &Motion,
        (local, step): (&DMatrix<f64>, &DVector<f64>),
        moments: &mut [Moments],
    ) {
        self.visit(samples, motion, |of| {
            let (mut moved, mut variance) = (0.0, 0.0);
            for &(row, one) in of.derivative {
                moved += one * step[row];
                let column = of.derivative.iter().map(|&(column, other)| other * local[(row, column)]);
                variance += one * column.sum::<f64>();
            }
            let whitened = (of.residual - moved) / self.sd(of);
            let (weight, _) = huber(whitened);
            let scale = weight / self.sd(of);
            moments[of.component].add(weight * whitened, scale * scale * variance);
        });
    }

    fn sd(&self, of: &Measured<'_>) -> f64 {
        self.sd[of.component] * self.growth.get(of.sample).copied().unwrap_or(1.0)
    }
}
