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
    /// Over the holds that were used; `None` where the recording has no temperature, one that jumps as none does, or no hold.
    ///
    /// # Errors
    /// As [`Temperatures::of`].
    pub fn of(recording: &ImuRecording, holds: &[HoldResult]) -> Result<Option<Self>> {
        if Temperatures::of(recording)?.is_some_and(|of| of.jumps()) {
            return Ok(None);
        }
        let used = holds.iter().filter(|hold| hold.used).map(|hold| (hold.hold.start_s, hold.hold.end_s));
        let each = Self::each(recording, used)?;
        let count = each.len() as f64;
        let mean = |of: fn(&Self) -> f64| each.iter().map(of).sum::<f64>() / count;
        let range = each.iter().map(|of| of.range_c).reduce(|[low, high], [l, h]| [low.min(l), high.max(h)]);
        Ok(range.map(|range_c| Self {
            mean_c: mean(|of| of.mean_c),
            rate_k_per_min: mean(|of| of.rate_k_per_min),
            range_c,
        }))
    }

    /// Between each of these times, s; none where the recording has no temperature.
    ///
    /// # Errors
    /// As [`Temperatures::of`].
    pub fn each(recording: &ImuRecording, spans: impl Iterator<Item = (f64, f64)>) -> Result<Vec<Self>> {
        let Some(temperatures) = Temperatures::of(recording)? else { return Ok(Vec::new()) };
        let rates = temperature_rates(temperatures.times_s, temperatures.values_c);
        let rates = Temperatures { times_s: temperatures.times_s, values_c: &rates };
        let of = |(start_s, end_s)| {
            let mean_c = temperatures.mean(start_s, end_s);
            Self { mean_c, rate_k_per_min: 60.0 * rates.mean(start_s, end_s), range_c: [mean_c; 2] }
        };
        Ok(spans.map(of).collect())
    }
}
