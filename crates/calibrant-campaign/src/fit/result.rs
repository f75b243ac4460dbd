//! The calibration over temperature, and what judges it.

use super::branch::Solved;
use super::scatter::SoakScatter;
use super::soak::SoakPath;
use super::verdicts::WaldTest;
use crate::Channel;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::sensor::{Axis, CalibratedImu};
use nalgebra::{DMatrix, DVector};

/// A calibration over temperature, from several soaks.
#[derive(Debug, Clone)]
pub struct FittedCampaign {
    /// The sensor at the reference temperature with its temperature terms.
    pub imu: CalibratedImu,
    /// The channels that follow temperature.
    pub channels: Vec<FittedChannel>,
    /// The soaks in their order.
    pub soaks: Vec<FittedSoak>,
    /// What was noticed.
    pub warnings: Vec<Diagnostic>,
    /// The axis whose bias contains its gain at 1 g, of a recording in one pose.
    pub with_gain: Option<Axis>,
    pub(super) solved: Solved,
}

/// A quantity over temperature.
#[derive(Debug, Clone)]
pub struct FittedChannel {
    /// As it was fitted.
    pub channel: Channel,
    /// The order that is reported.
    pub order: usize,
    /// What does not average within a soak.
    pub scatter: SoakScatter,
    /// The mean gain over the soaks that the gain of each axis is relative to; 1 of a bias.
    pub relative_to: Vec<f64>,
    /// Coefficients of each axis: polynomial, hysteresis, lag.
    pub coefficients: Vec<DVector<f64>>,
    /// Their covariance, without what all soaks share, such as gravity.
    pub covariances: Vec<DMatrix<f64>>,
    /// Root mean square of each soak less what the others predict of it, over the standard deviations: 1 where these hold. `None` where no soak is predicted.
    pub left_out_ratio: Option<f64>,
    /// Is there hysteresis? `None`: the soaks do not determine it.
    pub hysteresis: Option<WaldTest>,
    /// Does the thermometer lag?
    pub lag: Option<WaldTest>,
}

/// A soak beside the fit.
#[derive(Debug, Clone)]
pub struct FittedSoak {
    /// Its name.
    pub name: String,
    /// From where it came to its temperature.
    pub path: SoakPath,
    /// What it measures of each channel, for each axis.
    pub values: Vec<Vec<f64>>,
    /// Their standard deviations by its own calibration.
    pub sds: Vec<Vec<f64>>,
    /// Its residuals, for each channel and axis.
    pub residuals: Vec<Vec<f64>>,
    /// Their standard deviations.
    pub residual_sds: Vec<Vec<f64>>,
}

impl FittedCampaign {
    /// The sensor of a recording on this path, with the hysteresis of its direction and the lag of its rate. Its covariance has the scatter between recordings, but not what
    /// all recordings at the place share, such as gravity that is not exactly known.
    #[must_use]
    pub fn on_path(&self, path: &SoakPath) -> CalibratedImu {
        self.solved.on_path(&self.imu, path)
    }
}

impl FittedChannel {
    /// The polynomial of an axis at `x`, −1 to 1 over the range, and its standard deviation.
    #[must_use]
    pub fn at(&self, axis: usize, x: f64) -> (f64, f64) {
        let row = self.channel.polynomial_row(x);
        let variance = row.dot(&(&self.covariances[axis] * &row));
        (row.dot(&self.coefficients[axis]), variance.max(0.0).sqrt())
    }

    /// Root of the mean variance of the polynomial over the range and the axes.
    #[must_use]
    pub fn sd(&self) -> f64 {
        let mean = |covariance: &DMatrix<f64>| -> f64 {
            let of = |m: usize| covariance[(m, m)] * calibrant_core::sensor::legendre::mean_square(m);
            (0..self.channel.polynomial()).map(of).sum()
        };
        (self.covariances.iter().map(mean).sum::<f64>() / self.covariances.len().max(1) as f64).sqrt()
    }
}
