//! The arm's limits (`[limits]`): acceleration, jerk, velocity, displacement and rest. Plain data, per axis.

use crate::json::if_some;
use crate::json_object;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where the arm is at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Rest {
    /// No rest is prescribed.
    #[default]
    None,
    /// At the start.
    Start,
    /// At the start and at the end.
    Both,
}

/// Symmetric limits per axis. `None`: no limit.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Limits {
    /// Largest acceleration, m/s².
    pub acceleration_mps2: Option<Vector3<f64>>,
    /// Largest jerk, m/s³.
    pub jerk_mps3: Option<Vector3<f64>>,
    /// Largest intercept of an interval's line at t = 0 (the thesis's bound on x), m/s².
    pub intercept_mps2: Option<Vector3<f64>>,
    /// Largest velocity, m/s.
    pub velocity_mps: Option<Vector3<f64>>,
    /// Largest displacement, m.
    pub displacement_m: Option<Vector3<f64>>,
    /// Where the velocity is zero.
    pub rest: Rest,
    /// Prescribed acceleration at the start, m/s².
    pub start_acceleration_mps2: Option<Vector3<f64>>,
    /// Prescribed acceleration at the end, m/s².
    pub end_acceleration_mps2: Option<Vector3<f64>>,
}

json_object! {
    /// Symmetric limits for each axis; what is not there has none.
    Limits as of {
        acceleration_mps2: if_some(of.acceleration_mps2.map(<[f64; 3]>::from)),
        jerk_mps3: if_some(of.jerk_mps3.map(<[f64; 3]>::from)),
        /// Of an interval's line at t = 0.
        intercept_mps2: if_some(of.intercept_mps2.map(<[f64; 3]>::from)),
        velocity_mps: if_some(of.velocity_mps.map(<[f64; 3]>::from)),
        displacement_m: if_some(of.displacement_m.map(<[f64; 3]>::from)),
        rest: of.rest,
        /// Prescribed.
        start_acceleration_mps2: if_some(of.start_acceleration_mps2.map(<[f64; 3]>::from)),
        /// Prescribed.
        end_acceleration_mps2: if_some(of.end_acceleration_mps2.map(<[f64; 3]>::from)),
    }
}

impl Limits {
    /// The same limits, with accelerations that a sensor of this range can report.
    #[must_use]
    pub fn within_range(&self, range_mps2: Option<Vector3<f64>>) -> Self {
        let acceleration_mps2 = match (self.acceleration_mps2, range_mps2) {
            (Some(arm), Some(range)) => Some(arm.zip_map(&range, f64::min)),
            (arm, range) => arm.or(range),
        };
        Self { acceleration_mps2, ..self.clone() }
    }

    /// The limits of one axis, 0 to 2.
    #[must_use]
    pub fn axis(&self, k: usize) -> AxisLimits {
        let of = |limit: &Option<Vector3<f64>>| limit.map(|limit| limit[k]);
        AxisLimits {
            acceleration: of(&self.acceleration_mps2),
            jerk: of(&self.jerk_mps3),
            intercept: of(&self.intercept_mps2),
            velocity: of(&self.velocity_mps),
            displacement: of(&self.displacement_m),
            rest: self.rest,
            start: of(&self.start_acceleration_mps2),
            end: of(&self.end_acceleration_mps2),
        }
    }
}

/// The limits of one axis, SI; they hold at all times. Velocity and displacement count from rest at the
/// origin.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxisLimits {
    /// Largest acceleration.
    pub acceleration: Option<f64>,
    /// Largest jerk.
    pub jerk: Option<f64>,
    /// Largest intercept of an interval's line at t = 0.
    pub intercept: Option<f64>,
    /// Largest velocity.
    pub velocity: Option<f64>,
    /// Largest displacement.
    pub displacement: Option<f64>,
    /// Where the velocity is zero; the start always is.
    pub rest: Rest,
    /// Prescribed acceleration at the start.
    pub start: Option<f64>,
    /// Prescribed acceleration at the end.
    pub end: Option<f64>,
}
