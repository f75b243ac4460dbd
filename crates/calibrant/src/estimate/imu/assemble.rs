//! Puts the result together.

use super::faces::First;
use super::joint::{Fit, Joint, Miss, State};
use super::readings::usable;
use super::solver::singular;
use super::verdict;
use super::weights::Weighed;
use super::{ImuCalibration, ImuProblem, RotationResult, StillGyroscope, TurnResult};
use crate::error::Result;
use crate::estimate::HoldCalibration;
use crate::estimate::gravity::gravity_slope;
use crate::information;
use crate::sensor::{ImuParameters, Recording};
use nalgebra::{DMatrix, Vector3};
use std::ops::Range;

/// Everything that the result is put together from.
pub(super) struct Finished<'a> {
    pub(super) joint: &'a Joint<'a>,
    pub(super) fit: &'a Fit,
    pub(super) weighed: &'a Weighed,
    pub(super) before: &'a ImuParameters,
    pub(super) between: Vector3<f64>,
    pub(super) spans: &'a [Range<usize>],
    pub(super) chosen: &'a [usize],
}

impl Finished<'_> {
    pub(super) fn assemble(
        &self,
        problem: &ImuProblem<'_>,
        holds: &HoldCalibration,
        gyroscope: &Recording,
        axes: Option<[String; 3]>,
        first: &First,
    ) -> Result<ImuCalibration> {
        let (joint, fit) = (self.joint, self.fit);
        let size = joint.quantities.len();
        let information = DMatrix::from_fn(size, size, |i, j| fit.information[(i, j)]);
        let mut covariance = information::covariance(&information).ok_or_else(singular)?;
        let prior_share = (0..size)
            .map(|k| {
                joint
                    .prior
                    .as_ref()
                    .map_or(0.0, |(_, weight)| (weight[k] * covariance[(k, k)]).clamp(0.0, 1.0))
            })
            .collect();
        let imu = fit.state.imu;
        let g = problem.setup.holds.gravity;
        // what gravity's own uncertainty adds
        let slope = gravity_slope(&joint.quantities, &imu, &g);
        covariance += &slope * slope.transpose() * (g.sd_mps2 * g.sd_mps2);
        let rotations = self.rotations(gyroscope);
        let counted = rotations.iter().filter(|rotation| rotation.used).count();
        let stills = joint.holds.iter().filter(|hold| hold.gyroscope.is_some()).count();
        let equations = 3 * joint.holds.len() + 3 * stills + 2 * counted + 3 * joint.turns.len();
        let unknowns = size + 2 * joint.holds.iter().filter(|hold| hold.known.is_none()).count();
        let mut holds = holds.clone();
        for (&j, force) in self.chosen.iter().zip(&fit.state.forces) {
            holds.holds[j].force_mps2 = *force;
        }
        let correction = imu.gyroscope.matrix.try_inverse().ok_or_else(singular)?;
        let turns = joint
            .turns
            .iter()
            .zip(&problem.setup.turns)
            .map(|(data, turn)| TurnResult {
                start_s: turn.start_s,
                end_s: turn.end_s,
                angle_rad: data.angle,
                measured_rad: correction * (data.integral - imu.gyroscope.bias * data.duration_s),
            })
            .collect();
        let mut calibration = ImuCalibration {
            status: fit.status,
            iterations: fit.iterations,
            gradient_norm: fit.gradient_norm,
            values: joint.quantities.iter().map(|quantity| quantity.of(&imu)).collect(),
            quantities: joint.quantities.clone(),
            covariance,
            prior_share,
            imu,
            accelerometer_unit: problem.accelerometer.unit,
            gyroscope_unit: problem.gyroscope.unit,
            chi2: fit.chi2,
            degrees_of_freedom: equations.saturating_sub(unknowns),
            holds,
            still: StillGyroscope { noise: joint.gyroscope_noise, between_holds_sd: self.between },
            rotations,
            rotation_excess_sd_rad: joint.excess_rad,
            turns,
            validations: Vec::new(),
            warnings: first.warnings.clone(),
        };
        calibration.warnings.extend(verdict::warnings(&calibration, axes.as_ref()));
        Ok(calibration)
    }

    fn rotations(&self, gyroscope: &Recording) -> Vec<RotationResult> {
        let joint = self.joint;
        let rate = gyroscope.rate_hz();
        let state = &self.fit.state;
        let angle = |miss: &Miss| miss.error.norm().min(1.0).asin();
        joint
            .rotations
            .iter()
            .zip(self.spans)
            .enumerate()
            .map(|(i, (data, span))| {
                let (from_hold, to_hold) = (self.chosen[i], self.chosen[i + 1]);
                let at = |imu: &ImuParameters| {
                    joint.miss(data, &State { imu: *imu, forces: state.forces.clone() })
                };
                let (after, before) =
                    if data.used { (at(&state.imu), at(self.before)) } else { (None, None) };
                let studentised = self.weighed.studentised.get(i).copied().unwrap_or(f64::INFINITY);
                let reason = match usable(gyroscope, span, rate) {
                    Err(reason) => Some(reason),
                    Ok(()) if !data.counts => Some(format!(
                        "it misses gravity by {:.2}°, {studentised:.1} standard deviations",
                        after.as_ref().map_or(0.0, &angle).to_degrees()
                    )),
                    Ok(()) => None,
                };
                RotationResult {
                    from_hold,
                    to_hold,
                    start_s: gyroscope.times_s[span.start],
                    end_s: gyroscope.times_s[span.end - 1],
                    path_rad: after.as_ref().map_or(0.0, |miss| miss.rotation.path_rad),
                    peak_radps: after.as_ref().map_or(0.0, |miss| miss.rotation.peak_radps),
                    error_rad: after.as_ref().map_or(0.0, &angle),
                    error_before_rad: before.as_ref().map_or(0.0, &angle),
                    studentised: if studentised.is_finite() { studentised } else { 0.0 },
                    used: data.used && data.counts,
                    reason,
                }
            })
            .collect()
    }
}
