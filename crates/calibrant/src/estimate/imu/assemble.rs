//! Puts the result together.

use super::faces::First;
use super::joint::{Fit, Joint, Miss, State};
use super::readings::Integrable;
use super::solver::singular;
use super::thermal::Climate;
use super::verdict;
use super::weights::Weighed;
use super::{ImuCalibration, ImuProblem, RotationResult, StillGyroscope, TurnResult};
use crate::error::Result;
use crate::estimate::HoldCalibration;
use crate::information;
use crate::sensor::{ImuParameters, ImuQuantity, Quantity, Recording, Triad};
use nalgebra::{DVector, Vector3};
use std::ops::Range;

/// Everything that the result is put together from.
pub(super) struct Finished<'a> {
    pub(super) joint: &'a Joint<'a>,
    pub(super) fit: &'a Fit,
    pub(super) weighed: &'a Weighed,
    pub(super) before: &'a ImuParameters,
    pub(super) between: Vector3<f64>,
    pub(super) integrable: &'a Integrable<'a>,
    pub(super) spans: &'a [Range<usize>],
    pub(super) chosen: &'a [usize],
    pub(super) climate: &'a Climate<'a>,
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
        let mut covariance = information::covariance(&fit.information).ok_or_else(singular)?;
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
        // what gravity's own uncertainty adds: it is a common factor of the accelerometer's matrix and of the g-sensitivity
        let slope = DVector::from_iterator(
            size,
            joint.quantities.iter().map(|quantity| match quantity {
                ImuQuantity::Of(Triad::Accelerometer, Quantity::Bias(_))
                | ImuQuantity::Of(Triad::Gyroscope, _)
                | ImuQuantity::Thermal(..) => 0.0,
                _ => -quantity.of(&imu) / g.magnitude_mps2,
            }),
        );
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
        let turns = joint
            .turns
            .iter()
            .zip(&problem.setup.turns)
            .map(|(data, turn)| {
                let there = imu.at(data.temperature_c).gyroscope;
                let correction = there.matrix.try_inverse().ok_or_else(singular)?;
                Ok(TurnResult {
                    start_s: turn.start_s,
                    end_s: turn.end_s,
                    angle_rad: data.angle,
                    measured_rad: correction * (data.integral - there.bias * data.duration_s),
                })
            })
            .collect::<Result<_>>()?;
        let follows = !problem.setup.thermal.is_none();
        let hold_temperatures_c =
            follows.then(|| holds.holds.iter().map(|hold| self.climate.of_hold(&hold.hold)).collect());
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
            hold_temperatures_c,
            warnings: first.warnings.clone(),
        };
        calibration.warnings.extend(verdict::warnings(&calibration, axes.as_ref()));
        calibration.warnings.extend(verdict::extrapolation(&imu.thermal, self.climate.of_recording()));
        Ok(calibration)
    }

    fn rotations(&self, gyroscope: &Recording) -> Vec<RotationResult> {
        let joint = self.joint;
        let with_before = State { imu: *self.before, forces: self.fit.state.forces.clone() };
        let angle = |miss: &Miss| miss.error.norm().min(1.0).asin();
        joint
            .rotations
            .iter()
            .zip(self.spans)
            .enumerate()
            .map(|(i, (data, span))| {
                let (from_hold, to_hold) = (self.chosen[i], self.chosen[i + 1]);
                let after = self.fit.misses[i].as_ref();
                let before = after.and_then(|_| joint.miss(data, &with_before));
                let studentised = self.weighed.studentised.get(i).copied().unwrap_or(f64::INFINITY);
                let reason = match self.integrable.obstacle(span) {
                    Some(obstacle) => Some(obstacle),
                    None if !data.counts => Some(format!(
                        "it misses gravity by {:.2}°, {studentised:.1} standard deviations",
                        after.map_or(0.0, &angle).to_degrees()
                    )),
                    None => None,
                };
                RotationResult {
                    from_hold,
                    to_hold,
                    start_s: gyroscope.times_s[span.start],
                    end_s: gyroscope.times_s[span.end - 1],
                    path_rad: after.map_or(0.0, |miss| miss.rotation.path_rad),
                    peak_radps: after.map_or(0.0, |miss| miss.rotation.peak_radps),
                    error_rad: after.map_or(0.0, &angle),
                    error_before_rad: before.as_ref().map_or(0.0, &angle),
                    studentised: if studentised.is_finite() { studentised } else { 0.0 },
                    used: data.used && data.counts,
                    reason,
                }
            })
            .collect()
    }
}
