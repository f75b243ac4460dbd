//! The best campaign: the relaxed problem with its bound, then whole soaks.

mod candidates;
mod continuum;
mod knapsack;
mod relaxed;
mod shares;
mod time_needed;
mod whole;

pub use relaxed::{RelaxedCampaign, RelaxedSoak, relaxed};
pub use time_needed::{MOST_TIMES, time_needed_min};

use crate::{Campaign, Soak};
use calibrant_core::error::Result;
use std::ops::RangeInclusive;

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
/// [`Error::Infeasible`](calibrant_core::Error::Infeasible) where there is no time for a soak; [`Error::Experiment`](calibrant_core::Error::Experiment) where no campaign
/// determines the coefficients.
pub fn design(campaign: &Campaign) -> Result<CampaignDesign> {
    let relaxed = relaxed(campaign)?;
    let soaks = whole::whole(campaign, &relaxed);
    let information = campaign.information(&soaks);
    let (Some(value), Some(sd)) = (campaign.value(&soaks), campaign.sd(&information)) else {
        return Err(relaxed::undetermined());
    };
    Ok(CampaignDesign { soaks, value, sd, relaxed })
}

/// The best campaign over these numbers of cycles, with the campaign of that number. The bound is the least of them.
///
/// # Errors
/// As [`design`], where no number of cycles gives a campaign.
pub fn design_over_cycles(
    campaign: &Campaign,
    cycles: RangeInclusive<usize>,
) -> Result<(Campaign, CampaignDesign)> {
    let of = |cycles| {
        let campaign = Campaign { cycles, ..campaign.clone() };
        design(&campaign).map(|found| (campaign, found))
    };
    let (first, others) =
        (of(*cycles.start()), (cycles.start() + 1..=*cycles.end()).filter_map(|cycles| of(cycles).ok()));
    let mut best = first?;
    for (campaign, found) in others {
        let bounds = [&found, &best.1].map(|of| (of.relaxed.lower_bound, of.relaxed.lower_bound_anywhere));
        let least = |of: fn(&(f64, f64)) -> f64| bounds.iter().map(of).fold(f64::INFINITY, f64::min);
        if found.value < best.1.value {
            best = (campaign, found);
        }
        best.1.relaxed.lower_bound = least(|bounds| bounds.0);
        best.1.relaxed.lower_bound_anywhere = least(|bounds| bounds.1);
    }
    Ok(best)
}
