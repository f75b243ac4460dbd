//! The temperature while a sensor was held.

use super::hold_result::HoldResult;
use super::imu::temperature_rates;
use crate::error::Result;
use crate::json_object;
use crate::sensor::{ImuRecording, Temperatures};

/// The temperature over the holds of a recording: what a calibration at one temperature is of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoakTemperature {
    /// Mean over the holds, °C.
    pub mean_c: f64,
    /// Mean rate over the holds, K/min.
    pub rate_k_per_min: f64,
    /// Lowest and highest of a hold, °C.
    pub range_c: [f64; 2],
}

json_object! {
    /// The temperature over the holds.
    SoakTemperature as of {
        mean_c: of.mean_c,
        /// Mean rate over the holds.
        rate_k_per_min: of.rate_k_per_min,
        /// Lowest and highest mean of a hold.
        range_c: of.range_c,
    }
}

impl SoakTemperature {
    /// Over the holds that were used; `None` where the recording has no temperature, or no hold.
    ///
    /// # Errors
    /// As [`Temperatures::of`].
    pub fn of(recording: &ImuRecording, holds: &[HoldResult]) -> Result<Option<Self>> {
        let Some(temperatures) = Temperatures::of(recording)? else { return Ok(None) };
        let rates = temperature_rates(temperatures.times_s, temperatures.values_c);
        let rates = Temperatures { times_s: temperatures.times_s, values_c: &rates };
        let over = |of: Temperatures<'_>| -> Vec<f64> {
            let used = holds.iter().filter(|hold| hold.used);
            used.map(|hold| of.mean(hold.hold.start_s, hold.hold.end_s)).collect()
        };
        let (of_holds, rates) = (over(temperatures), over(rates));
        let range_c =
            of_holds.iter().map(|&t| [t, t]).reduce(|[low, high], [t, _]| [low.min(t), high.max(t)]);
        let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
        Ok(range_c.map(|range_c| Self {
            mean_c: mean(&of_holds),
            rate_k_per_min: 60.0 * mean(&rates),
            range_c,
        }))
    }
}
