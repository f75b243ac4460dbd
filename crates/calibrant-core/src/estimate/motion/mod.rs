//! Calibration from a commanded motion: the chain problem for each axis (scale-bias) or for all at once (full).
//!
//! With a diagonal `S` the axes are independent, and the scale-bias model is three chains of scalars. The full model is one chain of 3×3
//! blocks. The result is assembled from [`Solved`] chains. The [`clock`] of the recording is estimated about them. Where the fit is bad, [`changed_half_way`] looks for the reason. Where gravity is given, the chains solve for the reading at rest, from which [`gravity`]
//! makes biases.

mod chain;
mod changed_half_way;
mod clock;
mod clock_equations;
mod context;
mod contradicted_gravity;
mod fit;
mod gravity;
mod interval_moments;
mod sample_pairs;
mod solution;
mod undetermined;
mod verdict;
mod whiteness;

use super::{
    Calibration, CalibrationProblem, CalibrationSettings, CalibrationStatus, FitStatistics, Recovered,
    RecoveredClock, RecoveredGravity, RecoveredMotion,
};
use crate::error::{Error, InputError, Refusal, Result};
use crate::motion::{CommandedMotion, JerkControlledMotion, Trust};
use crate::sensor::{Axis, ImuParameters, PerSensor, SensorKind, SensorParameters};
use crate::solve::chi2_p_value;
use chain::Solved;
use context::Context;
use nalgebra::{DMatrix, Matrix3, Vector3};
use solution::solve_at;

/// Calibrates from a motion.
pub(super) fn calibrate(
    problem: &CalibrationProblem<'_>,
    command: &CommandedMotion,
    settings: &CalibrationSettings,
) -> Result<Calibration> {
    let (clock, used, is_found) = clock::find(problem, command, settings)?;
    let (recording, given) = (clock.on_motion_clock(problem.recording), problem);
    let problem = CalibrationProblem { recording: &recording, ..*problem };
    let first = used.start;
    let context = Context::new(&problem, command, settings, used)?;
    let mut solved = solve_at(&context)?;
    if !is_found {
        solved.status = CalibrationStatus::Stalled;
    }
    let delayed = clock::delayed(&solved, &clock);
    clock::marginalise(&mut solved, &clock);
    let gravity = command.gravity.map(|gravity| gravity::take_out(&context, &gravity, &mut solved));
    let mut calibration = assemble(&context, solved, (gravity, clock), first)?;
    calibration.warnings.extend(delayed);
    if calibration.warnings.iter().any(verdict::is_of_another_motion) {
        calibration.warnings.splice(0..0, changed_half_way::check(given, command, settings));
    }
    Ok(calibration)
}

/// Assembles the result: residuals, statistics, warnings.
fn assemble(
    context: &Context<'_>,
    solved: Solved,
    (gravity, clock): (Option<RecoveredGravity>, RecoveredClock),
    first_sample: usize,
) -> Result<Calibration> {
    let problem = context.problem;
    let list = problem.sensor.parameter_list();
    // axes that the sensor does not have count as perfect
    let absent = Vector3::from_fn(|k, _| if k < problem.sensor.axes { 0.0 } else { 1.0 });
    let mut sensor = SensorParameters::linear(Vector3::zeros(), Matrix3::from_diagonal(&absent));
    for (quantity, value) in list.quantities().iter().zip(&solved.values) {
        quantity.add_to(&mut sensor, *value);
    }
    let bias = solved.bias;
    let motion =
        JerkControlledMotion::new(context.command.motion.times_s().to_vec(), solved.nodes).map_err(|_| {
            Error::recording(InputError::new(
                Refusal::FitFailed,
                "the estimated motion is not finite",
                "check the recording's unit",
            ))
        })?;
    let at_rest = gravity.map_or_else(Vector3::zeros, |gravity| gravity.force_mps2());
    let fitted: Vec<_> = motion.acceleration_mps2().iter().map(|a| sensor.reading(&(a + at_rest))).collect();
    let mut residuals = Vec::with_capacity(context.readings.len());
    for i in 0..context.positions.intervals() {
        let samples = context.positions.interval_samples(i);
        let lambda = &context.positions.lambda[samples.clone()];
        residuals.extend(
            lambda
                .iter()
                .zip(&context.readings[samples])
                .map(|(l, y)| y - (fitted[i] * (1.0 - l) + fitted[i + 1] * *l)),
        );
    }
    let samples = residuals.len() as f64;
    let mut fit = FitStatistics {
        chi2: solved.chi2,
        degrees_of_freedom: solved.degrees_of_freedom,
        p_value: chi2_p_value(solved.chi2, solved.degrees_of_freedom),
        residual_rms: None,
        assumed_noise: Some(context.noise),
        noise_estimate: None,
        whiteness: Vec::new(),
    };
    let (mut residual_rms, mut noise_estimate) = (Vector3::zeros(), Vector3::zeros());
    for &axis in problem.sensor.active_axes() {
        let k = axis.index();
        let own: Vec<f64> = residuals.iter().map(|r| r[k]).collect();
        let squares = whiteness::dot(&own, &own);
        residual_rms[k] = (squares / samples).sqrt();
        let left = samples - solved.leverage[k];
        noise_estimate[k] = if left > 0.5 { (squares / left).sqrt() } else { f64::NAN };
        let shortfall: Vec<f64> = solved.shortfall.iter().map(|c| c[k]).collect();
        fit.whiteness.extend(whiteness::ljung_box(&own, &shortfall, solved.leverage[k]));
    }
    fit.residual_rms = Some(residual_rms);
    if noise_estimate.iter().all(|noise| noise.is_finite()) {
        fit.noise_estimate = Some(noise_estimate);
    }
    let nominal = problem.sensor.nominal().unwrap_or_else(|| nominal_from_data(&sensor));
    let mut calibration = Calibration {
        status: solved.status,
        iterations: solved.iterations,
        gradient_norm: solved.gradient_norm,
        quantities: list.of_accelerometer(),
        parameters: list.describe_accelerometer(problem.sensor, &nominal),
        values: solved.values,
        covariance: solved.covariance,
        budget: Vec::new(),
        prior_share: Vec::new(),
        gravity_slope: Vec::new(),
        datasheet_prior: context.settings.datasheet_prior,
        imu: ImuParameters::identity().with(SensorKind::Accelerometer, sensor),
        units: PerSensor::only(SensorKind::Accelerometer, problem.sensor.unit),
        counts_per_unit: PerSensor::default(),
        fit,
        recovered: Recovered::Motion(RecoveredMotion {
            motion,
            acceleration_sd_mps2: solved.node_sd,
            trust: context.command.trust.name(),
            gravity,
            clock,
            residuals,
            first_sample,
        }),
        gyroscope: None,
        soak: None,
        soak_prior: Vec::new(),
        changes: Vec::new(),
        warnings: Vec::new(),
    };
    verdict::respond(context, &calibration)?;
    contradicted_gravity::check(context, &calibration)?;
    calibration.warnings = verdict::warnings(context, &calibration, &bias);
    Ok(calibration)
}

/// Nominal values for a sensor whose gain and offset are not known: those of the data, without cross-axis terms.
fn nominal_from_data(sensor: &SensorParameters) -> SensorParameters {
    SensorParameters { matrix: Matrix3::from_diagonal(&sensor.matrix.diagonal()), ..*sensor }
}
