//! The lag of the thermometer behind the sensor.
//!
//! The temperature of a sensor is `T = T_m + t_l dT_m/dt`, with what the thermometer shows, `T_m`, and one lag `t_l` for a recording. The lag is known as far
//! as it is stated, and `dp/dt_l` times its standard deviation is in the errors of the parameters `p`. It is not taken from the recording: a purely
//! exponential warm-up of time constant `θ` has rates that are linear in the temperature, so that a lag looks like a slope that is larger by `t_l/θ`; and where
//! the warm-up begins, delays and slow thermometers differ more than recordings show lags. What the recording shows, by slope and curvature of the least
//! `χ²(t_l)`, is told.

use crate::error::Result;
use crate::estimate::imu::model::{Fit, ImuModel, singular};
use crate::estimate::imu::problem::Turn;
use crate::estimate::imu::temperature::RecordingTemperature;
use crate::estimate::imu::thermometer::ThermometerLag;
use crate::estimate::settings::CalibrationSettings;
use crate::motion::Hold;
use nalgebra::DVector;

/// A lag is seen where it lowers χ² by this much: five standard deviations, since errors of the thermometer are common to all axes.
const SEEN_CHI2: f64 = 25.0;

/// A lag further off what is stated, in its standard deviations, is a mistake of the model.
const PLAUSIBLE: f64 = 2.0;

/// Step of the differences, s.
const STEP_S: f64 = 5.0;

/// What a lag does to the estimates.
#[derive(Debug, Clone)]
pub(crate) struct LagEffect {
    /// The lag that the recording shows by itself, with its standard deviation.
    pub(crate) seen: Option<ThermometerLag>,
    /// Change of the estimates by one standard deviation of the stated lag.
    pub(crate) error: DVector<f64>,
}

impl LagEffect {
    /// By fits beside the one with the stated lag. `None` where nothing follows temperature, or the lag is known.
    pub(crate) fn of(
        model: &ImuModel<'_>,
        fit: &Fit,
        (temperature, holds, turns): (&RecordingTemperature<'_>, &[&Hold], &[Turn]),
        stated: &ThermometerLag,
        settings: &CalibrationSettings,
    ) -> Result<Option<Self>> {
        let Some(of_turns) = temperature.rates(turns.iter().map(|turn| (turn.start_s, turn.end_s))) else {
            return Ok(None);
        };
        let Some(of_holds) = temperature.rates(holds.iter().map(|hold| (hold.start_s, hold.end_s))) else {
            return Ok(None);
        };
        if stated.sd_s <= 0.0 {
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
        let by_recording = (curvature > 0.0).then(|| ThermometerLag {
            lag_s: stated.lag_s - 0.5 * slope / curvature,
            sd_s: curvature.recip().sqrt(),
        });
        let seen = by_recording.filter(|found| {
            let off_s = (found.lag_s - stated.lag_s).abs();
            (off_s / found.sd_s).powi(2) > SEEN_CHI2 && off_s < PLAUSIBLE * stated.sd_s
        });
        let error = DVector::from_iterator(
            model.quantities.len(),
            model.quantities.iter().map(|quantity| {
                let change = quantity.value(&more.state.imu) - quantity.value(&less.state.imu);
                0.5 * change / STEP_S * stated.sd_s
            }),
        );
        Ok(Some(Self { seen, error }))
    }
}
