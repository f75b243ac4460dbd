//! How much a rotation counts, and the rotations that must be left out.
//!
//! The noise of the samples explains only part of a rotation's error; the rest (scale factors that depend on the rate, a wandering bias, clocks, what the
//! model lacks) is estimated from the scatter itself: the excess `σ_r` for which χ² of the rotations equals its degrees of freedom (Paule and Mandel), in the
//! problem linearised at the present estimate, directions fixed (they are known ten times better than a rotation can tell). The Earth's rate is among its unknowns, after the gyroscope's quantities.

use crate::estimate::between_hold_variance::{Trial, excess};
use crate::estimate::imu::model::{GravityResidual, ImuModel, State};
use nalgebra::{DMatrix, DVector, Matrix2, Matrix2xX, Vector2};
use std::f64::consts::FRAC_PI_2;

/// A rotation is left out when an error as large as its own would be seen in fewer than this share of recordings.
const SIGNIFICANCE: f64 = 0.01;

/// Rounds of leaving out one rotation, or taking one back; twice their number where there are more.
const ROUNDS: usize = 200;

/// The excess of a good sensor, rad: a first guess.
const USUAL_EXCESS_RAD: f64 = 1e-3;

/// The rotations with their weights.
pub(crate) struct RotationWeights {
    /// `σ_r`, rad.
    pub(crate) between_rotations_sd_rad: f64,
    pub(crate) used: Vec<bool>,
    /// Error of each rotation, its own influence removed, in standard deviations: `χ²` of two degrees of freedom.
    pub(crate) studentised: Vec<f64>,
    /// The step of the gyroscope's parameters that these weights ask for, and of the Earth's rate.
    pub(crate) step: DVector<f64>,
    /// Their covariance, directions fixed.
    pub(crate) covariance: DMatrix<f64>,
    /// Its length in standard deviations.
    pub(crate) length: f64,
}

impl RotationWeights {
    /// No rotation at all.
    pub(crate) fn none(rotations: usize) -> Self {
        Self {
            between_rotations_sd_rad: 0.0,
            used: vec![false; rotations],
            studentised: vec![f64::INFINITY; rotations],
            step: DVector::zeros(0),
            covariance: DMatrix::zeros(0, 0),
            length: 0.0,
        }
    }
}

/// The linear problem: errors `e_i + J_i δp`, and what the rest of the data say of δp.
struct Linear<'a> {
    /// The rotations, each with its Jacobian.
    residuals: Vec<Option<(&'a GravityResidual, Matrix2xX<f64>)>>,
    /// Number of unknowns.
    size: usize,
    rest: DMatrix<f64>,
    rest_rhs: DVector<f64>,
    determined: usize,
    prior: Option<DVector<f64>>,
}

/// What the data beside the rotations say of the unknowns.
pub(crate) struct Rest {
    pub(crate) information: DMatrix<f64>,
    pub(crate) rhs: DVector<f64>,
    /// Number of unknowns that they tell: these take nothing of the rotations.
    pub(crate) determined: usize,
    /// Inverse variance of each other unknown beforehand, where there is a prior.
    pub(crate) prior: Option<DVector<f64>>,
}

/// Weighs the rotations of a problem, given their misses (`None` for those that cannot be used).
pub(crate) fn weigh_rotations(
    model: &ImuModel<'_>,
    state: &State,
    residuals: &[Option<GravityResidual>],
    rest: Rest,
) -> Option<RotationWeights> {
    let linear = Linear::new(model, state, residuals, rest);
    let unknowns_of_gyroscope = model.gyroscope_places().len();
    let is_there: Vec<bool> = residuals.iter().map(Option::is_some).collect();
    let all = count(&is_there);
    // those that end upside down are far from where the problem is linear, and a few of them would hide each other
    let upright: Vec<bool> = residuals
        .iter()
        .map(|residual| residual.as_ref().is_some_and(|residual| residual.error.norm() < FRAC_PI_2))
        .collect();
    let are_enough = |used: &[bool]| 2 * count(used) > unknowns_of_gyroscope + 4;
    let mut used = if are_enough(&upright) { upright } else { is_there };
    let mut excess;
    let mut solved;
    let (mut rounds, most) = (0, ROUNDS.max(2 * residuals.len()));
    loop {
        (excess, solved) = linear.excess(&used)?;
        let studentised = linear.studentised(&used, excess, &solved);
        let limit = critical(all);
        let worst = (0..used.len())
            .filter(|&i| used[i] && studentised[i] > limit)
            .max_by(|&a, &b| studentised[a].total_cmp(&studentised[b]));
        let best = (0..used.len())
            .filter(|&i| !used[i] && residuals[i].is_some() && studentised[i] <= limit)
            .min_by(|&a, &b| studentised[a].total_cmp(&studentised[b]));
        rounds += 1;
        match (worst, best) {
            (Some(i), _) if are_enough(&used) && rounds < most => used[i] = false,
            (_, Some(i)) if rounds < most => used[i] = true,
            _ => {
                return Some(RotationWeights {
                    between_rotations_sd_rad: excess,
                    used,
                    studentised,
                    length: solved.length,
                    step: solved.step,
                    covariance: solved.covariance,
                });
            }
        }
    }
}

/// The step and the covariance with weights that are given.
pub(crate) fn solve_again(
    model: &ImuModel<'_>,
    state: &State,
    residuals: &[Option<GravityResidual>],
    rest: Rest,
    weighed: RotationWeights,
) -> Option<RotationWeights> {
    let linear = Linear::new(model, state, residuals, rest);
    let Solved { step, covariance, length, .. } =
        linear.solve(&weighed.used, weighed.between_rotations_sd_rad)?;
    Some(RotationWeights { step, covariance, length, ..weighed })
}

fn count(used: &[bool]) -> usize {
    used.iter().filter(|used| **used).count()
}

struct Solved {
    step: DVector<f64>,
    covariance: DMatrix<f64>,
    chi2: f64,
    length: f64,
}

impl<'a> Linear<'a> {
    fn new(
        model: &ImuModel<'_>,
        state: &State,
        residuals: &'a [Option<GravityResidual>],
        rest: Rest,
    ) -> Self {
        let places = model.gyroscope_places();
        let size = rest.rhs.len();
        let jacobian = |(i, residual): (usize, &'a GravityResidual)| {
            let of_earth = model.earth.of_rotation(&model.rotations[i], residual, &state.imu, &state.forces);
            let mut jacobian = Matrix2xX::zeros(size);
            places
                .iter()
                .enumerate()
                .for_each(|(to, &k)| jacobian.set_column(to, &residual.by_parameters.column(k)));
            jacobian.columns_mut(places.len(), of_earth.ncols()).copy_from(&of_earth);
            (residual, jacobian)
        };
        Linear {
            residuals: residuals
                .iter()
                .enumerate()
                .map(|(i, residual)| Some(jacobian((i, residual.as_ref()?))))
                .collect(),
            size,
            rest: rest.information,
            rest_rhs: rest.rhs,
            determined: rest.determined,
            prior: rest.prior,
        }
    }
}

impl Linear<'_> {
    fn weight(&self, residual: &GravityResidual, excess: f64) -> Matrix2<f64> {
        (residual.covariance + Matrix2::identity() * (excess * excess + 1e-18))
            .try_inverse()
            .unwrap_or_else(Matrix2::zeros)
    }

    fn error(residual: &GravityResidual, jacobian: &Matrix2xX<f64>, step: &DVector<f64>) -> Vector2<f64> {
        let change = jacobian.column_iter().zip(step.iter()).map(|(column, step)| column * *step);
        residual.error + change.sum::<Vector2<f64>>()
    }

    fn used<'s>(
        &'s self,
        used: &'s [bool],
    ) -> impl Iterator<Item = &'s (&'s GravityResidual, Matrix2xX<f64>)> {
        self.residuals
            .iter()
            .zip(used)
            .filter(|(_, used)| **used)
            .filter_map(|(residual, _)| residual.as_ref())
    }

    fn solve(&self, used: &[bool], excess: f64) -> Option<Solved> {
        let (mut f, mut g) = (self.rest.clone(), self.rest_rhs.clone());
        let rows = 2 * count(used);
        let (mut all, mut weighted) = (DMatrix::zeros(self.size, rows), DMatrix::zeros(rows, self.size));
        for (k, (residual, jacobian)) in self.used(used).enumerate() {
            let by_weight = self.weight(residual, excess) * jacobian;
            g.gemv_tr(-1.0, &by_weight, &residual.error, 1.0);
            all.columns_mut(2 * k, 2).tr_copy_from(jacobian);
            weighted.rows_mut(2 * k, 2).copy_from(&by_weight);
        }
        f.gemm(1.0, &all, &weighted, 1.0);
        let covariance = crate::information::covariance(&f)?;
        let step = &covariance * &g;
        let length = step.dot(&g).max(0.0).sqrt();
        let chi2 = self
            .used(used)
            .map(|(residual, jacobian)| {
                let error = Self::error(residual, jacobian, &step);
                error.dot(&(self.weight(residual, excess) * error))
            })
            .sum();
        Some(Solved { step, covariance, chi2, length })
    }

    /// The excess that makes χ² equal its degrees of freedom, zero where the noise explains the scatter.
    fn excess(&self, used: &[bool]) -> Option<(f64, Solved)> {
        excess(
            |_| USUAL_EXCESS_RAD,
            |excess| {
                let solved = self.solve(used, excess)?;
                let degrees_of_freedom = self.degrees_left(2 * count(used), &solved);
                Some(Trial { chi2: solved.chi2, degrees_of_freedom, fitted: solved })
            },
        )
    }

    /// Degrees of freedom of the rotations: their equations less the unknowns that they determine.
    fn degrees_left(&self, equations: usize, solved: &Solved) -> f64 {
        let open = self.size - self.determined;
        match &self.prior {
            None => equations.saturating_sub(open) as f64,
            Some(weight) => {
                let of_prior = weight.dot(&solved.covariance.diagonal());
                (equations as f64 - (open as f64 - of_prior)).max(f64::EPSILON)
            }
        }
    }

    fn studentised(&self, used: &[bool], excess: f64, solved: &Solved) -> Vec<f64> {
        self.residuals
            .iter()
            .zip(used)
            .map(|(residual, used)| {
                let Some((residual, j)) = residual else { return f64::INFINITY };
                let own = residual.covariance + Matrix2::identity() * (excess * excess + 1e-18);
                let from: Matrix2<f64> = j * &solved.covariance * j.transpose();
                let expected = if *used { own - from } else { own + from };
                let error = Self::error(residual, j, &solved.step);
                // a rotation that decides the parameters by itself has no error of its own
                let inverse =
                    expected.try_inverse().filter(|_| expected.determinant() > 1e-6 * own.determinant());
                inverse.map_or(0.0, |inverse| error.dot(&(inverse * error)).max(0.0).sqrt())
            })
            .collect()
    }
}

/// Largest error that chance explains among so many rotations: from χ² of two degrees of freedom, `exp(−x²/2)`.
fn critical(rotations: usize) -> f64 {
    (-2.0 * (SIGNIFICANCE / rotations.max(1) as f64).ln()).sqrt()
}
