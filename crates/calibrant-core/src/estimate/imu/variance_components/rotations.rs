//! How much a rotation counts, and the rotations that must be left out.
//!
//! The noise of the samples explains only part of a rotation's error; the rest (scale factors that depend on the rate, a wandering bias, clocks, what the
//! model lacks) is estimated from the scatter itself: the excess `σ_r` for which χ² of the rotations equals its degrees of freedom (Paule and Mandel), in the
//! problem linearised at the present estimate, directions fixed (they are known ten times better than a rotation can tell). The Earth's rate is among its unknowns, after the gyroscope's quantities.
//!
//! A knock that is as short as a few sample steps has an integral that its samples show only roughly. The factor of that error is a second variance component, of the largest likelihood.

use crate::estimate::imu::model::{
    GravityResidual, ImuModel, KNOCK_DEGREES, RotationScatter, State, USUAL_KNOCK_FACTOR,
};
use crate::solve::{Judged, Trial, degrees_left, excess, leave_out, shares_of_prior, studentised_length};
use nalgebra::{DMatrix, DVector, Matrix2, Matrix2xX, Vector2};
use std::f64::consts::FRAC_PI_2;

/// A rotation is left out when an error as large as its own would be seen in fewer than this share of recordings.
const SIGNIFICANCE: f64 = 0.01;

/// Most changes, each of which leaves out one rotation or takes one back; twice their number where there are more.
const CHANGES: usize = 200;

/// Knock factors that are compared. A sensor whose samples are means over their steps integrates knocks exactly.
const KNOCK_FACTORS: [f64; 9] = [0.004, 0.008, 0.015, 0.03, 0.06, 0.12, 0.25, 0.5, 1.0];

/// Rounds in which the factors of the rotations and the fit follow each other.
const KNOCK_ROUNDS: usize = 4;

/// Knock factor of a pulse of half a sample step without a filter.
const LARGEST_KNOCK_FACTOR: f64 = 1.5;

/// The excess of a good sensor, rad: a first guess.
const USUAL_EXCESS_RAD: f64 = 1e-3;

/// The rotations with their weights.
pub(crate) struct RotationWeights {
    pub(crate) scatter: RotationScatter,
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
            scatter: RotationScatter::none(),
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
    let (used, (scatter, solved)) = leave_out(
        &is_there,
        if are_enough(&upright) { upright } else { is_there.clone() },
        CHANGES.max(2 * residuals.len()),
        |used, _| linear.scatter(used).ok_or(()),
        |used, (scatter, solved)| Judged {
            studentised: linear.studentised(used, scatter, solved),
            limit: critical(all),
            may_leave_out: are_enough(used),
        },
    )
    .ok()?;
    let studentised = linear.studentised(&used, &scatter, &solved);
    let Solved { step, covariance, length, .. } = solved;
    Some(RotationWeights { scatter, used, studentised, step, covariance, length })
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
    let Solved { step, covariance, length, .. } = linear.solve(&weighed.used, &weighed.scatter)?;
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
    fn weight(rotation: usize, residual: &GravityResidual, scatter: &RotationScatter) -> Matrix2<f64> {
        scatter.covariance(rotation, residual).try_inverse().unwrap_or_else(Matrix2::zeros)
    }

    fn error(residual: &GravityResidual, jacobian: &Matrix2xX<f64>, step: &DVector<f64>) -> Vector2<f64> {
        let change = jacobian.column_iter().zip(step.iter()).map(|(column, step)| column * *step);
        residual.error + change.sum::<Vector2<f64>>()
    }

    fn used<'s>(
        &'s self,
        used: &'s [bool],
    ) -> impl Iterator<Item = (usize, &'s GravityResidual, &'s Matrix2xX<f64>)> {
        self.residuals.iter().zip(used).enumerate().filter(|(_, (_, used))| **used).filter_map(
            |(i, (residual, _))| residual.as_ref().map(|(residual, jacobian)| (i, *residual, jacobian)),
        )
    }

    fn solve(&self, used: &[bool], scatter: &RotationScatter) -> Option<Solved> {
        let (mut f, mut g) = (self.rest.clone(), self.rest_rhs.clone());
        let rows = 2 * count(used);
        let (mut all, mut weighted) = (DMatrix::zeros(self.size, rows), DMatrix::zeros(rows, self.size));
        for (k, (i, residual, jacobian)) in self.used(used).enumerate() {
            let by_weight = Self::weight(i, residual, scatter) * jacobian;
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
            .map(|(i, residual, jacobian)| {
                let error = Self::error(residual, jacobian, &step);
                error.dot(&(Self::weight(i, residual, scatter) * error))
            })
            .sum();
        Some(Solved { step, covariance, chi2, length })
    }

    /// The scatter with its fit. Where rotations have knocks, it is that of the most likely knock factor.
    fn scatter(&self, used: &[bool]) -> Option<(RotationScatter, Solved)> {
        let with_knocks = |(_, residual, _): (usize, &GravityResidual, _)| residual.of_knocks.trace() > 0.0;
        if !self.used(used).any(with_knocks) {
            return self.excess(used, RotationScatter::none());
        }
        KNOCK_FACTORS
            .into_iter()
            .filter_map(|factor| self.with_knocks(used, factor))
            .max_by(|one, other| one.0.total_cmp(&other.0))
            .map(|(_, scatter, solved)| (scatter, solved))
    }

    /// The log likelihood of a knock factor, and the scatter with its fit.
    ///
    /// The errors of knocks follow Student's distribution (`lange1989`), since pulses of some lengths are integrated much better than others.
    /// Each rotation has a factor of its own, the larger the larger its error is.
    fn with_knocks(&self, used: &[bool], factor: f64) -> Option<(f64, RotationScatter, Solved)> {
        let own_factors = vec![factor; used.len()];
        let all =
            RotationScatter { knock_factor: factor, knock_rms: factor, own_factors, between_sd_rad: 0.0 };
        let (mut scatter, mut solved) = self.excess(used, all.clone())?;
        for _ in 0..KNOCK_ROUNDS {
            let studentised = self.studentised(used, &scatter, &solved);
            let own_factors = studentised.iter().zip(&scatter.own_factors).map(|(off, own)| {
                let chi2 = (off * own / factor).powi(2);
                // variance by the error, and what makes the information that of the distribution
                let widened = (KNOCK_DEGREES + chi2) * (KNOCK_DEGREES + 4.0) / (KNOCK_DEGREES + 2.0).powi(2);
                (factor * widened.sqrt()).min(LARGEST_KNOCK_FACTOR)
            });
            let own_factors = own_factors.collect();
            (scatter, solved) = self.excess(used, RotationScatter { own_factors, ..all.clone() })?;
        }
        let of_all = RotationScatter { between_sd_rad: scatter.between_sd_rad, ..all.clone() };
        let of_unknowns = solved.covariance.clone().cholesky().map_or(0.0, |root| root.ln_determinant());
        let of_factor = (factor / USUAL_KNOCK_FACTOR).ln().powi(2);
        let of_errors = self.used(used).map(|(i, residual, jacobian)| {
            let error = Self::error(residual, jacobian, &solved.step);
            let chi2 = error.dot(&(Self::weight(i, residual, &of_all) * error));
            let of_spread = of_all.covariance(i, residual).determinant().ln();
            of_spread
                + match residual.of_knocks.trace() > 0.0 {
                    true => (KNOCK_DEGREES + 2.0) * (1.0 + chi2 / KNOCK_DEGREES).ln(),
                    false => chi2,
                }
        });
        let log_likelihood = 0.5 * (of_unknowns - of_factor - of_errors.sum::<f64>());
        // longer tails than Student's
        let of_student = KNOCK_DEGREES / (KNOCK_DEGREES - 2.0);
        let longer = (self.mean_square(used, &of_all, &solved) / of_student).max(1.0).sqrt();
        let own_factors = scatter.own_factors.iter().map(|own| own * longer).collect();
        (scatter, solved) = self.excess(used, RotationScatter { own_factors, ..all.clone() })?;
        let of_all = RotationScatter { between_sd_rad: scatter.between_sd_rad, ..all };
        scatter.knock_rms = factor * self.mean_square(used, &of_all, &solved).max(1.0).sqrt();
        Some((log_likelihood, scatter, solved))
    }

    /// Mean of χ² per component of the rotations with knocks, each counted with the share of the knocks in its covariance.
    fn mean_square(&self, used: &[bool], scatter: &RotationScatter, solved: &Solved) -> f64 {
        let studentised = self.studentised(used, scatter, solved);
        let (mut sum, mut weight) = (0.0, 0.0);
        for (i, residual, _) in self.used(used) {
            let share = residual.of_knocks.trace() * scatter.knock_factor.powi(2)
                / scatter.covariance(i, residual).trace();
            sum += share * 0.5 * studentised[i].powi(2);
            weight += share;
        }
        sum / weight
    }

    /// The excess that makes χ² equal its degrees of freedom, zero where the noise explains the scatter.
    fn excess(&self, used: &[bool], scatter: RotationScatter) -> Option<(RotationScatter, Solved)> {
        let with = |between_sd_rad: f64| RotationScatter { between_sd_rad, ..scatter.clone() };
        excess(
            |_| USUAL_EXCESS_RAD,
            |excess| {
                let solved = self.solve(used, &with(excess))?;
                let of_prior = |weight: &DVector<f64>| shares_of_prior(weight.as_slice(), &solved.covariance);
                let shares = self.prior.as_ref().map(of_prior);
                let open = self.size - self.determined;
                let degrees_of_freedom = degrees_left(2.0 * count(used) as f64, open, shares.as_deref());
                Some(Trial { chi2: solved.chi2, degrees_of_freedom, fitted: solved })
            },
        )
        .map(|(excess, solved)| (with(excess), solved))
    }

    fn studentised(&self, used: &[bool], scatter: &RotationScatter, solved: &Solved) -> Vec<f64> {
        self.residuals
            .iter()
            .zip(used)
            .enumerate()
            .map(|(i, (residual, used))| {
                let Some((residual, j)) = residual else { return f64::INFINITY };
                let own = scatter.covariance(i, residual);
                let from: Matrix2<f64> = j * &solved.covariance * j.transpose();
                studentised_length(&Self::error(residual, j, &solved.step), (&own, &from), *used)
            })
            .collect()
    }
}

/// Largest error that chance explains among so many rotations: from χ² of two degrees of freedom, `exp(−x²/2)`.
fn critical(rotations: usize) -> f64 {
    (-2.0 * (SIGNIFICANCE / rotations.max(1) as f64).ln()).sqrt()
}
