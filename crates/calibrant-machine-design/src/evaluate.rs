//! What a trajectory determines, and which limits it keeps.
//!
//! # Formula
//! With the information `F` of sensor and nuisances and that of the priors `P` the joint covariance is `Σ = (F + P)⁻¹`. With the marginal covariance `C` of the sensor's
//! parameters and the gain `K` its blocks are `C`, `−C Kᵀ` and `(F_ηη + P_ηη)⁻¹ + K C Kᵀ`. A source of uncertainty has the part `Σ P_s Σ` of it; what is left is the
//! sensor's noise.

use crate::certificate::certify;
use crate::information::{FullInformation, Marginalised, Sensing, solved};
use crate::motion::Knots;
use crate::turned_cross_terms::{beyond_first_order, of_turned_cross_terms};
use crate::{LimitProof, TrajectoryProblem};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::estimate::{BudgetRow, VarianceSource};
use calibrant_core::sensor::ImuQuantity;
use calibrant_machine::estimate::{MachineQuantity, mount_variances};
use calibrant_machine::spline::{Degree, VectorSpline};
use nalgebra::DMatrix;

/// Quadrature points in an interval.
const POINTS: usize = 5;

/// A trajectory with what it determines and its limits.
#[derive(Debug, Clone)]
pub struct TrajectoryEvaluation {
    /// Positions of the joints.
    pub motion: VectorSpline,
    /// Value of the criterion, in nats, of first order in what is not known; infinite where the parameters are not determined.
    pub value: f64,
    /// Numbers whose variances the criterion is made of: a standard deviation goes as `exp(value/2 numbers)`.
    pub numbers: usize,
    /// The parameters of the sensor.
    pub quantities: Vec<ImuQuantity>,
    /// Information on them, with all else marginalised and what is known beforehand.
    pub information: DMatrix<f64>,
    /// Their covariance; `None` where they are not determined.
    pub covariance: Option<DMatrix<f64>>,
    /// Where the variance of each of them comes from.
    pub budget: Vec<BudgetRow>,
    /// What else is found, and its standard deviation afterwards.
    pub machine: Vec<(MachineQuantity, f64)>,
    /// Every limit.
    pub limits: Vec<LimitProof>,
}

impl TrajectoryEvaluation {
    /// Standard deviations of the parameters; infinite where they are not determined.
    #[must_use]
    pub fn sd(&self) -> Vec<f64> {
        match &self.covariance {
            Some(covariance) => covariance.diagonal().iter().map(|variance| variance.sqrt()).collect(),
            None => vec![f64::INFINITY; self.quantities.len()],
        }
    }

    /// How many times smaller standard deviations are than those of another trajectory, by the criterion.
    #[must_use]
    pub fn times_better_than(&self, other: &Self) -> f64 {
        ((other.value - self.value) / (2.0 * self.numbers as f64)).exp()
    }

    /// Is every limit proved?
    #[must_use]
    pub fn is_proved(&self) -> bool {
        self.limits.iter().all(|limit| limit.kept == crate::Kept::Proved)
    }
}

/// Evaluates a trajectory of the problem's chain: a cubic spline on any uniform knots.
///
/// # Errors
/// The spline is of another degree, or of another number of joints.
pub fn evaluate_trajectory(
    problem: &TrajectoryProblem<'_>,
    motion: &VectorSpline,
) -> Result<TrajectoryEvaluation> {
    let joints = problem.chain.joints.len();
    if motion.knots.degree != Degree::Cubic || motion.dimension != joints {
        return Err(Error::experiment(InputError::new(
            Refusal::ValueInvalid,
            format!(
                "the trajectory has {} joints, and the machine {joints}; trajectories are cubic splines",
                motion.dimension
            ),
            "give a trajectory of this machine, with positions and velocities at its knots",
        )));
    }
    let knots = Knots { step_s: motion.knots.step_s, intervals: motion.knots.intervals };
    let controls = DMatrix::from_row_slice(knots.controls(), joints, &motion.controls);
    evaluated(problem, &Sensing::new(problem)?, knots, &controls)
}

/// The same for control points.
pub(crate) fn evaluated(
    problem: &TrajectoryProblem<'_>,
    sensing: &Sensing,
    knots: Knots,
    controls: &DMatrix<f64>,
) -> Result<TrajectoryEvaluation> {
    let mut full = FullInformation::new(sensing, problem.chain, knots, POINTS);
    let marginalised = full.at(controls);
    let quantities = sensing.quantities();
    let (information, solved) = match marginalised {
        Some(of) => {
            let found = posterior(sensing, &of, problem.cross_axis_sd);
            (
                of.information,
                found.map(|found| (of.valued.value, of.valued.covariance + &found.second, found)),
            )
        }
        None => {
            (full.information().unwrap_or_else(|| DMatrix::zeros(quantities.len(), quantities.len())), None)
        }
    };
    let (value, covariance, budget, machine) = match solved {
        Some((value, covariance, found)) => (value, Some(covariance), found.budget, found.machine),
        None => (f64::INFINITY, None, Vec::new(), Vec::new()),
    };
    Ok(TrajectoryEvaluation {
        motion: knots.spline(controls),
        value,
        numbers: sensing.criterion.numbers(quantities.len()),
        quantities,
        information,
        covariance,
        budget,
        machine,
        limits: certify(problem, knots, controls),
    })
}

/// Budget, and what is known of the nuisances afterwards.
struct Posterior {
    /// What the mounting adds to the covariance beyond first order at the nominal sensor, as calibrations state it in the mean over sensors.
    second: DMatrix<f64>,
    budget: Vec<BudgetRow>,
    machine: Vec<(MachineQuantity, f64)>,
}

fn posterior(sensing: &Sensing, of: &Marginalised, cross_axis_sd: [f64; 2]) -> Option<Posterior> {
    let p = sensing.columns.len();
    let layout = &sensing.layout;
    let size = layout.quantities.len() - p;
    let prior = layout.prior.view((p, p), (size, size)).into_owned();
    let covariance = &of.valued.covariance;
    let gain = &of.gain * &sensing.columns.entries;
    let cross = -(covariance * gain.transpose());
    let own = solved(&(&of.nuisances + &prior), &DMatrix::identity(size, size))?;
    let own = own - &gain * &cross;
    let mut all = DMatrix::zeros(p + size, p + size);
    all.view_mut((p, p), (size, size)).copy_from(&own);
    all.view_mut((0, p), (p, size)).copy_from(&cross);
    let mut second = of_turned_cross_terms(layout, &all, cross_axis_sd);
    for (k, of) in mount_variances(layout, &layout.nominal, &all).into_iter().enumerate() {
        second[(k, k)] += beyond_first_order(of, second[(k, k)]);
    }
    let second = second.view((0, 0), (p, p)).into_owned();
    let sources: Vec<VarianceSource> =
        layout.quantities[p..].iter().map(|quantity| quantity.source()).collect();
    let quantities = sensing.quantities();
    let row = |(i, quantity): (usize, &ImuQuantity)| {
        let variance = covariance[(i, i)];
        let mut parts = VarianceSource::ALL.map(|source| {
            let inside = |k: &usize| sources[*k] == source;
            let places: Vec<usize> = (0..size).filter(inside).collect();
            let pairs = places.iter().flat_map(|a| places.iter().map(move |b| (*a, *b)));
            pairs.map(|(a, b)| cross[(i, a)] * prior[(a, b)] * cross[(i, b)]).sum::<f64>()
        });
        let others: f64 = parts.iter().sum();
        parts[VarianceSource::SensorNoise as usize] = (variance - others).max(0.0);
        parts[VarianceSource::Mounting as usize] += second[(i, i)];
        BudgetRow { quantity: *quantity, variance: variance + second[(i, i)], parts }
    };
    Some(Posterior {
        budget: quantities.iter().enumerate().map(row).collect(),
        machine: (layout.quantities[p..].iter().enumerate())
            .map(|(k, quantity)| (*quantity, own[(k, k)].max(0.0).sqrt()))
            .collect(),
        second,
    })
}
