//! The noise of one sample from a datasheet: its density, and the bandwidth in which the sensor has it.

use super::refused_key::{missing, refused};
use calibrant_core::error::Result;
use nalgebra::Vector3;

/// m/s² in one µg.
pub(super) const MPS2_PER_UG: f64 = 9.80665e-6;
/// rad/s in one mdps.
pub(super) const RADPS_PER_MDPS: f64 = 1e-3 * std::f64::consts::PI / 180.0;

/// The standard deviation of a sample, `n √B`, of each axis: `n` is the density of the one-sided spectrum, as datasheets have it, and `B` the bandwidth of the noise.
/// Both stand with their keys; `unit` is that of the density, in the unit of the result. `others` say the noise as well, where they are there.
pub(super) fn of_sample(
    (key, density): (&str, Option<Vector3<f64>>),
    (bandwidth_key, bandwidth_hz): (&str, Option<f64>),
    unit: f64,
    others: &[(&str, bool)],
) -> Result<Option<Vector3<f64>>> {
    let other = others.iter().find(|(_, is_there)| *is_there);
    match (density, bandwidth_hz, other) {
        (None, None, _) => Ok(None),
        (None, Some(_), _) => Err(missing(key, "noise_bandwidth_hz is that of a noise density")),
        (Some(_), _, Some((other, _))) => {
            Err(refused(key, format!("`{other}` gives the noise already"), "keep one of the two"))
        }
        (Some(_), None, None) => Err(missing(
            bandwidth_key,
            "noise_bandwidth_hz = 50.0, half of the sample rate of a sensor without a filter; 1.57 times the −3 dB frequency of a filter of first order",
        )),
        (Some(density), Some(bandwidth_hz), None) => Ok(Some(density * unit * bandwidth_hz.sqrt())),
    }
}
