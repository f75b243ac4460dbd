//! The effect of the Earth's rate about the vertical on the g-sensitivity.
//!
//! At rest a gyroscope reads `b + Γ f + S (Ω sin φ/g) f + S ω_h`, with `f` the specific force, φ the latitude and `ω_h` the Earth's rate about the north.
//! So the rate about the vertical looks like a g-sensitivity `S Ω sin φ/g`. At a known latitude it is part of the model. Otherwise `sin φ` is anything
//! from −1 to 1. The rate about the vertical then has the variance `Ω²/3`, a common error of all entries of Γ. `imu/earth_rate.rs` estimates the rest of the Earth's rate.

use crate::motion::EARTH_RATE_RADPS;
use crate::sensor::{ImuParameters, ImuQuantity, SensorKind};
use nalgebra::DVector;

/// Standard deviation of each component of the Earth's rate at an unknown latitude, `Ω/√3`, rad/s.
pub(super) const UNKNOWN_SD_RADPS: f64 = EARTH_RATE_RADPS / 1.732_050_807_568_877_2;
/// Derivative of each estimate with respect to a rate about the vertical that the model lacks: `S/g` for the g-sensitivity.
///
/// `prior_share`: the share of each quantity's information that comes from the prior. This part does not follow the rate.
pub(super) fn vertical_slope(
    quantities: &[ImuQuantity],
    prior_share: &[f64],
    imu: &ImuParameters,
    gravity_mps2: f64,
) -> DVector<f64> {
    let slope = |(quantity, known): (&ImuQuantity, &f64)| match quantity {
        ImuQuantity::GSensitivity(row, column) => {
            imu[SensorKind::Gyroscope].matrix[(row.index(), column.index())] / gravity_mps2 * (1.0 - known)
        }
        _ => 0.0,
    };
    DVector::from_iterator(quantities.len(), quantities.iter().zip(prior_share).map(slope))
}
