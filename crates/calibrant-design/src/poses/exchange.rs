//! The exchange of poses for others of a list (`fedorov1972`).
//!
//! One pose after the other is replaced by the direction of the list that lowers the criterion most, until a round changes nothing. Where the
//! poses are hardly more than the parameters, that ends far from the best: a pose that alone determines something must not go, though another
//! pair would do better. So pairs of poses are exchanged too, where there are not too many of them.

use super::hold_information::HoldInformation;
use crate::criterion::SmoothCriterion;
use calibrant_core::information::covariance;
use nalgebra::{DMatrix, Vector3};

/// Rounds over all poses.
const ROUNDS: usize = 50;
/// Relative decrease below which a replacement is rounding.
const ROUNDING: f64 = 1e-10;
/// Exchanges of two poses up to which all are tried: a round takes some hundredths of a second.
const PAIRS: usize = 10_000;

/// The number of exchanges of two poses that are tried in a round.
pub(super) fn pairs(poses: usize, directions: usize) -> usize {
    let count = poses.saturating_mul(poses.saturating_sub(1)) / 2;
    let all = count.saturating_mul(directions.saturating_mul(directions + 1) / 2);
    if all > PAIRS { 0 } else { all }
}

/// The poses after the exchange; `of_pairs`: of two at once, too. Where directions then move, single exchanges are enough.
pub(super) fn exchange(
    information: &HoldInformation,
    criterion: SmoothCriterion<'_>,
    list: &[Vector3<f64>],
    poses: Vec<Vector3<f64>>,
    of_pairs: bool,
) -> Vec<Vector3<f64>> {
    let of_poses: Vec<_> = poses.iter().map(|u| information.of_hold(u)).collect();
    let sum = of_poses.iter().fold(information.prior().clone(), |sum, of_pose| sum + of_pose);
    let candidates: Vec<_> = list.iter().map(|u| information.of_hold(u)).collect();
    let least = value(criterion, &sum);
    let mut search = Exchange { criterion, list, candidates, poses, of_poses, sum, least };
    for _ in 0..ROUNDS {
        let before = search.least;
        search.singles();
        if of_pairs && search.least >= before && pairs(search.poses.len(), list.len()) > 0 {
            search.pairs();
        }
        if search.least.partial_cmp(&before) != Some(std::cmp::Ordering::Less) {
            break;
        }
    }
    search.poses
}

fn value(criterion: SmoothCriterion<'_>, sum: &DMatrix<f64>) -> f64 {
    covariance(sum).map_or(f64::INFINITY, |c| criterion.at(&c).0)
}

/// The poses, and the candidates for them, with the information of each.
struct Exchange<'a> {
    criterion: SmoothCriterion<'a>,
    list: &'a [Vector3<f64>],
    candidates: Vec<DMatrix<f64>>,
    poses: Vec<Vector3<f64>>,
    of_poses: Vec<DMatrix<f64>>,
    sum: DMatrix<f64>,
    least: f64,
}

impl Exchange<'_> {
    /// Replaces each pose by the best candidate.
    fn singles(&mut self) {
        for k in 0..self.poses.len() {
            let without = &self.sum - &self.of_poses[k];
            for candidate in 0..self.list.len() {
                let sum = &without + &self.candidates[candidate];
                self.take_if_better(sum, &[(k, candidate)]);
            }
        }
    }

    /// Replaces each pair of poses by the best pair of candidates.
    fn pairs(&mut self) {
        for (k, l) in (0..self.poses.len()).flat_map(|k| (0..k).map(move |l| (k, l))) {
            let without = &self.sum - &self.of_poses[k] - &self.of_poses[l];
            for one in 0..self.list.len() {
                let with_one = &without + &self.candidates[one];
                for other in 0..=one {
                    let sum = &with_one + &self.candidates[other];
                    self.take_if_better(sum, &[(k, one), (l, other)]);
                }
            }
        }
    }

    fn take_if_better(&mut self, sum: DMatrix<f64>, replaced: &[(usize, usize)]) {
        let found = value(self.criterion, &sum);
        if found < self.least - ROUNDING {
            (self.least, self.sum) = (found, sum);
            for &(pose, candidate) in replaced {
                self.poses[pose] = self.list[candidate];
                self.of_poses[pose] = self.candidates[candidate].clone();
            }
        }
    }
}
