//! What the Earth's turn about the vertical does to the g-sensitivity.
//!
//! At rest a gyroscope reads `b + Γ f + S (Ω sin φ/g) f + S ω_h`, with `f` the specific force, φ the latitude and `ω_h` the Earth's rate about the north: the rate about the vertical looks like a
//! g-sensitivity `S Ω sin φ/g`. At a known latitude it is part of the model. Otherwise `sin φ` is anything from −1 to 1: the rate about the vertical has the variance `Ω²/3`, and all entries of Γ
//! are off by it together. How the rest of the Earth's rate is found is told in `imu/earth.rs`.

use super::ImuCalibration;
use crate::motion::EARTH_RATE_RADPS;
use crate::sensor::{ImuParameters, ImuQuantity};
use nalgebra::DVector;

/// Standard deviation of each component of the Earth's rate at an unknown latitude, `Ω/√3`, rad/s.
pub(super) const UNKNOWN_SD_RADPS: f64 = EARTH_RATE_RADPS / 1.732_050_807_568_877_2;
/// Standard deviations that it makes larger by less need no word.
const SIZEABLE: f64 = 1.15;

/// Change of each estimate with a rate about the vertical that the model lacks, `S/g` of the g-sensitivity as far as the data tell it; `prior_share`: what of each was known beforehand.
pub(super) fn vertical_slope(
    quantities: &[ImuQuantity],
    prior_share: &[f64],
    imu: &ImuParameters,
    gravity_mps2: f64,
) -> DVector<f64> {
    let slope = |(quantity, known): (&ImuQuantity, &f64)| match quantity {
        ImuQuantity::GSensitivity(row, column) => {
            imu.gyroscope.matrix[(row.index(), column.index())] / gravity_mps2 * (1.0 - known)
        }
        _ => 0.0,
    };
    DVector::from_iterator(quantities.len(), quantities.iter().zip(prior_share).map(slope))
}

/// What to say where an unknown latitude is a sizeable part of the uncertainty.
pub(super) fn unknown_latitude(calibration: &ImuCalibration) -> Option<String> {
    let slope = calibration.of_vertical.as_ref()?;
    let larger = |(slope, variance): (&f64, &f64)| {
        let without = (variance - slope.powi(2)).max(f64::MIN_POSITIVE);
        (variance / without).sqrt()
    };
    let variances = calibration.covariance.diagonal();
    let all = slope.iter().zip(variances.iter()).map(larger);
    let (quantity, most) =
        calibration.quantities.iter().zip(all).max_by(|one, other| one.1.total_cmp(&other.1))?;
    let (like, of_what) = match quantity {
        ImuQuantity::GSensitivity(..) => ("looks like g-sensitivity", "the latter's"),
        _ => ("adds to turns of known angle", "the gyroscope's"),
    };
    (most > SIZEABLE).then(|| {
        format!(
            "the Earth turns about the vertical by {EARTH_RATE_RADPS:.2e} rad/s times the sine of the latitude, which {like}: not knowing it makes {of_what} standard deviations \
             up to {most:.1} times larger; give holds.latitude_deg"
        )
    })
}
