//! The lag of the thermometer behind the sensor.
//!
//! The temperature of a sensor is `T = T_m + t_l dT_m/dt`, with what the thermometer shows, `T_m`, and one lag `t_l` for a recording. Beside the parameters
//! `p` the lag is one more unknown. With `χ²(t_l)` the least χ² at a lag, its curvature and slope give the lag, with a prior, and `dp/dt_l` the errors of all
//! parameters by it. In a purely exponential warm-up of time constant `θ` the rate is linear in the temperature: then a lag looks like a slope that is larger
//! by `t_l/θ`, the recording determines the sum only, and the prior carries the rest into biases and slopes.

use crate::error::Result;
use crate::estimate::imu::model::{Fit, ImuModel, singular};
use crate::estimate::imu::problem::Turn;
use crate::estimate::imu::temperature::RecordingTemperature;
use crate::estimate::settings::CalibrationSettings;
use crate::motion::Hold;
use nalgebra::DVector;

/// χ² of one degree of freedom that a lag of zero exceeds in one of a thousand recordings.
const SEEN_CHI2: f64 = 10.83;

/// Step of the differences, s.
const STEP_S: f64 = 5.0;

/// By how much the thermometer lags the sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThermometerLag {
    /// `t_l`, s.
    pub lag_s: f64,
    /// Its standard deviation, s. As a prior: 0 for the lag as it is stated.
    pub sd_s: f64,
}

/// What is supposed of a thermometer: it is the chip's own (no lag), or another one on the board, which lags by 10 to 30 s.
impl Default for ThermometerLag {
    fn default() -> Self {
        Self { lag_s: 0.0, sd_s: 15.0 }
    }
}

/// The lag by a fit at some lag.
#[derive(Debug, Clone)]
pub(crate) struct LagEstimate {
    pub(crate) lag: ThermometerLag,
    /// Is it not 0 by the recording alone?
    pub(crate) is_seen: bool,
    /// Change of the estimates by one standard deviation of the lag.
    pub(crate) error: DVector<f64>,
}

impl LagEstimate {
    /// The lag from a fit with temperatures that are those at `temperature.lag_s`. `None` where nothing follows temperature, or the lag is stated.
    pub(crate) fn of(
        model: &ImuModel<'_>,
        fit: &Fit,
        (temperature, holds, turns): (&RecordingTemperature<'_>, &[&Hold], &[Turn]),
        prior: &ThermometerLag,
        settings: &CalibrationSettings,
    ) -> Result<Option<Self>> {
        let Some(of_turns) = temperature.rates(turns.iter().map(|turn| (turn.start_s, turn.end_s))) else {
            return Ok(None);
        };
        let Some(of_holds) = temperature.rates(holds.iter().map(|hold| (hold.start_s, hold.end_s))) else {
            return Ok(None);
        };
        if prior.sd_s <= 0.0 {
            return Ok(None);
        }
        let at = |by_s: f64| {
            let mut moved = model.clone();
            for (hold, rate) in moved.holds.iter_mut().zip(&of_holds) {
                hold.temperature_c += by_s * rate;
            }
            for rotation in &mut moved.rotations {
                for (end, rate) in rotation.samples.drift.iter_mut().zip(&of_holds[rotation.from..]) {
                    end.temperature_c += by_s * rate;
                }
            }
            for (turn, rate) in moved.turns.iter_mut().zip(&of_turns) {
                turn.temperature_c += by_s * rate;
            }
            let residuals = moved.gravity_residuals(&fit.state).ok_or_else(singular)?;
            moved.fit(fit.state.clone(), residuals, settings).ok_or_else(singular)
        };
        let (less, more) = (at(-STEP_S)?, at(STEP_S)?);
        let slope = 0.5 * (more.chi2 - less.chi2) / STEP_S;
        let curvature = (0.5 * (more.chi2 + less.chi2 - 2.0 * fit.chi2) / STEP_S.powi(2)).max(0.0);
        let expected = prior.sd_s.powi(-2);
        let precision = curvature + expected;
        let off = 0.5 * slope + (temperature.lag_s - prior.lag_s) * expected;
        let lag =
            ThermometerLag { lag_s: temperature.lag_s - off / precision, sd_s: precision.recip().sqrt() };
        // (lag by the recording alone)² times the curvature
        let is_seen = (temperature.lag_s * curvature - 0.5 * slope).powi(2) > SEEN_CHI2 * curvature;
        let error = DVector::from_iterator(
            model.quantities.len(),
            model.quantities.iter().map(|quantity| {
                let change = quantity.value(&more.state.imu) - quantity.value(&less.state.imu);
                0.5 * change / STEP_S * lag.sd_s
            }),
        );
        Ok(Some(Self { lag, is_seen, error }))
    }
}
