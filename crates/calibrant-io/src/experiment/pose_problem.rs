//! Makes the problem of the best poses that an experiment file describes.

use super::holds::HoldsPlan;
use super::{Experiment, Plan};
use crate::EarlierCalibration;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{ParameterList, SensorParameters};
use calibrant_design::poses::{DirectionKnowledge, PoseProblem};
use nalgebra::Vector3;

impl Experiment {
    /// The parameters that a calibration from poses estimates: those of the gauge, or all where the directions
    /// of the holds are known.
    #[must_use]
    pub fn pose_parameters(&self, plan: &HoldsPlan) -> ParameterList {
        if self.design.poses.known {
            self.sensor.parameter_list()
        } else {
            plan.gauge.parameter_list(self.sensor.model)
        }
    }

    /// The problem of the best poses of a `[holds]` experiment, with the information of earlier calibrations,
    /// which adds up. `poses`: their number in place of `holds.poses`.
    ///
    /// The mean of a hold has the variance of its white noise, and that between holds.
    ///
    /// # Errors
    /// [`Error::Experiment`] without `[holds]`, with no noise at all, or as
    /// [`design_problem`](Self::design_problem).
    pub fn pose_problem(&self, earlier: &[EarlierCalibration], poses: Option<usize>) -> Result<PoseProblem> {
        let Plan::Holds(plan) = &self.plan else {
            let message = format!("poses need a [holds] experiment, this one has {}", self.plan.section());
            let help = "see `calibrant init static-poses`";
            return Err(Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, help)));
        };
        let list = self.pose_parameters(plan);
        let (at, prior) = self.known_before(&list, earlier)?;
        let sd_rad = plan.face_sd_rad.unwrap_or(0.0);
        Ok(PoseProblem {
            criterion: self.criterion(&list, &at)?,
            mean_sd: self.mean_sd(plan, &at)?,
            list,
            at,
            gravity_mps2: plan.gravity.magnitude_mps2,
            directions: if self.design.poses.known {
                DirectionKnowledge::Known { sd_rad }
            } else {
                DirectionKnowledge::Unknown
            },
            allowed: self.design.poses.allowed.clone(),
            prior,
            poses: poses.unwrap_or(plan.poses),
        })
    }

    /// Standard deviation of the mean reading of a hold.
    fn mean_sd(&self, plan: &HoldsPlan, at: &SensorParameters) -> Result<Vector3<f64>> {
        let gain = at.matrix.diagonal();
        let samples = (plan.hold_s * plan.rate_hz).max(1.0);
        let white = self.sensor.noise(&gain).unwrap_or_else(Vector3::zeros) / samples.sqrt();
        let sd = white.zip_map(&gain, |white, gain| white.hypot(plan.between_holds_sd_mps2 * gain));
        if sd.amin() > 0.0 {
            return Ok(sd);
        }
        let input_error = InputError::new(
            Refusal::KeyMissing,
            "the noise of a hold is not known, so its information is not",
            "give sensor.noise_mps2 (or noise_counts), or holds.between_holds_sd_mps2",
        );
        Err(Error::experiment(input_error.about_key("sensor.noise_mps2")))
    }
}
