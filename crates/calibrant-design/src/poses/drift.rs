//! The price of a bias that drifts while the poses are taken, which depends on their order.
//!
//! The bias in pose k is `b + d τ_k`. τ goes from −½ in the first pose to ½ in the last, and `d ~ N(0, σ_d²)`.
//! The calibration estimates d with the parameters. Let C₀ be their covariance without a drift. With it
//!
//! `C = C₀ + C₀ B (D − Bᵀ C₀ B)⁻¹ Bᵀ C₀`, `B = Σ τ_k Gᵀ N_k⁻¹`, `D = diag(1/σ_d²) + Σ τ_k² N_k⁻¹`.
//!
//! In an order with B = 0 the drift costs nothing (a trend-free order, `cox1951`).

use super::hold_information::HoldInformation;
use nalgebra::{DMatrix, Matrix3, Vector3};

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
    use crate::poses::tests::problem;
    use crate::poses::{Allowed, DirectionKnowledge};
    use calibrant_core::information::covariance;

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
