//! The quality of a fit as JSON.

use crate::estimate::FitStatistics;
use crate::form::per_axis;
use crate::json::{WithEnding, if_any, if_some, with_ending};
use crate::json_object;
use crate::sensor::{Axis, ReadingUnit};
use nalgebra::Vector3;

/// The quality of a fit to the readings of a sensor with this unit and number of axes.
pub struct FitInUnit<'a> {
    /// The statistics.
    pub fit: &'a FitStatistics,
    /// Unit of the readings.
    pub unit: ReadingUnit,
    /// Number of axes.
    pub axes: usize,
}

json_object! {
    /// How well the model fits the data.
    FitInUnit<'_> as of {
        /// Weighted sum of squared residuals, process noise and prior included.
        chi2: of.fit.chi2,
        /// Residuals less unknowns.
        degrees_of_freedom: of.fit.degrees_of_freedom,
        /// Probability of a χ² at least this large if model and noise are right.
        p_value: of.fit.p_value,
        /// Root mean square of the residuals.
        residual_rms: if_some(of.in_unit(of.fit.residual_rms)),
        /// Noise of one sample that was assumed.
        assumed_noise: if_some(of.in_unit(of.fit.assumed_noise)),
        /// Noise of one sample, from the residuals.
        noise_estimate: if_some(of.in_unit(of.fit.noise_estimate)),
        /// Ljung–Box test of each axis' residuals.
        whiteness: if_any(of.whiteness()),
    }
}

struct WhitenessOf {
    axis: Axis,
    of: crate::estimate::Whiteness,
}

json_object! {
    WhitenessOf as test {
        /// The axis of the residuals.
        axis: test.axis,
        /// The statistic Q of the Ljung–Box test.
        statistic: test.of.statistic,
        /// Number of lags that are tested.
        lags: test.of.lags,
        /// Probability of a statistic at least this large if the noise is white.
        p_value: test.of.p_value,
    }
}

impl FitInUnit<'_> {
    fn in_unit(&self, values: Option<Vector3<f64>>) -> Option<WithEnding<Vec<f64>>> {
        values.map(|values| with_ending(self.unit.suffix(), per_axis(&values, self.axes)))
    }

    fn whiteness(&self) -> Vec<WhitenessOf> {
        Axis::ALL
            .into_iter()
            .zip(&self.fit.whiteness)
            .map(|(axis, of)| WhitenessOf { axis, of: *of })
            .collect()
    }
}
