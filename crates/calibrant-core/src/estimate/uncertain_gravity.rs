//! The part of a calibration's uncertainty that is gravity's: an error that all gains of the accelerometer share.

use super::Calibration;
use super::unknown_latitude::SIZEABLE;
use crate::motion::Gravity;
use crate::sensor::ImuQuantity;

/// How much the uncertainty of gravity adds to the standard deviations.
#[derive(Debug, Clone, PartialEq)]
pub struct UncertainGravity {
    /// Gravity, as it was assumed.
    pub gravity: Gravity,
    /// The parameter that is affected most.
    pub parameter: ImuQuantity,
    /// Its standard deviation.
    pub sd: f64,
    /// What its standard deviation would be with gravity known exactly.
    pub sd_without: f64,
}

impl Calibration {
    /// The effect of gravity's uncertainty, where it is a sizeable part of the uncertainty of a calibration from holds.
    #[must_use]
    pub fn uncertain_gravity(&self) -> Option<UncertainGravity> {
        let gravity = self.holds()?.gravity;
        let variances = self.covariance.diagonal();
        let effect = |k: usize| UncertainGravity {
            gravity,
            parameter: self.quantities[k],
            sd: variances[k].sqrt(),
            sd_without: (variances[k] - (self.gravity_slope[k] * gravity.sd_mps2).powi(2))
                .max(f64::MIN_POSITIVE)
                .sqrt(),
        };
        let times = |of: &UncertainGravity| of.sd / of.sd_without;
        (0..self.gravity_slope.len())
            .map(effect)
            .max_by(|one, other| times(one).total_cmp(&times(other)))
            .filter(|most| times(most) > SIZEABLE)
    }
}
