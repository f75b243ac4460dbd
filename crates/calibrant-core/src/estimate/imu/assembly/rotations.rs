//! The rotations in the result.

use crate::diagnostic::RotationReason;
use crate::estimate::imu::least_squares::angular_rate::Path;
use crate::estimate::imu::model::{GravityResidual, ImuModel, LocalBias, State};
use crate::estimate::imu::result::RotationResult;
use crate::estimate::imu::rotations::movement::Movement;
use crate::estimate::imu::variance_components::solution::Solution;
use crate::sensor::ImuParameters;
use rayon::prelude::*;

/// Each rotation at a solution. `before`: the IMU before its calibration. `numbers`: those of the holds.
pub(crate) fn rotation_results(
    model: &ImuModel<'_>,
    solution: &Solution,
    movement: &Movement<'_>,
    before: &ImuParameters,
    numbers: &[usize],
) -> Vec<RotationResult> {
    let fit = &solution.fit;
    let with_before = State { imu: *before, forces: fit.state.forces.clone() };
    let angle = |residual: &GravityResidual| residual.error.norm();
    model
        .rotations
        .par_iter()
        .zip(&movement.spans)
        .enumerate()
        .filter(|(_, (_, span))| !span.is_between_recordings)
        .map(|(i, (data, span))| {
            let (from_hold, to_hold) = (numbers[i], numbers[i + 1]);
            let after = fit.residuals[i].as_ref();
            // one bias throughout
            let mut plain = data.clone();
            plain.samples.drift = plain.samples.drift.map(|end| LocalBias::none(end.temperature_c));
            let before = after.and_then(|_| model.gravity_residual(&plain, &with_before));
            let studentised = solution.weighed.studentised.get(i).copied().unwrap_or(f64::INFINITY);
            let reason = match movement.integrable.obstacle(span) {
                Some(obstacle) => Some(obstacle),
                None if !data.counts => Some(RotationReason::GravityMissed {
                    error_rad: after.map_or(0.0, &angle),
                    deviations: studentised,
                }),
                None => None,
            };
            let path = after.map_or_else(Path::default, |_| data.samples.path(&fit.state.imu));
            RotationResult {
                from_hold,
                to_hold,
                start_s: span.start_s,
                end_s: span.end_s,
                path_rad: path.length_rad,
                peak_radps: path.peak_radps,
                error_rad: after.map_or(0.0, &angle),
                error_before_rad: before.as_ref().map_or(0.0, &angle),
                studentised: if studentised.is_finite() { studentised } else { 0.0 },
                used: data.used && data.counts,
                reason,
            }
        })
        .collect()
}
