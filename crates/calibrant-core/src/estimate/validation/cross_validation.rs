//! A calibration tried on its own holds, each block predicted by a calibration without it.

use super::caveats_of_calibration::Caveats;
use super::folds::{Block, blocks, sorted};
use super::inputs::{from_holds, of_holds, singular, temperatures, view};
use super::judgement::judged;
use super::prediction::Prediction;
use super::prediction_errors::{Errors, Unused};
use super::{Validation, ValidationSource};
use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::imu::recordings;
use crate::estimate::{
    Calibration, CalibrationProblem, CalibrationSettings, CalibrationStatus, HoldsSetup, ImuProblem,
    ImuSetup, Stimulus, calibrate, calibrate_imu,
};
use crate::motion::Hold;
use crate::sensor::{ImuRecording, Recording, SensorKind};
use nalgebra::Vector3;
use rayon::prelude::*;
use std::borrow::Cow;

/// Leaves out each of so many contiguous blocks of the holds that the calibration of an IMU used, and predicts it from the others.
///
/// # Errors
/// [`Error::Experiment`](crate::Error::Experiment) for a number of folds below 2 or above that of the used holds, where the directions of the holds are known;
/// [`Error::Recording`](crate::Error::Recording) where no block can be predicted from the others (it says why). A single block that cannot is in the result.
pub fn cross_validate_imu(
    calibration: &Calibration,
    problem: &ImuProblem<'_>,
    settings: &CalibrationSettings,
    folds: usize,
) -> Result<Validation> {
    cross_validated_imu(calibration, problem, settings, folds, &|_| ())
}

/// The same; the tests tamper with what each calibration claims.
fn cross_validated_imu(
    calibration: &Calibration,
    problem: &ImuProblem<'_>,
    settings: &CalibrationSettings,
    folds: usize,
    tamper: &(dyn Fn(&mut Calibration) + Sync),
) -> Result<Validation> {
    if problem.setup.directions.is_some() {
        return Err(Error::experiment(InputError::new(
            Refusal::ValidationImpossible,
            "folds say nothing where the directions of the holds are known: a face that is left out shows how well the sensor was placed on it",
            "validate on another recording, with holds in any orientation",
        )));
    }
    let accelerometer = problem.recording[SensorKind::Accelerometer].as_ref();
    let accelerometer = accelerometer.map(|recording| steady(calibration, recording).into_owned());
    let gyroscope = problem.recording[SensorKind::Gyroscope].clone();
    let biases = calibration.gyroscope.as_ref().and_then(|gyroscope| gyroscope.recording_biases.as_ref());
    let gyroscope = match (gyroscope, biases) {
        (Some(recording), Some(biases)) => Some(biases.taken_out_of(&recording)),
        (gyroscope, _) => gyroscope,
    };
    let recording = ImuRecording { sensors: [accelerometer, gyroscope].into(), ..problem.recording.clone() };
    let problem = &ImuProblem { recording: &recording, ..*problem };
    let (accelerometer, gyroscope) = recordings(problem)?;
    let all: Vec<Hold> = calibration.hold_results().iter().map(|result| result.hold.clone()).collect();
    let still_noise = calibration.gyroscope.as_ref().map(|gyroscope| gyroscope.still.noise);
    let train = |block: &Block| {
        let setup = without(block, problem.setup);
        let recording = problem.recording.clone().with(SensorKind::Gyroscope, Some(block.cut(gyroscope)));
        let problem = ImuProblem { recording: &recording, setup: &setup, ..*problem };
        let mut trained = calibrate_imu(&problem, settings)?;
        converged(trained.status)?;
        tamper(&mut trained);
        // noise is that of all holds
        let still_noise = still_noise.unwrap_or_else(Vector3::zeros);
        Ok(Prediction { still_noise, ..Prediction::of(&trained, from_holds(&trained)?, &setup) })
    };
    let at_sensor = temperatures(calibration, problem)?;
    let data = Unused {
        gyroscope: Some(gyroscope),
        turning_holds: calibration.gyroscope.as_ref().map_or(&[], |of| &of.still.turning_holds),
        temperatures: at_sensor.as_ref().map(view),
        ..Unused::of_accelerometer(accelerometer, &all)
    };
    crossed(calibration, folds, &data, &train)
}

/// Leaves out each of so many contiguous blocks of the holds that the calibration of an accelerometer used, and predicts it from the others.
///
/// # Errors
/// As [`cross_validate_imu`]; [`Error::Experiment`](crate::Error::Experiment) for a calibration that is not from holds.
pub fn cross_validate(
    calibration: &Calibration,
    problem: &CalibrationProblem<'_>,
    settings: &CalibrationSettings,
    folds: usize,
) -> Result<Validation> {
    let (setup, _) = of_holds(calibration, problem)?;
    let setup = HoldsSetup { bias_drift_sd_mps2: 0.0, further_from_s: Vec::new(), ..setup.clone() };
    let steady = steady(calibration, problem.recording);
    let problem = &CalibrationProblem { recording: &steady, ..*problem };
    let train = |block: &Block| {
        let setup = HoldsSetup { intervals_s: Some(block.others.clone()), ..setup.clone() };
        let problem = CalibrationProblem { stimulus: Stimulus::Holds(&setup), ..*problem };
        let trained = calibrate(&problem, settings)?;
        converged(trained.status)?;
        Ok(Prediction::of(&trained, from_holds(&trained)?, &ImuSetup::from_holds(&setup)))
    };
    let all: Vec<Hold> = calibration.hold_results().iter().map(|result| result.hold.clone()).collect();
    let data = Unused::of_accelerometer(problem.recording, &all);
    crossed(calibration, folds, &data, &train)
}

/// The errors of each block by the claim without it.
fn crossed(
    calibration: &Calibration,
    folds: usize,
    data: &Unused<'_>,
    train: &(dyn Fn(&Block) -> Result<Prediction> + Sync),
) -> Result<Validation> {
    let results = calibration.hold_results();
    let used: Vec<(usize, &Hold)> =
        data.holds.iter().copied().filter(|(number, _)| results[*number].used).collect();
    let holds: Vec<&Hold> = used.iter().map(|(_, hold)| *hold).collect();
    let blocks = blocks(&holds, folds)?;
    let outcomes: Vec<Result<(Prediction, Errors)>> = blocks
        .par_iter()
        .enumerate()
        .map(|(fold, block)| {
            let prediction = train(block)?;
            let unused = Unused { holds: used[block.places.clone()].to_vec(), fold, ..data.clone() };
            let mut errors = unused.errors(&prediction).ok_or_else(singular)?;
            errors.retain_used(calibration);
            Ok((prediction, errors))
        })
        .collect();
    let numbers: Vec<usize> = used.iter().map(|(number, _)| *number).collect();
    let (done, failed) = sorted(&blocks, &numbers, outcomes)?;
    let (predictions, errors): (Vec<Prediction>, Vec<Errors>) = done.into_iter().unzip();
    let Some(prediction) = predictions.last() else { return Err(singular()) };
    let drift = calibration.holds().and_then(|holds| holds.drift.as_deref());
    let drift_degrees = drift.map_or(0.0, |drift| drift.degrees_of_freedom);
    let source = ValidationSource::Folds { folds, failed };
    Ok(judged(source, errors, prediction, drift_degrees, &Caveats::of(calibration)))
}

/// The recording without the drift of the accelerometer's bias, and with one bias: the blocks have them in common.
fn steady<'a>(calibration: &Calibration, accelerometer: &'a Recording) -> Cow<'a, Recording> {
    let mut steady = Cow::Borrowed(accelerometer);
    let Some(holds) = calibration.holds() else { return steady };
    if let Some(biases) = &holds.recording_biases {
        steady = Cow::Owned(biases.taken_out_of(&steady));
    }
    if let Some(drift) = &holds.drift {
        steady = Cow::Owned(drift.taken_out_of(&steady));
    }
    steady
}

/// What is known of the recording, without a block of its holds.
fn without(block: &Block, setup: &ImuSetup) -> ImuSetup {
    let mut setup = setup.clone();
    setup.holds.intervals_s = Some(block.others.clone());
    setup.holds.bias_drift_sd_mps2 = 0.0;
    setup.holds.further_from_s.clear();
    setup.turns.retain(|turn| !block.touches(turn.start_s, turn.end_s));
    setup
}

fn converged(status: CalibrationStatus) -> Result<()> {
    if status == CalibrationStatus::Converged {
        return Ok(());
    }
    Err(Error::recording(InputError::new(
        Refusal::FitFailed,
        format!("the estimation did not converge ({})", status.name()),
        "",
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::{CovarianceVerdict, ErrorKind, Gyroscope, Recovered};
    use crate::motion::Gravity;
    use crate::sensor::{ImuParameters, Sensor, SensorModel};
    use crate::simulate::{ImuSimulation, Purpose, simulate_imu, stream};
    use nalgebra::Vector3;

    /// Gyroscope's and accelerometer's noise twice as large as the calibrations of the folds believe.
    #[test]
    fn standard_deviations_that_are_half_of_what_they_should_be_are_found_by_folds() {
        let gyroscope = Gyroscope { g_sensitivity: false, ..Gyroscope::default() };
        let accelerometer = Sensor::triaxial(SensorModel::Full);
        let mut found = [0; 2];
        let count = 20;
        for number in 0..count {
            let mut rng = stream(31, Purpose::Sensor, number);
            let simulation = ImuSimulation { poses: 36, ..ImuSimulation::default() };
            let mut recording = simulate_imu(&ImuParameters::identity(), &simulation, &mut rng);
            // a disturbance of each hold
            let noise = simulate_imu(&ImuParameters::identity(), &simulation, &mut rng);
            let (Some(one), Some(other)) =
                (&mut recording[SensorKind::Accelerometer], &noise[SensorKind::Accelerometer])
            else {
                continue;
            };
            let pushes: Vec<Vector3<f64>> =
                (0..36).map(|k| other.readings[k * 450] - other.readings[k * 450 + 1]).collect();
            for (t, y) in one.times_s.iter().zip(&mut one.readings) {
                *y += pushes[(t / 4.5) as usize] * 0.2;
            }
            let intervals: Vec<(f64, f64)> =
                (0..36).map(|k| 4.5 * f64::from(k)).map(|t| (t + 0.02, t + 2.48)).collect();
            let setup = ImuSetup {
                holds: HoldsSetup {
                    intervals_s: Some(intervals),
                    bias_drift_sd_mps2: 0.0,
                    gravity: Gravity { sd_mps2: 0.0, ..Gravity::SOMEWHERE },
                    ..HoldsSetup::default()
                },
                ..ImuSetup::default()
            };
            let problem = ImuProblem {
                accelerometer: &accelerometer,
                gyroscope: &gyroscope,
                recording: &recording,
                setup: &setup,
            };
            let settings = CalibrationSettings::default();
            let whole = calibrate_imu(&problem, &settings).expect("determined");
            let halved = |calibration: &mut Calibration| {
                calibration.covariance *= 0.25;
                if let Recovered::Holds(holds) = &mut calibration.recovered {
                    holds.between_holds_sd_mps2 *= 0.5;
                }
            };
            for (k, validation) in [
                cross_validated_imu(&whole, &problem, &settings, 6, &|_| ()),
                cross_validated_imu(&whole, &problem, &settings, 6, &halved),
            ]
            .into_iter()
            .enumerate()
            {
                let validation = validation.expect("determined");
                let errors = validation.of_kind(ErrorKind::Magnitude).expect("holds");
                found[k] += u64::from(errors.verdict == CovarianceVerdict::TooSmall);
            }
        }
        assert!(found[0] <= 1 && found[1] >= count - 1, "{found:?} of {count}");
    }
}
