//! The covariance that a calibration will state: that of the holds, and that of gravity.
//!
//! An error of gravity is a common factor of the matrix S. It adds `(σ_g/g)² s sᵀ` to the covariance, with s the
//! entries of S among the parameters.

use super::problem::PoseProblem;
use calibrant_core::information::covariance;
use calibrant_core::sensor::Quantity;
use nalgebra::{DMatrix, DVector};

/// The covariance with that of gravity added.
pub(super) fn with_gravity(problem: &PoseProblem, of_holds: DMatrix<f64>) -> DMatrix<f64> {
    let slope = gravity_slope(problem);
    of_holds + &slope * slope.transpose()
}

impl PoseProblem {
    /// The covariance before the poses, where all parameters are known: that of the prior, with gravity.
    #[must_use]
    pub fn covariance_before(&self) -> Option<DMatrix<f64>> {
        self.prior.as_ref().and_then(covariance).map(|of_prior| with_gravity(self, of_prior))
    }

    /// The problem with a prior that came from a calibration which assumed this gravity. The error of gravity is
    /// taken out of the prior's covariance, since it is added to that of the result.
    #[must_use]
    pub fn with_gravity_out_of_prior(mut self) -> Self {
        let slope = gravity_slope(&self);
        let without =
            self.prior.as_ref().and_then(covariance).map(|of_prior| of_prior - &slope * slope.transpose());
        // a prior that knew gravity better stays
        if let Some(information) = without.as_ref().and_then(covariance) {
            self.prior = Some(information);
        }
        self
    }
}

/// The change of each parameter for one standard deviation of gravity.
pub(super) fn gravity_slope(problem: &PoseProblem) -> DVector<f64> {
    let share = problem.nuisance.gravity_sd_mps2 / problem.gravity_mps2;
    let change = |quantity: &Quantity| match quantity {
        Quantity::Bias(_) => 0.0,
        _ => share * quantity.value(&problem.at),
    };
    DVector::from_iterator(problem.list.len(), problem.list.quantities().iter().map(change))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poses::DirectionKnowledge;
    use crate::poses::tests::problem;

    #[test]
    fn gravity_leaves_the_prior_and_comes_back() {
        let mut problem = problem(DirectionKnowledge::Unknown, 12);
        problem.nuisance.gravity_sd_mps2 = 4e-4;
        let of_holds = DMatrix::from_fn(9, 9, |i, j| if i == j { 1e-8 } else { 1e-10 });
        let with = with_gravity(&problem, of_holds.clone());
        assert!((with[(3, 3)] - 1e-8 - (4e-4_f64 / 9.80665).powi(2)).abs() < 1e-20, "{with}");
        assert_eq!(with[(0, 0)], of_holds[(0, 0)]);
        problem.prior = covariance(&with);
        let problem = problem.with_gravity_out_of_prior();
        let left = problem.prior.as_ref().and_then(covariance).expect("regular");
        assert!((left - of_holds).amax() < 1e-16);
        assert!((problem.covariance_before().expect("a prior") - with).amax() < 1e-16);
    }
}
