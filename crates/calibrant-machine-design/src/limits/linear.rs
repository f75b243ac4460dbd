//! Limits of joints on control points: position, velocity, acceleration, jerk. They hold for all times.
//!
//! A row is a difference of order `d` of the control points of a joint, divided by `hᵈ`. Its two slacks are `1 − y` and `1 + y` of `y = (value − middle)/half`.
//! A row whose control points share one unknown, or have none, is constant and left out.

use super::JointLimit;
use crate::motion::{Knots, Ties};
use nalgebra::DMatrix;

/// Differences of order 0 to 3.
const DIFFERENCES: [[f64; 4]; 4] =
    [[1.0, 0.0, 0.0, 0.0], [-1.0, 1.0, 0.0, 0.0], [1.0, -2.0, 1.0, 0.0], [-1.0, 3.0, -3.0, 1.0]];

/// One row on one joint.
#[derive(Debug, Clone)]
struct Row {
    joint: usize,
    /// Its unknowns of that joint, and their factors.
    terms: Vec<(usize, f64)>,
    /// What control points that are given add.
    constant: f64,
}

/// All rows.
#[derive(Debug, Clone)]
pub(crate) struct Linear {
    rows: Vec<Row>,
    joints: usize,
}

impl Linear {
    /// The limits of these joints, of which a part is held back.
    pub(crate) fn new(limits: &[JointLimit], knots: &Knots, ties: &Ties) -> Self {
        let mut rows: Vec<Row> = Vec::new();
        let rest = ties.controls_of(&vec![0.0; ties.len()]);
        for (joint, limit) in limits.iter().enumerate() {
            let bounds = [
                (limit.lower, limit.upper),
                (-limit.velocity, limit.velocity),
                (-limit.acceleration, limit.acceleration),
                (-limit.jerk, limit.jerk),
            ];
            for (order, (lower, upper)) in bounds.into_iter().enumerate() {
                if !(upper - lower).is_finite() {
                    continue;
                }
                let (middle, half) = ((lower + upper) / 2.0, (upper - lower) / 2.0);
                let scale = 1.0 / (knots.step_s.powi(order as i32) * half);
                let mut last: Option<Row> = None;
                for first in 0..ties.controls() - order {
                    let mut terms: Vec<(usize, f64)> = Vec::new();
                    let mut constant = -middle / half;
                    for (r, factor) in DIFFERENCES[order].iter().enumerate().take(order + 1) {
                        constant += factor * scale * rest[(first + r, joint)];
                        if let Some(unknown) = ties.of(first + r) {
                            let factor = factor * scale * ties.size(joint);
                            match terms.iter_mut().find(|(of, _)| *of == unknown) {
                                Some((_, sum)) => *sum += factor,
                                None => terms.push((unknown, factor)),
                            }
                        }
                    }
                    terms.retain(|(_, factor)| factor.abs() > 1e-12 * scale);
                    let repeated = last.as_ref().is_some_and(|last| last.terms == terms);
                    if !terms.is_empty() && !repeated {
                        let row = Row { joint, terms, constant };
                        rows.push(row.clone());
                        last = Some(row);
                    }
                }
            }
        }
        Self { rows, joints: limits.len() }
    }

    /// Number of slacks.
    pub(crate) fn len(&self) -> usize {
        2 * self.rows.len()
    }

    /// `1 − y` and `1 + y` of each row.
    pub(crate) fn slacks(&self, x: &[f64], slacks: &mut [f64]) {
        for (row, slacks) in self.rows.iter().zip(slacks.chunks_exact_mut(2)) {
            let y = row.constant + self.product(row, x);
            (slacks[0], slacks[1]) = (1.0 - y, 1.0 + y);
        }
    }

    /// How the slacks change along a direction.
    pub(crate) fn changes(&self, direction: &[f64], changes: &mut [f64]) {
        for (row, changes) in self.rows.iter().zip(changes.chunks_exact_mut(2)) {
            let y = self.product(row, direction);
            (changes[0], changes[1]) = (-y, y);
        }
    }

    fn product(&self, row: &Row, x: &[f64]) -> f64 {
        row.terms.iter().map(|(unknown, factor)| factor * x[unknown * self.joints + row.joint]).sum()
    }

    /// Adds `Σ multiplier · ∂slack/∂x`.
    pub(crate) fn add_transposed(&self, multipliers: &[f64], out: &mut [f64]) {
        for (row, of) in self.rows.iter().zip(multipliers.chunks_exact(2)) {
            for (unknown, factor) in &row.terms {
                out[unknown * self.joints + row.joint] += factor * (of[1] - of[0]);
            }
        }
    }

    /// Adds `Σ weight · ∂slack ∂slackᵀ` entry by entry of the lower triangle.
    pub(crate) fn add_squares(&self, weights: &[f64], mut add: impl FnMut(usize, usize, f64)) {
        for (row, of) in self.rows.iter().zip(weights.chunks_exact(2)) {
            let weight = of[0] + of[1];
            for (a, (one, factor)) in row.terms.iter().enumerate() {
                for (other, other_factor) in &row.terms[..=a] {
                    let (high, low) = (one.max(other), one.min(other));
                    let place = |unknown: usize| unknown * self.joints + row.joint;
                    add(place(*high), place(*low), weight * factor * other_factor);
                }
            }
        }
    }
}

/// The motion's use of the limits, without ties: whether a motion keeps them, and with how much room.
pub(crate) fn least_slack(limits: &[JointLimit], knots: &Knots, controls: &DMatrix<f64>) -> f64 {
    let ties = Ties::untied(controls.nrows(), limits.len());
    let linear = Linear::new(limits, knots, &ties);
    let mut slacks = vec![0.0; linear.len()];
    linear.slacks(&ties.unknowns_of(controls), &mut slacks);
    slacks.into_iter().fold(f64::INFINITY, f64::min)
}
