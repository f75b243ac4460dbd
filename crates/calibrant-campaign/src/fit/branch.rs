//! The sensor on one branch: what the fit predicts of a recording that was not used.

use super::entry::{AtReference, Entry, Means};
use super::scatter::{SoakScatter, added_variance};
use super::soak::SoakPath;
use crate::{Campaign, Channel};
use calibrant_core::sensor::CalibratedImu;
use nalgebra::{DMatrix, DVector};

/// The fit as it was solved.
#[derive(Debug, Clone)]
pub(super) struct Solved {
    pub(super) campaign: Campaign,
    pub(super) channels: Vec<Channel>,
    pub(super) entries: Vec<Entry>,
    pub(super) means: Means,
    pub(super) scatters: Vec<SoakScatter>,
    pub(super) coefficients: DVector<f64>,
    /// Without what all soaks share.
    pub(super) covariance: DMatrix<f64>,
}

impl Solved {
    /// The sensor of a recording on this path; `imu`: the mean of both branches.
    pub(super) fn on_path(&self, imu: &CalibratedImu, path: &SoakPath) -> CalibratedImu {
        let Self { campaign, channels, entries, .. } = self;
        let mut covariance = self.covariance.clone();
        for entry in entries {
            let (first, channel) = (entry.places.start, &channels[entry.channel]);
            covariance[(first, first)] +=
                added_variance(campaign, channel, &self.scatters[entry.channel], path);
        }
        let mut imu = imu.clone();
        let at = AtReference::of(
            entries,
            &self.means,
            &self.coefficients,
            |entry| channels[entry.channel].on_branch(path.direction, path.lag_left),
            (campaign.range_c, imu.parameters.thermal.reference_c),
        );
        at.set(&mut imu.parameters);
        let covariance = &at.jacobian * covariance * at.jacobian.transpose();
        imu.covariance = Some(0.5 * (&covariance + covariance.transpose()));
        imu.quantities = at.quantities;
        imu.shared = None;
        imu
    }
}
