//! What an unknown latitude does to the uncertainty of a calibration.

use super::Calibration;
use crate::diagnostic::Diagnostic;
use crate::motion::EARTH_RATE_RADPS;
use crate::sensor::ImuQuantity;

/// Standard deviations that it makes larger by less need no word.
const SIZEABLE: f64 = 1.15;

/// What to say where an unknown latitude is a sizeable part of the uncertainty.
pub(super) fn unknown_latitude(calibration: &Calibration) -> Option<Diagnostic> {
    let slope = calibration.gyroscope.as_ref()?.of_vertical.as_ref()?;
    let larger = |(slope, variance): (&f64, &f64)| {
        let without = (variance - slope.powi(2)).max(f64::MIN_POSITIVE);
        (variance / without).sqrt()
    };
    let variances = calibration.covariance.diagonal();
    let all = slope.iter().zip(variances.iter()).map(larger);
    let (quantity, most) =
        calibration.quantities.iter().zip(all).max_by(|one, other| one.1.total_cmp(&other.1))?;
    let of_g_sensitivity = matches!(quantity, ImuQuantity::GSensitivity(..));
    let larger =
        Diagnostic::LatitudeUnknown { earth_rate_radps: EARTH_RATE_RADPS, of_g_sensitivity, times: most };
    (most > SIZEABLE).then_some(larger)
}
