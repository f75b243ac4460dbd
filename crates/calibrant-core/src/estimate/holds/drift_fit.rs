//! A bias that drifts over the recording: a nuisance of the fit, with a prior.
//!
//! The bias in hold j is `b + d τ_j`, with `τ` from −½ in the first hold to ½ in the last and `d ~ N(0, σ_d²)`. The fit is that of the means less
//! `d τ_j`. With `d̂`, its covariance `Σ_dd` from the magnitudes and the prior, and `J = ∂p/∂d`, the parameters have the covariance
//! `Σ_p|d + J Σ_dd Jᵀ`. Where the order of the holds looks like a parameter, `Σ_dd` stays that of the prior and the standard deviation grows.
//! In random order the magnitudes determine `d`, and it costs little.

use super::HoldsSetup;
use super::recording_biases::taken;
use super::robust::{Conditions, Robust};
use super::robust_weights;
use crate::error::Result;
use crate::estimate::bias_drift::{BiasDrift, spans};
use crate::estimate::recording_biases::RecordingBiases;
use crate::estimate::{CalibrationProblem, CalibrationSettings};
use crate::motion::Hold;
use crate::solve::{Uncertainty, VarianceSource};
use nalgebra::{DMatrix, Matrix3, Vector3};

/// Rounds in which drift and parameters follow each other.
const ROUNDS: usize = 8;
/// Rounds with the holds of the start: a drift that is known roughly makes good holds look like outliers.
const ROUGH_ROUNDS: usize = 3;
/// The rounds end with a step below this many standard deviations of the drift.
const CLOSE: f64 = 0.01;
/// With fewer degrees of freedom left, the scatter between holds is at least that of the fit without a drift.
const FEWEST_DEGREES: f64 = 6.0;

/// The fit of the holds.
pub(super) struct Fitted {
    /// The holds without the drift.
    pub(super) holds: Vec<Hold>,
    pub(super) robust: Robust,
    pub(super) drift: Option<BiasDrift>,
    /// That of the parameters, with what the drift adds.
    pub(super) uncertainty: Uncertainty,
    /// The fit without a drift, where one was allowed for.
    pub(super) without: Option<Robust>,
}

/// Fits the holds with a drift; `biases` of recordings were taken out of them, and each recording drifts by itself.
pub(super) fn fit(
    problem: &CalibrationProblem<'_>,
    setup: &HoldsSetup,
    settings: &CalibrationSettings,
    (holds, biases): (Vec<Hold>, Option<&RecordingBiases>),
    (sound, of_mean): (Vec<usize>, Vector3<f64>),
) -> Result<Fitted> {
    let taken = taken(biases);
    let fit = |holds: &[Hold], conditions: Conditions| {
        robust_weights::fit(problem, setup, settings, holds, (sound.clone(), of_mean, conditions))
    };
    let without = fit(&holds, Conditions { taken, ..Conditions::default() })?;
    if setup.bias_drift_sd_mps2 <= 0.0 || holds.len() < 3 {
        let uncertainty = without.uncertainty();
        return Ok(Fitted { holds, robust: without, drift: None, uncertainty, without: None });
    }
    let none = BiasDrift {
        value: Vector3::zeros(),
        covariance: Matrix3::zeros(),
        degrees_of_freedom: 0.0,
        spans_s: spans(&holds, biases.map_or(&[], |biases| &biases.further_from_s)),
        expected_sd: Vector3::zeros(),
    };
    let parts: Vec<f64> = holds.iter().map(|hold| none.part_of(hold)).collect();
    let of = |robust: &Robust, used: &[bool], drift: &BiasDrift| {
        Posterior::of(robust, (used, &parts), setup.bias_drift_sd_mps2, drift)
    };
    let found = |start: &[bool]| -> Result<(Vec<Hold>, Robust, Posterior)> {
        let (mut before, mut posterior, mut round) = (none.clone(), of(&without, start, &none), 0);
        loop {
            let drift = posterior.drift.clone();
            let step = drift.value - before.value;
            let corrected = drift.taken_out(&holds);
            let is_left = count(start) as f64
                - without.covariance.nrows() as f64
                - taken
                - posterior.drift.degrees_of_freedom
                >= FEWEST_DEGREES;
            let least_between = if is_left { 0.0 } else { without.between_holds_sd };
            let is_rough = round < ROUGH_ROUNDS;
            let used = is_rough.then(|| start.to_vec());
            let robust = fit(
                &corrected,
                Conditions { taken: taken + posterior.drift.degrees_of_freedom, least_between, used },
            )?;
            posterior = of(&robust, &robust.used, &drift);
            round += 1;
            let is_close = !is_rough && step.component_div(&drift.sd()).amax() < CLOSE;
            if is_close || round == ROUNDS {
                return Ok((corrected, robust, posterior));
            }
            before = drift;
        }
    };
    let mut best = found(&without.used)?;
    // a drift makes good holds look like outliers
    let all: Vec<bool> = (0..holds.len()).map(|j| sound.contains(&j)).collect();
    if all != without.used
        && let Ok(other) = found(&all)
        && count(&other.1.used) > count(&best.1.used)
    {
        best = other;
    }
    let (holds, robust, Posterior { drift, slope, .. }) = best;
    let dense = DMatrix::from_column_slice(3, 3, drift.covariance.as_slice());
    let mut uncertainty = robust.uncertainty();
    uncertainty.add_covariance(VarianceSource::BiasDrift, &(&slope * dense * slope.transpose()));
    Ok(Fitted { holds, robust, drift: Some(drift), uncertainty, without: Some(without) })
}

fn count(used: &[bool]) -> usize {
    used.iter().filter(|used| **used).count()
}

/// The drift that the magnitudes of a fit ask for.
struct Posterior {
    drift: BiasDrift,
    /// `J`, p × 3.
    slope: DMatrix<f64>,
}

impl Posterior {
    /// `drift` was taken out of the holds before the fit.
    fn of(robust: &Robust, (used, parts): (&[bool], &[f64]), sd_mps2: f64, drift: &BiasDrift) -> Self {
        let expected_sd = Vector3::from_fn(|axis, _| sd_mps2 * robust.sensor.matrix.row(axis).norm());
        let known = expected_sd.map(|sd| sd.powi(-2));
        let (mut information, mut rhs) = (Matrix3::from_diagonal(&known), -known.component_mul(&drift.value));
        let mut common = DMatrix::zeros(robust.covariance.nrows(), 3);
        let used = robust.magnitudes.iter().zip(parts).zip(used).filter(|(_, used)| **used);
        for ((magnitude, part), _) in used {
            // the first parameters are the biases
            let row = magnitude.by_parameters.fixed_rows::<3>(0) * *part;
            information += row * row.transpose() / magnitude.own;
            rhs += row * (magnitude.error / magnitude.own);
            common += &magnitude.by_parameters * row.transpose() / magnitude.own;
        }
        let slope = -(&robust.covariance * &common);
        let explained = common.transpose() * &slope;
        information += Matrix3::from_fn(|i, j| explained[(i, j)]);
        let covariance = information
            .try_inverse()
            .unwrap_or_else(|| Matrix3::from_diagonal(&known.map(|known| 1.0 / known)));
        let degrees_of_freedom = (0..3).map(|k| (1.0 - covariance[(k, k)] * known[k]).clamp(0.0, 1.0)).sum();
        Self {
            drift: BiasDrift {
                value: drift.value + covariance * rhs,
                covariance,
                degrees_of_freedom,
                expected_sd,
                ..drift.clone()
            },
            slope,
        }
    }
}
