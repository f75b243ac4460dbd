//! The accelerometer's bias in each of several recordings, from the magnitudes of their holds.

use super::HoldsSetup;
use super::robust::{Conditions, Robust};
use super::robust_weights;
use crate::error::Result;
use crate::estimate::recording_biases::{RecordingBiases, Told, recording_at};
use crate::estimate::{CalibrationProblem, CalibrationSettings};
use crate::motion::Hold;
use nalgebra::{DMatrix, DVector, Vector3};

/// Rounds in which biases and parameters follow each other.
const ROUNDS: usize = 8;
/// The rounds end with a step below this many standard deviations.
const CLOSE: f64 = 0.01;

/// The biases of the recordings; `None` where there is one recording, or one bias.
pub(super) fn recording_biases(
    problem: &CalibrationProblem<'_>,
    setup: &HoldsSetup,
    settings: &CalibrationSettings,
    holds: &[Hold],
    (sound, of_mean): (&[usize], Vector3<f64>),
) -> Result<Option<RecordingBiases>> {
    if setup.further_from_s.is_empty() {
        return Ok(None);
    }
    let mut biases: Option<RecordingBiases> = None;
    for round in 0..ROUNDS {
        let steady = biases.as_ref().map_or_else(|| holds.to_vec(), |biases| biases.taken_out(holds));
        // far biases make good holds look like outliers
        let all = || (0..holds.len()).map(|j| sound.contains(&j)).collect();
        let conditions = Conditions {
            used: (round == 0).then(all),
            taken: taken(biases.as_ref()),
            ..Conditions::default()
        };
        let robust =
            robust_weights::fit(problem, setup, settings, &steady, (sound.to_vec(), of_mean, conditions))?;
        let next = Magnitudes::of(&robust, &steady, setup).biases(biases.as_ref(), setup);
        let is_close = match (&biases, &next) {
            (Some(last), Some(next)) => last
                .values
                .iter()
                .zip(&next.values)
                .zip(next.sds())
                .all(|((last, next), sd)| (next - last).abs() < sd * CLOSE),
            (last, next) => last.is_none() && next.is_none(),
        };
        biases = next;
        if is_close {
            break;
        }
    }
    Ok(biases)
}

/// Degrees of freedom that the biases take.
pub(super) fn taken(biases: Option<&RecordingBiases>) -> f64 {
    biases.map_or(0.0, |biases| 3.0 * biases.values.len() as f64)
}

/// `J Σ_δδ Jᵀ`, in a fit of holds from which the biases were taken out.
pub(super) fn covariance_by(
    biases: &RecordingBiases,
    robust: &Robust,
    holds: &[Hold],
    setup: &HoldsSetup,
) -> DMatrix<f64> {
    let slope = -(&robust.covariance * Magnitudes::of(robust, holds, setup).common);
    &slope * &biases.covariance * slope.transpose()
}

/// What the magnitudes tell of biases in the unit of the readings.
struct Magnitudes {
    /// Information about the biases, with the parameters marginalised.
    information: DMatrix<f64>,
    /// The same times the biases that are left.
    weighted: DVector<f64>,
    /// Information that biases and parameters share.
    common: DMatrix<f64>,
    /// Diagonal of the information with the parameters known.
    unreduced: DVector<f64>,
    gains: Vector3<f64>,
}

impl Magnitudes {
    fn of(robust: &Robust, holds: &[Hold], setup: &HoldsSetup) -> Self {
        let unknowns = 3 * setup.further_from_s.len();
        let (mut information, mut weighted) = (DMatrix::zeros(unknowns, unknowns), DVector::zeros(unknowns));
        let mut common = DMatrix::zeros(robust.covariance.nrows(), unknowns);
        for ((magnitude, hold), _) in
            robust.magnitudes.iter().zip(holds).zip(&robust.used).filter(|(_, used)| **used)
        {
            let recording = recording_at(&setup.further_from_s, hold.start_s);
            if 3 * recording < unknowns {
                let mut row = DVector::zeros(unknowns);
                // the first parameters are the biases
                row.fixed_rows_mut::<3>(3 * recording).copy_from(&magnitude.by_parameters.fixed_rows::<3>(0));
                information += &row * row.transpose() / magnitude.own;
                weighted += &row * (magnitude.error / magnitude.own);
                common += &magnitude.by_parameters * row.transpose() / magnitude.own;
            }
        }
        let unreduced = information.diagonal();
        information -= common.transpose() * &robust.covariance * &common;
        Self { information, weighted, common, unreduced, gains: robust.sensor.gains() }
    }

    /// All biases. `taken_out`: those that were.
    fn biases(&self, taken_out: Option<&RecordingBiases>, setup: &HoldsSetup) -> Option<RecordingBiases> {
        let unknowns = self.weighted.len();
        // in m/s², in which the axes are alike
        let gain = |k: usize| self.gains[k % 3];
        let information =
            DMatrix::from_fn(unknowns, unknowns, |i, j| self.information[(i, j)] * gain(i) * gain(j));
        let taken_out = DVector::from_fn(unknowns, |k, _| {
            taken_out.map_or(0.0, |biases| biases.values[k / 3][k % 3] / gain(k))
        });
        let left = DVector::from_fn(unknowns, |k, _| self.weighted[k] * gain(k));
        let weighted = &information * taken_out + left;
        let reference = DVector::from_fn(unknowns, |k, _| self.unreduced[k] * gain(k).powi(2)).max();
        RecordingBiases::of(&setup.further_from_s, &Told { information, weighted, reference }, &self.gains)
    }
}
