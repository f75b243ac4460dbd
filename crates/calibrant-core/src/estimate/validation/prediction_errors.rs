//! Errors of a claim on holds and rotations that it knows nothing of.

use super::chi_square_ratio::Ratio;
use super::hold_prediction::HoldPrediction;
use super::noise_comparison::NoiseRatio;
use super::predicted_error::{Group, Item, Place, Scattered};
use super::prediction::Prediction;
use super::result::BiasShift;
use super::statistics::degrees_behind;
use super::whitened_errors::{Shift, Whitened};
use crate::estimate::imu::{GravityPropagation, GyroscopeAtRest, PropagatedGravity, StationaryMean};
use crate::estimate::quantisation::of_means;
use crate::estimate::{Calibration, RotationResult, clipped_holds, coarse_axes_in};
use crate::motion::Hold;
use crate::sensor::{Recording, SensorKind, Temperatures};
use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Vector3};

/// Below this error of a rotation nothing is told apart, as in the fit, rad.
const FLOOR_RAD: f64 = 1e-9;
/// A bias has moved where one that far off would be seen in fewer than this share of recordings.
const MOVED: f64 = 0.01;

/// Holds that a claim is tried on, and what was recorded in and between them.
#[derive(Clone)]
pub(super) struct Unused<'a> {
    /// The holds, with their numbers.
    pub(super) holds: Vec<(usize, &'a Hold)>,
    /// Standard deviation of an accelerometer sample within holds.
    pub(super) within: Vector3<f64>,
    pub(super) accelerometer: &'a Recording,
    pub(super) gyroscope: Option<&'a Recording>,
    /// Numbers of the holds in which the gyroscope turns, as the calibration of the same recording found.
    pub(super) turning_holds: &'a [usize],
    /// Temperatures, where the calibration follows them.
    pub(super) temperatures: Option<Temperatures<'a>>,
    /// Is it another recording than the claim's? Then its noise and the gyroscope's bias may be others.
    pub(super) another: bool,
    pub(super) fold: usize,
}

/// The errors of each kind.
pub(super) struct Errors {
    pub(super) magnitudes: Group,
    pub(super) rates: Group,
    pub(super) rotations: Group,
    pub(super) shift: Option<BiasShift>,
    /// Of each sensor of another recording.
    pub(super) noise: Vec<NoiseRatio>,
}

impl<'a> Unused<'a> {
    /// Holds of a recording of an accelerometer, but those in which it saturates.
    pub(super) fn of_accelerometer(recording: &'a Recording, holds: &'a [Hold]) -> Self {
        let clipped = clipped_holds(recording, holds);
        let sound = |(number, _): &(usize, &Hold)| clipped[*number].is_none();
        let holds: Vec<(usize, &Hold)> = holds.iter().enumerate().filter(sound).collect();
        Self {
            within: Hold::pooled_sd(holds.iter().map(|(_, hold)| *hold)),
            holds,
            accelerometer: recording,
            gyroscope: None,
            turning_holds: &[],
            temperatures: None,
            another: false,
            fold: 0,
        }
    }

    /// The errors that a claim makes on them; `None` where a matrix of it is singular.
    pub(super) fn errors(&self, prediction: &Prediction) -> Option<Errors> {
        let holds: Vec<&Hold> = self.holds.iter().map(|(_, hold)| *hold).collect();
        let beside = |sensor_kind: SensorKind, sd: &Vector3<f64>, calibrated_sd: &Vector3<f64>| {
            if self.another {
                NoiseRatio::of(sensor_kind, sd, calibrated_sd)
            } else {
                NoiseRatio::one(sensor_kind)
            }
        };
        let mut noise = vec![beside(SensorKind::Accelerometer, &self.within, &prediction.within)];
        let at_rest = self.gyroscope.map(|gyroscope| {
            let noise_of = |scatter: &Vector3<f64>| {
                let ratio = beside(SensorKind::Gyroscope, scatter, &prediction.still_within);
                noise.push(ratio);
                prediction.still_noise.component_mul(&ratio.axes)
            };
            let turns = |place: usize| self.turning_holds.contains(&self.holds[place].0);
            let at_rest = GyroscopeAtRest::of(gyroscope, &holds, turns, noise_of);
            let at_rest =
                if self.another { at_rest.with_steps_in_common(&prediction.still_sd) } else { at_rest };
            (gyroscope, at_rest)
        });
        let with_steps = match &at_rest {
            Some((_, at_rest)) => prediction.with_steps(at_rest.of_steps()),
            None => prediction.clone(),
        };
        let prediction = &with_steps;
        let hold_means: Vec<Option<StationaryMean>> = match &at_rest {
            Some((_, at_rest)) => at_rest.holds().collect(),
            None => vec![None; holds.len()],
        };
        let temperature = |hold: &Hold| match self.temperatures {
            Some(temperatures) => temperatures.mean(hold.start_s, hold.end_s),
            None => prediction.imu.thermal.reference_c,
        };
        let of_mean = of_means(&coarse_axes_in(self.accelerometer, holds.iter().copied()));
        let correct = |prediction: &Prediction| -> Option<Vec<HoldPrediction>> {
            let pairs = self.holds.iter().zip(&hold_means);
            pairs
                .map(|((number, hold), still)| {
                    let noise = (&self.within, &of_mean, noise.as_slice());
                    HoldPrediction::of(prediction, *number, hold, temperature(hold), noise, still.as_ref())
                })
                .collect()
        };
        let hold_predictions = correct(prediction)?;
        let magnitudes =
            hold_predictions.iter().map(|hold_predictions| hold_predictions.magnitude(prediction)).collect();
        let mut rates = self.group(
            hold_predictions.iter().filter_map(HoldPrediction::rate).collect(),
            &prediction.covariance,
        );
        let mut of_rotations = prediction.clone();
        let mut shift = None;
        if self.another && !rates.items.is_empty() {
            let without =
                Group { items: rates.items.clone(), covariance: prediction.covariance_without_bias() };
            let (found, value, covariance) = moved(&rates, &without, prediction)?;
            if found.moved {
                of_rotations = prediction.with_bias_moved_by(&value, &covariance);
                let by = DVector::from_column_slice(value.as_slice());
                rates = without;
                rates.items.iter_mut().for_each(|item| item.error -= &by);
            }
            shift = Some(found);
        }
        let temperatures_c: Vec<f64> = holds.iter().map(|hold| temperature(hold)).collect();
        let rotations = match &at_rest {
            Some((gyroscope, at_rest)) => {
                let noise_here = noise.last().map_or(1.0, |noise| noise.overall().powi(2));
                let at_rest = (*gyroscope, at_rest);
                self.rotations(
                    &of_rotations,
                    at_rest,
                    &holds,
                    &hold_predictions,
                    &temperatures_c,
                    noise_here,
                )?
            }
            None => Vec::new(),
        };
        Some(Errors {
            magnitudes: self.group(magnitudes, &prediction.covariance),
            rates,
            rotations: self.group(rotations, &of_rotations.covariance),
            shift,
            noise: if self.another { noise } else { Vec::new() },
        })
    }

    fn group(&self, mut items: Vec<Item>, covariance: &DMatrix<f64>) -> Group {
        items.iter_mut().for_each(|item| item.place.fold = self.fold);
        Group { items, covariance: covariance.clone() }
    }

    /// Gravity after each rotation. The directions before and after are those that the claim finds, with their errors. Neighbours share a hold, and with it the errors of its
    /// direction and of the bias in it. `noise_here`: how many times the variance of the gyroscope's noise is that in the calibration.
    fn rotations(
        &self,
        prediction: &Prediction,
        (gyroscope, at_rest): (&Recording, &GyroscopeAtRest),
        holds: &[&Hold],
        hold_predictions: &[HoldPrediction],
        temperatures_c: &[f64],
        noise_here: f64,
    ) -> Option<Vec<Item>> {
        let carrying = GravityPropagation {
            imu: &prediction.imu,
            quantities: &prediction.quantities,
            gravity_mps2: prediction.gravity_mps2,
            vertical_rate: prediction.vertical_rate,
            north_sd_radps: prediction.north_sd_radps,
            knock_rms: prediction.knock_rms,
            turns_in_holds: prediction.turns_in_holds,
            between: prediction.still_sd,
            accelerometer: self.accelerometer,
            gyroscope,
            at_rest,
        };
        let forces: Vec<Vector3<f64>> =
            hold_predictions.iter().map(|hold_predictions| hold_predictions.force).collect();
        let all = carrying.through(holds, &forces, temperatures_c)?;
        let mut previous: Option<&PropagatedGravity> = None;
        let items = all.iter().map(|propagated| {
            let (before, after) =
                (&hold_predictions[propagated.from], &hold_predictions[propagated.from + 1]);
            let neighbour =
                previous.replace(propagated).filter(|previous| previous.from + 1 == propagated.from);
            let shared = neighbour.map(|previous| {
                propagated.noise_with_previous + propagated.by_from * before.own * previous.by_to.transpose()
            });
            let dense = |by: &nalgebra::Matrix2x3<f64>| DMatrix::from_column_slice(2, 3, by.as_slice());
            let by_parameters = &propagated.by_parameters
                + dense(&propagated.by_from) * &before.by_parameters
                + dense(&propagated.by_to) * &after.by_parameters;
            let excess = Matrix2::identity() * prediction.rotation_sd_rad.powi(2);
            let own = propagated.noise
                + propagated.of_knocks
                + propagated.of_earth
                + excess
                + propagated.by_from * before.own * propagated.by_from.transpose()
                + propagated.by_to * after.own * propagated.by_to.transpose()
                + Matrix2::identity() * FLOOR_RAD.powi(2);
            Item {
                place: Place {
                    hold: self.holds[propagated.from + 1].0,
                    from_hold: Some(self.holds[propagated.from].0),
                    start_s: propagated.start_s,
                    end_s: propagated.end_s,
                    fold: self.fold,
                    along: vec![before.along(), after.along()],
                },
                error: DVector::from_column_slice(propagated.error.as_slice()),
                by_parameters,
                own: DMatrix::from_column_slice(2, 2, own.as_slice()),
                with_previous: shared.map(|shared| DMatrix::from_column_slice(2, 2, shared.as_slice())),
                knock_share: propagated.of_knocks.trace() / own.trace(),
                // rotations are taken to be as long as in the calibration
                scatters: vec![Scattered {
                    scatter: 0.5 * (excess + propagated.of_knocks).trace(),
                    calibrated_noise: 0.5 * propagated.noise.trace() / noise_here,
                    own: 0.5 * own.trace(),
                }],
            }
        });
        Some(items.collect())
    }
}

impl Errors {
    /// Leaves out the rotations that the calibration itself did not use.
    pub(super) fn retain_used(&mut self, calibration: &Calibration) {
        let Some(gyroscope) = &calibration.gyroscope else { return };
        let left_out: Vec<_> = gyroscope.rotations.iter().filter(|rotation| !rotation.used).collect();
        self.rotations.retain(|place| {
            let is_it =
                |of: &&RotationResult| Some(of.from_hold) == place.from_hold && of.to_hold == place.hold;
            !left_out.iter().any(is_it)
        });
    }
}

/// Has the bias moved? By how much, and how well that is known, in the errors alone.
fn moved(
    rates: &Group,
    without_bias: &Group,
    prediction: &Prediction,
) -> Option<(BiasShift, Vector3<f64>, Matrix3<f64>)> {
    let all = vec![true; rates.items.len()];
    let expected = Whitened::of(rates, &all)?.shift()?;
    let found = Whitened::of(without_bias, &all)?.shift()?;
    let behind = degrees_behind(rates.items.iter(), &prediction.still_degrees);
    let chi2 = beyond_steps(&expected, prediction).unwrap_or(expected.chi2);
    let p_value = Ratio::new(3.0, &behind).above(chi2 / 3.0);
    let shift = BiasShift {
        shift_radps: found.three(0),
        sd_radps: expected.sd_of_three(0),
        p_value,
        moved: p_value < MOVED,
    };
    Some((shift, found.three(0), found.covariance_of_three(0)))
}

/// χ² of a shift less what coarse steps may have made of it, where there are some: no more than √3 of their standard deviation, which is half a step where noise is small.
fn beyond_steps(shift: &Shift, prediction: &Prediction) -> Option<f64> {
    let correction = prediction.imu[SensorKind::Gyroscope]
        .matrix
        .try_inverse()
        .filter(|_| prediction.of_steps.amax() > 0.0)?;
    let of_steps = correction * Matrix3::from_diagonal(&prediction.of_steps) * correction.transpose();
    let value = shift.three(0);
    let beyond = Vector3::from_fn(|axis, _| {
        let most = (3.0 * of_steps[(axis, axis)]).sqrt();
        value[axis] - value[axis].clamp(-most, most)
    });
    let covariance = (shift.covariance_of_three(0) - of_steps).cholesky()?;
    Some(beyond.dot(&covariance.solve(&beyond)))
}
