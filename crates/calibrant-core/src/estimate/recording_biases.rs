//! The bias of a sensor in each of several recordings that are calibrated together.
//!
//! A sensor that was off in between has another bias. The bias in recording r is `b + δ_r`, with `δ = 0` in the last. `δ` is taken out of the data, and
//! its covariance `Σ_δδ` adds `J Σ_δδ Jᵀ` to that of the parameters p, with `J = ∂p/∂δ`. How far biases differ is a variance component, `δ ~ N(0, σ²)` on each axis:
//! by moments, from what the data tell of `δ` by themselves. It is 0 where they do not differ, and nothing is taken out.

use crate::motion::Hold;
use crate::sensor::Recording;
use nalgebra::{DMatrix, DVector, Vector3};

/// Combinations of biases whose information is below this share of what it was before the parameters were marginalised are not determined: they may be rounding.
const DETERMINED: f64 = 1e-9;

/// The bias of each earlier recording, less that of the last, in the unit of the readings.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordingBiases {
    /// When each recording but the first begins, s.
    pub(crate) further_from_s: Vec<f64>,
    /// Of each recording but the last.
    pub values: Vec<Vector3<f64>>,
    /// Their covariance, three rows for each.
    pub covariance: DMatrix<f64>,
}

impl RecordingBiases {
    /// From what the data tell. `unit`: by which the values are multiplied in the readings' unit, per axis. `None` where the data explain `δ` by chance.
    pub(super) fn of(further_from_s: &[f64], told: &Told, unit: &Vector3<f64>) -> Option<Self> {
        let variance = told.variance()?;
        let Told { information, weighted, .. } = told;
        let known = DMatrix::identity(weighted.len(), weighted.len()) / variance;
        let factor = (information + known).cholesky()?;
        let (values, covariance) = (factor.solve(weighted), factor.inverse());
        Some(Self {
            further_from_s: further_from_s.to_vec(),
            values: (0..further_from_s.len())
                .map(|r| values.fixed_rows::<3>(3 * r).component_mul(unit))
                .collect(),
            covariance: DMatrix::from_fn(weighted.len(), weighted.len(), |i, j| {
                covariance[(i, j)] * unit[i % 3] * unit[j % 3]
            }),
        })
    }

    /// The standard deviation of each value, per axis.
    pub fn sds(&self) -> impl Iterator<Item = Vector3<f64>> + '_ {
        let sd = |k: usize| self.covariance[(k, k)].max(0.0).sqrt();
        (0..self.values.len()).map(move |r| Vector3::new(sd(3 * r), sd(3 * r + 1), sd(3 * r + 2)))
    }

    /// The bias at a time, less that of the last recording.
    fn at(&self, time_s: f64) -> Vector3<f64> {
        self.values.get(recording_at(&self.further_from_s, time_s)).copied().unwrap_or_default()
    }

    /// The recordings of these holds.
    pub(super) fn recordings(&self, holds: &[&Hold]) -> Recordings {
        Recordings {
            of_holds: holds.iter().map(|hold| recording_at(&self.further_from_s, hold.start_s)).collect(),
            earlier: self.values.len(),
        }
    }

    /// The errors of the biases of the recordings, by one standard deviation of each independent combination: that of recording r in place r.
    pub(super) fn errors(&self) -> Vec<Vec<Vector3<f64>>> {
        let root = self.covariance.clone().cholesky().map(|factor| factor.l());
        let columns = root.iter().flat_map(|root| root.column_iter().map(|column| column.into_owned()));
        columns
            .map(|column| (0..self.values.len()).map(|r| column.fixed_rows::<3>(3 * r).into()).collect())
            .collect()
    }

    /// The recording with the bias of the last.
    pub(super) fn taken_out_of(&self, recording: &Recording) -> Recording {
        let mut times_s = recording.times_s().iter();
        recording.mapped(recording.unit(), |reading| {
            reading - times_s.next().map_or_else(Vector3::zeros, |time_s| self.at(*time_s))
        })
    }

    /// The holds with the bias of the last recording.
    pub(super) fn taken_out(&self, holds: &[Hold]) -> Vec<Hold> {
        holds.iter().map(|hold| Hold { mean: hold.mean - self.at(hold.start_s), ..hold.clone() }).collect()
    }
}

/// The recordings of some holds, each with a bias of its own. Empty where all have one.
#[derive(Debug, Clone, Default)]
pub(super) struct Recordings {
    /// The number of each hold's, from 0.
    pub(super) of_holds: Vec<usize>,
    /// Number of those before the last, with holds or without.
    pub(super) earlier: usize,
}

/// The number of the recording at a time, from 0. `further_from_s`: when each but the first begins.
#[must_use]
pub fn recording_at(further_from_s: &[f64], time_s: f64) -> usize {
    further_from_s.iter().filter(|from_s| **from_s <= time_s).count()
}

/// What the data tell of `δ`.
pub(super) struct Told {
    /// Information, with the parameters marginalised.
    pub(super) information: DMatrix<f64>,
    /// The same times `δ` of least squares.
    pub(super) weighted: DVector<f64>,
    /// The greatest entry of the information before that, on its diagonal.
    pub(super) reference: f64,
}

impl Told {
    /// `σ²` by moments. In the eigenvectors of the information, each component z of `δ` has variance `1/λ` by noise and `σ²` beyond; the precise ones count most.
    /// `None` where noise explains them.
    fn variance(&self) -> Option<f64> {
        let eigen = self.information.clone().symmetric_eigen();
        let along = eigen.eigenvectors.transpose() * &self.weighted;
        let least = DETERMINED * self.reference;
        let determined = eigen.eigenvalues.iter().zip(along.iter()).filter(|(lambda, _)| **lambda > least);
        let (mut sum, mut weights) = (0.0, 0.0);
        for (lambda, along) in determined {
            let weight = lambda * lambda;
            sum += weight * ((along / lambda).powi(2) - 1.0 / lambda);
            weights += weight;
        }
        (sum > 0.0).then(|| sum / weights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn biases_that_differ_by_chance_are_one_bias_and_others_are_their_own() {
        let information = DMatrix::identity(3, 3) * 100.0;
        let of = |delta: [f64; 3]| {
            let weighted = &information * DVector::from_row_slice(&delta);
            let told = Told { information: information.clone(), weighted, reference: 100.0 };
            RecordingBiases::of(&[60.0], &told, &Vector3::repeat(2.0))
        };
        // their sd is 0.1
        assert_eq!(of([0.1, -0.05, 0.08]), None);
        let found = of([5.0, -3.0, 2.0]).expect("they differ");
        assert!((found.values[0] - Vector3::new(10.0, -6.0, 4.0)).norm() < 0.02, "{:?}", found.values);
        assert!((found.sds().next().expect("one") - Vector3::repeat(0.2)).norm() < 1e-3);
        assert_eq!((found.at(59.0), found.at(60.0)), (found.values[0], Vector3::zeros()));
        let errors = found.errors();
        assert!(
            errors.len() == 3 && (errors[0][0] - Vector3::new(0.2, 0.0, 0.0)).norm() < 1e-3,
            "{errors:?}"
        );
    }

    #[test]
    fn what_is_not_determined_says_nothing_of_the_differences() {
        let mut information = DMatrix::identity(3, 3);
        information[(2, 2)] = 0.0;
        let weighted = DVector::from_row_slice(&[10.0, 10.0, 0.0]);
        let told = Told { information, weighted, reference: 1.0 };
        let found = RecordingBiases::of(&[1.0], &told, &Vector3::repeat(1.0)).expect("they differ");
        // as far off as the others
        let sd = found.sds().next().expect("one");
        assert!(found.values[0].z == 0.0 && (sd.z - 99.0_f64.sqrt()).abs() < 1e-9, "{found:?}");
    }
}
