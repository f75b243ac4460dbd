//! The best campaign: the relaxed problem with its bound, then whole soaks.

mod candidates;
mod continuum;
mod knapsack;
mod relaxed;
mod shares;
mod whole;

pub use relaxed::{RelaxedCampaign, RelaxedSoak, relaxed};

use crate::{Campaign, Soak};
use calibrant_core::error::Result;

/// The best campaign that was found, and the bound of the relaxed problem.
#[derive(Debug, Clone, PartialEq)]
pub struct CampaignDesign {
    /// The soaks, upwards, then downwards.
    pub soaks: Vec<Soak>,
    /// The criterion.
    pub value: f64,
    /// Standard deviation of each channel's polynomial, root of the mean variance over the range, in its unit.
    pub sd: Vec<f64>,
    /// The relaxed problem, in which soaks may be fractions, and its bound.
    pub relaxed: RelaxedCampaign,
}

impl CampaignDesign {
    /// How far the value is above the bound: a share of it, or a difference for D.
    #[must_use]
    pub fn gap(&self, campaign: &Campaign) -> f64 {
        campaign.criterion.gap(self.value, self.relaxed.lower_bound)
    }
}

/// Finds the best campaign of whole soaks.
///
/// # Errors
/// [`Error::Experiment`](calibrant_core::Error::Experiment) where there is no time for a soak, or where no campaign determines the coefficients.
pub fn design(campaign: &Campaign) -> Result<CampaignDesign> {
    let relaxed = relaxed(campaign)?;
    let soaks = whole::whole(campaign, &relaxed);
    let information = campaign.information(&soaks);
    let (Some(value), Some(sd)) = (campaign.value(&soaks), campaign.sd(&information)) else {
        return Err(relaxed::undetermined());
    };
    Ok(CampaignDesign { soaks, value, sd, relaxed })
}
