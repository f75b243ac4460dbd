//! The time that the goals need.

use super::relaxed::relaxed;
use crate::{Campaign, CampaignCriterion};

/// The longest time that [`time_needed_min`] examines, over the stated one.
pub const MOST_TIMES: f64 = 32.0;
/// Steps of the bisection.
const STEPS: usize = 12;

/// The least time in which the relaxed campaign meets the goals on average (criterion I is at most the number of channels), min; to 2 %. No campaign of whole soaks
/// needs less. `None` for other criteria, and where no time up to 32 times the stated one is enough.
#[must_use]
pub fn time_needed_min(campaign: &Campaign) -> Option<f64> {
    if campaign.criterion != CampaignCriterion::I {
        return None;
    }
    let goal = campaign.channels.len() as f64;
    let meets = |budget_min: f64| {
        relaxed(&Campaign { budget_min, ..campaign.clone() }).is_ok_and(|of| of.value <= goal)
    };
    let (mut low, mut high) = (campaign.travel_min() + campaign.block_min, MOST_TIMES * campaign.budget_min);
    if !meets(high) {
        return None;
    }
    for _ in 0..STEPS {
        let middle = (low * high).sqrt();
        if meets(middle) {
            high = middle
        } else {
            low = middle
        }
        if high < 1.02 * low {
            break;
        }
    }
    Some(high)
}
