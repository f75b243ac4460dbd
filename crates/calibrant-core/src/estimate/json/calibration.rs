//! A calibration as JSON: how the estimate ended, the calibrated IMU, and what was recovered beside its parameters.

use super::budget::Budget;
use super::fit::FitInUnit;
use super::gyroscope::{RotationsOf, StillOf};
use super::holds::HoldsOf;
use super::motion::MotionOf;
use crate::estimate::{Calibration, Recovered};
use crate::form::Form;
use crate::json::{flat, if_any, if_some};
use crate::json_object;
use crate::sensor::{ImuFields, ParameterKnowledge, SensorKind};

json_object! {
    /// A calibration of an accelerometer or of an IMU.
    Calibration as of {
        /// How the iteration ended.
        status: of.status,
        /// Number of iterations.
        iterations: of.iterations,
        /// Length of the remaining step, in standard deviations.
        gradient_norm: of.gradient_norm,
        /// `datasheet`, if that is a prior of the accelerometer.
        prior: if_some(of.datasheet_prior.then_some("datasheet")),
        imu: flat(ImuFields { imu: of.calibrated(), axes: of.axes(), knowledge: of.knowledge() }),
        /// The covariance with a diagonal of ones.
        correlation: Form::<Vec<Vec<f64>>>::form(&of.correlation()),
        /// Where the variance of each parameter comes from, by hand.
        budget: if_some(of.budget_by_hand()),
        fit: FitInUnit { fit: &of.fit, unit: of.unit(SensorKind::Accelerometer), axes: of.axes() },
        /// The motion, if the calibration is one of a commanded motion.
        motion: if_some(of.motion()),
        /// The holds, if it is one of holds.
        holds: if_some(of.holds_in_unit()),
        /// The temperature over the holds, where the recording has one.
        soak: if_some(of.soak),
        /// What other soaks say of the parameters, on which the estimates rest.
        soak_prior: if_any(of.soak_prior.clone()),
        still_gyroscope: if_some(of.gyroscope.as_deref().map(StillOf)),
        rotations: if_some(of.gyroscope.as_deref().map(|gyroscope| RotationsOf { calibration: of, gyroscope })),
        /// The turns of known angle.
        turns: if_any(of.turns()),
    }
}

impl Calibration {
    fn knowledge(&self) -> Vec<ParameterKnowledge> {
        let known = self.parameters.iter().enumerate().map(|(k, parameter)| ParameterKnowledge {
            nominal: parameter.nominal,
            spread_sd: parameter.spread,
            prior_share: self.prior_share.get(k).copied(),
        });
        known.collect()
    }

    /// That of a machine is in its own section.
    fn budget_by_hand(&self) -> Option<Budget> {
        self.holds().map(|_| Budget::of(&self.budget, &self.variance_sources()))
    }

    fn motion(&self) -> Option<MotionOf<'_>> {
        match &self.recovered {
            Recovered::Motion(recovered) => Some(MotionOf { recovered, axes: self.axes() }),
            Recovered::Holds(_) | Recovered::OnMachine(_) => None,
        }
    }

    fn holds_in_unit(&self) -> Option<HoldsOf<'_>> {
        let latitude_deg = self.gyroscope.as_deref().and_then(|gyroscope| gyroscope.latitude_deg);
        self.holds().map(|holds| HoldsOf { holds, unit: self.unit(SensorKind::Accelerometer), latitude_deg })
    }
}
