//! The order in which the poses are taken.
//!
//! Three things depend on it. A drift of the bias must look like no parameter (`drift`). The turns of an IMU
//! must determine its gyroscope (`turns`). An accelerometer alone should need little turning. The order
//! minimises
//!
//! `−ln e + ln v` with a gyroscope, `−ln e + κ s` without,
//!
//! where e is the efficiency that the drift leaves, v the variance of the gyroscope's matrix and s the mean
//! turn. So one per cent of the one counts as one per cent of the other. Two poses in a row that are nearly the
//! same would be one hold in the recording, and are kept apart.
//!
//! Starts are the way from each pose to the nearest that is left, and random orders. Each is improved by
//! reversals of a part (2-opt, `croes1958`) and exchanges of two poses, as long as one helps.

use super::drift::Drift;
use super::problem::PoseProblem;
use super::result::efficiency;
use super::turns::{gyroscope_variance, mean_turn};
use calibrant_core::simulate::{Purpose, stream};
use nalgebra::Vector3;
use rand::seq::SliceRandom;

/// Relative variance that a radian of mean turn is worth.
const TURN: f64 = 0.02;
/// Angle below which two poses in a row look like one hold, rad, and its price.
const ONE_HOLD: f64 = 0.1;
const PRICE: f64 = 10.0;
/// Random orders to begin with.
const STARTS: u64 = 3;
/// Rounds over all pairs.
const ROUNDS: usize = 40;
/// Decrease below which a change is rounding.
const ROUNDING: f64 = 1e-9;

/// The best order found, as positions in `directions`.
pub(super) fn best_order(
    problem: &PoseProblem,
    directions: &[Vector3<f64>],
    drift: &Drift,
    seed: u64,
) -> Vec<usize> {
    let without = problem.criterion.value(drift.without());
    let cost = |order: &[usize]| cost(problem, directions, (drift, without), order);
    let mut found = improved(&cost, nearest_next(directions));
    for number in 0..STARTS {
        let mut order: Vec<usize> = (0..directions.len()).collect();
        order.shuffle(&mut stream(seed, Purpose::Motion, 2 + number));
        let other = improved(&cost, order);
        if other.0 < found.0 - ROUNDING {
            found = other;
        }
    }
    found.1
}

/// `without`: the criterion without a drift.
fn cost(
    problem: &PoseProblem,
    directions: &[Vector3<f64>],
    (drift, without): (&Drift, f64),
    order: &[usize],
) -> f64 {
    let ordered: Vec<Vector3<f64>> = order.iter().map(|&k| directions[k]).collect();
    let criterion = &problem.criterion;
    let value = criterion.value(&drift.covariance(order));
    let lost = -efficiency(criterion, value, without, problem.list.len()).ln();
    let same = ordered.windows(2).filter(|pair| pair[0].angle(&pair[1]) < ONE_HOLD).count();
    lost + PRICE * same as f64
        + if problem.nuisance.has_gyroscope {
            gyroscope_variance(&ordered).ln()
        } else {
            TURN * mean_turn(&ordered)
        }
}

/// The order after all changes of two places that help, with its cost.
fn improved(cost: &impl Fn(&[usize]) -> f64, mut order: Vec<usize>) -> (f64, Vec<usize>) {
    let mut least = cost(&order);
    for _ in 0..ROUNDS {
        let before = least;
        for first in 0..order.len() {
            for last in first + 1..order.len() {
                for change in [<[usize]>::reverse, |part: &mut [usize]| part.swap(0, part.len() - 1)] {
                    change(&mut order[first..=last]);
                    let found = cost(&order);
                    if found < least - ROUNDING {
                        least = found;
                    } else {
                        change(&mut order[first..=last]);
                    }
                }
            }
        }
        if least >= before {
            break;
        }
    }
    (least, order)
}

/// From the direction nearest to z up on, always to the nearest that is left.
fn nearest_next(directions: &[Vector3<f64>]) -> Vec<usize> {
    let mut left: Vec<usize> = (0..directions.len()).collect();
    let mut here = Vector3::z();
    let mut order = Vec::new();
    while !left.is_empty() {
        let distance = |&place: &usize| directions[left[place]].angle(&here);
        let next = (0..left.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0);
        let pose = left.remove(next);
        here = directions[pose];
        order.push(pose);
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poses::hold_information::HoldInformation;
    use crate::poses::spectral_projected_gradient::Poses;
    use crate::poses::tests::problem;
    use crate::poses::{Allowed, DirectionKnowledge, PoseNuisance};

    /// The six faces: all 720 orders.
    fn every_order() -> Vec<Vec<usize>> {
        let mut orders = vec![Vec::new()];
        for place in 0..6 {
            orders = orders
                .into_iter()
                .flat_map(|order: Vec<usize>| {
                    (0..=place).map(move |at| {
                        let mut longer = order.clone();
                        longer.insert(at, place);
                        longer
                    })
                })
                .collect();
        }
        orders
    }

    #[test]
    fn poses_that_are_taken_twice_are_not_taken_in_a_row() {
        let Allowed::Of(faces) = Allowed::cube(false, false) else { panic!("a list") };
        let twice: Vec<_> = faces.iter().flat_map(|u| [*u, *u]).collect();
        let problem = problem(DirectionKnowledge::Known { sd_rad: 0.0 }, 12);
        let information = HoldInformation::new(&problem).expect("regular");
        let without = Poses::equal(twice.clone()).covariance(&information).expect("determined");
        let drift = Drift::of(&information, &twice, without, &Vector3::zeros());
        let order = best_order(&problem, &twice, &drift, 1);
        assert!(order.windows(2).all(|pair| twice[pair[0]] != twice[pair[1]]), "{order:?}");
    }

    #[test]
    fn no_other_order_of_the_six_faces_is_better() {
        let Allowed::Of(faces) = Allowed::cube(false, false) else { panic!("a list") };
        for has_gyroscope in [false, true] {
            for drift_sd in [0.0, 0.02] {
                let mut problem = problem(DirectionKnowledge::Known { sd_rad: 1e-3 }, 6);
                problem.nuisance =
                    PoseNuisance { gravity_sd_mps2: 0.0, drift_sd: Vector3::repeat(drift_sd), has_gyroscope };
                let information = HoldInformation::new(&problem).expect("regular");
                let without = Poses::equal(faces.clone()).covariance(&information).expect("determined");
                let drift = Drift::of(&information, &faces, without, &problem.nuisance.drift_sd);
                let of = |order: &[usize]| {
                    cost(&problem, &faces, (&drift, problem.criterion.value(drift.without())), order)
                };
                let orders = every_order();
                assert_eq!(orders.len(), 720);
                let least = orders.iter().map(|order| of(order)).fold(f64::INFINITY, f64::min);
                let found = of(&best_order(&problem, &faces, &drift, 1));
                assert!(found < least + 1e-9, "{has_gyroscope} {drift_sd}: {found} {least}");
                let first = of(&[0, 1, 2, 3, 4, 5]);
                println!("{has_gyroscope} {drift_sd}: {found}, as listed {first}");
            }
        }
    }
}
