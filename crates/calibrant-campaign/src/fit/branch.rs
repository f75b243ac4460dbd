//! The sensor on one branch: what the fit predicts of a recording that was not used.

use super::entry::{AtReference, Entry, Means};
use super::result::FittedCampaign;
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

impl FittedCampaign {
    /// The sensor of a recording on this path, with the hysteresis of its direction and the lag of its rate. Its covariance has the scatter between recordings, but not what
    /// all recordings at the place share, such as gravity that is not exactly known.
    #[must_use]
    pub fn on_path(&self, path: &SoakPath) -> CalibratedImu {
        let Solved { campaign, channels, entries, .. } = &self.solved;
        let mut covariance = self.solved.covariance.clone();
        for entry in entries {
            let (first, channel) = (entry.places.start, &channels[entry.channel]);
            covariance[(first, first)] +=
                added_variance(campaign, channel, &self.solved.scatters[entry.channel], path);
        }
        let mut imu = self.imu.clone();
        let at = AtReference::of(
            entries,
            &self.solved.means,
            &self.solved.coefficients,
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
