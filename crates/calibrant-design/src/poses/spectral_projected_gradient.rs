//! The spectral projected gradient method on poses and their shares (`birgin2000`).
//!
//! Each step goes against the gradient, is projected onto the allowed directions and shares, and has the
//! length of Barzilai and Borwein, `⟨s, s⟩ / ⟨s, y⟩` with s the last step and y the change of the gradient. A
//! step is halved until the value is below the largest of the last few. The projection of a direction is the
//! nearest allowed one. That of the shares onto `Σ w = n, w ≥ 0` shifts all by one number and cuts at zero.

use super::allowed::Allowed;
use super::hold_information::HoldInformation;
use crate::criterion::SmoothCriterion;
use calibrant_core::information::covariance;
use nalgebra::{DMatrix, Vector3};

/// Directions, and the number of poses at each of them.
#[derive(Clone)]
pub(super) struct Poses {
    pub(super) directions: Vec<Vector3<f64>>,
    pub(super) shares: Vec<f64>,
}

/// What a descent may change, and how long it may go on.
#[derive(Clone, Copy)]
pub(super) struct Descent<'a> {
    pub(super) information: &'a HoldInformation,
    pub(super) allowed: &'a Allowed,
    pub(super) criterion: SmoothCriterion<'a>,
    /// May the shares change?
    pub(super) moves_shares: bool,
    pub(super) iterations: usize,
}

/// Values that a step may not exceed.
const MEMORY: usize = 8;
/// Largest change of a direction (rad) or relative change of a share with which the descent ends.
const TOLERANCE: f64 = 1e-8;
/// Decrease that a step must bring, as a share of that of its slope.
const SUFFICIENT: f64 = 1e-4;

impl Poses {
    pub(super) fn equal(directions: Vec<Vector3<f64>>) -> Self {
        let shares = vec![1.0; directions.len()];
        Self { directions, shares }
    }

    pub(super) fn covariance(&self, information: &HoldInformation) -> Option<DMatrix<f64>> {
        let sum = information.sum(self.directions.iter().zip(self.shares.iter().copied()));
        covariance(&information.of_parameters(&sum))
    }
}

/// A point of the descent: the value, and its gradient along directions and relative shares.
struct Point {
    poses: Poses,
    value: f64,
    slopes: Vec<Vector3<f64>>,
    gains: Vec<f64>,
}

impl Descent<'_> {
    /// Poses that are better than `start` as far as steps lead down; `None` where `start` determines too
    /// little.
    pub(super) fn run(&self, start: Poses) -> Option<Poses> {
        let mut here = self.point(start)?;
        let mut values = vec![here.value; 1];
        let mut length = 0.1 / here.slopes.iter().map(Vector3::norm).fold(1e-9, f64::max);
        for _ in 0..self.iterations {
            let highest = values.iter().rev().take(MEMORY).copied().fold(f64::NEG_INFINITY, f64::max);
            let Some((next, moved)) = self.step(&here, length, highest) else { break };
            let (along, change) = self.products(&here, &next);
            length = if change > 0.0 { (along / change).clamp(1e-12, 1e6) } else { 10.0 * length };
            here = next;
            values.push(here.value);
            if moved < TOLERANCE {
                break;
            }
        }
        Some(here.poses)
    }

    /// The next point, and the largest change.
    fn step(&self, here: &Point, length: f64, highest: f64) -> Option<(Point, f64)> {
        let mut length = length;
        for _ in 0..40 {
            let trial = self.project(here, length);
            let (moved, slope) = self.difference(here, &trial);
            if moved == 0.0 {
                return None;
            }
            if let Some(point) = self.point(trial)
                && point.value <= highest + SUFFICIENT * slope
            {
                return Some((point, moved));
            }
            length *= 0.3;
        }
        None
    }

    fn project(&self, here: &Point, length: f64) -> Poses {
        let mut next = here.poses.clone();
        if self.allowed.is_continuous() {
            for (u, slope) in next.directions.iter_mut().zip(&here.slopes) {
                *u = self.allowed.nearest(&(*u - slope * length));
            }
        }
        if self.moves_shares {
            let scale = self.scale(&here.poses);
            let all: f64 = next.shares.iter().sum();
            for (share, gain) in next.shares.iter_mut().zip(&here.gains) {
                *share += gain * length * scale * scale;
            }
            next.shares = with_sum(&next.shares, all);
        }
        next
    }

    /// Mean share. Shares count relative to it.
    fn scale(&self, poses: &Poses) -> f64 {
        poses.shares.iter().sum::<f64>() / poses.shares.len() as f64
    }

    /// Largest change between two points, and the change of the value that the slope at the first promises.
    fn difference(&self, here: &Point, trial: &Poses) -> (f64, f64) {
        let scale = self.scale(&here.poses);
        let (mut moved, mut slope) = (0.0_f64, 0.0);
        for (k, (u, next)) in here.poses.directions.iter().zip(&trial.directions).enumerate() {
            let step = next - u;
            let share = trial.shares[k] - here.poses.shares[k];
            moved = moved.max(step.norm()).max((share / scale).abs());
            slope += here.slopes[k].dot(&step) - here.gains[k] * share;
        }
        (moved, slope.min(0.0))
    }

    /// `⟨s, s⟩` and `⟨s, y⟩`.
    fn products(&self, here: &Point, next: &Point) -> (f64, f64) {
        let scale = self.scale(&here.poses);
        let (mut along, mut change) = (0.0, 0.0);
        for k in 0..here.slopes.len() {
            let step = next.poses.directions[k] - here.poses.directions[k];
            let share = next.poses.shares[k] - here.poses.shares[k];
            along += step.norm_squared() + (share / scale).powi(2);
            change += step.dot(&(next.slopes[k] - here.slopes[k]));
            if self.moves_shares {
                change -= share * (next.gains[k] - here.gains[k]);
            }
        }
        (along, change)
    }

    fn point(&self, poses: Poses) -> Option<Point> {
        let c = poses.covariance(self.information)?;
        let (value, derivative) = self.criterion.at(&c);
        let gain = self.information.gain(&(&c * derivative * &c));
        let slopes = poses.directions.iter().zip(&poses.shares).map(|(u, &share)| {
            if self.allowed.is_continuous() { -gain.slope(u) * share } else { Vector3::zeros() }
        });
        let slopes = slopes.collect();
        let gains = poses.directions.iter().map(|u| gain.at(u)).collect();
        value.is_finite().then_some(Point { poses, value, slopes, gains })
    }
}

/// The nearest numbers, none below zero, with this sum.
fn with_sum(values: &[f64], sum: f64) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(|a, b| b.total_cmp(a));
    let (mut total, mut shift) = (0.0, 0.0);
    for (k, value) in sorted.iter().enumerate() {
        total += value;
        let candidate = (total - sum) / (k + 1) as f64;
        if *value > candidate {
            shift = candidate;
        }
    }
    values.iter().map(|value| (value - shift).max(0.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::with_sum;

    #[test]
    fn shares_are_projected_onto_those_with_their_sum() {
        assert_eq!(with_sum(&[1.0, 2.0, 3.0], 6.0), [1.0, 2.0, 3.0]);
        assert_eq!(with_sum(&[0.0, 0.0, 3.0], 1.0), [0.0, 0.0, 1.0]);
        assert_eq!(with_sum(&[1.0, 1.0], 4.0), [2.0, 2.0]);
    }
}
