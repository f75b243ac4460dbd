//! The temperature model in words.

use crate::number_format;
use calibrant_core::estimate::Calibration;

/// The reference temperature, the polynomials and the temperatures of the holds; `None` without temperature terms.
pub(super) fn temperature_in_words(calibration: &Calibration) -> Option<String> {
    calibration.holds()?.temperatures_c.as_ref()?;
    let thermal = &calibration.imu.thermal;
    let celsius = |t: f64| number_format::significant(t, 3);
    let range = thermal.range_c.map_or_else(String::new, |[low, high]| {
        format!(". The holds were at {} to {} °C", celsius(low), celsius(high))
    });
    Some(format!(
        "Biases and gains are those at T₀ = {} °C. With τ = T − T₀, a bias increases by bias_per_k τ + bias_per_k2 τ², and a gain is multiplied by \
         1 + scale_per_k τ + scale_per_k2 τ²{range}.",
        celsius(thermal.reference_c)
    ))
}
