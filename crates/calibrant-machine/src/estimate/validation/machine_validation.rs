//! What a validation on a machine gives.
//!
//! Validation on another recording: two calibrations of one sensor on one machine.
//!
//! What is wrong with mount and joints is wrong in both. With `I` the information of that prior, their errors `Σ₁ I (η̄ − η)` and `Σ₂ I (η̄ − η)` belong
//! together, and the covariance of the difference is `Σ₁ + Σ₂ − Σ₁ I Σ₂ − Σ₂ I Σ₁`.

use crate::estimate::{MachineCalibration, MachineQuantity, MachineSetup, TiltedGravity};
use calibrant_core::estimate::CovarianceVerdict;
use calibrant_core::sensor::SensorKind;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use schemars::JsonSchema;
use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// How far the sensor's parameters move with other data, beside what their covariance predicts.
#[derive(Debug, Clone, PartialEq)]
pub struct MachineValidation {
    /// The other data.
    pub source: MachineValidationSource,
    /// The parameters of each sensor.
    pub shifts: Vec<ParameterShift>,
    /// Speed of the other recording over that of this one: the ratio of the rms rates or that of the forces, whichever is further from 1. 1 for blocks.
    pub speed_ratio: f64,
}

/// The other data.
#[derive(Debug, Clone, PartialEq)]
pub enum MachineValidationSource {
    /// Another recording on the same machine.
    Recording {
        /// Its name, for people; empty until someone gives it one.
        name: String,
    },
    /// The recording without a block of time, for one block after the other.
    Blocks {
        /// Number of blocks.
        folds: usize,
        /// Length of a block, s.
        length_s: f64,
        /// Blocks without which there is no calibration.
        failed: Vec<FailedBlock>,
    },
}

/// A block of time without which there is no calibration.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct FailedBlock {
    /// Its beginning on the clock of the IMU, s.
    pub start_s: f64,
    /// Its end, s.
    pub end_s: f64,
    /// What is wrong, in words.
    pub reason: String,
}

/// The movement of one sensor's parameters `Δ`, and its predicted covariance `C`.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterShift {
    /// The sensor.
    pub sensor: SensorKind,
    /// The square of `factor` times the degrees of freedom: `Δᵀ C⁻¹ Δ` on another recording.
    pub chi2: f64,
    /// Its degrees of freedom: combinations of parameters that the other data determine; of blocks, those of `Δᵀ Δ` (`satterthwaite1946`).
    pub degrees_of_freedom: usize,
    /// `√(χ²/degrees of freedom)`, of blocks `√(Σ Δᵀ Δ / Σ tr C)`: by how much the standard deviations are too small.
    pub factor: f64,
    /// Its 99 % confidence interval.
    pub factor_interval: (f64, f64),
    /// What follows.
    pub verdict: CovarianceVerdict,
    /// The largest movement.
    pub largest: LargestShift,
}

/// The parameter that moves most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LargestShift {
    /// The parameter.
    pub quantity: MachineQuantity,
    /// Its movement, in the unit of the parameter.
    pub shift: f64,
    /// The same in predicted standard deviations.
    pub in_sd: f64,
    /// Beginning of the block that was left out, on the clock of the IMU, s; `None` for another recording.
    pub without_s: Option<f64>,
}

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
    let mut largest: Option<LargestShift> = None;
    let scaled: Vec<(DVector<f64>, DMatrix<f64>)> = movements
        .iter()
        .map(|movement| {
            let shift = DVector::from_fn(places.len(), |i, _| movement.shift[places[i]] / stated[i].sqrt());
            let covariance = DMatrix::from_fn(places.len(), places.len(), |i, j| {
                movement.covariance[(places[i], places[j])] / (stated[i] * stated[j]).sqrt()
            });
            (shift, covariance)
        })
        .collect();
    for (movement, (shift, covariance)) in movements.iter().zip(&scaled) {
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
    }
    let (factor, degrees) = match scaled.as_slice() {
        [(shift, covariance)] => of_recording(shift, covariance),
        blocks => of_blocks(blocks),
    }?;
    let distribution = ChiSquared::new(degrees as f64).ok()?;
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

/// The movement on another recording: each combination of parameters that it tells counts alike.
fn of_recording(shift: &DVector<f64>, covariance: &DMatrix<f64>) -> Option<(f64, usize)> {
    let SymmetricEigen { eigenvalues, eigenvectors } = covariance.clone().symmetric_eigen();
    let told = eigenvalues.iter().zip(eigenvectors.column_iter()).filter(|(value, _)| **value > TOLD);
    let squares: Vec<f64> = told.map(|(value, direction)| direction.dot(shift).powi(2) / value).collect();
    let chi2: f64 = squares.iter().sum();
    (!squares.is_empty()).then(|| ((chi2 / squares.len() as f64).sqrt(), squares.len()))
}

/// The movements without one block after the other: their squares, in parts of the stated variances, beside what is predicted. A block hardly tells most
/// combinations of parameters. What is wrong with the model moves these by more than is predicted of them, and by little of what is stated; so they count as much
/// as they are predicted to move. The sum has `(tr C)²/tr C²` degrees of freedom for each block (`satterthwaite1946`) but one: what leaves one block moves towards
/// the others, and the sum of all movements is about 0.
fn of_blocks(blocks: &[(DVector<f64>, DMatrix<f64>)]) -> Option<(f64, usize)> {
    let moved: f64 = blocks.iter().map(|(shift, _)| shift.norm_squared()).sum();
    let predicted: f64 = blocks.iter().map(|(_, covariance)| covariance.trace()).sum();
    let degrees = |(_, covariance): &(DVector<f64>, DMatrix<f64>)| {
        covariance.trace().powi(2) / covariance.norm_squared()
    };
    let number = blocks.len() as f64;
    let degrees = blocks.iter().map(degrees).sum::<f64>() * (number - 1.0) / number;
    (predicted > TOLD && degrees >= 1.0).then(|| ((moved / predicted).sqrt(), degrees.round() as usize))
}

/// A covariance, widened as that of the calibration.
pub(crate) fn widened(calibration: &MachineCalibration, covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let widened = &calibration.inflation;
    DMatrix::from_fn(widened.len(), widened.len(), |i, j| covariance[(i, j)] * widened[i] * widened[j])
}

/// Compares how far the parameters of `second` are from those of `first` with what both covariances predict. Both are of the same setup. Delays, clock
/// and tilt belong to each recording; mount and joints to both.
///
/// The validation is empty where the two calibrations do not have the same quantities.
#[must_use]
pub fn compare_on_machine(
    first: &MachineCalibration,
    second: &MachineCalibration,
    setup: &MachineSetup,
) -> MachineValidation {
    let source = MachineValidationSource::Recording { name: String::new() };
    if first.quantities != second.quantities {
        return MachineValidation { source, shifts: Vec::new(), speed_ratio: 1.0 };
    }
    let sensors = first.sensors.sensor_kinds();
    let information = |quantity: &MachineQuantity| {
        let sd = setup.prior_sd(*quantity, sensors.len());
        let shared = matches!(
            quantity,
            MachineQuantity::Lever(_)
                | MachineQuantity::Mounting(_)
                | MachineQuantity::Zero(_)
                | MachineQuantity::Geometry(..)
        );
        if shared && sd.is_finite() { 1.0 / (sd * sd) } else { 0.0 }
    };
    let n = first.quantities.len();
    let shared = DMatrix::from_diagonal(&DVector::from_iterator(n, first.quantities.iter().map(information)));
    let common = &first.linear_covariance * shared * &second.linear_covariance;
    let [one, two] = [first, second].map(|of| widened(of, &of.linear_covariance) + &of.unseen);
    let covariance = one + two - &common - common.transpose();
    let shift = second.values.iter().zip(&first.values).map(|(two, one)| two - one);
    let movement = [Movement { shift: DVector::from_iterator(n, shift), covariance, without_s: None }];
    let shifts = sensors.iter().filter_map(|sensor| judged(first, *sensor, &movement)).collect();
    let [one, two] = [first, second].map(|of| rms_of_motion(of, setup));
    let ratios =
        [two[0] / one[0], two[1] / one[1]].into_iter().filter(|ratio| ratio.is_finite() && *ratio > 0.0);
    let speed_ratio = ratios.max_by(|one, two| one.ln().abs().total_cmp(&two.ln().abs())).unwrap_or(1.0);
    MachineValidation { source, shifts, speed_ratio }
}

/// Root mean square of the rate, rad/s, and of the specific force beside gravity's magnitude, m/s².
fn rms_of_motion(calibration: &MachineCalibration, setup: &MachineSetup) -> [f64; 2] {
    let (motion, parameters) = (&calibration.motion, &calibration.parameters);
    let gravity = TiltedGravity::new(&setup.up).vector(parameters);
    let carrier = motion.carrier(gravity, parameters.mount, &parameters.corrections);
    let (knots, mut joints) = (motion.knots(), Default::default());
    let (mut rate, mut force, mut count) = (0.0, 0.0, 0.0_f64);
    for i in (0..knots.intervals).filter(|i| calibration.covered[*i]) {
        let at = motion.sensor(&knots.weights(knots.knot_s(i)), &carrier, &mut joints);
        rate += at.rate.norm_squared();
        force += (at.specific_force.norm() - gravity.norm()).powi(2);
        count += 1.0;
    }
    [rate, force].map(|sum| (sum / count.max(1.0)).sqrt())
}
