//! The effect of an unknown latitude on the uncertainty of a calibration.

use super::Calibration;
use crate::sensor::ImuQuantity;

/// Least increase of a standard deviation that is reported.
pub(super) const SIZEABLE: f64 = 1.15;

/// How much an unknown latitude adds to the standard deviations.
#[derive(Debug, Clone, PartialEq)]
pub struct UnknownLatitude {
    /// The parameter that is affected most.
    pub parameter: ImuQuantity,
    /// Its standard deviation over that at a known latitude.
    pub times: f64,
}

impl Calibration {
    /// The effect of an unknown latitude, where it is a sizeable part of the uncertainty. `None` at a known latitude, and without a gyroscope.
    #[must_use]
    pub fn unknown_latitude(&self) -> Option<UnknownLatitude> {
        let slope = self.gyroscope.as_ref()?.of_vertical.as_ref()?;
        let larger = |(slope, variance): (&f64, &f64)| {
            let without = (variance - slope.powi(2)).max(f64::MIN_POSITIVE);
            (variance / without).sqrt()
        };
        let variances = self.covariance.diagonal();
        let all = slope.iter().zip(variances.iter()).map(larger);
        let (parameter, times) =
            self.quantities.iter().zip(all).max_by(|one, other| one.1.total_cmp(&other.1))?;
        (times > SIZEABLE).then_some(UnknownLatitude { parameter: *parameter, times })
    }
}
