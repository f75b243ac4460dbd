//! The order in which the poses are taken, and what turns and a drift between them add.
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
//!
//! The turns between poses, and what they tell of a gyroscope.
//!
//! Between two holds the sensor is turned by the shortest way, about the axis `e ∝ u_j × u_i` by the angle θ
//! between the directions. The gyroscope's readings, integrated from the first hold, predict the direction in
//! the second. An error E of the gyroscope's matrix changes the prediction by
//!
//! `δu = [u_j]ₓ B E e`, `B = ∫₀^θ exp(−[e]ₓ s) ds = θ e eᵀ + sin θ (I − e eᵀ) − (1 − cos θ) [e]ₓ`,
//!
//! so the turn has the information `Bᵀ (I − u_j u_jᵀ) B ⊗ e eᵀ` on E, per variance of the prediction. A turn
//! shows the column of E along its axis alone, so the axes must span the space. A half turn has no axis of its own, and
//! counts as nothing.
//!
//! The price of a bias that drifts while the poses are taken, which depends on their order.
//!
//! The bias in pose k is `b + d τ_k`. τ goes from −½ in the first pose to ½ in the last, and `d ~ N(0, σ_d²)`.
//! The calibration estimates d with the parameters. Let C₀ be their covariance without a drift. With it
//!
//! `C = C₀ + C₀ B (D − Bᵀ C₀ B)⁻¹ Bᵀ C₀`, `B = Σ τ_k Gᵀ N_k⁻¹`, `D = diag(1/σ_d²) + Σ τ_k² N_k⁻¹`.
//!
//! In an order with B = 0 the drift costs nothing (a trend-free order, `cox1951`).

use super::efficiency::efficiency;
use super::hold_information::HoldInformation;
use super::problem::PoseProblem;
use calibrant_core::simulate::{Purpose, stream};
use nalgebra::{DMatrix, Matrix3, SMatrix, Vector3};
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

/// Standard deviation of the error of the gyroscope's matrix before the calibration.
const PRIOR: f64 = 0.05;
/// Standard deviation of a predicted direction, rad.
const PREDICTED: f64 = 1e-3;

/// The mean of all turns from z up on, rad.
pub(super) fn mean_turn(order: &[Vector3<f64>]) -> f64 {
    // before the first pose the sensor lies on the table
    let begin = order.first().map_or(0.0, |first| first.angle(&Vector3::z()));
    (begin + order.windows(2).map(|pair| pair[0].angle(&pair[1])).sum::<f64>()) / order.len().max(1) as f64
}

/// `tr (Λ + Σ m_turn)⁻¹`: sum of the variances of the entries of the gyroscope's matrix after these turns.
pub(super) fn gyroscope_variance(order: &[Vector3<f64>]) -> f64 {
    let mut information = SMatrix::<f64, 9, 9>::identity() / (PRIOR * PRIOR);
    for pair in order.windows(2) {
        information += turn_information(&pair[0], &pair[1]) / (PREDICTED * PREDICTED);
    }
    information.cholesky().map_or(f64::INFINITY, |cholesky| cholesky.inverse().trace())
}

/// The information of a turn on the entries of E, row by row, per variance of the prediction.
fn turn_information(from: &Vector3<f64>, to: &Vector3<f64>) -> SMatrix<f64, 9, 9> {
    let angle = from.angle(to);
    // the hand chooses the axis of a half turn
    let Some(e) = to.cross(from).try_normalize(1e-9) else { return SMatrix::zeros() };
    let b = accumulated(&e, angle);
    let across = Matrix3::identity() - to * to.transpose();
    let left = b.tr_mul(&(across * b));
    SMatrix::from_fn(|i, j| left[(i / 3, j / 3)] * e[i % 3] * e[j % 3])
}

/// B.
fn accumulated(e: &Vector3<f64>, angle: f64) -> Matrix3<f64> {
    let along = e * e.transpose();
    along * angle + (Matrix3::identity() - along) * angle.sin() - e.cross_matrix() * (1.0 - angle.cos())
}

/// Fewest poses in which the calibration allows for a drift.
const FEWEST: usize = 3;

/// The poses of a set, in no order yet.
pub(super) struct Drift {
    /// C₀.
    without: DMatrix<f64>,
    /// `Gᵀ N⁻¹` and `N⁻¹` of each pose.
    poses: Vec<(DMatrix<f64>, Matrix3<f64>)>,
    /// `1/σ_d²`; `None` without a drift.
    known: Option<Vector3<f64>>,
}

impl Drift {
    /// `without`: the covariance of these poses without a drift.
    pub(super) fn of(
        information: &HoldInformation,
        directions: &[Vector3<f64>],
        without: DMatrix<f64>,
        sd: &Vector3<f64>,
    ) -> Self {
        let has_drift = sd.amin() > 0.0 && directions.len() >= FEWEST;
        Self {
            without,
            poses: directions.iter().map(|u| (information.on_reading(u), information.weight(u))).collect(),
            known: has_drift.then(|| sd.map(|sd| sd.powi(-2))),
        }
    }

    /// C₀.
    pub(super) fn without(&self) -> &DMatrix<f64> {
        &self.without
    }

    /// The covariance C of the parameters, where the poses are taken in this order.
    pub(super) fn covariance(&self, order: &[usize]) -> DMatrix<f64> {
        let Some(known) = self.known else { return self.without.clone() };
        let mut b = DMatrix::zeros(self.without.nrows(), 3);
        let mut d = Matrix3::from_diagonal(&known);
        let last = (order.len() - 1) as f64;
        for (k, &pose) in order.iter().enumerate() {
            let tau = k as f64 / last - 0.5;
            let (on_reading, weight) = &self.poses[pose];
            b.zip_apply(on_reading, |b, value| *b += tau * value);
            d += weight * (tau * tau);
        }
        let slope = &self.without * &b;
        let explained = b.tr_mul(&slope);
        let left = d - Matrix3::from_fn(|i, j| explained[(i, j)]);
        let Some(variance) = left.try_inverse() else { return self.without.clone() };
        &self.without + &slope * DMatrix::from_fn(3, 3, |i, j| variance[(i, j)]) * slope.transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poses::hold_information::HoldInformation;
    use crate::poses::spectral_projected_gradient::Poses;
    use crate::poses::tests::problem;
    use crate::poses::{Allowed, DirectionKnowledge, PoseNuisance};
    use calibrant_core::information::covariance;
    use nalgebra::Rotation3;

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

    /// The prediction with a wrong matrix, by integration in small steps, against the formula.
    #[test]
    fn the_error_of_a_prediction_is_that_of_an_integration() {
        let from = Vector3::new(0.3, -0.5, 0.8).normalize();
        let to = Vector3::new(-0.7, 0.2, 0.4).normalize();
        let error = Matrix3::new(1.0, -2.0, 0.5, 0.3, 0.8, -1.0, 2.0, 0.1, -0.4) * 1e-6;
        let (angle, e) = (from.angle(&to), to.cross(&from).normalize());
        let steps = 20_000;
        let turn: Vector3<f64> = (Matrix3::<f64>::identity() + error) * e * (angle / f64::from(steps));
        let step = Rotation3::new(-turn);
        let mut predicted = from;
        for _ in 0..steps {
            predicted = step * predicted;
        }
        let expected = to.cross_matrix() * accumulated(&e, angle) * (error * e);
        assert!((predicted - to - expected).norm() < 1e-10, "{predicted} {to} {expected}");
    }

    /// A gyroscope that turns about one axis alone shows one column of its matrix.
    #[test]
    fn turns_about_one_axis_leave_six_entries_to_the_prior() {
        let flat: Vec<_> = (0..8)
            .map(|k| {
                let turn = f64::from(k) * std::f64::consts::FRAC_PI_4;
                Vector3::new(turn.cos(), turn.sin(), 0.0)
            })
            .collect();
        let prior = PRIOR * PRIOR;
        assert!(gyroscope_variance(&flat) > 6.0 * prior);
        let Allowed::Of(cube) = Allowed::cube(true, true) else { panic!("a list") };
        assert!(gyroscope_variance(&cube) < 0.1 * prior, "{}", gyroscope_variance(&cube) / prior);
    }

    #[test]
    fn the_mean_turn_of_a_circle_is_its_step() {
        let circle: Vec<_> = (0..8)
            .map(|k| {
                let turn = f64::from(k) * std::f64::consts::FRAC_PI_4;
                Vector3::new(0.0, turn.sin(), turn.cos())
            })
            .collect();
        assert!((mean_turn(&circle) - 7.0 / 8.0 * std::f64::consts::FRAC_PI_4).abs() < 1e-12);
    }

    /// All unknowns at once, with the drift as three further parameters, by dense algebra.
    #[test]
    fn the_drift_is_eliminated_as_dense_algebra_eliminates_it() {
        let Allowed::Of(directions) = Allowed::cube(true, true) else { panic!("a list") };
        let directions: Vec<_> = directions.into_iter().take(14).collect();
        for knowledge in [DirectionKnowledge::Unknown, DirectionKnowledge::Known { sd_rad: 1e-3 }] {
            let problem = problem(knowledge, 14);
            let information = HoldInformation::new(&problem).expect("regular");
            let of =
                |u: &Vector3<f64>| information.of_parameters(&information.sum(std::iter::once((u, 1.0))));
            let size = problem.list.len();
            let mut all = DMatrix::zeros(size + 3, size + 3);
            for (k, u) in directions.iter().enumerate() {
                let tau = k as f64 / 13.0 - 0.5;
                let (own, cross, weight) =
                    (of(u), information.on_reading(u) * tau, information.weight(u) * tau * tau);
                let mut add = |row, column, block: &DMatrix<f64>| {
                    let mut place = all.view_mut((row, column), block.shape());
                    place += block;
                };
                add(0, 0, &own);
                add(0, size, &cross);
                add(size, 0, &cross.transpose());
                add(size, size, &DMatrix::from_fn(3, 3, |i, j| weight[(i, j)]));
            }
            let sd = Vector3::<f64>::new(0.01, 0.02, 0.03);
            for axis in 0..3 {
                all[(size + axis, size + axis)] += sd[axis].powi(-2);
            }
            let expected = covariance(&all).expect("regular").view((0, 0), (size, size)).into_owned();
            let sum = information.sum(directions.iter().map(|u| (u, 1.0)));
            let without = covariance(&information.of_parameters(&sum)).expect("regular");
            let drift = Drift::of(&information, &directions, without, &sd);
            let found = drift.covariance(&(0..14).collect::<Vec<_>>());
            assert!((&found - &expected).amax() < 1e-9 * expected.amax(), "{found} {expected}");
        }
    }
}
