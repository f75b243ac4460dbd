//! How much a rotation counts, and the rotations that must be left out.
//!
//! The noise of the samples explains only part of a rotation's error; the rest (scale factors that depend on the rate, a wandering bias, clocks, what the
//! model lacks) is estimated from the scatter itself: the excess `σ_r` for which χ² of the rotations equals its degrees of freedom (Paule and Mandel), in the
//! problem linearised at the present estimate, directions fixed (they are known ten times better than a rotation can tell). The Earth's rate is among its unknowns, after the gyroscope's quantities.

use super::joint::{Joint, Miss, State};
use crate::estimate::excess::excess;
use nalgebra::{DMatrix, DVector, Matrix2, Matrix2xX, Vector2};
use std::f64::consts::FRAC_PI_2;

/// A rotation is left out when an error as large as its own would be seen in fewer than this share of recordings.
const SIGNIFICANCE: f64 = 0.01;
/// Rounds of leaving out one rotation, or taking one back; twice their number where there are more.
const ROUNDS: usize = 200;
/// An excess of the size of a good sensor's, rad.
const USUAL: f64 = 1e-3;

/// The rotations, weighed.
pub(super) struct Weighed {
    /// `σ_r`, rad.
    pub(super) excess_rad: f64,
    pub(super) used: Vec<bool>,
    /// Error of each rotation, its own influence removed, in standard deviations: `χ²` of two degrees of freedom.
    pub(super) studentised: Vec<f64>,
    /// The step of the gyroscope's parameters that these weights ask for, and of the Earth's rate.
    pub(super) step: DVector<f64>,
    /// Their covariance, directions fixed.
    pub(super) covariance: DMatrix<f64>,
    /// Its length in standard deviations.
    pub(super) length: f64,
}

impl Weighed {
    /// No rotation at all.
    pub(super) fn none(rotations: usize) -> Self {
        Self {
            excess_rad: 0.0,
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
    misses: Vec<Option<(&'a Miss, Matrix2xX<f64>)>>,
    /// Number of unknowns.
    size: usize,
    rest: DMatrix<f64>,
    rest_rhs: DVector<f64>,
    told: usize,
}

/// What the data beside the rotations say of the unknowns.
pub(super) struct Rest {
    pub(super) information: DMatrix<f64>,
    pub(super) rhs: DVector<f64>,
    /// Number of unknowns that they tell: these take nothing of the rotations.
    pub(super) told: usize,
}

/// Weighs the rotations of a problem, given their misses (`None` for those that cannot be used).
pub(super) fn weigh<'a>(
    joint: &Joint<'_>,
    state: &State,
    misses: &'a [Option<Miss>],
    rest: Rest,
) -> Option<Weighed> {
    let places = joint.gyroscope_places();
    let size = rest.rhs.len();
    let jacobian = |(i, miss): (usize, &'a Miss)| {
        let of_earth = joint.earth.of_rotation(&joint.rotations[i], miss, &state.imu, &state.forces);
        let mut jacobian = Matrix2xX::zeros(size);
        places.iter().enumerate().for_each(|(to, &k)| jacobian.set_column(to, &miss.by_parameters.column(k)));
        jacobian.columns_mut(places.len(), of_earth.ncols()).copy_from(&of_earth);
        (miss, jacobian)
    };
    let linear = Linear {
        misses: misses.iter().enumerate().map(|(i, miss)| Some(jacobian((i, miss.as_ref()?)))).collect(),
        size,
        rest: rest.information,
        rest_rhs: rest.rhs,
        told: rest.told,
    };
    let is_there: Vec<bool> = misses.iter().map(Option::is_some).collect();
    let all = count(&is_there);
    // those that end upside down are far from where the problem is linear, and a few of them would hide each other
    let upright: Vec<bool> =
        misses.iter().map(|miss| miss.as_ref().is_some_and(|miss| miss.error.norm() < FRAC_PI_2)).collect();
    let are_enough = |used: &[bool]| 2 * count(used) > places.len() + 4;
    let mut used = if are_enough(&upright) { upright } else { is_there };
    let mut excess;
    let mut solved;
    let (mut rounds, most) = (0, ROUNDS.max(2 * misses.len()));
    loop {
        (excess, solved) = linear.excess(&used)?;
        let studentised = linear.studentised(&used, excess, &solved);
        let limit = critical(all);
        let worst = (0..used.len())
            .filter(|&i| used[i] && studentised[i] > limit)
            .max_by(|&a, &b| studentised[a].total_cmp(&studentised[b]));
        let best = (0..used.len())
            .filter(|&i| !used[i] && misses[i].is_some() && studentised[i] <= limit)
            .min_by(|&a, &b| studentised[a].total_cmp(&studentised[b]));
        rounds += 1;
        match (worst, best) {
            (Some(i), _) if are_enough(&used) && rounds < most => used[i] = false,
            (_, Some(i)) if rounds < most => used[i] = true,
            _ => {
                return Some(Weighed {
                    excess_rad: excess,
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

fn count(used: &[bool]) -> usize {
    used.iter().filter(|used| **used).count()
}

struct Solved {
    step: DVector<f64>,
    covariance: DMatrix<f64>,
    chi2: f64,
    length: f64,
}

impl Linear<'_> {
    fn weight(&self, miss: &Miss, excess: f64) -> Matrix2<f64> {
        (miss.covariance + Matrix2::identity() * (excess * excess + 1e-18))
            .try_inverse()
            .unwrap_or_else(Matrix2::zeros)
    }

    fn error(miss: &Miss, jacobian: &Matrix2xX<f64>, step: &DVector<f64>) -> Vector2<f64> {
        let change = jacobian.column_iter().zip(step.iter()).map(|(column, step)| column * *step);
        miss.error + change.sum::<Vector2<f64>>()
    }

    fn used<'s>(&'s self, used: &'s [bool]) -> impl Iterator<Item = &'s (&'s Miss, Matrix2xX<f64>)> {
        self.misses.iter().zip(used).filter(|(_, used)| **used).filter_map(|(miss, _)| miss.as_ref())
    }

    fn solve(&self, used: &[bool], excess: f64) -> Option<Solved> {
        let (mut f, mut g) = (self.rest.clone(), self.rest_rhs.clone());
        let rows = 2 * count(used);
        let (mut all, mut weighted) = (DMatrix::zeros(self.size, rows), DMatrix::zeros(rows, self.size));
        for (k, (miss, jacobian)) in self.used(used).enumerate() {
            let by_weight = self.weight(miss, excess) * jacobian;
            g.gemv_tr(-1.0, &by_weight, &miss.error, 1.0);
            all.columns_mut(2 * k, 2).tr_copy_from(jacobian);
            weighted.rows_mut(2 * k, 2).copy_from(&by_weight);
        }
        f.gemm(1.0, &all, &weighted, 1.0);
        let covariance = crate::information::covariance(&f)?;
        let step = &covariance * &g;
        let length = step.dot(&g).max(0.0).sqrt();
        let chi2 = self
            .used(used)
            .map(|(miss, jacobian)| {
                let error = Self::error(miss, jacobian, &step);
                error.dot(&(self.weight(miss, excess) * error))
            })
            .sum();
        Some(Solved { step, covariance, chi2, length })
    }

    /// The excess that makes χ² equal its degrees of freedom, zero where the noise explains the scatter.
    fn excess(&self, used: &[bool]) -> Option<(f64, Solved)> {
        excess(
            (2 * count(used)).saturating_sub(self.size - self.told) as f64,
            |_| USUAL,
            |excess| {
                let solved = self.solve(used, excess)?;
                Some((solved.chi2, solved))
            },
        )
    }

    fn studentised(&self, used: &[bool], excess: f64, solved: &Solved) -> Vec<f64> {
        self.misses
            .iter()
            .zip(used)
            .map(|(miss, used)| {
                let Some((miss, j)) = miss else { return f64::INFINITY };
                let own = miss.covariance + Matrix2::identity() * (excess * excess + 1e-18);
                let from: Matrix2<f64> = j * &solved.covariance * j.transpose();
                let expected = if *used { own - from } else { own + from };
                let error = Self::error(miss, j, &solved.step);
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
