//! Makes the problem of the best poses that an experiment file describes.

use super::holds::HoldsPlan;
use super::{Experiment, Plan};
use crate::EarlierCalibration;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::simulation::NoiseAssumed;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::estimate::{Calibration, FaceTilt};
use calibrant_core::sensor::{ParameterList, SensorKind, SensorParameters, USUAL_NOISE_MPS2};
use calibrant_design::poses::{DirectionKnowledge, PoseNuisance, PoseProblem};
use nalgebra::Vector3;

impl Experiment {
    /// The problem of the best poses of a `[holds]` experiment, with the information of earlier calibrations,
    /// which adds up. `poses`: their number in place of `holds.poses`.
    ///
    /// The mean of a hold has the variance of its white noise and that between holds. The noise is that of
    /// `[sensor]`, or the last earlier one where that states none. The scatter between holds is that of
    /// `[holds]`, or of an earlier calibration where that is larger.
    ///
    /// # Errors
    /// [`Error::Experiment`] without `[holds]`, or as [`design_problem`](Self::design_problem).
    pub fn pose_problem(&self, earlier: &[EarlierCalibration], poses: Option<usize>) -> Result<PoseProblem> {
        let plan = self.holds()?;
        let list = self.pose_parameters(plan, self.design.knows_directions());
        let (at, prior) = self.known_before(&list, earlier)?;
        let directions = if self.design.knows_directions() {
            DirectionKnowledge::Known { sd_rad: plan.face_sd_rad().unwrap_or(FaceTilt::ASSUMED_RAD) }
        } else {
            DirectionKnowledge::Unknown
        };
        let problem = PoseProblem {
            criterion: self.criterion(&list, &at)?,
            mean_sd: self.mean_sd(plan, &at, earlier),
            nuisance: self.nuisance(plan, &at, self.design.knows_directions())?,
            list,
            at,
            gravity_mps2: plan.gravity()?.magnitude_mps2,
            directions,
            allowed: self.design.allowed_directions()?,
            prior,
            poses: poses.unwrap_or(plan.poses),
        };
        // earlier calibrations assumed the same gravity, so its error does not average out
        Ok(if earlier.is_empty() { problem } else { problem.with_gravity_out_of_prior() })
    }

    /// The problem whose poses are the holds that this calibration used, and their directions in order of time:
    /// with what it found of the sensor, of its noise and of the face alignment.
    ///
    /// # Errors
    /// As [`pose_problem`](Self::pose_problem).
    pub fn recorded_poses(&self, calibration: &Calibration) -> Result<(PoseProblem, Vec<Vector3<f64>>)> {
        let plan = self.holds()?;
        let Some(holds) = calibration.holds() else { return Err(self.without_holds()) };
        let directions: Vec<Vector3<f64>> = holds.used().map(|hold| hold.force_mps2.normalize()).collect();
        let at = calibration.imu[SensorKind::Accelerometer];
        let count = directions.len().max(1) as f64;
        let white: Vector3<f64> = holds
            .used()
            .map(|result| result.hold.sd.component_mul(&result.hold.sd) / result.hold.samples() as f64)
            .sum();
        let mean_sd = Vector3::from_fn(|axis, _| {
            let between = holds.between_holds_sd_mps2 * at.matrix.row(axis).norm();
            (white[axis] / count).sqrt().hypot(between)
        });
        let known = holds.tilt.map(|tilt| DirectionKnowledge::Known { sd_rad: tilt.sd_rad });
        let list = self.pose_parameters(plan, known.is_some());
        let problem = PoseProblem {
            criterion: self.criterion(&list, &at)?,
            mean_sd,
            nuisance: self.nuisance(plan, &at, known.is_some())?,
            list,
            at,
            gravity_mps2: plan.gravity()?.magnitude_mps2,
            directions: known.unwrap_or(DirectionKnowledge::Unknown),
            allowed: self.design.allowed_directions()?,
            prior: None,
            poses: directions.len(),
        };
        Ok((problem, directions))
    }

    /// The note that a usual noise stands in for that of the accelerometer, in a `[holds]` experiment that states none.
    #[must_use]
    pub fn assumed_noise(&self, earlier: &[EarlierCalibration]) -> Option<Diagnostic> {
        let Plan::Holds(plan) = &self.plan else { return None };
        // a campaign has a scatter of blocks in its place
        if self.campaign.is_some() {
            return None;
        }
        let is_found = between_mps2(plan, earlier) > 0.0 || noise_found(earlier).is_some();
        let is_assumed = !is_found && self.sensor.with_usual_noise().is_some();
        is_assumed.then(|| NoiseAssumed { noise_mps2: USUAL_NOISE_MPS2 }.into())
    }

    fn holds(&self) -> Result<&HoldsPlan> {
        match &self.plan {
            Plan::Holds(plan) => Ok(plan),
            _ => Err(self.without_holds()),
        }
    }

    fn without_holds(&self) -> Error {
        let message = format!("poses need a [holds] experiment, this one has {}", self.plan.section());
        let help = "see `calibrant init static-poses`";
        Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, help))
    }

    /// The parameters that a calibration from poses estimates: those of the gauge, or all where the directions
    /// of the holds are known.
    fn pose_parameters(&self, plan: &HoldsPlan, known: bool) -> ParameterList {
        plan.parameter_list(self.sensor.model, known)
    }

    /// A calibration of an accelerometer alone in known directions allows for no drift.
    fn nuisance(&self, plan: &HoldsPlan, at: &SensorParameters, known: bool) -> Result<PoseNuisance> {
        let has_drift = !known || self.imu.is_some();
        let gain = |axis: usize| if has_drift { at.matrix.row(axis).norm() } else { 0.0 };
        Ok(PoseNuisance {
            gravity_sd_mps2: plan.gravity()?.sd_mps2,
            drift_sd: Vector3::from_fn(|axis, _| plan.bias_drift_sd_mps2 * gain(axis)),
            has_gyroscope: self.imu.is_some(),
        })
    }

    /// Standard deviation of the mean reading of a hold. Where neither noise nor scatter is known, a usual noise stands in.
    fn mean_sd(
        &self,
        plan: &HoldsPlan,
        at: &SensorParameters,
        earlier: &[EarlierCalibration],
    ) -> Vector3<f64> {
        let (gain, between_mps2) = (at.matrix.diagonal(), between_mps2(plan, earlier));
        let usual = || self.sensor.with_usual_noise().filter(|_| between_mps2 == 0.0)?.noise(&gain);
        let stated = self.sensor.noise(&gain).or_else(|| noise_found(earlier));
        let samples = (plan.hold_s * plan.rate_hz).max(1.0);
        let white = stated.or_else(usual).unwrap_or_else(Vector3::zeros) / samples.sqrt();
        white.zip_map(&gain, |white, gain| white.hypot(between_mps2 * gain))
    }
}

/// The noise of one sample in the last earlier calibration that had holds, in the unit of the readings.
fn noise_found(earlier: &[EarlierCalibration]) -> Option<Vector3<f64>> {
    earlier.iter().rev().find_map(|earlier| earlier.noise)
}

/// Scatter of the holds beyond their noise: that of `[holds]`, or of an earlier calibration where that is larger, m/s².
fn between_mps2(plan: &HoldsPlan, earlier: &[EarlierCalibration]) -> f64 {
    let found = earlier.iter().filter_map(|earlier| earlier.between_holds_sd_mps2);
    found.fold(plan.between_holds_sd_mps2, f64::max)
}
