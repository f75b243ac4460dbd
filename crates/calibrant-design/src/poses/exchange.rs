//! The exchange of poses for others of a list (`fedorov1972`).
//!
//! One pose after the other is replaced by the direction of the list that lowers the criterion most. It ends
//! after a round without a change.

use super::hold_information::{HoldInformation, OnEntries};
use crate::criterion::smooth_criterion::SmoothCriterion;
use calibrant_core::information::covariance;
use nalgebra::Vector3;

/// Rounds over all poses.
const ROUNDS: usize = 50;
/// Relative decrease below which a replacement is rounding.
const ROUNDING: f64 = 1e-10;

/// The poses after the exchange.
pub(super) fn exchange(
    information: &HoldInformation,
    criterion: SmoothCriterion<'_>,
    list: &[Vector3<f64>],
    mut poses: Vec<Vector3<f64>>,
) -> Vec<Vector3<f64>> {
    let of = |u: &Vector3<f64>| information.sum(std::iter::once((u, 1.0)));
    let value = |sum: &OnEntries| {
        covariance(&information.of_parameters(sum)).map_or(f64::INFINITY, |c| criterion.at(&c).0)
    };
    let candidates: Vec<OnEntries> = list.iter().map(of).collect();
    let mut sum = information.sum(poses.iter().map(|u| (u, 1.0)));
    let mut least = value(&sum);
    for _ in 0..ROUNDS {
        let before = least;
        for pose in &mut poses {
            let without = sum - of(pose);
            for (candidate, u) in candidates.iter().zip(list) {
                let trial = without + candidate;
                let found = value(&trial);
                if found < least - ROUNDING {
                    (least, sum, *pose) = (found, trial, *u);
                }
            }
        }
        if least.partial_cmp(&before) != Some(std::cmp::Ordering::Less) {
            break;
        }
    }
    poses
}
