//! The calibration from holds: detection, fit, result.

use super::coarse_steps::coarse_steps;
use super::drift_fit::{self, Fitted};
use super::hold_detection::{beyond, find_clean_holds, holds_between};
use super::low_pass_filtered::{holds_lost_to_filter, with_filter};
use super::recording_biases::{covariance_by, recording_biases};
use super::residuals::magnitude_rms;
use super::saturated_holds::{clipped_holds, reason as clipped_reason, with_clipped};
use super::setup::HoldsSetup;
use super::{accelerometer_change, verdict};
use crate::diagnostic::{Diagnostic, HoldReason};
use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::at_rest::AtRest;
use crate::estimate::quantisation::of_means;
use crate::estimate::recording_biases::RecordingBiases;
use crate::estimate::{
    Calibration, CalibrationProblem, CalibrationSettings, FitStatistics, HoldCalibration, HoldResult,
    Uncalibrated, coarse_axes_in,
};
use crate::motion::Hold;
use crate::sensor::{ImuParameters, PerSensor, Recording, SensorKind, SensorParameters};
use crate::solve::{VarianceSource, chi2_p_value};
use nalgebra::{Matrix3, Vector3};

/// Calibrates from holds of a recording without spikes. `as_read`: the same samples before spikes were replaced, which show saturation.
pub(in crate::estimate) fn calibrate(
    problem: &CalibrationProblem<'_>,
    setup: &HoldsSetup,
    settings: &CalibrationSettings,
    as_read: &Recording,
) -> Result<Calibration> {
    if problem.sensor.axes != 3 {
        return Err(Error::experiment(InputError::new(
            Refusal::ExperimentUnsuited,
            "a static calibration needs three axes: only the magnitude of gravity is known, not its direction",
            "set sensor.axes = 3",
        )));
    }
    let holds = match (&setup.intervals_s, &setup.found) {
        (Some(intervals), _) => holds_between(problem.recording, intervals)?,
        (None, Some(found)) => found.clone(),
        (None, None) => find_clean_holds(problem.recording, setup.minimum_hold_s)?,
    };
    let clipped = clipped_holds(as_read, &holds);
    let sound: Vec<usize> = (0..holds.len()).filter(|&j| clipped[j].is_none()).collect();
    let coarse = coarse_axes_in(as_read, sound.iter().map(|&j| &holds[j]));
    let of_mean = of_means(&coarse);
    let found = setup.intervals_s.is_none().then_some((problem.recording, setup.minimum_hold_s));
    let lost = found
        .and_then(|(recording, minimum_s)| holds_lost_to_filter(recording, &holds, minimum_s))
        .map(Diagnostic::from);
    let detected = holds.clone();
    let fitted = fitted(problem, setup, settings, holds, (sound, of_mean))
        .map_err(|error| with_clipped(error, &clipped, as_read))
        .map_err(|error| match found {
            Some((recording, minimum_s)) => with_filter(error, recording, &detected, minimum_s),
            None => error,
        })?;
    let reasons = clipped.iter().map(|end| end.map(|end| clipped_reason(&end, as_read))).collect();
    let (biases, fitted) = fitted;
    let mut calibration = assemble(problem, setup, reasons, biases, fitted);
    calibration.warnings.extend(lost);
    calibration.warnings.extend(coarse_steps(&coarse, as_read));
    calibration.warnings.extend(beyond(as_read, setup.intervals_s.as_deref().unwrap_or_default()));
    Ok(Calibration { datasheet_prior: settings.datasheet_prior, ..calibration })
}

/// The fit of the holds as if they were of one recording, with the biases of the recordings.
fn fitted(
    problem: &CalibrationProblem<'_>,
    setup: &HoldsSetup,
    settings: &CalibrationSettings,
    holds: Vec<Hold>,
    (sound, of_mean): (Vec<usize>, Vector3<f64>),
) -> Result<(Option<RecordingBiases>, Fitted)> {
    let biases = recording_biases(problem, setup, settings, &holds, (&sound, of_mean))?;
    let holds = match &biases {
        Some(biases) => biases.taken_out(&holds),
        None => holds,
    };
    let mut fitted = drift_fit::fit(problem, setup, settings, (holds, biases.as_ref()), (sound, of_mean))?;
    if let Some(biases) = &biases {
        let without_drift = fitted.without.as_ref().unwrap_or(&fitted.robust);
        let by_biases = covariance_by(biases, without_drift, &fitted.holds, setup);
        fitted.uncertainty.add_covariance(VarianceSource::OtherRecordings, &by_biases);
    }
    Ok((biases, fitted))
}

/// Assembles the result.
fn assemble(
    problem: &CalibrationProblem<'_>,
    setup: &HoldsSetup,
    reasons: Vec<Option<HoldReason>>,
    recording_biases: Option<RecordingBiases>,
    Fitted { holds, robust, drift, uncertainty, without }: Fitted,
) -> Calibration {
    let list = setup.parameter_list(problem.sensor.model);
    let (sensor, g) = (robust.sensor, setup.gravity);
    let results: Vec<HoldResult> = holds
        .into_iter()
        .zip(reasons)
        .enumerate()
        .map(|(j, (hold, reason))| HoldResult {
            force_mps2: robust.forces[j],
            magnitude_residual_mps2: robust.magnitudes[j].error,
            magnitude_sd_mps2: (robust.magnitudes[j].error / robust.studentised[j]).abs(),
            studentised_residual: robust.studentised[j],
            used: robust.used[j],
            reason,
            hold,
        })
        .collect();
    let used = || results.iter().filter(|result| result.used);
    let count = used().count();
    let mut residual_rms = Vector3::zeros();
    for result in used() {
        let residual = result.hold.mean - sensor.reading(&result.force_mps2);
        residual_rms += residual.component_mul(&residual) / count as f64;
    }
    let magnitude_rms = magnitude_rms(&results);
    let fit = without.as_ref().unwrap_or(&robust);
    let change = accelerometer_change::change(&results, fit, g.magnitude_mps2, drift.is_some());
    let degrees_of_freedom = robust.degrees_of_freedom;
    let fit = FitStatistics {
        chi2: robust.chi2,
        degrees_of_freedom,
        p_value: if robust.between_holds_sd > 0.0 {
            None
        } else {
            chi2_p_value(robust.chi2, degrees_of_freedom)
        },
        residual_rms: Some(residual_rms.map(f64::sqrt)),
        assumed_noise: problem.sensor.noise(&sensor.matrix.diagonal()),
        noise_estimate: Some(robust.within_sd),
        whiteness: Vec::new(),
    };
    let gains = Matrix3::from_diagonal(&sensor.matrix.diagonal());
    let nominal = problem.sensor.nominal().unwrap_or(SensorParameters::linear(sensor.bias, gains));
    let at_rest = AtRest {
        quantities: list.of_accelerometer(),
        parameters: list.describe_accelerometer(problem.sensor, &nominal),
        units: PerSensor::only(SensorKind::Accelerometer, problem.sensor.unit),
        imu: ImuParameters::identity().with(SensorKind::Accelerometer, sensor),
        uncertainty,
        fit,
        status: robust.status,
        iterations: robust.iterations,
        gradient_norm: robust.gradient_norm,
        holds: HoldCalibration {
            holds: results,
            gravity: g,
            gauge: setup.gauge,
            between_holds_sd_mps2: robust.between_holds_sd,
            between_holds_dominates: robust.between_holds_sd > 0.0,
            tilt: None,
            magnitude_residual_rms_mps2: magnitude_rms,
            degrees_of_freedom,
            condition_number: robust.condition_number,
            detected: setup.intervals_s.is_none(),
            before: Uncalibrated::accelerometer(problem.sensor, &sensor),
            temperatures_c: None,
            thermometer: None,
            drift: drift.map(Box::new),
            recording_biases: recording_biases.map(Box::new),
            change: change.map(Box::new),
        },
    };
    let mut calibration = Calibration { changes: change.into_iter().collect(), ..at_rest.calibration() };
    calibration.warnings = verdict::warnings(&calibration, &robust.weakest);
    calibration
}
