//! Is a movement of parameters as large as its covariance predicts?

use crate::estimate::validation::machine_validation::{LargestShift, ParameterShift};
use crate::estimate::{MachineCalibration, MachineQuantity};
use calibrant_core::estimate::CovarianceVerdict;
use calibrant_core::sensor::SensorKind;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Combinations of parameters that other data move by less than this part of their variance are not looked at: those data hardly tell them.
const TOLD: f64 = 1e-3;
/// Ends of a two-sided interval of 99 %.
const TAILS: [f64; 2] = [0.005, 0.995];

/// A movement of all quantities, and its covariance.
pub(crate) struct Movement {
    pub(crate) shift: DVector<f64>,
    pub(crate) covariance: DMatrix<f64>,
    /// Beginning of the block that was left out, s.
    pub(crate) without_s: Option<f64>,
}

/// Judges the movements of a sensor's parameters. `None` where no data tell any.
pub(crate) fn judged(
    calibration: &MachineCalibration,
    sensor: SensorKind,
    movements: &[Movement],
) -> Option<ParameterShift> {
    let of_sensor = |place: &usize| matches!(calibration.quantities[*place], MachineQuantity::Imu(of) if of.sensor_kind() == sensor);
    let places: Vec<usize> = (0..calibration.quantities.len()).filter(of_sensor).collect();
    let stated: Vec<f64> = places.iter().map(|place| calibration.covariance[(*place, *place)]).collect();
    let (mut chi2, mut told) = (0.0, 0);
    let mut largest: Option<LargestShift> = None;
    for movement in movements {
        let shift = DVector::from_fn(places.len(), |i, _| movement.shift[places[i]] / stated[i].sqrt());
        let covariance = DMatrix::from_fn(places.len(), places.len(), |i, j| {
            movement.covariance[(places[i], places[j])] / (stated[i] * stated[j]).sqrt()
        });
        for (i, place) in places.iter().enumerate() {
            let in_sd = shift[i] / covariance[(i, i)].max(TOLD).sqrt();
            if largest.is_none_or(|of| in_sd.abs() > of.in_sd.abs()) {
                largest = Some(LargestShift {
                    quantity: calibration.quantities[*place],
                    shift: movement.shift[*place],
                    in_sd,
                    without_s: movement.without_s,
                });
            }
        }
        let SymmetricEigen { eigenvalues, eigenvectors } = covariance.symmetric_eigen();
        for (value, direction) in eigenvalues.iter().zip(eigenvectors.column_iter()) {
            if *value > TOLD {
                chi2 += direction.dot(&shift).powi(2) / value;
                told += 1;
            }
        }
    }
    // blocks of one recording: what leaves one block moves towards the others, and the sum of all movements is about 0
    let blocks = movements.len();
    let degrees = if blocks > 1 { told * (blocks - 1) / blocks } else { told };
    let distribution = ChiSquared::new(degrees as f64).ok()?;
    // each movement has its mean, so the sum is scaled to these degrees
    let factor = (chi2 / told as f64).sqrt();
    let chi2 = factor * factor * degrees as f64;
    let [high, low] = TAILS.map(|tail| factor * (degrees as f64 / distribution.inverse_cdf(tail)).sqrt());
    Some(ParameterShift {
        sensor,
        chi2,
        degrees_of_freedom: degrees,
        factor,
        factor_interval: (low, high),
        verdict: CovarianceVerdict::of(factor, (low, high)),
        largest: largest?,
    })
}

/// A covariance, widened as that of the calibration.
pub(crate) fn widened(calibration: &MachineCalibration, covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let widened = &calibration.inflation;
    DMatrix::from_fn(widened.len(), widened.len(), |i, j| covariance[(i, j)] * widened[i] * widened[j])
}
